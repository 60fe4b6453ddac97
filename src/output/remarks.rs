//! What a person should know of a solid's results before using them: a mesh that is too coarse for them,
//! or strains and displacements that a linear law does not hold for.

use crate::ch2_housing::elastomer::eight_chain::ChainPull;
use crate::kinematics::vec3::{Vec3, norm, scale};
use crate::mesh::Order;
use crate::mesh::layers::{Wall, thinnest_wall};
use crate::output::fields::Stresses;
use crate::output::session::Session;
use crate::solver::clock::{rounded, to_digits};
use crate::solver::housing::bore_equilibrium::BoreState;
use crate::solver::profile::Profile;
use crate::solver::solid::model::SolidModel;
use crate::solver::solid::modes::Modes;
use crate::solver::solid::rubber::error::StepFailure;
use crate::solver::solid::rubber::measures::{longest_chain, volume_changes};
use crate::solver::solid::rubber::model::RubberModel;
use crate::solver::solid::stress::nodal_stresses;
use crate::solver::solid::trust::{EnergyError, Strained, at_most, energy_error};

/// Part of displacements or frequencies that a mesh may miss without a word, by the upper end of what the estimate is
/// worth ([`at_most`]).
const SILENT: f64 = 0.02;
/// Part of the surface with the thinnest walls beneath it, which say how many elements a mesh has through them.
const THIN: f64 = 0.1;
/// Elements through a wall that are few enough to be told.
const FEW: f64 = 2.5;
/// Poisson's ratio from which ten-node elements are softer than they should be by several per cent on coarse
/// meshes: 9.5 % of a bent bar two elements high at 0.499, 1 % at 0.3.
const TEN_NODES_LOCK: f64 = 0.49;
/// Poisson's ratio from which four-node elements lock whatever their number through a wall: at 0.45 the bulk
/// modulus is ten times the shear modulus, and a mesh has about as many elements, each to keep
/// its volume, as free components.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
/// Of von Mises stress over Young's modulus: the hardest bearing steel yields at 2 GPa, 1 % of its modulus, and
/// beyond that a law that is linear in Green's strain is off by as much for rubber too.
const LARGEST_STRAIN: f64 = 0.01;

/// Change of volume beyond which rubber is told to be no rubber any more: a pressure of ten times C_R makes it where the
/// bulk modulus is a hundred times that.
const LARGEST_VOLUME_CHANGE: f64 = 0.1;

/// Part of its straight length up to which a chain of five terms pulls as (2.7) has it within 10 %: 0.8 of it has 4.50 where
/// the inverse Langevin function is 5.00.
const LONGEST_CHAIN: f64 = 0.8;

/// Nodes of a bore that touch, below which a contact is told to be the mesh's: three and 24 of one bore had critical speeds 14 % apart.
const FEW_TOUCH: usize = 40;

/// What to beware of where a race touches few of its bore's nodes.
pub fn of_narrow_contact(bore: &BoreState) -> Option<String> {
    let (touching, all) = (bore.touching, bore.loads.len());
    (touching < FEW_TOUCH.min(all)).then(|| {
        format!(
            "{touching} of {all} bore nodes touch: so narrow a contact is as stiff as the mesh there makes it, and frequencies and displacements of the race \
             move with it; take more cells around and along the bore until they stay where they are"
        )
    })
}

/// Remarks on a state of a solid of rubber: a volume and chains that the law was not made for.
///
/// # Errors
/// An element turned inside out.
pub fn of_rubber(model: &RubberModel, displacement: &[Vec3]) -> Result<Vec<String>, StepFailure> {
    let mut remarks = Vec::new();
    let [least, most] = volume_changes(model, displacement)?;
    let far = if -least > most { least } else { most };
    let is_rubber = far.abs() <= LARGEST_VOLUME_CHANGE;
    if !is_rubber {
        remarks.push(format!(
            "the volume of rubber comes to {} of what it is at rest: its law is for volumes that change by some per cent, so \
             that these results are of no real part; check displacements, loads and the bulk modulus",
            to_digits(1.0 + far, 3)
        ));
    }
    let chain = longest_chain(model, displacement)?;
    let within = chain <= LONGEST_CHAIN;
    if !within && model.problem.material.network.pull == ChainPull::FiveTerms {
        remarks.push(format!(
            "chains of the network come to {} of their straight length, where five terms pull less than chains do (a tenth less at \
             0.8, a fifth at 0.85, nothing holds them at 1); compare with chain_pull = \"inverse-langevin\"",
            to_digits(chain, 3)
        ));
    }
    Ok(remarks)
}

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
    let mut state = Strained::of(model, &session.displacement(0), &stresses.cell);
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
    let sudden = of_sudden(model, session.clock.step);
    of_locking(model).into_iter().chain(sudden).chain(of_law(&state, &when)).collect()
}

