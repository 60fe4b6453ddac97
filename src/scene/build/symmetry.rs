//! A quarter of a bushing stands for the whole where its planes of symmetry stay planes and nothing pushes across them.

use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::solid_scene::Held;
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;
use crate::scene::text::value::Checked;

/// Axes across the planes, and the sets that lie in these.
const PLANES: [(&str, &str); 2] = [("x", "x_low"), ("y", "y_low")];
const ADVICE: &str = "leave it out, or write part = \"whole\"";

/// # Errors
/// A plane that is not held, or what has no mirror image on its other side.
pub(crate) fn check(document: &Document, held: &[Held]) -> Result<(), SceneError> {
    for (axis, (name, set)) in PLANES.into_iter().enumerate() {
        if held.iter().any(|of| of.set == set && of.motion[axis].is_some()) {
            continue;
        }
        let reason = format!(
            "a quarter stands for the whole only where its planes of symmetry are held, and set {set:?} is not held along {name}"
        );
        let advice = format!(
            "add [[solid.fixed]] with set = {set:?}, {name} = true, or write part = \"whole\""
        );
        return Err(document.refused("solid.mesh.part", reason, advice));
    }
    for key in ["solid.gravity", "solid.velocity"] {
        if let Some(Checked::Vector(along)) = document.value(key)
            && let Some(axis) = (0..2).find(|axis| along[*axis] != 0.0)
        {
            return Err(document.refused(key, across(PLANES[axis].0), ADVICE));
        }
    }
    if matches!(document.value("solid.spin"), Some(Checked::Number(spin)) if *spin != 0.0) {
        let reason = "a quarter is not turned";
        return Err(document.refused("solid.spin", reason, ADVICE));
    }
    document.items("solid.load").try_for_each(load)
}

fn load(item: ItemRef) -> Result<(), SceneError> {
    for (axis, (name, _)) in PLANES.into_iter().enumerate() {
        let force = match item.value("force") {
            Some(Checked::Vector(force)) => force[axis] != 0.0,
            _ => false,
        };
        let key = if force { "force" } else { name };
        if force || item.value(name).is_some() {
            return Err(item.error(key, Problem::refused(across(name), ADVICE)));
        }
    }
    Ok(())
}

fn across(axis: &str) -> String {
    format!(
        "along {axis} it goes across a plane of symmetry of the quarter, whose other side would have to go the other way"
    )
}
