//! Housings reduced to modes, and the assembly with them.

use super::Fallible;
use super::housing::Housing;
use super::housings::{Largest, at_start, condensed, seats};
use super::lists::Lists;
use crate::commands::memory::{refuse_beyond, spun};
use crate::commands::plan_step::note;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::kinematics::vec3::{Vec3, dot, norm, sub};
use bearing_dynamics::members::bearing::Bearing;
use bearing_dynamics::members::sensor::SensorKind;
use bearing_dynamics::motion::reduced_start;
use bearing_dynamics::motion::reduced_start::{add_housing, ball_frequency, put_in_equilibrium};
use bearing_dynamics::motion::simulation::Start;
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::session::Motion;
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::plan::counts::Counts;
use bearing_dynamics::reduction::component_modes::{
    CutOff, LEFT_OUT, ReduceOptions, Reduction, reduce,
};
use bearing_dynamics::reduction::load_patterns::{LargestLoads, pressed};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::excitations::{Excitation, excitations};
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreState, Fit};
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::memory;
use std::error::Error;
use std::time::Instant;

pub struct Shapes {
    pub assembly: Assembly,
    /// Loads that the static correction modes of each housing cover, and force (N) and moment (N m) on its race at the start.
    pub presses: Vec<(LargestLoads<'static>, [f64; 2])>,
    /// One for each housing.
    pub reductions: Vec<Reduction>,
    /// Wall times of condensing, and of finding modes and start, s.
    pub seconds: [f64; 2],
    /// Counts of the stages of condensing, one for each housing.
    pub ran: Vec<Counts>,
}

/// Ratio of a load to the covered one above which a warning is printed. Contact areas grow less than loads.
const BEYOND: f64 = 1.25;

/// Ratio of the highest kept frequency of a housing to that of a ball between its races.
const BEYOND_BALLS: f64 = 2.0;

/// Modes in the estimate of memory: a block of steel has some dozens up to the frequency of a ball.
const COUNTED: usize = 40;

/// Reduces a housing for a bearing whose balls are loaded by `impact` (N).
fn reduction(
    housing: &Housing,
    bore: &CondensedBore,
    (bearing, impact): (&Bearing, f64),
    covered: &LargestLoads,
) -> Fallible<Reduction> {
    let settings = &housing.scene.housing;
    let fit = housing.setup.fit(&housing.scene);
    let loads = pressed(bore, settings.penalty, &fit, covered)?;
    let by_default = || BEYOND_BALLS * ball_frequency(bearing, impact);
    let modes_to = settings.modes_to.unwrap_or_else(by_default);
    let options = ReduceOptions { modes_to, left_out: LEFT_OUT };
    let what = format!(
        "{}natural modes of the housing up to {} Hz (housing.modes_to)",
        housing.before(),
        to_digits(modes_to, 4)
    );
    // The number of modes is not known yet.
    let needed = memory::modes_of_fixed(bore.unknowns(), COUNTED);
    refuse_beyond(&needed, ", a quasi-static housing (method = \"quasi-static\" in [housing])")?;
    let work = || reduce(&housing.setup.model, bore, settings.penalty, &loads, &options);
    Ok(spun(what, work)?)
}

/// Condenses and reduces the housings, and finds the equilibrium at the start of a run.
pub fn shapes(lists: &Lists, housings: &[Housing]) -> Fallible<Shapes> {
    let (scene, mut assembly) = (lists.scene, lists.assembly()?.clone());
    let largest = Largest::of(&assembly, housings);
    // A bearing may be loaded by prescribed displacements alone.
    let [impact, force] = [largest.on_bodies, largest.in_all].map(|force| force.max(1.0));
    let covered = LargestLoads { force, moment: largest.moments, start: None };
    let start = Instant::now();
    let mut bores: Vec<CondensedBore> = condensed(housings)?;
    let condensing = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let from_equilibrium = scene.run().is_none_or(|run| run.options.start != Start::Nominal);
    let at_rest = match from_equilibrium {
        true => {
            let found = at_start(&assembly, &seats(housings, &bores));
            Some(found.map_err(|error| slides(housings, error))?)
        }
        false => None,
    };
    let (mut reductions, mut presses) = (Vec::new(), Vec::new());
    for (index, (housing, bore)) in housings.iter().zip(&bores).enumerate() {
        let bearing = &assembly.bearings[housing.bearing];
        let start: Option<&BoreState> = at_rest.as_ref().map(|at_rest| &at_rest.seats[index]);
        let force = housing.scene.housing.bore_load.unwrap_or(covered.force);
        let covered = LargestLoads { force, ..covered };
        let reduction =
            reduction(housing, bore, (bearing, impact), &LargestLoads { start, ..covered })?;
        let [y, z, about_y, about_z] = start.map_or([0.0; 4], |start| start.load);
        presses.push((covered, [y.hypot(z), about_y.hypot(about_z)]));
        let body = bearing.mounts[1].body;
        let radius = housing.setup.radius(&housing.scene);
        let penalty = housing.scene.housing.penalty;
        add_housing(&mut assembly, body, &reduction, bore, radius, penalty);
        if let (Some(seat), Some(name)) = (assembly.seats.last_mut(), &housing.name) {
            seat.label = Some(name.clone());
            seat.name = format!("the bore of housing {name}");
        }
        place_sensors(&mut assembly, (index, housing), &reduction)?;
        reductions.push(reduction);
    }
    if from_equilibrium {
        let of = |((housing, reduction), bore): ((&Housing, _), _)| {
            let radius = housing.setup.radius(&housing.scene).value(0.0);
            let fit = Fit { radius, ..housing.setup.fit(&housing.scene) };
            let penalty = housing.scene.housing.penalty;
            reduced_start::Housing { reduction, bore, fit, penalty }
        };
        let mut parts: Vec<_> =
            housings.iter().zip(&reductions).zip(bores.iter_mut()).map(of).collect();
        let placed = put_in_equilibrium(&mut assembly, &mut parts);
        placed.map_err(|error| slides(housings, error.into()))?;
    }
    let seconds = [condensing, start.elapsed().as_secs_f64()];
    let ran = bores.iter().map(|bore| bore.ran).collect();
    Ok(Shapes { presses, assembly, reductions, seconds, ran })
}

/// Gives accelerometers on a housing the modes at their nearest nodes.
fn place_sensors(
    assembly: &mut Assembly,
    (solid, housing): (usize, &Housing),
    reduction: &Reduction,
) -> Fallible<()> {
    let nodes = &housing.setup.model.problem.nodes;
    for sensor in &mut assembly.sensors {
        let SensorKind::Node(of) = &mut sensor.kind else { continue };
        if of.bearing != housing.bearing {
            continue;
        }
        let distance = |node: &Vec3| norm(sub(*node, of.place));
        let nearest =
            (0..nodes.len()).min_by(|a, b| distance(&nodes[*a]).total_cmp(&distance(&nodes[*b])));
        let Some(node) = nearest else { continue };
        let (far, edge) = (distance(&nodes[node]), housing.built.quality.longest_edge);
        if far > edge {
            return Err(format!(
                "sensor.{}: the nearest node of the housing is {:.4} mm away, farther than the longest edge of the mesh, {:.4} mm; \
                 correct at, radius and angle",
                sensor.name,
                1e3 * far,
                1e3 * edge
            )
            .into());
        }
        let along = reduction.shapes.iter().map(|shape| dot(shape[node], of.direction));
        of.modes = Some((solid, along.collect()));
    }
    Ok(())
}

/// Adds a hint to the error of a start in equilibrium, if an outer race can slide.
fn slides(housings: &[Housing], error: Box<dyn Error>) -> Box<dyn Error> {
    match housings.iter().any(|housing| housing.scene.housing.axial == Axial::Free) {
        false => error,
        true => format!(
            "{error}. Hint: outer races with axial = \"free\" have no axial support, and balls at a contact angle load them axially: to let \
             them slide write start = \"nominal\" in [numerics], or fix one (axial = \"held\" in [housing.NAME])"
        )
        .into(),
    }
}

impl Shapes {
    /// Present displacements (m) and velocities (m/s) of all nodes of a housing.
    pub fn fields(&self, motion: &Motion, index: usize) -> Option<[Vec<Vec3>; 2]> {
        let Motion::Bearing(simulation) = motion else { return None };
        let (amplitudes, rates) = simulation.system.shapes_of(&simulation.state, index);
        Some([amplitudes, rates].map(|of| self.reductions[index].displacement(of)))
    }

