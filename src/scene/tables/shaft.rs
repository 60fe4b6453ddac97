//! Rows of the key table: flexible shafts, beams of stepped round sections with discs.

use crate::scene::tables::bearing::{
    DENSITY, DENSITY_HINT, FORCE, LOAD_HINT, MODULUS, STEEL_DENSITY,
};
use crate::scene::tables::dynamics::{INERTIA, INERTIA_HINT, MASS, MASS_HINT};
use crate::scene::tables::keys::{Key, Kind, Need, Range, Table, closed, list_table, open, table};
use crate::scene::tables::solid::DAMPED_MOTIONS;
use crate::scene::text::units::Dimension::{
    Angle, Damping, Frequency, Length, Rate, Stiffness, Unbalance,
};
use Need::{Default, Depends, Optional, Required};

const PLACE: Kind = Kind::Quantity(Length, closed(-1e5, 1e5, "mm"));
const PLACE_HINT: &str =
    "an axial position measured from the body's centre, like `inner_at`; check the unit";
const SIZE: Kind = Kind::Quantity(Length, open(0.0, 100.0, "m"));
const SIZE_HINT: &str = "a positive length; check the unit";
const BORE: Kind = Kind::Quantity(
    Length,
    Range { low: 0.0, high: 100.0, low_included: true, high_included: false, unit: "m" },
);
const POISSON: Kind =
    Kind::Number(Range { low: 0.0, high: 0.5, low_included: true, high_included: false, unit: "" });
