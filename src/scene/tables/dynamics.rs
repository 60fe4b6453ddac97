//! Rows of the key table for runs: inertias, rotation, foundation, cage, traction, integration.

use crate::plan::channels::ChannelGroup;
use crate::scene::tables::bearing::{
    DENSITY, DENSITY_HINT, DISPLACEMENT, FORCE, LOAD_HINT, MODULUS, MODULUS_HINT, MOMENT, POISSON,
    POISSON_HINT, RADIUS, RADIUS_HINT, SPIN, STEEL_DENSITY, TILT, TILT_HINT, quantity,
};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, open, table};
use crate::scene::tables::solid::{ELASTIC, LAW};
use crate::scene::text::units::Dimension;
use crate::scene::text::units::Dimension::{
    Angle, Frequency, HertzStiffness, InverseSpeed, Mass, Rate, Speed, Stiffness, StiffnessPerArea,
    Time,
};
use Need::{BySet, Default, Depends, Optional};

pub const MOTIONS: &[&str] = &["fixed", "5-dof", "6-dof"];
const MOTION: &str = "outer_race.motion";
const MOVES: &[&str] = &["5-dof", "6-dof"];
pub const POCKETS: &[&str] = &["cylindrical", "spherical"];
pub const CAGE_LAWS: &[&str] = &["penalty", "hertz"];
pub const TRACTION_LAWS: &[&str] = &["none", "constant", "slide-to-roll", "slip-speed"];
pub const DAMPING_LAWS: &[&str] = &["none", "hunt-crossley"];
pub const BALL_CONTACT_LAWS: &[&str] = &["none", "hertz"];
pub const STARTS: &[&str] = &["equilibrium", "nominal"];
pub const INTEGRATORS: &[&str] = &["rk4", "dormand-prince", "rosenbrock"];
/// Names of [`ChannelGroup::ALL`].
pub const CHANNELS: &[&str] = &{
    let mut names = [""; ChannelGroup::ALL.len()];
    let mut i = 0;
    while i < names.len() {
        names[i] = ChannelGroup::ALL[i].name();
        i += 1;
    }
    names
};

pub(crate) const MASS: Kind = Kind::Quantity(Mass, open(0.0, 10_000.0, "kg"));
pub(crate) const INERTIA: Kind = Kind::Quantity(Dimension::Inertia, open(0.0, 1e6, "kg m^2"));
pub(crate) const FOUNDATION: Kind = Kind::Quantity(Stiffness, closed(0.0, 1e13, "N/m"));
pub(crate) const TILT_FOUNDATION: Kind =
    Kind::Quantity(Dimension::TiltStiffness, closed(0.0, 1e13, "N m/rad"));
pub(crate) const DASHPOT: Kind = Kind::Quantity(Dimension::Damping, closed(0.0, 1e10, "N s/m"));
pub(crate) const TILT_DASHPOT: Kind =
    Kind::Quantity(Dimension::TiltDamping, closed(0.0, 1e10, "N m s/rad"));
const FRICTION: Kind = Kind::Number(closed(0.0, 2.0, ""));
/// Below 1e-9 m/s, slip speeds are rounding errors.
const SLIP: Kind = Kind::Quantity(Speed, closed(1e-9, 1e3, "m/s"));
const CURVE_RISE: Kind = Kind::Either(&[
    Kind::Number(closed(0.0, 1e9, "")),
    Kind::Quantity(InverseSpeed, closed(0.0, 1e9, "s/m")),
]);
const CURVE_DECAY: Kind = Kind::Either(&[
    Kind::Number(above(0.0, 1e9, "")),
    Kind::Quantity(InverseSpeed, above(0.0, 1e9, "s/m")),
]);
const CAGE_STIFFNESS: Kind = Kind::Either(&[
    Kind::Quantity(Stiffness, above(0.0, 1e15, "N/m")),
    Kind::Quantity(HertzStiffness, above(0.0, 1e18, "N/m^1.5")),
    Kind::Quantity(StiffnessPerArea, above(0.0, 1e21, "N/m^3")),
]);
pub const CAGE_BODIES: &[&str] = &["rigid", "reduced", "explicit"];
pub const CAGE_CONTACTS: &[&str] = &["surfaces", "nodes"];
const OF_NODES: Need = Depends("4, 2 and 2 if the cage touches by its nodes");
const STEEL_CAGE: Need = Depends("steel: 210 GPa and 0.3");

