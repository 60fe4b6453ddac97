//! A shaft of stations against beams that have closed forms.

use bearing_dynamics::ch4_rotor::beam::{Section, ShearCoefficient};
use bearing_dynamics::members::beam::{
    Beam, BeamDisc, BeamError, BeamMatrices, BeamSegment, STATION,
};
use nalgebra::{DMatrix, DVector};
use std::f64::consts::PI;

pub const E: f64 = 210e9;
const NU: f64 = 0.3;
pub const DENSITY: f64 = 7850.0;

pub fn steel(length: f64, outer_diameter: f64, inner_diameter: f64) -> BeamSegment {
    BeamSegment {
        length,
        outer_diameter,
        inner_diameter,
        density: DENSITY,
        youngs_modulus: E,
        poisson_ratio: NU,
    }
}

/// Area, second moment, κ G A of a full section.
pub fn full(diameter: f64) -> [f64; 3] {
    let area = PI / 4.0 * diameter * diameter;
    let kappa = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU);
    [area, PI / 64.0 * diameter.powi(4), kappa * E / (2.0 + 2.0 * NU) * area]
}

/// Rows and columns that are not held.
fn part(matrix: &DMatrix<f64>, free: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])])
}

fn without(count: usize, held: &[usize]) -> Vec<usize> {
    (0..count).filter(|i| !held.contains(i)).collect()
}

/// Frequencies of the shaft at rest, rad/s, ascending.
fn frequencies(of: &BeamMatrices, held: &[usize]) -> Vec<f64> {
    let free = without(of.mass.nrows(), held);
    let factor = part(&of.mass, &free).cholesky().expect("mass").l();
    let half = factor.solve_lower_triangular(&part(&of.stiffness, &free)).expect("regular");
    let whole = factor.solve_lower_triangular(&half.transpose()).expect("regular");
    let mut squares: Vec<f64> =
        ((&whole + whole.transpose()) * 0.5).symmetric_eigenvalues().iter().copied().collect();
    squares.sort_by(f64::total_cmp);
    squares.iter().map(|square| square.max(0.0).sqrt()).collect()
}

/// A cantilever of two sections under a force and a moment at its end: bending and shear of each length exactly, whatever the
/// elements.
#[test]
fn a_stepped_cantilever_bends_as_beam_theory_says() {
    let [a, b] = [0.15, 0.25];
    for longest in [1.0, 0.03] {
        let mut beam = Beam::new(vec![steel(a, 0.04, 0.0), steel(b, 0.03, 0.0)]);
        beam.longest_element = longest;
        let matrices = beam.matrices(&[0.2]).unwrap();
        let last = matrices.stations.len() - 1;
        assert!((matrices.stations[last] - 0.4).abs() <= 1e-15);
        let free = without(matrices.stiffness.nrows(), &[0, 1, 2, 3]);
        let mut loads = DVector::zeros(STATION * (last + 1));
        let [force, moment] = [-3000.0, 40.0];
        loads[STATION * last + 1] = force;
        loads[STATION * last + 2] = moment;
        let loads = DVector::from_fn(free.len(), |i, _| loads[free[i]]);
        let moved = part(&matrices.stiffness, &free).lu().solve(&loads).unwrap();
        let end = free.len() - STATION;
        // Bending moment about −Y at s from the end is F s − M; the deflection's slope is −turn_y.
        let [_, thick, thick_shear] = full(0.04);
        let [_, thin, thin_shear] = full(0.03);
        let integral = |power: i32| {
            let part = |from: f64, to: f64| (to.powi(power) - from.powi(power)) / f64::from(power);
            part(0.0, b) / (E * thin) + part(b, a + b) / (E * thick)
        };
        let deflection =
            force * integral(3) - moment * integral(2) + force * (b / thin_shear + a / thick_shear);
        let turn = -(force * integral(2) - moment * integral(1));
        assert!((moved[end + 1] / deflection - 1.0).abs() <= 1e-10, "{longest}");
        assert!((moved[end + 2] / turn - 1.0).abs() <= 1e-10, "{longest}");
        assert_eq!([moved[end], moved[end + 3]], [0.0, 0.0]);
    }
}

