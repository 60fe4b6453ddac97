//! An elastic shaft on bearings at rest.

use crate::beam::{E, full, steel};
use crate::common::table_4_1;
use bearing_dynamics::ch2_housing::bearing::geometry::Material;
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzModel, RaceSide, contact};
use bearing_dynamics::equilibrium::lists::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticBody, StaticSection, StaticShaft,
};
use bearing_dynamics::equilibrium::statics::{
    AssemblySolution, StaticOptions, StaticsError, solve_assembly,
};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::beam::Beam;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::members::shaft_modes::{Kept, ShaftShapes, free_shaft};
use nalgebra::{UnitQuaternion, Vector3};

fn at(x: f64) -> Pose {
    Pose { position: Vector3::new(x, 0.0, 0.0), orientation: UnitQuaternion::identity() }
}

const FREE: [Condition; 5] = [Condition::Load(0.0); 5];

fn down(force: f64) -> [f64; 5] {
    [0.0, 0.0, -force, 0.0, 0.0]
}

fn loaded(conditions: [Condition; 5]) -> Place {
    let (springs, rest, start, room) = ([0.0; 5], [0.0; 5], Some([0.0; 5]), 5e-3);
    Place::Loaded(Loaded { axes: None, conditions, springs, rest, start, room })
}

fn section(shapes: &ShaftShapes, along: f64, loads: [f64; 5]) -> StaticBody {
    let section = StaticSection { shaft: 0, section: shapes.section(along), loads };
    let name = format!("the section {along} m from the middle");
    StaticBody { name, place: Place::Section(Box::new(section)) }
}

/// The shaft of Table 4.1 on its bearings at two places, loaded downwards at a third; places count from its middle. Its
/// body is the last one.
fn assembly(
    clearance: f64,
    stiffer: f64,
    places: [f64; 3],
    kept: Kept,
    force: f64,
) -> StaticAssembly<'static> {
    let mut segment = steel(0.4, 0.03, 0.0);
    segment.youngs_modulus *= stiffer;
    let holds = places.map(|at| (at + 0.2, true));
    let (_, shapes) = free_shaft(&Beam::new(vec![segment]), kept, &holds, &[]).unwrap();
    let geometry = table_4_1(clearance);
    let side = |side| {
        contact(HertzModel::HamrockBrewe, side, &geometry, &Material::STEEL, &Material::STEEL)
            .unwrap()
    };
    let bearing = |index: usize| StaticBearing {
        name: Some(["left", "right"][index].into()),
        geometry,
        inner_contact: side(RaceSide::Inner),
        outer_contact: side(RaceSide::Outer),
        mounts: [Mount::at_centre(index), Mount::at_centre(3 + index)],
        azimuths: geometry.azimuths(0.0),
        weight: Vector3::zeros(),
        centrifugal: 0.0,
    };
    let held = |x| StaticBody { name: "an outer race".into(), place: Place::Fixed(at(x)) };
    StaticAssembly {
        bodies: vec![
            section(&shapes, places[0], [0.0; 5]),
            section(&shapes, places[1], [0.0; 5]),
            section(&shapes, places[2], down(force)),
            held(places[0]),
            held(places[1]),
            StaticBody { name: "the shaft".into(), place: loaded(FREE) },
        ],
        bearings: vec![bearing(0), bearing(1)],
        shafts: vec![StaticShaft::new(5, &shapes)],
        ..StaticAssembly::default()
    }
}

fn solve(assembly: &StaticAssembly) -> AssemblySolution {
    solve_assembly(assembly, None, &StaticOptions::default()).unwrap()
}

/// A shaft on springs at its ends, loaded downwards at mid-span.
fn on_springs(force: f64) -> StaticAssembly<'static> {
    let mut on_springs = assembly(0.0, 1.0, [-0.2, 0.2, 0.0], Kept::STATIC, force);
    on_springs.bearings.clear();
    for end in 0..2 {
        let ends = [Mount::at_centre(3 + end), Mount::at_centre(end)];
        // Held along the axis at one end: nothing pulls at a shaft that comes shorter as it bends.
        let along = if end == 0 { 1e8 } else { 0.0 };
        let stiffness = [along, 1e8, 5e7, 0.0, 0.0, 0.0];
        let law = Law::SpringDashpot(SpringDashpot { stiffness, ..SpringDashpot::default() });
        on_springs.connections.push(Connection { name: String::new(), label: None, ends, law });
    }
    on_springs
}

