//! Laws of dented races (3.20): the half-space against Hertz and against what a shallow pit costs, the table against its own
//! slopes, a bearing against its books.

use super::dynamics_integrators::{motion, started};
use crate::dynamics::{self, RPM, free_race};
use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, Material};
use bearing_dynamics::ch2_housing::bearing::hertz::{
    HertzContact, HertzModel, RaceSide, contact, contact_ellipse,
};
use bearing_dynamics::ch3_bushing::dent::{Dent, DentShape, DentTable, dented_load};
use bearing_dynamics::ch5_cage::raceway_profile::RacewayProfile;
use bearing_dynamics::kinematics::vec3::{add, cross, norm, scale};
use bearing_dynamics::members::contacts::{ContactTable, Kernel, Want};
use bearing_dynamics::members::dent_table::{
    Bed, DentOn, DentedContact, Fineness, dent_table, usual_table,
};
use bearing_dynamics::members::half_space::{Grid, Influence, love, press};
use bearing_dynamics::members::state::{POSITION, VELOCITY};
use bearing_dynamics::motion::simulation::{Integrator, Stepping};
use bearing_dynamics::motion::start;
use bearing_dynamics::motion::system::System;
use std::sync::OnceLock;

fn table_3_5() -> BearingGeometry {
    BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.9555e-3)
}

fn outer() -> HertzContact {
    let steel = Material::STEEL;
    contact(HertzModel::Exact, RaceSide::Outer, &table_3_5(), &steel, &steel).unwrap()
}

fn pit(diameter: f64, depth: f64) -> DentShape {
    DentShape { diameter, depth, shoulder_height: 0.0, shoulder_width: 0.0 }
}

const WIDE: f64 = 500e-6;

fn table_of(shape: DentShape) -> DentTable {
    dent_table(&DentedContact::new(shape, &outer()), Fineness { cells: 24, intervals: [16, 12] })
        .unwrap()
}

fn usual() -> &'static DentTable {
    static TABLE: OnceLock<DentTable> = OnceLock::new();
    TABLE.get_or_init(|| table_of(pit(WIDE, 25e-6)))
}

/// A rectangle seen from far away is a point load, u = P/(π E* r); over its middle the closed form is Love's.
#[test]
fn a_loaded_rectangle_sinks_as_love_has_it() {
    let (a, b) = (1e-5, 2e-5);
    let (far, load) = (libm::hypot(3e-3, 4e-3), 4.0 * a * b);
    let found = love(3e-3, 4e-3, a, b);
    // Of the order of (b/r)².
    assert!((found * std::f64::consts::PI * far / load - 1.0).abs() <= 2e-5, "{found}");
    let middle = 4.0 * (a * libm::asinh(b / a) + b * libm::asinh(a / b)) / std::f64::consts::PI;
    assert!((love(0.0, 0.0, a, b) / middle - 1.0).abs() <= 1e-14);
    // Four quarters are the whole.
    let quarters = [[-0.5, -0.5], [-0.5, 0.5], [0.5, -0.5], [0.5, 0.5]]
        .map(|[x, y]| love(3e-5 - x * a, 1e-5 - y * b, 0.5 * a, 0.5 * b));
    let whole = love(3e-5, 1e-5, a, b);
    assert!((quarters.iter().sum::<f64>() / whole - 1.0).abs() <= 1e-13);
}

/// Load and energy of the elliptic contact by complete elliptic integrals.
#[test]
fn the_half_space_comes_to_hertz() {
    let (hertz, delta) = (outer(), 3e-6);
    let modulus = 0.5 * hertz.effective_modulus;
    let misses = [16, 32, 64].map(|cells| {
        let bed =
            Bed::new(DentedContact::new(pit(WIDE, 0.0), &hertz), cells, DentOn::Across).unwrap();
        let found = bed.solve(0.0, delta, None, None).unwrap();
        let load = hertz.stiffness * delta * delta.sqrt();
        [found.load * modulus / load - 1.0, found.energy * modulus / (0.4 * load * delta) - 1.0]
    });
    println!("{misses:?}");
    // The edge of the contact runs through cells: a load scatters, an energy does less.
    assert!(misses[2].iter().all(|miss| miss.abs() <= 3e-4), "{misses:?}");
    let order = libm::log2(misses[0][1] / misses[2][1]) / 2.0;
    assert!(order >= 1.5, "{order}");
}

