//! Whirl, critical speeds and orbits against closed forms.

use crate::beam::{DENSITY, E, full, steel};
use crate::single_shaft::{
    Fixed, Orbit, SingleShaft, Support, Unbalance, damped_critical_speed, orbit, peak, response,
};
use bearing_dynamics::members::beam::{Beam, BeamDisc};
use bearing_dynamics::vibrations::critical_speeds::Critical;
use bearing_dynamics::vibrations::rotor::{RotorError, RotorModel};
use bearing_dynamics::vibrations::whirl::Whirl;
use nalgebra::{Complex, Matrix4};
use std::f64::consts::PI;

const LENGTH: f64 = 0.4;

/// Root of `of` between two places where its signs differ.
fn root(of: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(of(low) * of(high) < 0.0, "{} {}", of(low), of(high));
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if of(middle) * of(low) > 0.0 { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

fn pinned_shaft() -> SingleShaft {
    let mut beam = Beam::new(vec![steel(LENGTH, 0.03, 0.0)]);
    beam.longest_element = LENGTH / 15.5;
    let mut rotor = SingleShaft::new(beam);
    rotor.fixed = vec![Fixed::pin(0.0), Fixed::pin(LENGTH)];
    rotor
}

/// Determinant of a pinned spinning shaft's motion in circles at ω (below 0: backward) with one half wave.
fn pinned_whirl(waves: f64, spin: f64, omega: f64) -> f64 {
    let [area, moment, shear] = full(0.03);
    let k = waves * PI / LENGTH;
    let [m, i] = [DENSITY * area, DENSITY * moment];
    let deflection = shear * k * k - m * omega * omega;
    let turn = E * moment * k * k + shear - i * omega * omega + 2.0 * i * spin * omega;
    deflection * turn / (shear * shear * k * k) - 1.0
}

/// A spinning shaft on pins: its motions split into circles forward and backward, and their frequencies solve the quartic
/// of Timoshenko's beam with the gyroscopic moments of its sections.
#[test]
fn a_spinning_shaft_on_pins_whirls_in_circles() {
    let model = pinned_shaft().model().unwrap();
    for spin in [300.0, 3000.0, 30000.0] {
        let whirls = model.whirls(spin, 4).unwrap();
        for whirl in whirls {
            let sign = whirl.direction.signum();
            assert!((whirl.direction.abs() - 1.0).abs() <= 1e-9, "{}", whirl.direction);
            assert_eq!(whirl.is_forward(), sign > 0.0);
            assert!(whirl.eigenvalue.re.abs() <= 1e-9 * whirl.frequency());
            let waves = if whirl.frequency() < 5e3 { 1.0 } else { 2.0 };
            let near = whirl.frequency();
            let of = |omega: f64| pinned_whirl(waves, spin, sign * omega);
            let exact = root(of, 0.98 * near, 1.02 * near);
            assert!((near / exact - 1.0).abs() <= 1e-6, "{spin} {near} {exact}");
        }
    }
    // c over twice the natural frequency of each motion, and far from the small ratios where both ways to say it agree.
    let mut braked = pinned_shaft();
    let first = model.natural[0];
    braked.mass_damping = first;
    for whirl in braked.model().unwrap().whirls(0.0, 4).unwrap() {
        let ratio = first / (2.0 * whirl.eigenvalue.norm());
        assert!((whirl.damping_ratio() / ratio - 1.0).abs() <= 1e-9, "{}", whirl.damping_ratio());
        assert!(whirl.frequency() > 2.0 * first || (ratio - 0.5).abs() <= 1e-9, "{ratio}");
    }
    // It spins against Y towards Z: with the spin is with the spin, and nothing else changes.
    let [with, against] = [3000.0, -3000.0].map(|spin| model.whirls(spin, 4).unwrap());
    for (with, against) in with.iter().zip(&against) {
        assert!((with.frequency() / against.frequency() - 1.0).abs() <= 1e-9);
        assert!((with.direction - against.direction).abs() <= 1e-9);
    }
}

const DISC: BeamDisc = BeamDisc { at: LENGTH, mass: 5.0, axial: 0.04, transverse: 0.021 };

/// A clamped shaft that weighs next to nothing, a disc at its free end.
fn overhung() -> SingleShaft {
    let mut shaft = steel(LENGTH, 0.03, 0.0);
    shaft.density = 1e-3;
    let mut beam = Beam::new(vec![shaft]);
    beam.discs.push(DISC);
    let mut rotor = SingleShaft::new(beam);
    rotor.fixed = vec![Fixed::clamp(0.0)];
    rotor
}

/// Determinant of the disc's motion in circles: stiffness of a cantilever's end against force and moment.
fn overhung_whirl(spin: f64, omega: f64) -> f64 {
    let [_, moment, shear] = full(0.03);
    let [l, bending] = [LENGTH, E * moment];
    // Flexibility: deflection by force, by moment; turn by moment.
    let [a, b, c] = [l.powi(3) / (3.0 * bending) + l / shear, l * l / (2.0 * bending), l / bending];
    let d = a * c - b * b;
    let deflection = c / d - DISC.mass * omega * omega;
    let turn = a / d - DISC.transverse * omega * omega + DISC.axial * spin * omega;
    deflection * turn * d * d - b * b
}

/// Gyroscopic splitting of an overhung disc, to 1e-6; the axial inertia being the larger, no second forward critical speed.
#[test]
fn an_overhung_disc_splits_as_its_determinant_says() {
    let model = overhung().model().unwrap();
    for spin in [50.0, 400.0, 2000.0] {
        let whirls = model.whirls(spin, 4).unwrap();
        let forward = whirls.iter().filter(|whirl| whirl.is_forward()).count();
        assert_eq!([forward, whirls.len()], [2, 4]);
        for whirl in whirls {
            let near = whirl.frequency();
            let of = |omega: f64| overhung_whirl(spin, whirl.direction.signum() * omega);
            let exact = root(of, 0.999 * near, 1.001 * near);
            assert!((near / exact - 1.0).abs() <= 1e-6, "{spin} {near} {exact}");
        }
    }
    let criticals = model.critical_speeds().unwrap();
    let of_disc: Vec<_> = criticals.iter().filter(|critical| critical.speed < 1e4).collect();
    let forward: Vec<_> = of_disc.iter().filter(|c| c.whirl.is_forward()).collect();
    assert_eq!([forward.len(), of_disc.len()], [1, 3]);
    for critical in &of_disc {
        let sign = critical.whirl.direction.signum();
        let of = |speed: f64| overhung_whirl(speed, sign * speed);
        let exact = root(of, 0.999 * critical.speed, 1.001 * critical.speed);
        assert!((critical.speed / exact - 1.0).abs() <= 1e-6);
        // Where the line of the same motion has the frequency of the spin.
        let along = damped_critical_speed(&model, critical).unwrap().unwrap();
        assert!((along / critical.speed - 1.0).abs() <= 1e-9, "{along} {}", critical.speed);
        assert_is_a_motion_at_its_speed(&model, critical);
    }
}

/// Found as an eigenvector of the spin, its shape is that of one of the frequencies at that spin.
fn assert_is_a_motion_at_its_speed(model: &RotorModel, critical: &Critical) {
    let whirls = model.whirls(critical.speed, 2 * model.natural.len()).unwrap();
    let likeness = |whirl: &Whirl| critical.whirl.likeness(whirl);
    let own = whirls.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b))).unwrap();
    assert!((own.frequency() / critical.speed - 1.0).abs() <= 1e-8, "{}", own.frequency());
    // A part of 1e-4 that is missing, as rounding of both leaves 1e-6 at most.
    assert!(1.0 - likeness(own) <= 1e-8, "{} {}", critical.speed, likeness(own));
}

