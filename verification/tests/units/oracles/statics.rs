//! The oracle's own checks: derivatives, energy minimum, closed forms, known figures.

use verification::oracles::hertz::{ball_on_race, exact, hamrock_brewe, in_series};
use verification::oracles::misalignment::{Dimensions, TABLE_3_5, fitted};
use verification::oracles::statics::{Coordinates, Known, OracleBall, OracleBearing};
use verification::oracles::uniform_load::UniformLoad;

const STEEL: f64 = 210e9 / 0.91;

/// Table 3.5 with a given ball radius (m) and phase (rad), Hamrock–Brewe.
fn table_3_5(ball_radius: f64, phase: f64) -> OracleBearing {
    let dimensions = Dimensions { ball_radius, ..TABLE_3_5 };
    dimensions.bearing(dimensions.stiffness(fitted), phase)
}

fn angular_contact() -> OracleBearing {
    let (ball, groove, pitch) = (5.953e-3_f64, 6.6e-3_f64, 30e-3_f64);
    let angle = 35.0_f64.to_radians();
    let (radial, axial) = ((groove - ball) * angle.cos(), (groove - ball) * angle.sin());
    let stiffness = [(24e-3, 1.0), (36e-3, -1.0)]
        .map(|(race, sign)| exact(ball_on_race(ball, race, groove, sign), 1.0, STEEL).stiffness);
    OracleBearing::at_origin(
        11,
        ball,
        [pitch + radial, axial, groove],
        [pitch - radial, -axial, groove],
        stiffness,
        0.1,
    )
}

/// Rotation about an axis through (1, 2, −1) by `angle`, and a shift.
fn moved(mut bearing: OracleBearing, angle: f64, shift: [f64; 3]) -> OracleBearing {
    let n = [1.0, 2.0, -1.0].map(|c: f64| c / 6.0_f64.sqrt());
    let (sin, cos) = angle.sin_cos();
    let cross = [[0.0, -n[2], n[1]], [n[2], 0.0, -n[0]], [-n[1], n[0], 0.0]];
    for i in 0..3 {
        for j in 0..3 {
            let unit = if i == j { cos } else { 0.0 };
            bearing.outer_rotation[i][j] = unit + (1.0 - cos) * n[i] * n[j] + sin * cross[i][j];
        }
    }
    bearing.outer_position = shift;
    bearing
}

fn largest_ball_load(balls: &[OracleBall]) -> f64 {
    balls.iter().map(|ball| ball.inner.load.max(ball.outer.load)).fold(0.0, f64::max)
}

#[test]
fn loads_are_the_slopes_of_the_relaxed_energy() {
    let mut loaded = moved(angular_contact(), 0.02, [1e-3, -2e-3, 5e-4]);
    loaded.ball_force = [0.5, -0.2, -1.0];
    loaded.centrifugal = 400.0;
    for bearing in [table_3_5(5.9555e-3, 0.2), loaded] {
        let mut at = bearing.aligned();
        for (coordinate, step) in at.iter_mut().zip([9e-6, -6e-6, 8e-6, 1.5e-3, -1e-3]) {
            *coordinate += step;
        }
        let (_, loads, _) = bearing.evaluate(&at);
        for i in 0..5 {
            let step = if i < 3 { 2e-8 } else { 1e-6 };
            let energy = |offset: f64| {
                let mut there = at;
                there[i] += offset;
                bearing.evaluate(&there).0
            };
            // Fourth-order difference: truncation and rounding both near 1e-8 of the load.
            let slope = (8.0 * (energy(step) - energy(-step))
                - (energy(2.0 * step) - energy(-2.0 * step)))
                / (12.0 * step);
            let scale = if i < 3 { 100.0 } else { 3.0 };
            assert!((slope - loads[i]).abs() <= 3e-7 * scale, "{i}: {slope} {}", loads[i]);
        }
    }
}

