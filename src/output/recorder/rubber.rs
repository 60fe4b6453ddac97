//! Columns of a solid of rubber: what it holds and has lost, largest values, probes and reactions.

use super::{Recorder, length, mean, probe_columns};
use crate::kinematics::strain::von_mises;
use crate::output::series::Column;
use crate::output::session::SessionError;
use crate::scene::solid_problem::{NamedNodes, Support};
use crate::solver::solid::rubber::error::{RubberError, StepFailure};
use crate::solver::solid::rubber::measures::{network_energy, point_stresses};
use crate::solver::solid::rubber::steps::RubberSolid;

pub(super) fn columns(probes: &[NamedNodes], supports: &[Support]) -> Vec<Column> {
    // The last of the three is held in the Maxwell elements or lost in them.
    let names = ["energy_strain", "work_external", "energy_viscous"];
    let mut columns = names.map(|name| Column::new(name, "J")).to_vec();
    columns.push(Column::new("largest_displacement", "m"));
    columns.push(Column::new("largest_von_mises", "Pa"));
    columns.extend(probe_columns(probes, supports));
    columns
}

impl Recorder {
    /// Adds a row of a solid of rubber.
    ///
    /// # Errors
    /// A state that cannot be.
    pub(in crate::output) fn record_rubber(
        &mut self,
        solid: &RubberSolid,
    ) -> Result<(), SessionError> {
        let (model, state) = (solid.model(), solid.state());
        let cannot_be = |failure: StepFailure| {
            SessionError::Rubber(RubberError::NoEquilibrium {
                time: state.time,
                step: 0.0,
                failure,
            })
        };
        let held = network_energy(model, &state.displacement).map_err(cannot_be)?;
        let stresses = point_stresses(model, state).map_err(cannot_be)?;
        let largest = state.displacement.iter().map(length).fold(0.0, f64::max);
        let stress = stresses.as_flattened().iter().map(von_mises).fold(0.0, f64::max);
        self.values.extend([state.time, held, state.work, state.work - held, largest, stress]);
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