/// Frequencies fall and rise with speed along each line, and none jumps to another where lines cross.
#[test]
fn lines_of_the_campbell_diagram_follow_their_motions() {
    let model = overhung().model().unwrap();
    let speeds: Vec<f64> = (0..50).map(|n| 40.0 * f64::from(n)).collect();
    let campbell = model.campbell(&speeds, 4).unwrap();
    assert_eq!(campbell.lines.len(), 4);
    for line in &campbell.lines {
        assert_eq!(line.len(), speeds.len());
        let forward = line[49].is_forward();
        for pair in line[1..].windows(2) {
            let rise = pair[1].frequency() - pair[0].frequency();
            assert_eq!(pair[0].is_forward(), forward);
            assert_eq!(rise > 0.0, forward, "{rise}");
        }
    }
    // At rest the four lines are two frequencies, each of two motions, not one found twice.
    let pair = model.whirls(0.0, 2).unwrap();
    let alike = pair[0].likeness(&pair[1]);
    assert!(alike <= 0.5, "{alike}");
    let mut rest: Vec<f64> = campbell.lines.iter().map(|line| line[0].frequency()).collect();
    rest.sort_by(f64::total_cmp);
    assert!((rest[0] / rest[1] - 1.0).abs() <= 1e-9 && (rest[2] / rest[3] - 1.0).abs() <= 1e-9);
}

