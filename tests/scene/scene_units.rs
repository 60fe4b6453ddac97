//! Units are worth what their symbols say.

use bearing_dynamics::scene::text::units::{Dimension, parse_quantity};
use std::f64::consts::TAU;

/// Powers of kilogram, metre, second, radian and ampere.
type Powers = [f64; 5];

/// What a dimension is made of.
fn powers(dimension: Dimension) -> Powers {
    match dimension {
        Dimension::Length => [0.0, 1.0, 0.0, 0.0, 0.0],
        Dimension::Mass => [1.0, 0.0, 0.0, 0.0, 0.0],
        Dimension::Force => [1.0, 1.0, -2.0, 0.0, 0.0],
        Dimension::Moment => [1.0, 2.0, -2.0, 0.0, 0.0],
        Dimension::Angle => [0.0, 0.0, 0.0, 1.0, 0.0],
        Dimension::RotationSpeed => [0.0, 0.0, -1.0, 1.0, 0.0],
        Dimension::Stress => [1.0, -1.0, -2.0, 0.0, 0.0],
        Dimension::Density => [1.0, -3.0, 0.0, 0.0, 0.0],
        Dimension::Acceleration => [0.0, 1.0, -2.0, 0.0, 0.0],
        Dimension::Time => [0.0, 0.0, 1.0, 0.0, 0.0],
        Dimension::Frequency | Dimension::Rate => [0.0, 0.0, -1.0, 0.0, 0.0],
        Dimension::Speed => [0.0, 1.0, -1.0, 0.0, 0.0],
        Dimension::InverseSpeed => [0.0, -1.0, 1.0, 0.0, 0.0],
        Dimension::Stiffness => [1.0, 0.0, -2.0, 0.0, 0.0],
        Dimension::StiffnessPerArea => [1.0, -2.0, -2.0, 0.0, 0.0],
        Dimension::HertzStiffness => [1.0, -0.5, -2.0, 0.0, 0.0],
        Dimension::TiltStiffness => [1.0, 2.0, -2.0, -1.0, 0.0],
        Dimension::Damping => [1.0, 0.0, -1.0, 0.0, 0.0],
        Dimension::TiltDamping => [1.0, 2.0, -1.0, -1.0, 0.0],
        Dimension::Inertia => [1.0, 2.0, 0.0, 0.0, 0.0],
        Dimension::Unbalance => [1.0, 1.0, 0.0, 0.0, 0.0],
        Dimension::Capacitance => [-1.0, -2.0, 4.0, 0.0, 2.0],
        Dimension::Resistance => [1.0, 2.0, -3.0, 0.0, -2.0],
    }
}

/// A symbol by its definition; letters in front of some are powers of ten.
fn symbol(text: &str, dimension: Dimension) -> Option<(f64, Powers)> {
    let whole = match (text, dimension) {
        // A turn a second; the standard acceleration of free fall.
        ("Hz", Dimension::RotationSpeed) => (TAU, [0.0, 0.0, -1.0, 1.0, 0.0]),
        ("g", Dimension::Acceleration) => (9.80665, [0.0, 1.0, -2.0, 0.0, 0.0]),
        ("1", _) => (1.0, [0.0; 5]),
        ("in", _) => (25.4e-3, [0.0, 1.0, 0.0, 0.0, 0.0]),
        // The pound under the standard acceleration.
        ("lbf", _) => (0.453_592_37 * 9.80665, [1.0, 1.0, -2.0, 0.0, 0.0]),
        ("deg" | "\u{b0}", _) => (TAU / 360.0, [0.0, 0.0, 0.0, 1.0, 0.0]),
        ("arcmin", _) => (TAU / 360.0 / 60.0, [0.0, 0.0, 0.0, 1.0, 0.0]),
        ("rpm", _) => (TAU / 60.0, [0.0, 0.0, -1.0, 1.0, 0.0]),
        ("min", _) => (60.0, [0.0, 0.0, 1.0, 0.0, 0.0]),
        ("m", _) => (1.0, [0.0, 1.0, 0.0, 0.0, 0.0]),
        ("g", _) => (1e-3, [1.0, 0.0, 0.0, 0.0, 0.0]),
        ("s", _) => (1.0, [0.0, 0.0, 1.0, 0.0, 0.0]),
        ("rad", _) => (1.0, [0.0, 0.0, 0.0, 1.0, 0.0]),
        ("N", _) => (1.0, [1.0, 1.0, -2.0, 0.0, 0.0]),
        ("Pa", _) => (1.0, [1.0, -1.0, -2.0, 0.0, 0.0]),
        ("Hz", _) => (1.0, [0.0, 0.0, -1.0, 0.0, 0.0]),
        // An ampere second over a volt, and a volt over an ampere.
        ("F", _) => (1.0, [-1.0, -2.0, 4.0, 0.0, 2.0]),
        ("ohm" | "\u{3a9}" | "\u{2126}", _) => (1.0, [1.0, 2.0, -3.0, 0.0, -2.0]),
        _ => {
            let (first, rest) = text.split_at(text.chars().next()?.len_utf8());
            let ten = match first {
                "G" => 1e9,
                "M" => 1e6,
                "k" => 1e3,
                "c" => 1e-2,
                "m" => 1e-3,
                "u" | "\u{b5}" | "\u{3bc}" => 1e-6,
                "n" => 1e-9,
                "p" => 1e-12,
                _ => return None,
            };
            if !["m", "g", "s", "rad", "N", "Pa", "Hz", "F", "ohm"].contains(&rest) {
                return None;
            }
            let (factor, powers) = symbol(rest, dimension)?;
            (ten * factor, powers)
        }
    };
    Some(whole)
}

