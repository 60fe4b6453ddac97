//! From the given keys to the resolved scene: defaults, and what must hold between keys.

use crate::ch2_housing::bearing::geometry::{BearingKind, Material};
use crate::ch2_housing::bearing::hertz::HertzModel;
use crate::scene::document::Document;
use crate::scene::error::{Problem, SceneError};
use crate::scene::keys::{self, Kind, Need};
use crate::scene::resolve_geometry;
use crate::scene::resolved::{Cage, CageGuidance, DefaultUsed, Plot, Scene};
use crate::scene::units::{parse_number, parse_quantity};
use crate::scene::value::Checked;
use crate::solver::statics::{COORDINATE_NAMES, Condition};

/// Validates the document as a whole and turns it into SI.
///
/// # Errors
/// The first key, in a fixed order, that is missing or contradicts others.
pub fn resolve(document: &Document) -> Result<Scene, SceneError> {
    let mut reader = Reader { document, defaults_used: Vec::new() };
    let kind = match reader.required_choice("bearing.kind")? {
        "angular-contact" => BearingKind::AngularContact,
        _ => BearingKind::DeepGroove,
    };
    let (geometry, dimensions) = resolve_geometry::geometry(&mut reader, kind)?;
    let cage = cage(&reader, geometry.ball_radius)?;
    let hertz = match reader.choice("bearing.hertz") {
        Some("exact") => HertzModel::Exact,
        _ => HertzModel::HamrockBrewe,
    };
    let ball_phase = reader.number("bearing.ball_phase").unwrap_or(0.0);
    let inner_material = reader.material("bearing.inner_race.material");
    let outer_material = reader.material("bearing.outer_race.material");
    let ball_material = reader.material("bearing.ball.material");
    let conditions = reader.conditions(geometry.ball_radius)?;
    let outer_race = reader.outer_race(geometry.ball_radius)?;
    let inner_speed = reader.given_number("inner_race.speed");
    let gravity = match document.value("ball_forces.gravity") {
        Some(Checked::Vector(gravity)) => *gravity,
        _ => {
            reader.note_default("ball_forces.gravity");
            [0.0; 3]
        }
    };
    let centrifugal = match document.value("ball_forces.centrifugal") {
        Some(Checked::Boolean(centrifugal)) => *centrifugal,
        _ => {
            reader.note_default("ball_forces.centrifugal");
            false
        }
    };
    if centrifugal && inner_speed.is_none() {
        return Err(reader.missing("inner_race.speed", " with `ball_forces.centrifugal = true`"));
    }
    Ok(Scene {
        title: reader.text("title"),
        source: reader.text("source"),
        assumptions: document.assumptions().to_vec(),
        geometry,
        dimensions,
        inner_material,
        outer_material,
        ball_material,
        hertz,
        cage,
        ball_phase,
        conditions,
        outer_race,
        inner_speed,
        gravity,
        centrifugal,
        plots: reader.plots(),
        sweep: document.sweep().to_vec(),
        defaults_used: reader.defaults_used,
    })
}

/// Looks keys up and keeps note of the defaults used.
pub(crate) struct Reader<'d> {
    pub document: &'d Document,
    defaults_used: Vec<DefaultUsed>,
}