/// A stiff shaft on two springs with dashpots, different in Y and Z: a rigid body of four coordinates.
#[test]
fn a_stiff_shaft_on_springs_moves_as_a_rigid_body() {
    let mut shaft = steel(LENGTH, 0.03, 0.0);
    shaft.youngs_modulus *= 1e6;
    let mut rotor = SingleShaft::new(Beam::new(vec![shaft]));
    let [ky, kz, cy, cz] = [1e6, 2.5e6, 40.0, 90.0];
    let support = |at: f64| Support {
        at,
        stiffness: Matrix4::from_diagonal(&[ky, kz, 0.0, 0.0].into()),
        damping: Matrix4::from_diagonal(&[cy, cz, 0.0, 0.0].into()),
    };
    rotor.supports = vec![support(0.0), support(LENGTH)];
    let model = rotor.model().unwrap();
    let [area, ..] = full(0.03);
    let mass = DENSITY * area * LENGTH;
    let whirls = model.whirls(500.0, 4).unwrap();
    // Cylindrical motions know no spin.
    for (stiffness, damping) in [(2.0 * ky, 2.0 * cy), (2.0 * kz, 2.0 * cz)] {
        let decay = damping / (2.0 * mass);
        let exact = (stiffness / mass - decay * decay).sqrt();
        let found = whirls.iter().map(|whirl| whirl.eigenvalue);
        let best = found.min_by(|a, b| (a.im - exact).abs().total_cmp(&(b.im - exact).abs()));
        let best = best.unwrap();
        assert!((best.im / exact - 1.0).abs() <= 1e-6, "{best} {exact}");
        assert!((best.re / -decay - 1.0).abs() <= 1e-5, "{best} {decay}");
    }
    assert!(whirls.iter().all(|whirl| whirl.damping_ratio() > 0.0));
    // A support that pushes away.
    rotor.beam.segments[0].youngs_modulus = E;
    rotor.supports[0].stiffness = -rotor.supports[0].stiffness * 10.0;
    assert_eq!(rotor.model().unwrap_err(), RotorError::Unstable);
    // None at all: four rigid motions, and bending frequencies of a free shaft.
    rotor.supports.clear();
    let free = rotor.model().unwrap();
    assert_eq!(free.natural[..4], [0.0; 4]);
    assert!(free.natural[4] > 0.0);
    // At rest nothing of a rigid motion oscillates; spinning, the axis goes round about its own direction.
    assert!(free.whirls(0.0, 2).unwrap()[0].frequency() >= 0.999 * free.natural[4]);
    let first = &free.whirls(500.0, 1).unwrap()[0];
    let [area, moment, _] = full(0.03);
    let transverse = DENSITY * (area * LENGTH.powi(3) / 12.0 + moment * LENGTH);
    let precession = 2.0 * DENSITY * moment * LENGTH * 500.0 / transverse;
    assert!((first.frequency() / precession - 1.0).abs() <= 1e-6 && first.is_forward());
    // Critical speeds are those on springs too soft to matter, but for the rigid motions on these.
    rotor.modes = 60;
    let free_of_springs = rotor.model().unwrap();
    let bending = free_of_springs.critical_speeds().unwrap();
    let soft = Matrix4::from_diagonal(&[1.0, 1.0, 0.1, 0.1].into());
    rotor.supports = vec![Support { at: 0.5 * LENGTH, stiffness: soft, damping: Matrix4::zeros() }];
    let held = rotor.model().unwrap().critical_speeds().unwrap();
    let held: Vec<_> = held.iter().filter(|of| of.speed > 100.0).collect();
    assert!(bending.len() >= 8);
    for critical in bending.iter().take(8) {
        assert_is_a_motion_at_its_speed(&free_of_springs, critical);
    }
    for (free, held) in bending.iter().zip(held).take(8) {
        // 1 N/m over the shaft's stiffness of bending, some 1e7.
        let apart = (free.speed / held.speed - 1.0).abs();
        assert!(apart <= 1e-6, "{} {}", free.speed, held.speed);
        assert!((free.whirl.direction - held.whirl.direction).abs() <= 1e-6);
    }
}

