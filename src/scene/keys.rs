//! The key table: every key a scene may hold, what it means and what it may be.
//!
//! Reading, the refusal of unknown keys, `docs/scene.md` and the JSON Schema all follow this table.

use crate::scene::units::Dimension;
use std::collections::HashMap;
use std::sync::LazyLock;

/// Allowed interval of a number, in `unit` (empty for a plain number).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub high: f64,
    /// The bounds themselves are allowed.
    pub low_included: bool,
    pub high_included: bool,
    pub unit: &'static str,
}

impl Range {
    /// Whether `value`, in SI for a quantity of `dimension`, lies inside; NaN does not.
    pub fn contains(&self, value: f64, dimension: Option<Dimension>) -> bool {
        let unit = dimension.and_then(|dimension| dimension.find(self.unit));
        let scale = unit.map_or(1.0, |unit| unit.scale.factor());
        let (low, high) = (self.low * scale, self.high * scale);
        let above = if self.low_included { value >= low } else { value > low };
        let below = if self.high_included { value <= high } else { value < high };
        above && below
    }
}

impl std::fmt::Display for Range {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let gap = if self.unit.is_empty() { "" } else { " " };
        let low = if self.low_included { "from" } else { "more than" };
        let high = if self.high_included { "to" } else { "to less than" };
        let number = crate::scene::units::plain;
        write!(
            f,
            "{low} {}{gap}{unit} {high} {}{gap}{unit}",
            number(self.low),
            number(self.high),
            unit = self.unit
        )
    }
}

/// What a key's value looks like.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Text,
    Boolean,
    Integer {
        low: i64,
        high: i64,
    },
    /// One of these words.
    Choice(&'static [&'static str]),
    /// A list of different words out of these.
    Choices(&'static [&'static str]),
    /// A number without unit.
    Number(Range),
    /// A string of a number and a unit.
    Quantity(Dimension, Range),
    /// A list of three quantities along X, Y and Z.
    Vector(Dimension, Range),
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Need {
    Required,
    Optional,
    /// Required or refused depending on other keys; the text says how.
    Depends(&'static str),
    /// Absent means `value`; the reason is shown with the results.
    Default {
        value: &'static str,
        reason: &'static str,
    },
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Key {
    pub path: &'static str,
    pub kind: Kind,
    pub need: Need,
    /// Keys of one table with the same non-empty group exclude each other.
    pub group: &'static str,
    pub doc: &'static str,
    /// What to do about a value outside the range.
    pub hint: &'static str,
}

impl Key {
    const fn new(path: &'static str, kind: Kind, need: Need, doc: &'static str) -> Key {
        Key { path, kind, need, group: "", doc, hint: "" }
    }

    const fn group(mut self, group: &'static str) -> Key {
        self.group = group;
        self
    }

    const fn hint(mut self, hint: &'static str) -> Key {
        self.hint = hint;
        self
    }

    /// Path of the table that holds the key.
    pub fn table(&self) -> &'static str {
        self.path.rsplit_once('.').map_or("", |(table, _)| table)
    }

    /// The key's own name, without its table.
    pub fn name(&self) -> &'static str {
        self.path.rsplit_once('.').map_or(self.path, |(_, name)| name)
    }

    /// The other keys of the same exclusive group.
    pub fn rivals(&'static self) -> impl Iterator<Item = &'static Key> {
        KEYS.iter().filter(|other| {
            !self.group.is_empty()
                && other.group == self.group
                && other.table() == self.table()
                && other.path != self.path
        })
    }

    /// An example of a value, as it is written in TOML.
    pub fn example(&self) -> String {
        match self.kind {
            Kind::Text => "\"...\"".to_string(),
            Kind::Boolean => "true".to_string(),
            Kind::Integer { .. } => "8".to_string(),
            Kind::Choice(choices) => format!("\"{}\"", choices[0]),
            Kind::Choices(choices) => format!("[\"{}\"]", choices[0]),
            Kind::Number(_) => "0.3".to_string(),
            Kind::Quantity(_, range) => format!("\"1.5 {}\"", range.unit),
            Kind::Vector(_, range) => {
                format!("[\"0 {unit}\", \"0 {unit}\", \"1.5 {unit}\"]", unit = range.unit)
            }
        }
    }
}

const fn open(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, high, low_included: false, high_included: false, unit }
}

const fn closed(low: f64, high: f64, unit: &'static str) -> Range {
    Range { low, high, low_included: true, high_included: true, unit }
}

