//! Rows of the key table: a bearing's outer race in a flexible housing.

use crate::scene::tables::bearing::{RADIUS, RADIUS_HINT};
use crate::scene::tables::keys::{Key, Kind, Need, Table, above, closed, table};
use crate::scene::text::units::Dimension::{
    Force, Frequency, Length, Stiffness, StiffnessPerArea, Time,
};
use Need::{Default, Depends, Optional};

pub const METHODS: &[&str] = &["quasi-static", "explicit", "reduced", "rigid"];
pub const STARTS: &[&str] = &["undeformed", "equilibrium"];
pub const AXIAL: &[&str] = &["fixed", "free"];
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
    Key::new("housing.method", Kind::Choice(METHODS), Default { value: "quasi-static", reason: "inertia is negligible at usual loads; `plan` estimates its effect" },
        "Coupling of bearing and housing. `quasi-static`: a sequence of equilibria with the housing condensed onto its bore. `explicit`: both integrated, the housing with explicit steps, coupled by impulses. `reduced`: the housing reduced to modes and integrated with the bearing. `rigid`: the outer race is fixed and no mesh is read."),
    Key::new("housing.bore", Kind::Text, Default { value: "bore", reason: "its name in generated housings" },
        "Surface set of the solid in which the outer race is fitted (`inner` for a ring)."),
    Key::new("housing.outer_radius", RADIUS, Optional, "Outer radius of the outer race; the fit is its difference from the bore radius.").hint(RADIUS_HINT).example_of("35.527 mm"),
    Key::new("housing.fit.radial", FIT, FIT_NEED, "Radial interference between outer race and bore; negative is clearance.").group("fit").hint(FIT_HINT),
    Key::new("housing.fit.diametral", FIT, FIT_NEED, "Diametral interference, twice the radial one; negative is clearance.").group("fit").hint(FIT_HINT),
    Key::new("housing.fit_ramp", Kind::Quantity(Time, above(0.0, 1e4, "s")), Depends("`explicit` with interference: 1/10 of the run; otherwise no ramp"),
        "Time over which the interference grows to its full value from the start of a run.").example_of("2 ms"),
    Key::new("housing.start", Kind::Choice(STARTS), Default { value: "undeformed", reason: "as the source's explicit runs" },
        "Initial state for `explicit`: an undeformed housing in which the fit grows, or the equilibrium of all parts under the loads at t = 0, computed with the condensed housing.").only("housing.method", &["explicit"]),
    Key::new("housing.width", RADIUS, Depends("`bearing.length`; without it the length of the bore"), "Width of the outer race in the bore. Only nodes under the race are contact nodes.").hint("a positive width, along the axis; check the unit").example_of("20 mm"),
    Key::new("housing.axial", Kind::Choice(AXIAL), Depends("`fixed`; with friction `free`"),
        "Axial support of the outer race: `fixed` by a shoulder or ring, or `free` except for friction in the bore."),
    Key::new("housing.contact.stiffness", CONTACT_STIFFNESS, Default { value: "2.5e14 N/m^3", reason: "the source's 2.5e8 N/m at nodes of 1 mm^2" },
        "Penalty stiffness (2.19): per area (N/m^3), so that the pressure does not depend on the mesh, or per node (N/m), as in the source.").hint("the source has 2.5e8 N/m per node for steel").example_of("\"2.5e14 N/m^3\""),
    Key::new("housing.friction.law", Kind::Choice(FRICTION_LAWS), Default { value: "none", reason: "a frictionless bore" },
        "Friction law between bore and outer race for `explicit` (4.2.4.2)."),
    Key::new("housing.friction.coefficient", Kind::Number(closed(0.0, 10.0, "")), Default { value: "0.6", reason: "as the source" },
        "Friction coefficient of `stick-slip`; 0 for no friction.").hint("the source has 0.6").example_of("0.6").only("housing.friction.law", &["stick-slip"]),
    Key::new("housing.friction.stretch", Kind::Quantity(Length, above(0.0, 1e3, "um")), Default { value: "0.1 nm", reason: "the source states only \"a large penalty\"; beyond 0.17 nm of penetration the springs are as stiff as the contact" },
        "Tangential displacement at which a contact node slips with `stick-slip`; below it the friction force grows linearly. The tangential spring is never stiffer than the normal contact, so nodes with more penetration slip at a larger displacement.").hint("a fraction of a micrometre; a smaller value gives a stiffer tangential contact").example_of("0.1 nm").only("housing.friction.law", &["stick-slip"]),
    Key::new("housing.modes_to", Kind::Quantity(Frequency, above(0.0, 1e9, "Hz")), Depends("twice the natural frequency of a ball between its races under the largest load on bodies, without loads of `body.NAME.beam`"),
        "Highest natural frequency of the housing modes that `reduced` keeps. Stiffer motion is represented by static correction modes. `modes` lists modes up to 0.4 times the first omitted frequency: within 0.1 % of all.").example_of("40 kHz").only("housing.method", &["reduced"]),
    Key::new("housing.bore_load", Kind::Quantity(Force, above(0.0, 1e12, "N")), Depends("the largest radial load on all bodies at any time, including flexible shafts and unbalances at prescribed speeds"),
        "Radial force of the outer race on the bore for which `reduced` computes static correction modes: in directions all around, centred and off-centre, in addition to the load at t = 0. Set it if `run` warns of a larger force.").example_of("5 kN").only("housing.method", &["reduced"]),
    Key::new("housing.step_fraction", Kind::Number(above(0.0, 1.0, "")), Default { value: "0.8", reason: "below the stability limit of the housing in contact" },
        "Time step of the housing for `explicit`, divided by its stability limit.").example_of("0.8").only("housing.method", &["explicit"]),
    Key::new("housing.coupling_phase", Kind::Number(above(0.0, 1.9, "")), Default { value: "0.125", reason: "energy error 1e-4 of the energy of an impact through clearance" },
        "Length of a coupling step for `explicit`: phase, in rad, of the outer race's oscillation on the bore contact. Stable below 2; the energy error grows with its square.").example_of("0.25").only("housing.method", &["explicit"]),
];

/// Tables in the order of the reference.
#[rustfmt::skip]
pub(crate) const TABLES: &[Table] = &[
    table("housing", "Housing fit: the outer race in the bore of `[solid]`; needs `outer_race.motion = \"5-dof\"`.", "[housing]\nmethod = \"quasi-static\"\nfit = { radial = \"1 um\" }"),
    table("housing.fit", "Interference of the outer race in the bore, either `radial` or `diametral`.",
        "fit = { radial = \"5 um\" } or { diametral = \"10 um\" }"),
    table("housing.contact", "Contact between outer race and bore.", "contact = { stiffness = \"2.5e14 N/m^3\" }"),
    table("housing.friction", "Friction between outer race and bore, with `method = \"explicit\"`.", "friction = { law = \"stick-slip\" }"),
];
