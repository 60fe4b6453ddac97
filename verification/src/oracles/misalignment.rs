//! Moment over tilt of Table 3.5's bearing (3.4.5 and Table 3.7, fixed outer race) under many
//! readings of what the source leaves open.
//!
//! Published: 6.423 N·m at 0.15°, and 0.094°, 0.134°, 0.175° at 2.5, 5, 10 N·m. The rows show which
//! readings reproduce the first three numbers and that the fourth belongs to none of them. The
//! published numbers alone say why: ln M rises with ln θ at 1.95 between the first two tilts, at
//! 2.2 up to 0.15° and then at 2.87 up to 0.175°; the model's slopes grow smoothly (1.95, 2.26,
//! 2.47), and at 0.175° it carries 9.37 N·m.

use super::hertz::{RelativeRadii, ball_on_race, exact, hamrock_brewe, in_series};
use super::statics::{Known, OracleBearing};

/// Steel on steel with E 210 GPa and ν 0.3 (Table 2.3): E′ = E/(1−ν²).
pub const STEEL_ON_STEEL: f64 = 210e9 / 0.91;

/// Dimensions in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dimensions {
    pub balls: usize,
    pub ball_radius: f64,
    /// Groove-bottom radius and groove radius.
    pub inner: [f64; 2],
    pub outer: [f64; 2],
}

/// Table 3.5 with the ball of 5.9555 mm that makes 5 µm radial interference.
pub const TABLE_3_5: Dimensions = Dimensions {
    balls: 8,
    ball_radius: 5.9555e-3,
    inner: [20.047e-3, 6.013e-3],
    outer: [31.953e-3, 6.310e-3],
};

/// Hamrock–Brewe stiffness, N/m^1.5.
pub fn fitted(radii: RelativeRadii) -> f64 {
    hamrock_brewe(radii, 1.0, STEEL_ON_STEEL).stiffness
}

/// Exact Hertz stiffness, N/m^1.5.
pub fn elliptic(radii: RelativeRadii) -> f64 {
    exact(radii, 1.0, STEEL_ON_STEEL).stiffness
}

impl Dimensions {
    /// `[inner, outer]` under a stiffness law.
    pub fn stiffness(&self, law: fn(RelativeRadii) -> f64) -> [f64; 2] {
        [(self.inner, 1.0), (self.outer, -1.0)]
            .map(|([race, groove], sign)| law(ball_on_race(self.ball_radius, race, groove, sign)))
    }

    /// Deep-groove bearing at the origin; `phase` in rad.
    pub fn bearing(&self, stiffness: [f64; 2], phase: f64) -> OracleBearing {
        OracleBearing::at_origin(
            self.balls,
            self.ball_radius,
            [self.inner[0] + self.inner[1], 0.0, self.inner[1]],
            [self.outer[0] - self.outer[1], 0.0, self.outer[1]],
            stiffness,
            phase,
        )
    }
}

/// What one reading gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    pub name: String,
    /// N·m.
    pub moment_at_0_15_degrees: f64,
    /// Degrees at 2.5, 5 and 10 N·m.
    pub tilt_degrees: [f64; 3],
    /// Largest unbalanced load of the four solutions, N.
    pub residual: f64,
}

/// Which coordinate is tilted, which are held, what else acts.
#[derive(Clone, Copy)]
struct Setting {
    axis: usize,
    held: [bool; 5],
    loads: [f64; 5],
}

/// Tilt about Y, everything else free and unloaded.
const PLAIN: Setting = Setting { axis: 3, held: [false; 5], loads: [0.0; 5] };

fn read(name: &str, bearing: &OracleBearing, setting: Setting) -> Reading {
    let under = |tilted: Known| {
        let known: [Known; 5] = std::array::from_fn(|i| {
            if i == setting.axis {
                tilted
            } else if setting.held[i] {
                Known::Value(0.0)
            } else {
                Known::Load(setting.loads[i])
            }
        });
        bearing.solve(&known, None)
    };
    let held = under(Known::Value(0.15_f64.to_radians()));
    let turned = [2.5, 5.0, 10.0].map(|moment| under(Known::Load(moment)));
    Reading {
        name: name.into(),
        moment_at_0_15_degrees: held.loads[setting.axis],
        residual: turned.iter().map(|found| found.residual).fold(held.residual, f64::max),
        tilt_degrees: turned.map(|found| found.coordinates[setting.axis].to_degrees()),
    }
}

/// The stated bearing, tilt about Y, all else free and unloaded, ball phase in degrees.
pub fn baseline(phase_degrees: f64) -> Reading {
    let bearing = TABLE_3_5.bearing(TABLE_3_5.stiffness(fitted), phase_degrees.to_radians());
    read(&format!("Hamrock–Brewe, phase {phase_degrees}°"), &bearing, PLAIN)
}