use Dimension::{Acceleration, Angle, Density, Force, Length, Mass, Moment, RotationSpeed, Stress};
use Need::{Default, Depends, Optional, Required};

pub const KINDS: &[&str] = &["deep-groove", "angular-contact"];
pub const HERTZ_MODELS: &[&str] = &["hamrock-brewe", "exact"];
pub const THROUGH: &[&str] = &["ball", "inner-race", "outer-race"];
pub const GUIDANCE: &[&str] = &["outer-race", "inner-race", "balls"];
pub const PLOTS: &[&str] = &["load-zone", "polar", "moment-tilt"];

const RADIUS: Kind = Kind::Quantity(Length, open(0.0, 10_000.0, "mm"));
const CLEARANCE: Kind = Kind::Quantity(Length, closed(-10_000.0, 10_000.0, "um"));
const CONFORMITY: Kind = Kind::Number(open(0.5, 5.0, ""));
const OSCULATION: Kind = Kind::Number(open(0.1, 1.0, ""));
const MODULUS: Kind = Kind::Quantity(Stress, closed(0.001, 10_000.0, "GPa"));
const POISSON: Kind =
    Kind::Number(Range { low: 0.0, high: 0.5, low_included: true, high_included: false, unit: "" });
const DENSITY: Kind = Kind::Quantity(Density, closed(1.0, 30_000.0, "kg/m^3"));
const FORCE: Kind = Kind::Quantity(Force, closed(-1e9, 1e9, "N"));
const MOMENT: Kind = Kind::Quantity(Moment, closed(-1e9, 1e9, "N m"));
const DISPLACEMENT: Kind = Kind::Quantity(Length, closed(-1e6, 1e6, "um"));
const TILT: Kind = Kind::Quantity(Angle, closed(-5.0, 5.0, "deg"));
const GRAVITY: Kind = Kind::Vector(Acceleration, closed(-1e6, 1e6, "m/s^2"));

const STEEL_MODULUS: Need = Default { value: "210 GPa", reason: "bearing steel" };
const STEEL_POISSON: Need = Default { value: "0.3", reason: "bearing steel" };
const STEEL_DENSITY: Need = Default { value: "7850 kg/m^3", reason: "bearing steel" };
const ZERO_LENGTH: Need =
    Default { value: "0 um", reason: "the outer race is fixed, not displaced" };
const ZERO_TILT: Need = Default { value: "0 deg", reason: "the outer race is fixed, not tilted" };
const ONE_CONFORMITY: Need =
    Depends("exactly one of `groove_radius`, `conformity` and `osculation`");
const CLEARANCE_NEED: Need = Depends(
    "deep-groove: required unless both race radii and the ball are given; angular-contact: default 0",
);
const RACE_RADIUS_NEED: Need = Depends(
    "deep-groove: required unless it follows from the clearance; angular-contact: refused, it follows",
);
const BALL_NEED: Need = Depends(
    "deep-groove: required unless it follows from the clearance; angular-contact: required",
);
const COORDINATE_NEED: Need = Depends("neither key: the coordinate is free and unloaded");

const TILT_HINT: &str = "bearings run at tilts of minutes of arc; check the unit";
const LOAD_HINT: &str = "check the unit";
const RADIUS_HINT: &str = "give a positive radius, measured from the bearing axis";
const POISSON_HINT: &str = "steel has 0.3; 0.5 would be incompressible";
const CONFORMITY_HINT: &str = "conformity is groove radius / ball diameter, usually 0.505 to 0.54";
const OSCULATION_HINT: &str =
    "osculation is ball diameter / (2 groove radius), usually 0.92 to 0.99";
const GROOVE_HINT: &str = "the groove's cross-section radius is slightly more than the ball radius";

const fn quantity(path: &'static str, kind: Kind, need: Need, doc: &'static str) -> Key {
    Key::new(path, kind, need, doc)
}