/// Steps that a load or a support needs from one corner of its profile to the next, or for a period: the impulse of half a sine in
/// ten steps is off by (π/10)²/12, 0.8 %.
const FEWEST_STEPS: f64 = 10.0;

/// Loads and supports that change within a few steps (s): what they do depends on where the steps fall.
fn of_sudden(model: &SolidModel, step: f64) -> Option<String> {
    let loads = model.problem.loads.iter().map(|load| &load.profile);
    let all = loads.chain(model.problem.prescribed.iter().map(|held| &held.profile));
    let within = all.map(shortest_change).fold(f64::INFINITY, f64::min);
    let is_long = within >= FEWEST_STEPS * step;
    (!is_long).then(|| {
        format!(
            "a load or support changes within {} s, and steps are {} s long: what it does depends on where the steps fall; give a \
             shorter numerics.step, or a numerics.step_fraction",
            to_digits(within, 3),
            to_digits(step, 3)
        )
    })
}

/// Shortest time between two corners, or the period, s; infinite where there is neither. Jumps take no time.
fn shortest_change(profile: &Profile) -> f64 {
    if profile.cycles() > 0.0 {
        return 1.0 / profile.cycles();
    }
    let mut corners = profile.corners();
    corners.sort_by(f64::total_cmp);
    let apart = corners.windows(2).map(|pair| pair[1] - pair[0]).filter(|apart| *apart > 0.0);
    apart.fold(f64::INFINITY, f64::min)
}

/// What the jumps of the stresses say. Where four-node elements lock altogether they say too little (7 % for 98
/// in a clamped bar), and the law alone is reason enough.
fn of_mesh(model: &SolidModel, error: &EnergyError) -> Option<String> {
    if let Some(remark) = of_locking(model) {
        return Some(remark);
    }
    let judged = Judged::of(model, error);
    let [low, high] = [1.0, judged.at_most].map(|times| error.expected(times));
    let small = high <= SILENT;
    (!small).then(|| {
        format!(
            "the mesh is too coarse: displacements under these loads are expected to be {} to {} % too small, and \
             stresses are less certain than that ({}",
            to_digits(100.0 * low, 2),
            to_digits(100.0 * high, 2),
            judged.text(model, error)
        )
    })
}

/// What an estimate is worth on its mesh.
struct Judged {
    wall: Option<Wall>,
    /// The truth over the estimate.
    at_most: f64,
}

impl Judged {
    fn of(model: &SolidModel, error: &EnergyError) -> Judged {
        let elements = &model.problem.elements;
        // What misses next to nothing needs no walk through the mesh.
        let sound = error.part() <= 0.1 * SILENT;
        let wall = if sound { None } else { thinnest_wall(&model.problem.nodes, elements, THIN) };
        let through = wall.map_or(f64::INFINITY, |wall| wall.elements);
        Judged { wall, at_most: at_most(elements.order(), through) }
    }

    /// Where the numbers are from, and what to do.
    fn text(&self, model: &SolidModel, error: &EnergyError) -> String {
        let mut text = format!(
            "jumps of stress between elements say {} %, after Zienkiewicz and Zhu, of which the truth was \
             1 to {} times on meshes like this",
            to_digits(100.0 * error.part(), 2),
            self.at_most
        );
        if let Some(wall) = self.wall.filter(|wall| wall.elements < FEW) {
            let elements = to_digits(wall.elements, 2);
            let noun = if elements == 1.0 { "element" } else { "elements" };
            text += &format!(
                "); the thinnest walls have {elements} {noun} through them ({} mm{}",
                to_digits(1e3 * wall.thickness, 4),
                at(&wall.at)
            );
        }
        let poisson = model.problem.material.poisson_ratio();
        let order = model.problem.elements.order();
        if order == Order::Quadratic && poisson >= TEN_NODES_LOCK {
            text += &format!(
                "); at Poisson's ratio {} ten-node elements lock too, if less than four-node ones (of a bent bar \
                 two of them high, displacements are 9.5 % too small at 0.499, 1 % at 0.3",
                to_digits(poisson, 10)
            );
        }
        format!("{text}); {}", cure(model))
    }
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
    let error = energy_error(model, &shape, &nodal_stresses(model, &shape));
    let judged = Judged::of(model, &error);
    // A frequency goes with the root of the energy.
    let part = |times: f64| (1.0 - error.expected(times)).sqrt().recip() - 1.0;
    let [low, high] = [1.0, judged.at_most].map(part);
    let small = high <= SILENT;
    if small {
        return Vec::new();
    }
    vec![format!(
        "the mesh is too coarse: the lowest frequency is expected to be {} to {} % too high, and the others more \
         ({}",
        to_digits(100.0 * low, 2),
        to_digits(100.0 * high, 2),
        judged.text(model, &error)
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
