//! A resolved scene in SI units, the features that this program claims, and its Hertz contacts.

use serde_json::Value;
use std::f64::consts::PI;

/// Reason to stop: the scene needs an unclaimed feature (exit code 3), or another error (exit code 1).
#[derive(Debug)]
pub enum Stop {
    Unclaimed(String),
    Error(String),
}

pub type Outcome<T> = Result<T, Stop>;

pub const COORDINATES: [&str; 5] = ["x", "y", "z", "tilt_y", "tilt_z"];

/// Raceway: circle of groove centres, groove radius (m) and elastic constants.
#[derive(Clone, Copy, Debug, Default)]
pub struct Race {
    pub axial: f64,
    pub radial: f64,
    pub groove: f64,
    pub material: [f64; 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Through {
    Ball,
    Inner,
    Outer,
    Races,
}

/// Time span and start of a run.
#[derive(Clone, Copy, Debug)]
pub struct Run {
    pub end: f64,
    pub interval: f64,
    /// Fixed step, s, of a scene with the integrator `rk4`; `None` follows from the contact stiffness.
    pub step: Option<f64>,
    pub from_equilibrium: bool,
    /// Mass (kg), axial and transverse moment of inertia (kg m²) of the inner race.
    pub inertia: [f64; 3],
    /// Hunt–Crossley coefficient, s/m.
    pub alpha: f64,
    pub window_start: f64,
    /// Balls that touch would push each other: such runs are refused.
    pub touching: bool,
}

#[derive(Clone, Copy, Debug)]
pub struct Scene {
    pub deep_groove: bool,
    pub exact: bool,
    pub count: usize,
    /// Azimuth of ball 1, rad.
    pub phase: f64,
    pub ball_radius: f64,
    /// Ball radius before the clearance is applied, m.
    pub nominal: f64,
    pub ball_mass: f64,
    pub density: f64,
    pub ball_material: [f64; 2],
    pub pitch: f64,
    pub contact_angle: f64,
    pub clearance: f64,
    pub through: Through,
    pub inner: Race,
    pub outer: Race,
    pub gravity: [f64; 3],
    pub centrifugal: bool,
    pub turns: bool,
    /// Speed of the inner race, rad/s.
    pub speed: f64,
    /// Position of the outer race: x, y, z, tilt_y, tilt_z.
    pub outer_at: [f64; 5],
    pub free: [bool; 5],
    /// Load on a free coordinate, value of a prescribed one.
    pub condition: [f64; 5],
    pub run: Option<Run>,
}

/// Hertz contact of a ball with one race.
#[derive(Clone, Copy, Debug)]
pub struct Hertz {
    pub stiffness: f64,
    pub ellipticity: f64,
    pub second: f64,
    pub rolling: f64,
    pub transverse: f64,
    pub modulus: f64,
}

/// True for values that leave a feature out.
fn neutral(value: &Value) -> bool {
    match value {
        Value::Null | Value::Bool(false) => true,
        Value::String(text) => ["inner_race", "outer_race", "fixed"].contains(&text.as_str()),
        Value::Array(items) => items.is_empty(),
        Value::Object(items) => items.is_empty(),
        number => number.as_f64() == Some(0.0),
    }
}

struct Reader<'a>(&'a Value);

impl<'a> Reader<'a> {
    fn get(&self, path: &str) -> &'a Value {
        path.split('.').fold(self.0, |node, key| node.get(key).unwrap_or(&Value::Null))
    }
    fn number(&self, path: &str) -> Outcome<f64> {
        self.get(path).as_f64().ok_or_else(|| Stop::Error(format!("{path}: a number in SI units is needed")))
    }
    fn number_or(&self, path: &str, default: f64) -> Outcome<f64> {
        if self.get(path).is_null() { Ok(default) } else { self.number(path) }
    }
    fn word(&self, path: &str) -> &'a str {
        self.get(path).as_str().unwrap_or("")
    }
    /// A raceway before the clearance is applied, as if the balls had their nominal radius; `side` is +1 for the inner race.
    fn race(&self, name: &str, side: f64, nominal: f64) -> Outcome<Race> {
        let at = |key: &str| self.number(&format!("bearing.{name}.{key}"));
        let has = |key: &str| !self.get(&format!("bearing.{name}.{key}")).is_null();
        let groove = match ["groove_radius", "conformity"].map(has) {
            [true, _] => at("groove_radius")?,
            [_, true] => 2.0 * nominal * at("conformity")?,
            _ => nominal / at("osculation")?,
        };
        let angle = self.number_or("bearing.contact_angle", 0.0)?;
        let room = side * (groove - nominal);
        let (axial, radial) = if self.word("bearing.kind") == "deep-groove" {
            (0.0, at("radius")? + side * groove)
        } else {
            (room * angle.sin(), self.number("bearing.pitch_radius")? + room * angle.cos())
        };
        Ok(Race { axial, radial, groove, material: [at("material.youngs_modulus")?, at("material.poisson_ratio")?] })
    }
    /// Refuses keys outside `known` unless their value leaves the feature out.
    fn only(&self, table: &str, known: &str) -> Outcome<()> {
        let node = if table.is_empty() { self.0 } else { self.get(table) };
        for (key, value) in node.as_object().into_iter().flatten() {
            if !known.split(' ').any(|name| name == key) && !neutral(value) {
                return Err(Stop::Unclaimed(format!("{table}{}{key}", if table.is_empty() { "" } else { "." })));
            }
        }
        Ok(())
    }
}