/// Every key, in the order of the reference.
#[rustfmt::skip]
pub static KEYS: &[Key] = &[
    Key::new("title", Kind::Text, Optional, "Name of the scene, shown in results."),
    Key::new("source", Kind::Text, Optional, "Where the numbers come from: table and section."),

    Key::new("bearing.kind", Kind::Choice(KINDS), Required, "Kind of bearing."),
    Key::new("bearing.balls", Kind::Integer { low: 3, high: 200 }, Required, "Number of balls.")
        .hint("one or two balls cannot hold a race in every radial direction"),
    quantity("bearing.ball_phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
        Default { value: "0 deg", reason: "ball 1 sits on the Y axis" },
        "Azimuth of ball 1, from +Y towards +Z."),
    Key::new("bearing.hertz", Kind::Choice(HERTZ_MODELS),
        Default { value: "hamrock-brewe", reason: "the source's contact model" },
        "Solution of the elliptic contact problem: curve fit, or complete elliptic integrals."),
    quantity("bearing.pitch_radius", RADIUS,
        Depends("angular-contact: required; deep-groove: optional, half way between the races"),
        "Distance of the ball centres from the axis.").hint(RADIUS_HINT),
    quantity("bearing.contact_angle", Kind::Quantity(Angle, open(0.0, 80.0, "deg")),
        Depends("angular-contact: required; deep-groove: refused, the angle emerges"),
        "Angle of the contact line to the radial plane when the parts just touch.")
        .hint("a bearing without contact angle is a deep-groove bearing; one near 90 deg carries no radial load"),
    quantity("bearing.length", RADIUS, Optional, "Axial length of the bearing; information only."),

    quantity("bearing.clearance.radial", CLEARANCE, CLEARANCE_NEED,
        "Radial internal clearance; negative is interference.").group("clearance"),
    quantity("bearing.clearance.diametral", CLEARANCE, CLEARANCE_NEED,
        "Diametral internal clearance, twice the radial one.").group("clearance"),
    Key::new("bearing.clearance.through", Kind::Choice(THROUGH),
        Default { value: "ball", reason: "the source varies the clearance through the ball radius" },
        "Which part's size makes the clearance. Its own given size then is the nominal one."),

    quantity("bearing.inner_race.radius", RADIUS, RACE_RADIUS_NEED,
        "Radius of the groove bottom from the axis.").hint(RADIUS_HINT),
    quantity("bearing.inner_race.groove_radius", RADIUS, ONE_CONFORMITY,
        "Radius of the groove's cross-section.").group("groove").hint(GROOVE_HINT),
    Key::new("bearing.inner_race.conformity", CONFORMITY, ONE_CONFORMITY,
        "Groove radius / ball diameter.").group("groove").hint(CONFORMITY_HINT),
    Key::new("bearing.inner_race.osculation", OSCULATION, ONE_CONFORMITY,
        "Ball diameter / (2 groove radius).").group("groove").hint(OSCULATION_HINT),
    quantity("bearing.inner_race.bore_radius", RADIUS, Optional,
        "Radius of the bore; smaller than the groove bottom.").hint(RADIUS_HINT),
    quantity("bearing.inner_race.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Modulus of elasticity."),
    Key::new("bearing.inner_race.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.inner_race.material.density", DENSITY, STEEL_DENSITY, "Density."),

    quantity("bearing.outer_race.radius", RADIUS, RACE_RADIUS_NEED,
        "Radius of the groove bottom from the axis.").hint(RADIUS_HINT),
    quantity("bearing.outer_race.groove_radius", RADIUS, ONE_CONFORMITY,
        "Radius of the groove's cross-section.").group("groove").hint(GROOVE_HINT),
    Key::new("bearing.outer_race.conformity", CONFORMITY, ONE_CONFORMITY,
        "Groove radius / ball diameter.").group("groove").hint(CONFORMITY_HINT),
    Key::new("bearing.outer_race.osculation", OSCULATION, ONE_CONFORMITY,
        "Ball diameter / (2 groove radius).").group("groove").hint(OSCULATION_HINT),
    quantity("bearing.outer_race.outer_radius", RADIUS, Optional,
        "Outer radius of the race; larger than the groove bottom.").hint(RADIUS_HINT),
    quantity("bearing.outer_race.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Modulus of elasticity."),
    Key::new("bearing.outer_race.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.outer_race.material.density", DENSITY, STEEL_DENSITY, "Density."),

    quantity("bearing.ball.radius", RADIUS, BALL_NEED, "Ball radius.").group("size")
        .hint("give a positive radius"),
    quantity("bearing.ball.diameter", RADIUS, BALL_NEED, "Ball diameter.").group("size")
        .hint("give a positive diameter"),
    quantity("bearing.ball.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Modulus of elasticity."),
    Key::new("bearing.ball.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.ball.material.density", DENSITY, STEEL_DENSITY, "Density."),

    quantity("bearing.cage.pocket_radius", RADIUS, Optional, "Radius of the pockets; at least the ball radius."),
    quantity("bearing.cage.inner_radius", RADIUS, Optional, "Inner radius; smaller than the outer one."),
    quantity("bearing.cage.outer_radius", RADIUS, Optional, "Outer radius."),
    quantity("bearing.cage.race_clearance", Kind::Quantity(Length, closed(0.0, 1000.0, "mm")), Optional,
        "Radial gap to the race that guides the cage."),
    quantity("bearing.cage.mass", Kind::Quantity(Mass, open(0.0, 10_000.0, "kg")), Optional, "Mass of the cage."),
    Key::new("bearing.cage.guidance", Kind::Choice(GUIDANCE), Optional, "What guides the cage."),

    quantity("inner_race.x.load", FORCE, COORDINATE_NEED, "Axial force on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.x.displacement", DISPLACEMENT, COORDINATE_NEED, "Given axial displacement.").group("condition"),
    quantity("inner_race.y.load", FORCE, COORDINATE_NEED, "Lateral force on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.y.displacement", DISPLACEMENT, COORDINATE_NEED, "Given lateral displacement.").group("condition"),
    quantity("inner_race.z.load", FORCE, COORDINATE_NEED, "Vertical force on the inner race, up positive.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.z.displacement", DISPLACEMENT, COORDINATE_NEED, "Given vertical displacement.").group("condition"),
    quantity("inner_race.tilt_y.moment", MOMENT, COORDINATE_NEED, "Moment about Y on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.tilt_y.tilt", TILT, COORDINATE_NEED, "Given tilt about Y.").group("condition").hint(TILT_HINT),
    quantity("inner_race.tilt_z.moment", MOMENT, COORDINATE_NEED, "Moment about Z on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.tilt_z.tilt", TILT, COORDINATE_NEED, "Given tilt about Z.").group("condition").hint(TILT_HINT),
    quantity("inner_race.speed", Kind::Quantity(RotationSpeed, closed(-1e6, 1e6, "rpm")),
        Depends("required with `ball_forces.centrifugal`"),
        "Speed of the inner race about X; for frequencies and centrifugal force."),

    quantity("outer_race.x", DISPLACEMENT, ZERO_LENGTH, "Axial position of the outer race."),
    quantity("outer_race.y", DISPLACEMENT, ZERO_LENGTH, "Lateral position of the outer race."),
    quantity("outer_race.z", DISPLACEMENT, ZERO_LENGTH, "Vertical position of the outer race."),
    quantity("outer_race.tilt_y", TILT, ZERO_TILT, "Tilt of the outer race about Y.").hint(TILT_HINT),
    quantity("outer_race.tilt_z", TILT, ZERO_TILT, "Tilt of the outer race about Z.").hint(TILT_HINT),

    Key::new("ball_forces.gravity", GRAVITY,
        Default { value: "none", reason: "the weight of the balls is left out" },
        "Acceleration of gravity on the balls, along X, Y and Z."),
    Key::new("ball_forces.centrifugal", Kind::Boolean,
        Default { value: "false", reason: "the centrifugal force of the balls is left out" },
        "Whether the balls' centrifugal force counts; needs `inner_race.speed`."),

    Key::new("output.plots", Kind::Choices(PLOTS),
        Default { value: "load-zone, polar", reason: "usual plots" },
        "Plots to draw; `[]` for none."),
];

