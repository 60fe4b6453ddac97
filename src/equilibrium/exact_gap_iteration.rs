//! Equilibria in which nodes of bores are as far from their races as the steps of a motion have them.
//!
//! A condensed bore moves along normals that stay, and a race that goes across them comes no nearer to its nodes: by δ²/2r for a way δ,
//! some nanometres, of the some ten by which a node is pressed in. A motion that started there would begin with a blow. What is left out
//! depends little on the loads, so that it is taken from one equilibrium for the next until nothing changes.

use crate::assembly::static_lists::StaticAssembly;
use crate::equilibrium::statics::{
    AssemblySolution, StaticOptions, StaticsError, solve_assembly_in,
};
use crate::solids::bore_equilibrium::{BoreError, BoreSearch, BoreState};

/// What a round may change of a distance, as a part of the deepest penetration of the bore.
const SETTLED: f64 = 1e-7;
/// Distances that rounding of places cannot tell, m.
const ROUNDING: f64 = 1e-16;
const ROUNDS: usize = 25;

/// Equilibrium of `still`, where `beyond` says of the nodes of each seat's bore how far they are from the race beyond what normals that
/// stay make it, m ([`crate::solids::condensation::beyond_normals`]).
///
/// # Errors
/// No equilibrium; distances that do not settle.
pub fn solve_with_true_distances<'b>(
    still: &StaticAssembly<'b>,
    beyond: impl Fn(usize, &BoreState) -> Vec<f64>,
) -> Result<AssemblySolution, StaticsError> {
    let seats = still.seats.iter();
    let mut bores: Vec<BoreSearch<'b>> =
        seats.map(|seat| BoreSearch::new(seat.bore, seat.penalty)).collect();
    let options = StaticOptions::default();
    let mut found = solve_assembly_in(still, &mut bores, None, &options)?;
    let mut known: Vec<Vec<f64>> =
        found.seats.iter().map(|state| vec![0.0; state.loads.len()]).collect();
    let mut moving = None;
    for _ in 0..ROUNDS {
        let next: Vec<Vec<f64>> =
            found.seats.iter().enumerate().map(|(index, state)| beyond(index, state)).collect();
        let moves = next.iter().zip(&known).zip(&found.seats).position(|((next, known), state)| {
            let allowed = SETTLED * state.deepest() + ROUNDING;
            !next.iter().zip(known).all(|(next, known)| (next - known).abs() <= allowed)
        });
        moving = moves.map(|index| still.seats[index].suffix());
        if moving.is_none() {
            return Ok(found);
        }
        bores.iter_mut().zip(&next).for_each(|(bore, next)| bore.keep_beyond(next.clone()));
        found = solve_assembly_in(still, &mut bores, Some(&found.coordinates), &options)?;
        known = next;
    }
    let source = BoreError::FarAcross { rounds: ROUNDS };
    Err(StaticsError::Seat { of: moving.unwrap_or_default(), source })
}