fn unclaimed<T>(name: &str) -> Outcome<T> {
    Err(Stop::Unclaimed(name.into()))
}

/// Reads a resolved scene.
///
/// # Errors
///
/// A feature that this program does not claim, or a key that is absent.
pub fn read(resolved: &Value, kind: &str) -> Outcome<Scene> {
    let file = Reader(resolved);
    if !["deep-groove", "angular-contact"].contains(&file.word("bearing.kind")) {
        return unclaimed("a scene other than one ball bearing");
    }
    if !["statics", "run"].contains(&kind) {
        return unclaimed(kind);
    }
    let turning = kind == "run";
    let general = "title source defaults units assumptions bearing inner_race outer_race ball_forces traction contact_damping \
                   ball_contact numerics output sweep";
    file.only("", general)?;
    file.only("inner_race", "x y z tilt_y tilt_z speed inertia")?;
    file.only("outer_race", "x y z tilt_y tilt_z")?;
    for key in "inner_on outer_on inner_at outer_at reversed dent spall waviness ball.deviations".split(' ') {
        if !neutral(file.get(&format!("bearing.{key}"))) {
            return unclaimed(&format!("bearing.{key}"));
        }
    }
    let (mut free, mut condition, mut outer_at) = ([true; 5], [0.0; 5], [0.0; 5]);
    for (i, name) in COORDINATES.iter().enumerate() {
        outer_at[i] = file.number_or(&format!("outer_race.{name}"), 0.0).or_else(|_| unclaimed("a moving outer race"))?;
        for (key, value) in file.get(&format!("inner_race.{name}")).as_object().into_iter().flatten() {
            free[i] = ["load", "moment"].contains(&key.as_str());
            match value.as_f64() {
                Some(number) => condition[i] = number,
                None => return unclaimed("a profile over time"),
            }
        }
    }
    let mut gravity = [0.0; 3];
    for (slot, value) in gravity.iter_mut().zip(file.get("ball_forces.gravity").as_array().into_iter().flatten()) {
        *slot = value.as_f64().unwrap_or(0.0);
    }
    let run = if turning {
        if file.word("traction.law") != "none" {
            return unclaimed("traction");
        }
        if !neutral(file.get("bearing.cage.mass")) {
            return unclaimed("a moving cage");
        }
        if file.get("inner_race.inertia").is_null() {
            return unclaimed("a race without inertia");
        }
        let damped = file.word("contact_damping.law") == "hunt-crossley";
        Some(Run {
            end: file.number("numerics.end")?,
            interval: file.number("numerics.output_interval")?,
            step: file.get("numerics.step").as_f64(),
            from_equilibrium: file.word("numerics.start") != "nominal",
            inertia: [
                file.number("inner_race.inertia.mass")?,
                file.number("inner_race.inertia.axial")?,
                file.number("inner_race.inertia.transverse")?,
            ],
            alpha: if damped { file.number("contact_damping.alpha")? } else { 0.0 },
            window_start: file.number_or("output.window_start", 0.0)?,
            touching: file.word("ball_contact.law") != "none",
        })
    } else {
        None
    };
    let speed = file.get("inner_race.speed");
    if !speed.is_null() && speed.as_f64().is_none() {
        return unclaimed("a profile over time");
    }
    let given = file.number("bearing.clearance.radial");
    let given = given.or_else(|_| file.number("bearing.clearance.diametral").map(|clearance| 0.5 * clearance));
    let radius = file
        .number("bearing.ball.radius")
        .or_else(|_| file.number("bearing.ball.diameter").map(|diameter| 0.5 * diameter))
        .or_else(|_| {
            let race = |name: &str| file.number(&format!("bearing.{name}_race.radius"));
            let clearance = given.as_ref().map_or(0.0, |clearance| *clearance);
            Ok(0.5 * (race("outer")? - race("inner")? - clearance))
        })?;
    let density = file.number("bearing.ball.material.density")?;
    let (inner, outer) = (file.race("inner_race", 1.0, radius)?, file.race("outer_race", -1.0, radius)?);
    let deep_groove = file.word("bearing.kind") == "deep-groove";
    let before = if deep_groove { inner.groove + outer.groove - 2.0 * radius + outer.radial - inner.radial } else { 0.0 };
    let unused = !deep_groove && given.as_ref().is_ok_and(|clearance| *clearance == 0.0);
    let mut scene = Scene {
        deep_groove,
        exact: file.word("bearing.hertz") != "hamrock-brewe",
        count: file.number("bearing.balls")? as usize,
        phase: file.number("bearing.ball_phase")?,
        ball_radius: radius,
        nominal: radius,
        ball_mass: density * 4.0 / 3.0 * PI * radius.powi(3),
        density,
        ball_material: [
            file.number("bearing.ball.material.youngs_modulus")?,
            file.number("bearing.ball.material.poisson_ratio")?,
        ],
        pitch: 0.0,
        contact_angle: file.number_or("bearing.contact_angle", 0.0)?,
        clearance: before,
        through: match file.word("bearing.clearance.through") {
            "ball" => Through::Ball,
            "inner-race" => Through::Inner,
            "outer-race" => Through::Outer,
            "" if given.is_err() || unused || file.word("defaults") == "dissertation" => Through::Ball,
            _ => Through::Races,
        },
        inner,
        outer,
        gravity,
        // A run always has centrifugal forces.
        centrifugal: turning || file.get("ball_forces.centrifugal") == &Value::Bool(true),
        turns: !speed.is_null(),
        speed: speed.as_f64().unwrap_or(0.0),
        outer_at,
        free,
        condition,
        run,
    };
    scene.set_clearance(given.unwrap_or(before));
    if !deep_groove {
        scene.pitch = file.number("bearing.pitch_radius")?;
    }
    Ok(scene)
}

