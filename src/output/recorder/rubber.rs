//! Columns of a rubber solid: energies, largest values, probes and reactions.

use super::{Recorder, length, mean, probe_columns};
use crate::kinematics::strain::von_mises;
use crate::output::series::Column;
use crate::output::session::SessionError;
use crate::scene::build::solid::{NamedNodes, Support};
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::rubber::measures::{RubberLedger, point_stresses};
use crate::solids::rubber::steps::RubberSolid;

pub(super) fn columns(probes: &[NamedNodes], supports: &[Support]) -> Vec<Column> {
    // `energy_viscous` is the energy stored or dissipated in the Maxwell elements. The next three columns are its parts: stored
    // and dissipated by the law of small strain, and the contribution of finite strain. The last column is the residual.
    let names = [
        "energy_strain",
        "work_external",
        "energy_viscous",
        "energy_maxwell",
        "energy_dissipated",
        "energy_finite_strain",
        "energy_residual",
    ];
    let mut columns = names.map(|name| Column::new(name, "J")).to_vec();
    columns.push(Column::new("largest_displacement", "m"));
    columns.push(Column::new("largest_von_mises", "Pa"));
    columns.extend(probe_columns(probes, supports));
    columns
}

impl Recorder {
    /// Adds a row of a rubber solid.
    ///
    /// # Errors
    /// An invalid state.
    pub(in crate::output) fn record_rubber(
        &mut self,
        solid: &RubberSolid,
    ) -> Result<(), SessionError> {
        let (model, state) = (solid.model(), solid.state());
        let cannot_be = |failure: StepFailure| {
            SessionError::Solid(SolidError::NoEquilibrium { time: state.time, step: 0.0, failure })
        };
        let ledger = RubberLedger::of(model, state).map_err(cannot_be)?;
        let stresses = point_stresses(model, state).map_err(cannot_be)?;
        let largest = state.displacement.iter().map(length).fold(0.0, f64::max);
        let stress = stresses.as_flattened().iter().map(von_mises).fold(0.0, f64::max);
        let RubberLedger { network, springs, dissipated, beyond, work } = ledger;
        self.values.extend([state.time, network, work, work - network]);
        self.values.extend([springs, dissipated, beyond, ledger.residual(), largest, stress]);
        for probe in &self.probes {
            self.values.extend(mean(&state.displacement, &probe.nodes));
        }
        let reactions = solid.support_forces();
        for support in &self.supports {
            self.values.extend(support.total(&reactions));
        }
        Ok(())
    }
}