const DAMPING: Kind = Kind::Quantity(Rate, closed(0.0, 1e9, "1/s"));
const AROUND: Kind = Kind::Integer { low: 8, high: 1000 };
const MESH_METHODS: &[&str] = &["reduced", "explicit"];
const RADIAL: Kind = Kind::Integer { low: 1, high: 100 };
const WITH_MASS: Need = Depends("0 with `mass`");
const SIZE_OR_MASS: Need = Depends("give `outer_diameter` and `width`, or `mass`");

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("body.beam.start", PLACE, Depends("the beam is centred on the body"), "Axial position of the start of the first segment, measured from the body's centre.").hint(PLACE_HINT).example_of("-200 mm"),
    Key::new("body.beam.youngs_modulus", MODULUS, Default { value: "210 GPa", reason: "steel" }, "Young's modulus of all segments.").hint("steel has 210 GPa; check the unit"),
    Key::new("body.beam.poisson_ratio", POISSON, Default { value: "0.3", reason: "steel" }, "Poisson's ratio, for the shear stiffness."),
    Key::new("body.beam.density", DENSITY, STEEL_DENSITY, "Density of segments, and of discs given by their dimensions.").hint(DENSITY_HINT),
    Key::new("body.beam.modes_to", Kind::Quantity(Frequency, closed(0.0, 1e7, "Hz")), Default { value: "5 kHz", reason: "far above the speed of a shaft" }, "Highest natural frequency of the free-shaft modes that are kept. Static correction modes for every attachment are added; `plan` prints what is omitted. `modes` keeps them up to 2.5 times this frequency and lists modes up to it: within 0.1 % of all.").example_of("5 kHz").only("body.beam.mesh.method", &["reduced"]),
    Key::new("body.beam.damping", DAMPING, Default { value: "0 1/s", reason: "no damping" }, "Mass-proportional damping: force per mass and velocity, in non-rotating axes.").hint("the source has 77 and 100 1/s for solids").example_of("100 1/s"),
    Key::new("body.beam.damped_motion", Kind::Choice(DAMPED_MOTIONS), Default { value: "absolute", reason: "as (2.7)" }, "Velocity that `damping` acts on: all transverse and axial motion, or bending only. Bending only gives little damping of whirl if the bearings do not move."),
    Key::new("body.beam.internal_damping", DAMPING, Default { value: "0 1/s", reason: "no damping" }, "Mass-proportional damping of bending in axes that rotate with the shaft; above a critical speed it destabilises whirl.").example_of("10 1/s").only("body.beam.mesh.method", &["reduced"]),
    Key::new("body.beam.segments.length", SIZE, Required, "Length along the axis.").hint(SIZE_HINT).example_of("400 mm"),
    Key::new("body.beam.segments.outer_diameter", SIZE, Required, "Outer diameter.").hint(SIZE_HINT).example_of("30 mm"),
    Key::new("body.beam.segments.inner_diameter", BORE, Depends("0, a solid section"), "Diameter of the bore.").hint(SIZE_HINT).example_of("10 mm"),
    Key::new("body.beam.mesh.order", Kind::Integer { low: 1, high: 2 }, Depends("required with `[body.NAME.beam.mesh]`"), "Order of the elements: 1 for four nodes (the source's; too stiff in bending), 2 for ten nodes.").hint("1 for four-node, 2 for ten-node tetrahedra").example_of("2"),
    Key::new("body.beam.mesh.longest_layer", SIZE, Depends("one layer of cells between stations"), "Largest axial length of a layer of cells. Stations divide the shaft into 32 intervals, with additional stations at attachments.").hint(SIZE_HINT).example_of("5 mm"),
    Key::new("body.beam.mesh.around", AROUND, Default { value: "16", reason: "ten-node elements follow the circle to 1e-4" }, "Cells around the circumference, a multiple of 8."),
    Key::new("body.beam.mesh.radial", RADIAL, Default { value: "1", reason: "enough for bending with ten-node elements" }, "Radial cells between the square core and the innermost radius; outer rings have cells of the same size. With one, a tube of 40/24 mm is 0.1 to 0.2 % too stiff."),
    Key::new("body.beam.mesh.method", Kind::Choice(MESH_METHODS), Default { value: "reduced", reason: "seconds instead of minutes, within 0.1 % below 2 kHz" }, "Solution of the elements in a run: reduced to the stations, or all elements with explicit integration as in the source (4.2.2). Equilibria and `modes` always use the reduced mesh. `explicit` needs a prescribed `speed` and takes loads in `beam.load` only. It refuses `torque`, `below`, `internal_damping`, `damped_motion = \"relative-to-rigid\"`, prescribed displacements and a foundation of the body, discs without inertia, springs that end at the body, outer races on it, `housing.start = \"equilibrium\"`, housings of other methods, and `numerics.start`."),
    Key::new("body.beam.mesh.race_stiffness", Kind::Quantity(Stiffness, closed(1.0, 1e13, "N/m")), Default { value: "2e9 N/m", reason: "as the source (4.2.3)" }, "With `method = \"explicit\"`: stiffness, along each axis, of the spring between the centre of a race or disc and that of its section. The rotational stiffness is this times the square of the shaft diameter.").hint("the source has 2e9 N/m").only("body.beam.mesh.method", &["explicit"]),
    Key::new("body.beam.mesh.race_damping", Kind::Quantity(Damping, closed(0.0, 1e9, "N s/m")), Default { value: "200 N s/m", reason: "small, as in the source: 1 % of critical for a race of 50 g" }, "Damping parallel to `race_stiffness`, rotational damping likewise.").hint("the source requires a small one and states no value").only("body.beam.mesh.method", &["explicit"]),
    Key::new("body.beam.disc.at", PLACE, Required, "Axial position of the disc's centre.").hint(PLACE_HINT).example_of("0 mm"),
    Key::new("body.beam.disc.mass", MASS, SIZE_OR_MASS, "Mass of the disc, or of a race mounted there.").hint(MASS_HINT).example_of("20 kg"),
    Key::new("body.beam.disc.axial", INERTIA, WITH_MASS, "Moment of inertia of the disc about the shaft axis.").hint(INERTIA_HINT).example_of("0.1 kg m^2"),
    Key::new("body.beam.disc.transverse", INERTIA, WITH_MASS, "Moment of inertia of the disc about a transverse axis through its centre.").hint(INERTIA_HINT).example_of("0.05 kg m^2"),
    Key::new("body.beam.disc.outer_diameter", SIZE, SIZE_OR_MASS, "Outer diameter of a disc of the shaft's density.").hint(SIZE_HINT).example_of("200 mm"),
    Key::new("body.beam.disc.inner_diameter", BORE, Depends("0"), "Inner diameter of the disc: that of the shaft if the segments pass through it.").hint(SIZE_HINT).example_of("30 mm"),
    Key::new("body.beam.disc.width", SIZE, SIZE_OR_MASS, "Axial width of the disc.").hint(SIZE_HINT).example_of("20 mm"),
    Key::new("body.beam.load.at", PLACE, Required, "Axial position of the force, which acts at the centre of the section.").hint(PLACE_HINT).example_of("0 mm"),
    Key::new("body.beam.load.x", FORCE, Optional, "Axial force over time.").hint(LOAD_HINT),
    Key::new("body.beam.load.y", FORCE, Optional, "Lateral force over time.").hint(LOAD_HINT),
    Key::new("body.beam.load.z", FORCE, Optional, "Vertical force over time, up positive.").hint(LOAD_HINT).example_of("-3000 N"),
    Key::new("body.beam.unbalance.at", PLACE, Required, "Axial position of the unbalance.").hint(PLACE_HINT).example_of("0 mm"),
    Key::new("body.beam.unbalance.size", Kind::Quantity(Unbalance, closed(0.0, 1e6, "kg m")), Required, "Unbalance, mass times eccentricity.").hint("mass times eccentricity; 100 N at 1000 rpm is 9.12e-3 kg m").example_of("1e-3 kg m"),
    Key::new("body.beam.unbalance.angle", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Depends("0 deg"), "Direction of the unbalance at t = 0, from +Y towards +Z.").example_of("90 deg"),
    Key::new("body.beam.probe.name", Kind::Text, Required, "Name of the section in columns: `shaft_mid_y`, `shaft_mid_z` of `mid` on `[body.shaft]`.").example_of("mid"),
    Key::new("body.beam.probe.at", PLACE, Required, "Axial position of the section.").hint(PLACE_HINT).example_of("0 mm"),
];

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("body.beam", "A flexible shaft: Timoshenko beam of round segments with rigid discs, which replaces `inertia`. It bends and stretches; torsion is not modelled. Bearings, springs, `load` and `unbalance` act on sections. Loads on the body's own coordinates and its `foundation` act on all its mass, like weight.",
        "[body.shaft.beam]\nsegments = [{ length = \"400 mm\", outer_diameter = \"30 mm\" }]"),
    list_table("body.beam.segments", "Segments in order along +X.",
        "[[body.shaft.beam.segments]]\nlength = \"400 mm\"\nouter_diameter = \"30 mm\""),
    table("body.beam.mesh", "Tetrahedra instead of beam theory: a mesh of one material generated from the segments and reduced to stations, with the gyroscopic terms of a body of revolution. All other keys of the body apply unchanged.",
        "[body.shaft.beam.mesh]\norder = 2"),
    list_table("body.beam.disc", "Rigid discs on the shaft, any number. Each inner race needs one for its mass.",
        "[[body.shaft.beam.disc]]\nat = \"0 mm\"\nmass = \"20 kg\""),
    list_table("body.beam.load", "Forces on sections, any number.",
        "[[body.shaft.beam.load]]\nat = \"0 mm\"\nz = \"-3000 N\""),
    list_table("body.beam.unbalance", "Unbalances that rotate with the shaft, any number.",
        "[[body.shaft.beam.unbalance]]\nat = \"0 mm\"\nsize = \"1e-3 kg m\""),
    list_table("body.beam.probe", "Sections whose displacement is recorded, in the channel group of the races.",
        "[[body.shaft.beam.probe]]\nname = \"mid\"\nat = \"0 mm\""),
];
