//! Housings reduced to some shapes, and the assembly that they are part of.

use super::Fallible;
use super::course::percent;
use super::housing::Housing;
use super::housings::Largest;
use super::lists::Lists;
use crate::commands::plan_step::note;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::output::session::Motion;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::excitations::{Excitation, excitations};
use bearing_dynamics::solver::clock::to_digits;
use bearing_dynamics::solver::dynamics::assembly::{Assembly, Bearing};
use bearing_dynamics::solver::dynamics::run::Start;
use bearing_dynamics::solver::housing::bore_equilibrium::Fit;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::presses::pressed;
use bearing_dynamics::solver::housing::reduce::{
    CutOff, LEFT_OUT, ReduceOptions, Reduction, reduce,
};
use bearing_dynamics::solver::housing::reduced_start::{
    self, add_housing, ball_frequency, put_in_equilibrium,
};
use bearing_dynamics::solver::plan::tally::Tally;
use std::time::Instant;

/// Housings as shapes, and the assembly with them.
pub struct Shapes {
    pub assembly: Assembly,
    /// One for each housing.
    pub reductions: Vec<Reduction>,
    /// Wall time that condensing, and finding shapes and start took, s.
    pub seconds: [f64; 2],
    /// How often each stage of condensing ran, one for each housing.
    pub ran: Vec<Tally>,
}

/// Frequencies of the housing that are kept, over that of a ball between its races.
const BEYOND_BALLS: f64 = 2.0;

/// A housing condensed and reduced, and the wall time of both, s.
struct Found {
    bore: CondensedBore,
    reduction: Reduction,
    seconds: [f64; 2],
}

/// Condenses a housing and reduces it for a bearing with so much on it.
fn reduction(housing: &Housing, bearing: &Bearing, force: &Largest) -> Fallible<Found> {
    let settings = &housing.scene.housing;
    let start = Instant::now();
    let bore = housing.condensed()?;
    let condensing = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let fit = housing.setup.fit(&housing.scene);
    // A bearing may be loaded by its places alone.
    let [struck, pressing] = [force.on_bodies, force.in_all].map(|force| force.max(1.0));
    let loads = pressed(&bore, settings.penalty, &fit, [pressing, force.moments])?;
    let by_default = || BEYOND_BALLS * ball_frequency(bearing, struck);
    let modes_to = settings.modes_to.unwrap_or_else(by_default);
    let options = ReduceOptions { modes_to, left_out: LEFT_OUT };
    let reduction = reduce(&housing.setup.model, &bore, settings.penalty, &loads, &options)?;
    Ok(Found { bore, reduction, seconds: [condensing, start.elapsed().as_secs_f64()] })
}

/// Condenses and reduces the housings, and finds the equilibrium that a run starts from.
pub fn shapes(lists: &Lists, housings: &[Housing]) -> Fallible<Shapes> {
    let (scene, mut assembly) = (lists.scene, lists.assembly()?.clone());
    let force = Largest::of(&assembly, housings);
    let (mut reductions, mut bores) = (Vec::new(), Vec::new());
    let mut seconds = [0.0; 2];
    for housing in housings {
        let bearing = &assembly.bearings[housing.bearing];
        let found = reduction(housing, bearing, &force)?;
        let body = bearing.mounts[1].body;
        let radius = housing.setup.radius(&housing.scene);
        let penalty = housing.scene.housing.penalty;
        add_housing(&mut assembly, body, &found.reduction, &found.bore, radius, penalty);
        if let (Some(seat), Some(name)) = (assembly.seats.last_mut(), &housing.name) {
            seat.label = Some(name.clone());
            seat.name = format!("the bore of housing {name}");
        }
        seconds = [seconds[0] + found.seconds[0], seconds[1] + found.seconds[1]];
        reductions.push(found.reduction);
        bores.push(found.bore);
    }
    let start = Instant::now();
    if scene.run().is_none_or(|run| run.options.start != Start::Nominal) {
        let of = |((housing, reduction), bore): ((&Housing, _), _)| {
            let radius = housing.setup.radius(&housing.scene).value(0.0);
            let fit = Fit { radius, ..housing.setup.fit(&housing.scene) };
            let penalty = housing.scene.housing.penalty;
            reduced_start::Housing { reduction, bore, fit, penalty }
        };
        let mut parts: Vec<_> =
            housings.iter().zip(&reductions).zip(bores.iter_mut()).map(of).collect();
        put_in_equilibrium(&mut assembly, &mut parts)?;
    }
    seconds[1] += start.elapsed().as_secs_f64();
    let ran = bores.iter().map(|bore| bore.ran).collect();
    Ok(Shapes { assembly, reductions, seconds, ran })
}

impl Shapes {
    /// Displacements (m) and velocities (m/s) of all nodes of a housing now.
    pub fn fields(&self, motion: &Motion, index: usize) -> Option<[Vec<Vec3>; 2]> {
        let Motion::Bearing(simulation) = motion else { return None };
        let (gone, speeds) = simulation.system.shapes_of(&simulation.state, index);
        Some([gone, speeds].map(|of| self.reductions[index].displacement(of)))
    }

    /// Unknowns, shapes and frequencies of each housing, a line each.
    pub fn text(&self, housings: &[Housing]) -> String {
        let of = |(housing, reduction): (&Housing, &Reduction)| {
            format!("{}{}\n", housing.before(), text(&reduction.cut_off))
        };
        housings.iter().zip(&self.reductions).map(of).collect()
    }

    /// What there is to note of each housing in a plan.
    pub fn notes(&self, scene: &AssemblyScene, housings: &[Housing]) -> Vec<String> {
        let mut said = Vec::new();
        for (housing, reduction) in housings.iter().zip(&self.reductions) {
            let (of, cut) = (housing.before(), &reduction.cut_off);
            said.push(note("shapes of the housing", &format!("{of}{}", text(cut))));
            said.push(note("cut off", &format!("{of}{}", cut_off(scene, cut))));
        }
        said.push(note("masses of the housing", "lumped, as of explicit steps"));
        said
    }
}

fn text(cut: &CutOff) -> String {
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

fn cut_off(scene: &AssemblyScene, cut: &CutOff) -> String {
    let driven = |of: &Excitation| {
        let error = cut.dynamic_error(of.frequency);
        format!("{} of what goes with {}", percent(error), of.what)
    };
    let mut said = format!(
        "{} of the compliance under the largest load all round has no shape; the lowest natural shape left out swings at {} Hz",
        percent(cut.static_left_out),
        to_digits(cut.first_left_out, 4)
    );
    let errors: Vec<String> = excitations(scene).iter().map(driven).collect();
    if !errors.is_empty() {
        said += &format!(", which changes at most {}", errors.join(", "));
    }
    said
}
