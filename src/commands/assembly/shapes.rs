//! Housings reduced to some shapes, and the assembly that they are part of.

use super::Fallible;
use super::housing::Housing;
use super::housings::{Largest, at_start, condensed, seats};
use super::lists::Lists;
use crate::commands::memory::{refuse_beyond, spun};
use crate::commands::plan_step::note;
use bearing_dynamics::assembly::lists::{Assembly, Bearing};
use bearing_dynamics::assembly::plan::counts::Counts;
use bearing_dynamics::kinematics::vec3::Vec3;
use bearing_dynamics::motion::reduced_start;
use bearing_dynamics::motion::reduced_start::{add_housing, ball_frequency, put_in_equilibrium};
use bearing_dynamics::motion::simulation::Start;
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::session::Motion;
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::excitations::{Excitation, excitations};
use bearing_dynamics::solids::bore_equilibrium::{Axial, BoreState, Fit};
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::load_patterns::{LargestLoads, pressed};
use bearing_dynamics::solids::memory;
use bearing_dynamics::solids::reduction::{CutOff, LEFT_OUT, ReduceOptions, Reduction, reduce};
use std::error::Error;
use std::time::Instant;

/// Housings as shapes, and the assembly with them.
pub struct Shapes {
    pub assembly: Assembly,
    /// What the shapes of each housing are made for, and force (N) and moment (N m) on its race at the start.
    pub presses: Vec<(LargestLoads<'static>, [f64; 2])>,
    /// One for each housing.
    pub reductions: Vec<Reduction>,
    /// Wall time that condensing, and finding shapes and start took, s.
    pub seconds: [f64; 2],
    /// How often each stage of condensing ran, one for each housing.
    pub ran: Vec<Counts>,
}

/// A press by so much more than shapes are made for is told of: patches of contact grow by less than it does.
const BEYOND: f64 = 1.25;

/// Frequencies of the housing that are kept, over that of a ball between its races.
const BEYOND_BALLS: f64 = 2.0;

/// Modes whose memory is counted: a block of steel has some dozens up to the frequency of a ball.
const COUNTED: usize = 40;

/// Reduces a housing for a bearing whose balls are under `struck` (N).
fn reduction(
    housing: &Housing,
    bore: &CondensedBore,
    (bearing, struck): (&Bearing, f64),
    hardest: &LargestLoads,
) -> Fallible<Reduction> {
    let settings = &housing.scene.housing;
    let fit = housing.setup.fit(&housing.scene);
    let loads = pressed(bore, settings.penalty, &fit, hardest)?;
    let by_default = || BEYOND_BALLS * ball_frequency(bearing, struck);
    let modes_to = settings.modes_to.unwrap_or_else(by_default);
    let options = ReduceOptions { modes_to, left_out: LEFT_OUT };
    let what = format!(
        "{}natural shapes of the housing up to {} Hz (housing.modes_to)",
        housing.before(),
        to_digits(modes_to, 4)
    );
    // Their number is not known before.
    let needed = memory::modes_of_fixed(bore.unknowns(), COUNTED);
    refuse_beyond(&needed, ", a quasi-static housing (method = \"quasi-static\" in [housing])")?;
    let work = || reduce(&housing.setup.model, bore, settings.penalty, &loads, &options);
    Ok(spun(what, work)?)
}

/// Condenses and reduces the housings, and finds the equilibrium that a run starts from.
pub fn shapes(lists: &Lists, housings: &[Housing]) -> Fallible<Shapes> {
    let (scene, mut assembly) = (lists.scene, lists.assembly()?.clone());
    let largest = Largest::of(&assembly, housings);
    // A bearing may be loaded by its places alone.
    let [struck, force] = [largest.on_bodies, largest.in_all].map(|force| force.max(1.0));
    let hardest = LargestLoads { force, moment: largest.moments, start: None };
    let start = Instant::now();
    let mut bores: Vec<CondensedBore> = condensed(housings)?;
    let condensing = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let settles = scene.run().is_none_or(|run| run.options.start != Start::Nominal);
    let settled = match settles {
        true => {
            let found = at_start(&assembly, &seats(housings, &bores));
            Some(found.map_err(|error| slides(housings, error))?)
        }
        false => None,
    };
    let (mut reductions, mut presses) = (Vec::new(), Vec::new());
    for (index, (housing, bore)) in housings.iter().zip(&bores).enumerate() {
        let bearing = &assembly.bearings[housing.bearing];
        let start: Option<&BoreState> = settled.as_ref().map(|settled| &settled.seats[index]);
        let force = housing.scene.housing.press.unwrap_or(hardest.force);
        let hardest = LargestLoads { force, ..hardest };
        let reduction =
            reduction(housing, bore, (bearing, struck), &LargestLoads { start, ..hardest })?;
        let [y, z, about_y, about_z] = start.map_or([0.0; 4], |start| start.load);
        presses.push((hardest, [y.hypot(z), about_y.hypot(about_z)]));
        let body = bearing.mounts[1].body;
        let radius = housing.setup.radius(&housing.scene);
        let penalty = housing.scene.housing.penalty;
        add_housing(&mut assembly, body, &reduction, bore, radius, penalty);
        if let (Some(seat), Some(name)) = (assembly.seats.last_mut(), &housing.name) {
            seat.label = Some(name.clone());
            seat.name = format!("the bore of housing {name}");
        }
        reductions.push(reduction);
    }
    if settles {
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

/// What keeps a run from starting in equilibrium, where an outer race can slide.
fn slides(housings: &[Housing], error: Box<dyn Error>) -> Box<dyn Error> {
    match housings.iter().any(|housing| housing.scene.housing.axial == Axial::Free) {
        false => error,
        true => format!(
            "{error}. Hint: nothing takes a force along the axis on outer races with axial = \"free\", and balls at an angle push them: to let them \
             slide write start = \"nominal\" in [numerics], or hold one (axial = \"held\" in [housing.NAME])"
        )
        .into(),
    }
}

impl Shapes {
    /// Displacements (m) and velocities (m/s) of all nodes of a housing now.
    pub fn fields(&self, motion: &Motion, index: usize) -> Option<[Vec<Vec3>; 2]> {
        let Motion::Bearing(simulation) = motion else { return None };
        let (gone, speeds) = simulation.system.shapes_of(&simulation.state, index);
        Some([gone, speeds].map(|of| self.reductions[index].displacement(of)))
    }

    /// The presses that shapes of a housing are made for.
    fn made_for(&self, index: usize) -> String {
        let (hardest, [force, _]) = self.presses[index];
        let mut said = format!("presses of {} N", to_digits(hardest.force, 4));
        if hardest.moment > 0.0 {
            said += &format!(" or {} N m", to_digits(hardest.moment, 4));
        }
        if force > hardest.force {
            said += &format!(" and the start's {} N", to_digits(force, 4));
        }
        said
    }

    /// A race that was pressed (N) or turned (N m) beyond what the shapes of its housing are made for.
    pub fn beyond(&self, housings: &[Housing], index: usize, found: [f64; 2]) -> Option<Warning> {
        let (hardest, start) = self.presses[index];
        let housing = &housings[index];
        let force = hardest.force.max(start[0]);
        // Levers of a width are among the samples.
        let moment = (housing.setup.width * hardest.force).max(hardest.moment).max(start[1]);
        if found[0] <= BEYOND * force && found[1] <= BEYOND * moment {
            return None;
        }
        let needed = found[0].max(found[1] / housing.setup.width);
        let [force, moment, needed] = [found[0], found[1], needed].map(|of| to_digits(of, 4));
        let text = format!(
            "the load on the bore reaches {force} N and {moment} N m, beyond what its static correction modes are made for ({}): write press = \
             \"{needed} N\", or more, in [housing]",
            self.made_for(index)
        );
        Some(Warning::new(WarningCode::BeyondKeptModes, text).named(&housing.before()))
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
        for (index, (housing, reduction)) in housings.iter().zip(&self.reductions).enumerate() {
            let (of, cut) = (housing.before(), &reduction.cut_off);
            said.push(note("shapes of the housing", &format!("{of}{}", text(cut))));
            said.push(note(
                "cut off",
                &format!("{of}{}", cut_off(scene, &self.made_for(index), cut)),
            ));
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

fn cut_off(scene: &AssemblyScene, made_for: &str, cut: &CutOff) -> String {
    let driven = |of: &Excitation| {
        let error = cut.dynamic_error(of.frequency);
        format!("{} of what goes with {}", percent(error), of.what)
    };
    // Below that rounding is told.
    let left_out = match cut.static_left_out {
        part if part < 1e-9 => "nothing".into(),
        part => percent(part),
    };
    let mut said = format!(
        "of the compliance under {}, looked at all round, {} has no shape; the lowest natural shape left out swings at {} Hz",
        made_for,
        left_out,
        to_digits(cut.first_left_out, 4)
    );
    let errors: Vec<String> = excitations(scene).iter().map(driven).collect();
    if !errors.is_empty() {
        said += &format!(", which changes at most {}", errors.join(", "));
    }
    said
}

fn percent(part: f64) -> String {
    match part {
        part if part > 1.0 => "more than the whole".into(),
        part => format!("{} %", to_digits(100.0 * part, 2)),
    }
}
