//! What any material law has to keep, in one list that all of them run through: objectivity, symmetry,
//! stress as the derivative of energy, tangent as the derivative of stress, rest without stress.

use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::maxwell::{Maxwell, StepFactors, relaxed_history};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::kinematics::strain::{
    Mat3, Sym3, Tangent, applied, cauchy, double_dot, full, green_lagrange,
};

type Of<T> = Box<dyn Fn(&Sym3) -> T>;

struct Law {
    name: &'static str,
    /// Of laws without a history, J/m³.
    energy: Option<Of<f64>>,
    stress: Of<Sym3>,
    tangent: Of<Tangent>,
    /// Its stresses are measured by it, Pa.
    modulus: f64,
    /// Components of displacement gradients are taken up to this.
    strains: f64,
}

fn chain(locking: f64, bulk: f64, pull: ChainPull) -> EightChain {
    EightChain::new(1e6, locking, bulk, pull).unwrap()
}

fn network(name: &'static str, network: EightChain, strains: f64) -> Law {
    Law {
        name,
        energy: Some(Box::new(move |e| network.energy_density(e).unwrap())),
        stress: Box::new(move |e| network.second_piola_kirchhoff(e).unwrap()),
        tangent: Box::new(move |e| network.tangent(e).unwrap().1),
        modulus: network.bulk,
        strains,
    }
}

/// The stress at the end of a step with a history behind it.
fn with_history() -> Law {
    let network = chain(8.0, 1e8, ChainPull::FiveTerms);
    let elements = [Maxwell { gamma: 3.0, tau: 0.1 }, Maxwell { gamma: 0.7, tau: 2.0 }];
    let factors = StepFactors::of(&elements, 0.05).unwrap();
    let history = [[2e4, -1e4, 5e3, 1e4, -2e4, 3e3], [1e4, 2e4, 5e4, -1e4, 2e4, 1e3]];
    let past = relaxed_history(&history, &[3e4, 1e4, -4e4, 2e3, 8e3, -1e3], &factors);
    let gain = factors.total_gain;
    Law {
        name: "eight chains with Maxwell elements after a step",
        energy: None,
        stress: Box::new(move |e| {
            let (whole, own) =
                (network.second_piola_kirchhoff(e).unwrap(), network.isochoric_stress(e).unwrap());
            std::array::from_fn(|i| whole[i] + gain * own[i] + past[i])
        }),
        tangent: Box::new(move |e| {
            let (whole, own) =
                (network.tangent(e).unwrap().1, network.isochoric_tangent(e).unwrap());
            std::array::from_fn(|i| std::array::from_fn(|j| whole[i][j] + gain * own.1[i][j]))
        }),
        modulus: 1e8,
        strains: 0.25,
    }
}

fn laws() -> Vec<Law> {
    let steel = LinearElastic::new(2.1e11, 0.3).unwrap();
    vec![
        Law {
            name: "linear elasticity",
            energy: Some(Box::new(move |e| steel.energy_density(e))),
            stress: Box::new(move |e| steel.second_piola_kirchhoff(e)),
            tangent: Box::new(move |_| {
                let mut columns = [[0.0; 6]; 6];
                for b in 0..6 {
                    let mut unit = [0.0; 6];
                    unit[b] = if b < 3 { 1.0 } else { 0.5 };
                    let of = steel.second_piola_kirchhoff(&unit);
                    (0..6).for_each(|a| columns[a][b] = of[a]);
                }
                columns
            }),
            modulus: 2.1e11,
            strains: 0.25,
        },
        network("eight chains", chain(8.0, 1e8, ChainPull::FiveTerms), 0.25),
        network("eight chains that soon are straight", chain(2.0, 2e6, ChainPull::FiveTerms), 0.25),
        network("eight chains, exact pull", chain(8.0, 1e8, ChainPull::Exact), 0.25),
        network("exact pull near its limit", chain(1.05, 2e6, ChainPull::Exact), 0.08),
        network(
            "bulk modulus 1e5 times the rubber's",
            chain(8.0, 1e11, ChainPull::FiveTerms),
            0.25,
        ),
        with_history(),
    ]
}