/// A table that holds keys, with what to write in it.
pub struct Table {
    pub path: &'static str,
    pub doc: &'static str,
    pub example: &'static str,
}

const fn table(path: &'static str, doc: &'static str, example: &'static str) -> Table {
    Table { path, doc, example }
}

const MATERIAL_EXAMPLE: &str =
    "material = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850 kg/m^3\" }";

/// Every table, in the order of the reference. `assumptions` and `sweep` have keys of the user's.
#[rustfmt::skip]
pub static TABLES: &[Table] = &[
    table("assumptions", "Holes in the source that this scene fills: any name = \"what was assumed\". Repeated in the results.",
        "[assumptions]\nmaterial = \"steel, E 210 GPa\""),
    table("bearing", "The bearing.", "[bearing]\nkind = \"deep-groove\""),
    table("bearing.clearance", "Internal clearance. It must say what it is: `radial` or `diametral`.",
        "clearance = { radial = \"-5 um\" } or { diametral = \"-10 um\" }"),
    table("bearing.inner_race", "Inner race.", "[bearing.inner_race]\ngroove_radius = \"6.013 mm\""),
    table("bearing.inner_race.material", "Material of the inner race; every entry may be left out.", MATERIAL_EXAMPLE),
    table("bearing.outer_race", "Outer race.", "[bearing.outer_race]\ngroove_radius = \"6.31 mm\""),
    table("bearing.outer_race.material", "Material of the outer race; every entry may be left out.", MATERIAL_EXAMPLE),
    table("bearing.ball", "Balls.", "ball = { radius = \"5.953 mm\" }"),
    table("bearing.ball.material", "Material of the balls; every entry may be left out.", MATERIAL_EXAMPLE),
    table("bearing.cage", "Cage; may be left out, and every entry of it.", "[bearing.cage]\npocket_radius = \"6.2 mm\""),
    table("inner_race", "What acts on the inner race, or where it is held. Each coordinate is free and unloaded unless given.",
        "[inner_race]\nx = { load = \"250 N\" }"),
    table("inner_race.x", "Axial coordinate: a load, or a displacement.", "x = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.y", "Lateral coordinate.", "y = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.z", "Vertical coordinate.", "z = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.tilt_y", "Tilt about Y: a moment, or a tilt.", "tilt_y = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }"),
    table("inner_race.tilt_z", "Tilt about Z.", "tilt_z = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }"),
    table("outer_race", "Given position of the outer race; fixed and centred unless given.", "[outer_race]\nx = \"0 um\""),
    table("ball_forces", "What acts on the balls besides their contacts.", "[ball_forces]\ncentrifugal = true"),
    table("output", "What to write besides the numbers.", "[output]\nplots = [\"polar\"]"),
    table("sweep", "What `bearing sweep` varies when the command line names nothing: dotted key = list or range.",
        "[sweep]\n\"bearing.ball_phase\" = \"0 deg .. 45 deg / 91\""),
];