/// All readings tried. The first rows differ in what the source may mean, the last ones put in
/// what it would take to move the 10 N·m row alone.
pub fn readings() -> Vec<Reading> {
    let table = TABLE_3_5;
    let stiffness = table.stiffness(fitted);
    let stated = table.bearing(stiffness, 0.0);
    let scaled = |factor: f64| table.bearing(stiffness.map(|k| factor * k), 0.0);
    let with = |dimensions: Dimensions| dimensions.bearing(dimensions.stiffness(fitted), 0.0);

    let mut rows: Vec<Reading> = [0.0, 5.0, 11.25, 15.0, 22.5].map(baseline).into();
    let centred = [true, true, true, false, false];
    rows.extend([
        read("x held", &stated, Setting { held: [true, false, false, false, false], ..PLAIN }),
        read("x, y, z held", &stated, Setting { held: centred, ..PLAIN }),
        read(
            "x, y, z and the other tilt held, phase 11.25°",
            &table.bearing(stiffness, 11.25_f64.to_radians()),
            Setting { held: [true, true, true, false, true], ..PLAIN },
        ),
        read("tilt about Z", &stated, Setting { axis: 4, ..PLAIN }),
        read("exact Hertz", &table.bearing(table.stiffness(elliptic), 0.0), PLAIN),
        read("both contacts merged into one in series", &merged(), PLAIN),
        read("race radii at a contact angle of 11°", &at_contact_angle(11.0), PLAIN),
    ]);
    for radius in [5.955e-3, 5.9557e-3, 5.956e-3] {
        let name = format!("ball radius {:.4} mm", 1e3 * radius);
        rows.push(read(&name, &with(Dimensions { ball_radius: radius, ..table }), PLAIN));
    }
    let zero_clearance = Dimensions { ball_radius: 5.953e-3, ..table };
    let [inner, outer] = [table.inner, table.outer];
    rows.extend([
        read(
            "interference through the inner race",
            &with(Dimensions { inner: [inner[0] + 5e-6, inner[1]], ..zero_clearance }),
            PLAIN,
        ),
        read(
            "interference through the outer race",
            &with(Dimensions { outer: [outer[0] - 5e-6, outer[1]], ..zero_clearance }),
            PLAIN,
        ),
        read(
            "groove radii exchanged",
            &with(Dimensions { inner: [inner[0], outer[1]], outer: [outer[0], inner[1]], ..table }),
            PLAIN,
        ),
        read("7 balls", &with(Dimensions { balls: 7, ..table }), PLAIN),
        read("9 balls", &with(Dimensions { balls: 9, ..table }), PLAIN),
        read("E′ = E (Poisson's ratio forgotten)", &scaled(0.91), PLAIN),
        read("rigid inner contact", &table.bearing([1e3 * stiffness[0], stiffness[1]], 0.0), PLAIN),
        read("rigid outer contact", &table.bearing([stiffness[0], 1e3 * stiffness[1]], 0.0), PLAIN),
        read("stiffness × 1.07", &scaled(1.07), PLAIN),
    ]);
    for (name, index, load) in [
        ("axial load 150 N", 0, 150.0),
        ("radial load 500 N along Z", 2, 500.0),
        ("radial load 1000 N along Y", 1, 1000.0),
        ("moment 3 N·m about Z", 4, 3.0),
    ] {
        let mut setting = PLAIN;
        setting.loads[index] = load;
        rows.push(read(name, &stated, setting));
    }
    let mut spinning = stated.clone();
    // 7850 kg/m³ balls on a cage at 0.3855 × 1000 rpm.
    let mass = 4.0 / 3.0 * std::f64::consts::PI * table.ball_radius.powi(3) * 7850.0;
    spinning.centrifugal = mass * (0.3855 * 1000.0 * std::f64::consts::TAU / 60.0).powi(2);
    spinning.ball_force = [0.0, 0.0, -9.81 * mass];
    rows.push(read("centrifugal force at 1000 rpm and ball weight", &spinning, PLAIN));
    rows
}

/// One contact per ball with the stiffness of both: the inner one ten thousand times too stiff,
/// the outer one making up for it.
fn merged() -> OracleBearing {
    let [inner, outer] = TABLE_3_5.stiffness(fitted);
    let rigid = 1e4 * inner;
    let rest = in_series(inner, outer).powf(-2.0 / 3.0) - rigid.powf(-2.0 / 3.0);
    TABLE_3_5.bearing([rigid, rest.powf(-1.5)], 0.0)
}

/// Stiffness of the contacts with the curvature of the races where an oblique contact touches.
fn at_contact_angle(degrees: f64) -> OracleBearing {
    let cos = degrees.to_radians().cos();
    let pitch = 26e-3;
    let mut there = TABLE_3_5;
    there.inner[0] = pitch / cos - there.ball_radius;
    there.outer[0] = pitch / cos + there.ball_radius;
    TABLE_3_5.bearing(there.stiffness(fitted), 0.0)
}
