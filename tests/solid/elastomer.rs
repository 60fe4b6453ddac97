//! Rubber: the network beside its printed form and Maxwell elements.

use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::maxwell::{
    DashpotFactors, Maxwell, StepFactors, commit, complex_factor, curvature_error, relaxed_history,
    spring_energy,
};
use bearing_dynamics::ch2_housing::elastomer::{ElastomerError, named};
use bearing_dynamics::kinematics::strain::{Sym3, double_dot, green_lagrange};
use std::f64::consts::TAU;

fn chain(pull: ChainPull) -> EightChain {
    EightChain::new(0.647e6, 8.0, 64.7e6, pull).unwrap()
}

/// (3.7) as it is printed, by plain products.
fn printed(c_r: f64, n: f64, b: f64, e: &Sym3) -> Sym3 {
    let one = nalgebra::Matrix3::identity();
    let e = nalgebra::Matrix3::new(e[0], e[3], e[5], e[3], e[1], e[4], e[5], e[4], e[2]);
    let c: nalgebra::Matrix3<f64> = one + 2.0 * e;
    let (i1, j) = (c.trace(), c.determinant().sqrt());
    let inverse = c.try_inverse().unwrap();
    let x = i1 / (n * j.powf(2.0 / 3.0));
    let sum = 0.5
        + x / 10.0
        + 33.0 / 1050.0 * x * x
        + 76.0 / 7000.0 * x.powi(3)
        + 2595.0 / 673_750.0 * x.powi(4);
    let s = 2.0 * c_r / j.powf(2.0 / 3.0) * sum * (one - i1 / 3.0 * inverse)
        + j * b * (j - 1.0) * inverse;
    [s[(0, 0)], s[(1, 1)], s[(2, 2)], s[(0, 1)], s[(1, 2)], s[(2, 0)]]
}

#[test]
fn the_stress_is_the_printed_one() {
    let network = chain(ChainPull::FiveTerms);
    for k in 0..30 {
        let turn = 0.7 * f64::from(k);
        let h = [
            [0.4 * turn.sin(), 0.3, -0.2 * turn.cos()],
            [0.1, -0.3 * turn.cos(), 0.25],
            [0.3 * turn.sin(), -0.1, 0.2],
        ];
        let e = green_lagrange(&h);
        let ours = network.second_piola_kirchhoff(&e).unwrap();
        let theirs = printed(0.647e6, 8.0, 64.7e6, &e);
        for (ours, theirs) in ours.iter().zip(theirs) {
            // Rounding of (1 − I₁C⁻¹/3) and J − 1 in the printed form, with C⁻¹ up to 10.
            assert!((ours - theirs).abs() <= 1e-13 * 64.7e6, "{ours} {theirs}");
        }
    }
}

#[test]
fn shear_modulus_at_rest() {
    let five = chain(ChainPull::FiveTerms).shear_modulus() / 0.647e6;
    assert!((five - 1.0851).abs() <= 0.5e-4, "{five}");
    // The series leaves out the sixth term, some 1e-5 of the sum at N = 8.
    let exact = chain(ChainPull::Exact).shear_modulus() / 0.647e6;
    assert!(exact > five && exact < five * (1.0 + 5e-5), "{exact} {five}");
    let all = named::table_3_1();
    // Σγ = 33.675 in Table 3.1.
    assert!((all.instantaneous_shear_modulus() / (five * 0.647e6) - 34.675).abs() <= 1e-9);
}

fn stretched(axial: f64) -> Sym3 {
    let lateral = 1.0 / axial.sqrt();
    let half = |stretch: f64| 0.5 * (stretch * stretch - 1.0);
    [half(axial), half(lateral), half(lateral), 0.0, 0.0, 0.0]
}

#[test]
fn exact_chains_are_the_series_until_they_lock() {
    let (five, exact) = (chain(ChainPull::FiveTerms), chain(ChainPull::Exact));
    let pair = |stretch: f64| {
        [five, exact].map(|law| law.isochoric_stress(&stretched(stretch)).unwrap()[0])
    };
    let [a, b] = pair(0.74);
    assert!((b / a - 1.0).abs() <= 4e-4, "{a} {b}");
    // √8 · √3 pulls chains straight at an axial stretch of 4.857.
    let mut last = 0.0;
    for stretch in [3.0, 4.0, 4.5, 4.8, 4.85] {
        let [a, b] = pair(stretch);
        assert!(b > a && b > last, "{stretch}: {a} {b}");
        last = b;
    }
    for stretch in [4.86, 6.0, 1e3] {
        let e = stretched(stretch);
        let refused = [
            exact.second_piola_kirchhoff(&e).map(|_| ()),
            exact.isochoric_tangent(&e).map(|_| ()),
            exact.energy_density(&e).map(|_| ()),
        ];
        for refused in refused {
            let Err(ElastomerError::Locked { stretch, limit }) = refused else {
                panic!("{refused:?}");
            };
            assert!(stretch > limit && (limit - 8f64.sqrt()).abs() <= 1e-12);
        }
    }
}

