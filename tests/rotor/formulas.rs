//! Sections, discs and beams of chapter 4.

mod section {
    use bearing_dynamics::ch4_rotor::section::*;
    use bearing_dynamics::kinematics::vec3::norm;
    use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, dot, scale, sub};
    use nalgebra::{UnitQuaternion, Vector3};

    /// Any four nodes of unequal areas: a rigid motion is found exactly, and loads do the work of what they stand for on any
    /// displacements, rigid or not.
    #[test]
    fn rigid_motions_are_found_and_loads_do_their_work() {
        let nodes = [
            (3, [0.1, 0.02, 0.0], 2.0),
            (5, [0.1, -0.01, 0.01], 1.0),
            (1, [0.1, 0.0, -0.02], 0.5),
            (2, [0.1, 0.015, 0.015], 0.0),
        ];
        let section = RotorSection::new(&nodes).unwrap();
        let place = |node: u32| nodes.iter().find(|(n, ..)| *n == node).unwrap().1;
        let [shift, turn] = [[1e-3, -2e-3, 5e-4], [0.02, -0.01, 0.03]];
        let rigid = |n: u32| add(shift, cross(turn, sub(place(n), section.centre)));
        let [mean, rotation] = section.motion(rigid);
        for i in 0..3 {
            assert!((mean[i] - shift[i]).abs() <= 1e-17 && (rotation[i] - turn[i]).abs() <= 1e-15);
        }
        let [force, moment] = [[3.0, -1.0, 2.0], [0.1, 0.2, -0.4]];
        let any = |n: u32| [f64::from(n), 0.3 - f64::from(n * n), 0.7];
        let work: f64 = section.forces(force, moment).map(|(n, of)| dot(of, any(n))).sum();
        let [mean, rotation] = section.motion(any);
        let expected = dot(force, mean) + dot(moment, rotation);
        assert!((work - expected).abs() <= 1e-12 * expected.abs(), "{work} {expected}");
        // On one line there is no rotation about it.
        assert_eq!(RotorSection::new(&nodes[..2]), None);
    }

    /// Nodes across the axis that have moved, turned by more than a turn's half and been strained by a thousandth: the rotation is
    /// where the squares are least, its rate is that of differences, and loads keep power, force and moment.
    #[test]
    fn a_section_that_spins_has_the_rotation_that_fits_best() {
        let nodes: [(u32, Vec3, f64); 5] = [
            (0, [0.1, 0.012, 0.0], 2.0),
            (1, [0.1, -0.004, 0.01], 1.0),
            (2, [0.1, 0.0, -0.013], 0.5),
            (3, [0.1, 0.006, 0.009], 0.7),
            (4, [0.1, -0.011, -0.002], 1.3),
        ];
        let section = RotorSection::new(&nodes).unwrap();
        let at = |node: u32| nodes[node as usize].1;
        // Where a node is at a time: spun about an axis that moves, and strained.
        let now = |node: u32, t: f64| -> Vec3 {
            let (x, n) = (sub(at(node), section.centre), f64::from(node));
            let along = x[0] + 1e-5 * (n + t);
            let across = x[1] * (1.0 + 1e-3 * n * (1.0 + t));
            let strained = Vector3::new(along, across, x[2] - 1e-3 * x[1] * t + 1e-6 * n * n);
            let turn =
                UnitQuaternion::from_scaled_axis(Vector3::new(4.0 + 30.0 * t, 0.1, -0.2 * t));
            add((turn * strained).into(), [0.1 + t, 2e-3, -3.0 * t])
        };
        let h = 1e-6;
        let rate = |node: u32| scale(sub(now(node, h), now(node, -h)), 0.5 / h);
        let placed = |t: f64| section.place(|node| sub(now(node, t), at(node)), rate);
        let place = placed(0.0);
        let squares = |turn: UnitQuaternion<f64>| -> f64 {
            let off = |node: u32, arm: &Vec3| {
                let there: Vec3 = (turn * Vector3::from(*arm)).into();
                sub(sub(now(node, 0.0), place.centre), there)
            };
            let square = |(node, place, area): &(u32, Vec3, f64)| {
                area / 5.5 * norm(off(*node, &sub(*place, section.centre))).powi(2)
            };
            nodes.iter().map(square).sum()
        };
        let least = squares(place.orientation);
        for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
            for by in [1e-4, -1e-4] {
                let turned = UnitQuaternion::from_scaled_axis(axis * by) * place.orientation;
                assert!(squares(turned) > least, "{axis} {by}");
            }
        }
        let spin = Vector3::from(place.spin);
        let turned = (placed(h).orientation * placed(-h).orientation.inverse()).scaled_axis();
        // Rounding of 1e-16 over h, and h² of a turn of 30 rad/s.
        assert!((turned / (2.0 * h) - spin).norm() <= 1e-8 * spin.norm(), "{spin} {turned}");
        let [force, moment] = [[3.0, -1.0, 2.0], [0.1, 0.2, -0.4]];
        let (mut power, mut sum, mut about) = (0.0, [0.0; 3], [0.0; 3]);
        for (node, of) in section.forces_at(&place, force, moment) {
            power += dot(of, rate(node));
            sum = add(sum, of);
            about = add(about, cross(sub(now(node, 0.0), place.centre), of));
        }
        let expected = dot(force, place.velocity) + dot(moment, place.spin);
        assert!((power - expected).abs() <= 1e-12 * expected.abs(), "{power} {expected}");
        assert!(norm(sub(sum, force)) <= 1e-14 && norm(sub(about, moment)) <= 1e-14, "{about:?}");
    }
}

