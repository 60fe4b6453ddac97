//! Rows of the key table: a flexible solid by itself, its mesh, supports, loads and outputs.

use crate::scene::tables::bearing::{FORCE, GRAVITY};
use crate::scene::tables::keys::{
    Key, Kind, Need, Range, Table, above, closed, list_table, open, table,
};
use crate::scene::text::units::Dimension::{
    Density, Frequency, Length, Rate, RotationSpeed, Speed, Stress, Time,
};
use Need::{Default, Depends, Optional, Required};

pub const GENERATORS: &[&str] = &[
    "bar",
    "block",
    "ring",
    "shaft",
    "cage",
    "housing-a",
    "housing-b",
    "housing-c",
    "housing-d",
    "bushing",
];
const AXES: &[&str] = &["x", "y", "z"];
const LENGTH_UNITS: &[&str] = &["mm", "m"];
const REPAIRS: &[&str] = &["orient", "merge-duplicates", "drop-unreferenced"];
pub(crate) const DAMPED_MOTIONS: &[&str] = &["absolute", "relative-to-rigid"];
const METHODS: &[&str] = &["central-differences", "runge-kutta"];
const MASSES: &[&str] = &["consistent", "lumped"];
const PLANES: &[&str] = &["x", "y", "z"];
const LAWS: &[&str] = &["linear-elastic", "elastomer"];
pub(crate) const RUBBERS: &[&str] = &["2.3", "3.1"];
const CHAIN_FORCES: &[&str] = &["five-terms", "inverse-langevin"];
const PARTS: &[&str] = &["whole", "quarter"];
/// Key of the law, and its words.
pub(crate) const LAW: &str = "solid.material.law";
const RUBBER: &[&str] = &["elastomer"];
pub(crate) const ELASTIC: &[&str] = &["linear-elastic"];
const WITH_RUBBER: &str = "with `law = \"elastomer\"`";

const SIZE: Kind = Kind::Quantity(Length, open(0.0, 100.0, "m"));
const PLACE: Range = closed(-1000.0, 1000.0, "m");
const CELLS: Kind = Kind::Integer { low: 1, high: 100_000 };
const GROWTH: Kind = Kind::Number(closed(0.1, 10.0, ""));
const PRESSURE: Kind = Kind::Profile(Stress, closed(-1e6, 1e6, "MPa"));
const FIXED: Kind = Kind::TrueOrProfile(Length, closed(-1e6, 1e6, "um"));
const EVEN: Need = Default { value: "1", reason: "uniform steps" };

const fn size(path: &'static str, how: &'static str, doc: &'static str) -> Key {
    Key::new(path, SIZE, Depends(how), doc)
        .hint("a positive length; check the unit")
        .example_of("20 mm")
}

const fn cells(path: &'static str, how: &'static str, doc: &'static str) -> Key {
    Key::new(path, CELLS, Depends(how), doc).hint("a mesh of millions of cells is rarely meant")
}

impl Key {
    /// A dimension or number of cells of these generators.
    const fn of(self, generators: &'static [&'static str]) -> Key {
        self.only(GENERATE, generators)
    }
}