#[test]
fn constants_out_of_range_are_refused() {
    let network = |c: f64, n: f64, b: f64, pull| EightChain::new(c, n, b, pull).map(|_| ());
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let five = ChainPull::FiveTerms;
        // NaN is no equal of itself.
        let same =
            |a: Result<(), ElastomerError>, b| format!("{a:?}") == format!("{:?}", Err::<(), _>(b));
        assert!(same(network(bad, 8.0, 1.0, five), ElastomerError::Modulus(bad)));
        assert!(same(network(1.0, bad, 1.0, five), ElastomerError::Locking(bad)));
        assert!(same(network(1.0, 8.0, bad, five), ElastomerError::Bulk(bad)));
        assert!(same(Maxwell::new(bad, 1.0).map(|_| ()), ElastomerError::Gamma(bad)));
        assert!(same(Maxwell::new(1.0, bad).map(|_| ()), ElastomerError::Tau(bad)));
    }
    assert_eq!(network(1.0, 1.0, 1.0, ChainPull::Exact), Err(ElastomerError::LockedAtRest(1.0)));
    assert_eq!(network(1.0, 1.0, 1.0, ChainPull::FiveTerms), Ok(()));
    let flat = chain(ChainPull::FiveTerms).second_piola_kirchhoff(&[-0.5, 0.0, 0.0, 0.0, 0.0, 0.0]);
    assert!(matches!(flat, Err(ElastomerError::NoDeformation(det)) if det == 0.0));
}

/// DEV S over time, in steps: H of each element at the end, and their sum along the way.
fn course(elements: &[Maxwell], stress: impl Fn(f64) -> f64, dt: f64, steps: usize) -> Vec<f64> {
    let factors = StepFactors::of(elements, dt).unwrap();
    let mut history = vec![[0.0; 6]; elements.len()];
    let mut sums = Vec::new();
    for n in 0..steps {
        let [a, b] = [n, n + 1].map(|n| stress(n as f64 * dt));
        commit(&mut history, &[b - a, 0.0, 0.0, 0.0, 0.0, 0.0], &factors);
        sums.push(history.iter().map(|h| h[0]).sum());
    }
    sums
}

#[test]
fn a_held_strain_relaxes_to_the_network() {
    let rubber = named::table_3_1();
    let sudden = StepFactors::of(&rubber.maxwell, 0.0).unwrap();
    let jump = [1e6, -5e5, -5e5, 2e5, 0.0, 0.0];
    let mut history = vec![[0.0; 6]; 14];
    commit(&mut history, &jump, &sudden);
    for (h, element) in history.iter().zip(&rubber.maxwell) {
        assert_eq!(h[0], element.gamma * 1e6);
    }
    let mut reached = 0.0;
    for dt in [1e-7, 1e-3, 0.1, 1.0, 5.0] {
        commit(&mut history, &[0.0; 6], &StepFactors::of(&rubber.maxwell, dt).unwrap());
        reached += dt;
        let sum: f64 = history.iter().map(|h| h[0]).sum();
        let expected: f64 =
            rubber.maxwell.iter().map(|m| 1e6 * m.gamma * (-reached / m.tau).exp()).sum();
        // Products of exponentials in place of one.
        assert!((sum - expected).abs() <= 1e-13 * 33.7e6, "{reached}: {sum} {expected}");
    }
    commit(&mut history, &[0.0; 6], &StepFactors::of(&rubber.maxwell, 400.0).unwrap());
    let left = history.iter().map(|h| h[0].abs()).fold(0.0, f64::max);
    // 10 s at most, forty times.
    assert!(left <= 1e-11, "{left}");
}

#[test]
fn a_straight_course_is_exact_in_any_steps() {
    for tau in [1e-6, 1e-2, 1.0, 1e6] {
        let one = [Maxwell { gamma: 1.7, tau }];
        let exact = -1.7 * tau * (-1.0 / tau).exp_m1();
        for steps in [1, 7, 1000] {
            let found = *course(&one, |t| t, 1.0 / steps as f64, steps).last().unwrap();
            // Rounding adds up over the steps.
            assert!(
                (found / exact - 1.0).abs() <= 1e-13 * steps as f64,
                "{tau} {steps}: {found} {exact}"
            );
        }
    }
}

