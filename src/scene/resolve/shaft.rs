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
use crate::scene::resolve::unused::refuse_unused;
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;
use crate::scene::text::scopes::unfit;
use std::f64::consts::TAU;

const TABLE: &str = "body.beam";

/// The beam of a body, if it has one. Positions are relative to the body's centre.
pub(crate) fn beam(reader: &mut Reader) -> Result<Option<SceneBeam>, SceneError> {
    let document = reader.document;
    let Some(first) = document.first_below(TABLE) else { return Ok(None) };
    document.refuse_given(&[
        ("body.inertia", "the body is flexible (`beam`). Hint: leave it out: mass and inertia follow from segments and discs"),
        ("body.unbalance", "the body is flexible (`beam`). Hint: write [[body.NAME.beam.unbalance]] with its position"),
        ("body.rotating_load", "the body is flexible (`beam`). Hint: write [[body.NAME.beam.load]] with its position"),
    ])?;
    let mut number = |key: &str| reader.number(&format!("{TABLE}.{key}"));
    let [youngs_modulus, poisson_ratio, density] =
        ["youngs_modulus", "poisson_ratio", "density"].map(&mut number);
    let [below, damping, internal_damping] =
        ["modes_to", "damping", "internal_damping"].map(&mut number);
    let absolute = reader.choice("body.beam.damped_motion") == "absolute";
    let segment = |item: ItemRef| {
        let inner_diameter = item.number("inner_diameter").unwrap_or(0.0);
        let outer_diameter = item.required("outer_diameter")?;
        if inner_diameter >= outer_diameter {
            let reason = "it is no smaller than the outer diameter. Hint: give a smaller one, or leave it out";
            return Err(item.refused("inner_diameter", reason));
        }
        let length = item.required("length")?;
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
        return Err(document.refused(first, "a flexible shaft has segments. Hint: add segments = [{ length = \"400 mm\", outer_diameter = \"30 mm\" }] to [body.NAME.beam]"));
    }
    let mut beam = Beam::new(segments);
    beam.mesh = mesh(reader)?;
    let in_elements = in_elements(reader)?;
    let start = reader.given_number("body.beam.start").unwrap_or_else(|| -0.5 * beam.length());
    reader.follow("body.beam.start", start);
    for (list, key) in [("segments", "inner_diameter"), ("unbalance", "angle")] {
        for item in document.items(&format!("{TABLE}.{list}")) {
            reader.follow(&item.own_path(key), 0.0);
        }
    }
    let length = beam.length();
    let at = |item: ItemRef| -> Result<f64, SceneError> {
        let at = item.required("at")?;
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
        let force = ["x", "y", "z"].map(|axis| item.profile(axis));
        if force.iter().all(Option::is_none) {
            return Err(item.missing("z", ", there is no force"));
        }
        Ok((at(item)?, force.map(|force| force.unwrap_or(Profile::ZERO))))
    };
    let unbalance = |item: ItemRef| {
        let size = item.required("size")?;
        Ok((at(item)?, size, item.number("angle").unwrap_or(0.0)))
    };
    let mut names: Vec<String> = Vec::new();
    let mut watch = |item: ItemRef| {
        let name = item.text("name")?;
        let twice = names.contains(&name);
        let reason = match name.as_str() {
            "velocity" | "tilt" => Some("columns of the body have this name"),
            _ if twice => Some("another section has this name"),
            _ => None,
        };
        let problem = reason.map(|reason| {
            Problem::refused(format!("{reason}. Hint: choose another name, such as mid"))
        });
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
    let reason = format!(
        "{at:.4} mm is not on {of}, which extends from {start:.4} to {end:.4} mm. Hint: positions are relative to the body's centre"
    );
    Some(Problem::refused(reason))
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
            return Err(document.error_of(placed.name.as_deref(), &key, problem));
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
    let order = reader.given_number("body.beam.mesh.order").ok_or_else(|| {
        document.refused(first, "a mesh has elements of a stated order. Hint: add order = 2 to [body.NAME.beam.mesh], or 1 for four-node elements as in the source")
    })?;
    let mut cells = |key: &str| reader.number(key) as usize;
    let (around, radial) = (cells("body.beam.mesh.around"), cells("body.beam.mesh.radial"));
    if !around.is_multiple_of(8) {
        let reason =
            "the core of the mesh has four sides of two cells or more. Hint: give a multiple of 8";
        return Err(document.refused("body.beam.mesh.around", reason));
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
    refuse_unused(document, &["body.beam"])?;
    let is_meshed = document.first_below("body.beam.mesh").is_some();
    if !is_meshed || reader.choice("body.beam.mesh.method") != "explicit" {
        return Ok(None);
    }
    let reason = "a shaft in explicit steps has a prescribed speed. Hint: write `speed`";
    document.refuse_given(&[("body.torque", reason)])?;
    if document.value("body.speed").is_none() {
        let reason = "elements in explicit steps have a prescribed speed. Hint: write speed = \"1000 rpm\" in [body.NAME]";
        return Err(document.refused("body.beam.mesh.method", reason));
    }
    // The elements are its body: loads and foundations act on sections.
    let reason = "the shaft is a mesh, whose loads act at sections. Hint: write load = [{ at = \"0 mm\", z = \"-300 N\" }] in \
                  [body.NAME.beam]";
    let parts = ["body.x", "body.y", "body.z", "body.tilt_y", "body.tilt_z", "body.foundation"];
    document.refuse_given(&parts.map(|part| (part, reason)))?;
    if reader.choice_if_given("body.beam.damped_motion") == Some("relative-to-rigid") {
        let reason = "elements in explicit steps have damping only in axes that do not rotate. Hint: leave it out, or write \
                      method = \"reduced\" in [body.NAME.beam.mesh]";
        return Err(document.refused("body.beam.damped_motion", reason));
    }
    // A disc on its spring needs inertia.
    let inertia = ["mass", "axial", "transverse"];
    for item in document.items("body.beam.disc").filter(|item| item.is_given("mass")) {
        let missing = |name: &&str| item.number(name).is_none_or(|value| value <= 0.0);
        if let Some(name) = inertia.into_iter().find(missing) {
            let reason = format!(
                "a disc on elements in explicit steps is a body of its own. Hint: give its `{name}`, above 0; or its outer_diameter and width"
            );
            return Err(item.refused("mass", reason));
        }
    }
    let [stiffness, damping] = JOINT.map(|key| reader.number(key));
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
            let reason = "an outer race cannot be on elements in explicit steps. Hint: write method = \"reduced\" in [body.NAME.beam.mesh]";
            let problem = Problem::refused(reason);
            return Err(document.error_of(placed.name.as_deref(), "bearing.outer_on", problem));
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
                "body {} is a mesh in explicit steps, to which only bearings can be joined. Hint: write method = \"reduced\" in [body.NAME.beam.mesh]",
                of.name
            );
            let problem = Problem::refused(reason);
            return Err(document.scoped(&spring.name).error(key, problem));
        }
    }
    Ok(())
}

