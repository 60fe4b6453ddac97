//! What a reader should know of what the scene asks for, whatever the numbers turn out to be: of its shafts, springs and
//! given motions.

use bearing_dynamics::ch3_bushing::dent::Dent;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::scene::assembly::{AssemblyScene, Carrier, SceneBody, Spring, SpringAt};
use bearing_dynamics::scene::excitations::{driven, excitations, largest};
use bearing_dynamics::scene::housing::{FitSize, HousingMethod};
use bearing_dynamics::scene::statics::orbital_speed;
use bearing_dynamics::scene::{RunPlot, Scene};
use bearing_dynamics::solver::clock::{to_digits, told};
use bearing_dynamics::solver::dynamics::connection::uneven;
use bearing_dynamics::solver::dynamics::model::{Drive, RaceBody, Rotation};
use bearing_dynamics::solver::dynamics::run::Start;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::statics::COORDINATE_NAMES;
use std::f64::consts::TAU;

/// Shafts of tetrahedra.
pub fn of_shafts(scene: &AssemblyScene) -> Vec<String> {
    let said = |body: &SceneBody| {
        let mesh = body.beam.as_ref()?.beam.mesh?;
        let nodes = if mesh.order == Order::Linear { "four" } else { "ten" };
        let solved = match body.beam.as_ref()?.in_elements {
            None => "condensed onto its sections; it moves in shapes, no element takes steps".into(),
            Some(_) => format!(
                "in explicit steps in a run; in equilibria and `modes` condensed onto its sections{}",
                blows(scene, body).map_or(String::new(), |all| {
                    format!(
                        ". A run starts straight, so that {all} strike it at the start: what grows from nothing (`smooth_ramp`) does not"
                    )
                })
            ),
        };
        Some(format!(
            "the segments of body.{} are {nodes}-node tetrahedra ({} cells around, {} in the ring about the core), {solved}",
            body.name, mesh.around, mesh.radial
        ))
    };
    scene.bodies.iter().filter_map(said).collect()
}

/// Shafts that are thicker than the groove of an inner race on them.
pub fn too_thick(scene: &AssemblyScene) -> impl Iterator<Item = String> {
    scene.bearings.iter().filter_map(|placed| {
        let Carrier::Body { index, at } = placed.carriers[0] else { return None };
        let body = &scene.bodies[index];
        let beam = body.beam.as_ref()?;
        let mut end = beam.start;
        let here = beam.beam.segments.iter().filter(|segment| {
            let start = end;
            end += segment.length;
            start <= at && at <= end
        });
        // At a shoulder the race may sit on the thinner side.
        let diameter = here.map(|segment| segment.outer_diameter).reduce(f64::min)?;
        let groove = 2.0 * placed.scene.geometry.race_radii().0;
        (diameter > groove).then(|| {
            let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
            format!(
                "body.{} is {} mm thick where the inner race{of} sits, whose groove has a diameter of {} mm: it does not go through; check \
                 segments, `inner_at` and their units",
                body.name,
                told(1e3 * diameter),
                told(1e3 * groove)
            )
        })
    })
}

/// What a shaft that starts straight meets at once.
fn blows(scene: &AssemblyScene, body: &SceneBody) -> Option<String> {
    let beam = body.beam.as_ref()?;
    let gravity = scene.common().gravity != [0.0; 3];
    let loads = beam.loads.iter().flat_map(|(_, force)| force).any(|force| force.value(0.0) != 0.0);
    let turns = matches!(&body.race.rotation, Rotation::Speed(speed) if speed.value(0.0) != 0.0);
    let unbalances = turns && beam.unbalances.iter().any(|(_, size, _)| *size != 0.0);
    let all = [
        (gravity, "gravity"),
        (loads, "loads that are there at t = 0"),
        (unbalances, "unbalances at the speed of the start"),
    ];
    let all: Vec<&str> = all.iter().filter(|(is, _)| *is).map(|(_, what)| *what).collect();
    (!all.is_empty()).then(|| all.join(", "))
}