/// To first order in its depth a pit costs the undented pressure times its depth.
#[test]
fn a_shallow_pit_costs_what_the_pressure_finds_in_it() {
    let (hertz, delta) = (outer(), 3e-6);
    let load = hertz.stiffness * delta * delta.sqrt();
    let ellipse = contact_ellipse(&hertz, load);
    for (on, dent) in [
        (DentOn::Rolling, [0.0, 0.0]),
        (DentOn::Rolling, [80e-6, 0.0]),
        (DentOn::Across, [0.0, 300e-6]),
        (DentOn::Anywhere, [60e-6, -200e-6]),
    ] {
        let shape = pit(WIDE, 3e-9);
        let bed = Bed::new(DentedContact::new(shape, &hertz), 48, on).unwrap();
        let energy = |dent| bed.solve(0.0, delta, dent, None).unwrap().energy;
        let lost = (energy(None) - energy(Some(dent))) * 0.5 * hertz.effective_modulus;
        // ∫ p d dA over the ellipse, in rings.
        let (rings, spokes) = (200, 400);
        let mut expected = 0.0;
        for i in 0..rings {
            let r = (i as f64 + 0.5) / rings as f64;
            for j in 0..spokes {
                let (sin, cos) =
                    libm::sincos(std::f64::consts::TAU * (j as f64 + 0.5) / spokes as f64);
                let (x, y) = (ellipse.semi_minor * r * cos, ellipse.semi_major * r * sin);
                let depth = shape.depth_at(libm::hypot(x - dent[0], y - dent[1]));
                expected += ellipse.peak_pressure * (1.0 - r * r).sqrt() * depth * r;
            }
        }
        expected *= ellipse.semi_minor * ellipse.semi_major / rings as f64 * std::f64::consts::TAU
            / spokes as f64;
        println!("{dent:?}: {lost:e} J, closed form {expected:e} J");
        // A thousandth of the approach, and cells of a 24th of the contact.
        assert!((lost / expected - 1.0).abs() <= 2e-3, "{dent:?}");
    }
}

#[test]
fn slopes_of_the_table_are_its_differences() {
    let table = usual();
    let mut noise = dynamics::Noise(5);
    for _ in 0..2000 {
        let delta = 20e-6 * (1.0 + noise.next());
        let place = [4e-4 * noise.next(), 9e-4 * noise.next()];
        let value =
            |delta: f64, s: f64, y: f64| table.lost(delta, [s, y]).map_or(0.0, |lost| lost.value);
        let [s, y] = place;
        let (h, d) = (1e-9, 1e-5 * delta);
        let found = table.lost(delta, place).unwrap_or_default();
        let differences = [
            (found.by_approach, (value(delta + d, s, y) - value(delta - d, s, y)) / (2.0 * d)),
            (found.along, (value(delta, s + h, y) - value(delta, s - h, y)) / (2.0 * h)),
            (found.across, (value(delta, s, y + h) - value(delta, s, y - h)) / (2.0 * h)),
        ];
        for (slope, difference) in differences {
            // Rounding of 1e-6 m in differences of 1e-9 m, and the splines' third derivative.
            assert!((slope - difference).abs() <= 1e-5 * (1.0 + slope.abs()), "{delta} {place:?}");
        }
    }
}

/// What the table is made from, between its nodes.
#[test]
fn the_table_says_what_the_half_space_does() {
    let (hertz, shape) = (outer(), pit(WIDE, 25e-6));
    let table = dent_table(&DentedContact::new(shape, &hertz), Fineness::USUAL).unwrap();
    for (on, towards) in [
        (DentOn::Rolling, [1.0, 0.0]),
        (DentOn::Across, [0.0, 1.0]),
        (DentOn::Anywhere, [0.6, -0.8]),
        (DentOn::Anywhere, [-0.9, 1.4]),
    ] {
        let bed = Bed::new(DentedContact::new(shape, &hertz), 64, on).unwrap();
        for delta in [1.5e-6, 4e-6, 11e-6] {
            for along in [0.0, 90e-6, 170e-6, 280e-6] {
                let flat = bed.solve(0.0, delta, None, None).unwrap().load;
                let place = towards.map(|part| part * along);
                let found = bed.solve(0.0, delta, Some(place), None).unwrap().load / flat;
                let n = table.exponent(delta, place);
                let share = dented_load(1.0, delta, n) / (delta * delta.sqrt());
                println!("{delta} {place:?}: {share:.4} of {found:.4}, n {n:.4}");
                assert!((share - found).abs() <= 0.02, "{delta} {place:?}: {share} {found}");
            }
        }
    }
}

