//! From the keys of a bonded bushing between two bodies to its springs.

use crate::ch2_housing::elastomer::eight_chain::ChainPull;
use crate::members::connection::SpringDashpot;
use crate::members::prony::{BushingSpring, bushing_spring};
use crate::mesh::generate::{Bushing, BushingMesh, Part, bushing as mesh_of};
use crate::scene::build::assembly::{BushingInElements, BushingOfSpring, BushingStepping};
use crate::scene::error::SceneError;
use crate::scene::resolve::bearing::Reader;
use crate::scene::resolve::rubber::rubber;
use std::f64::consts::TAU;
use std::sync::{Mutex, PoisonError};

const TABLE: &str = "spring.bushing";
/// Power of the grading of cells towards sleeves and ends.
const GRADING: f64 = 2.0;
/// Limit of cells: reading a scene takes minutes beyond.
const MOST_CELLS: usize = 1500;

/// The bushing of a spring, if it is one, and its law.
pub(crate) fn bushing(
    reader: &mut Reader,
) -> Result<Option<(BushingOfSpring, SpringDashpot)>, SceneError> {
    let document = reader.document;
    if document.first_below(TABLE).is_none() {
        return Ok(None);
    }
    let reason = "the spring is a bushing, whose stiffness follows from its dimensions and rubber. Hint: leave this or \
                  [spring.NAME.bushing] out";
    document.refuse_given(&[("spring.stiffness", reason), ("spring.maxwell", reason)])?;
    let size = |key: &str| reader.required_number(&format!("{TABLE}.{key}"), " of a bushing");
    let [inner_diameter, outer_diameter, length] =
        [size("inner_diameter")?, size("outer_diameter")?, size("length")?];
    let thickness = 0.5 * (outer_diameter - inner_diameter);
    let thick = thickness > 0.0;
    if !thick {
        let reason = "it is no larger than the inner diameter. Hint: give a larger one; both are those of the rubber";
        return Err(document.refused("spring.bushing.outer_diameter", reason));
    }
    let [usual_radial, usual_axial] = usual_cells(thickness, length);
    let around = reader.number("spring.bushing.cells.around") as usize;
    let mut cells = |key: &str, usual: usize| {
        let (path, shown) = (format!("{TABLE}.cells.{key}"), usual.to_string());
        let reason = "from the length and thickness of the bushing";
        reader.number_or(&path, usual as f64, &shown, reason) as usize
    };
    let [radial, axial] = [cells("radial", usual_radial), cells("axial", usual_axial)];
    let all = around * radial * axial;
    if all > MOST_CELLS {
        let reason = format!(
            "{around} × {radial} × {axial} are {all} cells. Hint: take at most 1500, each is five elements of ten nodes; finer ones are for [solid.mesh] with \
                      `generate = \"bushing\"`"
        );
        return Err(document.refused("spring.bushing.cells", reason));
    }
    let mesh = BushingMesh { around, radial, axial, grading: GRADING, part: Part::Quarter };
    let body = Bushing { inner_diameter, thickness, length };
    let fastest = reader.number("spring.bushing.fastest");
    let table = reader.choice_if_given("spring.bushing.table");
    let because = " of a bushing without `table`";
    let material = rubber(reader, TABLE, table, ChainPull::FiveTerms, because)?;
    let (misses, elements) = ([0.0; 4], None);
    let mut of = BushingOfSpring { body, mesh, material, table, fastest, misses, elements };
    let spring = fitted(&of).map_err(|(key, error)| {
        document.refused(key, format!("{error}. Hint: check its dimensions, cells and rubber"))
    })?;
    of.misses = spring.misses;
    let method = reader.choice("spring.bushing.method");
    let stepping = match method {
        "explicit" => {
            let fraction = reader.number("spring.bushing.step_fraction");
            Some(BushingStepping::Explicit { fraction })
        }
        "implicit" => {
            Some(BushingStepping::Implicit { step: reader.given_number("spring.bushing.step") })
        }
        _ => None,
    };
    of.elements = stepping.map(|stepping| {
        let density = reader.number("spring.bushing.density");
        let coupling_phase = reader.number("spring.bushing.coupling_phase");
        BushingInElements { density, stepping, coupling_phase }
    });
    Ok(Some((of, spring.law)))
}

/// Default cells across the wall and along half of the length, in number about constant. All stiffnesses are within 1.1
/// % of an oracle's (case `bushing_sleeve_motions`); 4 by 4 give an error of 3 to 5.5 % for thin sleeves and flat
/// discs.
fn usual_cells(thickness: f64, length: f64) -> [usize; 2] {
    match 0.5 * length / thickness {
        slender if slender >= 12.0 => [2, 12],
        slender if slender >= 6.0 => [2, 8],
        slender if slender <= 0.3 => [8, 2],
        _ => [4, 4],
    }
}

/// The last fitted bushings: a sweep reads one scene many times, and a fit takes a second.
static FITTED: Mutex<Vec<(BushingOfSpring, BushingSpring)>> = Mutex::new(Vec::new());
const KEPT: usize = 8;

/// The spring of a bushing whose `misses` are zero; otherwise the invalid key, and the reason.
fn fitted(of: &BushingOfSpring) -> Result<BushingSpring, (&'static str, String)> {
    let kept = || FITTED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, spring)) = kept().iter().find(|(other, _)| other == of) {
        return Ok(spring.clone());
    }
    // The lock is free meanwhile: threads of a sweep have different bushings.
    let solid = mesh_of(&of.body, &of.mesh).and_then(|solid| solid.quadratic());
    let solid = solid.map_err(|error| ("spring.bushing.cells", error.to_string()))?;
    let found = bushing_spring(&solid.mesh, Part::Quarter, &of.material, TAU * of.fastest);
    let spring = found.map_err(|error| (TABLE, error.to_string()))?;
    let mut kept = kept();
    if kept.len() == KEPT {
        kept.remove(0);
    }
    kept.push((of.clone(), spring.clone()));
    Ok(spring)
}
