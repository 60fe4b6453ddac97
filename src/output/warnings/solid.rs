//! Warnings on a solid: coarse mesh, locking elements, stresses and strains outside the range of the material law.

use super::{Warning, WarningCode};
use crate::ch2_housing::elastomer::eight_chain::ChainPull;
use crate::kinematics::vec3::{Vec3, norm, scale};
use crate::mesh::Order;
use crate::mesh::layers::thinnest_wall;
use crate::numeric::clock::{rounded, to_digits};
use crate::output::fields::Stresses;
use crate::output::session::Session;
use crate::solids::bore_equilibrium::BoreState;
use crate::solids::error::StepFailure;
use crate::solids::model::SolidModel;
use crate::solids::modes::Modes;
use crate::solids::rubber::measures::{longest_chain, volume_changes};
use crate::solids::rubber::model::RubberModel;
use crate::solids::stress::nodal_stresses;
use crate::solids::trust::{EnergyError, Placed, at_most, energy_error, largest_von_mises, size};

/// Relative error of displacements or frequencies without a warning; compared with the upper end of the estimate ([`at_most`]).
const TOLERATED_ERROR: f64 = 0.02;
/// Fraction of the surface with the thinnest walls, where elements through the wall are counted.
const THIN_SURFACE_SHARE: f64 = 0.1;
/// Number of elements through a wall below which a mesh is too coarse.
const FEWEST_ELEMENTS: f64 = 2.5;
/// Poisson's ratio above which four-node elements lock with any number of elements through a wall. At 0.45 the bulk
/// modulus is ten times the shear modulus, and a mesh has about as many volume constraints (elements) as free
/// components.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
/// Limit of von Mises stress over Young's modulus. The hardest bearing steel yields at 2 GPa, 1 % of its modulus. Beyond
/// this strain, a law linear in Green's strain is off by a similar amount for rubber too.
const LARGEST_STRAIN: f64 = 0.01;
/// Relative volume change under a pressure of ten times C_R if the bulk modulus is a hundred times C_R.
const LARGEST_VOLUME_CHANGE: f64 = 0.1;
/// Fraction of its full length up to which the five-term chain force agrees with (2.7) within 10 %: at 0.8 it is 4.50,
/// and the inverse Langevin function is 5.00.
const LONGEST_CHAIN: f64 = 0.8;
/// Number of contact nodes of a bore below which the contact depends on the mesh. With 3 and 24 nodes of one bore, critical speeds differed by 14 %.
const FEW_CONTACT_NODES: usize = 40;

/// Warning on a race in contact with few nodes of its bore.
pub fn of_contact_nodes(bore: &BoreState) -> Option<Warning> {
    let (touching, all) = (bore.touching, bore.loads.len());
    (touching < FEW_CONTACT_NODES.min(all)).then(|| {
        Warning::new(
            WarningCode::FewContactNodes,
            format!(
                "{touching} of {all} bore nodes are in contact, so the contact stiffness depends on the mesh: refine it around and along the bore"
            ),
        )
    })
}

/// Warnings on a state of a rubber solid.
///
/// # Errors
/// An inverted element.
pub fn of_rubber(model: &RubberModel, displacement: &[Vec3]) -> Result<Vec<Warning>, StepFailure> {
    let mut warnings = Vec::new();
    let [least, most] = volume_changes(model, displacement)?;
    let far = if -least > most { least } else { most };
    let is_rubber = far.abs() <= LARGEST_VOLUME_CHANGE;
    if !is_rubber {
        let part = to_digits(1.0 + far, 3);
        let text = format!(
            "the volume of rubber is {part} of its initial value, but its material law is valid for changes of a few per cent: check displacements, \
             loads and the bulk modulus"
        );
        warnings.push(Warning::new(WarningCode::RubberVolume, text));
    }
    let chain = longest_chain(model, displacement)?;
    let within = chain <= LONGEST_CHAIN;
    if !within && model.problem.material.network.pull == ChainPull::FiveTerms {
        let text = format!(
            "chains of the network reach {} of their full length, where the five-term series is more than 10 % too soft: compare with chain_force = \
             \"inverse-langevin\"",
            to_digits(chain, 3)
        );
        warnings.push(Warning::new(WarningCode::ChainsNearFullLength, text));
    }
    Ok(warnings)
}

pub fn of_equilibrium(
    model: &SolidModel,
    displacement: &[Vec3],
    stresses: &Stresses,
) -> Vec<Warning> {
    let error = energy_error(model, displacement, &stresses.nodal);
    let of_mesh = of_locking(model).or_else(|| of_mesh(model, &error));
    let stress = largest_von_mises(model, &stresses.cell);
    of_mesh.into_iter().chain(of_stress(model, &stress, None)).collect()
}

/// Warnings on a moving solid, from its present stresses.
pub fn of_motion(model: &SolidModel, stresses: &Stresses) -> Vec<Warning> {
    let stress = largest_von_mises(model, &stresses.cell);
    of_locking(model).into_iter().chain(of_stress(model, &stress, None)).collect()
}