impl Scene {
    /// Sets one key of the scene to a value in SI units.
    ///
    /// # Errors
    ///
    /// A key that cannot be varied.
    pub fn set(&mut self, key: &str, value: f64) -> Outcome<()> {
        match key {
            "bearing.ball_phase" => self.phase = value,
            "bearing.clearance.radial" => self.set_clearance(value),
            "bearing.clearance.diametral" => self.set_clearance(0.5 * value),
            "inner_race.speed" => self.speed = value,
            "contact_damping.alpha" if self.run.is_some() => self.run.iter_mut().for_each(|run| run.alpha = value),
            _ => {
                let place = key.strip_prefix("inner_race.").and_then(|rest| rest.split_once('.'));
                let index = place.and_then(|(name, _)| COORDINATES.iter().position(|known| *known == name));
                let loads = place.map(|(_, kind)| ["load", "moment"].contains(&kind));
                match (index, loads) {
                    (Some(index), Some(load)) if self.free[index] == load => self.condition[index] = value,
                    _ => return Err(Stop::Unclaimed(format!("varying {key}"))),
                }
            }
        }
        Ok(())
    }

    /// Changes the radial clearance (m) through the part that the scene names.
    fn set_clearance(&mut self, clearance: f64) {
        let change = clearance - self.clearance;
        self.clearance = clearance;
        match self.through {
            Through::Ball => {
                let axial = self.inner.axial - self.outer.axial;
                // Radial distance of the groove centres without clearance does not depend on the ball.
                let radial = self.inner.radial - self.outer.radial + clearance;
                self.ball_radius = 0.5 * (self.inner.groove + self.outer.groove - axial.hypot(radial));
                self.ball_mass = self.density * 4.0 / 3.0 * PI * self.ball_radius.powi(3);
            }
            Through::Inner => self.inner.radial -= change,
            Through::Outer => self.outer.radial += change,
            Through::Races => {
                self.inner.radial -= 0.5 * change;
                self.outer.radial += 0.5 * change;
            }
        }
        if self.deep_groove {
            self.pitch = 0.5 * (self.inner.radial - self.inner.groove + self.outer.radial + self.outer.groove);
        }
    }

