//! Rows of the key table: geometry and materials, conditions on the races, outputs.

use crate::scene::tables::keys::{Key, Kind, Need, Range, Table, closed, list_table, open, table};
use crate::scene::text::units::Dimension::{
    Acceleration, Angle, Density, Force, Length, Mass, Moment, RotationSpeed, Stress,
};
use Need::{Default, Depends, Optional, Required};

pub const KINDS: &[&str] = &["deep-groove", "angular-contact"];
pub const HERTZ_MODELS: &[&str] = &["hamrock-brewe", "exact"];
pub const THROUGH: &[&str] = &["ball", "inner-race", "outer-race"];
pub const DENTED: &[&str] = &["outer", "inner"];
pub const GUIDANCE: &[&str] = &["outer-race", "inner-race", "balls"];
/// The first three are drawn by statics, the others by a run.
pub const PLOTS: &[&str] =
    &["load-zone", "polar", "moment-tilt", "orbit", "spectrum", "series", "slip-spin", "run-up"];

pub(crate) const RADIUS: Kind = Kind::Quantity(Length, open(0.0, 10_000.0, "mm"));
const CLEARANCE: Kind = Kind::Quantity(Length, closed(-10_000.0, 10_000.0, "um"));
const CONFORMITY: Kind = Kind::Number(open(0.5, 0.6, ""));
const OSCULATION: Kind = Kind::Number(open(0.83, 1.0, ""));
pub(crate) const MODULUS: Kind = Kind::Quantity(Stress, closed(0.5, 1000.0, "GPa"));
const POISSON: Kind =
    Kind::Number(Range { low: 0.0, high: 0.5, low_included: true, high_included: false, unit: "" });
pub(crate) const DENSITY: Kind = Kind::Quantity(Density, closed(500.0, 25_000.0, "kg/m^3"));
pub(crate) const FORCE: Kind = Kind::Profile(Force, closed(-1e9, 1e9, "N"));
pub(crate) const MOMENT: Kind = Kind::Profile(Moment, closed(-1e9, 1e9, "N m"));
pub(crate) const SPIN: Kind = Kind::Profile(RotationSpeed, closed(-1e6, 1e6, "rpm"));
pub(crate) const DISPLACEMENT: Kind = Kind::Profile(Length, closed(-1e6, 1e6, "um"));
pub(crate) const TILT: Kind = Kind::Profile(Angle, closed(-5.0, 5.0, "deg"));
const POSITION: Kind = Kind::Quantity(Length, closed(-1e6, 1e6, "um"));
const TILT_POSITION: Kind = Kind::Quantity(Angle, closed(-5.0, 5.0, "deg"));
pub(crate) const GRAVITY: Kind = Kind::Vector(Acceleration, closed(-2000.0, 2000.0, "m/s^2"));

const STEEL_MODULUS: Need = Default { value: "210 GPa", reason: "bearing steel" };
const STEEL_POISSON: Need = Default { value: "0.3", reason: "bearing steel" };
pub(crate) const STEEL_DENSITY: Need = Default { value: "7850 kg/m^3", reason: "bearing steel" };
const ZERO_LENGTH: Need = Default { value: "0 um", reason: "its nominal place" };
const ZERO_TILT: Need = Default { value: "0 deg", reason: "its nominal place" };
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

pub(crate) const TILT_HINT: &str = "bearings run at tilts of minutes of arc; check the unit";
pub(crate) const LOAD_HINT: &str = "check the unit";
pub(crate) const RADIUS_HINT: &str =
    "a positive radius, measured from the bearing axis; check the unit";
const MODULUS_HINT: &str = "steel has 210 GPa; check the unit";
pub(crate) const DENSITY_HINT: &str = "steel has 7850 kg/m^3; check the unit";
const POISSON_HINT: &str = "steel has 0.3; 0.5 would be incompressible";
const CONFORMITY_HINT: &str = "conformity is groove radius / ball diameter, usually 0.505 to 0.54";
const OSCULATION_HINT: &str =
    "osculation is ball diameter / (2 groove radius), usually 0.92 to 0.99";
