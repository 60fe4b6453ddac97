//! Rows of the key table: which bodies bearings sit on, rigid bodies besides the races, springs between them.

use crate::scene::tables::bearing::{
    DENSITY, DISPLACEMENT, FORCE, LOAD_HINT, MOMENT, SPIN, TILT, TILT_HINT,
};
use crate::scene::tables::dynamics::{
    DASHPOT, FOUNDATION, FOUNDATION_HINT, INERTIA, INERTIA_HINT, MASS, MASS_HINT, TILT_DASHPOT,
    TILT_FOUNDATION,
};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, list_table, open, table};
use crate::scene::tables::solid::RUBBERS;
use crate::scene::text::units::Dimension::{Angle, Frequency, Length, Stress, Time, Unbalance};
use Need::{Default, Depends, Optional, Required};

/// The word for a race that is a body of its own, and for what does not move.
pub const OWN_RACES: [&str; 2] = ["inner_race", "outer_race"];
pub const GROUND: &str = "ground";

pub(crate) const PLACE: Kind = Kind::Quantity(Length, closed(-1e5, 1e5, "mm"));
pub(crate) const PLACE_HINT: &str =
    "a distance along the body's axis from its centre; check the unit";
const SIZE: Kind = Kind::Quantity(Length, open(0.0, 10.0, "m"));
const SIZE_HINT: &str = "a positive length; check the unit";
const CELLS: Kind = Kind::Integer { low: 2, high: 100 };
const METHODS: &[&str] = &["reduced", "explicit", "implicit"];
const WITH_BUSHING: Need = Depends("required with `[spring.NAME.bushing]`");
const FREE: Need = Depends("neither key: the coordinate is free and unloaded");
const ALL_THREE: Need = Depends("all three, required for a run and with gravity");
const NONE: Need = Default { value: "0 N/m", reason: "none is given" };
const NO_TURN: Need = Default { value: "0 N m/rad", reason: "none is given" };
const NO_DASHPOT: Need = Default { value: "0 N s/m", reason: "none is given" };
const NO_TURN_DASHPOT: Need = Default { value: "0 N m s/rad", reason: "none is given" };

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("bearing.inner_on", Kind::Text, Depends("the only `[body.NAME]`; without any, an inner race of its own"), "The body that carries the inner race, `shaft` for `[body.shaft]`; `inner_race`: a body of its own, as `[inner_race]` says."),
    Key::new("bearing.inner_at", PLACE, Default { value: "0 mm", reason: "at the centre of the body" }, "Where the inner race sits: distance of its centre from the body's centre along the body's axis; of a race of its own the place where it stands.").hint(PLACE_HINT).example_of("-60 mm"),
    Key::new("bearing.outer_on", Kind::Text, Default { value: "outer_race", reason: "a body of its own, as `[outer_race]` says" }, "The body that carries the outer race; `outer_race`: a body of its own."),
    Key::new("bearing.outer_at", PLACE, Depends("as `inner_at`"), "Where the outer race sits on its body, as `inner_at`; positions in `[outer_race]` count from there. What results say of either race counts X from `inner_at`.").hint(PLACE_HINT).example_of("-60 mm"),
    Key::new("bearing.reversed", Kind::Boolean, Default { value: "false", reason: "the bearing's +X is that of its bodies" }, "Whether the bearing is put in the other way round, turned by half a turn about Z: a contact angle then carries loads along -X on the inner race. Results are in the scene's axes; contact angles count from the side on which the bearing carries."),
    Key::new("body.x.load", FORCE, FREE, "Axial force on the body.").group("condition").hint(LOAD_HINT),
    Key::new("body.x.displacement", DISPLACEMENT, FREE, "Given displacement.").group("condition"),
    Key::new("body.y.load", FORCE, FREE, "Lateral force on the body.").group("condition").hint(LOAD_HINT),
    Key::new("body.y.displacement", DISPLACEMENT, FREE, "Given displacement.").group("condition"),
    Key::new("body.z.load", FORCE, FREE, "Vertical force on the body, up positive.").group("condition").hint(LOAD_HINT),
    Key::new("body.z.displacement", DISPLACEMENT, FREE, "Given displacement.").group("condition"),
    Key::new("body.tilt_y.moment", MOMENT, FREE, "Moment about Y on the body, about its centre.").group("condition").hint(LOAD_HINT),
    Key::new("body.tilt_y.tilt", TILT, FREE, "Given tilt about Y.").group("condition").hint(TILT_HINT),
    Key::new("body.tilt_z.moment", MOMENT, FREE, "Moment about Z on the body, about its centre.").group("condition").hint(LOAD_HINT),
    Key::new("body.tilt_z.tilt", TILT, FREE, "Given tilt about Z.").group("condition").hint(TILT_HINT),
    Key::new("body.speed", SPIN, Depends("a run without speed and torque: 0"), "Speed of the body about its axis. Statics uses it for frequencies and centrifugal force, a run imposes it.").group("rotation"),
    Key::new("body.torque", MOMENT, Optional, "Moment about the body's axis, instead of a speed.").group("rotation").hint(LOAD_HINT),
    Key::new("body.inertia.mass", MASS, ALL_THREE, "Mass of the body with all races that sit on it.").hint(MASS_HINT),
    Key::new("body.inertia.axial", INERTIA, ALL_THREE, "Moment of inertia about its axis.").hint(INERTIA_HINT),
    Key::new("body.inertia.transverse", INERTIA, ALL_THREE, "Moment of inertia across its axis, about its centre.").hint(INERTIA_HINT),
    Key::new("body.rotating_load.force", FORCE, Depends("required with the table"), "Size of the force, over time.").hint(LOAD_HINT),
    Key::new("body.rotating_load.speed", SPIN, Depends("required with the table"), "Speed at which the force turns about X, from +Y towards +Z.").example_of("50 rpm"),
    Key::new("body.rotating_load.phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Default { value: "0 deg", reason: "the force starts along +Y" }, "Direction of the force at the start, from +Y towards +Z."),
    Key::new("body.unbalance", Kind::Quantity(Unbalance, closed(0.0, 1e6, "kg m")), Optional, "Mass times its distance from the axis, turning with the body, at its centre.").hint("mass times eccentricity; 100 N at 1000 rpm is 9.12e-3 kg m"),
    Key::new("body.foundation.stiffness.x", FOUNDATION, NONE, "Spring along X.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.y", FOUNDATION, NONE, "Spring along Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.z", FOUNDATION, NONE, "Spring along Z.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.tilt_y", TILT_FOUNDATION, NO_TURN, "Spring against tilting about Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.tilt_z", TILT_FOUNDATION, NO_TURN, "Spring against tilting about Z.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.x", DASHPOT, NO_DASHPOT, "Dashpot along X.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.y", DASHPOT, NO_DASHPOT, "Dashpot along Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.z", DASHPOT, NO_DASHPOT, "Dashpot along Z.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.tilt_y", TILT_DASHPOT, NO_TURN_DASHPOT, "Dashpot against tilting about Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.tilt_z", TILT_DASHPOT, NO_TURN_DASHPOT, "Dashpot against tilting about Z.").hint(FOUNDATION_HINT),
    Key::new("spring.from", Kind::Text, Required, "The body it begins at, `shaft` for `[body.shaft]`; a race that is a body of its own, `outer_race` or `left.outer_race`; or `ground`. Its axes are those of the spring and turn with it: what holds a turning shaft begins at the `ground`."),
    Key::new("spring.to", Kind::Text, Default { value: "ground", reason: "what does not move" }, "What it ends at, as `from`. Its force and moment there are columns of a run (`forces`)."),
    Key::new("spring.from_at", PLACE, Default { value: "0 mm", reason: "at the centre of the body" }, "Where it begins: distance from the body's or race's centre along its axis; of the ground along X, where the race sits if it ends at one.").hint(PLACE_HINT).example_of("100 mm"),
    Key::new("spring.to_at", PLACE, Depends("at the place where it begins"), "Where it ends, as `from_at`.").hint(PLACE_HINT).example_of("100 mm"),
    Key::new("spring.stiffness.x", FOUNDATION, NONE, "Spring along X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.y", FOUNDATION, NONE, "Spring along Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.z", FOUNDATION, NONE, "Spring along Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.turn_x", TILT_FOUNDATION, NO_TURN, "Spring against turns about X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.turn_y", TILT_FOUNDATION, NO_TURN, "Spring against turns about Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.turn_z", TILT_FOUNDATION, NO_TURN, "Spring against turns about Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.x", DASHPOT, NO_DASHPOT, "Dashpot along X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.y", DASHPOT, NO_DASHPOT, "Dashpot along Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.z", DASHPOT, NO_DASHPOT, "Dashpot along Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.turn_x", TILT_DASHPOT, NO_TURN_DASHPOT, "Dashpot against turns about X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.turn_y", TILT_DASHPOT, NO_TURN_DASHPOT, "Dashpot against turns about Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.turn_z", TILT_DASHPOT, NO_TURN_DASHPOT, "Dashpot against turns about Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.bushing.inner_diameter", SIZE, WITH_BUSHING, "Inner diameter of the rubber.").hint(SIZE_HINT).example_of("71 mm"),
    Key::new("spring.bushing.outer_diameter", SIZE, WITH_BUSHING, "Outer diameter of the rubber.").hint(SIZE_HINT).example_of("91 mm"),
    Key::new("spring.bushing.length", SIZE, WITH_BUSHING, "Length of the rubber along X.").hint(SIZE_HINT).example_of("20 mm"),
    Key::new("spring.bushing.table", Kind::Choice(RUBBERS), Depends("this or `rubber_modulus`"), "Rubber of this table of the source, as in `[solid.material]`: keys given beside it take the place of what it says.").example_of("3.1"),
    Key::new("spring.bushing.rubber_modulus", Kind::Quantity(Stress, closed(1e-6, 1e6, "MPa")), Depends("required without `table`"), "C_R of the network.").hint("the source's rubbers have 0.324 and 0.647 MPa; the shear modulus is 1.085 times it").example_of("0.647 MPa"),
    Key::new("spring.bushing.chain", Kind::Number(above(1.0, 1e6, "")), Depends("8 unless given"), "N, the links of a chain.").example_of("8"),
    Key::new("spring.bushing.bulk_ratio", Kind::Number(closed(1.0, 1e6, "")), Depends("100 unless given"), "Bulk modulus over C_R.").example_of("100"),
    Key::new("spring.bushing.fastest", Kind::Quantity(Frequency, closed(1e-6, 1e9, "Hz")), Default { value: "10 kHz", reason: "faster than bodies on rubber swing" }, "Up to this frequency the springs answer as the rubber does; beyond it they are as stiff as there.").example_of("10 kHz"),
    Key::new("spring.bushing.method", Kind::Choice(METHODS), Default { value: "reduced", reason: "motions are a few hundredths of the wall" }, "`reduced`: the fitted springs. `explicit`: four-node elements in explicit steps beside the bearing, `implicit`: ten-node elements in implicit steps, both with the rubber's mass, at any strain and from rest in the equilibrium of the fitted springs.").example_of("implicit"),
    Key::new("spring.bushing.density", DENSITY, Default { value: "1100 kg/m^3", reason: "the source states none; usual for rubber" }, "Density of the rubber; fitted springs have no mass.").hint("of rubber 900 to 1500 kg/m^3"),
    Key::new("spring.bushing.step_fraction", Kind::Number(closed(1e-3, 0.95, "")), Default { value: "0.8", reason: "below the stability limit" }, "Explicit steps over the longest stable one."),
    Key::new("spring.bushing.step", Kind::Quantity(Time, above(0.0, 1e3, "s")), Depends("as long as bodies and rubber may go without each other, unless given"), "Longest implicit step.").hint("shorter than a twentieth of a swing").example_of("50 us"),
    Key::new("spring.bushing.window_phase", Kind::Number(closed(1e-3, 1.5, "")), Default { value: "0.2", reason: "the exchange is 0.2 % off the frequency of a swing" }, "How far a body may swing on the rubber's sudden stiffness between two exchanges with it, rad: longer windows are cheaper and, in slow motions, as good; beyond 1 coarse explicit elements may make energy, which ends a run.").example_of("0.6"),
    Key::new("spring.bushing.cells.around", CELLS, Default { value: "16", reason: "bushings of 3.4.3 answer within 2 % of an axisymmetric computation" }, "Cells of the mesh around half of the bushing."),
    Key::new("spring.bushing.cells.radial", CELLS, Depends("4; 8 where half of the length is at most 0.3 of the wall, 2 where it is 6 walls or more"), "Cells across the wall, an even number."),
    Key::new("spring.bushing.cells.axial", CELLS, Depends("4; 2 where half of the length is at most 0.3 of the wall, 8 where it is 6 walls or more, 12 from 12 walls on"), "Cells along half of the length."),
    Key::new("spring.bushing.maxwell.gamma", Kind::Number(above(0.0, 1e6, "")), Required, "Stiffness of the element over that of the network."),
    Key::new("spring.bushing.maxwell.relaxation_time", Kind::Quantity(Time, above(0.0, 1e9, "s")), Required, "Time in which its stress falls to 1/e at rest.").hint("of rubber 1 us to 100 s; check the unit").example_of("10 s"),
    Key::new("spring.maxwell.relaxation_time", Kind::Quantity(Time, above(0.0, 1e9, "s")), Required, "Time in which the element's force falls to 1/e at rest.").hint("of rubber 1 us to 100 s; check the unit").example_of("10 ms"),
    Key::new("spring.maxwell.x", FOUNDATION, NONE, "Stiffness along X of the first body before it relaxes.").hint(FOUNDATION_HINT).example_of("2e6 N/m"),
    Key::new("spring.maxwell.y", FOUNDATION, NONE, "The same along Y.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.z", FOUNDATION, NONE, "The same along Z.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.turn_x", TILT_FOUNDATION, NO_TURN, "The same against turns about X.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.turn_y", TILT_FOUNDATION, NO_TURN, "The same against turns about Y.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.turn_z", TILT_FOUNDATION, NO_TURN, "The same against turns about Z.").hint(FOUNDATION_HINT),
];