const FREE: Need = Depends("neither key: the coordinate is free and unloaded");
const NO_SPRING: Need = Default { value: "0 N/m", reason: "no spring" };
const NO_TILT_SPRING: Need = Default { value: "0 N m/rad", reason: "no spring" };
const NO_DASHPOT: Need = Default { value: "0 N s/m", reason: "no dashpot" };
const NO_TILT_DASHPOT: Need = Default { value: "0 N m s/rad", reason: "no dashpot" };
const ALL_THREE: Need = Depends("give all three or none; none: computed from geometry and density");
const LAW_NEEDS: Need = Depends("required if the law has it");
const BOUNDARY: Need = Depends(
    "`slide-to-roll`: usual values for boundary lubrication, 22.28, 181.46, 0.1; `slip-speed`: required",
);

pub(crate) const MASS_HINT: &str = "a positive mass; check the unit";
pub(crate) const INERTIA_HINT: &str = "a positive moment of inertia; check the unit";
const FRICTION_HINT: &str = "friction coefficients of steel are 0.05 to 0.2";
pub(crate) const FOUNDATION_HINT: &str = "stiffness and damping are not negative; check the unit";
const STEP_HINT: &str = "stable steps of steel bearings are 0.1 to 10 us; without `step`, the step follows from `accuracy`";
const SLIP_HINT: &str = "1 to 100 mm/s is usual";

