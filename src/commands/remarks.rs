//! What a reader of the numbers should know: one set of remarks for equilibrium and motion.

use crate::commands::scene_remarks::{at_rest, moving_starts, of_springs, on_dents, sudden_fits};
use crate::commands::size_remarks::{of_bearing, of_sizes};
use bearing_dynamics::ch2_housing::bearing::ball_contact::peak_pressure;
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use bearing_dynamics::scene::assembly::{AssemblyScene, PlacedBearing, SceneBody, Spring};
use bearing_dynamics::scene::statics::{ball_mass, orbital_speed};
use bearing_dynamics::scene::{CageInRun, Scene};
use bearing_dynamics::solver::clock::told;
use bearing_dynamics::solver::dynamics::assembly::Bearing;
use bearing_dynamics::solver::dynamics::bounds::FARTHEST_BENT;
use bearing_dynamics::solver::dynamics::connection::Connection;
use bearing_dynamics::solver::dynamics::extremes::{Extreme, Extremes};
use bearing_dynamics::solver::dynamics::model::Rotation;
use bearing_dynamics::solver::dynamics::race::{self, mounted};
use bearing_dynamics::solver::dynamics::run::Simulation;
use bearing_dynamics::solver::static_assembly::{Place, StaticAssembly};
use bearing_dynamics::solver::static_tables::BearingState;
use bearing_dynamics::solver::statics::{AssemblySolution, BallState, ContactState, Determinacy};

/// Pressure above which ISO 76 counts on lasting dents in ball bearings, Pa.
const STATIC_RATING: f64 = 4200e6;
/// A ball this close to the bottom of the groove, in rad, needs no shoulder.
const BOTTOM: f64 = 1e-6;
/// How far beyond the nominal contact angle, rad, shoulders that are not given reach at least in an
/// angular-contact bearing.
const BEYOND_NOMINAL: f64 = 15.0 / 180.0 * std::f64::consts::PI;
/// Elastic deflections are hundredths of a ball radius.
const FAR: f64 = 0.1;
/// Traction that a gyroscopic moment asks for, as a part of the load, from which on it is worth a word.
const GYROSCOPIC: f64 = 0.01;
/// Centrifugal force on a ball, as a part of the largest ball load, from which on leaving it out is worth a word.
const CENTRIFUGAL: f64 = 0.05;

/// Part of a bushing's wall that small displacements are far beyond.
const FAR_IN_WALL: f64 = 0.3;

/// What remarks are made of; times are those of a run, s.
#[derive(Clone, Debug, Default)]
struct Seen {
    /// Inner, outer: largest load, N; farthest end of a contact ellipse and the contact angle there, rad.
    loads: [Extreme; 2],
    edges: [Extreme; 2],
    edge_angles: [f64; 2],
    /// Balls loaded at a negative contact angle, counted from 1.
    reversed: Vec<usize>,
    /// Centre of the inner race from that of the outer one, m.
    apart: Extreme,
    /// Load between two balls, N, and its pressure, Pa.
    between: Extreme,
    between_pressure: f64,
    moves: bool,
}

impl Seen {
    fn when(&self, of: &Extreme) -> String {
        if self.moves { format!(" at t = {} s", told(of.time)) } else { String::new() }
    }
}