/// A pinned shaft of n half waves: det of the two equations of Timoshenko's beam, ω the lower root.
fn pinned(waves: f64, length: f64, diameter: f64) -> f64 {
    let [area, moment, shear] = full(diameter);
    let k = waves * PI / length;
    let [m, i] = [DENSITY * area, DENSITY * moment];
    let b = m * (E * moment * k * k + shear) + i * shear * k * k;
    let c = shear * k * k * E * moment * k * k;
    let a = m * i;
    ((2.0 * c) / (b + (b * b - 4.0 * a * c).sqrt())).sqrt()
}

/// Of the pinned shaft's nth frequency, relative.
fn pinned_error(diameter: f64, elements: usize, waves: usize) -> f64 {
    let mut beam = Beam::new(vec![steel(0.4, diameter, 0.0)]);
    beam.longest_element = 0.4 / elements as f64 * (1.0 + 1e-9);
    let matrices = beam.matrices(&[]).unwrap();
    let last = STATION * (matrices.stations.len() - 1);
    let found = frequencies(&matrices, &[0, 1, last, last + 1]);
    let mode = 2 * (waves - 1);
    // Both planes alike, but for the rounding of eigenvalues that are up to 1e9 times as large.
    assert!((found[mode] / found[mode + 1] - 1.0).abs() <= 1e-6);
    found[mode] / pinned(waves as f64, 0.4, diameter) - 1.0
}

#[test]
fn a_pinned_shaft_vibrates_as_its_frequency_equation_says() {
    // The eighth order of the element's length; two elements are not yet all the way there.
    let [coarse, fine] = [2, 4].map(|elements| pinned_error(0.03, elements, 1));
    let order = (coarse / fine).log2();
    assert!(fine > 0.0 && (7.0..=8.5).contains(&order), "{coarse:e} {fine:e} {order}");
    // A slender one, where shear is a hundred times less, does not lock; its errors are of the sixth order.
    for diameter in [0.03, 0.003] {
        let [first, third] = [1, 3].map(|waves| pinned_error(diameter, 8, waves));
        assert!(first.abs() <= 1e-7 && third.abs() <= 2e-5, "{diameter}: {first:e} {third:e}");
    }
}

/// Rigid motions cost no strain and carry the mass and inertias of the shaft and its disc.
#[test]
fn rigid_motions_are_free_and_carry_the_whole_inertia() {
    let mut beam = Beam::new(vec![steel(0.3, 0.03, 0.01), steel(0.1, 0.05, 0.01)]);
    beam.discs.push(BeamDisc { at: 0.11, mass: 2.0, axial: 0.01, transverse: 0.006 });
    let matrices = beam.matrices(&[0.2, 0.25]).unwrap();
    let motions = matrices.rigid_motions(0.0);
    let scale = matrices.stiffness.amax();
    for motion in &motions {
        assert!((&matrices.stiffness * motion).amax() <= 1e-13 * scale);
    }
    let area = |d: f64| PI / 4.0 * (d * d - 0.01 * 0.01);
    let moment = |d: f64| PI / 64.0 * (d.powi(4) - 0.01f64.powi(4));
    let lengths = [(0.0, 0.3, 0.03), (0.3, 0.4, 0.05)];
    let sum = |of: &dyn Fn(f64, f64, f64) -> f64| -> f64 {
        lengths.iter().map(|&(from, to, d)| DENSITY * of(from, to, d)).sum()
    };
    let mass = sum(&|from, to, d| area(d) * (to - from)) + 2.0;
    let first = sum(&|from, to, d| area(d) * (to * to - from * from) / 2.0) + 2.0 * 0.11;
    let about_end =
        sum(&|from, to, d| area(d) * (to.powi(3) - from.powi(3)) / 3.0 + moment(d) * (to - from))
            + 2.0 * 0.11 * 0.11
            + 0.006;
    let axial = sum(&|from, to, d| 2.0 * moment(d) * (to - from)) + 0.01;
    let of = |matrix: &DMatrix<f64>, i: usize, j: usize| motions[i].dot(&(matrix * &motions[j]));
    for (value, expected) in [
        (of(&matrices.mass, 0, 0), mass),
        (of(&matrices.mass, 1, 1), mass),
        (of(&matrices.mass, 1, 2), -first),
        (of(&matrices.mass, 0, 3), first),
        (of(&matrices.mass, 2, 2), about_end),
        (of(&matrices.mass, 3, 3), about_end),
        (of(&matrices.gyroscopic, 2, 3), axial),
        (of(&matrices.gyroscopic, 3, 2), -axial),
        (matrices.axial_mass.sum(), mass),
    ] {
        assert!((value / expected - 1.0).abs() <= 1e-11, "{value} {expected}");
    }
    let skew = &matrices.gyroscopic + matrices.gyroscopic.transpose();
    assert_eq!(skew.amax(), 0.0);
    // A bar: the flexibilities of its lengths add.
    let last = matrices.stations.len() - 1;
    let free: Vec<usize> = (1..=last).collect();
    let mut pull = DVector::zeros(last);
    pull[last - 1] = 1.0;
    let moved = part(&matrices.axial_stiffness, &free).lu().solve(&pull).unwrap();
    let expected = 0.3 / (E * area(0.03)) + 0.1 / (E * area(0.05));
    assert!((moved[last - 1] / expected - 1.0).abs() <= 1e-12);
}