/// A disc between pins on a shaft without mass: the orbit of a Jeffcott rotor, and its peak.
#[test]
fn an_unbalanced_disc_orbits_as_jeffcotts() {
    let mut shaft = steel(LENGTH, 0.03, 0.0);
    shaft.density = 1e-3;
    let mut beam = Beam::new(vec![shaft]);
    let mass = 20.0;
    beam.discs.push(BeamDisc { at: 0.5 * LENGTH, mass, axial: 0.0, transverse: 0.0 });
    let mut rotor = SingleShaft::new(beam);
    rotor.fixed = vec![Fixed::pin(0.0), Fixed::pin(LENGTH)];
    rotor.mass_damping = 100.0;
    let model = rotor.model().unwrap();
    let station = model.station(0.5 * LENGTH).unwrap();
    let [_, moment, shear] = full(0.03);
    let stiffness = 1.0 / (LENGTH.powi(3) / (48.0 * E * moment) + LENGTH / (4.0 * shear));
    let unbalance = Unbalance { at: 0.5 * LENGTH, moment: 1e-3, angle: 0.4 };
    let exact = |speed: f64| {
        let [re, im] = [stiffness - mass * speed * speed, 100.0 * mass * speed];
        1e-3 * speed * speed / re.hypot(im)
    };
    for speed in [100.0, 530.0, 2000.0] {
        let response = response(&model, &[unbalance], speed).unwrap();
        let orbit = orbit(&model, &response, station);
        let [forward, backward] = orbit.circles();
        assert!((forward / exact(speed) - 1.0).abs() <= 1e-6, "{forward} {}", exact(speed));
        assert!(backward <= 1e-9 * forward);
        // At low speed the heavy side flies out.
        if speed == 100.0 {
            let lag = (100.0 * mass * speed).atan2(stiffness - mass * speed * speed);
            assert!((orbit.y.arg() - (0.4 - lag)).abs() <= 1e-6);
            assert!((orbit.z.arg() - (0.4 - lag - PI / 2.0)).abs() <= 1e-6);
        }
    }
    let natural = (stiffness / mass).sqrt();
    let expected = natural / (1.0 - 0.5 * (100.0 / natural).powi(2)).sqrt();
    let [speed, height] = peak(&model, &[unbalance], station, [0.5 * natural, 1.5 * natural]);
    // A peak is flat: its place is known to the root of the rounding.
    assert!((speed / expected - 1.0).abs() <= 1e-6, "{speed} {expected}");
    assert!((height / exact(expected) - 1.0).abs() <= 1e-6);
}