#[test]
fn none_or_twice_the_same_element() {
    assert_eq!(StepFactors::of(&[], 0.1).unwrap().total_gain, 0.0);
    assert_eq!(relaxed_history(&[], &[1.0; 6], &StepFactors::of(&[], 0.1).unwrap()), [-0.0; 6]);
    let whole = [Maxwell { gamma: 2.0, tau: 0.3 }];
    let halves = [Maxwell { gamma: 1.0, tau: 0.3 }; 2];
    let wave = |t: f64| (3.0 * t).sin();
    for (a, b) in course(&whole, wave, 0.05, 40).iter().zip(course(&halves, wave, 0.05, 40)) {
        assert!((a - b).abs() <= 1e-14);
    }
}

/// Carried stress and gain give what committing gives.
#[test]
fn the_search_and_the_commit_agree() {
    let rubber = named::table_3_1();
    let factors = StepFactors::of(&rubber.maxwell, 3e-4).unwrap();
    let mut history = vec![[0.0; 6]; 14];
    for (j, h) in history.iter_mut().enumerate() {
        *h = std::array::from_fn(|i| 1e5 * ((3 * j + i) as f64).sin());
    }
    let before: Sym3 = std::array::from_fn(|i| 4e5 * (i as f64 + 0.3).cos());
    let after: Sym3 = std::array::from_fn(|i| 5e5 * (i as f64 - 0.1).sin());
    let past = relaxed_history(&history, &before, &factors);
    commit(&mut history, &std::array::from_fn(|i| after[i] - before[i]), &factors);
    for i in 0..6 {
        let committed: f64 = history.iter().map(|h| h[i]).sum();
        let sought = factors.total_gain * after[i] + past[i];
        assert!((committed - sought).abs() <= 1e-14 * 33.7 * 5e5, "{committed} {sought}");
    }
}

/// Second order, and the estimate of a step's error is the error.
#[test]
fn the_recursion_is_of_second_order_and_knows_its_error() {
    let elements = [Maxwell { gamma: 1.5, tau: 0.2 }, Maxwell { gamma: 4.0, tau: 1e-4 }];
    // ∫ exp(−(1 − s)/τ) 2s ds.
    let exact: f64 = elements
        .iter()
        .map(|Maxwell { gamma, tau }| gamma * 2.0 * tau * (1.0 - tau * -(-1.0 / tau).exp_m1()))
        .sum();
    let slow_only = |steps: usize| {
        let one = &elements[..1];
        let exact = 1.5 * 2.0 * 0.2 * (1.0 - 0.2 * -(-5.0f64).exp_m1());
        course(one, |t| t * t, 1.0 / steps as f64, steps).last().unwrap() - exact
    };
    let order = (slow_only(20) / slow_only(40)).log2();
    assert!((order - 2.0).abs() <= 0.02, "{order}");
    // One step of a parabola: curvature 2.
    let error = exact - course(&elements, |t| t * t, 1.0, 1)[0];
    let estimate = 2.0 * curvature_error(&elements, 1.0);
    assert!((error / estimate - 1.0).abs() <= 1e-12, "{error} {estimate}");
    for ratio in [0.999_999e-2, 1.000_001e-2] {
        let one = [Maxwell { gamma: 1.0, tau: 1.0 }];
        let series = ratio * ratio * ratio * (1.0 / 12.0 - ratio / 24.0 + ratio * ratio / 80.0);
        // x³/360 is left out; cancellation of the closed form, 1e-16/x².
        assert!((curvature_error(&one, ratio) / series - 1.0).abs() <= 1e-7, "{ratio}");
    }
}

