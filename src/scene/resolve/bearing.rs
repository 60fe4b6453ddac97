//! From the given keys to the resolved scene: defaults, and checks between keys.

use crate::ch2_housing::bearing::geometry::{BearingGeometry, BearingKind, Material};
use crate::ch2_housing::bearing::hertz::HertzModel;
use crate::ch2_housing::bearing::rating::LARGEST_CONTACT_ANGLE;
use crate::equilibrium::statics::COORDINATE_NAMES;
use crate::members::body::{Condition, Drive};
use crate::numeric::profile::Profile;
use crate::scene::error::{Problem, SceneError, mm};
use crate::scene::resolve::resolved::{DefaultUsed, Plot, RunPlot, Scene};
use crate::scene::resolve::unused::refuse_unused;
use crate::scene::resolve::{cage, dynamics, geometry, profile, solid};
use crate::scene::tables::keys;
use crate::scene::tables::keys::{DEFAULT_SETS, DEFAULTS, Need};
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;
use crate::scene::text::value;
use crate::scene::text::value::Checked;

/// Validates the document as a whole and turns it into SI.
///
/// # Errors
/// The first key, in a fixed order, that is missing or contradicts others.
pub fn resolve(document: &Document) -> Result<Scene, SceneError> {
    solid::refuse_solid(document)?;
    solid::refuse_fields(document)?;
    resolve_bearing(document)
}

/// The bearing of a scene that may contain a solid as well.
pub(crate) fn resolve_bearing(document: &Document) -> Result<Scene, SceneError> {
    let mut reader = Reader::new(document);
    reader.choice(DEFAULTS);
    let kind = match reader.required_choice("bearing.kind", "")? {
        "angular-contact" => BearingKind::AngularContact,
        _ => BearingKind::DeepGroove,
    };
    refuse_unused(document, &["bearing", "outer_race", "traction", "contact_damping"])?;
    let (geometry, dimensions) = geometry::geometry(&mut reader, kind)?;
    let cage = cage::cage(&reader, &geometry, &dimensions)?;
    let dynamic_rating = rating(&reader, &geometry)?;
    let hertz = match reader.choice("bearing.hertz") {
        "exact" => HertzModel::Exact,
        _ => HertzModel::HamrockBrewe,
    };
    let ball_phase = reader.number("bearing.ball_phase");
    let inner_material = reader.material("bearing.inner_race.material");
    let outer_material = reader.material("bearing.outer_race.material");
    let ball_material = reader.material("bearing.ball.material");
    let inner_drives = reader.drives("inner_race", geometry.ball_radius)?;
    let conditions = inner_drives.each_ref().map(|drive| match drive {
        Drive::Load(profile) => Condition::Load(profile.value(0.0)),
        Drive::Motion(profile) => Condition::Displacement(profile.value(0.0)),
    });
    let outer_race = reader.outer_race(geometry.ball_radius)?;
    let inner_speed = reader.profile("inner_race.speed").map(|speed| speed.value(0.0));
    let outer_speed = reader.profile("outer_race.speed").map(|speed| speed.value(0.0));
    let gravity = reader.vector("ball_forces.gravity");
    let centrifugal = reader.boolean("ball_forces.centrifugal");
    if centrifugal && inner_speed.is_none() {
        return Err(reader.missing("inner_race.speed", " with `ball_forces.centrifugal = true`"));
    }
    let (plots, run_plots) = reader.plots();
    let defaults_used = std::mem::take(&mut reader.defaults_used);
    let parts = dynamics::Parts {
        geometry: &geometry,
        dimensions: &dimensions,
        inner_material: &inner_material,
        outer_material: &outer_material,
        cage: cage.as_ref(),
    };
    let mut dynamics = dynamics::dynamics(&mut reader, &parts, inner_drives)?;
    dynamics.plots = run_plots;
    dynamics.defaults_used = reader.defaults_used;
    Ok(Scene {
        title: text(document, "title"),
        source: text(document, "source"),
        assumptions: document.assumptions(),
        geometry,
        dimensions,
        inner_material,
        outer_material,
        ball_material,
        hertz,
        cage,
        dynamic_rating,
        ball_phase,
        conditions,
        outer_race,
        inner_speed,
        outer_speed,
        gravity,
        centrifugal,
        dynamics,
        plots,
        rigid_housing: false,
        sweep: document.sweep(),
        defaults_used,
    })
}

/// The given dynamic load rating, N.
fn rating(reader: &Reader, geometry: &BearingGeometry) -> Result<Option<f64>, SceneError> {
    const DYNAMIC: &str = "bearing.rating.dynamic";
    let given = reader.given_number(DYNAMIC);
    if given.is_some() && geometry.contact_angle > LARGEST_CONTACT_ANGLE {
        let reason = "the rating life of a thrust bearing is not modelled. Hint: leave it out, or use a contact angle of at most 45 deg";
        return Err(reader.document.error(DYNAMIC, Problem::refused(reason)));
    }
    Ok(given)
}

/// Reads keys and records the defaults used.
pub(crate) struct Reader<'d> {
    pub document: &'d Document,
    defaults_used: Vec<DefaultUsed>,
}