/// Key of the mesh generator.
pub(crate) const GENERATE: &str = "solid.mesh.generate";

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("solid.damping", Kind::Quantity(Rate, closed(0.0, 1e9, "1/s")), Default { value: "0 1/s", reason: "no damping" },
        "Mass-proportional damping: force per mass and velocity.").hint("the source has 77 and 100 1/s").only(LAW, ELASTIC),
    Key::new("solid.damped_motion", Kind::Choice(DAMPED_MOTIONS), Default { value: "absolute", reason: "as (2.7)" },
        "Velocity that damping acts on: absolute, or relative to the body's rigid translation and rotation.").only(LAW, ELASTIC),
    Key::new("solid.gravity", GRAVITY, Default { value: "none", reason: "weight is neglected" },
        "Acceleration of gravity along X, Y and Z."),
    Key::new("solid.velocity", Kind::Vector(Speed, closed(-1e4, 1e4, "m/s")), Default { value: "none", reason: "it starts at rest" },
        "Velocity of the whole body at the start of a run.").example_of("-1 m/s").only(LAW, ELASTIC),
    Key::new("solid.spin", Kind::Quantity(RotationSpeed, closed(-1e6, 1e6, "rpm")), Default { value: "0 rpm", reason: "it does not turn" },
        "Rotation of the whole body about X at the start of a run.").only(LAW, ELASTIC),

    Key::new("solid.material.law", Kind::Choice(LAWS), Default { value: "linear-elastic", reason: "as steel" },
        "Linear elastic (St. Venant-Kirchhoff), or rubber: an eight-chain network (2.8) parallel to Maxwell elements (2.13)."),
    Key::new("solid.material.youngs_modulus", Kind::Quantity(Stress, closed(1e-6, 10_000.0, "GPa")), Default { value: "210 GPa", reason: "bearing steel" },
        "Young's modulus.").hint("steel has 210 GPa; check the unit").only(LAW, ELASTIC),
    Key::new("solid.material.poisson_ratio", Kind::Number(open(-1.0, 0.5, "")), Default { value: "0.3", reason: "bearing steel" },
        "Poisson's ratio.").hint("0.5 would be incompressible; this law needs less").only(LAW, ELASTIC),
    Key::new("solid.material.density", Kind::Quantity(Density, closed(1.0, 30_000.0, "kg/m^3")), Depends("7850 kg/m^3, bearing steel; rubber: 1100 kg/m^3"), "Density.").hint("steel has 7850 kg/m^3; check the unit"),
    Key::new("solid.material.table", Kind::Choice(RUBBERS), Depends(WITH_RUBBER),
        "Rubber of this table of the source. Other keys of the rubber override its values; `[[solid.material.maxwell]]` replaces all its Maxwell elements.").only(LAW, RUBBER),
    Key::new("solid.material.rubber_modulus", Kind::Quantity(Stress, closed(1e-6, 1e6, "MPa")), Depends("with `law = \"elastomer\"`; required without `table`"),
        "Modulus C_R of the network; at N = 8 the shear modulus is 1.085 C_R.").hint("the source has 0.324 and 0.647 MPa; check the unit").example_of("0.647 MPa").only(LAW, RUBBER),
    Key::new("solid.material.chain", Kind::Number(above(1.0, 1e6, "")), Depends("8, with `law = \"elastomer\"`"),
        "Number N of links in a chain; a chain is fully extended at a stretch of √N.").hint("the source has 8; at 1, chains are fully extended in the undeformed rubber").example_of("8").only(LAW, RUBBER),
    Key::new("solid.material.chain_force", Kind::Choice(CHAIN_FORCES), Default { value: "five-terms", reason: "as (2.8)" },
        "Force of a chain over its stretch: the five terms of the source, or the inverse Langevin function that they approximate, which is undefined beyond full extension.").only(LAW, RUBBER),
    Key::new("solid.material.bulk_ratio", Kind::Number(closed(1.0, 1e6, "")), Depends("100, with `law = \"elastomer\"`"),
        "Bulk modulus divided by C_R.").group("bulk").hint("the source has 100; many rubbers have 1000").example_of("100").only(LAW, RUBBER),
    Key::new("solid.material.bulk_modulus", Kind::Quantity(Stress, closed(1e-6, 1e9, "MPa")), Depends(WITH_RUBBER),
        "Bulk modulus, instead of `bulk_ratio`.").group("bulk").hint("check the unit").example_of("64.7 MPa").only(LAW, RUBBER),
    Key::new("solid.material.maxwell.gamma", Kind::Number(above(0.0, 1e6, "")), Required,
        "Stiffness of a Maxwell element divided by the deviatoric stiffness of the network.").example_of("0.492").only(LAW, RUBBER),
    Key::new("solid.material.maxwell.relaxation_time", Kind::Quantity(Time, closed(1e-15, 1e9, "s")), Required,
        "Relaxation time of the element.").hint("the source has 1e-7 to 10 s; check the unit").example_of("10 s").only(LAW, RUBBER),

    Key::new("solid.harmonic.frequencies", Kind::Quantities(Frequency, closed(0.0, 1e9, "Hz")), Depends("required with `[solid.harmonic]`"),
        "Frequencies at which `statics` computes the complex stiffness; 0 is the relaxed network.").example_of("0.1 Hz").only(LAW, RUBBER),
    Key::new("solid.harmonic.set", Kind::Text, Depends("required with `[solid.harmonic]`"),
        "Fixed set that is moved; all other fixed sets stay at rest.").only(LAW, RUBBER),
    Key::new("solid.harmonic.axis", Kind::Choice(AXES), Depends("required with `[solid.harmonic]`"), "Axis of the set's motion.").only(LAW, RUBBER),

    Key::new("solid.mesh.file", Kind::Text, Depends("required without `generate`"),
        "Mesh file, relative to the scene: Gmsh `.msh` (4.1, or 2.0 to 2.2, text or binary) or Abaqus `.inp` (C3D4, C3D10).").group("mesh"),
    Key::new("solid.mesh.generate", Kind::Choice(GENERATORS), Depends("required without `file`"),
        "Mesh generator; its dimensions are listed under [Generated meshes](#generated-meshes).").group("mesh"),
    Key::new("solid.mesh.unit", Kind::Choice(LENGTH_UNITS), Depends("required with `file`"),
        "Unit of length in the file; neither format states it."),
    Key::new("solid.mesh.origin", Kind::Vector(Length, PLACE), Depends("the mesh's own origin"),
        "Point, in the mesh's coordinates, that becomes the origin of the scene; for a housing, the centre of its bearing. Example: (0, 30, 65) mm if the bore is centred there.").example_of("65 mm"),
    Key::new("solid.mesh.axis", Kind::Choice(AXES), Depends("`x`"),
        "Axis of the mesh that becomes X of the scene. `y`: Y, Z, X become X, Y, Z; `z`: Z, X, Y become X, Y, Z."),
    Key::new("solid.mesh.order", Kind::Integer { low: 1, high: 2 }, Depends("that of the file; required with `generate`"),
        "Order of the elements: 1 for four nodes (as the source), 2 for ten nodes. 2 adds mid-side nodes to four-node elements of a file.")
        .hint("1 for four-node, 2 for ten-node tetrahedra").example_of("2"),
    Key::new("solid.mesh.renumber", Kind::Boolean, Default { value: "true", reason: "faster memory access" },
        "True to renumber nodes and elements for speed; fields are then not in the order of the file."),
    Key::new("solid.mesh.repair", Kind::Choices(REPAIRS), Default { value: "none", reason: "no repairs" },
        "Repairs of a mesh file, each reported: reorient inverted elements, merge coincident nodes, remove unused nodes."),
    Key::new("solid.mesh.cavities", Kind::Integer { low: 0, high: 1_000_000 }, Default { value: "0", reason: "an enclosed cavity is usually due to missing elements" },
        "Number of intended enclosed cavities."),
    Key::new("solid.mesh.largest_aspect", Kind::Number(above(1.0, 1e9, "")), Default { value: "1000", reason: "a worse element is a defect" },
        "Largest allowed aspect ratio of an element; 1 for a regular one.").example_of("1000"),
    size("solid.mesh.length", "bar, shaft, bushing", "Length along X.").group("length").of(&["bar", "shaft", "bushing"]),
    size("solid.mesh.width", "bar (along Y), ring, cage (along X)", "Width.").of(&["bar", "ring", "cage"]),
    size("solid.mesh.height", "bar", "Height along Z.").of(&["bar"]),
    size("solid.mesh.radius", "shaft", "Radius.").of(&["shaft"]),
    size("solid.mesh.inner_radius", "ring, cage", "Inner radius.").of(&["ring", "cage"]),
    size("solid.mesh.inner_diameter", "bushing", "Inner diameter of the rubber.").of(&["bushing"]),
    size("solid.mesh.outer_diameter", "bushing", "Outer diameter of the rubber.").of(&["bushing"]),
    Key::new("solid.mesh.part", Kind::Choice(PARTS), Depends("bushing; `whole`"),
        "The whole bushing, or its quarter with X, Y ≥ 0 for a sleeve that moves along Z. For a quarter fix `x_low` along X and `y_low` along Y, and multiply forces by four.").of(&["bushing"]),
    size("solid.mesh.outer_radius", "ring, cage, housing-b, -c, -d", "Outer radius; for a pillow block that of its annulus.").of(&["ring", "cage", "housing-b", "housing-c", "housing-d"]),
    Key::new("solid.mesh.stations", Kind::Quantities(Length, PLACE), Depends("shaft, instead of `length`"),
        "Axial positions of node layers of a shaft, increasing; each is a set `station_1`, ….").group("length").example_of("0 mm").of(&["shaft"]),
    Key::new("solid.mesh.pockets", Kind::Integer { low: 2, high: 200 }, Depends("cage"), "Number of pockets.").of(&["cage"]),
    size("solid.mesh.pocket_radius", "cage", "Radius of a pocket.").of(&["cage"]),
    size("solid.mesh.bore_radius", "housings", "Radius of the bore.").of(&["housing-a", "housing-b", "housing-c", "housing-d"]),
    size("solid.mesh.side", "housing-a", "Side of the square cuboid.").of(&["housing-a"]),
    size("solid.mesh.depth", "housings", "Length along the bore.").of(&["housing-a", "housing-b", "housing-c", "housing-d"]),
    size("solid.mesh.centre_height", "housing-b, -c; 1.8 bore radii unless given", "Height of the bore's centre above the bottom.").of(&["housing-b", "housing-c"]),
    size("solid.mesh.base_width", "housing-b, -c; 4.2 bore radii unless given", "Width of the base.").of(&["housing-b", "housing-c"]),
    size("solid.mesh.base_height", "housing-b, -c; 0.55 bore radii unless given", "Height of the base.").of(&["housing-b", "housing-c"]),
    size("solid.mesh.neck_width", "housing-b, -c; 2.5 bore radii unless given", "Width over both necks.").of(&["housing-b", "housing-c"]),
    size("solid.mesh.fillet_radius", "housing-b, -c; 0.35 bore radii unless given", "Fillet radius between necks and base.").of(&["housing-b", "housing-c"]),
    size("solid.mesh.half_width", "block", "Half contact width b: the block is 8 b wide (Y), 5 b high (Z, top at 0), 1 b deep (X).").of(&["block"]),
    size("solid.mesh.relief.depth", "with `relief`", "Depth of the cage's rails below the belt, at their edges.").of(&["cage"]),
    size("solid.mesh.relief.belt_width", "with `relief`", "Width of the cylindrical part of the cage's outer surface.").of(&["cage"]),
    cells("solid.mesh.cells.along", "bar, shaft", "Cells along X. In a shaft with `stations`, layers are at most its length divided by this number.").of(&["bar", "shaft"]),
    cells("solid.mesh.cells.across", "bar", "Cells along Y.").of(&["bar"]),
    cells("solid.mesh.cells.up", "bar", "Cells along Z.").of(&["bar"]),
    cells("solid.mesh.cells.around", "ring, housings; bushing: 3 or more, quarter: 2 or more; shaft: a multiple of 8", "Cells around the circumference.").of(&["ring", "shaft", "housing-a", "housing-b", "housing-c", "housing-d", "bushing"]),
    cells("solid.mesh.cells.radial", "ring, shaft, housings, bushing: even", "Cells along the radius; for a shaft those outside its core.").of(&["ring", "shaft", "housing-a", "housing-b", "housing-c", "housing-d", "bushing"]),
    cells("solid.mesh.cells.axial", "ring, housings; bushing: even for `whole`", "Cells along X; for a quarter of a bushing those along half its length.").of(&["ring", "housing-a", "housing-b", "housing-c", "housing-d", "bushing"]),
    cells("solid.mesh.cells.quarter", "cage", "Cells along a quarter of a pocket's edge.").of(&["cage"]),
    cells("solid.mesh.cells.bar", "cage", "Cells from a pocket's edge to the middle of the bar.").of(&["cage"]),
    cells("solid.mesh.cells.wall", "cage", "Cells through the wall.").of(&["cage"]),
    cells("solid.mesh.cells.per_half_width", "block", "Cells per half contact width in the fine zone, 3 b wide and 1.5 b high.").of(&["block"]),
    cells("solid.mesh.cells.deep", "block", "Cells along the depth.").of(&["block"]),
    Key::new("solid.mesh.cells.growth", GROWTH, EVEN, "Growth ratio of radial steps outwards (ring, housings), or of steps outside the fine zone (block).").example_of("1.25").of(&["block", "ring", "housing-a", "housing-b", "housing-c", "housing-d"]),

    Key::new("solid.mesh.cells.grading", Kind::Number(closed(1.0, 10.0, "")), Depends("bushing; 1, uniform"),
        "Grading exponent p of a bushing's cells towards sleeves and ends, where corner stresses are singular: the station at fraction s from the middle is at 1 − (1 − s)^p.").example_of("2").of(&["bushing"]),

    Key::new("solid.set.name", Kind::Text, Required, "Name of the set; it is added to those of the mesh."),
    Key::new("solid.set.plane", Kind::Choice(PLANES), Optional, "Surface on the plane normal to this axis at `at`.").group("place"),
    Key::new("solid.set.at", Kind::Quantity(Length, PLACE), Depends("required with `plane`"), "Position of the plane on its axis."),
    Key::new("solid.set.cylinder", Kind::Quantity(Length, open(0.0, 100.0, "m")), Optional, "Surface on the cylinder of this radius about X.").group("place"),
    Key::new("solid.set.low", Kind::Vector(Length, PLACE), Optional, "Nodes in a box: corner with the lowest coordinates.").group("place"),
    Key::new("solid.set.high", Kind::Vector(Length, PLACE), Depends("required with `low`"), "Corner of the box with the highest coordinates."),
    Key::new("solid.set.tolerance", Kind::Quantity(Length, open(0.0, 100.0, "m")), Depends("1e-6 of the mesh's size"),
        "Largest distance of a node from the surface.").example_of("1 um"),

    Key::new("solid.fixed.set", Kind::Text, Required, "Set whose nodes are fixed."),
    Key::new("solid.fixed.x", FIXED, Depends("free"), "Fixed at zero along X (`true`), or prescribed displacement."),
    Key::new("solid.fixed.y", FIXED, Depends("free"), "As `x`, along Y."),
    Key::new("solid.fixed.z", FIXED, Depends("free"), "As `x`, along Z."),

    Key::new("solid.load.set", Kind::Text, Required, "Set that is loaded."),
    Key::new("solid.load.x", FORCE, Optional, "Total force along X, distributed over a surface by area and over other node sets evenly.").hint("check the unit"),
    Key::new("solid.load.y", FORCE, Optional, "Total force along Y.").hint("check the unit"),
    Key::new("solid.load.z", FORCE, Optional, "Total force along Z.").hint("check the unit"),
    Key::new("solid.load.force", Kind::Vector(crate::scene::text::units::Dimension::Force, closed(-1e9, 1e9, "N")), Optional,
        "Constant total force along X, Y and Z."),
    Key::new("solid.load.pressure", PRESSURE, Optional,
        "Pressure on a surface, positive into the body. A dead load: on the undeformed area, along the undeformed normal.").hint("check the unit").example_of("2 MPa"),

    Key::new("solid.probe.name", Kind::Text, Depends("the name of the set; required with `at`"), "Name of the columns."),
    Key::new("solid.probe.set", Kind::Text, Depends("required without `at`"), "Set whose mean displacement is written."),
    Key::new("solid.probe.at", Kind::Vector(Length, PLACE), Depends("required without `set`"), "Point; the displacement of the nearest node is written."),

    Key::new("modes.count", Kind::Integer { low: 1, high: 1000 }, Default { value: "12", reason: "six rigid-body modes of a free body and six more" },
        "Number of modes, including rigid-body modes.").only(LAW, ELASTIC),
    Key::new("modes.mass", Kind::Choice(MASSES), Default { value: "consistent", reason: "converges fastest" },
        "Mass matrix: consistent, or diagonal as in explicit integration.").only(LAW, ELASTIC),

    Key::new("numerics.method", Kind::Choice(METHODS), Default { value: "central-differences", reason: "one force evaluation per step" },
        "Time integrator of a solid: central differences of order 2, or the source's classical Runge-Kutta. The step is 0.8 of the stability limit unless `step` or `step_fraction` is given; a step beyond the limit is refused.").only(LAW, ELASTIC),
    Key::new("numerics.fields_interval", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("solid: 1/20 of the run; housings and shafts in elements: at the end only"),
        "Time between field files of a solid, a housing or a shaft in elements, rounded to whole output rows.").example_of("0.1 ms"),
];

