//! A quarter of a bushing represents the whole if its planes of symmetry stay planes without forces across them.

use crate::scene::error::SceneError;
use crate::scene::resolve::solid_scene::Held;
use crate::scene::text::document::Document;
use crate::scene::text::items::ItemRef;
use crate::scene::text::value::Checked;

/// Axes across the planes, and their sets.
const PLANES: [(&str, &str); 2] = [("x", "x_low"), ("y", "y_low")];

/// # Errors
///
/// A plane that is not fixed, or a load without a mirror image.
pub(crate) fn check(document: &Document, held: &[Held]) -> Result<(), SceneError> {
    for (axis, (name, set)) in PLANES.into_iter().enumerate() {
        if held.iter().any(|of| of.set == set && of.motion[axis].is_some()) {
            continue;
        }
        let reason = format!(
            "a quarter represents the whole only if its planes of symmetry are fixed, and set {set:?} is not fixed along {name}. Hint: add [[solid.fixed]] with set = {set:?}, {name} = true, or write part = \"whole\""
        );
        return Err(document.refused("solid.mesh.part", reason));
    }
    for key in ["solid.gravity", "solid.velocity"] {
        if let Some(Checked::Vector(along)) = document.value(key)
            && let Some(axis) = (0..2).find(|axis| along[*axis] != 0.0)
        {
            return Err(document.refused(key, across(PLANES[axis].0)));
        }
    }
    if matches!(document.value("solid.spin"), Some(Checked::Number(spin)) if *spin != 0.0) {
        let reason = "a quarter cannot rotate. Hint: leave it out, or write part = \"whole\"";
        return Err(document.refused("solid.spin", reason));
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
            return Err(item.refused(key, across(name)));
        }
    }
    Ok(())
}

fn across(axis: &str) -> String {
    format!(
        "along {axis} it crosses a plane of symmetry of the quarter, whose mirror image would have to move the other \
         way. Hint: leave it out, or write part = \"whole\""
    )
}