const DENT_HINT: &str =
    "dents are micrometres deep and some tenths of a millimetre wide; check the unit";
const GROOVE_HINT: &str = "the groove's cross-section radius is slightly more than the ball radius";

pub(crate) const fn quantity(path: &'static str, kind: Kind, need: Need, doc: &'static str) -> Key {
    Key::new(path, kind, need, doc)
}

/// Geometry, conditions and outputs, in the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("title", Kind::Text, Optional, "Name of the scene, shown in results."),
    Key::new("source", Kind::Text, Optional, "Where the numbers come from: table and section."),
    Key::new("base", Kind::Text, Optional, "Another scene that this one is on, a file relative to this one: all that the base says holds, but for what is said here."),
    Key::new("without", Kind::Text, Optional, "Of a scene with a base: keys, tables (`solid.mesh`) and names (`sensor.top`) of the base that are left out, with commas between."),

    Key::new("bearing.kind", Kind::Choice(KINDS), Required, "Kind of bearing."),
    Key::new("bearing.balls", Kind::Integer { low: 3, high: 200 }, Required, "Number of balls.")
        .hint("one or two balls cannot hold a race in every radial direction"),
    quantity("bearing.ball_phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
        Default { value: "0 deg", reason: "ball 1 sits on the Y axis" },
        "Azimuth of ball 1, from +Y towards +Z. Of a `reversed` bearing in its own axes: its ball 1 stands at 180 deg less this in the scene, and its balls are counted the other way round."),
    Key::new("bearing.hertz", Kind::Choice(HERTZ_MODELS),
        Default { value: "hamrock-brewe", reason: "the source's contact model" },
        "Solution of the elliptic contact problem: curve fit, or complete elliptic integrals."),
    quantity("bearing.pitch_radius", RADIUS,
        Depends("angular-contact: required; deep-groove: optional, half way between the races"),
        "Distance of the ball centres from the axis.").hint(RADIUS_HINT).example_of("26 mm"),
    quantity("bearing.contact_angle", Kind::Quantity(Angle, open(0.0, 80.0, "deg")),
        Depends("angular-contact: required; deep-groove: refused, the angle emerges"),
        "Angle of the contact line to the radial plane when the parts just touch.")
        .hint("a bearing without contact angle is a deep-groove bearing; one near 90 deg carries no radial load").example_of("35 deg"),
    quantity("bearing.length", RADIUS, Optional, "Axial length of the bearing; information only."),

    quantity("bearing.clearance.radial", CLEARANCE, CLEARANCE_NEED,
        "Radial internal clearance; negative is interference.").group("clearance"),
    quantity("bearing.clearance.diametral", CLEARANCE, CLEARANCE_NEED,
        "Diametral internal clearance, twice the radial one.").group("clearance"),
    Key::new("bearing.clearance.through", Kind::Choice(THROUGH),
        Default { value: "ball", reason: "the source varies the clearance through the ball radius" },
        "Which part's size makes the clearance. Its own given size then is the nominal one."),

    quantity("bearing.inner_race.radius", RADIUS, RACE_RADIUS_NEED,
        "Radius of the groove bottom from the axis.").hint(RADIUS_HINT).example_of("20.047 mm"),
    quantity("bearing.inner_race.groove_radius", RADIUS, ONE_CONFORMITY,
        "Radius of the groove's cross-section.").group("groove").hint(GROOVE_HINT).example_of("6.2 mm"),
    Key::new("bearing.inner_race.conformity", CONFORMITY, ONE_CONFORMITY,
        "Groove radius / ball diameter.").group("groove").hint(CONFORMITY_HINT).example_of("0.515"),
    Key::new("bearing.inner_race.osculation", OSCULATION, ONE_CONFORMITY,
        "Ball diameter / (2 groove radius).").group("groove").hint(OSCULATION_HINT).example_of("0.97"),
    quantity("bearing.inner_race.bore_radius", RADIUS, Optional,
        "Radius of the bore; smaller than the groove bottom.").hint(RADIUS_HINT),
    quantity("bearing.inner_race.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Modulus of elasticity.").hint(MODULUS_HINT),
    Key::new("bearing.inner_race.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.inner_race.material.density", DENSITY, STEEL_DENSITY, "Density.").hint(DENSITY_HINT),

    quantity("bearing.outer_race.radius", RADIUS, RACE_RADIUS_NEED,
        "Radius of the groove bottom from the axis.").hint(RADIUS_HINT).example_of("31.953 mm"),
    quantity("bearing.outer_race.groove_radius", RADIUS, ONE_CONFORMITY,
        "Radius of the groove's cross-section.").group("groove").hint(GROOVE_HINT).example_of("6.2 mm"),
    Key::new("bearing.outer_race.conformity", CONFORMITY, ONE_CONFORMITY,
        "Groove radius / ball diameter.").group("groove").hint(CONFORMITY_HINT).example_of("0.515"),
    Key::new("bearing.outer_race.osculation", OSCULATION, ONE_CONFORMITY,
        "Ball diameter / (2 groove radius).").group("groove").hint(OSCULATION_HINT).example_of("0.97"),
    quantity("bearing.outer_race.outer_radius", RADIUS, Optional,
        "Outer radius of the race; larger than the groove bottom.").hint(RADIUS_HINT),
    quantity("bearing.outer_race.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Modulus of elasticity.").hint(MODULUS_HINT),
    Key::new("bearing.outer_race.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.outer_race.material.density", DENSITY, STEEL_DENSITY, "Density.").hint(DENSITY_HINT),

    quantity("bearing.ball.radius", RADIUS, BALL_NEED, "Ball radius.").group("size")
        .hint("was a diameter given, or a wrong unit?"),
    quantity("bearing.ball.diameter", RADIUS, BALL_NEED, "Ball diameter.").group("size")
        .hint("is its unit right?"),
    quantity("bearing.ball.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Modulus of elasticity.").hint(MODULUS_HINT),
    Key::new("bearing.ball.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.ball.material.density", DENSITY, STEEL_DENSITY, "Density.").hint(DENSITY_HINT),

    quantity("bearing.cage.pocket_radius", RADIUS, Optional, "Radius of the pockets; at least the ball radius."),
    quantity("bearing.cage.inner_radius", RADIUS, Optional, "Inner radius; smaller than the outer one."),
    quantity("bearing.cage.outer_radius", RADIUS, Optional, "Outer radius."),
    quantity("bearing.cage.race_clearance", Kind::Quantity(Length, closed(0.0, 1000.0, "mm")), Optional,
        "Radial gap to the race that guides the cage."),
    Key::new("bearing.dent.race", Kind::Choice(DENTED), Required, "The race that has it."),
    quantity("bearing.dent.angle", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Required,
        "Where it is around the race, from the race's own Y towards its Z; it turns with the race. Of a `reversed` bearing in its own axes: it stands at 180 deg less this in the scene.").example_of("270 deg"),
    quantity("bearing.dent.groove_angle", Kind::Quantity(Angle, closed(-80.0, 80.0, "deg")),
        Default { value: "0 deg", reason: "at the bottom of the groove" },
        "Where it is around the groove, from its bottom towards the race's X; of a `reversed` bearing towards its own X."),
    quantity("bearing.dent.diameter", Kind::Quantity(Length, open(0.0, 100.0, "mm")), Required,
        "Diameter of the pit, at most half the ball's radius.").hint(DENT_HINT).example_of("500 um"),
    quantity("bearing.dent.depth", Kind::Quantity(Length, closed(0.0, 10.0, "mm")),
        Depends("a twentieth of the diameter"),
        "Depth of the pit below the surface, half a wave of a cosine; 0 leaves none.").hint(DENT_HINT).example_of("25 um"),
    quantity("bearing.dent.shoulder_height", Kind::Quantity(Length, closed(0.0, 1.0, "mm")),
        Default { value: "0 um", reason: "the source's dent has no shoulder" },
        "Height of the shoulder around the pit, a wave of a cosine. Under light load the contact beside the middle of a dent with a wide shoulder is good to a third of its load only.").hint(DENT_HINT).example_of("1 um"),
    quantity("bearing.dent.shoulder_width", Kind::Quantity(Length, open(0.0, 100.0, "mm")),
        Depends("a quarter of the diameter"),
        "Width of the shoulder beyond the pit.").hint(DENT_HINT).example_of("125 um"),
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
    quantity("inner_race.speed", SPIN, Depends("required with `ball_forces.centrifugal`; a run without speed and torque: 0"),
        "Speed of the inner race about X. Statics uses it for frequencies and centrifugal force, a run imposes it.").group("rotation"),

    quantity("outer_race.x", POSITION, ZERO_LENGTH, "Axial position of the outer race; where it starts if it moves.").group("x"),
    quantity("outer_race.y", POSITION, ZERO_LENGTH, "Lateral position of the outer race; where it starts if it moves.").group("y"),
    quantity("outer_race.z", POSITION, ZERO_LENGTH, "Vertical position of the outer race; where it starts if it moves.").group("z"),
    quantity("outer_race.tilt_y", TILT_POSITION, ZERO_TILT, "Tilt of the outer race about Y; where it starts if it moves.").group("tilt_y").hint(TILT_HINT),
    quantity("outer_race.tilt_z", TILT_POSITION, ZERO_TILT, "Tilt of the outer race about Z; where it starts if it moves.").group("tilt_z").hint(TILT_HINT),

    Key::new("ball_forces.gravity", GRAVITY,
        Default { value: "none", reason: "the weight of the balls is left out" },
        "Acceleration of gravity along X, Y and Z: on the balls in statics, on every moving part in a run."),
    Key::new("ball_forces.centrifugal", Kind::Boolean,
        Default { value: "false", reason: "the centrifugal force of the balls is left out" },
        "Whether the balls' centrifugal force counts in statics; needs `inner_race.speed`. A run has it by itself."),

    Key::new("output.plots", Kind::Choices(PLOTS),
        Depends("`load-zone`, `polar`; of a run `orbit`, `series`, `polar`; of a solid `series`, `spectrum`"),
        "Plots to draw; `[]` for none. Statics draws `load-zone`, `polar` and `moment-tilt` (in a housing `load-zone` only; equilibria over time have no `polar`, `slip-spin` and `run-up`), a run `polar` and the others; `run-up` is how far what changes its speed is off its axis, over that speed (a note says so where nothing does)."),
];

