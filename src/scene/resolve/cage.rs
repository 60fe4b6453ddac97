//! The cage: its sizes, and its rigid body in a run.

use crate::assembly::bearing_alone::CageBody;
use crate::ch2_housing::bearing::cage::{CageContacts, CageForce, Guidance, Pocket};
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::inertia::{Inertia, hollow_cylinder};
use crate::ch2_housing::bore_contact::Penalty;
use crate::mesh;
use crate::scene::error::{Problem, SceneError, mm};
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::dynamics::{check_inertia, millimetres};
use crate::scene::resolve::resolved::{Cage, CageInRun, CageMethod, Dimensions, FlexibleCage};
use crate::scene::text::value::Checked;
use std::f64::consts::PI;

/// The cage as far as it is given.
pub(crate) fn cage(
    reader: &Reader,
    geometry: &BearingGeometry,
    sizes: &Dimensions,
) -> Result<Option<Cage>, SceneError> {
    let guidance = reader.choice_if_given("bearing.cage.guidance").map(|word| match word {
        "outer-race" => Guidance::OuterRace,
        "inner-race" => Guidance::InnerRace,
        _ => Guidance::Balls,
    });
    let cage = Cage {
        pocket_radius: reader.given_number("bearing.cage.pocket_radius"),
        inner_radius: reader.given_number("bearing.cage.inner_radius"),
        outer_radius: reader.given_number("bearing.cage.outer_radius"),
        race_clearance: reader.given_number("bearing.cage.race_clearance"),
        mass: reader.given_number("bearing.cage.mass"),
        guidance,
    };
    if cage == Cage::default() {
        return Ok(None);
    }
    if let Some(pocket) = cage.pocket_radius
        && pocket < geometry.ball_radius
    {
        let (pocket, ball) = (mm(pocket), mm(geometry.ball_radius));
        let problem = Problem::Contradiction(format!(
            "the pocket radius {pocket} is smaller than the ball radius {ball}. Allowed: at least {ball}. Hint: a ball must fit \
             its pocket"
        ));
        return Err(reader.document.error("bearing.cage.pocket_radius", problem));
    }
    if let Some(pocket) = cage.pocket_radius {
        // Half the distance between pockets at the radius of their centres.
        let pitch = reader.given_number("bearing.cage.pocket_pitch_radius");
        let room =
            pitch.unwrap_or(geometry.pitch_radius) * libm::sin(PI / geometry.ball_count as f64);
        if pocket >= room {
            let other = ("half the distance between centres of pockets", room);
            let hint = "pockets would run into each other, with no bar between them; check radius, not diameter, and the number \
                        of balls";
            let problem = Problem::order(pocket, "less than", other, hint);
            return Err(reader.document.error("bearing.cage.pocket_radius", problem));
        }
    }
    if let (Some(inner), Some(outer)) = (cage.inner_radius, cage.outer_radius)
        && inner >= outer
    {
        let other = ("the cage's outer radius", outer);
        let problem = Problem::order(inner, "less than", other, "are the two exchanged?");
        return Err(reader.document.error("bearing.cage.inner_radius", problem));
    }
    check_between_races(reader, &cage, geometry.pitch_radius, sizes)?;
    Ok(Some(cage))
}

/// Checks that the cage is between the races: inside the shoulders if they are given, else inside the groove bottoms; a
/// guiding race is farther by its clearance.
fn check_between_races(
    reader: &Reader,
    cage: &Cage,
    pitch: f64,
    sizes: &Dimensions,
) -> Result<(), SceneError> {
    let shoulder = |race: &str| reader.given_number(&format!("bearing.{race}.shoulder_radius"));
    let sides = [
        (
            "bearing.cage.outer_radius",
            cage.outer_radius,
            1.0,
            shoulder("outer_race"),
            sizes.outer_race.radius,
            Guidance::OuterRace,
            ["less than", "the outer race's shoulder radius", "the outer race's groove radius"],
        ),
        (
            "bearing.cage.inner_radius",
            cage.inner_radius,
            -1.0,
            shoulder("inner_race"),
            sizes.inner_race.radius,
            Guidance::InnerRace,
            ["more than", "the inner race's shoulder radius", "the inner race's groove radius"],
        ),
    ];
    for (key, radius, outward, shoulder, bottom, guide, [relation, of_shoulder, of_bottom]) in sides
    {
        let Some(radius) = radius else { continue };
        // A shoulder on the wrong side of the balls is reported elsewhere.
        let shoulder = shoulder.filter(|shoulder| (shoulder - pitch) * outward > 0.0);
        let (other_name, other) = match shoulder {
            Some(shoulder) => (of_shoulder, shoulder),
            None => (of_bottom, bottom),
        };
        let overlaps = |value: f64, other: f64| (other - value) * outward <= 0.0;
        if overlaps(radius, other) {
            let advice = "a cage is between the races; check radius, not diameter, and unit";
            let problem = Problem::order(radius, relation, (other_name, other), advice);
            return Err(reader.document.error(key, problem));
        }
        // Radius of the guiding surface of the race.
        let land = radius + outward * cage.race_clearance.unwrap_or(0.0);
        if cage.guidance == Some(guide) && overlaps(land, bottom) {
            let advice = "this is the sum of the cage's radius and race_clearance, at which the race \
                          guides it; a race ends at its groove";
            let problem = Problem::order(land, relation, (of_bottom, bottom), advice);
            return Err(reader.document.error("bearing.cage.race_clearance", problem));
        }
        // Balls hold the cage only where it has more room to the races than they have in their pockets.
        let room = cage.race_clearance.unwrap_or((other - radius) * outward);
        if let (Some(Guidance::Balls), Some(pocket)) = (cage.guidance, cage.pocket_radius)
            && pocket - sizes.nominal_ball_radius >= room
        {
            let advice = "this is the room of a ball in its pocket: with so much the cage meets a race \
                          first; write which one in `guidance`";
            let play = pocket - sizes.nominal_ball_radius;
            let room = ("the room between the cage and a race", room);
            let problem = Problem::order(play, "less than", room, advice);
            return Err(reader.document.error("bearing.cage.pocket_radius", problem));
        }
    }
    Ok(())
}

