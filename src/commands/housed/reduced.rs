//! A housing reduced to some shapes, and its bearing in it.

use super::{Fallible, Prepared, condensed};
use crate::commands::plan_step::note;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::course::on_inner;
use bearing_dynamics::output::session::Motion;
use bearing_dynamics::scene::dynamics::dynamic_problem;
use bearing_dynamics::scene::housing::HousedScene;
use bearing_dynamics::scene::housing_problem::{Excitation, excitations};
use bearing_dynamics::solver::clock::to_digits;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Bearing, OUTER};
use bearing_dynamics::solver::dynamics::run::Start;
use bearing_dynamics::solver::housing::bore_equilibrium::Fit;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::reduce::{
    LEFT_OUT, ReduceOptions, Reduction, pressed, reduce,
};
use bearing_dynamics::solver::housing::reduced_start::{
    Housing, add_housing, ball_frequency, put_in_equilibrium,
};
use bearing_dynamics::solver::plan::tally::Tally;
use bearing_dynamics::solver::statics::Condition;
use std::time::Instant;

/// A bearing in a reduced housing, ready to run.
pub struct Reduced {
    pub reduction: Reduction,
    pub assembly: Assembly,
    /// Wall time that condensing, and finding shapes and start took, s.
    pub seconds: [f64; 2],
    /// How often each stage of condensing ran.
    pub ran: Tally,
}

/// Frequencies of the housing that are kept, over that of a ball between its races.
const BEYOND_BALLS: f64 = 2.0;

/// A housing condensed and reduced, and the wall time of both, s.
pub struct Found {
    pub bore: CondensedBore,
    pub reduction: Reduction,
    pub seconds: [f64; 2],
}

/// Condenses a housing and reduces it for a bearing with up to `force` (N) on it.
pub fn reduction(
    scene: &HousedScene,
    prepared: &Prepared,
    bearing: &Bearing,
    force: f64,
) -> Fallible<Found> {
    let setup = &prepared.setup;
    let penalty = scene.housing.penalty;
    let start = Instant::now();
    let bore = condensed(prepared)?;
    let condensing = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let loads = pressed(&bore, penalty, &setup.fit(scene), force.max(1.0))?;
    let by_default = || BEYOND_BALLS * ball_frequency(bearing, force);
    let modes_to = scene.housing.modes_to.unwrap_or_else(by_default);
    let options = ReduceOptions { modes_to, left_out: LEFT_OUT };
    let reduction = reduce(&setup.model, &bore, penalty, &loads, &options)?;
    Ok(Found { bore, reduction, seconds: [condensing, start.elapsed().as_secs_f64()] })
}

/// Condenses and reduces the housing of a scene, and finds the equilibrium that a run starts from.
pub fn reduced(scene: &HousedScene, prepared: &Prepared) -> Fallible<Reduced> {
    let (setup, penalty) = (&prepared.setup, scene.housing.penalty);
    let mut assembly = dynamic_problem(&scene.bearing)?.assembly();
    let force = largest_force(scene, &assembly.corners());
    let Found { mut bore, reduction, seconds: [condensing, reducing] } =
        reduction(scene, prepared, &assembly.bearings[0], force)?;
    let start = Instant::now();
    let radius = setup.radius(scene);
    let fit = Fit { radius: radius.value(0.0), ..setup.fit(scene) };
    add_housing(&mut assembly, OUTER, &reduction, &bore, radius, penalty);
    let nominal = |run: &bearing_dynamics::scene::RunSettings| run.options.start == Start::Nominal;
    if !scene.bearing.dynamics.run.as_ref().is_some_and(nominal) {
        let housing = Housing { reduction: &reduction, bore: &mut bore, fit, penalty };
        put_in_equilibrium(&mut assembly, &mut [housing])?;
    }
    let seconds = [condensing, reducing + start.elapsed().as_secs_f64()];
    Ok(Reduced { reduction, assembly, seconds, ran: bore.ran })
}

/// Looks at loads between two of their corners, and how long after the last one, s.
const LOOKS: usize = 64;
const AFTER: f64 = 1.0;

/// On the inner race across its axis, N, at any time: a run that is extended keeps its housing.
fn largest_force(scene: &HousedScene, corners: &[f64]) -> f64 {
    let load = |condition: &Condition| match condition {
        Condition::Load(load) => *load,
        Condition::Displacement(_) => 0.0,
    };
    let at = |t: f64| {
        let conditions = on_inner(scene, t);
        load(&conditions[1]).hypot(load(&conditions[2]))
    };
    let mut largest = at(0.0);
    let mut from = 0.0;
    for to in corners.iter().copied().chain([corners.last().unwrap_or(&0.0) + AFTER]) {
        let times = (1..=LOOKS).map(|i| from + (to - from) * i as f64 / LOOKS as f64);
        largest = times.map(at).fold(largest, f64::max);
        from = to;
    }
    largest
}

impl Reduced {
    /// Displacements (m) and velocities (m/s) of all nodes of the housing now.
    pub fn fields(&self, motion: &Motion) -> Option<[Vec<Vec3>; 2]> {
        let Motion::Bearing(simulation) = motion else { return None };
        let (gone, speeds) = simulation.system.shapes_of(&simulation.state, 0);
        Some([gone, speeds].map(|of| self.reduction.displacement(of)))
    }

    /// Unknowns, shapes and frequencies.
    pub fn text(&self) -> String {
        let cut = &self.reduction.cut_off;
        format!(
            "{} natural shapes up to {} Hz and {} static answers to pressure on the bore's {} nodes{}; frequencies from {} to {} Hz",
            cut.natural,
            to_digits(cut.modes_to, 4),
            cut.patterns,
            cut.nodes,
            match cut.own {
                0 => String::new(),
                own => format!(" and {own} to weight and loads"),
            },
            to_digits(cut.lowest, 4),
            to_digits(cut.highest, 4)
        )
    }
}

/// What there is to note of a reduced housing.
pub fn plan_notes(scene: &HousedScene, reduced: &Reduced) -> Vec<String> {
    let cut = &reduced.reduction.cut_off;
    let driven = |of: &Excitation| {
        let error = cut.dynamic_error(of.frequency);
        format!("{} of what goes with {}", super::plan::percent(error), of.what)
    };
    let mut cut_off = format!(
        "{} of the compliance under the largest load all round has no shape; the lowest natural shape left out swings at {} Hz",
        super::plan::percent(cut.static_left_out),
        to_digits(cut.first_left_out, 4)
    );
    let errors: Vec<String> = excitations(scene).iter().map(driven).collect();
    if !errors.is_empty() {
        cut_off += &format!(", which changes at most {}", errors.join(", "));
    }
    vec![
        note("shapes of the housing", &reduced.text()),
        note("cut off", &cut_off),
        note("masses of the housing", "lumped, as of explicit steps"),
    ]
}