/// Warnings on the run of a single solid, from all its rows.
pub fn of_run(session: &Session, model: &SolidModel, stresses: &Stresses) -> Vec<Warning> {
    let recorder = &session.recorder;
    let column = recorder.columns().iter().position(|column| column.name == "largest_von_mises");
    let Some(column) = column else { return Vec::new() };
    let rows = (0..recorder.rows()).map(|row| (recorder.row(row)[column], recorder.row(row)[0]));
    let (of_rows, time) =
        rows.fold((0.0, 0.0), |most, now| if now.0 > most.0 { now } else { most });
    let mut stress = largest_von_mises(model, &stresses.cell);
    let mut when = None;
    if of_rows > stress.value {
        (stress.value, when) = (of_rows, Some(time));
    }
    of_locking(model).into_iter().chain(of_stress(model, &stress, when)).collect()
}

/// Warnings on natural modes, from the stresses of the lowest mode that is not a rigid-body mode.
pub fn of_modes(model: &SolidModel, found: &Modes) -> Vec<Warning> {
    if let Some(warning) = of_locking(model) {
        return vec![warning];
    }
    let highest = found.modes.last().map_or(0.0, |mode| mode.frequency);
    // The frequencies of rigid-body modes are zero except for rounding.
    let Some(lowest) = found.modes.iter().find(|mode| mode.frequency > 1e-3 * highest) else {
        return Vec::new();
    };
    // Scaled to small amplitude, so that strains are linear.
    let most = lowest.shape.iter().map(|u| norm(*u)).fold(0.0, f64::max);
    let small = 1e-6 * size(model) / most;
    let shape: Vec<Vec3> = lowest.shape.iter().map(|u| scale(*u, small)).collect();
    let error = energy_error(model, &shape, &nodal_stresses(model, &shape));
    let (factor, walls) = upper_end(model, &error);
    // A frequency is proportional to the square root of the energy.
    let part = (1.0 - error.expected(factor)).sqrt().recip() - 1.0;
    let fine = part <= TOLERATED_ERROR;
    let text = || {
        format!(
            "the lowest frequency may be up to {} % too high, and the others more{walls}: {}",
            to_digits(100.0 * part, 2),
            refinement(model)
        )
    };
    (!fine).then(|| Warning::new(WarningCode::MeshTooCoarse, text())).into_iter().collect()
}

fn of_mesh(model: &SolidModel, error: &EnergyError) -> Option<Warning> {
    let (factor, walls) = upper_end(model, error);
    let part = error.expected(factor);
    let fine = part <= TOLERATED_ERROR;
    (!fine).then(|| {
        let text = format!(
            "displacements under these loads may be up to {} % too small, and stresses are less accurate{walls}: {}",
            to_digits(100.0 * part, 2),
            refinement(model)
        );
        Warning::new(WarningCode::MeshTooCoarse, text)
    })
}

/// Upper limit of the ratio of true to estimated error, and a text on walls with few elements through them.
fn upper_end(model: &SolidModel, error: &EnergyError) -> (f64, String) {
    let elements = &model.problem.elements;
    // A small error needs no search for thin walls.
    let sound = error.part() <= 0.1 * TOLERATED_ERROR;
    let wall = if sound {
        None
    } else {
        thinnest_wall(&model.problem.nodes, elements, THIN_SURFACE_SHARE)
    };
    let through = wall.map_or(f64::INFINITY, |wall| wall.elements);
    let walls = wall.filter(|wall| wall.elements < FEWEST_ELEMENTS).map_or(String::new(), |wall| {
        let count = to_digits(wall.elements, 2);
        let noun = if count == 1.0 { "element" } else { "elements" };
        let thickness = to_digits(1e3 * wall.thickness, 4);
        format!("; the thinnest walls have {count} {noun} through {thickness} mm{}", at(&wall.at))
    });
    (at_most(elements.order(), through), walls)
}

fn refinement(model: &SolidModel) -> &'static str {
    match model.problem.elements.order() {
        Order::Linear => "write order = 2 in [solid.mesh], or give more cells through the walls",
        Order::Quadratic => "refine the mesh where stresses are high",
    }
}

fn of_locking(model: &SolidModel) -> Option<Warning> {
    let poisson = model.problem.material.poisson_ratio();
    let locks = model.problem.elements.order() == Order::Linear && poisson >= NEARLY_INCOMPRESSIBLE;
    locks.then(|| {
        let text = format!(
            "four-node elements lock at Poisson's ratio {}, so that displacements may be a fraction of the true ones: write order = 2 in \
             [solid.mesh]",
            to_digits(poisson, 10)
        );
        Warning::new(WarningCode::FourNodeLocking, text)
    })
}

/// Warning on a stress outside the linear range, with its time or position.
fn of_stress(model: &SolidModel, stress: &Placed, time: Option<f64>) -> Option<Warning> {
    let strain = stress.value / model.problem.material.youngs_modulus();
    let elastic = strain <= LARGEST_STRAIN;
    (!elastic).then(|| {
        let place = match time {
            Some(time) => format!(" at t = {} s", rounded(time)),
            None => at(&stress.at),
        };
        let text = format!(
            "von Mises stress {} MPa{place} is {} % of Young's modulus, outside the linear-elastic range: check loads, units and material",
            to_digits(1e-6 * stress.value, 4),
            to_digits(100.0 * strain, 3)
        );
        Warning::new(WarningCode::StressAboveElastic, text)
    })
}

fn at(place: &Vec3) -> String {
    let [x, y, z] = place.map(|x| 1e3 * x);
    format!(" (at x {x:.3}, y {y:.3}, z {z:.3} mm)")
}