/// Places, discs and steps have stations; elements are no longer than asked; values that no shaft has are told.
#[test]
fn stations_stand_where_they_are_asked_for() {
    let mut beam = Beam::new(vec![steel(0.3, 0.03, 0.0), steel(0.1, 0.05, 0.0)]);
    beam.discs.push(BeamDisc { at: 0.4, mass: 1.0, axial: 0.0, transverse: 0.0 });
    beam.longest_element = 0.06;
    let places = [0.0, 0.123, 0.3, 0.123 + 1e-12];
    let matrices = beam.matrices(&places).unwrap();
    for at in places {
        let station = matrices.station(at).expect("a station");
        assert!((matrices.stations[station] - at).abs() <= 1e-9);
    }
    assert_eq!(matrices.station(0.2), None);
    assert_eq!(matrices.station(1.0), None);
    assert_eq!(matrices.stations.len(), 4 * (3 + 3 + 2) + 1);
    assert!(matrices.stations.windows(2).all(|pair| pair[1] - pair[0] <= 0.06));
    assert_eq!(matrices.mass.nrows(), STATION * matrices.stations.len());

    let off = beam.matrices(&[0.41]).unwrap_err();
    assert!(matches!(off, BeamError::OffShaft { at: 0.41, .. }), "{off}");
    assert_eq!(Beam::new(vec![]).matrices(&[]), Err(BeamError::NoSegment));
    let faults: [fn(&mut Beam); 6] = [
        |beam| beam.segments[1].inner_diameter = 0.05,
        |beam| beam.segments[0].density = f64::NAN,
        |beam| beam.discs[0].mass = -1.0,
        |beam| beam.longest_element = 0.0,
        |beam| beam.longest_element = 1e-5,
        |beam| beam.shear_coefficient = ShearCoefficient::Given(0.0),
    ];
    for fault in faults {
        let mut beam = beam.clone();
        fault(&mut beam);
        assert!(beam.matrices(&[]).is_err());
    }
}

/// Full sections and thin tubes as the papers have them, and rings between: both formulas are quotients of
/// polynomials in both diameters that do not tell these apart.
#[test]
fn shear_coefficients_of_full_sections_rings_and_tubes() {
    let of = |law: ShearCoefficient, outer_diameter: f64, inner_diameter: f64, nu: f64| {
        law.of(&Section { outer_diameter, inner_diameter }, nu)
    };
    for nu in [0.0, 0.2, 0.3, 0.5] {
        let one = 1.0 + nu;
        for (law, full, tube) in [
            (ShearCoefficient::Cowper, 6.0 * one / (7.0 + 6.0 * nu), 2.0 * one / (4.0 + 3.0 * nu)),
            (
                ShearCoefficient::Hutchinson,
                6.0 * one * one / (7.0 + 12.0 * nu + 4.0 * nu * nu),
                one / (2.0 + nu),
            ),
        ] {
            assert!((of(law, 0.03, 0.0, nu) - full).abs() <= 1e-15, "{law:?} {nu}");
            assert!((of(law, 0.03, 0.03, nu) - tube).abs() <= 1e-15, "{law:?} {nu}");
            for inner in [0.01, 0.02, 0.029] {
                let (ring, turned) = (of(law, 0.03, inner, nu), of(law, inner, 0.03, nu));
                assert!((ring - turned).abs() <= 1e-14, "{law:?} {nu}: {ring} {turned}");
                assert!(ring > tube && ring < full, "{law:?} {nu}: {ring}");
            }
        }
    }
}
