//! Rules of elements, chains of rubber, motions that a support leaves free.

mod tet10 {
    use bearing_dynamics::elements::tet10::*;
    use bearing_dynamics::kinematics::vec3::Vec3;

    /// ∫ of a monomial over a tetrahedron of unit volume: 6·a!b!c!d!/(a+b+c+d+3)!.
    fn exact(powers: [u32; 4]) -> f64 {
        let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
        6.0 * powers.iter().map(|&p| factorial(p)).product::<f64>()
            / factorial(powers.iter().sum::<u32>() + 3)
    }

    #[test]
    fn the_rules_integrate_what_they_promise() {
        type Rule = Vec<([f64; 4], f64)>;
        let rules: [(u32, Rule); 2] = [
            (2, (0..POINTS).map(|point| (stiffness_rule(point), 0.25)).collect()),
            (5, mass_rule().to_vec()),
        ];
        for (degree, rule) in rules {
            for a in 0..=degree {
                for b in 0..=degree - a {
                    for c in 0..=degree - a - b {
                        let powers = [a, b, c, 0];
                        let sum: f64 = rule
                            .iter()
                            .map(|(l, w)| {
                                w * (0..4).map(|i| l[i].powi(powers[i] as i32)).product::<f64>()
                            })
                            .sum();
                        // Fifteen terms of at most 1, rounding only.
                        assert!((sum - exact(powers)).abs() <= 1e-14, "{powers:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn lumped_masses_of_a_straight_element() {
        let corners = [[0.0; 3], [1.0, 0.1, 0.0], [0.2, 1.3, 0.0], [0.0, 0.3, 0.9]];
        let nodes: [Vec3; 10] = std::array::from_fn(|i| {
            if i < 4 {
                corners[i]
            } else {
                let [a, b] = EDGES[i - 4];
                std::array::from_fn(|k| 0.5 * (corners[a][k] + corners[b][k]))
            }
        });
        let masses = lumped_mass(&nodes, 6.0);
        let total: f64 = masses.iter().sum();
        let volume = Tet10::new(&nodes).unwrap().volume();
        assert!((total - 6.0 * volume).abs() <= 1e-14 * total);
        for (i, mass) in masses.iter().enumerate() {
            let share = if i < 4 { 1.0 / 36.0 } else { 4.0 / 27.0 };
            assert!((mass / total - share).abs() <= 1e-14, "{i}: {}", mass / total);
        }
    }
}

mod langevin {
    use bearing_dynamics::ch2_housing::elastomer::langevin::*;

    #[test]
    fn the_inverse_undoes_the_function() {
        for x in [1e-6, 1e-3, 0.03, 0.0333, 0.1, 0.3536, 0.7, 0.95, 0.999, 0.999_999] {
            let [beta, slope] = inverse(x);
            // Rounding of coth β − 1/β, both up to 10.
            assert!((langevin(beta)[0] - x).abs() <= 4e-15, "{x}");
            let h = 1e-5 * x.min(1.0 - x);
            let difference = (inverse(x + h)[0] - inverse(x - h)[0]) / (2.0 * h);
            // The third derivative, 1e-10, and rounding of x: 1e-16/(1 − x) of β over a difference of 1e-5.
            assert!(
                (difference / slope - 1.0).abs() <= 1e-9 + 1e-11 / (1.0 - x),
                "{x}: {difference} {slope}"
            );
        }
    }

    #[test]
    fn both_forms_meet_where_they_change() {
        let [below, above] = [0.1 - 1e-12, 0.1 + 1e-12].map(langevin);
        // The change over the gap, 2e-12/3, and cancellation in coth β − 1/β, 1e-16·10/0.03.
        assert!((above[0] - below[0] - 2e-12 / 3.0).abs() <= 4e-15);
        assert!((above[1] / below[1] - 1.0).abs() <= 1e-12);
    }
}

mod support {
    use bearing_dynamics::mesh::generate::bar;
    use bearing_dynamics::numeric::profile::Profile;
    use bearing_dynamics::solids::model::Prescribed;
    use bearing_dynamics::solids::support::*;

    fn held(components: &[(usize, f64)]) -> FreeMotions {
        let mesh = bar([0.1, 0.01, 0.01], [4, 2, 2]).unwrap().mesh;
        let mut prescribed = Vec::new();
        for (axis, at) in components {
            for (node, place) in (0..).zip(&mesh.nodes) {
                if place[0] == *at {
                    prescribed.push(Prescribed { node, axis: *axis, profile: Profile::ZERO });
                }
            }
        }
        free_motions(&mesh.nodes, &prescribed)
    }

    #[test]
    fn free_motions_are_counted_and_named() {
        let free = held(&[]);
        assert_eq!((free.count, free.shares), (6, [1.0; 6]));
        assert_eq!(held(&[(0, 0.0), (1, 0.0), (2, 0.0)]).count, 0);
        // An end held along the axis only: it cannot turn about y and z either.
        let guided = held(&[(0, 0.0)]);
        assert_eq!((guided.count, guided.names().as_str()), (3, "along y, along z, about x"));
        let hinged = held(&[(2, 0.0), (2, 0.1)]);
        assert_eq!((hinged.count, hinged.names().as_str()), (3, "along x, along y, about z"));
    }
}
