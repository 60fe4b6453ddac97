//! Rows of the key table: a body that bends, as a beam of stepped round sections with discs.

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
    "a distance along the body's axis from its centre, as `inner_at`; check the unit";
const SIZE: Kind = Kind::Quantity(Length, open(0.0, 100.0, "m"));
const SIZE_HINT: &str = "a positive length; check the unit";
const BORE: Kind = Kind::Quantity(
    Length,
    Range { low: 0.0, high: 100.0, low_included: true, high_included: false, unit: "m" },
);
const POISSON: Kind =
    Kind::Number(Range { low: 0.0, high: 0.5, low_included: true, high_included: false, unit: "" });
const BRAKE: Kind = Kind::Quantity(Rate, closed(0.0, 1e9, "1/s"));
const AROUND: Kind = Kind::Integer { low: 8, high: 1000 };
const MESH_METHODS: &[&str] = &["reduced", "explicit"];
const RADIAL: Kind = Kind::Integer { low: 1, high: 100 };
const OF_DISC: Need = Depends("with `mass`: 0 unless given");
const OF_RING: Need = Depends("`outer_diameter` and `width`, or `mass`");

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("body.beam.start", PLACE, Depends("half its length before the body's centre"), "Where the first segment begins: distance from the body's centre along its axis.").hint(PLACE_HINT).example_of("-200 mm"),
    Key::new("body.beam.youngs_modulus", MODULUS, Default { value: "210 GPa", reason: "steel" }, "Modulus of elasticity of all segments.").hint("steel has 210 GPa; check the unit"),
    Key::new("body.beam.poisson_ratio", POISSON, Default { value: "0.3", reason: "steel" }, "Poisson's ratio; for the shear of the sections."),
    Key::new("body.beam.density", DENSITY, STEEL_DENSITY, "Density of segments, and of discs of a given size.").hint(DENSITY_HINT),
    Key::new("body.beam.below", Kind::Quantity(Frequency, closed(0.0, 1e7, "Hz")), Default { value: "5 kHz", reason: "far above the speed of a shaft" }, "Natural shapes of the free shaft up to this frequency are taken, and beside them its static answers to whatever takes hold of it; `plan` says what is left out.").example_of("5 kHz"),
    Key::new("body.beam.damping", BRAKE, Default { value: "0 1/s", reason: "no damping" }, "Mass-proportional damping: force per mass and velocity, in axes that do not spin.").hint("the source has 77 and 100 1/s for solids").example_of("100 1/s"),
    Key::new("body.beam.damped_motion", Kind::Choice(DAMPED_MOTIONS), Default { value: "absolute", reason: "as (2.7)" }, "What it brakes: all motion across the axis and along it, or bending alone, which hardly brakes a whirl whose bearings stand still."),
    Key::new("body.beam.internal_damping", BRAKE, Default { value: "0 1/s", reason: "no damping" }, "The same of bending alone as the spinning material feels it; above a critical speed it feeds the whirl.").example_of("10 1/s"),
    Key::new("body.beam.segments.length", SIZE, Required, "Length along the axis.").hint(SIZE_HINT).example_of("400 mm"),
    Key::new("body.beam.segments.outer_diameter", SIZE, Required, "Outer diameter.").hint(SIZE_HINT).example_of("30 mm"),
    Key::new("body.beam.segments.inner_diameter", BORE, Depends("0 unless given: full"), "Diameter of the bore.").hint(SIZE_HINT).example_of("10 mm"),
    Key::new("body.beam.mesh.order", Kind::Integer { low: 1, high: 2 }, Depends("required with `[body.NAME.beam.mesh]`"), "Elements of 4 nodes (1, the source's, too stiff in bending) or of 10 (2).").hint("1 for four-node, 2 for ten-node tetrahedra").example_of("2"),
    Key::new("body.beam.mesh.longest_layer", SIZE, Depends("one layer of cells from station to station unless given"), "No layer of cells is longer than this along the axis. Stations are 32 intervals along the shaft, more where something takes hold of it.").hint(SIZE_HINT).example_of("5 mm"),
    Key::new("body.beam.mesh.around", AROUND, Default { value: "16", reason: "ten-node elements follow the circle to 1e-4" }, "Cells around: a multiple of 8."),
    Key::new("body.beam.mesh.radial", RADIAL, Default { value: "1", reason: "ten-node elements bend without more" }, "Cells in the ring about the square core of the innermost radius; rings outside it get cells of that size. A tube of 40/24 mm is 0.1 to 0.2 % too stiff with one, hardly with two."),
    Key::new("body.beam.mesh.method", Kind::Choice(MESH_METHODS), Default { value: "reduced", reason: "seconds in the place of minutes, within 0.1 % below 2 kHz" }, "How the elements are solved in a run: reduced to the stations, or all of them in explicit steps as in the source (4.2.2). Equilibria and `modes` are those of the reduced mesh either way. `explicit` takes a given `speed`; it refuses `torque`, `below`, `internal_damping`, `damped_motion = \"relative-to-rigid\"`, loads, motions and a foundation of the body itself (loads stand at places of `beam`), discs without inertia, springs that end at the body, outer races on it, `housing.start = \"equilibrium\"` and housings of other methods beside it, and `numerics.start`."),
    Key::new("body.beam.mesh.race_stiffness", Kind::Quantity(Stiffness, closed(1.0, 1e13, "N/m")), Default { value: "2e9 N/m", reason: "as the source (4.2.3)" }, "With `method = \"explicit\"`: spring between the centre of a race, or of a disc, and that of its section, along each axis; against turns it has as much on an arm of the shaft's diameter.").hint("the source has 2e9 N/m"),
    Key::new("body.beam.mesh.race_damping", Kind::Quantity(Damping, closed(0.0, 1e9, "N s/m")), Default { value: "200 N s/m", reason: "small, as the source asks for: a hundredth of critical for a race of 50 g" }, "Dashpot beside that spring, against turns on the same arm.").hint("the source names a small one without a figure"),
    Key::new("body.beam.disc.at", PLACE, Required, "Where its centre sits.").hint(PLACE_HINT).example_of("0 mm"),
    Key::new("body.beam.disc.mass", MASS, OF_RING, "Mass of the disc, or of a race that sits there.").hint(MASS_HINT).example_of("20 kg"),
    Key::new("body.beam.disc.axial", INERTIA, OF_DISC, "Its moment of inertia about the axis.").hint(INERTIA_HINT).example_of("0.1 kg m^2"),
    Key::new("body.beam.disc.transverse", INERTIA, OF_DISC, "Its moment of inertia across the axis, about its own centre.").hint(INERTIA_HINT).example_of("0.05 kg m^2"),
    Key::new("body.beam.disc.outer_diameter", SIZE, OF_RING, "Outer diameter of a disc of the shaft's density.").hint(SIZE_HINT).example_of("200 mm"),
    Key::new("body.beam.disc.inner_diameter", BORE, Depends("0 unless given"), "Its inner diameter: that of the shaft, if the segments go through.").hint(SIZE_HINT).example_of("30 mm"),
    Key::new("body.beam.disc.width", SIZE, OF_RING, "Its width along the axis.").hint(SIZE_HINT).example_of("20 mm"),
    Key::new("body.beam.load.at", PLACE, Required, "Where the force acts, at the middle of the section.").hint(PLACE_HINT).example_of("0 mm"),
    Key::new("body.beam.load.x", FORCE, Optional, "Force along X, over time.").hint(LOAD_HINT),
    Key::new("body.beam.load.y", FORCE, Optional, "Force along Y.").hint(LOAD_HINT),
    Key::new("body.beam.load.z", FORCE, Optional, "Force along Z, up positive.").hint(LOAD_HINT).example_of("-3000 N"),
    Key::new("body.beam.unbalance.at", PLACE, Required, "Where it sits.").hint(PLACE_HINT).example_of("0 mm"),
    Key::new("body.beam.unbalance.size", Kind::Quantity(Unbalance, closed(0.0, 1e6, "kg m")), Required, "Mass times its distance from the axis.").hint("mass times eccentricity; 100 N at 1000 rpm is 9.12e-3 kg m").example_of("1e-3 kg m"),
    Key::new("body.beam.unbalance.angle", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Depends("0 deg unless given"), "Its direction at the start, from +Y towards +Z.").example_of("90 deg"),
    Key::new("body.beam.probe.name", Kind::Text, Required, "Name of the section in columns: `shaft_mid_y`, `shaft_mid_z` of `mid` on `[body.shaft]`.").example_of("mid"),
    Key::new("body.beam.probe.at", PLACE, Required, "Where the section is.").hint(PLACE_HINT).example_of("0 mm"),
];

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("body.beam", "The body bends: a Timoshenko beam of round segments with rigid discs, which gives it its `inertia`. Bearings and springs take hold of its sections; `load` and `unbalance` stand at a place. Loads on the body's own coordinates and its `foundation` act as weight does, on all its mass: it bends between what holds it against them. It bends and stretches, and does not twist.",
        "[body.shaft.beam]\nsegments = [{ length = \"400 mm\", outer_diameter = \"30 mm\" }]"),
    list_table("body.beam.segments", "Its segments one after the other, along X.",
        "[[body.shaft.beam.segments]]\nlength = \"400 mm\"\nouter_diameter = \"30 mm\""),
    table("body.beam.mesh", "The segments are tetrahedra in the place of beam theory: a mesh of one material, made from their dimensions and reduced to its stations, with gyroscopic terms as a body of revolution has them. Everything else about the body stays.",
        "[body.shaft.beam.mesh]\norder = 2"),
    list_table("body.beam.disc", "Rigid discs on it, any number; inner races count as one each.",
        "[[body.shaft.beam.disc]]\nat = \"0 mm\"\nmass = \"20 kg\""),
    list_table("body.beam.load", "Forces on sections.",
        "[[body.shaft.beam.load]]\nat = \"0 mm\"\nz = \"-3000 N\""),
    list_table("body.beam.unbalance", "Unbalances that turn with it.",
        "[[body.shaft.beam.unbalance]]\nat = \"0 mm\"\nsize = \"1e-3 kg m\""),
    list_table("body.beam.probe", "Sections whose displacement is recorded with the races.",
        "[[body.shaft.beam.probe]]\nname = \"mid\"\nat = \"0 mm\""),
];
