//! Rows of the key table that only a run needs: inertias, rotation, foundation, cage, traction, steps.

use crate::assembly::channels::ChannelGroup;
use crate::scene::tables::bearing::{
    DENSITY, DENSITY_HINT, DISPLACEMENT, FORCE, LOAD_HINT, MOMENT, RADIUS, RADIUS_HINT, SPIN,
    STEEL_DENSITY, TILT, TILT_HINT, quantity,
};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, open, table};
use crate::scene::text::units::Dimension;
use crate::scene::text::units::Dimension::{
    Angle, HertzStiffness, InverseSpeed, Mass, Speed, Stiffness, Time,
};
use Need::{Default, Depends, Optional};

pub const MOTIONS: &[&str] = &["fixed", "5-dof", "6-dof"];
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
/// Below 1e-9 m/s rounding alone makes more slip than that.
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
]);

const FREE: Need = Depends("neither key: the coordinate is free and unloaded");
const NO_SPRING: Need = Default { value: "0 N/m", reason: "no spring" };
const NO_TILT_SPRING: Need = Default { value: "0 N m/rad", reason: "no spring" };
const NO_DASHPOT: Need = Default { value: "0 N s/m", reason: "no dashpot" };
const NO_TILT_DASHPOT: Need = Default { value: "0 N m s/rad", reason: "no dashpot" };
const ALL_THREE: Need = Depends("all three or none; none: from geometry and density");
const LAW_NEEDS: Need = Depends("required by the laws that have it");
const BOUNDARY: Need = Depends(
    "`slide-to-roll`: common boundary-lubrication set 22.28, 181.46, 0.1; `slip-speed`: required",
);

pub(crate) const MASS_HINT: &str = "a positive mass; check the unit";
pub(crate) const INERTIA_HINT: &str = "a positive moment of inertia; check the unit";
const FRICTION_HINT: &str = "friction coefficients of steel are 0.05 to 0.2";
pub(crate) const FOUNDATION_HINT: &str =
    "a spring or dashpot holds back: it is not negative; check the unit";
const STEP_HINT: &str = "stable steps of steel bearings are 0.1 to 10 us; leave it out, and steps follow from an accuracy";
const SLIP_HINT: &str = "friction needs some sliding speed to build up; 1 to 100 mm/s is usual";