/// Of an equilibrium of a bearing alone.
pub fn of_statics(
    scene: &Scene,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Vec<String> {
    let mut remarks = of_bearing(scene);
    if let Determinacy::Indeterminate { free_directions } = &solution.determinacy {
        remarks.push(format!(
            "indeterminate: {} of the race's directions meet no stiffness, the position shown is one \
             of many; load the bearing, preload it, or hold these coordinates",
            free_directions.len()
        ));
    }
    if solution.saddles_left > 0 {
        remarks.push(
            "the symmetric position is unstable and was left; its mirror image is an equilibrium too"
                .into(),
        );
    }
    for (bearing, state) in assembly.bearings.iter().zip(&solution.bearings) {
        let contacts = [&bearing.inner_contact, &bearing.outer_contact];
        remarks.extend(of_balls(scene, &Still::new(contacts, state)));
        remarks.extend(without_loads_of_runs(scene, &state.balls, !assembly.seats.is_empty()));
    }
    remarks
}

/// Of an equilibrium of several bodies.
pub fn of_assembly(
    scene: &AssemblyScene,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Vec<String> {
    let mut remarks = of_sizes(scene);
    remarks.extend(of_springs(scene));
    remarks.extend(at_rest(scene));
    if let Determinacy::Indeterminate { free_directions } = &solution.determinacy {
        remarks.push(format!(
            "indeterminate: {} directions of the bodies meet no stiffness, the position shown is one of many; \
             load the bearings, preload them, or hold these coordinates",
            free_directions.len()
        ));
    }
    remarks.extend(bent_far(assembly, solution));
    remarks.extend(without_unbalances(scene, solution));
    remarks.extend(pressed_through(scene, assembly, solution));
    if solution.saddles_left > 0 {
        remarks.push(
            "an unstable position was left for one beside it; its mirror image is an equilibrium too".into(),
        );
    }
    for ((placed, bearing), state) in
        scene.bearings.iter().zip(&assembly.bearings).zip(&solution.bearings)
    {
        let still = Still::new([&bearing.inner_contact, &bearing.outer_contact], state);
        remarks.extend(named(placed, of_balls(&placed.scene, &still)));
    }
    remarks
}

/// Of motions about an equilibrium: what speed does to balls and is not in it.
pub fn of_balls_at_speed(scene: &AssemblyScene, solution: &AssemblySolution) -> Vec<String> {
    let bearings = scene.bearings.iter().zip(&solution.bearings);
    let said = bearings.map(|(placed, state)| {
        let own = [
            gyroscopic(&placed.scene, &state.balls),
            without_centrifugal(&placed.scene, &state.balls),
        ];
        named(placed, own.into_iter().flatten().collect())
    });
    said.flatten().collect()
}

/// The section that is turned most against its body, where that is more than small bending stands for.
fn bent_far(assembly: &StaticAssembly, solution: &AssemblySolution) -> Option<String> {
    let turned = |body: usize| {
        let Place::Section(of) = &assembly.bodies[body].place else { return None };
        let [own, whole] = [body, assembly.shafts[of.shaft].body].map(|i| solution.coordinates[i]);
        Some((libm::hypot(own[3] - whole[3], own[4] - whole[4]), &assembly.bodies[body].name))
    };
    let all = (0..assembly.bodies.len()).filter_map(turned);
    let (turn, section) = all.max_by(|a, b| a.0.total_cmp(&b.0))?;
    (turn > FARTHEST_BENT).then(|| {
        format!(
            "the section of {section} is turned by {:.1} deg against its body: bending is of small turns, up to {:.0} deg, a run \
             would end here; check loads and their units",
            turn.to_degrees(),
            FARTHEST_BENT.to_degrees()
        )
    })
}

/// A bearing in equilibrium.
struct Still<'s> {
    contacts: [&'s HertzContact; 2],
    balls: &'s [BallState],
    /// Centres of the races, m.
    apart: f64,
}

impl<'s> Still<'s> {
    fn new(contacts: [&'s HertzContact; 2], state: &'s BearingState) -> Still<'s> {
        let [inner, outer] = state.centres;
        Still { contacts, balls: &state.balls, apart: (inner - outer).norm() }
    }
}

fn of_balls(scene: &Scene, still: &Still) -> Vec<String> {
    let geometry = &scene.geometry;
    let grooves = [geometry.inner.groove_radius, geometry.outer.groove_radius];
    let mut seen = Seen::default();
    let reversed =
        |contact: &ContactState| contact.normal_load > 0.0 && contact.contact_angle < -BOTTOM;
    for (ball, state) in still.balls.iter().enumerate() {
        for (side, contact) in [&state.inner, &state.outer].into_iter().enumerate() {
            take(&mut seen.loads[side], contact.normal_load, ball);
            let angle = contact.contact_angle.abs();
            if contact.normal_load > 0.0
                && take(&mut seen.edges[side], angle + contact.semi_major / grooves[side], ball)
            {
                seen.edge_angles[side] = angle;
            }
        }
        if reversed(&state.inner) || reversed(&state.outer) {
            seen.reversed.push(ball + 1);
        }
    }
    seen.apart.value = still.apart;
    let mut remarks = shared(scene, still.contacts, &seen);
    remarks.extend(gyroscopic(scene, still.balls));
    remarks.extend(without_centrifugal(scene, still.balls));
    if !scene.dynamics.dents.is_empty() {
        remarks.push(
            "dents are left out: an equilibrium has races without them, a run does not".into(),
        );
    }
    remarks
}

/// Of a run: of every step so far.
pub fn of_run(scene: &AssemblyScene, simulation: &Simulation) -> Vec<String> {
    let bearings = simulation.system.assembly.bearings.iter().zip(&simulation.extremes);
    let each = scene.bearings.iter().zip(bearings).map(|(placed, (bearing, extremes))| {
        named(placed, of_moving(&placed.scene, bearing, extremes))
    });
    let of_scene = of_sizes(scene).into_iter().chain(of_springs(scene)).chain(on_dents(scene));
    let of_scene = of_scene.chain(sudden_fits(scene));
    let of_scene = of_scene.chain(moving_starts(scene));
    of_scene.chain(each.flatten()).collect()
}

/// With the name of the bearing that they are about.
fn named(placed: &PlacedBearing, remarks: Vec<String>) -> Vec<String> {
    match &placed.name {
        None => remarks,
        Some(name) => remarks.iter().map(|said| format!("bearing {name}: {said}")).collect(),
    }
}

fn of_moving(scene: &Scene, problem: &Bearing, extremes: &Extremes) -> Vec<String> {
    let mut reversed: Vec<usize> = extremes
        .races
        .iter()
        .filter(|race| race.reversed.value > BOTTOM)
        .map(|race| race.reversed.ball + 1)
        .collect();
    reversed.sort_unstable();
    reversed.dedup();
    let seen = Seen {
        loads: extremes.races.map(|race| race.load),
        edges: extremes.races.map(|race| race.edge),
        edge_angles: extremes.races.map(|race| race.edge_angle),
        reversed,
        apart: extremes.apart,
        between: extremes.between_balls,
        between_pressure: problem.ball_contact.map_or(0.0, |law| {
            peak_pressure(&law, problem.geometry.ball_radius, extremes.between_balls.value)
        }),
        moves: true,
    };
    shared(scene, [&problem.inner_contact, &problem.outer_contact], &seen)
}

/// Whether `value` is the largest so far.
fn take(largest: &mut Extreme, value: f64, ball: usize) -> bool {
    let larger = value > largest.value;
    if larger {
        *largest = Extreme { value, ball, time: 0.0 };
    }
    larger
}

/// Remarks that equilibrium and motion have in common.
fn shared(scene: &Scene, contacts: [&HertzContact; 2], seen: &Seen) -> Vec<String> {
    let mut remarks = Vec::new();
    remarks.extend(without_shoulder(scene, seen));
    remarks.extend(over_the_edge(scene, seen));
    let pressure =
        |side: usize| contact_ellipse(contacts[side], seen.loads[side].value).peak_pressure;
    let side = if pressure(1) > pressure(0) { 1 } else { 0 };
    let between = seen.between_pressure > pressure(side);
    let (highest, of, where_) = match between {
        true => (seen.between_pressure, &seen.between, " between two balls"),
        false => (pressure(side), &seen.loads[side], ""),
    };
    if highest > STATIC_RATING {
        remarks.push(format!(
            "a contact pressure of {:.0} MPa{where_}{} is above the 4200 MPa at which ISO 76 counts on lasting \
             dents; the model is elastic: check loads, speeds, clearance and their units{}",
            1e-6 * highest,
            seen.when(of),
            if between && matches!(scene.dynamics.cage, CageInRun::LeftOut(_)) {
                "; without [bearing.cage] nothing keeps balls apart, and they drift together"
            } else {
                ""
            }
        ));
    }
    remarks.extend(far_apart(scene, seen));
    remarks
}

/// An angular-contact bearing has a shoulder on one side of each groove only; the model's groove is
/// a whole torus and carries on either side.
fn without_shoulder(scene: &Scene, seen: &Seen) -> Option<String> {
    if scene.geometry.contact_angle <= 0.0 || seen.reversed.is_empty() {
        return None;
    }
    let numbers: Vec<String> = seen.reversed.iter().map(usize::to_string).collect();
    Some(format!(
        "ball{} {} loaded at a negative contact angle, on the side of the groove where an \
         angular-contact bearing has no shoulder; the real bearing would come apart or a ball \
         ride the edge: preload it along +x",
        if numbers.len() == 1 { "" } else { "s" },
        numbers.join(", ")
    ))
}

/// Where the groove of each race ends, rad from its bottom, and whether the scene says so.
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

/// The model's groove has no shoulder; of a contact past the real one's a part is missing.
fn over_the_edge(scene: &Scene, seen: &Seen) -> Option<String> {
    let ends = shoulders(scene);
    let past = |side: usize| seen.edges[side].value - ends[side].0;
    let side = if past(1) > past(0) { 1 } else { 0 };
    if past(side).is_nan() || past(side) <= 0.0 {
        return None;
    }
    let (edge, race) = (&seen.edges[side], ["inner", "outer"][side]);
    let source = match ends[side].1 {
        true => "as given".to_string(),
        false => format!(
            "taken, since bearing.{race}_race.shoulder_radius is not given: a height of 20 % of the ball \
             diameter, and 15 deg past the nominal contact angle at least"
        ),
    };
    Some(format!(
        "the contact of ball {} with the {race} race reaches {} from the bottom of the groove{} \
         (contact angle {:.1} deg), past the shoulder, which ends at {:.1} deg ({source}); the model's \
         groove goes on, the real contact is cut off at the edge",
        edge.ball + 1,
        if edge.value < std::f64::consts::FRAC_PI_2 {
            format!("{:.1} deg", edge.value.to_degrees())
        } else {
            "more than 90 deg".into()
        },
        seen.when(edge),
        seen.edge_angles[side].to_degrees(),
        ends[side].0.to_degrees()
    ))
}

/// Farther apart than clearance and elastic deflection explain.
fn far_apart(scene: &Scene, seen: &Seen) -> Option<String> {
    let ball = scene.geometry.ball_radius;
    let expected = FAR * ball + scene.dimensions.diametral_clearance.max(0.0);
    (seen.apart.value > expected).then(|| {
        format!(
            "the centres of the races are {:.4} mm apart{}, more than a tenth of the ball radius beside \
             the clearance: no elastic deflection of a bearing; check loads, speeds, unbalance and their \
             units, and whether something holds the race along its axis",
            1e3 * seen.apart.value,
            seen.when(&seen.apart)
        )
    })
}

/// Balls that go round a bearing with a contact angle resist the turning of their own axes; equilibrium
/// has no such moment, nor the traction that holds it.
///
/// A ball that rolls on the outer race (speed ω_o) without spin there turns against the cage: the part of that across the
/// bearing's axis, (Ω − ω_o)(R/r) sin α_o, is what the balls' own course turns round at Ω: J |Ω (Ω − ω_o)| (R/r) sin α_o.
fn gyroscopic(scene: &Scene, balls: &[BallState]) -> Option<String> {
    let speed = if scene.centrifugal { orbital_speed(scene) } else { 0.0 };
    let mass = ball_mass(scene);
    if speed == 0.0 || mass == 0.0 {
        return None;
    }
    let g = &scene.geometry;
    let inertia = 0.4 * mass * g.ball_radius * g.ball_radius;
    let past_outer = (speed - scene.outer_speed.unwrap_or(0.0)).abs();
    let (mut largest, mut worst) = (0.0f64, Extreme::default());
    for (number, ball) in balls.iter().enumerate() {
        let outer = &ball.outer;
        let across = past_outer * g.pitch_radius / g.ball_radius * libm::sin(outer.contact_angle);
        let moment = inertia * speed.abs() * across.abs();
        // Both contacts hold it, each as far as its load lets it.
        let loads = ball.inner.normal_load + outer.normal_load;
        if loads > 0.0 {
            largest = largest.max(moment);
            take(&mut worst, moment / (g.ball_radius * loads), number);
        }
    }
    (worst.value > GYROSCOPIC).then(|| {
        format!(
            "equilibrium has no gyroscopic moment of the balls: up to {:.4} N mm here; to hold it takes traction \
             of {:.1} % of the loads of both contacts of ball {}, where that is most, and it moves contact angles and the \
             race; `run` has it",
            1e3 * largest,
            100.0 * worst.value,
            worst.ball + 1
        )
    })
}

/// N.
fn largest_load(balls: &[BallState]) -> f64 {
    balls.iter().map(|b| b.inner.normal_load.max(b.outer.normal_load)).fold(0.0, f64::max)
}

/// What acts on the inner race of a bearing alone in a run and not in an equilibrium, where it is much beside the ball loads. In a
/// housing weight and rotating load count.
fn without_loads_of_runs(scene: &Scene, balls: &[BallState], housed: bool) -> Option<String> {
    let of = &scene.dynamics;
    let gravity = scene.gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
    let speed = scene.inner_speed.unwrap_or(0.0);
    let rotating = of.rotating_load.as_ref().map_or(0.0, |load| load.force.value(0.0).abs());
    let all = [
        ("its weight", of.inner.inertia.mass * gravity, housed),
        ("its unbalance at this speed", of.unbalance * speed * speed, false),
        ("the rotating load", rotating, housed),
    ];
    let largest = largest_load(balls);
    let told = all.iter().filter(|(_, force, counts)| !counts && *force > CENTRIFUGAL * largest);
    let told: Vec<String> = told.map(|(what, force, _)| format!("{what}, {force:.3} N")).collect();
    (!told.is_empty()).then(|| {
        format!(
            "what acts on the inner race in a run is left out: {}; `run` has it, here give it as a load",
            told.join("; ")
        )
    })
}

/// Bushings that are pushed through more of their wall than small displacements are.
fn pressed_through(
    scene: &AssemblyScene,
    assembly: &StaticAssembly,
    solution: &AssemblySolution,
) -> Vec<String> {
    let said = |(spring, connection): (&Spring, &Connection)| {
        let wall = spring.bushing.as_ref()?.body.thickness;
        let ends = connection
            .ends
            .map(|mount| mounted(&race::fixed(&solution.coordinates[mount.body].into()), &mount));
        let [gone, _] = connection.reach([&ends[0], &ends[1]]);
        (gone > FAR_IN_WALL * wall).then(|| {
            let beyond = if gone >= wall { ", beyond it: nothing but its springs is there" } else { "" };
            format!(
                "bushing {} is pushed by {:.3} mm, its wall is {:.3} mm{beyond}; its springs are of small displacements",
                spring.name,
                1e3 * gone,
                1e3 * wall
            )
        })
    };
    scene.springs.iter().zip(&assembly.connections).filter_map(said).collect()
}

/// Unbalances of bodies, which a run has from its start on, where they are much beside the ball loads.
fn without_unbalances(scene: &AssemblyScene, solution: &AssemblySolution) -> Option<String> {
    let of_body = |body: &SceneBody| {
        let Rotation::Speed(speed) = &body.race.rotation else { return None };
        let square = speed.value(0.0).powi(2);
        let along = body.beam.iter().flat_map(|beam| &beam.unbalances).map(|of| of.1.abs());
        let force = along.fold(body.unbalance.abs(), f64::max) * square;
        Some((force, format!("body {}", body.name)))
    };
    let of_race = |placed: &PlacedBearing| {
        let speed = placed.scene.inner_speed.unwrap_or(0.0);
        let name = placed.name.as_ref().map_or(String::new(), |name| format!(" of {name}"));
        (placed.scene.dynamics.unbalance.abs() * speed * speed, format!("the inner race{name}"))
    };
    let all = scene.bodies.iter().filter_map(of_body).chain(scene.bearings.iter().map(of_race));
    let (force, body) = all.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let largest =
        solution.bearings.iter().map(|state| largest_load(&state.balls)).fold(0.0, f64::max);
    (force > CENTRIFUGAL * largest).then(|| {
        format!(
            "unbalances at the speed at t = 0 are left out, the largest one, of {body}, with {force:.3} N; `run` has them from its start on"
        )
    })
}

/// A bearing that turns, solved without the centrifugal force of its balls.
fn without_centrifugal(scene: &Scene, balls: &[BallState]) -> Option<String> {
    let speed = orbital_speed(scene);
    if scene.centrifugal || speed == 0.0 {
        return None;
    }
    let force = ball_mass(scene) * speed * speed * scene.geometry.pitch_radius;
    let largest = largest_load(balls);
    // NaN says nothing.
    (force > CENTRIFUGAL * largest).then(|| {
        let part = if largest > 0.0 {
            format!("{:.1} % of the largest ball load", 100.0 * force / largest)
        } else {
            "while no ball is loaded".into()
        };
        format!(
            "the centrifugal force of a ball at this speed, {force:.3} N, is left out: {part}; write \
             ball_forces.centrifugal = true to have it"
        )
    })
}