/// Newton–Euler instead of energy: forces along the contact normals, moments by arm × force.
#[test]
fn loads_balance_the_contact_forces_and_their_moments() {
    let bearing = moved(angular_contact(), 0.05, [1e-3, -2e-3, 5e-4]);
    let mut at = bearing.aligned();
    for (coordinate, step) in at.iter_mut().zip([9e-6, -6e-6, 8e-6, 1.5e-3, -4e-3]) {
        *coordinate += step;
    }
    let (_, loads, balls) = bearing.evaluate(&at);
    let (xi, lambda) = (at[3], at[4]);
    let axis = [xi.cos() * lambda.cos(), lambda.sin(), -xi.sin() * lambda.cos()];
    let own_z = [xi.sin(), 0.0, xi.cos()];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
    for ball in &balls {
        let (sin, cos) = ball.azimuth.sin_cos();
        let local = [ball.position[0], ball.position[1] * cos, ball.position[1] * sin];
        let arm: [f64; 3] = std::array::from_fn(|i| {
            dot(bearing.outer_rotation[i], local) + bearing.outer_position[i] - at[i]
        });
        // Groove centre nearest the ball, built from the race outwards.
        let height = dot(arm, axis);
        let flat: [f64; 3] = std::array::from_fn(|i| arm[i] - height * axis[i]);
        let length = dot(flat, flat).sqrt();
        let [radius, axial, _] = bearing.inner;
        let centre: [f64; 3] = std::array::from_fn(|i| axial * axis[i] + radius / length * flat[i]);
        let normal: [f64; 3] = std::array::from_fn(|i| arm[i] - centre[i]);
        let scale = ball.inner.load / dot(normal, normal).sqrt();
        // The race is pushed from its groove centre towards the ball.
        let push = normal.map(|c| scale * c);
        for i in 0..3 {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            force[i] += push[i];
            moment[i] += arm[j] * push[k] - arm[k] * push[j];
        }
    }
    let size = largest_ball_load(&balls);
    for i in 0..3 {
        assert!((loads[i] + force[i]).abs() <= 1e-9 * size, "force {i}");
    }
    assert!((loads[3] + moment[1]).abs() <= 1e-9 * 0.03 * size);
    assert!((loads[4] + dot(moment, own_z)).abs() <= 1e-9 * 0.03 * size);
}

#[test]
fn solution_is_a_minimum_of_the_energy() {
    let bearing = table_3_5(5.9555e-3, 0.0);
    let load = [50.0, -120.0, 300.0, 3.0, -1.0];
    let found = bearing.solve(&load.map(Known::Load), None);
    let potential = |at: &Coordinates| {
        let work: f64 = at.iter().zip(load).map(|(q, f)| q * f).sum();
        bearing.evaluate(at).0 - work
    };
    let bottom = potential(&found.coordinates);
    for i in 0..5 {
        for sign in [-1.0, 1.0] {
            let mut there = found.coordinates;
            there[i] += sign * if i < 3 { 1e-7 } else { 1e-5 };
            assert!(potential(&there) > bottom, "coordinate {i}");
        }
    }
}

#[test]
fn equilibrium_to_rounding_from_a_cold_start() {
    let cases: [[f64; 5]; 5] = [
        [0.0, 0.0, -1500.0, 0.0, 0.0],
        [445.0, 0.0, 0.0, 0.0, 0.0],
        [-300.0, 200.0, 900.0, 5.0, -2.0],
        [800.0, -3000.0, 100.0, -10.0, 10.0],
        [5.0, 1.0, -2.0, 0.01, 0.02],
    ];
    for clearance in [-20e-6, -5e-6, 0.0, 5e-6, 40e-6] {
        for load in cases {
            let bearing = moved(table_3_5(5.953e-3 - 0.5 * clearance, 0.3), 0.4, [0.3, -0.2, 0.5]);
            let mut slanted = angular_contact();
            slanted.ball_radius -= 0.5 * clearance;
            for bearing in [bearing, slanted] {
                let found = bearing.solve(&load.map(Known::Load), None);
                let size = load[0].abs() + load[1].abs() + load[2].abs();
                // Preload stays in the balls when the load is small.
                let size = if clearance < 0.0 { largest_ball_load(&found.balls) } else { size };
                assert!(
                    found.residual <= 1e-10 * size,
                    "C {clearance}, {load:?}: {} after {}",
                    found.residual,
                    found.iterations
                );
                // Loads evaluated with balls relaxed one by one agree, up to the rounding of
                // coordinates half a metre from the origin (6e-17 m, 1e9 N/m).
                let size = size + 60.0;
                let (_, loads, balls) = bearing.evaluate(&found.coordinates);
                for i in 0..5 {
                    let unit = if i < 3 { 1.0 } else { 0.026 };
                    assert!((loads[i] - load[i]).abs() <= 1e-9 * size * unit, "{i}");
                }
                for (one, other) in balls.iter().zip(&found.balls) {
                    assert!((one.inner.load - other.inner.load).abs() <= 1e-9 * size);
                    assert!((one.outer.load - other.outer.load).abs() <= 1e-9 * size);
                }
            }
        }
    }
}