/// The cage of a run, or the reason why there is none.
pub(crate) fn in_run(
    reader: &mut Reader,
    geometry: &BearingGeometry,
    cage: Option<&Cage>,
) -> Result<CageInRun, SceneError> {
    let given_inertia = given_inertia(reader)?;
    let force = force(reader)?;
    let pitch = pocket_pitch(reader, geometry)?;
    let Some(cage) = cage else {
        return Ok(CageInRun::LeftOut("the scene has no cage".to_string()));
    };
    let needs_clearance = cage.guidance.is_some_and(|guidance| guidance != Guidance::Balls);
    let missing: Vec<&str> = [
        ("pocket_radius", cage.pocket_radius.is_none()),
        ("inner_radius", cage.inner_radius.is_none()),
        ("outer_radius", cage.outer_radius.is_none()),
        ("mass", cage.mass.is_none()),
        ("guidance", cage.guidance.is_none()),
        ("race_clearance", needs_clearance && cage.race_clearance.is_none()),
    ]
    .into_iter()
    .filter_map(|(name, missing)| missing.then_some(name))
    .collect();
    let (Some(pocket_radius), Some(inner), Some(outer), Some(mass), Some(guidance), true) = (
        cage.pocket_radius,
        cage.inner_radius,
        cage.outer_radius,
        cage.mass,
        cage.guidance,
        missing.is_empty(),
    ) else {
        let reason = format!("the scene gives no {} of the cage", missing.join(", "));
        return Ok(CageInRun::LeftOut(reason));
    };
    let density = reader.number("bearing.cage.density");
    let length = match reader.given_number("bearing.cage.length") {
        Some(length) => length,
        None => {
            let pockets = geometry.ball_count as f64 * pocket_volume(pocket_radius, inner, outer);
            let length = (mass / density + pockets) / (PI * (outer * outer - inner * inner));
            let reason = "follows from the cage's mass, density, radii and pockets";
            reader.number_or("bearing.cage.length", length, &millimetres(length), reason)
        }
    };
    let [axial, transverse] = given_inertia.unwrap_or_else(|| {
        let full = hollow_cylinder(inner, outer, length, density);
        let value = format!(
            "axial {:.4e} kg m^2, transverse {:.4e} kg m^2",
            full.axial / full.mass * mass,
            full.transverse / full.mass * mass
        );
        let [axial, transverse] =
            [full.axial / full.mass * mass, full.transverse / full.mass * mass];
        reader
            .note("bearing.cage.inertia", &value, "a hollow cylinder of the cage's mass")
            .fill("bearing.cage.inertia.axial", axial)
            .fill("bearing.cage.inertia.transverse", transverse);
        [axial, transverse]
    });
    let pocket = match reader.choice("bearing.cage.pocket") {
        "spherical" => Pocket::Spherical,
        _ => Pocket::Cylindrical,
    };
    let contacts = CageContacts {
        pocket,
        pocket_radius,
        pocket_pitch_radius: pitch.unwrap_or_else(|| {
            let reason = "the pockets are on the bearing's pitch circle";
            let value = millimetres(geometry.pitch_radius);
            let key = "bearing.cage.pocket_pitch_radius";
            reader.number_or(key, geometry.pitch_radius, &value, reason)
        }),
        guidance,
        ring: [inner, outer],
        guide_radius: if guidance == Guidance::InnerRace { inner } else { outer },
        race_clearance: cage.race_clearance.unwrap_or(0.0),
        length,
        force: force.unwrap_or_else(|| {
            let reason = "the source's stiffness (5.8), there at each node of a flexible cage";
            let (key, stiffness) = ("bearing.cage.contact.stiffness", 2e8);
            reader.note(key, "2e8 N/m", reason).fill(key, Checked::Either(0, stiffness));
            CageForce::Penalty { stiffness }
        }),
        friction: reader.number("bearing.cage.friction"),
        regularisation_speed: reader.number("bearing.cage.regularisation_speed"),
    };
    Ok(CageInRun::Body(CageBody { inertia: Inertia { mass, axial, transverse }, contacts }))
}

