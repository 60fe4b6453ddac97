//! From the keys of a flexible body to its beam and the loads along it.

use crate::ch4_rotor::disc::Inertia as DiscInertia;
use crate::members::beam::{Beam, BeamDisc, BeamSegment};
use crate::members::meshed_shaft::ShaftMesh;
use crate::members::shaft_modes::Kept;
use crate::mesh::Order;
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::{
    AssemblyScene, Carrier, PlacedBearing, RaceJoint, SceneBeam, SceneBody, Spring, SpringAt,
};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::dynamics::check_inertia;
use crate::scene::resolve::solid::{item_number, item_profile, item_text, missing};
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;
use crate::scene::text::scopes::unfit;
use std::f64::consts::TAU;

const TABLE: &str = "body.beam";

/// The beam of a body, if it has one. Positions are relative to the body's centre.
pub(crate) fn beam(reader: &mut Reader) -> Result<Option<SceneBeam>, SceneError> {
    let document = reader.document;
    let Some(first) = document.first_below(TABLE) else { return Ok(None) };
    let refused =
        |key: &str, reason: &str, advice: &str| Err(document.refused(key, reason, advice));
    for (part, advice) in [
        ("body.inertia", "leave it out: mass and inertia follow from segments and discs"),
        ("body.unbalance", "write [[body.NAME.beam.unbalance]] with its position"),
        ("body.rotating_load", "write [[body.NAME.beam.load]] with its position"),
    ] {
        if let Some(given) = document.first_below(part) {
            return refused(given, "the body is flexible (`beam`)", advice);
        }
    }
    let mut number = |key: &str| reader.number(&format!("{TABLE}.{key}")).unwrap_or(0.0);
    let [youngs_modulus, poisson_ratio, density] =
        ["youngs_modulus", "poisson_ratio", "density"].map(&mut number);
    let [below, damping, internal_damping] =
        ["modes_to", "damping", "internal_damping"].map(&mut number);
    let absolute = reader.choice("body.beam.damped_motion") == Some("absolute");
    let segment = |item: ItemRef| {
        let size = |name, example| required(item, name, example);
        let inner_diameter = item_number(item, "inner_diameter").unwrap_or(0.0);
        let outer_diameter = size("outer_diameter", "outer_diameter = \"30 mm\"")?;
        if inner_diameter >= outer_diameter {
            let reason = "it is no smaller than the outer diameter";
            let advice = "give a smaller one, or leave it out";
            return Err(item.error("inner_diameter", Problem::refused(reason, advice)));
        }
        let length = size("length", "length = \"400 mm\"")?;
        let (youngs_modulus, density) = (youngs_modulus, density);
        Ok(BeamSegment {
            length,
            outer_diameter,
            inner_diameter,
            density,
            youngs_modulus,
            poisson_ratio,
        })
    };
    let segments: Vec<BeamSegment> =
        document.items("body.beam.segments").map(segment).collect::<Result<_, _>>()?;
    if segments.is_empty() {
        return refused(
            first,
            "a flexible shaft has segments",
            "add segments = [{ length = \"400 mm\", outer_diameter = \"30 mm\" }] to [body.NAME.beam]",
        );
    }
    let mut beam = Beam::new(segments);
    beam.mesh = mesh(reader)?;
    let in_elements = in_elements(reader)?;
    let start = reader.given_number("body.beam.start").unwrap_or_else(|| -0.5 * beam.length());
    let length = beam.length();
    let at = |item: ItemRef| -> Result<f64, SceneError> {
        let at = required(item, "at", "at = \"0 mm\"")?;
        match beside(at, [start, start + length], "the shaft") {
            None => Ok(at),
            Some(problem) => Err(item.error("at", problem)),
        }
    };
    beam.discs = document
        .items("body.beam.disc")
        .map(|item| disc(item, at(item)? - start, density))
        .collect::<Result<_, SceneError>>()?;
    let load = |item: ItemRef| {
        let force = ["x", "y", "z"].map(|axis| item_profile(item, axis));
        if force.iter().all(Option::is_none) {
            return Err(missing(item, "z", ", there is no force", "z = \"-3000 N\""));
        }
        Ok((at(item)?, force.map(|force| force.unwrap_or(Profile::ZERO))))
    };
    let unbalance = |item: ItemRef| {
        let size = required(item, "size", "size = \"1e-3 kg m\"")?;
        Ok((at(item)?, size, item_number(item, "angle").unwrap_or(0.0)))
    };
    let mut names: Vec<String> = Vec::new();
    let mut watch = |item: ItemRef| {
        let name = item_text(item, "name", "name = \"mid\"")?;
        let twice = names.contains(&name);
        let reason = match name.as_str() {
            "velocity" | "tilt" => Some("columns of the body have this name"),
            _ if twice => Some("another section has this name"),
            _ => None,
        };
        let problem =
            reason.map(|reason| Problem::refused(reason, "choose another name, such as mid"));
        if let Some(problem) = unfit(&name).or(problem) {
            return Err(item.error("name", problem));
        }
        names.push(name.clone());
        Ok((name, at(item)?))
    };
    Ok(Some(SceneBeam {
        start,
        kept: Kept { below: TAU * below, most: usize::MAX },
        damping,
        absolute,
        internal_damping,
        loads: document.items("body.beam.load").map(load).collect::<Result<_, _>>()?,
        unbalances: document
            .items("body.beam.unbalance")
            .map(unbalance)
            .collect::<Result<_, _>>()?,
        probes: document
            .items("body.beam.probe")
            .map(&mut watch)
            .collect::<Result<_, SceneError>>()?,
        beam,
        in_elements,
    }))
}