/// Numbers without pattern in (−1, 1).
fn scatter(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn gradient(seed: &mut u64, up_to: f64) -> Mat3 {
    [[0.0; 3]; 3].map(|row: [f64; 3]| row.map(|_| up_to * scatter(seed)))
}

fn largest(s: &Sym3) -> f64 {
    s.iter().fold(0.0, |m: f64, x| m.max(x.abs()))
}

const TRIES: usize = 40;

#[test]
fn turning_a_body_turns_its_cauchy_stress() {
    let mut seed = 3;
    for law in laws() {
        for _ in 0..TRIES {
            let h = gradient(&mut seed, law.strains);
            let angles = [0; 3].map(|_| 3.0 * scatter(&mut seed));
            let turn = nalgebra::Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
            let f = nalgebra::Matrix3::from_fn(|i, j| h[i][j] + f64::from(u8::from(i == j)));
            let turned = turn * f - nalgebra::Matrix3::identity();
            let turned: Mat3 = std::array::from_fn(|i| std::array::from_fn(|j| turned[(i, j)]));
            let stress = |h: &Mat3| {
                let t = full(&cauchy(h, &(law.stress)(&green_lagrange(h))));
                nalgebra::Matrix3::from_fn(|i, j| t[i][j])
            };
            let expected = turn * stress(&h) * turn.inverse();
            let gap = (stress(&turned) - expected).abs().max();
            // Rounding of products of gradients of up to 2.
            assert!(gap <= 1e-13 * law.modulus, "{}: {gap:e}", law.name);
        }
    }
}

#[test]
fn stress_is_the_derivative_of_energy() {
    let mut seed = 5;
    for law in laws() {
        let Some(energy) = &law.energy else { continue };
        for _ in 0..TRIES {
            let e = green_lagrange(&gradient(&mut seed, law.strains));
            let s = (law.stress)(&e);
            for i in 0..6 {
                let step = 1e-5;
                let at = |by: f64| {
                    let mut e = e;
                    e[i] += by;
                    energy(&e)
                };
                // Of fourth order, since a straight chain's energy bends much.
                let slope = (8.0 * (at(step) - at(-step)) - (at(2.0 * step) - at(-2.0 * step)))
                    / (12.0 * step);
                let expected = if i < 3 { s[i] } else { 2.0 * s[i] };
                // Rounding of energies of up to the modulus, 1e-16/1e-5, and what the fourth order leaves
                // near the pole of straight chains.
                let gap = (slope - expected).abs();
                assert!(gap <= 1e-9 * law.modulus, "{} {i}: {gap:e} {e:?}", law.name);
            }
        }
    }
}

#[test]
fn tangent_is_the_derivative_of_stress() {
    let mut seed = 7;
    for law in laws() {
        for _ in 0..TRIES {
            let e = green_lagrange(&gradient(&mut seed, law.strains));
            let tangent = (law.tangent)(&e);
            let change: Sym3 = [0.0; 6].map(|_: f64| scatter(&mut seed));
            let step = 1e-5;
            let at = |by: f64| (law.stress)(&std::array::from_fn(|i| e[i] + by * change[i]));
            let [a, b, c, d] = [-2.0, -1.0, 1.0, 2.0].map(|k: f64| at(k * step));
            let slope: Sym3 =
                std::array::from_fn(|i| (8.0 * (c[i] - b[i]) - (d[i] - a[i])) / (12.0 * step));
            let ours = applied(&tangent, &change);
            let gap = largest(&std::array::from_fn(|i| ours[i] - slope[i]));
            // As for energies, of stresses of several moduli.
            assert!(gap <= 1e-9 * law.modulus.max(largest(&slope)), "{}: {gap:e}", law.name);
        }
    }
}

#[test]
fn tangents_are_symmetric() {
    let mut seed = 11;
    for law in laws() {
        for _ in 0..TRIES {
            let tangent = (law.tangent)(&green_lagrange(&gradient(&mut seed, law.strains)));
            for (a, row) in tangent.iter().enumerate() {
                for (b, entry) in row.iter().enumerate() {
                    let gap = (entry - tangent[b][a]).abs();
                    assert!(gap <= 1e-13 * law.modulus, "{}: {gap:e}", law.name);
                }
            }
        }
    }
}

#[test]
fn rest_has_neither_energy_nor_stress() {
    for law in laws() {
        let Some(energy) = &law.energy else { continue };
        assert_eq!((law.stress)(&[0.0; 6]), [0.0; 6], "{}", law.name);
        assert_eq!(energy(&[0.0; 6]), 0.0, "{}", law.name);
    }
}

/// At a strain of 1e-9 the law is its tangent at rest, to every digit: none is lost by C − 1, J − 1
/// or Ī₁ − 3.
#[test]
fn small_strains_keep_their_digits() {
    let mut seed = 13;
    for law in laws() {
        let Some(energy) = &law.energy else { continue };
        let rest = (law.tangent)(&[0.0; 6]);
        for _ in 0..TRIES {
            let e: Sym3 = [0.0; 6].map(|_: f64| 1e-9 * scatter(&mut seed));
            let linear = applied(&rest, &e);
            let s = (law.stress)(&e);
            let gap = largest(&std::array::from_fn(|i| s[i] - linear[i]));
            // Second-order terms, some ten times the strain; of the modulus where by chance the volume
            // hardly changes.
            let scale = largest(&linear).max(1e-9 * law.modulus);
            assert!(gap <= 1e-7 * scale, "{}: {gap:e}", law.name);
            let quadratic = 0.5 * double_dot(&linear, &e);
            let gap = (energy(&e) - quadratic).abs();
            assert!(gap <= 1e-7 * quadratic.max(1e-18 * law.modulus), "{}: {gap:e}", law.name);
        }
    }
}