/// A cage that touches by the nodes of its mesh, if the scene asks for one.
pub(crate) fn flexible(
    reader: &mut Reader,
    geometry: &BearingGeometry,
    cage: &CageInRun,
) -> Result<Option<FlexibleCage>, SceneError> {
    let method = match reader.choice_if_given("bearing.cage.body") {
        Some("reduced") => CageMethod::Reduced,
        Some("explicit") => CageMethod::Explicit,
        _ => CageMethod::Rigid,
    };
    let (reduced, flexible) = (method == CageMethod::Reduced, method != CageMethod::Rigid);
    let at = reader.choice_if_given("bearing.cage.contact.at");
    let path = "bearing.cage.contact.stiffness";
    let per_area = match reader.document.value(path) {
        Some(Checked::Either(2, stiffness)) => Some(*stiffness),
        _ => None,
    };
    let by_nodes = flexible || at == Some("nodes");
    if !by_nodes {
        if per_area.is_some() {
            let reason = "a stiffness per area is for a cage that touches by its nodes. Hint: write `at = \"nodes\"` in [bearing.cage.contact], or a stiffness in N/m";
            return Err(reader.document.refused(path, reason));
        }
        return Ok(None);
    }
    let refuse = |key: &str, reason: &str| {
        Err(reader.document.refused(&format!("bearing.cage.{key}"), reason))
    };
    if flexible && at == Some("surfaces") {
        return refuse(
            "contact.at",
            "a flexible cage touches by the nodes of its mesh. Hint: leave it out, or write `body = \"rigid\"`",
        );
    }
    if reader.choice_if_given("bearing.cage.contact.law") == Some("hertz") {
        return refuse(
            "contact.law",
            "nodes touch by the penalty of (5.8). Hint: write `law = \"penalty\"`, or leave it out",
        );
    }
    if reader.choice_if_given("bearing.cage.pocket") == Some("spherical") {
        return refuse(
            "pocket",
            "the mesh of a cage has cylindrical pockets. Hint: leave it out: the mesh has round pockets with radial axes",
        );
    }
    let CageInRun::Body(CageBody { contacts, inertia }) = cage else { return Ok(None) };
    let shape = mesh::generate::Cage {
        pocket_count: geometry.ball_count,
        pocket_radius: contacts.pocket_radius,
        inner_radius: contacts.ring[0],
        outer_radius: contacts.ring[1],
        width: contacts.length,
        relief: None,
    };
    let count = |reader: &Reader, key: &str, usual: usize| {
        let given = reader.given_number(&format!("bearing.cage.mesh.{key}"));
        given.map_or(usual, |count| count as usize)
    };
    let cells = mesh::generate::CageMesh {
        quarter: count(reader, "quarter", 4),
        bar: count(reader, "bar", 2),
        wall: count(reader, "wall", 2),
    };
    let pockets = geometry.ball_count as f64
        * pocket_volume(contacts.pocket_radius, contacts.ring[0], contacts.ring[1]);
    let [inner, outer] = contacts.ring;
    let volume = PI * (outer * outer - inner * inner) * contacts.length - pockets;
    let order = count(reader, "order", 2);
    let counts =
        [("quarter", cells.quarter), ("bar", cells.bar), ("wall", cells.wall), ("order", order)];
    for (key, count) in counts {
        reader.follow(&format!("bearing.cage.mesh.{key}"), count as f64);
    }
    reader.follow("bearing.cage.contact.at", "nodes");
    let mut given = |key: &str, usual: f64, shown: &str, reason: &str| {
        let path = format!("bearing.cage.{key}");
        reader.given_number(&path).unwrap_or_else(|| {
            if reduced || (flexible && key != "modes_to") {
                reader.note(&path, shown, reason).fill(&path, usual);
            }
            usual
        })
    };
    let youngs_modulus = given("youngs_modulus", 210e9, "210 GPa", "steel");
    let poisson_ratio = given("poisson_ratio", 0.3, "0.3", "steel");
    let kept = "six times the first natural frequency of the source's cage";
    let modes_to = given("modes_to", 15e3, "15 kHz", kept);
    let damping = given("damping", 0.0, "0 1/s", "the source states none for the cage");
    let corrections = match reader.document.value("bearing.cage.corrections") {
        Some(Checked::Boolean(given)) => *given,
        _ => true,
    };
    if reduced {
        reader.follow("bearing.cage.corrections", corrections);
    }
    let penalty = match (per_area, contacts.force) {
        (Some(stiffness), _) => Penalty::PerArea(stiffness),
        (None, CageForce::Penalty { stiffness } | CageForce::Hertz { stiffness }) => {
            Penalty::PerNode(stiffness)
        }
    };
    Ok(Some(FlexibleCage {
        shape,
        cells,
        penalty,
        youngs_modulus,
        poisson_ratio,
        // The mesh has the given mass.
        density: inertia.mass / volume,
        damping,
        method,
        order,
        modes_to: if reduced { modes_to } else { 0.0 },
        corrections: reduced && corrections,
    }))
}