/// Problem of a position that is not between the ends of a shaft (m); `None` if it is.
pub(crate) fn beside(at: f64, [start, end]: [f64; 2], of: &str) -> Option<Problem> {
    // Within the tolerance of stations.
    let room = 1e-9 * (end - start);
    if start - room <= at && at <= end + room {
        return None;
    }
    let [at, start, end] = [at, start, end].map(|x| 1e3 * x);
    let reason = format!("{at:.4} mm is not on {of}, which extends from {start:.4} to {end:.4} mm");
    Some(Problem::refused(reason, "positions are relative to the body's centre"))
}

/// Refuses races and springs beside their shafts.
///
/// # Errors
///
/// The first that is beside its shaft.
pub(crate) fn refuse_places_off_shafts(
    document: &Document,
    (bearings, springs): (&[PlacedBearing], &[Spring]),
    bodies: &[SceneBody],
) -> Result<(), SceneError> {
    let off = |index: usize, at: f64| {
        let beam = bodies[index].beam.as_ref()?;
        let ends = [beam.start, beam.start + beam.beam.length()];
        beside(at, ends, &format!("body {}", bodies[index].name))
    };
    for placed in bearings {
        for (carrier, key) in placed.carriers.into_iter().zip(["inner_at", "outer_at"]) {
            let Carrier::Body { index, at } = carrier else { continue };
            let Some(problem) = off(index, at) else { continue };
            let key = format!("bearing.{key}");
            return Err(match &placed.name {
                Some(name) => document.scoped(name).error(&key, problem),
                None => document.error(&key, problem),
            });
        }
    }
    for spring in springs {
        for (end, key) in spring.ends.iter().zip(["spring.from_at", "spring.to_at"]) {
            let SpringAt::Body(index) = end.at else { continue };
            if let Some(problem) = off(index, end.along) {
                return Err(document.scoped(&spring.name).error(key, problem));
            }
        }
    }
    Ok(())
}

/// Mesh of the segments, if they are tetrahedra.
fn mesh(reader: &mut Reader) -> Result<Option<ShaftMesh>, SceneError> {
    let document = reader.document;
    let Some(first) = document.first_below("body.beam.mesh") else { return Ok(None) };
    let refused = |key: &str, reason: &str, advice: &str| document.refused(key, reason, advice);
    let order = reader.given_number("body.beam.mesh.order").ok_or_else(|| {
        let advice =
            "add order = 2 to [body.NAME.beam.mesh], or 1 for four-node elements as in the source";
        refused(first, "a mesh has elements of a stated order", advice)
    })?;
    let mut cells = |key: &str| reader.number(key).unwrap_or(1.0) as usize;
    let (around, radial) = (cells("body.beam.mesh.around"), cells("body.beam.mesh.radial"));
    if !around.is_multiple_of(8) {
        let reason = "the core of the mesh has four sides of two cells or more";
        return Err(refused("body.beam.mesh.around", reason, "give a multiple of 8"));
    }
    let longest_layer = reader.given_number("body.beam.mesh.longest_layer");
    Ok(Some(ShaftMesh {
        order: if order < 1.5 { Order::Linear } else { Order::Quadratic },
        longest_layer: longest_layer.unwrap_or(f64::INFINITY),
        around,
        radial,
    }))
}