/// Every way to read a product of symbols: "Nms" is N m s or N ms.
fn products(text: &str, dimension: Dimension) -> Vec<(f64, Powers)> {
    let text = text.trim_start_matches([' ', '*', '\u{b7}', '\u{22c5}']);
    if text.is_empty() {
        return vec![(1.0, [0.0; 5])];
    }
    let mut found = Vec::new();
    for end in (1..=text.len()).filter(|&end| text.is_char_boundary(end)) {
        let Some((factor, powers)) = symbol(&text[..end], dimension) else { continue };
        let rest = &text[end..];
        let exponents = [
            ("^(3/2)", 1.5),
            ("^1.5", 1.5),
            ("^2", 2.0),
            ("^3", 3.0),
            ("^-1", -1.0),
            ("\u{b2}", 2.0),
            ("\u{b3}", 3.0),
        ];
        let written = exponents.iter().find_map(|(way, n)| Some((rest.strip_prefix(way)?, *n)));
        let (rest, exponent) = written.unwrap_or((rest, 1.0));
        for (others, other_powers) in products(rest, dimension) {
            let together = std::array::from_fn(|i| exponent * powers[i] + other_powers[i]);
            found.push((factor.powf(exponent) * others, together));
        }
    }
    found
}

/// What one of a unit is in SI, from the definitions of its symbols alone.
fn by_definition(unit: &str, dimension: Dimension) -> f64 {
    // The slash of an exponent divides nothing.
    let at = unit.char_indices().find(|&(i, c)| c == '/' && !unit[..i].contains('('));
    let (above, below) = at.map_or((unit, ""), |(i, _)| (&unit[..i], &unit[i + 1..]));
    let mut readings: Vec<f64> = Vec::new();
    for (factor, powers_above) in products(above, dimension) {
        for (divisor, powers_below) in products(below, dimension) {
            if (0..5).all(|i| powers_above[i] - powers_below[i] == powers(dimension)[i]) {
                readings.push(factor / divisor);
            }
        }
    }
    assert_eq!(readings.len(), 1, "{unit}, {}: {readings:?}", dimension.name());
    readings[0]
}

/// Ours and theirs take a few operations each, of half a last place (1.1e-16) at most.
#[test]
fn every_unit_is_worth_what_its_symbols_say() {
    let mut spellings = 0;
    for dimension in Dimension::ALL {
        assert_eq!(by_definition(dimension.si_unit(), dimension), 1.0, "{}", dimension.name());
        for unit in dimension.units() {
            for spelling in unit.spellings {
                let expected = by_definition(spelling, dimension);
                for number in [1.0, -2.5, 3e-7] {
                    let text = format!("{number} {spelling}");
                    let read = parse_quantity(&text, dimension).unwrap().si;
                    let error = (read / (number * expected) - 1.0).abs();
                    assert!(error <= 1e-15, "{text} is {read:e} and not {:e}", number * expected);
                }
                let scale = unit.scale.factor() / expected - 1.0;
                assert!(scale.abs() <= 1e-15, "{spelling}: {scale:e}");
                spellings += 1;
            }
        }
    }
    assert!(spellings >= 120, "{spellings}");
}