#[test]
fn prescribed_coordinates_at_half_a_degree() {
    let bearing = table_3_5(5.9555e-3, 0.0);
    let tilt = 0.5_f64.to_radians();
    let known = [
        Known::Load(100.0),
        Known::Value(3e-6),
        Known::Load(-50.0),
        Known::Value(tilt),
        Known::Load(0.0),
    ];
    let found = bearing.solve(&known, None);
    assert!(found.residual <= 1e-10 * found.loads[3] / 0.026, "{}", found.residual);
    assert!(found.coordinates[1] == 3e-6 && found.coordinates[3] == tilt);
    assert!((found.loads[0] - 100.0).abs() <= 1e-8 && (found.loads[2] + 50.0).abs() <= 1e-8);
}

#[test]
fn axial_load_agrees_with_the_closed_form() {
    let bearing = angular_contact();
    let closed = UniformLoad {
        balls: 11,
        centre_distance: 2.0 * (6.6e-3 - 5.953e-3),
        free_angle: 35.0_f64.to_radians(),
        stiffness: in_series(bearing.stiffness_inner, bearing.stiffness_outer),
    };
    for load in [1.0, 445.0, 2e4] {
        let expected = closed.solve(load);
        let found = bearing.solve(&[load, 0.0, 0.0, 0.0, 0.0].map(Known::Load), None);
        // 26 mm positions round at 3.5e-18 m; the approach is at least 0.07 µm.
        assert!((found.coordinates[0] - expected.axial_displacement).abs() <= 1e-16);
        for ball in &found.balls {
            for contact in [ball.inner, ball.outer] {
                assert!((contact.load / expected.ball_load - 1.0).abs() <= 1e-8);
                assert!((contact.angle - expected.contact_angle).abs() <= 1e-11);
            }
        }
    }
}

#[test]
fn moving_the_whole_bearing_changes_no_ball_load() {
    let bearing = angular_contact();
    let here = bearing.solve(&[400.0, 100.0, -200.0, 1.0, 2.0].map(Known::Load), None);
    let shifted = moved(bearing.clone(), 0.0, [0.5, -1.0, 0.25]);
    let there = shifted.solve(&[400.0, 100.0, -200.0, 1.0, 2.0].map(Known::Load), None);
    for (one, other) in here.balls.iter().zip(&there.balls) {
        assert!((one.inner.load - other.inner.load).abs() <= 1e-7);
    }
    // Turned about the bearing's own axis by one ball pitch: the balls change places.
    let mut turned = bearing.clone();
    turned.phase += std::f64::consts::TAU / 11.0;
    let turned = turned.solve(&[400.0, 100.0, -200.0, 1.0, 2.0].map(Known::Load), None);
    for ball in 0..11 {
        let other = &turned.balls[(ball + 10) % 11];
        assert!((here.balls[ball].outer.load - other.outer.load).abs() <= 1e-8);
    }
}

#[test]
fn a_ball_rests_on_the_outer_race_by_its_weight_and_spin() {
    let mut bearing = table_3_5(5.943e-3, 0.0);
    bearing.ball_radial_force = 3.0;
    bearing.ball_force = [0.0, 0.0, -0.07];
    bearing.centrifugal = 100.0;
    let (_, loads, balls) = bearing.evaluate(&[0.0; 5]);
    for ball in &balls {
        let radial = 3.0 + 100.0 * ball.position[1] - 0.07 * ball.azimuth.sin();
        assert!((ball.outer.load - radial).abs() <= 1e-9, "{ball:?}");
        assert!(ball.inner.load == 0.0);
    }
    assert!(loads == [0.0; 5]);
}