/// Springs, bending and shear in series.
#[test]
fn a_shaft_on_springs_bends_as_beam_theory_says() {
    let solution = solve(&on_springs(3000.0));
    let [_, moment, shear] = full(0.03);
    let ends = -1500.0 / 5e7;
    let bent = -3000.0 * (0.4f64.powi(3) / (48.0 * E * moment) + 0.4 / (4.0 * shear));
    let turn = 3000.0 * 0.4 * 0.4 / (16.0 * E * moment);
    // Without bearings tilts are over a metre, and the search ends earlier in what is soft.
    for (ours, theirs) in [
        (solution.coordinates[0][2], ends),
        (solution.coordinates[2][2], ends + bent),
        (solution.coordinates[0][3], turn),
        (solution.coordinates[1][3], -turn),
    ] {
        assert!((ours / theirs - 1.0).abs() <= 1e-8, "{ours} {theirs}");
    }
}

/// A body has 5 mm before nothing seems to hold it; the centre of mass of a shaft that bends goes farther, its ends do not.
#[test]
fn a_shaft_that_bends_far_is_held_where_it_is_held() {
    let (force, [_, moment, shear]) = (60e3, full(0.03));
    let bent = on_springs(force);
    let solution = solve(&bent);
    assert!(solution.coordinates[5][2] < -5e-3, "{}", solution.coordinates[5]);
    let middle = solution.coordinates[2][2];
    let straight = -0.5 * force / 5e7;
    let theirs = straight - force * (0.4f64.powi(3) / (48.0 * E * moment) + 0.4 / (4.0 * shear));
    assert!(theirs < -6e-3, "{theirs}");
    // Slopes of 0.07: their square is what beam theory leaves out.
    assert!((middle / theirs - 1.0).abs() <= 8e-3, "{middle} {theirs}");
    let mut loose = on_springs(force);
    loose.connections.clear();
    let error = solve_assembly(&loose, None, &StaticOptions::default()).unwrap_err();
    assert!(matches!(error, StaticsError::NoEquilibrium { coordinate: "z", .. }), "{error}");
}

/// Three balls' radii deep, a shaft and the races on their springs sink together: nothing has left its place.
#[test]
fn a_shaft_sinks_with_the_races_that_carry_it() {
    let held = assembly(0.0, 1.0, [-0.2, 0.2, 0.0], Kept::STATIC, 300.0);
    let mut soft = held.clone();
    for (body, x) in [(3, -0.2), (4, 0.2)] {
        let mut race = loaded([Condition::Displacement(0.0); 5]);
        let Place::Loaded(own) = &mut race else { panic!("a race") };
        own.conditions[0] = Condition::Displacement(x);
        own.conditions[2] = Condition::Load(0.0);
        own.springs[2] = 1e4;
        (own.start, own.room) = (Some([x, 0.0, 0.0, 0.0, 0.0]), 1.0);
        soft.bodies[body].place = race;
    }
    let [held, soft] = [solve(&held), solve(&soft)];
    for body in [0, 1, 2, 5] {
        let sunk = soft.coordinates[body][2] - held.coordinates[body][2];
        // 1e-8 of 300 N on 1e4 N/m.
        assert!((sunk + 0.015).abs() <= 3e-10, "{body}: {sunk}");
    }
    for (held, soft) in held.bearings.iter().zip(&soft.bearings) {
        let off = (held.forces[0] - soft.forces[0]).norm();
        assert!(off <= 1e-7 * held.forces[0].norm(), "{off:e}");
    }
}

/// The forces of both bearings on the shaft and its load cancel, and natural shapes beside static answers change nothing.
#[test]
fn static_answers_are_exact_whatever_natural_shapes_stand_beside_them() {
    let places = [-0.2, 0.1, 0.2];
    let solution = solve(&assembly(0.0, 1.0, places, Kept::STATIC, 3000.0));
    let forces = |of: &AssemblySolution| [0, 1].map(|i| of.bearings[i].forces[0]);
    let [left, right] = forces(&solution);
    assert!((left.z + right.z - 3000.0).abs() <= 1e-6 && (left.x + right.x).abs() <= 1e-6);
    for kept in [Kept { most: 3, ..Kept::ALL }, Kept::ALL] {
        let other = solve(&assembly(0.0, 1.0, places, kept, 3000.0));
        for (one, other) in forces(&solution).iter().zip(forces(&other)) {
            // Static answers to loads across the shaft do not quite have the shape that a pull along it bends besides: 2e-8.
            assert!((one - other).norm() <= 1e-7 * one.norm(), "{one} {other}");
        }
    }
}