/// Twelve motions in each plane against all: overhung and heavy, at a speed where its lines have split widely.
#[test]
fn few_natural_motions_are_enough() {
    let mut rotor = overhung();
    rotor.beam.segments[0].density = DENSITY;
    let [few, all] = [24, 1000].map(|modes| {
        let rotor = SingleShaft { modes, ..rotor.clone() };
        rotor.model().unwrap().whirls(2000.0, 6).unwrap()
    });
    for (few, all) in few.iter().zip(&all) {
        let error = few.frequency() / all.frequency() - 1.0;
        assert!(error.abs() <= 1e-10, "{} {error:e}", all.frequency());
    }
}

/// However far apart the speeds are, no motion is on two lines.
#[test]
fn no_motion_is_on_two_lines_of_the_campbell_diagram() {
    let mut rotor = overhung();
    // Two discs, whose shapes change places as they spin.
    rotor.beam.discs.push(BeamDisc { at: 0.5 * LENGTH, ..DISC });
    let model = rotor.model().unwrap();
    for top in [200.0, 1000.0, 3000.0, 1e4, 3e4] {
        let campbell = model.campbell(&[0.0, 0.5 * top, top], 6).unwrap();
        for (index, line) in campbell.lines.iter().enumerate() {
            // Where speeds are too far apart to follow a motion its line ends.
            assert!(line.len() == 3 || top == 3e4, "{top} {index}");
            for other in &campbell.lines[..index] {
                for (at, (one, other)) in line.iter().rev().zip(other.iter().rev()).enumerate() {
                    let alike = one.likeness(other);
                    assert!(alike <= 1.0 - 1e-6, "{top} {at} {index}: {alike}");
                }
            }
        }
    }
}

/// At a high speed the two slowest motions are backward; each is followed down to its own pair at rest, past the forward
/// one of the first pair, which is slower there than the second.
#[test]
fn lines_that_cross_are_followed_to_rest() {
    let mut rotor = overhung();
    rotor.beam.discs.push(BeamDisc { at: 0.5 * LENGTH, ..DISC });
    let model = rotor.model().unwrap();
    let pairs = model.whirls(0.0, 6).unwrap();
    let speeds: Vec<f64> = (0..=100).map(|n| 100.0 * f64::from(n)).collect();
    let campbell = model.campbell(&speeds, 2).unwrap();
    for (index, line) in campbell.lines.iter().enumerate() {
        assert!(line[1..].iter().all(|whirl| !whirl.is_forward()), "{index}");
        let rest = pairs[2 * index].frequency();
        // As near as the two motions of a pair at rest are to each other.
        let miss = line[0].frequency() / rest - 1.0;
        assert!(miss.abs() <= 1e-9, "{index}: {miss}");
    }
}

/// y = 3 cos φ, z = 2 sin φ: an ellipse of half axes 3 and 2, whichever way it is gone round.
#[test]
fn an_ellipse_is_as_long_as_both_circles_together() {
    for around in [-2.0, 2.0] {
        let orbit = Orbit { y: Complex::new(3.0, 0.0), z: Complex::new(0.0, around) };
        assert!((orbit.semi_major() - 3.0).abs() <= 1e-15, "{}", orbit.semi_major());
        let [forward, backward] = orbit.circles();
        let farthest = (0..360).map(|i| f64::from(i).to_radians().sin_cos());
        let farthest =
            farthest.map(|(sin, cos)| (3.0 * cos).hypot(around * sin)).fold(0.0, f64::max);
        assert!((forward + backward - farthest).abs() <= 1e-14, "{forward} {backward}");
    }
}
