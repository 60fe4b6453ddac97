//! Joints of shafts and elements, and the closed forms of chapter 3.

mod stepped_shaft {
    use bearing_dynamics::ch4_rotor::section::RotorSection;
    use bearing_dynamics::kinematics::vec3::norm;
    use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, dot};
    use bearing_dynamics::members::connection::SpringDashpot;
    use bearing_dynamics::members::state::BodyState;
    use bearing_dynamics::motion::explicit_shaft::*;
    use bearing_dynamics::numeric::profile::Profile;
    use nalgebra::{UnitQuaternion, Vector3};

    const NODES: [Vec3; 5] = [
        [0.2, 0.012, 0.0],
        [0.2, -0.004, 0.01],
        [0.2, 0.0, -0.013],
        [0.2, 0.006, 0.009],
        [0.2, -0.011, -0.002],
    ];

    fn joint() -> Joint {
        let nodes: Vec<(u32, Vec3, f64)> =
            (0..5).map(|n| (n as u32, NODES[n], 1.0 + n as f64)).collect();
        let section = RotorSection::new(&nodes).unwrap();
        let stiffness = [2e9, 2e9, 2e9, 1e6, 1e6, 1e6];
        let damping = [2e2, 2e2, 2e2, 0.2, 0.2, 0.2];
        Joint { body: 0, section, law: SpringDashpot { stiffness, damping, ..Default::default() } }
    }

    /// Nodes that have spun by `angle` about an axis through anywhere, strained and moved: displacement and rate.
    fn state(node: u32, t: f64) -> Vec3 {
        let n = f64::from(node);
        let turn = UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 2.0 + 600.0 * t);
        let strained = Vector3::from(NODES[node as usize]) * (1.0 + 1e-4 * n)
            + Vector3::z() * 1e-6 * n * (1.0 + 50.0 * t);
        let now = turn * strained + Vector3::new(1e-6, 2e-6 + 0.03 * t, -3e-6);
        (now - Vector3::from(NODES[node as usize])).into()
    }

    fn rate(node: u32, t: f64) -> Vec3 {
        const H: f64 = 1e-7;
        let (later, before) = (state(node, t + H), state(node, t - H));
        [0, 1, 2].map(|i: usize| (later[i] - before[i]) / (2.0 * H))
    }

    fn body(t: f64) -> BodyState {
        let mut body = BodyState::at_rest([0.2 + 2e-6, 1e-6 + 0.01 * t, 5e-7]);
        let tilt = UnitQuaternion::from_scaled_axis(Vector3::new(0.0, 1e-5, 2e-5));
        body.orientation =
            tilt * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 2.0 + 600.0 * t);
        (body.velocity, body.spin) =
            ([0.0, 0.01, 0.0], (tilt * Vector3::new(600.0, 0.0, 0.0)).into());
        body
    }

    /// What a joint does to section and body sums to nothing, about any point; its power is what its springs lose and its
    /// dashpots take.
    #[test]
    fn joints_keep_momentum_and_their_power_is_stored_or_lost() {
        let joint = joint();
        let at = |t: f64| {
            let place = joint.section.place(|n| state(n, t), |n| rate(n, t));
            (place, pulled(&joint, &place, &body(t)))
        };
        let (place, pull) = at(0.0);
        let (mut force, mut moment, mut power) = ([0.0; 3], [0.0; 3], 0.0);
        for (node, of) in joint.section.forces_at(&place, pull.on[0].force, pull.on[0].moment) {
            let now = add(NODES[node as usize], state(node, 0.0));
            force = add(force, of);
            moment = add(moment, cross(now, of));
            power += dot(of, rate(node, 0.0));
        }
        let (on, body) = (pull.on[1], body(0.0));
        power += dot(on.force, body.velocity) + dot(on.moment, body.spin);
        let left = norm(add(force, on.force));
        assert!(left <= 1e-12 * norm(on.force), "{left}");
        let about = add(moment, add(on.moment, cross(body.position, on.force)));
        assert!(norm(about) <= 1e-12 * norm(on.force), "{about:?}");
        // Differences over 1e-7 s, of an energy that is a part of 1e-3 of what changes it.
        let step = 1e-7;
        let grows = (at(step).1.energy - at(-step).1.energy) / (2.0 * step);
        assert!(
            (power + grows - pull.loss).abs() <= 1e-5 * power.abs(),
            "{power} {grows} {}",
            pull.loss
        );
        assert!(pull.loss < 0.0);
    }

    /// Of a force that turns with the section: outwards with Ω², and against the sense of rotation where the speed grows.
    #[test]
    fn an_unbalance_pulls_outwards_and_lags_a_shaft_that_speeds_up() {
        let section = joint().section;
        let of = SectionUnbalance { section, size: 1e-3, angle: 0.5 };
        let place = of.section.place(|n| state(n, 0.0), |n| rate(n, 0.0));
        let angle: f64 = 2.0 + 0.5;
        let speed = Profile::SmoothRamp { from: 0.0, to: 100.0, start: -1.0, duration: 2.0 };
        let force = unbalanced(&of, &speed, &place, 0.0);
        let (value, growth) = (speed.value(0.0), speed.rate(0.0));
        assert!(growth > 1.0);
        let out = 1e-3 * value * value;
        let back = 1e-3 * growth;
        // The section's nodes are strained by 1e-4 of themselves, which turns what fits them best by as little.
        let expected =
            [out * angle.cos() + back * angle.sin(), out * angle.sin() - back * angle.cos()];
        for (part, expected) in force[1..].iter().zip(expected) {
            assert!((part - expected).abs() <= 1e-3 * out, "{force:?} {expected}");
        }
    }
}