/// Springs whose axes turn with the body that they begin at, and that are not the same along all of them.
pub fn of_springs(scene: &AssemblyScene) -> Vec<String> {
    let turning = |rotation: &Rotation| match rotation {
        Rotation::Speed(speed) => *speed != Profile::ZERO,
        Rotation::Torque(_) => true,
    };
    let turns = |at: SpringAt| match at {
        SpringAt::Ground => false,
        SpringAt::Body(body) => turning(&scene.bodies[body].race.rotation),
        SpringAt::Race { bearing, side } => {
            let of = &scene.bearings[bearing].scene.dynamics;
            let race = if side == 0 { Some(&of.inner) } else { of.outer.as_ref() };
            race.is_some_and(|race| turning(&race.rotation))
        }
    };
    let bare = |name: &str| name.trim_start_matches("body.").to_string();
    let said = |spring: &Spring| {
        let [from, to] = spring.ends.map(|end| end.at);
        let uneven_element = spring.maxwell.iter().any(|element| uneven(&element.stiffness));
        let alike = !uneven(&spring.stiffness) && !uneven(&spring.damping) && !uneven_element;
        if alike || !turns(from) {
            return None;
        }
        let [body, end] = [from, to].map(|at| scene.name_of_end(at));
        let advice = if turns(to) {
            "both ends turn: make it alike along y and z".to_string()
        } else {
            format!(
                "for axes that stand still write from = {:?}, to = {:?}",
                bare(&end),
                bare(&body)
            )
        };
        Some(format!(
            "spring {} turns with {body}, where it begins: its axes are those of that body, and what it does along \
             y differs from along z, so that its force goes round with the body; {advice}",
            spring.name
        ))
    };
    scene.springs.iter().filter_map(said).collect()
}

/// Races that a run begins in their whole fit while the housing has given way nowhere.
pub fn sudden_fits(scene: &AssemblyScene) -> impl Iterator<Item = String> {
    let nominal = scene.run().is_some_and(|run| run.options.start == Start::Nominal);
    let bearings = scene.bearings.iter().filter(move |_| nominal);
    bearings.filter_map(|placed| {
        let settings = &placed.housing.as_ref()?.settings;
        let sudden = settings.method == HousingMethod::Reduced && settings.fit_ramp.is_none();
        let strikes = match settings.fit {
            FitSize::Interference(fit) if fit <= 0.0 => return None,
            FitSize::Interference(_) => "an interference strikes race and housing at the start",
            // Only the mesh knows the bore, and a clearance strikes nothing.
            FitSize::OuterRadius(_) => {
                "where housing.outer_radius is more than the bore's, the interference strikes race and housing at the start"
            }
        };
        let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
        sudden.then(|| {
            format!(
                "the outer race{of} is in its whole fit at once (numerics.start = \"nominal\", no housing.fit_ramp): \
                 {strikes}; let it grow in by housing.fit_ramp, or start in equilibrium"
            )
        })
    })
}

/// Loads that change from t = 0 on where a run starts with the velocity of its equilibrium.
pub fn moving_starts(scene: &AssemblyScene) -> Option<String> {
    let turns = scene.bearings.iter().any(|placed| orbital_speed(&placed.scene) != 0.0);
    // Equilibria that follow each other have no velocity.
    let mut housings = scene.bearings.iter().filter_map(|placed| placed.housing.as_ref());
    let still = housings.any(|of| of.settings.method == HousingMethod::QuasiStatic);
    let nominal = scene.run().is_none_or(|run| run.options.start != Start::Equilibrium);
    if !turns || still || nominal {
        return None;
    }
    let changing = |(key, race): (String, &RaceBody)| {
        let mut loads = race.drives.iter().zip(COORDINATE_NAMES);
        loads.find_map(|(drive, coordinate)| match drive {
            Drive::Load(load) if load.rate(0.0) != 0.0 => Some(format!("{key}.{coordinate}")),
            _ => None,
        })
    };
    let first = driven(scene).find_map(changing)?;
    Some(format!(
        "the load {first} changes from t = 0 on: the run starts with the velocity at which its equilibrium moves on then, a blow where the load \
         has just begun; to start at rest let it begin later (`start`) or smoothly (`smooth_ramp`), or write numerics.start = \"nominal\""
    ))
}

/// Rows that are too far apart for what drives the scene: what they show of it is folded to other frequencies.
pub fn between_rows(scene: &AssemblyScene, interval: f64) -> Option<String> {
    let end = scene.run().map_or(0.0, |run| run.end);
    let turning = |rotation: &Rotation, unbalanced: bool| match rotation {
        Rotation::Speed(speed) if unbalanced => largest(speed, end) / TAU,
        _ => 0.0,
    };
    // Balls that pass are seen where spectra are looked at.
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
        (
            "the unbalance of the inner race".to_string(),
            turning(&of.inner.rotation, of.unbalance != 0.0),
        )
    });
    let all = driven.chain(bodies).chain(races);
    let (what, frequency) = all.max_by(|a, b| a.1.total_cmp(&b.1))?;
    folded(&what, frequency, interval)
}

