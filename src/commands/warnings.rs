//! Warnings about equilibria and runs of bearings.

use crate::commands::bushing_warnings;
use bearing_dynamics::ch2_housing::bearing::ball_contact::peak_pressure;
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use bearing_dynamics::equilibrium::lists::{Place, StaticAssembly};
use bearing_dynamics::equilibrium::statics::{
    AssemblySolution, BallState, ContactState, Determinacy,
};
use bearing_dynamics::members::bearing::Bearing;
use bearing_dynamics::members::body::Rotation;
use bearing_dynamics::motion::extremes::{Extreme, Extremes};
use bearing_dynamics::motion::validity::FARTHEST_BENT;
use bearing_dynamics::numeric::clock::{display_time, to_digits};
use bearing_dynamics::output::session::Session;
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::scene::build::assembly::{AssemblyScene, BushingStepping, PlacedBearing};
use bearing_dynamics::scene::build::excitations::{excitations, largest};
use bearing_dynamics::scene::build::statics::{ball_mass, orbital_speed};
use bearing_dynamics::scene::{CageInRun, RunPlot, Scene};
use std::error::Error;
use std::f64::consts::{PI, TAU};

/// Pressure above which ISO 76 expects permanent deformation in ball bearings, Pa.
const STATIC_RATING: f64 = 4200e6;
/// Contact angle below which a ball needs no shoulder, rad.
const BOTTOM: f64 = 1e-6;
/// Smallest angle from the nominal contact angle to an estimated shoulder of an angular-contact bearing, rad.
const BEYOND_NOMINAL: f64 = 15.0 / 180.0 * PI;
/// Smallest ratio of centrifugal force to the largest ball load that gives a warning.
const CENTRIFUGAL: f64 = 0.05;

/// Extremes of the ball contacts of a bearing; times of a run in s.
#[derive(Clone, Debug, Default)]
struct ContactExtremes {
    /// Largest load on the inner and the outer race, N.
    loads: [Extreme; 2],
    /// Largest angle from the bottom of the groove to the end of a contact ellipse, and its contact angle, rad.
    edges: [Extreme; 2],
    edge_angles: [f64; 2],
    /// Balls loaded at a negative contact angle, counted from 1.
    reversed: Vec<usize>,
    /// Largest load between two balls, N, and its pressure, Pa.
    between: Extreme,
    between_pressure: f64,
    in_run: bool,
}

impl ContactExtremes {
    fn when(&self, of: &Extreme) -> String {
        if self.in_run { format!(" at t = {} s", display_time(of.time)) } else { String::new() }
    }
}