impl Reader<'_> {
    pub fn given_number(&self, path: &str) -> Option<f64> {
        match self.document.value(path)? {
            Checked::Number(value) => Some(*value),
            Checked::Integer(value) => Some(*value as f64),
            _ => None,
        }
    }

    pub fn is_given(&self, path: &str) -> bool {
        self.document.value(path).is_some()
    }

    /// The given number, else the default of the key table.
    fn number(&mut self, path: &str) -> Option<f64> {
        self.given_number(path).or_else(|| {
            self.note_default(path);
            default_number(path)
        })
    }

    pub fn required_number(&self, path: &str, because: &str) -> Result<f64, SceneError> {
        self.given_number(path).ok_or_else(|| self.missing(path, because))
    }

    fn given_choice(&self, path: &str) -> Option<&'static str> {
        match self.document.value(path)? {
            Checked::Choice(word) => Some(word),
            _ => None,
        }
    }

    /// The given word, else the default of the key table.
    pub fn choice(&mut self, path: &str) -> Option<&'static str> {
        self.given_choice(path).or_else(|| {
            self.note_default(path);
            match keys::find(path)?.1.need {
                Need::Default { value, .. } => Some(value),
                _ => None,
            }
        })
    }

    /// The given word, without recourse to the default.
    pub fn choice_if_given(&self, path: &str) -> Option<&'static str> {
        self.given_choice(path)
    }

    fn required_choice(&self, path: &str) -> Result<&'static str, SceneError> {
        self.given_choice(path).ok_or_else(|| self.missing(path, ""))
    }

    fn text(&self, path: &str) -> Option<String> {
        match self.document.value(path)? {
            Checked::Text(text) => Some(text.clone()),
            _ => None,
        }
    }

    /// Notes that the key table's default of `path` is in use.
    fn note_default(&mut self, path: &str) {
        if let Some((_, key)) = keys::find(path)
            && let Need::Default { value, reason } = key.need
        {
            self.note(path, value, reason);
        }
    }

    pub fn note(&mut self, key: &str, value: &str, reason: &str) {
        self.defaults_used.push(DefaultUsed {
            key: key.to_string(),
            value: value.to_string(),
            reason: reason.to_string(),
        });
    }

    pub fn missing(&self, path: &str, because: &str) -> SceneError {
        let example = keys::find(path)
            .map(|(_, key)| format!("`{} = {}`{}", key.name(), key.example(), below(key.table())));
        let problem =
            Problem::Missing { because: because.to_string(), example: example.unwrap_or_default() };
        self.document.error(path, problem)
    }

    fn material(&mut self, table: &str) -> Material {
        let paths = ["youngs_modulus", "poisson_ratio", "density"].map(|k| format!("{table}.{k}"));
        if paths.iter().any(|path| self.is_given(path)) {
            let [modulus, poisson, density] = paths;
            return Material {
                youngs_modulus: self.number(&modulus).unwrap_or(Material::STEEL.youngs_modulus),
                poisson_ratio: self.number(&poisson).unwrap_or(Material::STEEL.poisson_ratio),
                density: self.number(&density).unwrap_or(Material::STEEL.density),
            };
        }
        self.note(
            table,
            "youngs_modulus 210 GPa, poisson_ratio 0.3, density 7850 kg/m^3",
            "bearing steel",
        );
        Material::STEEL
    }

    fn conditions(&mut self, ball_radius: f64) -> Result<[Condition; 5], SceneError> {
        let mut conditions = [Condition::Load(0.0); 5];
        for (condition, name) in conditions.iter_mut().zip(COORDINATE_NAMES) {
            let table = format!("inner_race.{name}");
            let (load, held, zero) = if name.starts_with("tilt") {
                ("moment", "tilt", "{ moment = \"0 N m\" }")
            } else {
                ("load", "displacement", "{ load = \"0 N\" }")
            };
            let held = format!("{table}.{held}");
            if let Some(load) = self.given_number(&format!("{table}.{load}")) {
                *condition = Condition::Load(load);
            } else if let Some(value) = self.given_number(&held) {
                self.limit_displacement(&held, value, ball_radius)?;
                *condition = Condition::Displacement(value);
            } else {
                self.note(&table, zero, "the coordinate is free and unloaded");
            }
        }
        Ok(conditions)
    }

    fn outer_race(&mut self, ball_radius: f64) -> Result<[f64; 5], SceneError> {
        let mut position = [0.0; 5];
        for (value, name) in position.iter_mut().zip(COORDINATE_NAMES) {
            let path = format!("outer_race.{name}");
            *value = self.number(&path).unwrap_or(0.0);
            self.limit_displacement(&path, *value, ball_radius)?;
        }
        Ok(position)
    }

    /// Tilts have their range in the key table; displacements are measured by the ball.
    fn limit_displacement(&self, path: &str, value: f64, ball: f64) -> Result<(), SceneError> {
        if path.contains("tilt") || value.abs() <= ball {
            return Ok(());
        }
        Err(self.document.error(path, Problem::DisplacementTooLarge { displacement: value, ball }))
    }

    fn plots(&self) -> Vec<Plot> {
        match self.document.value("output.plots") {
            Some(Checked::Choices(names)) => names
                .iter()
                .map(|name| match *name {
                    "load-zone" => Plot::LoadZone,
                    "polar" => Plot::Polar,
                    _ => Plot::MomentTilt,
                })
                .collect(),
            _ => vec![Plot::LoadZone, Plot::Polar],
        }
    }
}

pub(crate) fn below(table: &str) -> String {
    if table.is_empty() { " at the top".to_string() } else { format!(" to [{table}]") }
}

fn default_number(path: &str) -> Option<f64> {
    let (_, key) = keys::find(path)?;
    let Need::Default { value, .. } = key.need else { return None };
    match key.kind {
        Kind::Quantity(dimension, _) => {
            parse_quantity(value, dimension).ok().map(|quantity| quantity.si)
        }
        _ => parse_number(value).ok(),
    }
}

fn cage(reader: &Reader, ball_radius: f64) -> Result<Option<Cage>, SceneError> {
    let guidance = reader.choice_if_given("bearing.cage.guidance").map(|word| match word {
        "outer-race" => CageGuidance::OuterRace,
        "inner-race" => CageGuidance::InnerRace,
        _ => CageGuidance::Balls,
    });
    let cage = Cage {
        pocket_radius: reader.given_number("bearing.cage.pocket_radius"),
        inner_radius: reader.given_number("bearing.cage.inner_radius"),
        outer_radius: reader.given_number("bearing.cage.outer_radius"),
        race_clearance: reader.given_number("bearing.cage.race_clearance"),
        mass: reader.given_number("bearing.cage.mass"),
        guidance,
    };
    if cage == Cage::default() {
        return Ok(None);
    }
    if let Some(pocket) = cage.pocket_radius
        && pocket < ball_radius
    {
        let problem = Problem::BallExceedsPocket { pocket, ball: ball_radius };
        return Err(reader.document.error("bearing.cage.pocket_radius", problem));
    }
    if let (Some(inner), Some(outer)) = (cage.inner_radius, cage.outer_radius)
        && inner >= outer
    {
        let problem = Problem::WrongOrder {
            value: inner,
            relation: "less than",
            other_name: "the cage's outer radius",
            other: outer,
            advice: "were the two exchanged?",
        };
        return Err(reader.document.error("bearing.cage.inner_radius", problem));
    }
    Ok(Some(cage))
}