    fn made_for(&self, index: usize) -> String {
        let (covered, [force, _]) = self.presses[index];
        let mut text = format!("loads of {} N", to_digits(covered.force, 4));
        if covered.moment > 0.0 {
            text += &format!(" or {} N m", to_digits(covered.moment, 4));
        }
        if force > covered.force {
            text += &format!(" and {} N at the start", to_digits(force, 4));
        }
        text
    }

    /// Warning about a force (N) or moment (N m) on a race beyond the loads that the modes of its housing cover.
    pub fn beyond(&self, housings: &[Housing], index: usize, found: [f64; 2]) -> Option<Warning> {
        let (covered, start) = self.presses[index];
        let housing = &housings[index];
        let force = covered.force.max(start[0]);
        // The covered loads act with levers of up to a width.
        let moment = (housing.setup.width * covered.force).max(covered.moment).max(start[1]);
        if found[0] <= BEYOND * force && found[1] <= BEYOND * moment {
            return None;
        }
        let needed = found[0].max(found[1] / housing.setup.width);
        let [force, moment, needed] = [found[0], found[1], needed].map(|of| to_digits(of, 4));
        let text = format!(
            "the load on the bore reaches {force} N and {moment} N m, beyond what its static correction modes cover ({}): write bore_load = \
             \"{needed} N\", or more, in [housing]",
            self.made_for(index)
        );
        Some(Warning::new(WarningCode::BeyondKeptModes, text).named(&housing.before()))
    }