/// From any guess the same pressure, no gap beyond the tolerance, in few iterations; what is not a number is no contact.
#[test]
fn a_contact_does_not_depend_on_its_guess() {
    let grid = Grid { nx: 12, ny: 6, hx: 1.0, hy: 0.8, mirrored: true };
    let influence = Influence::new(grid);
    // A bowl with a step, so that cells in the middle carry nothing.
    let gap = |cell: usize| {
        let [x, y] = grid.middle(cell);
        0.01 * (x * x + y * y) + if x * x + y * y < 3.0 { 0.1 } else { 0.0 }
    };
    let gaps: Vec<f64> = (0..grid.cells()).map(gap).collect();
    let (approach, tolerance) = (0.2, 1e-9);
    let pressed = |gaps: &[f64], guess: Option<&[f64]>| {
        press(&influence, 1.0, gaps, approach, guess, tolerance)
    };
    let plain = pressed(&gaps, None).unwrap();
    let largest = plain.pressure.iter().copied().fold(0.0, f64::max);
    assert!(plain.pressure.contains(&0.0) && largest > 0.0);
    let guesses: [&dyn Fn(usize) -> f64; 5] =
        [&|_| 0.0, &|_| 10.0, &|_| -1.0, &|_| f64::NAN, &|cell| {
            [1e-6, 3.0, 0.0, 0.2][cell * 7 % 4]
        }];
    for (number, guess) in guesses.into_iter().enumerate() {
        let guess: Vec<f64> = (0..grid.cells()).map(guess).collect();
        let found = pressed(&gaps, Some(&guess)).unwrap();
        assert!(found.iterations <= 120, "{number}: {}", found.iterations);
        for (one, other) in found.pressure.iter().zip(&plain.pressure) {
            // Gaps of 1e-9 over the stiffness of a cell by itself, ten times.
            assert!((one - other).abs() <= 1e-7 * largest, "{number}: {one} {other}");
        }
        assert!((found.energy / plain.energy - 1.0).abs() <= 1e-12, "{number}");
    }
    // Love's sums for every cell: nothing is pressed and open, nothing overlaps.
    let sunk = |cell: usize| {
        let [x, y] = grid.middle(cell);
        let of = |other: usize| {
            let ([a, b], p) = (grid.middle(other), plain.pressure[other]);
            p * (love(x - a, y - b, 0.5, 0.4) + love(x - a, y + b, 0.5, 0.4))
        };
        (0..grid.cells()).map(of).sum::<f64>()
    };
    for (cell, gap) in gaps.iter().enumerate() {
        let open = gap + sunk(cell) - approach;
        let allowed = tolerance * approach;
        let closed = if plain.pressure[cell] > 0.0 { open.abs() } else { -open };
        assert!(closed <= allowed, "{cell}: {open}");
    }
    let mut broken = gaps.clone();
    broken[29] = f64::NAN;
    assert!(pressed(&broken, None).is_none());
    assert!(press(&influence, f64::NAN, &gaps, approach, None, tolerance).is_none());
}

/// A shoulder of a micrometre takes finer cells, or the load in the middle changes by a tenth of what it should.
#[test]
fn a_shoulder_is_solved_finely_enough() {
    let hertz = outer();
    let shape = DentShape { shoulder_height: 1e-6, shoulder_width: 125e-6, ..pit(WIDE, 25e-6) };
    let contact = DentedContact::new(shape, &hertz);
    let table = usual_table(&contact).unwrap();
    let bed = Bed::new(contact, 120, DentOn::Rolling).unwrap();
    for delta in [8e-6, 13e-6] {
        let flat = bed.solve(0.0, delta, None, None).unwrap().load;
        let found = bed.solve(0.0, delta, Some([0.0; 2]), None).unwrap().load / flat;
        let n = table.exponent(delta, [0.0, 0.0]);
        let share = dented_load(1.0, delta, n) / (delta * delta.sqrt());
        println!("{delta}: {share:.4} of {found:.4}");
        // Forty cells are 0.01 to 0.02 off.
        assert!((share - found).abs() <= 3e-3, "{delta}: {share} {found}");
    }
}