/// Warnings about an equilibrium.
///
/// # Errors
/// If a section is tilted beyond the range of linear bending.
pub fn of_equilibrium(
    scene: &AssemblyScene,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Result<Vec<Warning>, Box<dyn Error>> {
    refuse_bent(assembly, solution)?;
    let mut warnings = bushing_warnings::of_equilibrium(scene, assembly, solution);
    if let Determinacy::Indeterminate { free_directions } = &solution.determinacy {
        let text = format!(
            "the position is not determined, because {} directions have no stiffness: load or preload the bearings, or prescribe these coordinates",
            free_directions.len()
        );
        warnings.push(Warning::new(WarningCode::IndeterminatePosition, text));
    }
    if solution.saddles_left > 0 {
        let text = "an unstable equilibrium was left for a stable one next to it, whose mirror image is an equilibrium too; if the support keeps \
                    a race upright, fix its tilts, as in tilt_y = { tilt = \"0 deg\" }";
        warnings.push(Warning::new(WarningCode::SaddleLeft, text));
    }
    let bearings = scene.bearings.iter().zip(&assembly.bearings).zip(&solution.bearings);
    for ((placed, bearing), state) in bearings {
        let contacts = [&bearing.inner_contact, &bearing.outer_contact];
        let own = shared(placed, contacts, &at_rest(&placed.scene, &state.balls));
        let own = own.into_iter().chain(centrifugal_left_out(&placed.scene, &state.balls));
        warnings.extend(named(placed, own));
    }
    Ok(warnings)
}

/// Returns an error if a section is tilted from its body beyond the range of linear bending.
fn refuse_bent(
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Result<(), Box<dyn Error>> {
    for (body, own) in assembly.bodies.iter().zip(&solution.coordinates) {
        let Place::Section(of) = &body.place else { continue };
        let whole = &solution.coordinates[assembly.shafts[of.shaft].body];
        let tilt = libm::hypot(own[3] - whole[3], own[4] - whole[4]);
        if tilt > FARTHEST_BENT {
            return Err(format!(
                "the section of {} is tilted by {:.1} deg from its body. Allowed: up to {:.1} deg, because bending is linear. Hint: check loads and their units",
                body.name,
                tilt.to_degrees(),
                FARTHEST_BENT.to_degrees()
            )
            .into());
        }
    }
    Ok(())
}

fn at_rest(scene: &Scene, balls: &[BallState]) -> ContactExtremes {
    let geometry = &scene.geometry;
    let grooves = [geometry.inner.groove_radius, geometry.outer.groove_radius];
    let mut seen = ContactExtremes::default();
    let reversed =
        |contact: &ContactState| contact.normal_load > 0.0 && contact.contact_angle < -BOTTOM;
    for (ball, state) in balls.iter().enumerate() {
        for (side, contact) in [&state.inner, &state.outer].into_iter().enumerate() {
            update_largest(&mut seen.loads[side], contact.normal_load, ball);
            let angle = contact.contact_angle.abs();
            if contact.normal_load > 0.0
                && update_largest(
                    &mut seen.edges[side],
                    angle + contact.semi_major / grooves[side],
                    ball,
                )
            {
                seen.edge_angles[side] = angle;
            }
        }
        if reversed(&state.inner) || reversed(&state.outer) {
            seen.reversed.push(ball + 1);
        }
    }
    seen
}

pub fn of_run(scene: &AssemblyScene, session: &Session) -> Vec<Warning> {
    let mut warnings = of_bushings(scene);
    if let Some(simulation) = session.motion.bearing() {
        let bearings = simulation.system.assembly.bearings.iter().zip(&simulation.extremes);
        for (placed, (bearing, extremes)) in scene.bearings.iter().zip(bearings) {
            let contacts = [&bearing.inner_contact, &bearing.outer_contact];
            let own = shared(placed, contacts, &in_motion(bearing, extremes));
            warnings.extend(named(placed, own.into_iter()));
        }
    }
    warnings.extend(between_rows(scene, session.clock.row_interval()));
    warnings.extend(bushing_warnings::of_run(scene, session));
    warnings
}

fn named<'w>(
    placed: &'w PlacedBearing,
    warnings: impl Iterator<Item = Warning> + 'w,
) -> impl Iterator<Item = Warning> + 'w {
    let name = placed.name.as_ref().map_or(String::new(), |name| format!("bearing {name}: "));
    warnings.map(move |warning| warning.named(&name))
}

fn in_motion(problem: &Bearing, extremes: &Extremes) -> ContactExtremes {
    let races = extremes.races.iter().filter(|race| race.reversed.value > BOTTOM);
    let mut reversed: Vec<usize> = races.map(|race| race.reversed.ball + 1).collect();
    reversed.sort_unstable();
    reversed.dedup();
    ContactExtremes {
        loads: extremes.races.map(|race| race.load),
        edges: extremes.races.map(|race| race.edge),
        edge_angles: extremes.races.map(|race| race.edge_angle),
        reversed,
        between: extremes.between_balls,
        between_pressure: problem.ball_contact.map_or(0.0, |law| {
            peak_pressure(&law, problem.geometry.ball_radius, extremes.between_balls.value)
        }),
        in_run: true,
    }
}

/// Updates `largest`; returns whether `value` is larger.
fn update_largest(largest: &mut Extreme, value: f64, ball: usize) -> bool {
    let larger = value > largest.value;
    if larger {
        *largest = Extreme { value, ball, time: 0.0 };
    }
    larger
}

fn shared(
    placed: &PlacedBearing,
    contacts: [&HertzContact; 2],
    seen: &ContactExtremes,
) -> Vec<Warning> {
    let scene = &placed.scene;
    let all = [
        on_open_side(placed, seen),
        past_shoulder(scene, seen),
        above_rating(scene, contacts, seen),
    ];
    all.into_iter().flatten().collect()
}

