//! Columns of a single solid: its energy balance, largest values, probes and reactions.

use super::Recorder;
use crate::kinematics::vec3::Vec3;
use crate::output::series::Column;
use crate::output::session::{LedgerWatch, SessionError};
use crate::scene::build::solid::{NamedNodes, Support};
use crate::solids::energy::SolidEnergy;
use crate::solids::error::SolidError;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::stress::check;

pub(super) fn columns(probes: &[NamedNodes], supports: &[Support]) -> Vec<Column> {
    let names =
        ["energy_strain", "energy_kinetic", "work_external", "work_damping", "energy_residual"];
    let mut columns = names.map(|name| Column::new(name, "J")).to_vec();
    columns.push(Column::new("largest_displacement", "m"));
    columns.push(Column::new("largest_von_mises", "Pa"));
    columns.extend(probe_columns(probes, supports));
    columns
}

pub fn probe_columns(probes: &[NamedNodes], supports: &[Support]) -> Vec<Column> {
    let mut columns = Vec::new();
    for probe in probes {
        columns.extend(["x", "y", "z"].map(|a| Column::new(format!("{}_{a}", probe.name), "m")));
    }
    for support in supports {
        for axis in support.axes() {
            let name = format!("reaction_{}_{}", support.name, ["x", "y", "z"][axis]);
            columns.push(Column::new(name, "N"));
        }
    }
    columns
}

impl Recorder {
    /// Adds a row of a single solid.
    ///
    /// # Errors
    /// A value that is not finite, an inverted element, an energy balance that does not close.
    pub(in crate::output) fn record_solid(
        &mut self,
        solid: &mut ExplicitSolid,
        watch: &mut LedgerWatch,
        limit: f64,
    ) -> Result<(), SessionError> {
        let (time, step) = (solid.time, solid.steps);
        let displacement: Vec<Vec3> =
            solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
        check_finite(solid, &displacement, time, step)?;
        let seen = check(&solid.model, &displacement);
        if let Some((element, ratio)) = seen.inverted {
            return Err(solid.model.inverted(element, ratio, time, step).into());
        }
        let ledger = solid.ledger();
        let SolidEnergy { strain, kinetic } = ledger.energy;
        let (external, damping) = (ledger.external_work, ledger.damping_work);
        let residual = ledger.balance() - watch.first;
        let turned_over = (strain + kinetic).max(external.abs()).max(damping.abs());
        if !watch.record(residual, turned_over, strain + kinetic, limit) {
            let turned_over = watch.turned_over;
            return Err(SessionError::Energy { residual, turned_over, limit, time, step });
        }
        let largest = displacement.iter().map(length).fold(0.0, f64::max);
        self.values.extend([time, strain, kinetic, external, damping, residual, largest]);
        self.values.push(seen.von_mises);
        for probe in &self.probes {
            self.values.extend(mean(&displacement, &probe.nodes));
        }
        let reactions = reactions(solid);
        for support in &self.supports {
            self.values.extend(support.total(&reactions));
        }
        Ok(())
    }
}

pub(super) fn check_finite(
    solid: &ExplicitSolid,
    displacement: &[Vec3],
    time: f64,
    step: u64,
) -> Result<(), SolidError> {
    match displacement.iter().position(|u| !u.iter().all(|x| x.is_finite())) {
        Some(node) => Err(solid.model.not_finite(node, time, step)),
        None => Ok(()),
    }
}

/// Support forces on the nodes at the time of the last energy balance, N; zero on free components.
fn reactions(solid: &ExplicitSolid) -> Vec<Vec3> {
    let (model, forces) = (&solid.model, solid.forces());
    let mut reactions = vec![[0.0; 3]; forces.len()];
    for prescribed in &model.problem.prescribed {
        let (node, axis) = (prescribed.node as usize, prescribed.axis);
        let inertia = model.mass[node] * prescribed.profile.acceleration(solid.time);
        reactions[node][axis] = inertia - forces[node][axis];
    }
    reactions
}

pub fn length(v: &Vec3) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

pub fn mean(of: &[Vec3], nodes: &[u32]) -> Vec3 {
    sum(of, nodes).map(|total| total / nodes.len() as f64)
}

pub fn sum(of: &[Vec3], nodes: &[u32]) -> Vec3 {
    let mut total = [0.0; 3];
    for node in nodes {
        for i in 0..3 {
            total[i] += of[*node as usize][i];
        }
    }
    total
}