/// Work of a strain of 1e-4 that swings and stops is what the network and the springs hold and what
/// the dashpots took.
#[test]
fn energy_closes_at_small_strain() {
    let rubber = named::table_3_1();
    let mu = rubber.network.shear_modulus();
    let strain = |t: f64| -> Sym3 {
        let swing = 1e-4 * (TAU * t).sin();
        [swing, -0.5 * swing, -0.5 * swing, 0.7 * swing, 0.0, -0.2 * swing]
    };
    for (dt, steps) in [(1e-2, 130), (1e-3, 1300)] {
        let factors = StepFactors::of(&rubber.maxwell, dt).unwrap();
        let mut dashpots = DashpotFactors::default();
        dashpots.set(&rubber.maxwell, dt);
        let mut history = vec![[0.0; 6]; 14];
        let (mut work, mut lost) = (0.0, 0.0);
        let total = |history: &[Sym3], t: f64| -> Sym3 {
            let own = rubber.network.second_piola_kirchhoff(&strain(t)).unwrap();
            std::array::from_fn(|i| own[i] + history.iter().map(|h| h[i]).sum::<f64>())
        };
        for n in 0..steps {
            let [a, b] = [n, n + 1].map(|n| n as f64 * dt);
            let [from, to] = [a, b].map(|t| rubber.network.isochoric_stress(&strain(t)).unwrap());
            let change: Sym3 = std::array::from_fn(|i| to[i] - from[i]);
            let moved: Sym3 = std::array::from_fn(|i| strain(b)[i] - strain(a)[i]);
            // Within a step the strain goes straight; H does not, so that its mean is taken exactly: what
            // it loses to the dashpots is H/τ, hence ∫H dt/τ = γ ΔDEV S − ΔH.
            let before = history.clone();
            lost += dashpots.energy(&before, &change, mu);
            commit(&mut history, &change, &factors);
            let mut mean = [0.0; 6];
            for ((m, h0), h1) in rubber.maxwell.iter().zip(&before).zip(&history) {
                for i in 0..6 {
                    mean[i] += m.tau / dt * (m.gamma * change[i] - (h1[i] - h0[i]));
                }
            }
            let own = double_dot(
                &std::array::from_fn(|i| 0.5 * (total(&[], a)[i] + total(&[], b)[i])),
                &moved,
            );
            work += own + double_dot(&mean, &moved);
        }
        let end = steps as f64 * dt;
        let held = rubber.network.energy_density(&strain(end)).unwrap()
            + spring_energy(&rubber.maxwell, &history, mu);
        let gap = (work - held - lost) / work;
        // Strains of 1e-4 leave terms of their own size.
        assert!(gap.abs() <= 1e-4 && lost > 0.3 * work, "{dt}: {gap:e}, {}", lost / work);
    }
}

#[test]
fn complex_stiffness_is_what_a_swing_reads() {
    let rubber = named::table_3_1();
    for frequency in [0.1, 10.0, 1e3] {
        let [storage, loss] = complex_factor(&rubber.maxwell, TAU * frequency);
        let per = 2000;
        let dt = 1.0 / (frequency * per as f64);
        let mut cycles: usize = 3;
        // The slowest element has forgotten its start to e⁻²⁰.
        while cycles as f64 / frequency < 200.0 && cycles < 40 {
            cycles += 1;
        }
        let slow = rubber.maxwell.iter().filter(|m| m.tau < 2.0 / frequency);
        let elements: Vec<Maxwell> = slow.copied().collect();
        let expected = complex_factor(&elements, TAU * frequency);
        let wave = |t: f64| (TAU * frequency * t).sin();
        let sums = course(&elements, wave, dt, cycles * per);
        let last = &sums[(cycles - 1) * per..];
        let (mut cos, mut sin) = (0.0, 0.0);
        for (n, sum) in last.iter().enumerate() {
            let phase = TAU * (n + 1) as f64 / per as f64;
            sin += 2.0 * sum * phase.sin() / per as f64;
            cos += 2.0 * sum * phase.cos() / per as f64;
        }
        // Second order in 2π/2000, and the first elements' start.
        assert!((1.0 + sin - expected[0]).abs() <= 1e-5 * expected[0], "{frequency}: {sin}");
        assert!((cos - expected[1]).abs() <= 1e-5 * expected[1], "{frequency}: {cos}");
        assert!(storage >= expected[0] && loss >= expected[1]);
    }
    assert_eq!(complex_factor(&rubber.maxwell, 0.0), [1.0, 0.0]);
}

#[test]
fn steps_and_pulsations_at_their_ends() {
    let rubber = named::table_3_1();
    for bad in [-1e-9, f64::NAN] {
        let refused = format!("{:?}", StepFactors::of(&rubber.maxwell, bad));
        assert_eq!(refused, format!("Err(Step({bad:?}))"));
    }
    let never = StepFactors::of(&rubber.maxwell, f64::INFINITY).unwrap();
    assert!(never.total_gain == 0.0 && never.decay.iter().all(|d| *d == 0.0));
    let [storage, loss] = complex_factor(&rubber.maxwell, f64::INFINITY);
    // Σγ of Table 3.1.
    assert!((storage - 34.675).abs() <= 1e-9 && loss == 0.0, "{storage} {loss}");
    assert!(complex_factor(&rubber.maxwell, f64::NAN).iter().all(|x| x.is_nan()));
}