/// Volume of one round pocket with a radial axis in the ring: the integral of sqrt(R_o² - y²) - sqrt(R_i² - y²) over
/// the pocket's circle.
fn pocket_volume(pocket: f64, inner: f64, outer: f64) -> f64 {
    // Chebyshev quadrature of the second kind, whose weight is the circle's width at y.
    const NODES: usize = 12;
    let wall =
        |y: f64| (outer * outer - y * y).max(0.0).sqrt() - (inner * inner - y * y).max(0.0).sqrt();
    let sum: f64 = (1..=NODES)
        .map(|k| {
            let (sin, cos) = libm::sincos(PI * k as f64 / (NODES + 1) as f64);
            sin * sin * wall(pocket * cos)
        })
        .sum();
    2.0 * pocket * pocket * sum * PI / (NODES + 1) as f64
}

/// Axial and transverse moment, if given.
fn given_inertia(reader: &Reader) -> Result<Option<[f64; 2]>, SceneError> {
    let keys = ["bearing.cage.inertia.axial", "bearing.cage.inertia.transverse"];
    if !keys.iter().any(|key| reader.is_given(key)) {
        return Ok(None);
    }
    let because = " with the other moment of inertia";
    let axial = reader.required_number(keys[0], because)?;
    let transverse = reader.required_number(keys[1], because)?;
    check_inertia(axial, transverse).map_err(|problem| reader.document.error(keys[0], problem))?;
    Ok(Some([axial, transverse]))
}

/// The contact law, if its stiffness is given.
fn force(reader: &mut Reader) -> Result<Option<CageForce>, SceneError> {
    let path = "bearing.cage.contact.stiffness";
    let hertz = reader.choice_if_given("bearing.cage.contact.law") == Some("hertz");
    match (reader.document.value(path), hertz) {
        (None, false) => Ok(None),
        (None, true) => {
            let because = " with `law = \"hertz\"`".to_string();
            let example = "`stiffness = \"1e10 N/m^1.5\"` to [bearing.cage.contact]".to_string();
            Err(reader.document.error(path, Problem::Missing { because, example }))
        }
        (Some(Checked::Either(0, stiffness)), false) => {
            Ok(Some(CageForce::Penalty { stiffness: *stiffness }))
        }
        (Some(Checked::Either(1, stiffness)), true) => {
            Ok(Some(CageForce::Hertz { stiffness: *stiffness }))
        }
        // A stiffness per area is for nodes, see `flexible`.
        (Some(Checked::Either(2, _)), false) => Ok(None),
        (Some(_), _) => {
            let reason = match hertz {
                true => {
                    "`hertz` takes a stiffness in N/m^1.5. Hint: write stiffness = \"1e10 N/m^1.5\", or choose the other law"
                }
                false => {
                    "`penalty` takes a stiffness in N/m. Hint: write stiffness = \"2e8 N/m\", or choose the other law"
                }
            };
            Err(reader.document.refused(path, reason))
        }
    }
}

/// Radius of the pockets' centres, if given: balls must reach them.
fn pocket_pitch(reader: &Reader, geometry: &BearingGeometry) -> Result<Option<f64>, SceneError> {
    let path = "bearing.cage.pocket_pitch_radius";
    let Some(value) = reader.given_number(path) else { return Ok(None) };
    let (low, high) = (
        geometry.pitch_radius - geometry.ball_radius,
        geometry.pitch_radius + geometry.ball_radius,
    );
    if value > low && value < high {
        return Ok(Some(value));
    }
    let (relation, other_name, other) = if value <= low {
        ("more than", "the pitch radius less a ball radius", low)
    } else {
        ("less than", "the pitch radius plus a ball radius", high)
    };
    let advice = "leave it out; the pockets are then on the pitch circle";
    let problem = Problem::order(value, relation, (other_name, other), advice);
    Err(reader.document.error(path, problem))
}
