//! Quantities, courses and dimensions that a scene gives.

mod units {
    use bearing_dynamics::scene::text::units::*;
    use std::f64::consts::PI;

    fn si(text: &str, dimension: Dimension) -> f64 {
        parse_quantity(text, dimension).unwrap().si
    }

    #[test]
    fn decimals_in_decimal_units_are_exact() {
        assert_eq!(si("20.047 mm", Dimension::Length), 20.047e-3);
        assert_eq!(si("-5 um", Dimension::Length), -5e-6);
        assert_eq!(si("\u{2212}5\u{b5}m", Dimension::Length), -5e-6);
        assert_eq!(si("6.013E+0 mm", Dimension::Length), 6.013e-3);
        assert_eq!(si("210GPa", Dimension::Stress), 210e9);
        assert_eq!(si("2.5 N m", Dimension::Moment), 2.5);
        assert_eq!(si(" 7.85 g/cm^3 ", Dimension::Density), 7850.0);
        assert_eq!(si(".5 mm", Dimension::Length), 0.5e-3);
        assert_eq!(si("1e-99999999999999999999 m", Dimension::Length), 0.0);
    }

    #[test]
    fn other_units_follow_their_definition() {
        assert_eq!(si("180 deg", Dimension::Angle), PI);
        assert_eq!(si("60 rpm", Dimension::RotationSpeed), 2.0 * PI);
        assert_eq!(si("1 Hz", Dimension::RotationSpeed), 2.0 * PI);
        assert_eq!(si("1 in", Dimension::Length), 0.0254);
        assert_eq!(si("1 g", Dimension::Acceleration), 9.80665);
        assert_eq!(si("1 g", Dimension::Mass), 1e-3);
    }

    #[test]
    fn every_problem_has_its_own_name() {
        use QuantityProblem::*;
        let problem = |text| parse_quantity(text, Dimension::Length).unwrap_err();
        assert_eq!(problem("5"), NoUnit { number: "5".to_string() });
        assert_eq!(problem("mm"), NoNumber);
        assert_eq!(problem(""), NoNumber);
        assert_eq!(problem("20,047 mm"), DecimalComma);
        assert_eq!(problem("nan mm"), NotFinite);
        assert_eq!(problem("1e400 mm"), NotFinite);
        assert_eq!(problem("1e99999999999999999999 mm"), NotFinite);
        assert!(matches!(problem("5 N"), WrongDimension { belongs_to: Dimension::Force, .. }));
        assert!(matches!(problem("5 MM"), UnknownUnit { nearest: Some("mm"), .. }));
    }
}

mod excitations {
    use bearing_dynamics::numeric::profile::Profile;
    use bearing_dynamics::scene::build::excitations::frequency;

    #[test]
    fn a_table_excites_as_fast_as_its_shortest_change() {
        let points = vec![[0.0, 1.0], [2.0, 3.0], [2.5, -1.0], [2.75, -1.0], [7.0, 4.0]];
        assert_eq!(frequency(&Profile::Table { points }), 1.0);
    }
}

mod resolve_solid_mesh {
    use bearing_dynamics::scene::{KEY_OF_DIMENSION, key_of_dimension};

    /// Every dimension that a generator may refuse leads to a key of a scene.
    #[test]
    fn dimensions_of_generators_are_keys() {
        for (_, key) in KEY_OF_DIMENSION {
            assert!(
                bearing_dynamics::scene::tables::keys::find(&format!("solid.mesh.{key}")).is_some(),
                "{key}"
            );
        }
        // These have three sizes, are not made from scenes, or follow from others that are checked.
        const NO_KEY: [&str; 5] = [
            "size of the bar",
            "cells along the bar",
            "cells along the block",
            "first step",
            "length to be divided",
        ];
        let sources = [
            include_str!("../../src/mesh/generate/bushing.rs"),
            include_str!("../../src/mesh/generate/cage.rs"),
            include_str!("../../src/mesh/generate/grading.rs"),
            include_str!("../../src/mesh/generate/housing.rs"),
            include_str!("../../src/mesh/generate/solids.rs"),
        ];
        let mut seen = 0;
        for call in sources.iter().flat_map(|text| text.split("between(\"").skip(1)) {
            seen += named(call, &NO_KEY);
        }
        for call in sources.iter().flat_map(|text| text.split("divisions(\"").skip(1)) {
            seen += named(call, &NO_KEY);
        }
        assert!(seen > 30, "{seen}");
    }

    fn named(call: &str, no_key: &[&str]) -> usize {
        let what = call.split('"').next().unwrap_or_default();
        assert!(key_of_dimension(what).is_some() || no_key.contains(&what), "{what}");
        1
    }
}
