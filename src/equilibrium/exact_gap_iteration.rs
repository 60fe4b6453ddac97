//! Equilibria with the exact gaps between bore nodes and races that the steps of a motion have.
//!
//! The nodes of a condensed bore move along fixed normals, which neglects the change of gap by a lateral displacement
//! δ, δ²/2r: some nanometres, for penetrations of some ten. A motion that started there would begin with an impact.
//! This part depends little on the loads, so that it is taken from one equilibrium to the next until it converges.

use crate::equilibrium::lists::StaticAssembly;
use crate::equilibrium::statics::{
    AssemblySolution, StaticOptions, StaticsError, solve_assembly_in,
};
use crate::solids::bore_equilibrium::{BoreError, BoreSearch, BoreState};

/// Largest change of a gap in the last iteration, as a fraction of the deepest penetration.
const SETTLED: f64 = 1e-7;
/// Rounding of gaps, m.
const ROUNDING: f64 = 1e-16;
const ROUNDS: usize = 25;

/// Equilibrium of `still`; `beyond` returns the part of each node's gap beyond that along fixed normals, m
/// ([`crate::solids::condensation::beyond_normals`]).
///
/// # Errors
///
/// No equilibrium; gaps that do not converge.
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
