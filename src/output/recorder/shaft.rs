//! Columns of a shaft or cage in elements: its probes, its energies, and those of its joints or contacts.

use super::Recorder;
use crate::motion::coupling::SolidPart;
use crate::motion::explicit_shaft::JointSnapshot;
use crate::motion::explicit_solid::{SolidSnapshot, SteppedSolid};
use crate::output::series::Column;

/// Energy columns, J.
const ENERGIES: [&str; 8] = [
    "energy_strain",
    "energy_kinetic",
    "work_loads",
    "work_damping",
    "work_unbalance",
    "energy_joints",
    "heat_joints",
    "work_on_races",
];

/// Energy columns of a cage, J.
const OF_CAGE: [&str; 7] = [
    "energy_strain",
    "energy_kinetic",
    "work_loads",
    "work_damping",
    "energy_contacts",
    "heat_contacts",
    "work_on_balls_and_race",
];

/// Columns of a shaft or cage in elements; empty for other solids.
pub(super) fn columns(part: &SolidPart) -> Vec<Column> {
    if part.cage.is_some() {
        let name = part.name.as_deref().unwrap_or("cage");
        return OF_CAGE.map(|energy| Column::new(format!("{name}_{energy}"), "J")).to_vec();
    }
    let Some(shaft) = &part.shaft else { return Vec::new() };
    let name = part.name.as_deref().unwrap_or("shaft");
    let of = |section: &str, axis| Column::new(format!("{name}_{section}_{axis}"), "m");
    let sections = shaft.probes.iter();
    let mut columns: Vec<Column> =
        sections.flat_map(|(section, _)| [of(section, "y"), of(section, "z")]).collect();
    columns.extend(ENERGIES.map(|energy| Column::new(format!("{name}_{energy}"), "J")));
    columns
}

impl Recorder {
    /// Adds the values in the order of [`columns`].
    pub(super) fn record_shaft(&mut self, part: &SteppedSolid, now: &SolidSnapshot) {
        let of_joints = |of: fn(&JointSnapshot) -> f64| -> f64 { now.joints.iter().map(of).sum() };
        let ledger = &now.ledger;
        if part.cage.is_some() {
            self.values.extend([
                ledger.energy.strain,
                ledger.energy.kinetic,
                ledger.external_work,
                ledger.damping_work,
                of_joints(|contacts| contacts.stored),
                of_joints(|contacts| contacts.heat),
                of_joints(|contacts| contacts.work + contacts.to_come),
            ]);
            return;
        }
        let Some(shaft) = &part.shaft else { return };
        let centres = shaft.probe_centres(&part.solid);
        self.values.extend(centres.flat_map(|[_, y, z]| [y, z]));
        self.values.extend([
            ledger.energy.strain,
            ledger.energy.kinetic,
            ledger.external_work,
            ledger.damping_work,
            now.unbalance_work,
            of_joints(|joint| joint.stored),
            of_joints(|joint| joint.heat),
            // Work up to the time of the elements, so that the columns sum up to the residual.
            of_joints(|joint| joint.work + joint.to_come),
        ]);
    }
}