/// Springs between races and sections, for elements in explicit steps.
fn in_elements(reader: &mut Reader) -> Result<Option<RaceJoint>, SceneError> {
    const JOINT: [&str; 2] = ["body.beam.mesh.race_stiffness", "body.beam.mesh.race_damping"];
    let document = reader.document;
    let refused =
        |key: &str, reason: &str, advice: &str| Err(document.refused(key, reason, advice));
    let is_meshed = document.first_below("body.beam.mesh").is_some();
    if !is_meshed || reader.choice("body.beam.mesh.method") != Some("explicit") {
        return match JOINT.into_iter().find(|key| reader.is_given(key)) {
            Some(key) => refused(
                key,
                "races are joined directly to the sections of a reduced shaft",
                "write method = \"explicit\" in [body.NAME.beam.mesh], or leave it out",
            ),
            None => Ok(None),
        };
    }
    for (key, reason, advice) in [
        (
            "body.beam.modes_to",
            "elements in explicit steps have all of their frequencies",
            "leave it out",
        ),
        ("body.torque", "a shaft in explicit steps has a prescribed speed", "write `speed`"),
        (
            "body.beam.internal_damping",
            "elements in explicit steps have damping only in axes that do not rotate",
            "leave it out, or write method = \"reduced\" in [body.NAME.beam.mesh]",
        ),
    ] {
        if document.value(key).is_some() {
            return refused(key, reason, advice);
        }
    }
    if document.value("body.speed").is_none() {
        let advice = "write speed = \"1000 rpm\" in [body.NAME]";
        return refused(
            "body.beam.mesh.method",
            "elements in explicit steps have a prescribed speed",
            advice,
        );
    }
    // The elements are its body: loads and foundations act on sections.
    for part in ["x", "y", "z", "tilt_y", "tilt_z", "foundation"] {
        let part = format!("body.{part}");
        if let Some(key) = document.first_below(&part) {
            let reason = "the shaft is a mesh, whose loads act at sections";
            return refused(
                key,
                reason,
                "write load = [{ at = \"0 mm\", z = \"-300 N\" }] in [body.NAME.beam]",
            );
        }
    }
    if reader.choice_if_given("body.beam.damped_motion") == Some("relative-to-rigid") {
        let reason = "elements in explicit steps have damping only in axes that do not rotate";
        return refused("body.beam.damped_motion", reason, "leave it out");
    }
    // A disc on its spring needs inertia.
    let inertia = ["mass", "axial", "transverse"];
    for item in document.items("body.beam.disc").filter(|item| item_number(*item, "mass").is_some())
    {
        let missing = |name: &&str| item_number(item, name).is_none_or(|value| value <= 0.0);
        if let Some(name) = inertia.into_iter().find(missing) {
            let reason = "a disc on elements in explicit steps is a body of its own";
            let advice = format!("give its `{name}`, above 0; or its outer_diameter and width");
            return Err(item.error("mass", Problem::refused(reason, advice)));
        }
    }
    let [stiffness, damping] = JOINT.map(|key| reader.number(key).unwrap_or(0.0));
    Ok(Some(RaceJoint { stiffness, damping }))
}

/// Refuses springs and outer races on a shaft in elements.
///
/// # Errors
///
/// The first spring or outer race on one.
pub(crate) fn refuse_springs_on_elements(
    document: &Document,
    scene: &AssemblyScene,
) -> Result<(), SceneError> {
    let is_elements = |index: usize| {
        scene.bodies[index].beam.as_ref().is_some_and(|beam| beam.in_elements.is_some())
    };
    for placed in &scene.bearings {
        let Carrier::Body { index, .. } = placed.carriers[1] else { continue };
        if is_elements(index) {
            let reason = "an outer race cannot be on elements in explicit steps";
            let advice = "write method = \"reduced\" in [body.NAME.beam.mesh]";
            let problem = Problem::refused(reason, advice);
            return Err(match &placed.name {
                Some(name) => document.scoped(name).error("bearing.outer_on", problem),
                None => document.error("bearing.outer_on", problem),
            });
        }
    }
    for spring in &scene.springs {
        for (end, key) in spring.ends.iter().zip(["spring.from", "spring.to"]) {
            let SpringAt::Body(index) = end.at else { continue };
            if !is_elements(index) {
                continue;
            }
            let of = &scene.bodies[index];
            let reason = format!(
                "body {} is a mesh in explicit steps, to which only bearings can be joined",
                of.name
            );
            let advice = "write method = \"reduced\" in [body.NAME.beam.mesh]";
            let problem = Problem::refused(reason, advice);
            return Err(document.scoped(&spring.name).error(key, problem));
        }
    }
    Ok(())
}

fn required(item: ItemRef, name: &str, example: &str) -> Result<f64, SceneError> {
    item_number(item, name).ok_or_else(|| missing(item, name, "", example))
}

/// A disc of a given mass, or of a given size and the shaft's density; `at` from the shaft's first end.
fn disc(item: ItemRef, at: f64, density: f64) -> Result<BeamDisc, SceneError> {
    let given = |name: &str| item_number(item, name);
    if let Some(mass) = given("mass") {
        let size = ["outer_diameter", "inner_diameter", "width"];
        if let Some(name) = size.into_iter().find(|name| given(name).is_some()) {
            let advice = format!("keep `mass` or `{name}`");
            return Err(item.error(name, Problem::Exclusive { rival: "mass".into(), advice }));
        }
        if given("axial").is_some() && given("transverse").is_none() {
            let because = " with `axial`";
            return Err(missing(item, "transverse", because, "transverse = \"0.05 kg m^2\""));
        }
        let [axial, transverse] = ["axial", "transverse"].map(|name| given(name).unwrap_or(0.0));
        check_inertia(axial, transverse).map_err(|problem| item.error("axial", problem))?;
        return Ok(BeamDisc { at, mass, axial, transverse });
    }
    let outer = required(item, "outer_diameter", "outer_diameter = \"200 mm\"")?;
    let width = required(item, "width", "width = \"20 mm\"")?;
    let inner = given("inner_diameter").unwrap_or(0.0);
    if inner >= outer {
        let reason = "it is no smaller than the outer diameter";
        let advice = "give a smaller one, or leave it out";
        return Err(item.error("inner_diameter", Problem::refused(reason, advice)));
    }
    let DiscInertia { mass, axial, transverse } =
        DiscInertia::of_ring(outer, inner, width, density);
    Ok(BeamDisc { at, mass, axial, transverse })
}
