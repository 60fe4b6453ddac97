//! Numbers with units: `"20.047 mm"` to SI.
//!
//! A decimal number in a power-of-ten unit becomes the double nearest to the exact SI value: the
//! exponent is shifted in the text before it is parsed, so `"20.047 mm"` equals `20.047e-3`.

/// Dimensions of quantities: name with its article, usual value, units.
macro_rules! dimensions {
    ($($name:ident: $phrase:literal, $usual:literal, $units:ident;)*) => {
        /// Dimension of a key's value.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Dimension {
            $($name,)*
        }

        impl Dimension {
            pub const ALL: [Dimension; [$(stringify!($name)),*].len()] = [$(Dimension::$name),*];

            const fn facts(self) -> (&'static str, &'static str, &'static [Unit]) {
                match self {
                    $(Dimension::$name => ($phrase, $usual, $units),)*
                }
            }
        }
    };
}

#[rustfmt::skip]
dimensions! {
    Length: "a length", "6 mm", LENGTH;
    Mass: "a mass", "0.1 kg", MASS;
    Force: "a force", "250 N", FORCE;
    Moment: "a moment", "2.5 N m", MOMENT;
    Angle: "an angle", "0.15 deg", ANGLE;
    RotationSpeed: "a rotation speed", "1000 rpm", ROTATION_SPEED;
    Stress: "a stress or modulus", "210 GPa", STRESS;
    Density: "a density", "7850 kg/m^3", DENSITY;
    Acceleration: "an acceleration", "-9.80665 m/s^2", ACCELERATION;
    Time: "a time", "0.1 s", TIME;
    Frequency: "a frequency", "50 Hz", FREQUENCY;
    Speed: "a speed", "0.01 m/s", SPEED;
    InverseSpeed: "an inverse speed", "0.1 s/m", INVERSE_SPEED;
    Stiffness: "a stiffness", "1e8 N/m", STIFFNESS;
    StiffnessPerArea: "a stiffness per area", "2.5e14 N/m^3", STIFFNESS_PER_AREA;
    HertzStiffness: "a Hertz stiffness", "1e10 N/m^1.5", HERTZ_STIFFNESS;
    TiltStiffness: "a tilting stiffness", "1e4 N m/rad", TILT_STIFFNESS;
    Damping: "a damping coefficient", "1000 N s/m", DAMPING;
    TiltDamping: "a tilting damping coefficient", "1 N m s/rad", TILT_DAMPING;
    Inertia: "a moment of inertia", "1e-4 kg m^2", INERTIA;
    Unbalance: "an unbalance", "9.12e-3 kg m", UNBALANCE;
    Rate: "a rate", "77 1/s", RATE;
    Capacitance: "a capacitance", "100 pF", CAPACITANCE;
    Resistance: "a resistance", "0.3 ohm", RESISTANCE;
}

/// Conversion of a unit to SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// SI value = number × 10^exponent, exact in decimal.
    PowerOfTen(i32),
    /// SI value = number × factor, rounded.
    Factor(f64),
}

impl Scale {
    /// SI value of one unit.
    pub fn factor(self) -> f64 {
        match self {
            Scale::PowerOfTen(exponent) => 10f64.powi(exponent),
            Scale::Factor(factor) => factor,
        }
    }
}

/// One unit with all its accepted spellings, the preferred one first.
#[derive(Clone, Copy, Debug)]
pub struct Unit {
    pub spellings: &'static [&'static str],
    pub scale: Scale,
}

const fn decimal(spellings: &'static [&'static str], exponent: i32) -> Unit {
    Unit { spellings, scale: Scale::PowerOfTen(exponent) }
}

const fn factor(spellings: &'static [&'static str], factor: f64) -> Unit {
    Unit { spellings, scale: Scale::Factor(factor) }
}

use std::f64::consts::PI;

