//! Rows of the key table: a bearing's outer race in a flexible housing.

use crate::scene::tables::bearing::{RADIUS, RADIUS_HINT};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, table};
use crate::scene::text::units::Dimension::{
    Force, Frequency, Length, Stiffness, StiffnessPerArea, Time,
};
use Need::{Default, Depends, Optional};

pub const METHODS: &[&str] = &["quasi-static", "explicit", "reduced", "rigid"];
pub const STARTS: &[&str] = &["undeformed", "equilibrium"];
pub const AXIAL: &[&str] = &["held", "free"];
pub const FRICTION_LAWS: &[&str] = &["none", "stick-slip"];

const FIT: Kind = Kind::Quantity(Length, closed(-10_000.0, 10_000.0, "um"));
const FIT_NEED: Need =
    Depends("one of `radial`, `diametral` and `housing.outer_radius`; none: transition, 0");
const FIT_HINT: &str = "fits are micrometres; check the unit";
const CONTACT_STIFFNESS: Kind = Kind::Either(&[
    Kind::Quantity(StiffnessPerArea, above(0.0, 1e21, "N/m^3")),
    Kind::Quantity(Stiffness, above(0.0, 1e15, "N/m")),
]);

/// In the order of the reference.
#[rustfmt::skip]
pub(crate) const KEYS: &[Key] = &[
    Key::new("housing.method", Kind::Choice(METHODS), Default { value: "quasi-static", reason: "inertia is negligible at usual loads; the plan estimates its part" },
        "How bearing and housing are solved together: one equilibrium after the other with the housing condensed onto its bore, both in explicit steps that exchange impulses, both in the bearing's steps with the housing reduced to some shapes, or not at all: `rigid` fixes the outer race and touches no mesh."),
    Key::new("housing.bore", Kind::Text, Default { value: "bore", reason: "its name in the housings that are made" },
        "Surface set of the solid that holds the outer race (`inner` of a ring)."),
    Key::new("housing.outer_radius", RADIUS, Optional, "Outer radius of the outer race; its difference to the bore is the fit.").hint(RADIUS_HINT).example_of("35.527 mm"),
    Key::new("housing.fit.radial", FIT, FIT_NEED, "Radial interference between outer race and bore; negative is clearance.").group("fit").hint(FIT_HINT),
    Key::new("housing.fit.diametral", FIT, FIT_NEED, "Diametral interference, twice the radial one; negative is clearance.").group("fit").hint(FIT_HINT),
    Key::new("housing.fit_ramp", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("`explicit` with an interference: a tenth of the run; else there from the start"),
        "Time over which an interference grows in from the start of a run.").example_of("2 ms"),
    Key::new("housing.start", Kind::Choice(STARTS), Default { value: "undeformed", reason: "the source's explicit runs start so" },
        "`explicit`: what a run starts from: an undeformed housing into which the fit grows, or the equilibrium of all under the loads at the start, found with the housing condensed."),
    Key::new("housing.width", RADIUS, Depends("`bearing.length`; without it the bore's own"), "Width of the outer race in its seat; nodes of the bore beside it are not touched.").hint("a positive width, along the axis; check the unit").example_of("20 mm"),
    Key::new("housing.axial", Kind::Choice(AXIAL), Depends("`held`; with friction `free`"),
        "What takes an axial force on the outer race: something beside the bore, such as a shoulder or a ring, or nothing but friction."),
    Key::new("housing.contact.stiffness", CONTACT_STIFFNESS, Default { value: "2.5e14 N/m^3", reason: "the source's 2.5e8 N/m at nodes of 1 mm^2" },
        "Penalty stiffness (2.19): by area (N/m^3), so that pressure does not depend on the mesh, or for each node (N/m), as printed.").hint("the source has 2.5e8 N/m a node for steel").example_of("\"2.5e14 N/m^3\""),
    Key::new("housing.friction.law", Kind::Choice(FRICTION_LAWS), Depends("`none`: a smooth bore"),
        "`explicit`: whether bore and outer race stick and slip (4.2.4.2)."),
    Key::new("housing.friction.coefficient", Kind::Number(closed(0.0, 10.0, "")), Default { value: "0.6", reason: "the source's" },
        "`stick-slip`: coefficient at which the bore slips on the outer race. Zero is no friction.").hint("the source has 0.6").example_of("0.6"),
    Key::new("housing.friction.stretch", Kind::Quantity(Length, above(0.0, 1e3, "um")), Default { value: "0.1 nm", reason: "the source says \"a large penalty\" alone; from 0.17 nm of penetration on springs are as stiff as the contact" },
        "`stick-slip`: how far a node of the bore moves along the outer race, against a spring, until it slips: up to there the coefficient grows with the stretch. No spring is stiffer than the contact along its normal, so that deeper nodes slip later.").hint("a part of a micrometre; the shorter, the stiffer the grip").example_of("0.1 nm"),
    Key::new("housing.modes_to", Kind::Quantity(Frequency, above(0.0, 1e9, "Hz")), Depends("twice the natural frequency of a ball between its races under the largest load on bodies; shafts that bend keep theirs to themselves"),
        "`reduced`: natural shapes of the housing up to this frequency move; what is stiffer follows statically, and by a few shapes of its own.").example_of("40 kHz"),
    Key::new("housing.press", Kind::Quantity(Force, above(0.0, 1e12, "N")), Depends("the largest load across their axes on all bodies, shafts and unbalances at given speeds among them, at any time"),
        "`reduced`: shapes of the housing are made for the outer race pressed into its bore by this, all round and with levers, besides what presses it at the start. To be given where something else presses: `run` says so.").example_of("5 kN"),
    Key::new("housing.step_fraction", Kind::Number(above(0.0, 1.0, "")), Default { value: "0.8", reason: "a part of the largest stable step of the housing in contact" },
        "`explicit`: steps of the housing as a part of their stability limit.").example_of("0.8"),
    Key::new("housing.window_phase", Kind::Number(above(0.0, 1.9, "")), Default { value: "0.125", reason: "energy is kept to 1e-4 of what a blow through clearance turns over" },
        "`explicit`: window between two exchanges of impulses, as a phase of the outer race's swing on its seat; stable below 2. Errors of energy go with its square.").example_of("0.25"),
];

/// Tables in the order of the reference.
#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("housing", "The outer race in the bore of `[solid]`; needs `outer_race.motion = \"5-dof\"`.", "[housing]\nmethod = \"quasi-static\"\nfit = { radial = \"1 um\" }"),
    table("housing.fit", "Interference of the outer race in the bore. It must say what it is: `radial` or `diametral`.",
        "fit = { radial = \"5 um\" } or { diametral = \"10 um\" }"),
    table("housing.contact", "Contact between outer race and bore.", "contact = { stiffness = \"2.5e14 N/m^3\" }"),
    table("housing.friction", "Stick and slip between outer race and bore, in explicit steps.", "friction = { law = \"stick-slip\" }"),
];
