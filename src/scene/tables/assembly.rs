//! Rows of the key table: positions of bearings on bodies, rigid bodies other than races, springs between them.

use crate::scene::tables::bearing::{
    DENSITY, DISPLACEMENT, FORCE, LOAD_HINT, MOMENT, SPIN, TILT, TILT_HINT,
};
use crate::scene::tables::dynamics::{
    DASHPOT, FOUNDATION, FOUNDATION_HINT, INERTIA, INERTIA_HINT, MASS, MASS_HINT, TILT_DASHPOT,
    TILT_FOUNDATION,
};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, list_table, open, table};
use crate::scene::tables::solid::RUBBERS;
use crate::scene::text::units::Dimension::{
    Angle, Damping, Frequency, Length, Stiffness, Stress, Time, Unbalance,
};
use Need::{Default, Depends, Optional, Required};

/// Name of a race that is a body of its own.
pub const OWN_RACES: [&str; 2] = ["inner_race", "outer_race"];
/// Name of the fixed frame.
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
const CROSS: Kind = Kind::Quantity(Stiffness, closed(-1e13, 1e13, "N/m"));
const CROSS_DASHPOT: Kind = Kind::Quantity(Damping, closed(-1e10, 1e10, "N s/m"));
const CROSS_HINT: &str = "journal bearings and seals have them, of either sign; check the unit";
const NO_SPRING: Need = Default { value: "0 N/m", reason: "no spring" };
const NO_ROTATIONAL_SPRING: Need = Default { value: "0 N m/rad", reason: "no spring" };
const NO_DASHPOT: Need = Default { value: "0 N s/m", reason: "no dashpot" };
const NO_ROTATIONAL_DASHPOT: Need = Default { value: "0 N m s/rad", reason: "no dashpot" };

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("bearing.inner_on", Kind::Text, Depends("the only `[body.NAME]`; if there is none, `inner_race`"), "Body on which the inner race is mounted, `shaft` for `[body.shaft]`; `inner_race`: the race is a body of its own, described by `[inner_race]`."),
    Key::new("bearing.inner_at", PLACE, Default { value: "0 mm", reason: "at the centre of the body" }, "Position of the inner race: distance of its centre from the body's centre along the body's axis. For a race that is a body of its own, its position along X.").hint(PLACE_HINT).example_of("-60 mm"),
    Key::new("bearing.outer_on", Kind::Text, Default { value: "outer_race", reason: "a body of its own, described by `[outer_race]`" }, "Body on which the outer race is mounted; `outer_race`: the race is a body of its own."),
    Key::new("bearing.outer_at", PLACE, Depends("equal to `inner_at`"), "Position of the outer race on its body, measured like `inner_at`; origin of the positions in `[outer_race]`. Results of both races count X from `inner_at`.").hint(PLACE_HINT).example_of("-60 mm"),
    Key::new("bearing.reversed", Kind::Boolean, Default { value: "false", reason: "the bearing's +X is that of its bodies" }, "True if the bearing is mounted the other way round, rotated by 180 deg about Z. An angular-contact bearing then carries axial loads along -X on the inner race. Results are in the scene's axes; contact angles are positive on the side that carries the load."),
    Key::new("body.x.load", FORCE, FREE, "Axial force on the body.").group("condition").hint(LOAD_HINT),
    Key::new("body.x.displacement", DISPLACEMENT, FREE, "Prescribed displacement.").group("condition"),
    Key::new("body.y.load", FORCE, FREE, "Lateral force on the body.").group("condition").hint(LOAD_HINT),
    Key::new("body.y.displacement", DISPLACEMENT, FREE, "Prescribed displacement.").group("condition"),
    Key::new("body.z.load", FORCE, FREE, "Vertical force on the body, up positive.").group("condition").hint(LOAD_HINT),
    Key::new("body.z.displacement", DISPLACEMENT, FREE, "Prescribed displacement.").group("condition"),
    Key::new("body.tilt_y.moment", MOMENT, FREE, "Moment about Y on the body, about its centre.").group("condition").hint(LOAD_HINT),
    Key::new("body.tilt_y.tilt", TILT, FREE, "Prescribed tilt about Y.").group("condition").hint(TILT_HINT),
    Key::new("body.tilt_z.moment", MOMENT, FREE, "Moment about Z on the body, about its centre.").group("condition").hint(LOAD_HINT),
    Key::new("body.tilt_z.tilt", TILT, FREE, "Prescribed tilt about Z.").group("condition").hint(TILT_HINT),
    Key::new("body.speed", SPIN, Depends("0 in a run without `torque`"), "Rotation speed of the body about its axis. `statics` uses it for frequencies and centrifugal force; a run prescribes it.").group("rotation"),
    Key::new("body.torque", MOMENT, Optional, "Moment about the body's axis, instead of a speed.").group("rotation").hint(LOAD_HINT),
    Key::new("body.inertia.mass", MASS, ALL_THREE, "Mass of the body including all races mounted on it.").hint(MASS_HINT),
    Key::new("body.inertia.axial", INERTIA, ALL_THREE, "Moment of inertia about its axis.").hint(INERTIA_HINT),
    Key::new("body.inertia.transverse", INERTIA, ALL_THREE, "Moment of inertia about a transverse axis through the body's centre.").hint(INERTIA_HINT),
    Key::new("body.rotating_load.force", FORCE, Depends("required with the table"), "Magnitude of the force over time.").hint(LOAD_HINT),
    Key::new("body.rotating_load.speed", SPIN, Depends("required with the table"), "Rotation speed of the force about X, positive from +Y towards +Z.").example_of("50 rpm"),
    Key::new("body.rotating_load.phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")), Default { value: "0 deg", reason: "the force starts along +Y" }, "Direction of the force at t = 0, from +Y towards +Z."),
    Key::new("body.unbalance", Kind::Quantity(Unbalance, closed(0.0, 1e6, "kg m")), Optional, "Unbalance, mass times eccentricity, at the body's centre; rotates with the body.").hint("mass times eccentricity; 100 N at 1000 rpm is 9.12e-3 kg m"),
    Key::new("body.foundation.stiffness.x", FOUNDATION, NO_SPRING, "Stiffness along X.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.y", FOUNDATION, NO_SPRING, "Stiffness along Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.z", FOUNDATION, NO_SPRING, "Stiffness along Z.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.tilt_y", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Tilt stiffness about Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.stiffness.tilt_z", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Tilt stiffness about Z.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.x", DASHPOT, NO_DASHPOT, "Damping along X.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.y", DASHPOT, NO_DASHPOT, "Damping along Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.z", DASHPOT, NO_DASHPOT, "Damping along Z.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.tilt_y", TILT_DASHPOT, NO_ROTATIONAL_DASHPOT, "Tilt damping about Y.").hint(FOUNDATION_HINT),
    Key::new("body.foundation.damping.tilt_z", TILT_DASHPOT, NO_ROTATIONAL_DASHPOT, "Tilt damping about Z.").hint(FOUNDATION_HINT),
    Key::new("spring.from", Kind::Text, Required, "First body: `shaft` for `[body.shaft]`, a race that is a body of its own (`outer_race`, `left.outer_race`), or `ground`. The spring acts along this body's axes, which rotate with it. Use `ground` here for a support of a rotating shaft."),
    Key::new("spring.to", Kind::Text, Default { value: "ground", reason: "the fixed frame" }, "Second body, as for `from`. The spring's force and moment on it are columns of a run (`forces`)."),
    Key::new("spring.from_at", PLACE, Default { value: "0 mm", reason: "at the centre of the body" }, "Attachment point on `from`: distance from the centre of the body or race along its axis. On the ground: position along X, by default that of the race if the spring ends at one.").hint(PLACE_HINT).example_of("100 mm"),
    Key::new("spring.to_at", PLACE, Depends("the same point as `from_at`"), "Attachment point on `to`, measured like `from_at`.").hint(PLACE_HINT).example_of("100 mm"),
    Key::new("spring.stiffness.x", FOUNDATION, NO_SPRING, "Stiffness along X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.y", FOUNDATION, NO_SPRING, "Stiffness along Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.z", FOUNDATION, NO_SPRING, "Stiffness along Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.turn_x", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Rotational stiffness about X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.turn_y", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Rotational stiffness about Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.turn_z", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Rotational stiffness about Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.stiffness.yz", CROSS, NO_SPRING, "Cross-coupled stiffness: force along Y per displacement along Z, F_y = -K_yz z.").hint(CROSS_HINT),
    Key::new("spring.stiffness.zy", CROSS, NO_SPRING, "Cross-coupled stiffness: force along Z per displacement along Y, F_z = -K_zy y. If it differs from `yz`, the force is circulatory: runs and `modes` have it, `statics` refuses it, and the equilibrium at the start of a run or of `modes` is that of the mean of both.").hint(CROSS_HINT),
    Key::new("spring.damping.x", DASHPOT, NO_DASHPOT, "Damping along X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.y", DASHPOT, NO_DASHPOT, "Damping along Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.z", DASHPOT, NO_DASHPOT, "Damping along Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.turn_x", TILT_DASHPOT, NO_ROTATIONAL_DASHPOT, "Rotational damping about X of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.turn_y", TILT_DASHPOT, NO_ROTATIONAL_DASHPOT, "Rotational damping about Y of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.turn_z", TILT_DASHPOT, NO_ROTATIONAL_DASHPOT, "Rotational damping about Z of the first body.").hint(FOUNDATION_HINT),
    Key::new("spring.damping.yz", CROSS_DASHPOT, NO_DASHPOT, "Cross-coupled damping: force along Y per velocity along Z.").hint(CROSS_HINT),
    Key::new("spring.damping.zy", CROSS_DASHPOT, NO_DASHPOT, "Cross-coupled damping: force along Z per velocity along Y.").hint(CROSS_HINT),
    Key::new("spring.bushing.inner_diameter", SIZE, WITH_BUSHING, "Inner diameter of the rubber.").hint(SIZE_HINT).example_of("71 mm"),
    Key::new("spring.bushing.outer_diameter", SIZE, WITH_BUSHING, "Outer diameter of the rubber.").hint(SIZE_HINT).example_of("91 mm"),
    Key::new("spring.bushing.length", SIZE, WITH_BUSHING, "Length of the rubber along X.").hint(SIZE_HINT).example_of("20 mm"),
    Key::new("spring.bushing.table", Kind::Choice(RUBBERS), Depends("required without `rubber_modulus`"), "Rubber of this table of the source, as in `[solid.material]`. Other keys of the rubber override its values.").example_of("3.1"),
    Key::new("spring.bushing.rubber_modulus", Kind::Quantity(Stress, closed(1e-6, 1e6, "MPa")), Depends("required without `table`"), "Modulus C_R of the eight-chain network.").hint("the source's rubbers have 0.324 and 0.647 MPa; the shear modulus is 1.085 times it").example_of("0.647 MPa"),
    Key::new("spring.bushing.chain", Kind::Number(above(1.0, 1e6, "")), Depends("8"), "Number N of links in a chain.").example_of("8"),
    Key::new("spring.bushing.bulk_ratio", Kind::Number(closed(1.0, 1e6, "")), Depends("100"), "Bulk modulus divided by C_R.").example_of("100"),
    Key::new("spring.bushing.fastest", Kind::Quantity(Frequency, closed(1e-6, 1e9, "Hz")), Default { value: "10 kHz", reason: "above the natural frequencies of bodies on rubber mounts" }, "Highest frequency of the fit. Above it the stiffness is constant.").example_of("10 kHz"),
    Key::new("spring.bushing.method", Kind::Choice(METHODS), Default { value: "reduced", reason: "valid for displacements of a few hundredths of the wall" }, "`reduced`: fitted springs. `explicit`: four-node elements with explicit integration. `implicit`: ten-node elements with implicit integration. Both element methods include the rubber's mass and large strains, and start at rest in the equilibrium of the fitted springs.").example_of("implicit"),
    Key::new("spring.bushing.density", DENSITY, Default { value: "1100 kg/m^3", reason: "the source states none; usual for rubber" }, "Density of the rubber; fitted springs have no mass.").hint("rubber has 900 to 1500 kg/m^3").only("spring.bushing.method", &["explicit", "implicit"]),
    Key::new("spring.bushing.step_fraction", Kind::Number(closed(1e-3, 0.95, "")), Default { value: "0.8", reason: "below the stability limit" }, "Explicit step divided by the stability limit.").only("spring.bushing.method", &["explicit"]),
    Key::new("spring.bushing.step", Kind::Quantity(Time, above(0.0, 1e3, "s")), Depends("the coupling step"), "Longest implicit step.").hint("shorter than a twentieth of an oscillation period").example_of("50 us").only("spring.bushing.method", &["implicit"]),
    Key::new("spring.bushing.coupling_phase", Kind::Number(closed(1e-3, 1.5, "")), Default { value: "0.2", reason: "0.2 % error of the frequency of a body on the rubber" }, "Length of a coupling step between bodies and rubber: phase, in rad, of a body's oscillation on the rubber's instantaneous stiffness. Longer coupling steps are cheaper and as accurate in slow motions. Beyond 1, coarse explicit elements may generate energy, which ends a run.").example_of("0.6").only("spring.bushing.method", &["explicit", "implicit"]),
    Key::new("spring.bushing.cells.around", CELLS, Default { value: "16", reason: "stiffness of the bushings of 3.4.3 within 2 % of an axisymmetric computation" }, "Cells around half of the circumference."),
    Key::new("spring.bushing.cells.radial", CELLS, Depends("4; 8 if half the length is at most 0.3 of the wall, 2 if it is 6 walls or more"), "Cells across the wall, an even number."),
    Key::new("spring.bushing.cells.axial", CELLS, Depends("4; 2 if half the length is at most 0.3 of the wall, 8 if it is 6 walls or more, 12 if 12 walls or more"), "Cells along half of the length."),
    Key::new("spring.bushing.maxwell.gamma", Kind::Number(above(0.0, 1e6, "")), Required, "Stiffness of the Maxwell element divided by that of the network."),
    Key::new("spring.bushing.maxwell.relaxation_time", Kind::Quantity(Time, above(0.0, 1e9, "s")), Required, "Relaxation time: the stress falls to 1/e at constant strain.").hint("rubber has 1 us to 100 s; check the unit").example_of("10 s"),
    Key::new("spring.maxwell.relaxation_time", Kind::Quantity(Time, above(0.0, 1e9, "s")), Required, "Relaxation time: the force falls to 1/e at constant displacement.").hint("rubber has 1 us to 100 s; check the unit").example_of("10 ms"),
    Key::new("spring.maxwell.x", FOUNDATION, NO_SPRING, "Instantaneous stiffness along X of the first body.").hint(FOUNDATION_HINT).example_of("2e6 N/m"),
    Key::new("spring.maxwell.y", FOUNDATION, NO_SPRING, "Instantaneous stiffness along Y.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.z", FOUNDATION, NO_SPRING, "Instantaneous stiffness along Z.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.turn_x", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Instantaneous rotational stiffness about X.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.turn_y", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Instantaneous rotational stiffness about Y.").hint(FOUNDATION_HINT),
    Key::new("spring.maxwell.turn_z", TILT_FOUNDATION, NO_ROTATIONAL_SPRING, "Instantaneous rotational stiffness about Z.").hint(FOUNDATION_HINT),
];