fn above_rating(
    scene: &Scene,
    contacts: [&HertzContact; 2],
    seen: &ContactExtremes,
) -> Option<Warning> {
    let pressure =
        |side: usize| contact_ellipse(contacts[side], seen.loads[side].value).peak_pressure;
    let side = if pressure(1) > pressure(0) { 1 } else { 0 };
    let between = seen.between_pressure > pressure(side);
    let (highest, of, where_) = match between {
        true => (seen.between_pressure, &seen.between, " between two balls"),
        false => (pressure(side), &seen.loads[side], ""),
    };
    let advice = match between && matches!(scene.dynamics.cage, CageInRun::LeftOut(_)) {
        true => "add [bearing.cage], because nothing else keeps the balls apart",
        false => "check loads, speeds, clearance and their units",
    };
    (highest > STATIC_RATING).then(|| {
        let text = format!(
            "contact pressure {:.0} MPa{where_}{} exceeds the 4200 MPa of ISO 76: {advice}",
            1e-6 * highest,
            seen.when(of)
        );
        Warning::new(WarningCode::PressureAboveRating, text)
    })
}

/// Load on the open side of an angular-contact bearing. The groove of the model is a full torus and
/// supports loads on either side.
fn on_open_side(placed: &PlacedBearing, seen: &ContactExtremes) -> Option<Warning> {
    if placed.scene.geometry.contact_angle <= 0.0 || seen.reversed.is_empty() {
        return None;
    }
    let numbers: Vec<String> = seen.reversed.iter().map(usize::to_string).collect();
    let text = format!(
        "ball{} {} loaded at a negative contact angle, where an angular-contact bearing has no shoulder: preload it along {}x",
        if numbers.len() == 1 { "" } else { "s" },
        numbers.join(", "),
        if placed.reversed { '-' } else { '+' }
    );
    Some(Warning::new(WarningCode::LoadOnOpenSide, text))
}

/// Angle of each race's shoulder from the bottom of its groove, rad, and whether the scene gives it.
fn shoulders(scene: &Scene) -> [(f64, bool); 2] {
    let sizes = &scene.dimensions;
    let races = [&sizes.inner_race, &sizes.outer_race];
    std::array::from_fn(|side| {
        let (race, shoulder) = (races[side], &scene.dynamics.shoulders[side]);
        let height = (shoulder.radius - race.radius).abs();
        let end = libm::acos((1.0 - height / race.groove_radius).max(-1.0));
        let nominal = scene.geometry.contact_angle;
        let usual = if nominal > 0.0 { end.max(nominal + BEYOND_NOMINAL) } else { end };
        (if shoulder.given { end } else { usual }, shoulder.given)
    })
}

/// Contact ellipse past the shoulder, which the groove of the model does not have.
fn past_shoulder(scene: &Scene, seen: &ContactExtremes) -> Option<Warning> {
    let ends = shoulders(scene);
    let past = |side: usize| seen.edges[side].value - ends[side].0;
    let side = if past(1) > past(0) { 1 } else { 0 };
    if past(side).is_nan() || past(side) <= 0.0 {
        return None;
    }
    let (edge, race) = (&seen.edges[side], ["inner", "outer"][side]);
    let (source, advice) = match ends[side].1 {
        true => ("given", String::new()),
        false => ("estimated", format!(", or give bearing.{race}_race.shoulder_radius")),
    };
    let text = format!(
        "the contact of ball {} with the {race} race reaches {} from the bottom of the groove{} (contact angle {:.1} deg), past the shoulder at \
         {:.1} deg ({source}): reduce load or tilt{advice}",
        edge.ball + 1,
        if edge.value < 0.5 * PI {
            format!("{:.1} deg", edge.value.to_degrees())
        } else {
            "more than 90 deg".into()
        },
        seen.when(edge),
        seen.edge_angles[side].to_degrees(),
        ends[side].0.to_degrees()
    );
    Some(Warning::new(WarningCode::ContactPastShoulder, text))
}

fn centrifugal_left_out(scene: &Scene, balls: &[BallState]) -> Option<Warning> {
    let speed = orbital_speed(scene);
    if scene.centrifugal || speed == 0.0 {
        return None;
    }
    let force = ball_mass(scene) * speed * speed * scene.geometry.pitch_radius;
    let loads = balls.iter().map(|ball| ball.inner.normal_load.max(ball.outer.normal_load));
    let largest = loads.fold(0.0, f64::max);
    // False for NaN.
    (force > CENTRIFUGAL * largest).then(|| {
        let part = if largest > 0.0 {
            format!("{:.1} % of the largest ball load", 100.0 * force / largest)
        } else {
            "while no ball is loaded".into()
        };
        let text = format!(
            "the centrifugal force of a ball at this speed, {force:.3} N, is left out, {part}: write ball_forces.centrifugal = true"
        );
        Warning::new(WarningCode::CentrifugalForceLeftOut, text)
    })
}