/// Half a wave deep and a whole one high: without a step or a kink where pit, shoulder and surface meet.
#[test]
fn a_dent_is_smooth_from_its_pit_to_the_surface_around_it() {
    let shape = DentShape { shoulder_height: 4e-6, shoulder_width: 100e-6, ..pit(WIDE, 25e-6) };
    let course = [(0.0, 25.0), (125.0, 12.5), (250.0, 0.0), (275.0, -2.0), (300.0, -4.0)];
    for (r, depth) in course.into_iter().chain([(325.0, -2.0), (350.0, 0.0), (400.0, 0.0)]) {
        let error = shape.depth_at(1e-6 * r) - 1e-6 * depth;
        assert!(error.abs() <= 1e-19, "{r} um: {error}");
    }
    assert_eq!(shape.reach(), 350e-6);
    const NEAR: f64 = 1e-9;
    for r in [NEAR, 250e-6, 300e-6, 350e-6] {
        let slope = (shape.depth_at(r + NEAR) - shape.depth_at(r - NEAR)) / (2.0 * NEAR);
        // Curvatures of up to 8e3 1/m; elsewhere slopes are 0.1.
        assert!(slope.abs() <= 8e3 * NEAR, "{r}: {slope}");
    }
}

/// 3/2 far away and under a load that fills the dent; larger over a wider one; smaller on a shoulder.
#[test]
fn the_exponent_follows_load_shape_and_distance() {
    let (table, wide) = (usual(), table_of(pit(2.0 * WIDE, 25e-6)));
    let delta = 3e-6;
    assert_eq!(table.exponent(delta, [1e-3, 0.0]), 1.5);
    assert_eq!(table.exponent(delta, [0.0, 3e-3]), 1.5);
    let n = |delta: f64| table.exponent(delta, [0.0, 0.0]);
    assert!(wide.exponent(delta, [0.0, 0.0]) > n(delta) + 0.02);
    let course = [1e-6, 3e-6, 10e-6, 30e-6, 50e-6].map(n);
    assert!(course.windows(2).all(|pair| pair[1] < pair[0]), "{course:?}");
    assert!(course[0] > 1.54 && course[4] < 1.501, "{course:?}");
    let away = [0.0, 1e-4, 2e-4, 3e-4, 4e-4].map(|s| table.exponent(delta, [s, 0.0]));
    assert!(away.windows(2).all(|pair| pair[1] < pair[0]), "{away:?}");
    let shoulder = DentShape { shoulder_height: 1e-6, shoulder_width: 100e-6, ..pit(WIDE, 5e-6) };
    let raised = table_of(shoulder);
    assert!(raised.exponent(delta, [300e-6, 0.0]) < 1.498);
    // It carries before the surface around it does.
    let lost = raised.lost(-0.2e-6, [300e-6, 0.0]).unwrap();
    assert!(-0.2e-6 - lost.value > 0.3e-6, "{lost:?}");
}

fn dent(side: usize, angle: f64) -> Dent {
    Dent { shape: pit(WIDE, 25e-6), side, angle, groove_angle: 0.02 }
}

fn dented(dents: Vec<Dent>) -> DynamicProblem {
    let mut problem = dynamics::bearing(table_3_5(), [0.0, 0.0, -300.0, 0.0, 0.0], 1000.0 * RPM);
    problem.raceway_profiles = dents.into_iter().map(RacewayProfile::Dent).collect();
    problem.ball_phase = 0.0;
    problem
}