/// Keys of runs, in the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    quantity("bearing.inner_race.shoulder_radius", RADIUS,
        Depends("groove bottom + 20 % of the ball diameter, in a run without `inertia`"),
        "Radius of the shoulders of the groove; used for mass and inertia.").hint(RADIUS_HINT),
    quantity("bearing.outer_race.shoulder_radius", RADIUS,
        Depends("groove bottom - 20 % of the ball diameter, in a run without `inertia`"),
        "Radius of the shoulders of the groove; used for mass and inertia.").hint(RADIUS_HINT),

    Key::new("bearing.cage.pocket", Kind::Choice(POCKETS),
        Default { value: "cylindrical", reason: "radial holes, as in a machined cage" },
        "Shape of the pockets."),
    quantity("bearing.cage.pocket_pitch_radius", RADIUS, Depends("the bearing's pitch radius"),
        "Distance of the pocket centres from the cage axis.").hint(RADIUS_HINT),
    quantity("bearing.cage.length", RADIUS, Depends("follows from mass, density, radii and pockets"),
        "Axial length of the cage.").hint(RADIUS_HINT),
    quantity("bearing.cage.density", DENSITY, STEEL_DENSITY,
        "Density of the cage; determines its length if `length` is not given.").hint(DENSITY_HINT),
    Key::new("bearing.cage.contact.law", Kind::Choice(CAGE_LAWS),
        Default { value: "penalty", reason: "the source's law (5.8)" },
        "Law of the normal force in the cage's contacts: linear in the penetration, or its power 3/2."),
    Key::new("bearing.cage.contact.stiffness", CAGE_STIFFNESS,
        Depends("`penalty`: 2e8 N/m; `hertz`: required"),
        "Stiffness of the cage's contacts: N/m for `penalty` (of each node, if the cage touches by its nodes), N/m^1.5 for `hertz`. N/m^3 is a stiffness per area for nodes, so that the force does not depend on the mesh.")
        .hint("the source has 2e8 N/m (5.8)").example_of("\"2e8 N/m\""),
    Key::new("bearing.cage.body", Kind::Choice(CAGE_BODIES),
        Default { value: "rigid", reason: "a flexible cage costs several times as much" },
        "Cage as a rigid body, or as a flexible one: `reduced` to modes in a rotating frame, or in `explicit` steps of its elements, the source's way and far dearer. A flexible cage touches by the nodes of its mesh."),
    Key::new("bearing.cage.contact.at", Kind::Choice(CAGE_CONTACTS),
        Depends("`surfaces` of a rigid cage, `nodes` of a flexible one"),
        "Contact points of the cage: its geometric `surfaces`, or the `nodes` of its mesh (5.3.2). Nodes of a pocket touch their ball, nodes of the rails outside the pockets' width touch the land of the guiding race."),
    Key::new("bearing.cage.mesh.quarter", Kind::Integer { low: 2, high: 100 }, OF_NODES, "Cells along a quarter of a pocket's edge.").example_of("4"),
    Key::new("bearing.cage.mesh.bar", Kind::Integer { low: 1, high: 100 }, OF_NODES, "Cells from a pocket's edge to the middle of the bar.").example_of("2"),
    Key::new("bearing.cage.mesh.wall", Kind::Integer { low: 1, high: 100 }, OF_NODES, "Cells through the wall.").example_of("2"),
    Key::new("bearing.cage.mesh.order", Kind::Integer { low: 1, high: 2 }, Depends("2 if the cage touches by its nodes"), "Elements of four nodes (1) or ten (2).").example_of("2"),
    quantity("bearing.cage.youngs_modulus", MODULUS, STEEL_CAGE, "Young's modulus of a flexible cage.").hint(MODULUS_HINT),
    Key::new("bearing.cage.poisson_ratio", POISSON, STEEL_CAGE, "Poisson's ratio of a flexible cage.").hint(POISSON_HINT),
    quantity("bearing.cage.modes_to", Kind::Quantity(Frequency, above(0.0, 1e6, "Hz")),
        Depends("15 kHz for a reduced cage"),
        "Highest natural frequency of the free cage that is kept. Static correction modes are added.").example_of("15 kHz"),
    Key::new("bearing.cage.corrections", Kind::Boolean,
        Depends("true for a reduced cage"),
        "True to add static correction modes for both walls of each pocket and for both rails next to it.").example_of("true"),
    quantity("bearing.cage.damping", Kind::Quantity(Rate, closed(0.0, 1e9, "1/s")),
        Depends("0 1/s for a flexible cage"),
        "Mass-proportional damping of the deformation of a flexible cage.").hint("the source has 77 and 100 1/s for housings and shafts").example_of("77 1/s"),
    Key::new("bearing.cage.friction", FRICTION, Default { value: "0.1", reason: "section 5.3.2" },
        "Friction coefficient of the cage's contacts.").hint(FRICTION_HINT).example_of("0.1"),
    quantity("bearing.cage.regularisation_speed", SLIP,
        Default { value: "0.01 m/s", reason: "the source states none" },
        "Sliding speed below which the cage's friction is regularised.").hint(SLIP_HINT),
    quantity("bearing.cage.inertia.axial", INERTIA, Depends("give both or none; none: those of a hollow cylinder of the cage's mass"),
        "Moment of inertia about the cage's axis.").hint(INERTIA_HINT),
    quantity("bearing.cage.inertia.transverse", INERTIA, Depends("give both or none; none: those of a hollow cylinder of the cage's mass"),
        "Moment of inertia about a transverse axis of the cage.").hint(INERTIA_HINT),

    quantity("inner_race.torque", MOMENT, Optional,
        "Moment about the inner race's axis, instead of a speed.").group("rotation").hint(LOAD_HINT),
    quantity("inner_race.inertia.mass", MASS, ALL_THREE, "Mass of the inner race.").hint(MASS_HINT),
    quantity("inner_race.inertia.axial", INERTIA, ALL_THREE, "Moment of inertia about its axis.").hint(INERTIA_HINT),
    quantity("inner_race.inertia.transverse", INERTIA, ALL_THREE, "Moment of inertia about a transverse axis.").hint(INERTIA_HINT),
    quantity("inner_race.added_mass", Kind::Quantity(Mass, closed(0.0, 10_000.0, "kg")), Optional,
        "Point mass that moves with the inner race, such as part of a shaft; no moment of inertia.").hint(MASS_HINT),
    quantity("inner_race.rotating_load.force", FORCE, Depends("required with the table"),
        "Magnitude of the force over time.").hint(LOAD_HINT),
    quantity("inner_race.rotating_load.speed", SPIN,
        Depends("required with the table"), "Rotation speed of the force about X, positive from +Y towards +Z; its direction is the time integral.").example_of("50 rpm"),
    quantity("inner_race.rotating_load.phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
        Default { value: "0 deg", reason: "the force starts along +Y" }, "Direction of the force at t = 0, from +Y towards +Z."),
    quantity("inner_race.unbalance", Kind::Quantity(Dimension::Unbalance, closed(0.0, 1e6, "kg m")), Optional,
        "Unbalance, mass times eccentricity; rotates with the inner race.")
        .hint("mass times eccentricity; 100 N at 1000 rpm is 9.12e-3 kg m"),

    Key::new("outer_race.motion", Kind::Choice(MOTIONS),
        Default { value: "fixed", reason: "the outer race does not move" },
        "Motion of the outer race: none; all coordinates but the rotation about its axis, which `speed` prescribes; or all six."),
    quantity("outer_race.x.load", FORCE, FREE, "Axial force on a moving outer race.").group("x").hint(LOAD_HINT).only(MOTION, MOVES),
    quantity("outer_race.x.displacement", DISPLACEMENT, FREE, "Prescribed displacement; constant if the race is fixed.").group("x"),
    quantity("outer_race.y.load", FORCE, FREE, "Lateral force on a moving outer race.").group("y").hint(LOAD_HINT).only(MOTION, MOVES),
    quantity("outer_race.y.displacement", DISPLACEMENT, FREE, "Prescribed displacement; constant if the race is fixed.").group("y"),
    quantity("outer_race.z.load", FORCE, FREE, "Vertical force on a moving outer race.").group("z").hint(LOAD_HINT).only(MOTION, MOVES),
    quantity("outer_race.z.displacement", DISPLACEMENT, FREE, "Prescribed displacement; constant if the race is fixed.").group("z"),
    quantity("outer_race.tilt_y.moment", MOMENT, FREE, "Moment about Y on a moving outer race.").group("tilt_y").hint(LOAD_HINT).only(MOTION, MOVES),
    quantity("outer_race.tilt_y.tilt", TILT, FREE, "Prescribed tilt; constant if the race is fixed.").group("tilt_y").hint(TILT_HINT),
    quantity("outer_race.tilt_z.moment", MOMENT, FREE, "Moment about Z on a moving outer race.").group("tilt_z").hint(LOAD_HINT).only(MOTION, MOVES),
    quantity("outer_race.tilt_z.tilt", TILT, FREE, "Prescribed tilt; constant if the race is fixed.").group("tilt_z").hint(TILT_HINT),
    quantity("outer_race.speed", SPIN, Depends("`5-dof`: 0; `6-dof`: not allowed"),
        "Rotation speed of an outer race with `motion = \"5-dof\"` about its axis.").group("rotation").only("outer_race.motion", &["5-dof"]),
    quantity("outer_race.torque", MOMENT, Depends("`6-dof`: 0; `5-dof`: not allowed"),
        "Moment about the axis of an outer race with `motion = \"6-dof\"`.").group("rotation").hint(LOAD_HINT).only("outer_race.motion", &["6-dof"]),
    quantity("outer_race.inertia.mass", MASS, ALL_THREE, "Mass of the outer race.").hint(MASS_HINT).only(MOTION, MOVES),
    quantity("outer_race.inertia.axial", INERTIA, ALL_THREE, "Moment of inertia about its axis.").hint(INERTIA_HINT).only(MOTION, MOVES),
    quantity("outer_race.inertia.transverse", INERTIA, ALL_THREE, "Moment of inertia about a transverse axis.").hint(INERTIA_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.stiffness.x", FOUNDATION, NO_SPRING, "Stiffness along X.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.stiffness.y", FOUNDATION, NO_SPRING, "Stiffness along Y.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.stiffness.z", FOUNDATION, NO_SPRING, "Stiffness along Z.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.stiffness.tilt_y", TILT_FOUNDATION, NO_TILT_SPRING, "Tilt stiffness about Y.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.stiffness.tilt_z", TILT_FOUNDATION, NO_TILT_SPRING, "Tilt stiffness about Z.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.damping.x", DASHPOT, NO_DASHPOT, "Damping along X.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.damping.y", DASHPOT, NO_DASHPOT, "Damping along Y.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.damping.z", DASHPOT, NO_DASHPOT, "Damping along Z.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.damping.tilt_y", TILT_DASHPOT, NO_TILT_DASHPOT, "Tilt damping about Y.").hint(FOUNDATION_HINT).only(MOTION, MOVES),
    quantity("outer_race.foundation.damping.tilt_z", TILT_DASHPOT, NO_TILT_DASHPOT, "Tilt damping about Z.").hint(FOUNDATION_HINT).only(MOTION, MOVES),

    Key::new("traction.law", Kind::Choice(TRACTION_LAWS),
        Default { value: "slide-to-roll", reason: "the source does not print its friction curve; this is the usual form" },
        "Friction law between balls and races: none; a constant coefficient; an exponential curve over slide-to-roll ratio or sliding speed."),
    Key::new("traction.coefficient", FRICTION, LAW_NEEDS, "Friction coefficient of `constant`.").hint(FRICTION_HINT).example_of("0.05").only("traction.law", &["none", "constant"]),
    quantity("traction.regularisation_speed", SLIP, LAW_NEEDS, "Sliding speed below which the friction of `constant` is regularised.").hint(SLIP_HINT).only("traction.law", &["none", "constant"]),
    Key::new("traction.b", CURVE_RISE, BOUNDARY,
        "Rise b of the curve (b x - d) exp(-c x) + d. x is the slide-to-roll ratio (b a plain number) or the sliding speed (b in s/m).").example_of("22.28").only("traction.law", &["none", "slide-to-roll", "slip-speed"]),
    Key::new("traction.c", CURVE_DECAY, BOUNDARY, "Decay c of the curve, in the unit of `b`.").example_of("181.46").only("traction.law", &["none", "slide-to-roll", "slip-speed"]),
    Key::new("traction.d", FRICTION, BOUNDARY, "Friction coefficient d at large x.").hint(FRICTION_HINT).example_of("0.1").only("traction.law", &["none", "slide-to-roll", "slip-speed"]),
    quantity("traction.entrainment_floor", SLIP,
        Default { value: "0.01 m/s", reason: "the slide-to-roll ratio is singular at rest" },
        "Lower bound of the entrainment speed in the slide-to-roll ratio.").hint(SLIP_HINT).only("traction.law", &["none", "slide-to-roll"]),
    Key::new("traction.slices", Kind::Integer { low: 1, high: 201 }, Default { value: "15", reason: "error 0.6 % in pure spin" },
        "Slices of the contact ellipse along its major axis, over which slip is integrated. One slice with one point has no friction from spin.").hint("the error in pure spin is 0.6 % with 15 slices and 0.06 % with 45; with rolling and spin under a steep law, up to 10 % with 15"),
    Key::new("traction.points_across", Kind::Integer { low: 1, high: 9 }, BySet { dissertation: ("1", "it varies slip along the ellipse only"), engineering: ("3", "friction from spin within 1 %") },
        "Points across each slice. One point neglects the slip that spin causes across a slice. Friction from pure spin is then too low by the factor 1/E, E the complete elliptic integral of the contact: 2 % for an axis ratio of 8, 5 % for 5, 15 % for 2.3. With additional rolling slip, friction may be too high by as much.").hint("at an axis ratio of 2.3 the error in pure spin is 2 % with two points and 0.8 % with three, if `slices` is large").example_of("3"),

    Key::new("traction.differential_sliding", Kind::Boolean, BySet { dissertation: ("false", "it takes contacts as flat"), engineering: ("true", "most of the friction of a bearing under radial load") },
        "True to include the differential sliding of a ball in its curved groove (Heathcote): the ball rolls without slip on two lines of its contact only, and slides elsewhere."),

    Key::new("contact_damping.law", Kind::Choice(DAMPING_LAWS), Default { value: "none", reason: "the source states no contact damping" },
        "Damping law of the normal contacts between balls and races."),
    quantity("contact_damping.alpha", Kind::Quantity(InverseSpeed, closed(0.0, 1e4, "s/m")), LAW_NEEDS,
        "Coefficient of `hunt-crossley`: F = K d^1.5 (1 + 1.5 alpha v).").hint("steel has 0.08 to 0.32 s/m").only("contact_damping.law", &["none", "hunt-crossley"]),

    Key::new("ball_contact.law", Kind::Choice(BALL_CONTACT_LAWS),
        Default { value: "hertz", reason: "balls without a cage touch as equal spheres" },
        "Contact between neighbouring balls. With `none`, a run ends with an error when balls touch."),
    Key::new("ball_contact.friction", FRICTION,
        Default { value: "0.1", reason: "as in the contacts of the source's cage, section 5.3.2" },
        "Friction coefficient of `hertz`.").hint(FRICTION_HINT).example_of("0.1"),
    quantity("ball_contact.regularisation_speed", SLIP,
        Default { value: "0.01 m/s", reason: "as in the contacts of the cage" },
        "Sliding speed below which the friction between balls is regularised.").hint(SLIP_HINT),

    quantity("numerics.end", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("required for a run"), "Time at which the run ends.").hint("a run of seconds takes seconds to minutes; check the unit"),
    quantity("numerics.step", Kind::Quantity(Time, closed(1e-12, 1e-2, "s")), Optional,
        "Fixed time step; the integrator is `rk4` unless given. Without it, the step follows from `accuracy`, in a scene without bearings from the stability limit.").group("step").hint(STEP_HINT).example_of("1 us"),
    Key::new("numerics.step_fraction", Kind::Number(above(0.0, 1.0, "")),
        Depends("0.5 with `rk4` and no `step`, 0.1 without bearings; not allowed with another integrator"),
        "Time step divided by the stability limit of `rk4`.").group("step").hint("1 is the stability limit; above it the run fails").example_of("0.5").only(LAW, ELASTIC),
    Key::new("numerics.accuracy", Kind::Number(closed(1e-8, 0.1, "")),
        Depends("0.001 without `step`, `step_fraction` and `rk4`; not allowed with `rk4`"),
        "Tolerance of the step-size control: error of the races' motion divided by the largest overlap of a contact.")
        .group("step").hint("0.001 is usual; below 1e-4 the free vibration of an undamped bearing determines the step").example_of("0.001"),
    Key::new("numerics.start", Kind::Choice(STARTS), Default { value: "equilibrium", reason: "no impact at the start" },
        "Initial state: static equilibrium under the loads at t = 0, or nominal positions. Balls and cage roll in both."),
    quantity("numerics.output_interval", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("1/1000 of the run"),
        "Time between output rows.").example_of("0.1 ms"),
    Key::new("numerics.energy_limit", Kind::Number(above(0.0, 1.0, "")), Depends("0.01; with an `accuracy` 0.2"),
        "Largest error of the energy balance, divided by the energy turnover; beyond it the run stops with an error. The turnover is the largest contact energy plus all work and losses; with `accuracy` also the kinetic energy and the energy that passes through the contacts. The balance is checked every 16 steps with `rk4`, otherwise after each step. Five consecutive checks beyond the limit stop the run, in a shorter run the last check.").example_of("0.01").only(LAW, ELASTIC),
    Key::new("numerics.integrator", Kind::Choice(INTEGRATORS), Depends("`rk4` with `step`, `step_fraction` or an explicit housing, or without bearings; otherwise chosen by the plan"),
        "Time integrator: classical Runge-Kutta; the explicit Dormand-Prince method of order 5; a linearly implicit Rosenbrock method for stiff traction and contacts. The latter two take an `accuracy`."),

    Key::new("output.channels", Kind::Choices(CHANNELS),
        Default { value: "races, cage, orbits, loads, pockets, forces, energy", reason: "all but `moments` and `slip`, which has six columns per ball" },
        "Groups of columns of `series.csv`; `energy` is always included. `forces` are the contact forces on each race of a bearing, `moments` their moments about the race's centre."),
    quantity("output.window_start", Kind::Quantity(Time, closed(0.0, 1e4, "s")), Depends("the middle of the run"),
        "Start of the time interval for means and spectra.").example_of("0.05 s"),
];