impl<'d> Reader<'d> {
    pub fn new(document: &'d Document) -> Reader<'d> {
        Reader { document, defaults_used: Vec::new() }
    }

    pub fn into_defaults_used(self) -> Vec<DefaultUsed> {
        self.defaults_used
    }

    /// Adds the defaults of a named thing to others, under its name.
    pub fn note_named(self, defaults: &mut Vec<DefaultUsed>) {
        let document = self.document;
        defaults.extend(self.defaults_used.into_iter().map(|mut used| {
            used.name(document);
            used
        }));
    }

    pub fn given_number(&self, path: &str) -> Option<f64> {
        self.document.value(path)?.number()
    }

    pub fn is_given(&self, path: &str) -> bool {
        self.document.value(path).is_some()
    }

    /// The given profile; a plain quantity is a constant one.
    pub fn profile(&self, path: &str) -> Option<Profile> {
        self.document.value(path)?.profile()
    }

    /// The given number, else the default of the key table.
    pub fn number(&mut self, path: &str) -> f64 {
        self.given_number(path).unwrap_or_else(|| self.default_number(path, path))
    }

    /// The default number of the key table, which is then in use for the key `filled`.
    fn default_number(&mut self, path: &str, filled: &str) -> f64 {
        let value = self.note_default_of(path, filled);
        value.and_then(|value| value.number()).unwrap_or(0.0)
    }

    pub fn required_number(&self, path: &str, because: &str) -> Result<f64, SceneError> {
        self.given_number(path).ok_or_else(|| self.missing(path, because))
    }

    /// The default word of the key table, which is then in use.
    fn default_word(&mut self, path: &str) -> &'static str {
        self.note_default(path);
        let need = keys::find(path).map(|(_, key)| key.need);
        need.and_then(|need| need.default_in(self.set())).map_or("", |(value, _)| value)
    }