// "µ" is both U+00B5 (micro sign) and U+03BC (Greek mu): keyboards give either.
const LENGTH: &[Unit] = &[
    decimal(&["mm"], -3),
    decimal(&["um", "\u{b5}m", "\u{3bc}m"], -6),
    decimal(&["nm"], -9),
    decimal(&["cm"], -2),
    decimal(&["m"], 0),
    decimal(&["km"], 3),
    factor(&["in"], 0.0254),
];
const MASS: &[Unit] = &[decimal(&["kg"], 0), decimal(&["g"], -3)];
const FORCE: &[Unit] = &[
    decimal(&["N"], 0),
    decimal(&["kN"], 3),
    decimal(&["MN"], 6),
    decimal(&["mN"], -3),
    factor(&["lbf"], 4.448_221_615_260_5),
];
const MOMENT: &[Unit] = &[
    decimal(&["N m", "Nm", "N*m", "N\u{b7}m", "N\u{22c5}m"], 0),
    decimal(&["N mm", "Nmm", "N*mm", "N\u{b7}mm", "N\u{22c5}mm"], -3),
    decimal(&["kN m", "kNm", "kN*m", "kN\u{b7}m", "kN\u{22c5}m"], 3),
];
const ANGLE: &[Unit] = &[
    factor(&["deg", "\u{b0}"], PI / 180.0),
    decimal(&["rad"], 0),
    decimal(&["mrad"], -3),
    factor(&["arcmin"], PI / 10_800.0),
];
const ROTATION_SPEED: &[Unit] = &[
    factor(&["rpm"], PI / 30.0),
    decimal(&["rad/s"], 0),
    factor(&["Hz"], 2.0 * PI),
    factor(&["deg/s", "\u{b0}/s"], PI / 180.0),
];
const STRESS: &[Unit] = &[
    decimal(&["GPa"], 9),
    decimal(&["MPa", "N/mm^2", "N/mm\u{b2}"], 6),
    decimal(&["kPa"], 3),
    decimal(&["Pa"], 0),
];
const DENSITY: &[Unit] =
    &[decimal(&["kg/m^3", "kg/m\u{b3}"], 0), decimal(&["g/cm^3", "g/cm\u{b3}"], 3)];
const ACCELERATION: &[Unit] = &[decimal(&["m/s^2", "m/s\u{b2}"], 0), factor(&["g"], 9.806_65)];
const TIME: &[Unit] = &[
    decimal(&["s"], 0),
    decimal(&["ms"], -3),
    decimal(&["us", "\u{b5}s", "\u{3bc}s"], -6),
    decimal(&["ns"], -9),
    factor(&["min"], 60.0),
];
const FREQUENCY: &[Unit] = &[decimal(&["Hz"], 0), decimal(&["kHz"], 3), decimal(&["MHz"], 6)];
const SPEED: &[Unit] = &[decimal(&["m/s"], 0), decimal(&["mm/s"], -3), decimal(&["um/s"], -6)];
const INVERSE_SPEED: &[Unit] = &[decimal(&["s/m"], 0), decimal(&["s/mm"], 3)];
const STIFFNESS: &[Unit] = &[
    decimal(&["N/m"], 0),
    decimal(&["N/mm"], 3),
    decimal(&["kN/mm", "N/um", "N/\u{b5}m", "N/\u{3bc}m"], 6),
];
const STIFFNESS_PER_AREA: &[Unit] = &[
    decimal(&["N/m^3", "N/m\u{b3}", "Pa/m"], 0),
    decimal(&["N/mm^3", "N/mm\u{b3}", "MPa/mm"], 9),
    decimal(&["MPa/um", "MPa/\u{b5}m", "MPa/\u{3bc}m"], 12),
];
const HERTZ_STIFFNESS: &[Unit] = &[
    decimal(&["N/m^1.5", "N/m^(3/2)"], 0),
    // 1000^1.5.
    factor(&["N/mm^1.5", "N/mm^(3/2)"], 31_622.776_601_683_792),
];
const TILT_STIFFNESS: &[Unit] = &[
    decimal(&["N m/rad", "Nm/rad", "N*m/rad", "N\u{b7}m/rad"], 0),
    decimal(&["kN m/rad", "kNm/rad"], 3),
    factor(&["N m/deg", "Nm/deg"], 180.0 / PI),
];
const DAMPING: &[Unit] =
    &[decimal(&["N s/m", "Ns/m", "N*s/m"], 0), decimal(&["N s/mm", "Ns/mm"], 3)];
