//! Rows of the key table: geometry and materials, conditions on the races, outputs.

use crate::scene::tables::keys::{
    DEFAULT_SETS, DEFAULTS, Key, Kind, Need, Range, SI, Table, UNITS, above, closed, list_table,
    open, table,
};
use crate::scene::text::units::Dimension::{
    Acceleration, Angle, Density, Force, Length, Mass, Moment, RotationSpeed, Stress,
};
use Need::{BySet, Default, Depends, Optional, Required};

pub const KINDS: &[&str] = &["deep-groove", "angular-contact"];
pub const HERTZ_MODELS: &[&str] = &["hamrock-brewe", "exact"];
pub const THROUGH: &[&str] = &["ball", "inner-race", "outer-race", "races"];
pub const DENTED: &[&str] = &["outer", "inner"];
/// Parts with a spall or waves.
pub const PROFILED: &[&str] = &["outer", "inner", "ball"];
pub const GUIDANCE: &[&str] = &["outer-race", "inner-race", "balls"];
/// Plots: the first three of statics, the others of a run.
pub const PLOTS: &[&str] =
    &["load-zone", "polar", "moment-tilt", "orbit", "spectrum", "series", "slip-spin", "run-up"];

pub(crate) const RADIUS: Kind = Kind::Quantity(Length, open(0.0, 10_000.0, "mm"));
const CLEARANCE: Kind = Kind::Quantity(Length, closed(-10_000.0, 10_000.0, "um"));
const CONFORMITY: Kind = Kind::Number(open(0.5, 0.6, ""));
const OSCULATION: Kind = Kind::Number(open(0.83, 1.0, ""));
pub(crate) const MODULUS: Kind = Kind::Quantity(Stress, closed(0.5, 1000.0, "GPa"));
pub(crate) const POISSON: Kind =
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
const ZERO_LENGTH: Need = Default { value: "0 um", reason: "nominal position" };
const ZERO_TILT: Need = Default { value: "0 deg", reason: "nominal position" };
const ONE_CONFORMITY: Need =
    Depends("exactly one of `groove_radius`, `conformity` and `osculation` is required");
const CLEARANCE_NEED: Need = Depends(
    "deep-groove: required unless both race radii and the ball are given; angular-contact: 0",
);
const RACE_RADIUS_NEED: Need = Depends(
    "deep-groove: required unless it follows from the clearance; angular-contact: not allowed, it follows from the other sizes",
);
const BALL_NEED: Need = Depends(
    "deep-groove: required unless it follows from the clearance; angular-contact: required",
);
const COORDINATE_NEED: Need = Depends("neither key: the coordinate is free and unloaded");

pub(crate) const TILT_HINT: &str = "bearings tilt by minutes of arc; check the unit";
pub(crate) const LOAD_HINT: &str = "check the unit";
pub(crate) const RADIUS_HINT: &str =
    "a positive radius, measured from the bearing axis; check the unit";
pub(crate) const MODULUS_HINT: &str = "steel has 210 GPa; check the unit";
pub(crate) const DENSITY_HINT: &str = "steel has 7850 kg/m^3; check the unit";
pub(crate) const POISSON_HINT: &str = "steel has 0.3; 0.5 would be incompressible";
const CONFORMITY_HINT: &str = "conformity is groove radius / ball diameter, usually 0.505 to 0.54";
const OSCULATION_HINT: &str =
    "osculation is ball diameter / (2 groove radius), usually 0.92 to 0.99";
const DENT_HINT: &str =
    "dents are micrometres deep and some tenths of a millimetre wide; check the unit";
const SPALL_HINT: &str =
    "spalls are millimetres long and some tenths of a millimetre deep; check the unit";
const WAVE_HINT: &str = "waves of ground raceways are parts of a micrometre high; check the unit";
const SIZE_HINT: &str = "balls of one grade differ by less than a micrometre; check the unit";
const PROFILED_NEED: Need = Depends("required on a race; not allowed on a ball");
const PROFILED_BALL_NEED: Need = Depends("required on a ball; not allowed on a race");
const GROOVE_HINT: &str = "the groove's cross-section radius is slightly more than the ball radius";

pub(crate) const fn quantity(path: &'static str, kind: Kind, need: Need, doc: &'static str) -> Key {
    Key::new(path, kind, need, doc)
}