/// Tables in the order of the reference.
#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("solid", "A flexible solid, either by itself or as the housing of a bearing (`[housing]`).", "[solid]\ndamping = \"77 1/s\""),
    table("solid.material", "Linear elastic (St. Venant-Kirchhoff), or rubber: `law = \"elastomer\"` with `table = \"3.1\"`, or with `rubber_modulus` and Maxwell elements.",
        "[solid.material]\nyoungs_modulus = \"210 GPa\"\npoisson_ratio = 0.3\ndensity = \"7850 kg/m^3\""),
    list_table("solid.material.maxwell", "Maxwell elements of a rubber, any number. Without them and without `table`, the rubber is the network only.",
        "[[solid.material.maxwell]]\ngamma = 0.492\nrelaxation_time = \"10 s\""),
    table("solid.harmonic", "Small harmonic motion of a rubber solid about rest, without inertia: complex stiffness K′ + i K″ for the motion of a set, dynamic stiffness K_d = √(K′² + K″²) (3.13) and η_d = K″/K_d (3.14), the sine of the loss angle, over frequency.",
        "[solid.harmonic]\nset = \"inner\"\naxis = \"z\"\nfrequencies = [\"0.1 Hz\", \"10 Hz\"]"),
    table("solid.mesh", "Tetrahedra from a file or a generator. A mesh with faults is refused unless `repair` is given.",
        "[solid.mesh]\nfile = \"part.msh\"\nunit = \"mm\""),
    table("solid.mesh.relief", "Relieved rails of a cage, lower than its belt; not in the source.",
        "[solid.mesh.relief]\ndepth = \"0.5 mm\"\nbelt_width = \"13 mm\""),
    table("solid.mesh.cells", "Numbers of cells of a generated mesh.", "[solid.mesh.cells]\nalong = 20\nacross = 2\nup = 2"),
    list_table("solid.set", "Sets defined by geometry, any number, in addition to those of the mesh.",
        "[[solid.set]]\nname = \"tip\"\nplane = \"x\"\nat = \"100 mm\""),
    list_table("solid.fixed", "Supports, any number: sets of nodes that are fixed or have a prescribed displacement.",
        "[[solid.fixed]]\nset = \"x_low\"\nx = true\ny = true\nz = { ramp = [\"0 um\", \"5 um\"], duration = \"1 ms\" }"),
    list_table("solid.load", "Loads on sets, any number: `x`, `y`, `z`, or `force`, or `pressure`.",
        "[[solid.load]]\nset = \"x_high\"\nz = \"-100 N\""),
    list_table("solid.probe", "Nodes or sets whose mean displacement is written, any number.",
        "[[solid.probe]]\nset = \"x_high\""),
    table("modes", "Natural modes of a solid.", "[modes]\ncount = 12"),
];