const TILT_DAMPING: &[Unit] = &[decimal(&["N m s/rad", "Nms/rad", "N*m*s/rad"], 0)];
const INERTIA: &[Unit] = &[
    decimal(&["kg m^2", "kg m\u{b2}", "kg*m^2"], 0),
    decimal(&["kg mm^2", "kg mm\u{b2}", "kg*mm^2"], -6),
    decimal(&["g mm^2", "g mm\u{b2}", "g*mm^2"], -9),
];
const UNBALANCE: &[Unit] = &[
    decimal(&["kg m", "kg*m"], 0),
    decimal(&["kg mm", "kg*mm"], -3),
    decimal(&["g mm", "g*mm"], -6),
];

const RATE: &[Unit] = &[decimal(&["1/s", "/s", "s^-1"], 0)];
const CAPACITANCE: &[Unit] = &[
    decimal(&["pF"], -12),
    decimal(&["nF"], -9),
    decimal(&["uF", "\u{b5}F", "\u{3bc}F"], -6),
    decimal(&["F"], 0),
];
const RESISTANCE: &[Unit] = &[decimal(&["ohm", "\u{3a9}", "\u{2126}"], 0), decimal(&["mohm"], -3)];

impl Dimension {
    /// Name with its article, as used in a sentence: "a length".
    pub fn name(self) -> &'static str {
        self.facts().0
    }

    /// A usual value, for examples.
    pub fn usual(self) -> &'static str {
        self.facts().1
    }

    pub fn units(self) -> &'static [Unit] {
        self.facts().2
    }

    /// The preferred spelling of every unit, for messages: "mm, um, nm, cm, m, km, in".
    pub fn unit_list(self) -> String {
        let names: Vec<&str> = self.units().iter().map(|unit| unit.spellings[0]).collect();
        names.join(", ")
    }

    /// SI unit of the resolved value.
    pub fn si_unit(self) -> &'static str {
        let si = self.units().iter().find(|unit| unit.scale.factor() == 1.0);
        si.map_or("", |unit| unit.spellings[0])
    }

    /// The unit with this spelling, if the dimension has it.
    pub fn find(self, spelling: &str) -> Option<&'static Unit> {
        self.units().iter().find(|unit| unit.spellings.contains(&spelling))
    }
}

/// Why a text is not a quantity of the wanted dimension.
#[derive(Clone, Debug, PartialEq)]
pub enum QuantityProblem {
    /// A number without a unit.
    NoUnit {
        number: String,
    },
    /// The text does not begin with a number.
    NoNumber,
    /// `20,047 mm`.
    DecimalComma,
    /// The unit belongs to another dimension.
    WrongDimension {
        unit: String,
        belongs_to: Dimension,
    },
    UnknownUnit {
        number: String,
        unit: String,
        nearest: Option<&'static str>,
    },
    /// NaN, infinite, or too large for a double.
    NotFinite,
}

/// A quantity as written: number, unit and SI value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quantity<'t> {
    pub number: f64,
    pub unit: &'t str,
    pub scale: Scale,
    pub si: f64,
}

/// Reads `number [space] unit` of a given dimension.
///
/// ```
/// use bearing_dynamics::scene::text::units::{Dimension, parse_quantity};
/// assert_eq!(parse_quantity("20.047 mm", Dimension::Length).unwrap().si, 20.047e-3);
/// ```
pub fn parse_quantity(text: &str, dimension: Dimension) -> Result<Quantity<'_>, QuantityProblem> {
    let (number, unit) = split_number(text)?;
    if unit.is_empty() {
        return Err(QuantityProblem::NoUnit { number: number.to_string() });
    }
    let Some(found) = dimension.find(unit) else {
        return Err(unit_problem(number, unit, dimension));
    };
    let plain = parse_decimal(number, 0)?;
    let si = match found.scale {
        Scale::PowerOfTen(exponent) => parse_decimal(number, exponent)?,
        Scale::Factor(factor) => finite(plain * factor)?,
    };
    Ok(Quantity { number: plain, unit, scale: found.scale, si })
}

/// Reads a plain decimal number such as `0.3` or `-1.5e-3`.
pub fn parse_number(text: &str) -> Result<f64, QuantityProblem> {
    let (number, rest) = split_number(text)?;
    if !rest.is_empty() {
        return Err(unit_of_plain_number(number, rest));
    }
    parse_decimal(number, 0)
}

