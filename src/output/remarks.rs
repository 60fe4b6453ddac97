//! What a person should know of a solid's results before using them: a mesh that is too coarse for them,
//! or strains and displacements that a linear law does not hold for.

use crate::kinematics::vec3::{Vec3, norm, scale};
use crate::mesh::Order;
use crate::output::fields::Stresses;
use crate::output::session::Session;
use crate::solver::clock::{rounded, to_digits};
use crate::solver::solid::model::SolidModel;
use crate::solver::solid::modes::Modes;
use crate::solver::solid::stress::nodal_stresses;
use crate::solver::solid::trust::{EnergyError, Strained, energy_error};

/// Part of the energy that a mesh may seem to miss without a word. On coarse meshes the estimate is a third
/// to three fifths of the truth (a clamped bar in ten-node elements: 0.5 % for 1.5, four-node ones: 37 % for
/// 65), so that displacements are good to some per cents below it.
const SILENT: f64 = 0.02;
/// Poisson's ratio from which four-node elements lock whatever their number through a wall: at 0.45 the bulk
/// modulus is ten times the shear modulus, and a mesh has about as many elements, each to keep
/// its volume, as free components.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
/// Of von Mises stress over Young's modulus: the hardest bearing steel yields at 2 GPa, 1 % of its modulus, and
/// beyond that a law that is linear in Green's strain is off by as much for rubber too.
const LARGEST_STRAIN: f64 = 0.01;

/// Remarks on an equilibrium.
pub fn of_equilibrium(
    model: &SolidModel,
    displacement: &[Vec3],
    stresses: &Stresses,
) -> Vec<String> {
    let error = energy_error(model, displacement, &stresses.nodal);
    let state = Strained::of(model, displacement, &stresses.cell);
    of_mesh(model, &error).into_iter().chain(of_law(&state, "")).collect()
}

/// Remarks on a moving solid, from the last state of its `stresses`.
pub fn of_motion(model: &SolidModel, displacement: &[Vec3], stresses: &Stresses) -> Vec<String> {
    let state = Strained::of(model, displacement, &stresses.cell);
    of_locking(model).into_iter().chain(of_law(&state, " at the end of the run")).collect()
}

/// Remarks on the run of a solid by itself, from all its rows.
pub fn of_run(session: &Session, model: &SolidModel, stresses: &Stresses) -> Vec<String> {
    let recorder = &session.recorder;
    let column = |name: &str| recorder.columns().iter().position(|column| column.name == name);
    let (Some(stress), Some(moved)) = (column("largest_von_mises"), column("largest_displacement"))
    else {
        return Vec::new();
    };
    let largest = |column: usize| {
        (0..recorder.rows())
            .map(|row| (recorder.row(row)[column], recorder.row(row)[0]))
            .fold((0.0, 0.0), |most, now| if now.0 > most.0 { now } else { most })
    };
    let mut state = Strained::of(model, &session.displacement(), &stresses.cell);
    let (of_rows, time) = largest(stress);
    let mut when = String::new();
    if of_rows > state.stress.value {
        state.stress.value = of_rows;
        when = format!(" at t = {} s", rounded(time));
    }
    // A body that is free to move may go as far as it likes.
    if !model.problem.prescribed.is_empty() {
        state.displacement.value = state.displacement.value.max(largest(moved).0);
    }
    of_locking(model).into_iter().chain(of_law(&state, &when)).collect()
}

/// What the jumps of the stresses say. Where four-node elements lock altogether they say too little (7 % for 98
/// in a clamped bar), and the law alone is reason enough.
fn of_mesh(model: &SolidModel, error: &EnergyError) -> Option<String> {
    if let Some(remark) = of_locking(model) {
        return Some(remark);
    }
    let part = error.part();
    let small = part <= SILENT;
    if small {
        return None;
    }
    let cure = cure(model);
    Some(format!(
        "the mesh is too coarse: displacements under these loads are expected to be {} % too small, on coarse \
         meshes two or three times as much, and stresses are less certain than that (after Zienkiewicz and \
         Zhu, from the jumps of stress between elements); {cure}",
        to_digits(100.0 * part, 2)
    ))
}

/// Remarks on natural modes, from the stresses of the lowest one that is no rigid motion.
pub fn of_modes(model: &SolidModel, found: &Modes) -> Vec<String> {
    if let Some(remark) = of_locking(model) {
        return vec![remark];
    }
    let highest = found.modes.last().map_or(0.0, |mode| mode.frequency);
    // Rigid motions have what rounding leaves of zero.
    let Some(lowest) = found.modes.iter().find(|mode| mode.frequency > 1e-3 * highest) else {
        return Vec::new();
    };
    // So small that strains are linear.
    let size = Strained::of(model, &lowest.shape, &[]).size;
    let most = lowest.shape.iter().map(|u| norm(*u)).fold(0.0, f64::max);
    let shape: Vec<Vec3> = lowest.shape.iter().map(|u| scale(*u, 1e-6 * size / most)).collect();
    let part = energy_error(model, &shape, &nodal_stresses(model, &shape)).part();
    let small = part <= SILENT;
    if small {
        return Vec::new();
    }
    // Frequencies go with the root of the energy.
    let percent = to_digits(50.0 * part, 2);
    let cure = cure(model);
    vec![format!(
        "the mesh is too coarse: the lowest frequency is expected to be {percent} % too high, on coarse meshes \
         two or three times as much, and the others more (after Zienkiewicz and Zhu, from the jumps of stress \
         between elements); {cure}"
    )]
}

/// What to do about a mesh that is too coarse.
fn cure(model: &SolidModel) -> &'static str {
    match model.problem.elements.order() {
        Order::Linear => {
            "four-node elements are too stiff where walls bend over few of them: write order = 2 in \
             [solid.mesh], or more cells through the wall"
        }
        Order::Quadratic => "make the mesh finer where stresses are high",
    }
}

/// Four-node elements near incompressibility.
fn of_locking(model: &SolidModel) -> Option<String> {
    let poisson = model.problem.material.poisson_ratio();
    let locks = model.problem.elements.order() == Order::Linear && poisson >= NEARLY_INCOMPRESSIBLE;
    locks.then(|| {
        format!(
            "four-node elements lock at Poisson's ratio {}: displacements may be a fraction of the true \
             ones; write order = 2 in [solid.mesh]",
            to_digits(poisson, 10)
        )
    })
}

/// Strains and displacements that the linear law does not hold for.
fn of_law(state: &Strained, when: &str) -> Vec<String> {
    let mut remarks = Vec::new();
    let bearable = state.strain() <= LARGEST_STRAIN;
    if !bearable {
        remarks.push(format!(
            "the von Mises stress comes to {} MPa{when}, {} % of Young's modulus{}: no steel stays elastic \
             beyond 1 %, and the linear law holds for small strains only, so that these results are \
             of no real part; check loads, units and material",
            to_digits(1e-6 * state.stress.value, 4),
            to_digits(100.0 * state.strain(), 3),
            if when.is_empty() { at(&state.stress.at) } else { String::new() },
        ));
    }
    let small = state.displacement.value <= state.size;
    if !small {
        remarks.push(format!(
            "the largest displacement, {} mm, is more than the body's size of {} mm; check loads, units and \
             supports",
            to_digits(1e3 * state.displacement.value, 4),
            to_digits(1e3 * state.size, 4)
        ));
    }
    remarks
}

fn at(place: &Vec3) -> String {
    let [x, y, z] = place.map(|x| 1e3 * x);
    format!(" (at x {x:.3}, y {y:.3}, z {z:.3} mm)")
}