/// Output interval too long for the fastest excitation, which appears aliased in the rows.
fn between_rows(scene: &AssemblyScene, interval: f64) -> Option<Warning> {
    let end = scene.run().map_or(0.0, |run| run.end);
    let turning = |rotation: &Rotation, unbalanced: bool| match rotation {
        Rotation::Speed(speed) if unbalanced => largest(speed, end) / TAU,
        _ => 0.0,
    };
    // Ball passing matters for spectra only.
    let spectra = scene.common().dynamics.plots.contains(&RunPlot::Spectrum);
    let driven =
        excitations(scene).into_iter().filter(|of| of.repeats && (spectra || !of.is_ripple));
    let driven = driven.map(|of| (of.what, of.frequency));
    let bodies = scene.bodies.iter().map(|body| {
        let along = body.beam.iter().flat_map(|beam| &beam.unbalances);
        let unbalanced = body.unbalance != 0.0 || along.clone().any(|(_, size, _)| *size != 0.0);
        let frequency = turning(&body.race.rotation, unbalanced);
        (format!("the unbalance of body.{}", body.name), frequency)
    });
    let races = scene.bearings.iter().map(|placed| {
        let of = &placed.scene.dynamics;
        let frequency = turning(&of.inner.rotation, of.unbalance != 0.0);
        ("the unbalance of the inner race".to_string(), frequency)
    });
    let all = driven.chain(bodies).chain(races);
    let (what, frequency) = all.max_by(|a, b| a.1.total_cmp(&b.1))?;
    aliased(&what, frequency, interval)
}

/// Warning if an excitation of `frequency` (Hz) has fewer than two rows, `interval` (s) apart, in a period.
pub fn aliased(what: &str, frequency: f64, interval: f64) -> Option<Warning> {
    let resolved = frequency * interval <= 0.5;
    (!resolved).then(|| {
        let text = format!(
            "rows are {} s apart, more than half a period of {what} ({} Hz): shorten numerics.output_interval, {} s for eight rows a period",
            to_digits(interval, 3),
            to_digits(frequency, 4),
            to_digits(0.125 / frequency, 2)
        );
        Warning::new(WarningCode::RowsTooFarApart, text)
    })
}

/// Warnings about bushings that do not depend on a solution.
pub fn of_bushings(scene: &AssemblyScene) -> Vec<Warning> {
    let in_steps = scene.springs.iter().filter(|spring| {
        let elements = spring.bushing.as_ref().and_then(|of| of.elements.as_ref());
        elements.is_some_and(|of| matches!(of.stepping, BushingStepping::Explicit { .. }))
    });
    let locking = in_steps.map(|spring| {
        let text = format!(
            "bushing {} is solved in four-node elements, which are stiffer than its rubber: compare with finer cells, or write method = \
             \"implicit\"",
            spring.name
        );
        Warning::new(WarningCode::FourNodeLocking, text)
    });
    faster_than_fitted(scene).into_iter().chain(locking).collect()
}

fn faster_than_fitted(scene: &AssemblyScene) -> Option<Warning> {
    let fitted = scene.springs.iter().filter_map(|spring| Some((spring, spring.bushing.as_ref()?)));
    let fitted = fitted.filter(|(_, bushing)| bushing.elements.is_none());
    let (spring, bushing) = fitted.min_by(|a, b| a.1.fastest.total_cmp(&b.1.fastest))?;
    let driven = excitations(scene).into_iter().filter(|of| of.repeats);
    let fast = driven.max_by(|a, b| a.frequency.total_cmp(&b.frequency))?;
    (fast.frequency > bushing.fastest).then(|| {
        let text = format!(
            "{} ({} Hz) is above the {} Hz up to which the springs of bushing {} are fitted: raise spring.{}.bushing.fastest",
            fast.what,
            to_digits(fast.frequency, 4),
            to_digits(bushing.fastest, 4),
            spring.name,
            spring.name
        );
        Warning::new(WarningCode::ExcitationFasterThanFit, text)
    })
}