    /// Ratio of ball radius to pitch radius, times the cosine of the contact angle.
    pub fn gamma(&self) -> f64 {
        self.ball_radius / self.pitch * self.contact_angle.cos()
    }

    /// Speed of the ball set that rolls without slip, rad/s.
    pub fn orbital(&self) -> f64 {
        0.5 * (1.0 - self.gamma()) * self.speed
    }

    /// Hertz contacts with the inner and the outer race at the nominal geometry.
    pub fn hertz(&self) -> [Hertz; 2] {
        [(&self.inner, 1.0), (&self.outer, -1.0)].map(|(race, sign)| {
            let principal = race.radial / self.contact_angle.cos() - sign * race.groove;
            let rolling = 1.0 / (1.0 / self.ball_radius + sign / principal);
            let transverse = 1.0 / (1.0 / self.ball_radius - 1.0 / race.groove);
            let ratio = (transverse / rolling).max(rolling / transverse);
            let (ellipticity, first, second) = if self.exact {
                elliptic(ratio)
            } else {
                (1.0339 * ratio.powf(0.636), 1.5277 + 0.6023 * ratio.ln(), 1.0003 + 0.5968 / ratio)
            };
            let compliance = |[young, poisson]: [f64; 2]| (1.0 - poisson * poisson) / young;
            let modulus = 2.0 / (compliance(self.ball_material) + compliance(race.material));
            let curvature = 1.0 / rolling + 1.0 / transverse;
            let stiffness = PI * ellipticity * modulus * (2.0 * second / (9.0 * curvature * first.powi(3))).sqrt();
            Hertz { stiffness, ellipticity, second, rolling, transverse, modulus }
        })
    }
}

/// Ellipticity k and the complete elliptic integrals F and E, from R_y/R_x = (k²E − F)/(F − E), by the secant method.
fn elliptic(ratio: f64) -> (f64, f64, f64) {
    let integrals = |k: f64| {
        // Arithmetic-geometric mean with the sum for the second kind.
        let (mut a, mut g, mut c2, mut power) = (1.0, 1.0 / k, 1.0 - 1.0 / (k * k), 0.5);
        let mut sum = power * c2;
        for _ in 0..8 {
            let next = 0.5 * (a + g);
            c2 = 0.25 * (a - g) * (a - g);
            g = (a * g).sqrt();
            a = next;
            power *= 2.0;
            sum += power * c2;
            if c2 < 1e-34 {
                break;
            }
        }
        let first = 0.5 * PI / a;
        (first, first * (1.0 - sum), first * sum)
    };
    let misfit = |x: f64| {
        let k = x.exp();
        let (first, second, difference) = integrals(k);
        ((k * k * second - first) / difference).ln() - ratio.ln()
    };
    let guess = (1.0339 * ratio.powf(0.636)).max(1.01).ln();
    let (mut x, mut at) = (guess, misfit(guess));
    let mut slope = 1.5;
    for _ in 0..40 {
        let step = -at / slope;
        let next = misfit(x + step);
        if step.abs() < 1e-15 || next == at {
            break;
        }
        slope = (next - at) / step;
        x += step;
        at = next;
    }
    let k = x.exp();
    let (first, second, _) = integrals(k);
    (k, first, second)
}