/// Both races free: forces on all bodies sum to nothing, and so do their moments.
#[test]
fn a_dent_makes_no_momentum() {
    let mut problem = dented(vec![dent(1, 0.004), dent(0, -0.003), dent(1, 0.79)]);
    (problem.inner, problem.outer) = (free_race(), Some(free_race()));
    for driver in [Kernel::Scalar, Kernel::Simd] {
        let mut system = System::new(&problem, driver);
        let state = start_of(&problem);
        let mut rates = vec![0.0; state.len()];
        system.evaluate(0.0, &state, &mut rates);
        let set = &system.sets[0];
        assert!(set.table.profiled.len() >= 3, "{:?}", set.table.profiled);
        assert!(set.table.profiled.iter().any(|dented| norm(dented.aside) > 0.1));
        let (mut force, mut moment, mut largest) = ([0.0; 3], [0.0; 3], 0.0f64);
        for ball in 0..8 {
            let at = set.layout.ball_vector(&state, POSITION, ball);
            let pushed = scale(set.layout.ball_vector(&rates, VELOCITY, ball), problem.ball.mass);
            largest = largest.max(norm(pushed));
            force = add(force, pushed);
            moment = add(moment, cross(at, pushed));
        }
        for (loads, race) in set.on_races.iter().zip(&set.races) {
            force = add(force, loads.force);
            moment = add(moment, add(loads.moment, cross(race.motion.position, loads.force)));
        }
        assert!(largest > 1.0 && norm(force) <= 1e-11 * largest, "{force:?} of {largest}");
        assert!(norm(moment) <= 1e-12 * largest, "{moment:?}");
    }
}

/// Ball 0 of a system alone, pressed into the outer race by `overlap` (m) at angles around the axis and in the groove (rad); what
/// is made of its contact there.
fn press_ball(system: &mut System, [around, in_groove]: [f64; 2], overlap: f64) -> ContactTable {
    let geometry = table_3_5();
    let deep = geometry.outer.groove_radius - geometry.ball_radius + overlap;
    let (sin, cos) = libm::sincos(in_groove);
    let radius = geometry.outer.centre_radius + deep * cos;
    let place = [deep * sin, radius * libm::cos(around), radius * libm::sin(around)];
    let mut state = start_of(&dented(Vec::new()));
    for (i, value) in place.into_iter().enumerate() {
        state[system.sets[0].layout.ball(POSITION + i)] = value;
    }
    let mut rates = vec![0.0; state.len()];
    system.evaluate_with(Want::ForcesAndSlopes, 0.0, &state, &mut rates);
    system.sets[0].table.clone()
}

fn table_of_dent(system: &System) -> &DentTable {
    system.sets[0].laws.raceway_profiles.on_races[0].dent_table().unwrap()
}

/// A dent high up in its groove is nearer to the axis than the groove's bottom: arcs from it are of that radius. And the stiffness
/// over a dent is the slope of its load over the approach.
#[test]
fn arcs_and_stiffness_over_a_dent() {
    let (high, low) = ([0.2, 0.6], [1.0, 0.0]);
    let at = |[angle, groove_angle]: [f64; 2]| Dent { groove_angle, ..dent(1, angle) };
    let mut system = System::new(dented(vec![at(high), at(low)]), Kernel::Simd);
    let pair = system.sets[0].layout.padded;
    let outer = table_3_5().outer;
    let radius = outer.centre_radius + outer.groove_radius * libm::cos(high[1]);
    for arc in [100e-6, 200e-6, 300e-6] {
        let overlap = 6e-6;
        let table = press_ball(&mut system, [high[0] + arc / radius, high[1]], overlap);
        let lost = overlap - table.contact[pair].overlap;
        let expected = table_of_dent(&system).lost(overlap, [arc, 0.0]).unwrap().value;
        // Rounding of places; arcs of the groove's bottom would be 3 % longer.
        assert!((lost / expected - 1.0).abs() <= 1e-6, "{arc}: {lost:e} {expected:e}");
    }
    for (aside, overlap) in [(0.0, 4e-6), (0.0, 15e-6), (0.004, 4e-6), (0.006, 8e-6)] {
        let mut over = |overlap: f64| {
            let table = press_ball(&mut system, [low[0] + aside, low[1]], overlap);
            *table.profiled(pair).expect("it is over the dent")
        };
        let step = 1e-4 * overlap;
        let slope = (over(overlap + step).elastic - over(overlap - step).elastic) / (2.0 * step);
        let found = over(overlap).stiffness;
        // Its own differences are as long; splines have jumps of their third derivative.
        assert!((found / slope - 1.0).abs() <= 1e-5, "{aside} {overlap}: {found} {slope}");
    }
}

/// Nominal positions: every ball in the middle of an interference of 5 µm.
fn start_of(problem: &DynamicProblem) -> Vec<f64> {
    start::nominal(&problem.assembly())
}