const CONDITION: &str = "x = { load = \"250 N\" } or { displacement = \"3 um\" }";
const TILT_CONDITION: &str = "tilt_y = { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }";

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("body", "A rigid body with an axis of symmetry along X, such as a shaft or a hub: `[body.shaft]`. Any number, each with a name. Its centre is at the origin.",
        "[body.shaft]\nspeed = \"1000 rpm\"\nz = { load = \"-500 N\" }"),
    table("body.x", "Axial coordinate: a load, or a displacement.", CONDITION),
    table("body.y", "Lateral coordinate.", CONDITION),
    table("body.z", "Vertical coordinate.", CONDITION),
    table("body.tilt_y", "Tilt about Y: a moment, or a tilt.", TILT_CONDITION),
    table("body.tilt_z", "Tilt about Z.", TILT_CONDITION),
    table("body.inertia", "Mass and moments of inertia.", "inertia = { mass = \"2 kg\", axial = \"1e-3 kg m^2\", transverse = \"8e-3 kg m^2\" }"),
    table("body.rotating_load", "A rotating radial force at the body's centre.", "rotating_load = { force = \"250 N\", speed = \"50 rpm\" }"),
    table("body.foundation", "Springs and dashpots between the body's centre and the ground.", "foundation = { stiffness = { x = \"1e8 N/m\" }, damping = { x = \"1000 N s/m\" } }"),
    table("body.foundation.stiffness", "Springs.", "stiffness = { x = \"1e8 N/m\", tilt_y = \"1e4 N m/rad\" }"),
    table("body.foundation.damping", "Dashpots.", "damping = { x = \"1000 N s/m\", tilt_y = \"1 N m s/rad\" }"),
    table("spring", "Springs and dashpots between two bodies, or a body and the ground: `[spring.NAME]`, any number. Unstressed in the initial position of the bodies.",
        "[spring.coupling]\nfrom = \"ground\"\nto = \"shaft\"\nstiffness = { turn_x = \"100 N m/rad\" }"),
    table("spring.stiffness", "Stiffnesses along and about the axes of the first body. A run ends with an error at a deflection above 1 m or a rotation above 160 deg.", "stiffness = { x = \"1e8 N/m\", turn_y = \"1e4 N m/rad\" }"),
    table("spring.damping", "Damping along and about the axes of the first body.", "damping = { x = \"1000 N s/m\", turn_y = \"1 N m s/rad\" }"),
    table("spring.bushing", "A bonded rubber bushing about X between two bodies, which are its sleeves; instead of `stiffness` and `maxwell`. Its complex stiffness in axial, radial, torsional and tilting motion is computed with ten-node elements and fitted by springs and Maxwell elements up to the `fastest` frequency. Results include the error of the fit. The fit is valid for displacements of a few hundredths of the wall; for larger ones set `method`.",
        "[spring.mount.bushing]\ninner_diameter = \"71 mm\"\nouter_diameter = \"91 mm\"\nlength = \"20 mm\"\ntable = \"3.1\""),
    table("spring.bushing.cells", "Cells of the mesh of a quarter of the bushing, refined towards sleeves and ends.", "cells = { around = 16, radial = 4, axial = 4 }"),
    list_table("spring.bushing.maxwell", "Maxwell elements of the rubber, any number; they replace those of `table`.",
        "[[spring.mount.bushing.maxwell]]\ngamma = 0.492\nrelaxation_time = \"10 s\""),
    list_table("spring.maxwell", "Prony series of rubber: Maxwell elements (spring and dashpot in series), any number, parallel to `stiffness`, which is then the relaxed stiffness. In runs and `modes` each element has a state of its own; in an equilibrium all are relaxed.",
        "[[spring.mount.maxwell]]\nrelaxation_time = \"10 ms\"\ny = \"2e6 N/m\"\nz = \"2e6 N/m\""),
];
