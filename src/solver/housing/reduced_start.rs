//! A bearing in a reduced housing as one assembly of bodies, bearing, solid and seat, and the equilibrium that it starts from.

use super::assembly::{AssemblyError, AssemblyOptions, AssemblySearch, AssemblyState};
use super::bore_equilibrium::{BoreSearch, Fit};
use super::condensed::{CondensedBore, placed};
use super::reduce::Reduction;
use crate::ch2_housing::bearing::contact::{normal_load, normal_stiffness};
use crate::ch2_housing::bore_contact::Penalty;
use crate::kinematics::euler::angles;
use crate::kinematics::vec3::{Vec3, add_scaled};
use crate::solver::dynamics::assembly::{Assembly, OUTER};
use crate::solver::dynamics::model::{Drive, DynamicProblem};
use crate::solver::mount::Mount;
use crate::solver::profile::Profile;
use std::f64::consts::TAU;

/// The bearing with its outer race in the bore of the reduced housing, which starts still and undeformed with the
/// race where `problem.outer_start` has it.
pub fn housed(
    problem: &DynamicProblem,
    reduction: &Reduction,
    bore: &CondensedBore,
    radius: Profile,
    penalty: Penalty,
) -> Assembly {
    let mut assembly = problem.assembly();
    assembly.seats.push(reduction.seat(bore, Mount::at_centre(OUTER), 0, radius, penalty));
    assembly.solids.push(reduction.solid.clone());
    assembly
}

/// Puts outer race and housing of [`housed`] where they are in equilibrium under the loads at t = 0 (forces on the
/// outer race; of moments on it nothing is known here), the race grown as `fit` says.
///
/// The bore is taken as the shapes have it, so that nothing rings of what they leave out; `bore` is as it was afterwards.
///
/// # Errors
/// No equilibrium.
pub fn put_in_equilibrium(
    assembly: &mut Assembly,
    problem: &DynamicProblem,
    reduction: &Reduction,
    bore: &mut CondensedBore,
    fit: &Fit,
    penalty: Penalty,
) -> Result<AssemblyState, AssemblyError> {
    let compliance = std::mem::replace(&mut bore.compliance, reduction.compliance());
    let own = std::mem::replace(&mut bore.own, reduction.own());
    let found = {
        let search = BoreSearch::new(bore, penalty);
        let mut search = AssemblySearch::new(search, AssemblyOptions::default());
        search.solve(&problem.statics(0.0), fit, on_outer(problem))
    };
    (bore.compliance, bore.own) = (compliance, own);
    let state = found?;
    let pose = placed(&bore.reach.nominal, &state.bore.pose);
    let (_, tilt_y, tilt_z) = angles(&pose.orientation);
    let [x, y, z] = pose.position.into();
    assembly.bodies[OUTER].rest = [x, y, z, tilt_y, tilt_z];
    assembly.solids[0].start = reduction.rest(&state.bore.loads);
    Ok(state)
}

/// Natural frequency of a ball between its races, Hz, where `force` (N) is on the bearing: nothing in a bearing
/// pushes its races faster.
pub fn ball_frequency(problem: &DynamicProblem, force: f64) -> f64 {
    let [inner, outer] = [problem.inner_contact.stiffness, problem.outer_contact.stiffness];
    // The ball under the load carries five times the mean of all (Stribeck), besides the preload of a bearing
    // without clearance.
    let preload = (-problem.geometry.radial_clearance).max(0.0);
    let share = libm::cbrt((outer / inner) * (outer / inner));
    let overlap = preload * share / (1.0 + share);
    let load = 5.0 * force / problem.geometry.ball_count as f64 + normal_load(inner, overlap);
    let stiffness = |of: f64| normal_stiffness(of, libm::cbrt((load / of) * (load / of)));
    ((stiffness(inner) + stiffness(outer)) / problem.ball.mass).sqrt() / TAU
}

/// Weight of the outer race and forces on it at t = 0, N.
fn on_outer(problem: &DynamicProblem) -> Vec3 {
    let Some(outer) = &problem.outer else { return [0.0; 3] };
    let given = [0, 1, 2].map(|i: usize| match &outer.drives[i] {
        Drive::Load(load) => load.value(0.0),
        Drive::Motion(_) => 0.0,
    });
    add_scaled(given, outer.inertia.mass, problem.gravity)
}