/// In and out of dents of both races, without loss and without friction.
#[test]
fn a_pass_makes_no_energy() {
    let problem = dented(vec![dent(1, 0.03), dent(0, -0.03)]);
    let drift = |step: f64, end: f64| {
        let mut simulation = started(&problem, Integrator::RungeKutta, Stepping::Fixed(step));
        let (mut dented, mut passed, mut held) = (false, false, 0.0f64);
        while simulation.time < end {
            simulation.step().unwrap();
            let now = simulation.system.sets[0].table.profiled.iter().any(|of| of.pair >= 8);
            (dented, passed) = (dented || now, passed || (dented && !now));
            held = held.max(simulation.system.energy(&simulation.state).contact);
        }
        assert!(passed, "not across the dent");
        simulation.snapshot().residual / held
    };
    let found = [drift(1e-6, 3e-3), drift(0.5e-6, 3e-3)];
    println!("{found:?}");
    assert!(found[1].abs() <= 1e-7, "{found:?}");
}

/// A dent of no depth is none: every bit as without it.
#[test]
fn a_vanishing_dent_is_hertz() {
    let mut flat = dent(1, 0.01);
    flat.shape.depth = 0.0;
    let run = |dents: Vec<Dent>| {
        let problem = dented(dents);
        let mut simulation = started(&problem, Integrator::RungeKutta, Stepping::Fixed(1e-6));
        for _ in 0..500 {
            simulation.step().unwrap();
        }
        simulation.state.iter().map(|value| value.to_bits()).collect::<Vec<u64>>()
    };
    let without = run(Vec::new());
    assert!(without == run(vec![flat]));
    assert!(without != run(vec![dent(1, 0.01)]));
    // And the law itself where the dent is out of reach.
    assert_eq!(usual().lost(3e-6, [1e-3, 0.0]), None);
}

/// Linearly implicit steps at a tight accuracy and small explicit ones go the same way.
#[test]
fn both_methods_cross_a_dent_alike() {
    let problem = dented(vec![dent(1, 0.02)]);
    let place = |integrator, stepping| {
        let (rows, simulation) = motion(&problem, integrator, stepping, 1.2e-3, 1);
        (rows[0], simulation.steps)
    };
    let (exact, _) = place(Integrator::RungeKutta, Stepping::Fixed(2e-7));
    let misses = [1e-4, 1e-6].map(|accuracy| {
        let (found, steps) = place(Integrator::Rosenbrock, Stepping::Accuracy(accuracy));
        println!("accuracy {accuracy}: {steps} steps, z {:e} of {:e} m", found[2], exact[2]);
        (found[2] - exact[2]).abs()
    });
    // The race moves by some tenths of a micrometre.
    assert!(misses[0] <= 2e-8 && misses[1] <= 1e-9, "{misses:?}");
}

/// Balls of a tight bearing that carries nothing stand still in the frames of linearly implicit steps, at any speed: no error
/// says that a dent is near, and yet none is passed over.
#[test]
fn no_step_passes_over_a_dent() {
    let geometry =
        BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, 31.953e-3, 6.310e-3, 5.963e-3);
    for (angle, accuracy) in [(4.363, 1e-3), (4.38, 1e-3), (4.38, 1e-6), (4.311, 1e-4)] {
        let mut problem = dynamics::bearing(geometry, [0.0; 5], 10_000.0 * RPM);
        let dent = Dent { shape: pit(400e-6, 25e-6), side: 1, angle, groove_angle: 0.0 };
        problem.raceway_profiles = vec![RacewayProfile::Dent(dent)];
        problem.ball_phase = 0.0;
        let place = |integrator, stepping| {
            let (rows, simulation) = motion(&problem, integrator, stepping, 2e-3, 1);
            (rows[0], simulation.steps, simulation.control.unwrap().memory.displacement)
        };
        let (exact, ..) = place(Integrator::DormandPrince, Stepping::Accuracy(1e-7));
        let (found, steps, overlap) = place(Integrator::Rosenbrock, Stepping::Accuracy(accuracy));
        let miss = (0..3).map(|i| (found[i] - exact[i]).abs()).fold(0.0, f64::max) / overlap;
        println!(
            "{angle}, {accuracy}: {steps} steps, {miss:e} of the overlap off, z {:e}",
            exact[2]
        );
        assert!(norm(exact) >= 1e-8, "the dent is felt: {exact:?}");
        assert!(miss <= accuracy, "{angle}, {accuracy}: {miss:e}");
    }
}