/// Geometry, conditions and outputs, in the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("title", Kind::Text, Optional, "Name of the scene, shown in results."),
    Key::new("source", Kind::Text, Optional, "Where the numbers come from: table and section."),
    Key::new("base", Kind::Text, Optional, "Scene file that this scene inherits, relative to this file. Keys given here override those of the base."),
    Key::new("without", Kind::Text, Optional, "Keys, tables (`solid.mesh`) and named tables (`sensor.top`) of the base that are not inherited, separated by commas."),

    Key::new(UNITS, Kind::Choice(&[SI]), Optional, "With `SI`, quantities are numbers in SI units (m, kg, s, N, rad, Pa), as in `resolved.json`. A quantity may still be a text with its unit."),

    Key::new(DEFAULTS, Kind::Choice(DEFAULT_SETS), Default { value: "engineering", reason: "friction and clearance as in real bearings" },
        "Set of defaults of `bearing.hertz`, `bearing.clearance.through`, `traction.points_across` and `traction.differential_sliding`: those of real bearings, or those of the dissertation."),

    Key::new("bearing.kind", Kind::Choice(KINDS), Required, "Kind of bearing."),
    Key::new("bearing.balls", Kind::Integer { low: 3, high: 200 }, Required, "Number of balls.")
        .hint("one or two balls cannot support a race in every radial direction"),
    quantity("bearing.ball_phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
        Default { value: "0 deg", reason: "ball 1 is on the Y axis" },
        "Azimuth of ball 1, from +Y towards +Z. A `reversed` bearing measures it in its own axes: in the scene ball 1 is at 180 deg minus this angle, and the balls are numbered in the opposite sense."),
    Key::new("bearing.hertz", Kind::Choice(HERTZ_MODELS),
        BySet { dissertation: ("hamrock-brewe", "its contact model"), engineering: ("exact", "no error of a fit") },
        "Solution of the elliptic Hertz contact: curve fit, or complete elliptic integrals."),
    quantity("bearing.pitch_radius", RADIUS,
        Depends("angular-contact: required; deep-groove: half way between the races"),
        "Distance of the ball centres from the axis.").hint(RADIUS_HINT).example_of("26 mm"),
    quantity("bearing.contact_angle", Kind::Quantity(Angle, open(0.0, 80.0, "deg")),
        Depends("angular-contact: required; deep-groove: not allowed, the angle follows from loads"),
        "Nominal contact angle: angle of the contact line to the radial plane when the parts just touch.")
        .hint("a bearing without contact angle is a deep-groove bearing; one near 90 deg carries no radial load").example_of("35 deg").only("bearing.kind", &["angular-contact"]),
    quantity("bearing.length", RADIUS, Optional, "Axial length of the bearing; default of `housing.width`, otherwise for information only."),

    quantity("bearing.clearance.radial", CLEARANCE, CLEARANCE_NEED,
        "Radial internal clearance; negative is interference.").group("clearance"),
    quantity("bearing.clearance.diametral", CLEARANCE, CLEARANCE_NEED,
        "Diametral internal clearance, twice the radial one.").group("clearance"),
    Key::new("bearing.clearance.through", Kind::Choice(THROUGH),
        BySet { dissertation: ("ball", "it varies the clearance through the ball radius"), engineering: ("races", "balls are made to size, races to clearance") },
        "Part whose size is adjusted to give the clearance. Its given size is then the nominal size; `races`: half through each race."),

    quantity("bearing.inner_race.radius", RADIUS, RACE_RADIUS_NEED,
        "Radius of the groove bottom, measured from the axis.").hint(RADIUS_HINT).example_of("20.047 mm").only("bearing.kind", &["deep-groove"]),
    quantity("bearing.inner_race.groove_radius", RADIUS, ONE_CONFORMITY,
        "Radius of the groove's cross-section.").group("groove").hint(GROOVE_HINT).example_of("6.2 mm"),
    Key::new("bearing.inner_race.conformity", CONFORMITY, ONE_CONFORMITY,
        "Groove radius / ball diameter.").group("groove").hint(CONFORMITY_HINT).example_of("0.515"),
    Key::new("bearing.inner_race.osculation", OSCULATION, ONE_CONFORMITY,
        "Ball diameter / (2 groove radius).").group("groove").hint(OSCULATION_HINT).example_of("0.97"),
    quantity("bearing.inner_race.bore_radius", RADIUS, Optional,
        "Radius of the bore; smaller than the groove bottom.").hint(RADIUS_HINT),
    quantity("bearing.inner_race.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Young's modulus.").hint(MODULUS_HINT),
    Key::new("bearing.inner_race.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.inner_race.material.density", DENSITY, STEEL_DENSITY, "Density.").hint(DENSITY_HINT),

    quantity("bearing.outer_race.radius", RADIUS, RACE_RADIUS_NEED,
        "Radius of the groove bottom, measured from the axis.").hint(RADIUS_HINT).example_of("31.953 mm").only("bearing.kind", &["deep-groove"]),
    quantity("bearing.outer_race.groove_radius", RADIUS, ONE_CONFORMITY,
        "Radius of the groove's cross-section.").group("groove").hint(GROOVE_HINT).example_of("6.2 mm"),
    Key::new("bearing.outer_race.conformity", CONFORMITY, ONE_CONFORMITY,
        "Groove radius / ball diameter.").group("groove").hint(CONFORMITY_HINT).example_of("0.515"),
    Key::new("bearing.outer_race.osculation", OSCULATION, ONE_CONFORMITY,
        "Ball diameter / (2 groove radius).").group("groove").hint(OSCULATION_HINT).example_of("0.97"),
    quantity("bearing.outer_race.outer_radius", RADIUS, Optional,
        "Outer radius of the race; larger than the groove bottom.").hint(RADIUS_HINT),
    quantity("bearing.outer_race.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Young's modulus.").hint(MODULUS_HINT),
    Key::new("bearing.outer_race.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.outer_race.material.density", DENSITY, STEEL_DENSITY, "Density.").hint(DENSITY_HINT),

    quantity("bearing.ball.radius", RADIUS, BALL_NEED, "Ball radius.").group("size")
        .hint("was a diameter given, or a wrong unit?"),
    quantity("bearing.ball.diameter", RADIUS, BALL_NEED, "Ball diameter.").group("size")
        .hint("is its unit right?"),
    Key::new("bearing.ball.deviations", Kind::QuantityList(Length, closed(-0.1, 0.1, "mm")), Optional,
        "Excess of each ball's radius over the common one, ball 1 first; positive for a larger ball. Runs only. It changes the overlap with both races; mass, pockets and contacts between balls stay nominal.").group("deviations").hint(SIZE_HINT).example_of("0.2 um"),
    quantity("bearing.ball.scatter", Kind::Quantity(Length, closed(0.0, 0.1, "mm")), Optional,
        "Standard deviation of normally distributed deviations of the balls' radii. `check` prints them.").group("deviations").hint(SIZE_HINT).example_of("0.1 um"),
    Key::new("bearing.ball.seed", Kind::Integer { low: 0, high: 1_000_000_000 },
        Depends("1 with `scatter`, otherwise not allowed"),
        "Seed of the random deviations of `scatter`; another number gives other deviations.").example_of("2"),
    quantity("bearing.ball.material.youngs_modulus", MODULUS, STEEL_MODULUS, "Young's modulus.").hint(MODULUS_HINT),
    Key::new("bearing.ball.material.poisson_ratio", POISSON, STEEL_POISSON, "Poisson's ratio.").hint(POISSON_HINT),
    quantity("bearing.ball.material.density", DENSITY, STEEL_DENSITY, "Density.").hint(DENSITY_HINT),

    quantity("bearing.cage.pocket_radius", RADIUS, Optional, "Pocket radius; at least the ball radius."),
    quantity("bearing.cage.inner_radius", RADIUS, Optional, "Inner radius; smaller than the outer one."),
    quantity("bearing.cage.outer_radius", RADIUS, Optional, "Outer radius."),
    quantity("bearing.cage.race_clearance", Kind::Quantity(Length, closed(0.0, 1000.0, "mm")), Optional,
        "Radial clearance to the race that guides the cage."),
    quantity("bearing.rating.dynamic", Kind::Quantity(Force, above(0.0, 1e9, "N")),
        Depends("ISO 281, from the geometry"),
        "Basic dynamic load rating C. `statics` computes the rating life of ISO/TS 16281 from it and the ball loads. Contact angles up to 45 deg only.")
        .hint("catalogues give C in kN; check the unit").example_of("23.4 kN"),
    Key::new("bearing.dent.race", Kind::Choice(DENTED), Required, "Race with the dent."),
    quantity("bearing.dent.angle", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Required,
        "Azimuth of the dent on the race, from the race's own Y towards its Z; the dent rotates with the race. A `reversed` bearing measures it in its own axes: in the scene it is at 180 deg minus this angle.").example_of("270 deg"),
    quantity("bearing.dent.groove_angle", Kind::Quantity(Angle, closed(-80.0, 80.0, "deg")),
        Default { value: "0 deg", reason: "at the bottom of the groove" },
        "Angle of the dent in the groove's cross-section, from the bottom towards the bearing's own +X."),
    quantity("bearing.dent.diameter", Kind::Quantity(Length, open(0.0, 100.0, "mm")), Required,
        "Diameter of the pit; at most half the ball radius.").hint(DENT_HINT).example_of("500 um"),
    quantity("bearing.dent.depth", Kind::Quantity(Length, closed(0.0, 10.0, "mm")),
        Depends("1/20 of the diameter"),
        "Depth h of the pit, whose profile is h (1 + cos(2 pi r/diameter))/2; 0 for no pit.").hint(DENT_HINT).example_of("25 um"),
    quantity("bearing.dent.shoulder_height", Kind::Quantity(Length, closed(0.0, 1.0, "mm")),
        Default { value: "0 um", reason: "the source's dent has no shoulder" },
        "Height of the shoulder around the pit, whose profile is a cosine wave. With a wide shoulder and a light load, contact loads away from the dent's middle have errors up to a third.").hint(DENT_HINT).example_of("1 um"),
    quantity("bearing.dent.shoulder_width", Kind::Quantity(Length, open(0.0, 100.0, "mm")),
        Depends("1/4 of the diameter"),
        "Width of the shoulder outside the pit.").hint(DENT_HINT).example_of("125 um"),
    Key::new("bearing.spall.on", Kind::Choice(PROFILED), Required, "Part with the spall: a race, or a ball."),
    Key::new("bearing.spall.ball", Kind::Integer { low: 1, high: 200 }, PROFILED_BALL_NEED, "Number of the ball.").only("bearing.spall.on", &["ball"]),
    quantity("bearing.spall.angle", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Required,
        "Azimuth of the spall on the race, from the race's own Y towards its Z; the spall rotates with the race. On a ball: azimuth about the ball's X, from its Y towards its Z; at the start the ball's axes are those of the scene.").example_of("270 deg"),
    quantity("bearing.spall.groove_angle", Kind::Quantity(Angle, closed(-90.0, 90.0, "deg")),
        Depends("in the nominal track: the nominal contact angle on the outer race, minus that angle on the inner race"),
        "Angle of the spall in the groove's cross-section, from the bottom towards the bearing's own +X. On a ball: angle from the direction of `angle` towards the ball's +X; the default is the place that meets the outer race if `angle` is the ball's azimuth and the bearing is not `reversed`.").example_of("0 deg"),
    quantity("bearing.spall.length", Kind::Quantity(Length, closed(0.0, 100.0, "mm")), Required,
        "Length in the rolling direction between the beginnings of the rounded edges, at most the ball radius; diameter on a ball. 0 for no spall.").hint(SPALL_HINT).example_of("2 mm"),
    quantity("bearing.spall.width", Kind::Quantity(Length, open(0.0, 100.0, "mm")), PROFILED_NEED,
        "Width across the rolling direction. The depth is constant in the middle half of the width, and falls to zero at the sides.").hint(SPALL_HINT).example_of("4 mm").only("bearing.spall.on", &["outer", "inner"]),
    quantity("bearing.spall.edge_radius", Kind::Quantity(Length, closed(0.0, 100.0, "mm")),
        Default { value: "1 mm", reason: "r of Fig. 5.29" }, "Radius r of the rounded edges.").hint(SPALL_HINT),
    quantity("bearing.spall.floor_radius", Kind::Quantity(Length, open(0.0, 10_000.0, "mm")),
        Depends("6 mm (R of Fig. 5.29) without `depth`"),
        "Radius R of the floor, which determines the depth R + r - sqrt((R + r)^2 - l^2/4). A floor tighter than the ball is bridged.").group("floor").hint(SPALL_HINT),
    quantity("bearing.spall.depth", Kind::Quantity(Length, closed(0.0, 100.0, "mm")),
        Depends("from `floor_radius`"),
        "Depth of the floor, which determines its radius. 0 for no spall.").group("floor").hint(SPALL_HINT).example_of("0.07 mm"),
    Key::new("bearing.waviness.on", Kind::Choice(PROFILED), Required, "Part with the waves: a race, or a ball."),
    Key::new("bearing.waviness.ball", Kind::Integer { low: 1, high: 200 }, PROFILED_BALL_NEED, "Number of the ball.").only("bearing.waviness.on", &["ball"]),
    Key::new("bearing.waviness.order", Kind::Integer { low: 1, high: 1000 }, Required, "Number n of waves on the circumference.").example_of("12"),
    quantity("bearing.waviness.amplitude", Kind::Quantity(Length, closed(0.0, 0.1, "mm")), Required,
        "Amplitude A of the waves, normal to the surface. Crests, where cos(n angle + phase) = 1, increase the overlap of a ball by A. The wave has the same height across the groove.").hint(WAVE_HINT).example_of("0.5 um"),
    quantity("bearing.waviness.phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
        Default { value: "0 deg", reason: "a crest on the race's own Y; not allowed on a ball" },
        "Phase of the waves, in the azimuth from the race's own Y towards its Z.").only("bearing.waviness.on", &["outer", "inner"]),
    quantity("bearing.waviness.angle", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), PROFILED_BALL_NEED,
        "Azimuth of the pole of a ball's waves about the ball's X, from its Y towards its Z; at the start the ball's axes are those of the scene. The wave is the same on every great circle through the pole.").example_of("0 deg").only("bearing.waviness.on", &["ball"]),
    quantity("bearing.waviness.groove_angle", Kind::Quantity(Angle, closed(-90.0, 90.0, "deg")),
        Default { value: "0 deg", reason: "the pole is in the radial plane; not allowed on a race" },
        "Angle of the pole from the direction of `angle` towards the ball's +X.").only("bearing.waviness.on", &["ball"]),
    quantity("bearing.cage.mass", Kind::Quantity(Mass, open(0.0, 10_000.0, "kg")), Optional, "Mass of the cage."),
    Key::new("bearing.cage.guidance", Kind::Choice(GUIDANCE), Optional, "Part that guides the cage."),

    quantity("inner_race.x.load", FORCE, COORDINATE_NEED, "Axial force on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.x.displacement", DISPLACEMENT, COORDINATE_NEED, "Prescribed axial displacement.").group("condition"),
    quantity("inner_race.y.load", FORCE, COORDINATE_NEED, "Lateral force on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.y.displacement", DISPLACEMENT, COORDINATE_NEED, "Prescribed lateral displacement.").group("condition"),
    quantity("inner_race.z.load", FORCE, COORDINATE_NEED, "Vertical force on the inner race, up positive.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.z.displacement", DISPLACEMENT, COORDINATE_NEED, "Prescribed vertical displacement.").group("condition"),
    quantity("inner_race.tilt_y.moment", MOMENT, COORDINATE_NEED, "Moment about Y on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.tilt_y.tilt", TILT, COORDINATE_NEED, "Prescribed tilt about Y.").group("condition").hint(TILT_HINT),
    quantity("inner_race.tilt_z.moment", MOMENT, COORDINATE_NEED, "Moment about Z on the inner race.").group("condition").hint(LOAD_HINT),
    quantity("inner_race.tilt_z.tilt", TILT, COORDINATE_NEED, "Prescribed tilt about Z.").group("condition").hint(TILT_HINT),
    quantity("inner_race.speed", SPIN, Depends("required with `ball_forces.centrifugal`; 0 in a run without `torque`"),
        "Rotation speed of the inner race about X. `statics` uses it for frequencies and centrifugal force; a run prescribes it.").group("rotation"),

    quantity("outer_race.x", POSITION, ZERO_LENGTH, "Axial position of the outer race; its initial position if it moves.").group("x"),
    quantity("outer_race.y", POSITION, ZERO_LENGTH, "Lateral position of the outer race; its initial position if it moves.").group("y"),
    quantity("outer_race.z", POSITION, ZERO_LENGTH, "Vertical position of the outer race; its initial position if it moves.").group("z"),
    quantity("outer_race.tilt_y", TILT_POSITION, ZERO_TILT, "Tilt of the outer race about Y; its initial tilt if it moves.").group("tilt_y").hint(TILT_HINT),
    quantity("outer_race.tilt_z", TILT_POSITION, ZERO_TILT, "Tilt of the outer race about Z; its initial tilt if it moves.").group("tilt_z").hint(TILT_HINT),

    Key::new("ball_forces.gravity", GRAVITY,
        Default { value: "none", reason: "weight is neglected" },
        "Acceleration of gravity along X, Y and Z. It acts on the balls in statics and on every moving part in a run."),
    Key::new("ball_forces.centrifugal", Kind::Boolean,
        Default { value: "false", reason: "the centrifugal force of the balls is neglected" },
        "True to include the balls' centrifugal force in statics; needs `inner_race.speed`. A run always includes it."),

    Key::new("output.plots", Kind::Choices(PLOTS),
        Depends("statics: `load-zone`, `polar`; run: `orbit`, `series`, `polar`; solid: `series`, `spectrum`"),
        "Plots to draw; `[]` for none. Statics draws `load-zone`; also `polar` and `moment-tilt` if the scene is one unnamed bearing at the origin with a fixed outer race, not `reversed`, without bodies, springs, foundation and housing. A run draws `polar` and the others; a quasi-static sequence has no `polar`, `slip-spin` and `run-up`. `run-up` shows the radial displacement of each part with changing speed over that speed."),
    Key::new("sweep.of", Kind::Choice(&["statics", "runs"]), Default { value: "statics", reason: "the loads at t = 0" },
        "Results at each point: the equilibrium, or a run in a folder of its own."),
    Key::new("sweep.together", Kind::Boolean, Default { value: "false", reason: "every combination of the values" },
        "True to vary all keys together, value by value; each then has as many values."),
];