const CONDITION: &str = "x = { load = \"250 N\" } or { displacement = \"3 um\" }";
const TILT_CONDITION: &str = "tilt_y = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }";

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("body", "A rigid body with an axis of symmetry along X, such as a shaft or a hub: `[body.shaft]`. Any number, each with a name. It stands at the origin.",
        "[body.shaft]\nspeed = \"1000 rpm\"\nz = { load = \"-500 N\" }"),
    table("body.x", "Axial coordinate: a load, or a displacement.", CONDITION),
    table("body.y", "Lateral coordinate.", CONDITION),
    table("body.z", "Vertical coordinate.", CONDITION),
    table("body.tilt_y", "Tilt about Y: a moment, or a tilt.", TILT_CONDITION),
    table("body.tilt_z", "Tilt about Z.", TILT_CONDITION),
    table("body.inertia", "Mass and moments of inertia.", "inertia = { mass = \"2 kg\", axial = \"1e-3 kg m^2\", transverse = \"8e-3 kg m^2\" }"),
    table("body.rotating_load", "A radial force at its centre that turns at its own speed.", "rotating_load = { force = \"250 N\", speed = \"50 rpm\" }"),
    table("body.foundation", "Springs and dashpots between the body's centre and the ground.", "foundation = { stiffness = { x = \"1e8 N/m\" }, damping = { x = \"1000 N s/m\" } }"),
    table("body.foundation.stiffness", "Springs.", "stiffness = { x = \"1e8 N/m\", tilt_y = \"1e4 N m/rad\" }"),
    table("body.foundation.damping", "Dashpots.", "damping = { x = \"1000 N s/m\", tilt_y = \"1 N m s/rad\" }"),
    table("spring", "Springs and dashpots between two bodies, or a body and the ground: `[spring.NAME]`, any number. At rest where the bodies stand at first.",
        "[spring.coupling]\nfrom = \"ground\"\nto = \"shaft\"\nstiffness = { turn_x = \"100 N m/rad\" }"),
    table("spring.stiffness", "Springs along and about the axes of the first body. A run ends where one is stretched by more than a metre or turned by more than 160 deg.", "stiffness = { x = \"1e8 N/m\", turn_y = \"1e4 N m/rad\" }"),
    table("spring.damping", "Dashpots along and about the same axes.", "damping = { x = \"1000 N s/m\", turn_y = \"1 N m s/rad\" }"),
    table("spring.bushing", "A bonded bushing of rubber about X in place of `stiffness` and `maxwell`, between sleeves that are the two bodies: meshed by ten-node elements, its small vibrations solved along, across, about X and tilting, and written as springs and Maxwell elements up to the `fastest` frequency. Results tell how well they fit. It stands for motions of a few hundredths of its wall; `method` puts its elements beside the bearing instead.",
        "[spring.mount.bushing]\ninner_diameter = \"71 mm\"\nouter_diameter = \"91 mm\"\nlength = \"20 mm\"\ntable = \"3.1\""),
    table("spring.bushing.cells", "Cells of its mesh, a quarter of it; they crowd at sleeves and ends.", "cells = { around = 16, radial = 4, axial = 4 }"),
    list_table("spring.bushing.maxwell", "Maxwell elements of the rubber in place of those of `table`; as many as wanted.",
        "[[spring.mount.bushing.maxwell]]\ngamma = 0.492\nrelaxation_time = \"10 s\""),
    list_table("spring.maxwell", "Springs in series with dashpots beside those of `stiffness`, which then is what is left at rest: rubber, by its Prony series. As many as wanted. In motion and in `modes` each has a state of its own; in an equilibrium all have relaxed.",
        "[[spring.mount.maxwell]]\nrelaxation_time = \"10 ms\"\ny = \"2e6 N/m\"\nz = \"2e6 N/m\""),
];