mod hysteresis {
    use bearing_dynamics::ch2_housing::elastomer::maxwell::StepFactors;
    use bearing_dynamics::ch2_housing::elastomer::maxwell::complex_factor;
    use bearing_dynamics::ch2_housing::elastomer::named::table_3_1;
    use bearing_dynamics::ch3_bushing::hysteresis::*;
    use std::f64::consts::TAU;

    /// A point of the rubber of Table 3.1, sheared at 0.1 Hz in twelve steps a cycle.
    #[test]
    fn the_error_of_the_recursion_is_known() {
        let elements = table_3_1().maxwell;
        let (per, period, amplitude) = (12, 10.0, 1e-3);
        let factors = StepFactors::of(&elements, period / f64::from(per)).unwrap();
        let x = |n: i32| amplitude * (TAU * f64::from(n) / f64::from(per)).sin();
        let mut history = vec![0.0; elements.len()];
        let mut points = Vec::new();
        for n in 1..=60 * per {
            for ((h, decay), gain) in history.iter_mut().zip(&factors.decay).zip(&factors.gain) {
                *h = decay * *h + gain * (x(n) - x(n - 1));
            }
            points.push([x(n), x(n) + history.iter().sum::<f64>()]);
        }
        let points = &points[59 * per as usize..];
        let [storage, loss] = complex_factor(&elements, TAU / period);
        let exact = of_complex_stiffness(storage, loss);
        let corrected = of_steps(points, &elements, period).unwrap().unwrap();
        // Nearly all of it is a rounding; after 59 cycles the slowest element forgot its start to e⁻⁵⁹.
        assert!((corrected.dynamic_stiffness / exact.dynamic_stiffness - 1.0).abs() <= 1e-12);
        assert!((corrected.damping_ratio / exact.damping_ratio - 1.0).abs() <= 1e-12);
        let read = of_loop(points).unwrap();
        assert!((read.damping_ratio / exact.damping_ratio - 1.0).abs() > 0.05, "{read:?}");
        assert_eq!(first_harmonic(&points[..2]), None);
        assert_eq!(first_harmonic(&[[1.0, 1.0]; 8]), None);
        assert!(of_steps(points, &elements, -1.0).is_err());
    }

    #[test]
    fn a_loop_of_sines_is_its_complex_stiffness() {
        let (storage, loss, amplitude) = (3.0e6, 1.1e6, 1e-3);
        let points: Vec<[f64; 2]> = (0..4000)
            .map(|n| {
                let phase = TAU * f64::from(n) / 4000.0;
                [amplitude * phase.sin(), amplitude * (storage * phase.sin() + loss * phase.cos())]
            })
            .collect();
        let (ours, exact) = (of_loop(&points).unwrap(), of_complex_stiffness(storage, loss));
        // Chords for arcs: (2π/4000)²/6; the peak between two points, (2π/4000)²/8.
        assert!((ours.dynamic_stiffness / exact.dynamic_stiffness - 1.0).abs() <= 5e-7);
        assert!((ours.damping_ratio / exact.damping_ratio - 1.0).abs() <= 1e-6);
        let backwards: Vec<[f64; 2]> = points.iter().rev().copied().collect();
        // 3.5 J of four thousand sums.
        assert!((loop_area(&backwards) + loop_area(&points)).abs() <= 1e-12);
        assert_eq!(of_loop(&[]), None);
        assert_eq!(of_loop(&[[1.0, 0.0], [0.0, 0.0]]), None);
    }

    /// What is largest is so on either side: a lopsided loop the other way round has the same stiffness and damping.
    #[test]
    fn a_lopsided_loop_is_the_same_the_other_way_round() {
        let points = [[0.0, 0.5], [1e-3, 2.0], [0.0, -0.5], [-3e-3, -9.0]];
        let turned = points.map(|point| point.map(|x| -x));
        let [found, other] = [&points, &turned].map(|points| of_loop(points).unwrap());
        assert_eq!(found, other);
        // 9 N over 3 mm.
        assert!((found.dynamic_stiffness / 3e3 - 1.0).abs() <= 1e-14, "{found:?}");
    }
}

mod similitude {
    use bearing_dynamics::ch3_bushing::hysteresis::Hysteresis;
    use bearing_dynamics::ch3_bushing::similitude::*;

    /// A bushing twice as large of twice the modulus: four times the stiffness, the same groups.
    #[test]
    fn like_bushings_have_like_groups() {
        let small = Scale { modulus: 1e6, diameter: 0.04, length: 0.06, thickness: 0.02 };
        let large = Scale { modulus: 2e6, diameter: 0.08, length: 0.12, thickness: 0.04 };
        let of = |k| Hysteresis { dynamic_stiffness: k, damping_ratio: 0.1 };
        assert_eq!(small.diameter_ratio(), large.diameter_ratio());
        assert_eq!(small.length_ratio(), large.length_ratio());
        let [a, b] = [small.dynamic_stiffness(&of(1e6)), large.dynamic_stiffness(&of(4e6))];
        assert!((a / b - 1.0).abs() <= 1e-15);
        // 1e6 N/m · 0.02 m/(1e6 Pa · 0.06 m · 0.04 m).
        assert!((a - 1e6 * 0.02 / (1e6 * 0.06 * 0.04)).abs() <= 1e-12 * a);
        assert!((small.force(2400.0) - 1.0).abs() <= 1e-15);
    }
}