mod disc {
    use bearing_dynamics::ch4_rotor::disc::*;
    use nalgebra::Vector2;
    use std::f64::consts::PI;

    /// A disc of 0.1 m and 20 mm, a thin hoop, and the unbalance against the acceleration of its place by differences.
    #[test]
    fn rings_and_unbalance() {
        let disc = Inertia::of_ring(0.1, 0.0, 0.02, 7850.0);
        let mass = 7850.0 * PI * 0.0025 * 0.02;
        assert!((disc.mass / mass - 1.0).abs() <= 1e-14);
        assert!((disc.axial / (mass * 0.0025 / 2.0) - 1.0).abs() <= 1e-14);
        assert!((disc.transverse / (mass * (0.0025 / 4.0 + 0.0004 / 12.0)) - 1.0).abs() <= 1e-14);
        let hoop = Inertia::of_ring(1.0, 0.999, 1e-9, 1.0);
        assert!((hoop.axial / (2.0 * hoop.transverse) - 1.0).abs() <= 1e-12);

        let [speed, gain, t, h] = [30.0, 200.0, 0.4, 1e-4];
        let turn = |t: f64| 0.3 + speed * t + 0.5 * gain * t * t;
        let place = |t: f64| Vector2::new(turn(t).cos(), turn(t).sin());
        let acceleration = (place(t + h) - place(t) * 2.0 + place(t - h)) / (h * h);
        let force = unbalance_force(1e-3, turn(t), speed + gain * t, gain);
        // Second differences miss by h²/12 of the fourth derivative, (110 rad/s)⁴: 1e-5 of ω².
        assert!((force + acceleration * 1e-3).norm() <= 2e-5 * force.norm());
    }
}

mod beam {
    use bearing_dynamics::ch4_rotor::beam::*;
    use nalgebra::SVector;

    /// Deflections of a cubic and the turns that go with them without load between the ends: the work is that of the
    /// moments and shear forces at both ends, the masses are those of polynomials that one can integrate by hand.
    #[test]
    fn a_cubic_has_the_energy_of_beam_theory() {
        let section = Section { outer_diameter: 0.03, inner_diameter: 0.01 };
        let kappa = ShearCoefficient::Cowper.of(&section, 0.3);
        for length in [0.02, 3.0] {
            let e = Element::new(&section, length, 210e9, 0.3, 7850.0, kappa);
            // w = x³ with s = 3x² + 6 EI/κGA: moment 6 EI x, shear force −6 EI everywhere.
            let shear = 6.0 * e.bending / e.shear;
            let at = |i: usize| length * i as f64 / (NODES - 1) as f64;
            let cubic = SVector::<f64, { 2 * NODES }>::from_fn(|i, _| {
                let x = at(i / 2);
                if i % 2 == 0 { x * x * x } else { 3.0 * x * x + shear }
            });
            let energy = (e.stiffness() * cubic).dot(&cubic);
            let l3 = length * length * length;
            let expected = 12.0 * e.bending * l3 + e.shear * shear * shear * length;
            assert!((energy / expected - 1.0).abs() <= 1e-9, "{length}: {energy} {expected}");
            let mass = (e.translational_mass() * cubic).dot(&cubic);
            let expected = e.line_mass * l3 * l3 * length / 7.0;
            assert!((mass / expected - 1.0).abs() <= 1e-13);
            let rotary = (e.rotary_mass() * cubic).dot(&cubic);
            let expected = e.line_inertia
                * (1.8 * l3 * length * length + 2.0 * shear * l3 + shear * shear * length);
            assert!((rotary / expected - 1.0).abs() <= 1e-13);
        }
    }

    /// Known values: 0.886 (Cowper) and 0.925 (Hutchinson) for a full section of ν = 0.3; a thin tube shears with about
    /// half its area, 2(1+ν)/(4+3ν) by Cowper and (1+ν)/(2+ν) by Hutchinson.
    #[test]
    fn shear_coefficients_of_full_sections_and_thin_tubes() {
        let full = Section { outer_diameter: 0.03, inner_diameter: 0.0 };
        let thin = Section { outer_diameter: 1.0, inner_diameter: 1.0 - 1e-9 };
        let nu = 0.3;
        let expected = [
            (ShearCoefficient::Cowper, 7.8 / 8.8, 2.6 / 4.9),
            (ShearCoefficient::Hutchinson, 10.14 / 10.96, 1.3 / 2.3),
        ];
        for (choice, of_full, of_thin) in expected {
            assert!((choice.of(&full, nu) - of_full).abs() <= 1e-14);
            assert!((choice.of(&thin, nu) - of_thin).abs() <= 1e-8, "{choice:?}");
        }
    }
}