/// Of something with a frequency (Hz), and rows that are `interval` s apart.
pub fn folded(what: &str, frequency: f64, interval: f64) -> Option<String> {
    let seen = frequency * interval <= 0.5;
    (!seen).then(|| {
        format!(
            "rows are {} s apart, more than half a period of {what} ({} Hz): means, swings and spectra of rows may be none of \
             the motion's; write numerics.output_interval, {} s for eight rows a period",
            to_digits(interval, 3),
            to_digits(frequency, 4),
            to_digits(0.125 / frequency, 2)
        )
    })
}

/// Half of the width of a usual contact along the rolling direction, in parts of the ball's radius, and more than half of its
/// length across the groove.
const HALF_CONTACT: f64 = 0.02;
const HALF_LENGTH: f64 = 0.25;

/// Balls that stand on a dent where a run begins in the equilibrium of races that have none.
pub fn on_dents(scene: &AssemblyScene) -> Vec<String> {
    let in_equilibrium = scene.run().is_some_and(|run| run.options.start == Start::Equilibrium);
    let bearings = scene.bearings.iter().filter(|_| in_equilibrium);
    let mut said = Vec::new();
    for placed in bearings {
        let Scene { geometry, dynamics, ball_phase, .. } = &placed.scene;
        let near = |dent: &&Dent| {
            let out = if dent.side == 0 { -geometry.ball_radius } else { geometry.ball_radius };
            let radius = geometry.pitch_radius + out;
            let reach = dent.shape.reach() + HALF_CONTACT * geometry.ball_radius;
            let away = |azimuth: f64| radius * libm::remainder(azimuth - dent.angle, TAU).abs();
            // On the side that a positive contact angle has.
            let side = if dent.side == 0 { -1.0 } else { 1.0 };
            let groove = [&geometry.inner, &geometry.outer][dent.side].groove_radius;
            let beside = groove * (dent.groove_angle - side * geometry.contact_angle).abs();
            let met = beside <= dent.shape.reach() + HALF_LENGTH * geometry.ball_radius;
            !dent.shape.vanishes()
                && met
                && geometry.azimuths(*ball_phase).into_iter().any(|at| away(at) <= reach)
        };
        let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
        said.extend(dynamics.dents.iter().filter(near).map(|dent| {
            format!(
                "a ball stands at the dent of the {} race{of} at {:.3} deg when the run begins, in the equilibrium of races that \
                 have no dents: the first moments are the blow of its sinking in, which nothing real makes; begin with the ball \
                 beside it (bearing.ball_phase) or leave them out (output.window_start)",
                ["inner", "outer"][dent.side],
                dent.angle.to_degrees()
            )
        }));
    }
    said
}

/// Outer races that turn as they are told, whatever acts on them.
pub fn turning_races(scene: &AssemblyScene) -> impl Iterator<Item = String> {
    scene.bearings.iter().filter_map(|placed| {
        let outer = placed.scene.dynamics.outer.as_ref()?;
        let turns = matches!(&outer.rotation, Rotation::Speed(speed) if !speed.is_zero());
        let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
        turns.then(|| {
            format!(
                "the outer race{of} turns about its axis at the speed that is given, which nothing that acts on it \
                 changes; write motion = \"6-dof\" for a race that moments turn"
            )
        })
    })
}

/// Springs and foundations of which an equilibrium knows a part only.
pub fn at_rest(scene: &AssemblyScene) -> impl Iterator<Item = String> {
    let bodies = scene.bodies.iter().map(|body| (format!("body {}", body.name), &body.race));
    let races = scene.bearings.iter().filter_map(|placed| {
        let name = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
        Some((format!("the outer race{name}"), placed.scene.dynamics.outer.as_ref()?))
    });
    let damped = bodies.chain(races).filter(|(_, race)| race.foundation_damping != [0.0; 5]);
    let foundations =
        damped.map(|(of, _)| format!("foundation of {of}: its dashpots push nothing at rest"));
    let springs = scene.springs.iter().filter_map(|Spring { name, damping, maxwell, .. }| {
        let slowest = maxwell.iter().map(|element| element.relaxation_time).fold(0.0, f64::max);
        match (*damping != [0.0; 6], slowest > 0.0) {
            (_, true) => Some(format!(
                "spring {name}: its Maxwell elements have relaxed, as they have some {} s after the last change; \
                 dashpots push nothing at rest",
                to_digits(slowest, 3)
            )),
            (true, false) => Some(format!("spring {name}: its dashpots push nothing at rest")),
            (false, false) => None,
        }
    });
    let in_elements = scene
        .springs
        .iter()
        .filter(|spring| spring.bushing.as_deref().is_some_and(|of| of.elements.is_some()));
    let in_elements = in_elements.map(|spring| {
        format!(
            "bushing {}: its fitted springs stand for its elements here; a run starts where the elements are in equilibrium",
            spring.name
        )
    });
    springs.chain(foundations).chain(in_elements)
}