    /// The given choice, else the default of the key table.
    pub fn choice(&mut self, path: &str) -> &'static str {
        self.choice_if_given(path).unwrap_or_else(|| self.default_word(path))
    }

    /// The given truth value, else the default of the key table.
    pub fn boolean(&mut self, path: &str) -> bool {
        let given = self.document.value(path).and_then(Checked::boolean);
        given.unwrap_or_else(|| self.default_word(path) == "true")
    }

    /// The given vector, else zero, the default of all vectors that are read so.
    pub fn vector(&mut self, path: &str) -> [f64; 3] {
        self.document.value(path).and_then(Checked::vector).unwrap_or_else(|| {
            self.note_default(path);
            [0.0; 3]
        })
    }

    /// The given number of a table of a list, else the default of the key table.
    pub fn of_item(&mut self, item: ItemRef, name: &str) -> f64 {
        item.number(name)
            .unwrap_or_else(|| self.default_number(&item.path(name), &item.own_path(name)))
    }

    /// The given number, else one that follows from other keys.
    pub fn number_or(&mut self, path: &str, usual: f64, shown: &str, reason: &str) -> f64 {
        self.given_number(path).unwrap_or_else(|| {
            self.note(path, shown, reason).fill(path, usual);
            usual
        })
    }

    /// The same for a choice.
    pub fn choice_or(&mut self, path: &str, usual: &'static str, reason: &str) -> &'static str {
        self.choice_if_given(path).unwrap_or_else(|| {
            self.note(path, usual, reason).fill(path, usual);
            usual
        })
    }

    /// Name of the set of defaults.
    fn set(&self) -> &'static str {
        self.choice_if_given(DEFAULTS).unwrap_or(DEFAULT_SETS[0])
    }

    /// The given choice, without the default.
    pub fn choice_if_given(&self, path: &str) -> Option<&'static str> {
        self.document.value(path)?.choice()
    }

    pub fn required_choice(&self, path: &str, because: &str) -> Result<&'static str, SceneError> {
        self.choice_if_given(path).ok_or_else(|| self.missing(path, because))
    }

    /// Records that the key table's default of `path` is in use.
    pub fn note_default(&mut self, path: &str) {
        self.note_default_of(path, path);
    }

    fn note_default_of(&mut self, path: &str, filled: &str) -> Option<Checked> {
        let set = self.set();
        let (_, key) = keys::find(path)?;
        let (shown, reason) = key.need.default_in(set)?;
        let value = value::default_in(key, set);
        let used = match key.need {
            Need::BySet { .. } => self.note(path, shown, &format!("{set} defaults: {reason}")),
            _ => self.note(path, shown, reason),
        };
        used.fills.extend(value.clone().map(|value| (filled.to_string(), value)));
        value
    }

    pub fn note(&mut self, key: &str, value: &str, reason: &str) -> &mut DefaultUsed {
        let [key, value, reason] = [key, value, reason].map(str::to_string);
        self.defaults_used.push(DefaultUsed { key, value, reason, fills: Vec::new() });
        let last = self.defaults_used.len() - 1;
        &mut self.defaults_used[last]
    }

    /// Records the value of a key that is not reported as a default.
    pub fn follow(&mut self, path: &str, value: impl Into<Checked>) {
        self.note(path, "", "").fill(path, value);
    }

    pub fn missing(&self, path: &str, because: &str) -> SceneError {
        let example = keys::find(path).map(|(_, key)| {
            let table = self.document.shown(key.table(), self.document.is_named(path));
            format!("`{} = {}`{}", key.name(), key.example(), below(&table))
        });
        let problem =
            Problem::Missing { because: because.to_string(), example: example.unwrap_or_default() };
        self.document.error(path, problem)
    }

    fn material(&mut self, table: &str) -> Material {
        let paths = ["youngs_modulus", "poisson_ratio", "density"].map(|k| format!("{table}.{k}"));
        if paths.iter().any(|path| self.is_given(path)) {
            let [modulus, poisson, density] = paths;
            return Material {
                youngs_modulus: self.number(&modulus),
                poisson_ratio: self.number(&poisson),
                density: self.number(&density),
            };
        }
        let [modulus, poisson, density] = &paths;
        let steel = Material::STEEL;
        let value = "youngs_modulus 210 GPa, poisson_ratio 0.3, density 7850 kg/m^3";
        self.note(table, value, "bearing steel")
            .fill(modulus, steel.youngs_modulus)
            .fill(poisson, steel.poisson_ratio)
            .fill(density, steel.density);
        steel
    }

    /// Load or prescribed motion of the five coordinates of a race.
    pub fn drives(&mut self, race: &str, ball_radius: f64) -> Result<[Drive; 5], SceneError> {
        let mut drives = [const { Drive::Load(Profile::ZERO) }; 5];
        // A body in elements has loads on its sections only.
        let in_elements =
            race == "body" && self.choice_if_given("body.beam.mesh.method") == Some("explicit");
        for (drive, name) in drives.iter_mut().zip(COORDINATE_NAMES) {
            let table = format!("{race}.{name}");
            let zero = match name.starts_with("tilt") {
                true => "{ moment = \"0 N m\" }",
                false => "{ load = \"0 N\" }",
            };
            let held = dynamics::drive_key(race, name, false);
            let loaded = dynamics::drive_key(race, name, true);
            if let Some(load) = self.profile(&loaded) {
                *drive = Drive::Load(load);
            } else if let Some(motion) = self.profile(&held) {
                self.limit_displacement(&held, profile::largest(&motion), ball_radius)?;
                *drive = Drive::Motion(motion);
            } else {
                let used = self.note(&table, zero, "the coordinate is free and unloaded");
                if !in_elements {
                    used.fill(&loaded, 0.0);
                }
            }
        }
        Ok(drives)
    }

    /// Position of the outer race, at the start if it moves.
    fn outer_race(&mut self, ball_radius: f64) -> Result<[f64; 5], SceneError> {
        let mut position = [0.0; 5];
        for (value, name) in position.iter_mut().zip(COORDINATE_NAMES) {
            let path = format!("outer_race.{name}");
            if let Some(motion) = self.profile(&dynamics::drive_key("outer_race", name, false)) {
                *value = motion.value(0.0);
            } else {
                *value = self.number(&path);
                self.limit_displacement(&path, *value, ball_radius)?;
            }
        }
        Ok(position)
    }

    /// Tilts have their range in the key table; the limit of displacements is the ball radius.
    fn limit_displacement(&self, path: &str, value: f64, ball: f64) -> Result<(), SceneError> {
        if path.contains("tilt") || value.abs() <= ball {
            return Ok(());
        }
        let problem = Problem::Contradiction(format!(
            "the displacement {} is more than a ball radius. Allowed: {} to {}. Hint: check the unit; bearings deflect by \
             micrometres",
            mm(value),
            mm(-ball),
            mm(ball)
        ));
        Err(self.document.error(path, problem))
    }

    /// Plots of statics and of a run.
    fn plots(&self) -> (Vec<Plot>, Vec<RunPlot>) {
        let Some(Checked::Choices(names)) = self.document.value("output.plots") else {
            return (vec![Plot::LoadZone, Plot::Polar], vec![RunPlot::Orbit, RunPlot::Series]);
        };
        let (mut plots, mut run_plots) = (Vec::new(), Vec::new());
        for name in names {
            match *name {
                "load-zone" => plots.push(Plot::LoadZone),
                "polar" => plots.push(Plot::Polar),
                "moment-tilt" => plots.push(Plot::MomentTilt),
                "orbit" => run_plots.push(RunPlot::Orbit),
                "spectrum" => run_plots.push(RunPlot::Spectrum),
                "series" => run_plots.push(RunPlot::Series),
                "run-up" => run_plots.push(RunPlot::RunUp),
                _ => run_plots.push(RunPlot::SlipSpin),
            }
        }
        (plots, run_plots)
    }
}

pub(crate) fn text(document: &Document, path: &str) -> Option<String> {
    document.value(path)?.text().map(str::to_string)
}

pub(crate) fn below(table: &str) -> String {
    if table.is_empty() { " at the top".to_string() } else { format!(" to [{table}]") }
}
