//! Reduced housings of an assembly, and the equilibrium from which a motion starts.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::contact::{normal_load, normal_stiffness};
use crate::ch2_housing::bore_contact::Penalty;
use crate::equilibrium::exact_gap_iteration::solve_with_true_distances;
use crate::equilibrium::initial::static_assembly;
use crate::equilibrium::lists::StaticSeat;
use crate::equilibrium::statics::{AssemblySolution, StaticsError};
use crate::members::bearing::Bearing;
use crate::members::housing_fit::Seat;
use crate::members::mount::Mount;
use crate::numeric::profile::Profile;
use crate::reduction::component_modes::Reduction;
use crate::solids::bore_equilibrium::Fit;
use crate::solids::condensation::CondensedBore;
use std::f64::consts::TAU;

/// Adds a reduced housing and the fit of a body in it. The housing starts at rest and undeformed, the body at its
/// `rest`.
pub fn add_housing(
    assembly: &mut Assembly,
    body: usize,
    reduction: &Reduction,
    bore: &CondensedBore,
    radius: Profile,
    penalty: Penalty,
) {
    let solid = assembly.solids.len();
    let seat: Seat = reduction.seat(bore, Mount::at_centre(body), solid, radius, penalty);
    assembly.seats.push(seat);
    assembly.solids.push(reduction.solid.clone());
}

/// A reduced housing in the search for equilibrium.
pub struct Housing<'h> {
    pub reduction: &'h Reduction,
    /// The condensed bore; updated by the search.
    pub bore: &'h mut CondensedBore,
    /// Fit of the race at t = 0.
    pub fit: Fit,
    pub penalty: Penalty,
}

/// Moves bodies in bores, and their solids, to equilibrium under the loads at t = 0. There is one housing for each
/// housing fit, in their order.
///
/// The bore is represented by the modes, so that nothing oscillates because of omitted modes, and its nodes have the
/// distance from the race that they have in motion.
///
/// # Errors
///
/// No equilibrium.
pub fn put_in_equilibrium(
    assembly: &mut Assembly,
    housings: &mut [Housing],
) -> Result<AssemblySolution, StaticsError> {
    let as_it_was: Vec<_> = housings
        .iter_mut()
        .map(|Housing { reduction, bore, .. }| {
            let compliance = std::mem::replace(&mut bore.compliance, reduction.compliance());
            (compliance, std::mem::replace(&mut bore.own, reduction.own()))
        })
        .collect();
    let found = {
        let mut still = static_assembly(assembly, 0.0, &[]);
        let seats: Vec<StaticSeat> = assembly
            .seats
            .iter()
            .zip(&*housings)
            .map(|(seat, housing)| StaticSeat {
                name: seat.label.clone(),
                mount: still.attachment_of(&seat.race),
                nominal: housing.bore.reach.nominal,
                bore: housing.bore,
                penalty: housing.penalty,
                fit: housing.fit,
            })
            .collect();
        still.seats = seats;
        solve_with_true_distances(&still, |index, state| {
            let Housing { reduction, bore, .. } = &housings[index];
            reduction.beyond_normals(bore, state)
        })
    };
    for (housing, (compliance, own)) in housings.iter_mut().zip(as_it_was) {
        (housing.bore.compliance, housing.bore.own) = (compliance, own);
    }
    let found = found?;
    for ((seat, state), housing) in assembly.seats.iter().zip(&found.seats).zip(&*housings) {
        assembly.bodies[seat.race.body].rest = found.coordinates[seat.race.body].into();
        assembly.solids[seat.solid].start = housing.reduction.rest(&state.loads);
    }
    Ok(found)
}

/// Natural frequency of a ball between its races, Hz, under `force` (N) on the bearing: the highest frequency of
/// excitation in a bearing.
pub fn ball_frequency(bearing: &Bearing, force: f64) -> f64 {
    let [inner, outer] = [bearing.inner_contact.stiffness, bearing.outer_contact.stiffness];
    // The most loaded ball carries five times the mean load (Stribeck), in addition to the preload of a bearing without
    // clearance.
    let preload = (-bearing.geometry.radial_clearance).max(0.0);
    let share = libm::cbrt((outer / inner) * (outer / inner));
    let overlap = preload * share / (1.0 + share);
    let load = 5.0 * force / bearing.geometry.ball_count as f64 + normal_load(inner, overlap);
    let stiffness = |of: f64| normal_stiffness(of, libm::cbrt((load / of) * (load / of)));
    ((stiffness(inner) + stiffness(outer)) / bearing.ball.mass).sqrt() / TAU
}