const MATERIAL_EXAMPLE: &str =
    "material = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850 kg/m^3\" }";

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
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
    list_table("bearing.dent", "A dent in a race (3.20), in a run. As many as wanted; equilibria know of none.",
        "[[bearing.dent]]\nrace = \"outer\"\nangle = \"270 deg\"\ndiameter = \"500 um\""),
    table("bearing.cage", "Cage; may be left out, and every entry of it.", "[bearing.cage]\npocket_radius = \"6.2 mm\""),
    table("inner_race", "What acts on the inner race, or where it is held. Each coordinate is free and unloaded unless given.",
        "[inner_race]\nx = { load = \"250 N\" }"),
    table("inner_race.x", "Axial coordinate: a load, or a displacement.", "x = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.y", "Lateral coordinate.", "y = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.z", "Vertical coordinate.", "z = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.tilt_y", "Tilt about Y: a moment, or a tilt.", "tilt_y = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }"),
    table("inner_race.tilt_z", "Tilt about Z.", "tilt_z = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }"),
    table("outer_race", "Position of the outer race, fixed and centred unless given, or what acts on it where it moves.", "[outer_race]\nx = \"0 um\""),
    table("ball_forces", "What acts on the balls besides their contacts.", "[ball_forces]\ncentrifugal = true"),
    table("output", "What to write besides the numbers.", "[output]\nplots = [\"polar\"]"),
    table("sweep", "What `bearing sweep` varies when the command line names nothing: dotted key = list or range.",
        "[sweep]\n\"bearing.ball_phase\" = \"0 deg .. 45 deg / 91\""),
];