static INDEX: LazyLock<HashMap<&'static str, usize>> =
    LazyLock::new(|| KEYS.iter().enumerate().map(|(i, key)| (key.path, i)).collect());

/// Row of the key with this dotted path.
pub fn find(path: &str) -> Option<(usize, &'static Key)> {
    INDEX.get(path).map(|&i| (i, &KEYS[i]))
}

pub fn find_table(path: &str) -> Option<&'static Table> {
    TABLES.iter().find(|table| table.path == path)
}

/// Names of the keys and tables directly inside the table `path` (empty for the top).
pub fn children(path: &str) -> Vec<&'static str> {
    let mut names = Vec::new();
    let paths = KEYS.iter().map(|key| key.path).chain(TABLES.iter().map(|table| table.path));
    for known in paths {
        let inside = match path {
            "" => Some(known),
            _ => known.strip_prefix(path).and_then(|rest| rest.strip_prefix('.')),
        };
        let name = inside.and_then(|rest| rest.split('.').next());
        if let Some(name) = name.filter(|name| !names.contains(name)) {
            names.push(name);
        }
    }
    names
}

/// The key or table an unknown key of the table `path` was probably meant to be: a similar one
/// beside it, else one of the same or nearly the same name in another table.
pub fn nearest_key(path: &str, name: &str) -> Option<String> {
    let dotted = |name: &str| match path {
        "" => name.to_string(),
        _ => format!("{path}.{name}"),
    };
    if let Some(sibling) = nearest(name, children(path).into_iter(), 0.6) {
        return Some(dotted(sibling));
    }
    let last = name.rsplit('.').next().unwrap_or(name);
    let elsewhere = nearest(last, KEYS.iter().map(Key::name), 0.8);
    let found = elsewhere.and_then(|name| KEYS.iter().find(|key| key.name() == name));
    let whole = || nearest(&dotted(name), KEYS.iter().map(|key| key.path), 0.6).map(str::to_string);
    found.map(|key| key.path.to_string()).or_else(whole)
}

/// The candidate most like `word` (ignoring case), if at least `similarity` (0 to 1) alike.
pub fn nearest<'c>(
    word: &str,
    candidates: impl Iterator<Item = &'c str>,
    similarity: f64,
) -> Option<&'c str> {
    // Comparing takes time proportional to the length; nobody mistypes a key into 60 letters.
    if word.len() > 60 {
        return None;
    }
    let word = word.to_lowercase();
    let mut best: Option<(&str, f64)> = None;
    for candidate in candidates {
        let alike = strsim::normalized_damerau_levenshtein(&word, &candidate.to_lowercase());
        if alike >= similarity && best.is_none_or(|(_, most)| alike > most) {
            best = Some((candidate, alike));
        }
    }
    best.map(|(candidate, _)| candidate)
}