    pub fn text(&self, housings: &[Housing]) -> String {
        let of = |(housing, reduction): (&Housing, &Reduction)| {
            format!("{}{}\n", housing.before(), text(&reduction.cut_off))
        };
        housings.iter().zip(&self.reductions).map(of).collect()
    }

    pub fn notes(&self, scene: &AssemblyScene, housings: &[Housing]) -> Vec<String> {
        let mut notes = Vec::new();
        for (index, (housing, reduction)) in housings.iter().zip(&self.reductions).enumerate() {
            let (of, cut) = (housing.before(), &reduction.cut_off);
            notes.push(note("modes of the housing", &format!("{of}{}", text(cut))));
            notes.push(note(
                "cut off",
                &format!("{of}{}", cut_off(scene, &self.made_for(index), cut)),
            ));
        }
        notes.push(note("masses of the housing", "lumped, as in explicit steps"));
        notes
    }
}

fn text(cut: &CutOff) -> String {
    format!(
        "{} natural modes up to {} Hz and {} static correction modes for pressure on the bore's {} nodes{}; frequencies from {} to {} Hz",
        cut.natural,
        to_digits(cut.modes_to, 4),
        cut.patterns,
        cut.nodes,
        match cut.own {
            0 => String::new(),
            own => format!(" and {own} for weight and loads"),
        },
        to_digits(cut.lowest, 4),
        to_digits(cut.highest, 4)
    )
}

fn cut_off(scene: &AssemblyScene, made_for: &str, cut: &CutOff) -> String {
    let driven = |of: &Excitation| {
        let error = cut.dynamic_error(of.frequency);
        format!("{} of the response to {}", percent(error), of.what)
    };
    let left_out = match cut.static_left_out {
        part if part < 1e-9 => "nothing".into(),
        part => percent(part),
    };
    let mut text = format!(
        "of the compliance under {} in all directions, {} is left out; the lowest natural mode left out is at {} Hz",
        made_for,
        left_out,
        to_digits(cut.first_left_out, 4)
    );
    let errors: Vec<String> = excitations(scene).iter().map(driven).collect();
    if !errors.is_empty() {
        text += &format!(", which changes at most {}", errors.join(", "));
    }
    text
}

fn percent(part: f64) -> String {
    match part {
        part if part > 1.0 => "more than 100 %".into(),
        part => format!("{} %", to_digits(100.0 * part, 2)),
    }
}