/// A shaft that bends ten thousand times less carries its bearings as a rigid body does.
#[test]
fn a_stiff_shaft_is_a_rigid_body() {
    let places = [-0.2, 0.1, 0.2];
    let stiff = solve(&assembly(-5e-6, 1e4, places, Kept::STATIC, 3000.0));
    let mut rigid = assembly(-5e-6, 1.0, places, Kept::STATIC, 3000.0);
    rigid.shafts.clear();
    let mut conditions = FREE;
    conditions[2] = Condition::Load(-3000.0);
    // A force down in front of the middle turns towards +Y.
    conditions[3] = Condition::Load(3000.0 * 0.2);
    rigid.bodies[5].place = loaded(conditions);
    for index in 0..3 {
        rigid.bodies[index].place = Place::Fixed(at(0.0));
    }
    for (bearing, along) in rigid.bearings.iter_mut().zip(places) {
        bearing.mounts[0] = Mount { body: 5, along, reversed: false };
    }
    let rigid = solve(&rigid);
    for i in 0..2 {
        let [stiff, rigid] = [&stiff, &rigid].map(|of| &of.bearings[i]);
        let force = (stiff.forces[1] - rigid.forces[1]).norm() / rigid.forces[1].norm();
        let moment = (stiff.moments[1] - rigid.moments[1]).norm() / rigid.moments[1].norm();
        assert!(force <= 1e-3 && moment <= 1e-2, "{i}: {force:e} {moment:e}");
    }
}

/// Loads that hold given coordinates of a shaft change as its stiffness says, its shapes and both bearings in equilibrium.
#[test]
fn stiffness_is_the_slope_of_the_loads_that_hold_a_shaft() {
    let given = |at: [f64; 5]| {
        let mut shaft = assembly(-5e-6, 1.0, [-0.2, 0.15, 0.1], Kept::STATIC, 3000.0);
        shaft.bodies[5].place = loaded(at.map(Condition::Displacement));
        solve(&shaft)
    };
    let here = [3e-6, 20e-6, -150e-6, 4e-4, -7e-4];
    let found = given(here);
    for column in 0..5 {
        let step = if column < 3 { 1e-8 } else { 1e-6 };
        let moved = |sign: f64| {
            let mut at = here;
            at[column] += sign * step;
            given(at).loads[5]
        };
        let slope = (moved(1.0) - moved(-1.0)) / (2.0 * step);
        let own = found.stiffness.column(column);
        // Differences of loads that are known to 1e-11 of 3000 N over the step; the curvature of contacts over its square.
        let off = (slope - own)
            .component_div(&nalgebra::SVector::<f64, 5>::from([1.0, 1.0, 1.0, 0.1, 0.1]));
        let size = own.amax().max(1.0);
        assert!(off.amax() <= 2e-6 * size, "{column}: {slope} {own}");
    }
}

/// Bent to a circle by moments at its ends, a shaft has them nearer to each other by M² L³/(24 (E I)²): its line keeps its
/// length.
#[test]
fn a_shaft_comes_shorter_as_it_bends() {
    let mut bent = assembly(0.0, 1.0, [-0.2, 0.2, 0.0], Kept::STATIC, 0.0);
    bent.bearings.clear();
    let moment = 50.0;
    for (body, sign) in [(0, 1.0), (1, -1.0)] {
        let Place::Section(section) = &mut bent.bodies[body].place else { panic!("a section") };
        section.loads[3] = sign * moment;
    }
    bent.bodies[5].place = loaded([0.0; 5].map(Condition::Displacement));
    let found = solve(&bent);
    let [_, second, _] = full(0.03);
    let curvature = moment / (E * second);
    let tilts = [0, 1].map(|end| found.coordinates[end][3]);
    for (tilt, sign) in tilts.into_iter().zip([1.0, -1.0]) {
        assert!((tilt / (sign * curvature * 0.2) - 1.0).abs() <= 1e-9, "{tilts:?}");
    }
    let nearer = 0.4 - (found.coordinates[1][0] - found.coordinates[0][0]);
    let expected = curvature * curvature * 0.4f64.powi(3) / 24.0;
    // Differences of places of 0.2 m.
    assert!((nearer / expected - 1.0).abs() <= 1e-8, "{nearer:e} {expected:e}");
}
