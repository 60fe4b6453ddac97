//! Elastic shafts in an equilibrium: energy, load and stiffness over the coordinates of the bodies that sit on them.

use super::static_assembly::StaticShaft;
use super::static_model::{Evaluation, Model};
use nalgebra::DVector;

/// The bodies' tilts are Euler angles where the shaft's are small turns: they differ by their squares.
pub(super) fn add_shaft(model: &Model, shaft: &StaticShaft, here: &mut Evaluation) {
    let firsts: Vec<Option<usize>> =
        shaft.bodies.iter().map(|&body| model.first_unknown(body)).collect();
    let mut at = DVector::zeros(5 * firsts.len());
    for (own, first) in firsts.iter().enumerate() {
        if let Some(first) = first {
            at.fixed_rows_mut::<5>(5 * own).copy_from(&here.at.fixed_rows::<5>(*first));
        }
    }
    let pull = &shaft.stiffness * &at;
    here.energy += 0.5 * at.dot(&pull) - at.dot(&shaft.loads);
    for (one, row) in firsts.iter().enumerate() {
        let Some(row) = *row else { continue };
        let mut gradient = here.gradient.fixed_rows_mut::<5>(row);
        gradient += pull.fixed_rows::<5>(5 * one) - shaft.loads.fixed_rows::<5>(5 * one);
        for (other, column) in firsts.iter().enumerate() {
            let Some(column) = *column else { continue };
            let mut block = here.stiffness.fixed_view_mut::<5, 5>(row, column);
            block += shaft.stiffness.fixed_view::<5, 5>(5 * one, 5 * other);
        }
    }
}