const TWO_RIVALS: &str = "x = \"3 um\" or { load = \"250 N\" } or { displacement = \"3 um\" }";
const TILT_RIVALS: &str =
    "tilt_y = \"0.15 deg\" or { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }";
const RACE_INERTIA: &str =
    "inertia = { mass = \"0.2 kg\", axial = \"1e-4 kg m^2\", transverse = \"1e-4 kg m^2\" }";

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("bearing.cage.contact", "Normal force of the cage's contacts.", "contact = { law = \"penalty\", stiffness = \"2e8 N/m\" }"),
    table("bearing.cage.mesh", "Mesh of a cage that touches by its nodes, generated from the cage's dimensions.", "mesh = { quarter = 4, bar = 2, wall = 2 }"),
    table("bearing.cage.inertia", "Moments of inertia of the cage.", "inertia = { axial = \"7e-5 kg m^2\", transverse = \"4e-5 kg m^2\" }"),
    table("inner_race.inertia", "Mass and moments of inertia of the inner race.", RACE_INERTIA),
    table("inner_race.rotating_load", "A rotating radial force.",
        "[inner_race.rotating_load]\nforce = \"250 N\"\nspeed = \"50 rpm\""),
    table("outer_race.x", "Axial coordinate: a position, a load, or a prescribed displacement.", TWO_RIVALS),
    table("outer_race.y", "Lateral coordinate.", TWO_RIVALS),
    table("outer_race.z", "Vertical coordinate.", TWO_RIVALS),
    table("outer_race.tilt_y", "Tilt about Y: an angle, a moment, or a prescribed tilt.", TILT_RIVALS),
    table("outer_race.tilt_z", "Tilt about Z.", TILT_RIVALS),
    table("outer_race.inertia", "Mass and moments of inertia of a moving outer race.", RACE_INERTIA),
    table("outer_race.foundation", "Springs and dashpots between a moving outer race and the ground, unstressed in its initial position.",
        "foundation = { stiffness = { x = \"1e8 N/m\" }, damping = { x = \"1000 N s/m\" } }"),
    table("outer_race.foundation.stiffness", "Springs.", "stiffness = { x = \"1e8 N/m\", tilt_y = \"1e4 N m/rad\" }"),
    table("outer_race.foundation.damping", "Dashpots.", "damping = { x = \"1000 N s/m\", tilt_y = \"1 N m s/rad\" }"),
    table("traction", "Friction between balls and races in a run. Keys of a law that is not chosen are refused; `none` allows all keys and ignores them.",
        "[traction]\nlaw = \"constant\"\ncoefficient = 0.05\nregularisation_speed = \"0.01 m/s\""),
    table("contact_damping", "Damping of the contacts between balls and races in a run. Keys of a law that is not chosen are refused, as in `traction`.",
        "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"0.1 s/m\""),
    table("ball_contact", "Contact between balls in a run without a cage. Keys of a law that is not chosen are refused, as in `traction`.",
        "[ball_contact]\nfriction = 0.05"),
    table("numerics", "Numerical settings of a run.", "[numerics]\nend = \"0.1 s\""),
];