fn unit_of_plain_number(number: &str, unit: &str) -> QuantityProblem {
    match dimension_of(unit) {
        Some(belongs_to) => QuantityProblem::WrongDimension { unit: unit.to_string(), belongs_to },
        None => QuantityProblem::UnknownUnit {
            number: number.to_string(),
            unit: unit.to_string(),
            nearest: None,
        },
    }
}

fn unit_problem(number: &str, unit: &str, dimension: Dimension) -> QuantityProblem {
    if let Some(belongs_to) = dimension_of(unit) {
        return QuantityProblem::WrongDimension { unit: unit.to_string(), belongs_to };
    }
    let spellings = dimension.units().iter().flat_map(|unit| unit.spellings);
    QuantityProblem::UnknownUnit {
        number: number.to_string(),
        unit: unit.to_string(),
        nearest: crate::scene::tables::keys::nearest(unit, spellings.copied(), 0.4),
    }
}

fn dimension_of(unit: &str) -> Option<Dimension> {
    Dimension::ALL.into_iter().find(|dimension| dimension.find(unit).is_some())
}

/// Splits into the leading decimal number and the trimmed rest.
fn split_number(text: &str) -> Result<(&str, &str), QuantityProblem> {
    let text = text.trim();
    let end = number_length(text);
    if end == 0 {
        let word = text.trim_start_matches(['+', '-', '\u{2212}']);
        let not_finite = ["nan", "inf"]
            .iter()
            .any(|name| word.get(..3).is_some_and(|start| start.eq_ignore_ascii_case(name)));
        return Err(if not_finite {
            QuantityProblem::NotFinite
        } else {
            QuantityProblem::NoNumber
        });
    }
    let rest = &text[end..];
    let mut following = rest.chars();
    if following.next() == Some(',') && following.next().is_some_and(|c| c.is_ascii_digit()) {
        return Err(QuantityProblem::DecimalComma);
    }
    Ok((&text[..end], rest.trim_start()))
}

/// Bytes of the decimal number at the start of `text`; 0 if there is none. The typographic minus
/// U+2212, which PDF files contain, counts as a minus sign.
fn number_length(text: &str) -> usize {
    let bytes = text.as_bytes();
    let digits = |from: usize| {
        bytes[from.min(bytes.len())..].iter().take_while(|b| b.is_ascii_digit()).count()
    };
    let sign = match text.chars().next() {
        Some(c @ ('+' | '-' | '\u{2212}')) => c.len_utf8(),
        _ => 0,
    };
    let whole = digits(sign);
    let mut end = sign + whole;
    let mut fraction = 0;
    if bytes.get(end) == Some(&b'.') {
        fraction = digits(end + 1);
        end += 1 + fraction;
    }
    if whole + fraction == 0 {
        return 0;
    }
    if matches!(bytes.get(end), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
        let exponent = digits(end + 1 + sign);
        if exponent > 0 {
            end += 1 + sign + exponent;
        }
    }
    end
}

/// The double nearest to `number` × 10^shift; `number` as [`number_length`] accepts it.
fn parse_decimal(number: &str, shift: i32) -> Result<f64, QuantityProblem> {
    let number = number.replace('\u{2212}', "-");
    let (mantissa, exponent) = match number.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent),
        None => (number.as_str(), "0"),
    };
    // An exponent that does not fit i64 is far outside the doubles; its sign decides.
    let limit = if exponent.starts_with('-') { i64::MIN / 2 } else { i64::MAX / 2 };
    let exponent = exponent.parse::<i64>().unwrap_or(limit).saturating_add(i64::from(shift));
    let value: f64 =
        format!("{mantissa}e{exponent}").parse().map_err(|_| QuantityProblem::NoNumber)?;
    finite(value)
}

fn finite(value: f64) -> Result<f64, QuantityProblem> {
    if value.is_finite() { Ok(value) } else { Err(QuantityProblem::NotFinite) }
}

/// A number as a person would write it: no exponent unless it is very small or large.
pub fn plain(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || (1e-5..1e6).contains(&size) {
        format!("{value}")
    } else {
        format!("{value:e}")
    }
}