const MATERIAL_EXAMPLE: &str =
    "material = { youngs_modulus = \"210 GPa\", poisson_ratio = 0.3, density = \"7850 kg/m^3\" }";

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("assumptions", "Assumptions for data that the source does not state: any name = \"assumption\". Results repeat them.",
        "[assumptions]\nmaterial = \"steel, E 210 GPa\""),
    table("bearing", "The bearing.", "[bearing]\nkind = \"deep-groove\""),
    table("bearing.clearance", "Internal clearance, either `radial` or `diametral`.",
        "clearance = { radial = \"-5 um\" } or { diametral = \"-10 um\" }"),
    table("bearing.inner_race", "Inner race.", "[bearing.inner_race]\ngroove_radius = \"6.013 mm\""),
    table("bearing.inner_race.material", "Material of the inner race; every key is optional.", MATERIAL_EXAMPLE),
    table("bearing.outer_race", "Outer race.", "[bearing.outer_race]\ngroove_radius = \"6.31 mm\""),
    table("bearing.outer_race.material", "Material of the outer race; every key is optional.", MATERIAL_EXAMPLE),
    table("bearing.ball", "Balls.", "ball = { radius = \"5.953 mm\" }"),
    table("bearing.ball.material", "Material of the balls; every key is optional.", MATERIAL_EXAMPLE),
    table("bearing.rating", "Load rating.", "[bearing.rating]\ndynamic = \"23.4 kN\""),
    list_table("bearing.dent", "A dent in a race (3.20), any number. Runs only; equilibria ignore dents.",
        "[[bearing.dent]]\nrace = \"outer\"\nangle = \"270 deg\"\ndiameter = \"500 um\""),
    list_table("bearing.spall", "A spall in a race or on a ball (5.4.3), any number. Runs only; equilibria ignore spalls.",
        "[[bearing.spall]]\non = \"outer\"\nangle = \"270 deg\"\nlength = \"2 mm\"\nwidth = \"4 mm\""),
    list_table("bearing.waviness", "Waves of a race or a ball, any number. Runs only; equilibria ignore waves.",
        "[[bearing.waviness]]\non = \"outer\"\norder = 12\namplitude = \"0.5 um\""),
    table("bearing.cage", "Cage; the table and every key of it are optional.", "[bearing.cage]\npocket_radius = \"6.2 mm\""),
    table("inner_race", "Loads or prescribed displacements of the inner race. A coordinate without a key is free and unloaded.",
        "[inner_race]\nx = { load = \"250 N\" }"),
    table("inner_race.x", "Axial coordinate: a load, or a displacement.", "x = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.y", "Lateral coordinate.", "y = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.z", "Vertical coordinate.", "z = { load = \"250 N\" } or { displacement = \"3 um\" }"),
    table("inner_race.tilt_y", "Tilt about Y: a moment, or a tilt.", "tilt_y = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }"),
    table("inner_race.tilt_z", "Tilt about Z.", "tilt_z = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }"),
    table("outer_race", "Position of the outer race (default: fixed and centred), or its loads and prescribed displacements if it moves.", "[outer_race]\nx = \"0 um\""),
    table("ball_forces", "Body forces on the balls.", "[ball_forces]\ncentrifugal = true"),
    table("output", "Optional output.", "[output]\nplots = [\"polar\"]"),
    table("sweep", "Keys that `bearing sweep` varies if the command line names none: dotted key = list or range; and what it computes.",
        "[sweep]\n\"bearing.ball_phase\" = \"0 deg .. 45 deg / 91\""),
];