/// What moves a bearing, in the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    quantity("bearing.inner_race.shoulder_radius", RADIUS,
        Depends("a run without given inertia: groove bottom + 20 % of the ball diameter"),
        "Radius of the shoulders beside the groove; for mass and inertia.").hint(RADIUS_HINT),
    quantity("bearing.outer_race.shoulder_radius", RADIUS,
        Depends("a run without given inertia: groove bottom - 20 % of the ball diameter"),
        "Radius of the shoulders beside the groove; for mass and inertia.").hint(RADIUS_HINT),

    Key::new("bearing.cage.pocket", Kind::Choice(POCKETS),
        Default { value: "cylindrical", reason: "holes with radial axes, as in a machined cage" },
        "Shape of the pockets."),
    quantity("bearing.cage.pocket_pitch_radius", RADIUS, Depends("the bearing's pitch radius"),
        "Distance of the pockets' centres from the cage's axis.").hint(RADIUS_HINT),
    quantity("bearing.cage.length", RADIUS, Depends("follows from mass, density, radii and pockets"),
        "Axial length of the cage.").hint(RADIUS_HINT),
    quantity("bearing.cage.density", DENSITY, STEEL_DENSITY,
        "Density of the cage; gives its length where that is not given.").hint(DENSITY_HINT),
    Key::new("bearing.cage.contact.law", Kind::Choice(CAGE_LAWS),
        Default { value: "penalty", reason: "the source's law (5.8)" },
        "Normal force of the cage's contacts over the penetration: linear, or to the power 3/2."),
    Key::new("bearing.cage.contact.stiffness", CAGE_STIFFNESS,
        Depends("`penalty`: 2e8 N/m; `hertz`: required"),
        "Stiffness of the cage's contacts: N/m for `penalty`, N/m^1.5 for `hertz`.")
        .hint("(5.8) has 2e8 N/m").example_of("\"2e8 N/m\""),
    Key::new("bearing.cage.friction", FRICTION, Default { value: "0.1", reason: "section 5.3.2" },
        "Friction coefficient of the cage's contacts.").hint(FRICTION_HINT).example_of("0.1"),
    quantity("bearing.cage.regularisation_speed", SLIP,
        Default { value: "0.01 m/s", reason: "the source states none" },
        "Sliding speed below which the cage's friction is rounded off.").hint(SLIP_HINT),
    quantity("bearing.cage.inertia.axial", INERTIA, Depends("both or none; none: a hollow cylinder of the cage's mass"),
        "Moment of inertia about the cage's axis.").hint(INERTIA_HINT),
    quantity("bearing.cage.inertia.transverse", INERTIA, Depends("both or none; none: a hollow cylinder of the cage's mass"),
        "Moment of inertia across the cage's axis.").hint(INERTIA_HINT),

    quantity("inner_race.torque", MOMENT, Optional,
        "Moment about the inner race's axis, instead of a speed.").group("rotation").hint(LOAD_HINT),
    quantity("inner_race.inertia.mass", MASS, ALL_THREE, "Mass of the inner race.").hint(MASS_HINT),
    quantity("inner_race.inertia.axial", INERTIA, ALL_THREE, "Moment of inertia about its axis.").hint(INERTIA_HINT),
    quantity("inner_race.inertia.transverse", INERTIA, ALL_THREE, "Moment of inertia across its axis.").hint(INERTIA_HINT),
    quantity("inner_race.added_mass", Kind::Quantity(Mass, closed(0.0, 10_000.0, "kg")), Optional,
        "Mass that moves with the inner race, such as its part of a shaft; without moment of inertia.").hint(MASS_HINT),
    quantity("inner_race.rotating_load.force", FORCE, Depends("required with the table"),
        "Size of the force, over time.").hint(LOAD_HINT),
    quantity("inner_race.rotating_load.speed", SPIN,
        Depends("required with the table"), "Speed at which the force turns about X, from +Y towards +Z; its direction is the integral over time.").example_of("50 rpm"),
    quantity("inner_race.rotating_load.phase", Kind::Quantity(Angle, closed(-360.0, 360.0, "deg")),
        Default { value: "0 deg", reason: "the force starts along +Y" }, "Direction of the force at the start, from +Y towards +Z."),
    quantity("inner_race.unbalance", Kind::Quantity(Dimension::Unbalance, closed(0.0, 1e6, "kg m")), Optional,
        "Mass times its distance from the axis, turning with the inner race.")
        .hint("mass times eccentricity; 100 N at 1000 rpm is 9.12e-3 kg m"),

    Key::new("outer_race.motion", Kind::Choice(MOTIONS),
        Default { value: "fixed", reason: "the outer race does not move" },
        "Whether the outer race moves: not, all but its rotation, or all six coordinates."),
    quantity("outer_race.x.load", FORCE, FREE, "Axial force on a moving outer race.").group("x").hint(LOAD_HINT),
    quantity("outer_race.x.displacement", DISPLACEMENT, FREE, "Given motion; a plain quantity if the race is fixed.").group("x"),
    quantity("outer_race.y.load", FORCE, FREE, "Lateral force on a moving outer race.").group("y").hint(LOAD_HINT),
    quantity("outer_race.y.displacement", DISPLACEMENT, FREE, "Given motion; a plain quantity if the race is fixed.").group("y"),
    quantity("outer_race.z.load", FORCE, FREE, "Vertical force on a moving outer race.").group("z").hint(LOAD_HINT),
    quantity("outer_race.z.displacement", DISPLACEMENT, FREE, "Given motion; a plain quantity if the race is fixed.").group("z"),
    quantity("outer_race.tilt_y.moment", MOMENT, FREE, "Moment about Y on a moving outer race.").group("tilt_y").hint(LOAD_HINT),
    quantity("outer_race.tilt_y.tilt", TILT, FREE, "Given tilt; a plain quantity if the race is fixed.").group("tilt_y").hint(TILT_HINT),
    quantity("outer_race.tilt_z.moment", MOMENT, FREE, "Moment about Z on a moving outer race.").group("tilt_z").hint(LOAD_HINT),
    quantity("outer_race.tilt_z.tilt", TILT, FREE, "Given tilt; a plain quantity if the race is fixed.").group("tilt_z").hint(TILT_HINT),
    quantity("outer_race.speed", SPIN, Depends("`5-dof`: 0; refused with `6-dof`"),
        "Speed at which an outer race with `motion = \"5-dof\"` turns about its axis.").group("rotation"),
    quantity("outer_race.torque", MOMENT, Depends("`6-dof`: 0; refused with `5-dof`"),
        "Moment about the axis of an outer race with `motion = \"6-dof\"`.").group("rotation").hint(LOAD_HINT),
    quantity("outer_race.inertia.mass", MASS, ALL_THREE, "Mass of the outer race.").hint(MASS_HINT),
    quantity("outer_race.inertia.axial", INERTIA, ALL_THREE, "Moment of inertia about its axis.").hint(INERTIA_HINT),
    quantity("outer_race.inertia.transverse", INERTIA, ALL_THREE, "Moment of inertia across its axis.").hint(INERTIA_HINT),
    quantity("outer_race.foundation.stiffness.x", FOUNDATION, NO_SPRING, "Spring along X.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.stiffness.y", FOUNDATION, NO_SPRING, "Spring along Y.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.stiffness.z", FOUNDATION, NO_SPRING, "Spring along Z.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.stiffness.tilt_y", TILT_FOUNDATION, NO_TILT_SPRING, "Spring against tilting about Y.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.stiffness.tilt_z", TILT_FOUNDATION, NO_TILT_SPRING, "Spring against tilting about Z.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.damping.x", DASHPOT, NO_DASHPOT, "Dashpot along X.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.damping.y", DASHPOT, NO_DASHPOT, "Dashpot along Y.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.damping.z", DASHPOT, NO_DASHPOT, "Dashpot along Z.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.damping.tilt_y", TILT_DASHPOT, NO_TILT_DASHPOT, "Dashpot against tilting about Y.").hint(FOUNDATION_HINT),
    quantity("outer_race.foundation.damping.tilt_z", TILT_DASHPOT, NO_TILT_DASHPOT, "Dashpot against tilting about Z.").hint(FOUNDATION_HINT),

    Key::new("traction.law", Kind::Choice(TRACTION_LAWS),
        Default { value: "slide-to-roll", reason: "the source's friction curve is not printed; its field's usual form is assumed" },
        "Friction between balls and races: none; a constant coefficient; an exponential curve over slide-to-roll ratio or sliding speed."),
    Key::new("traction.coefficient", FRICTION, LAW_NEEDS, "Friction coefficient of `constant`.").hint(FRICTION_HINT).example_of("0.05"),
    quantity("traction.regularisation_speed", SLIP, LAW_NEEDS, "Sliding speed below which `constant` is rounded off.").hint(SLIP_HINT),
    Key::new("traction.b", CURVE_RISE, BOUNDARY,
        "Rise of the curve (b x - d) exp(-c x) + d: a number over the slide-to-roll ratio, s/m over the sliding speed.").example_of("22.28"),
    Key::new("traction.c", CURVE_DECAY, BOUNDARY, "Decay of the curve, as `b`.").example_of("181.46"),
    Key::new("traction.d", FRICTION, BOUNDARY, "Friction coefficient far out on the curve.").hint(FRICTION_HINT).example_of("0.1"),
    quantity("traction.entrainment_floor", SLIP,
        Default { value: "0.01 m/s", reason: "the slide-to-roll ratio is singular at rest" },
        "Least entrainment speed that `slide-to-roll` divides by.").hint(SLIP_HINT),
    Key::new("traction.slices", Kind::Integer { low: 1, high: 201 }, Default { value: "15", reason: "0.6 % of the integral over many slices" },
        "Slices along the contact ellipse over which slip varies. One slice with one point has no friction from spin.").hint("in pure spin 15 slices are within 0.6 % of many, 45 within 0.06 %; where rolling and spin mix under a steep law 15 may be 10 % off"),
    Key::new("traction.points_across", Kind::Integer { low: 1, high: 9 }, Default { value: "1", reason: "the source varies slip along the ellipse only" },
        "Points across each slice. With one, what spin adds across a slice is left out: friction from spin alone comes out low by the factor 1/E, E the complete elliptic integral of the contact (2 % for axes of 8 to 1, 5 % for 5 to 1, 15 % for 2.3 to 1), with rolling slip beside up to as much too high.").hint("in pure spin by many slices two are within 2 % and three within 0.8 % where the axes are 2.3 to 1; with few slices the error of these remains").example_of("3"),

    Key::new("contact_damping.law", Kind::Choice(DAMPING_LAWS), Default { value: "none", reason: "the source states no damping of contacts" },
        "Loss in the normal contacts between balls and races."),
    quantity("contact_damping.alpha", Kind::Quantity(InverseSpeed, closed(0.0, 1e4, "s/m")), LAW_NEEDS,
        "Coefficient of `hunt-crossley`: F = K d^1.5 (1 + 1.5 alpha v).").hint("steel has 0.08 to 0.32 s/m"),

    Key::new("ball_contact.law", Kind::Choice(BALL_CONTACT_LAWS),
        Default { value: "hertz", reason: "balls that no cage keeps apart touch as equal spheres; the source's have cages" },
        "Contact between neighbouring balls. With `none` a run in which they meet ends with an error."),
    Key::new("ball_contact.friction", FRICTION,
        Default { value: "0.1", reason: "as in the contacts of the source's cage, section 5.3.2" },
        "Friction coefficient of `hertz`.").hint(FRICTION_HINT).example_of("0.1"),
    quantity("ball_contact.regularisation_speed", SLIP,
        Default { value: "0.01 m/s", reason: "as in the contacts of the cage" },
        "Sliding speed below which the friction between balls is rounded off.").hint(SLIP_HINT),

    quantity("numerics.end", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("required for a run"), "Time at which the run ends.").hint("a run of seconds takes seconds to minutes; check the unit"),
    quantity("numerics.step", Kind::Quantity(Time, closed(1e-12, 1e-2, "s")), Optional,
        "Fixed step, of `rk4` unless another integrator is given; leave it out, and steps follow from an accuracy.").group("step").hint(STEP_HINT).example_of("1 us"),
    Key::new("numerics.step_fraction", Kind::Number(above(0.0, 1.0, "")),
        Depends("0.5 where `rk4` is written and no `step`; refused with another integrator"),
        "Step as a part of the largest stable one of `rk4`.").group("step").hint("1 is the stability limit; above it the run fails").example_of("0.5"),
    Key::new("numerics.accuracy", Kind::Number(closed(1e-8, 0.1, "")),
        Depends("0.001 where neither `step`, `step_fraction` nor `rk4` is given; refused with `rk4`"),
        "Error wanted in the motion of the races, as a part of the largest overlap of a contact; steps follow from it.")
        .group("step").hint("0.001 is usual; an undamped bearing rings, and below 1e-4 the ringing sets the step").example_of("0.001"),
    Key::new("numerics.start", Kind::Choice(STARTS), Default { value: "equilibrium", reason: "no shock at the start" },
        "Start at the static equilibrium of the loads at t = 0, or in nominal positions; balls and cage roll either way."),
    quantity("numerics.output_interval", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("a thousandth of the run"),
        "Time from one written row to the next.").example_of("0.1 ms"),
    Key::new("numerics.energy_limit", Kind::Number(above(0.0, 1.0, "")), Depends("0.01; with an `accuracy` 0.2"),
        "Energy unaccounted for, as a part of the energy turned over, at which the run is stopped. Turned over is the largest energy in the contacts, all work and losses, and with an `accuracy` also the kinetic energy and what goes into contacts and out again. It is looked at whatever rows are written (with `rk4` every 16 steps, else after each): five looks on end stop the run, at the end of a run that is shorter than that one does.").example_of("0.01"),
    Key::new("numerics.integrator", Kind::Choice(INTEGRATORS), Depends("with a `step` or a `step_fraction`, and in a housing by explicit steps, `rk4`; otherwise what the plan chooses"),
        "Time integration: classical Runge-Kutta; Dormand and Prince's explicit method of fifth order; a linearly implicit one that traction and contacts do not bind. The latter two take an `accuracy`."),

    Key::new("output.channels", Kind::Choices(CHANNELS),
        Default { value: "races, cage, orbits, loads, pockets, forces, energy", reason: "all but `slip`, which has six columns a ball, and `moments`" },
        "Groups of columns of `series.csv`; `energy` is always among them. `forces` are those of all that touches a race in the bearing, `moments` theirs about its centre."),
    quantity("output.window_start", Kind::Quantity(Time, closed(0.0, 1e4, "s")), Depends("the middle of the run"),
        "Time from which means and spectra are taken.").example_of("0.05 s"),
];