/// A disc of a given mass, or of a given size and the shaft's density; `at` from the shaft's first end.
fn disc(item: ItemRef, at: f64, density: f64) -> Result<BeamDisc, SceneError> {
    let given = |name: &str| item.number(name);
    if let Some(mass) = given("mass") {
        let size = ["outer_diameter", "inner_diameter", "width"];
        if let Some(name) = size.into_iter().find(|name| given(name).is_some()) {
            let advice = format!("keep `mass` or `{name}`");
            return Err(item.error(name, Problem::Exclusive { rival: "mass".into(), advice }));
        }
        if given("axial").is_some() && given("transverse").is_none() {
            return Err(item.missing("transverse", " with `axial`"));
        }
        let [axial, transverse] = ["axial", "transverse"].map(|name| given(name).unwrap_or(0.0));
        check_inertia(axial, transverse).map_err(|problem| item.error("axial", problem))?;
        return Ok(BeamDisc { at, mass, axial, transverse });
    }
    let (outer, width) = (item.required("outer_diameter")?, item.required("width")?);
    let inner = given("inner_diameter").unwrap_or(0.0);
    if inner >= outer {
        let reason =
            "it is no smaller than the outer diameter. Hint: give a smaller one, or leave it out";
        return Err(item.refused("inner_diameter", reason));
    }
    let DiscInertia { mass, axial, transverse } =
        DiscInertia::of_ring(outer, inner, width, density);
    Ok(BeamDisc { at, mass, axial, transverse })
}