#[test]
fn clearance_without_load_stays_put() {
    let found = table_3_5(5.943e-3, 0.0).solve(&[0.0; 5].map(Known::Load), None);
    assert!(found.coordinates == [0.0; 5] && found.residual == 0.0);
}

/// Uniform numbers in (0, 1), Knuth's MMIX generator.
struct Lcg(u64);

impl Lcg {
    fn within(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        low + (high - low) * ((self.0 >> 11) as f64 / (1u64 << 53) as f64)
    }
}

#[test]
fn random_bearings_loads_and_tilts_reach_equilibrium() {
    let mut random = Lcg(2024);
    let (mut worst, mut worst_loads, mut most) = (0.0_f64, 0.0_f64, 0);
    for case in 0..400 {
        let ball = random.within(2e-3, 12e-3);
        let pitch = ball * random.within(3.5, 7.0);
        let osculation = [random.within(1.01, 1.08), random.within(1.01, 1.08)];
        let grooves = osculation.map(|o| o * ball);
        let angle: f64 = if case % 2 == 0 { 0.0 } else { random.within(0.25, 0.75) };
        let clearance = random.within(-20e-6, 40e-6);
        let touch = grooves.map(|groove| groove - ball);
        let stiffness = [(pitch - ball, grooves[0], 1.0), (pitch + ball, grooves[1], -1.0)].map(
            |(race, groove, sign)| {
                hamrock_brewe(ball_on_race(ball, race, groove, sign), 1.0, STEEL).stiffness
            },
        );
        let bearing = OracleBearing::at_origin(
            (random.within(5.0, 20.0)) as usize,
            ball - 0.5 * clearance,
            [pitch + touch[0] * angle.cos(), touch[0] * angle.sin(), grooves[0]],
            [pitch - touch[1] * angle.cos(), -touch[1] * angle.sin(), grooves[1]],
            stiffness,
            random.within(0.0, std::f64::consts::TAU),
        );
        let tilt = random.within(-0.3, 0.3);
        let shift = [0; 3].map(|_| random.within(-1e-4, 1e-4));
        let bearing = moved(bearing, tilt, shift);
        let mut size = 10.0_f64.powf(random.within(1.0, 3.7));
        let aligned = bearing.aligned();
        let known: [Known; 5] = std::array::from_fn(|i| {
            let unit = if i < 3 { 1.0 } else { 0.3 * pitch };
            if random.within(0.0, 1.0) < 0.75 {
                Known::Load(unit * size * random.within(-1.0, 1.0))
            } else if i < 3 {
                Known::Value(aligned[i] + random.within(-2e-5, 2e-5))
            } else {
                Known::Value(aligned[i] + random.within(-0.5, 0.5).to_radians())
            }
        });
        let found = bearing.solve(&known, None);
        // The energy has one minimum here: some cases start again from elsewhere.
        if case % 16 == 0 {
            let mut start = aligned;
            for (i, coordinate) in start.iter_mut().enumerate() {
                *coordinate += random.within(-1.0, 1.0) * if i < 3 { 5e-5 } else { 5e-3 };
            }
            let again = bearing.solve(&known, Some(start));
            for i in 0..5 {
                let unit = if i < 3 { 1.0 } else { pitch };
                let apart = unit * (again.coordinates[i] - found.coordinates[i]).abs();
                assert!(apart <= 1e-9, "case {case}, {i}: {apart} m between two starts");
            }
        }
        size = size.max(largest_ball_load(&found.balls));
        worst = worst.max(found.residual / size);
        most = most.max(found.iterations);
        assert!(found.residual <= 1e-10 * size, "case {case}: {}", found.residual);
        let (_, loads, _) = bearing.evaluate(&found.coordinates);
        for i in 0..5 {
            if let Known::Load(load) = known[i] {
                let unit = if i < 3 { 1.0 } else { pitch };
                let error = (loads[i] - load).abs() / (size * unit);
                worst_loads = worst_loads.max(error);
                assert!(error <= 1e-9, "case {case}, {i}: {} for {load}", loads[i]);
            }
        }
    }
    println!("worst residual {worst:e}, worst load {worst_loads:e}, most iterations {most}");
}