const TWO_RIVALS: &str = "x = \"3 um\" or { load = \"250 N\" } or { displacement = \"3 um\" }";
const TILT_RIVALS: &str =
    "tilt_y = \"0.15 deg\" or { moment = \"2.5 N m\" } or { tilt = \"0.15 deg\" }";
const RACE_INERTIA: &str =
    "inertia = { mass = \"0.2 kg\", axial = \"1e-4 kg m^2\", transverse = \"1e-4 kg m^2\" }";

#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("bearing.cage.contact", "Normal force of the cage's contacts.", "contact = { law = \"penalty\", stiffness = \"2e8 N/m\" }"),
    table("bearing.cage.inertia", "Moments of inertia of the cage.", "inertia = { axial = \"7e-5 kg m^2\", transverse = \"4e-5 kg m^2\" }"),
    table("inner_race.inertia", "Mass and moments of inertia of the inner race.", RACE_INERTIA),
    table("inner_race.rotating_load", "A radial force that turns at its own speed.",
        "[inner_race.rotating_load]\nforce = \"250 N\"\nspeed = \"50 rpm\""),
    table("outer_race.x", "Axial coordinate: a position, a load, or a given motion.", TWO_RIVALS),
    table("outer_race.y", "Lateral coordinate.", TWO_RIVALS),
    table("outer_race.z", "Vertical coordinate.", TWO_RIVALS),
    table("outer_race.tilt_y", "Tilt about Y: an angle, a moment, or a given motion.", TILT_RIVALS),
    table("outer_race.tilt_z", "Tilt about Z.", TILT_RIVALS),
    table("outer_race.inertia", "Mass and moments of inertia of a moving outer race.", RACE_INERTIA),
    table("outer_race.foundation", "Springs and dashpots between a moving outer race and the ground, at rest where it starts.",
        "foundation = { stiffness = { x = \"1e8 N/m\" }, damping = { x = \"1000 N s/m\" } }"),
    table("outer_race.foundation.stiffness", "Springs.", "stiffness = { x = \"1e8 N/m\", tilt_y = \"1e4 N m/rad\" }"),
    table("outer_race.foundation.damping", "Dashpots.", "damping = { x = \"1000 N s/m\", tilt_y = \"1 N m s/rad\" }"),
    table("traction", "Friction between balls and races in a run. Keys of another law than the chosen one are refused; `none` takes them all and uses none.",
        "[traction]\nlaw = \"constant\"\ncoefficient = 0.05\nregularisation_speed = \"0.01 m/s\""),
    table("contact_damping", "Loss in the contacts between balls and races in a run; keys as for `traction`.",
        "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"0.1 s/m\""),
    table("ball_contact", "Contact between balls in a run, where no cage keeps them apart; keys as for `traction`.",
        "[ball_contact]\nfriction = 0.05"),
    table("numerics", "How a run is computed.", "[numerics]\nend = \"0.1 s\""),
];
