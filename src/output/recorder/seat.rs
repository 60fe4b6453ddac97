//! Columns of housing fits, the same for every housing method, and of housings in explicit steps.

use super::{Recorder, channels::connection_columns, shaft, solid::check_finite};
use crate::ch2_housing::bore_contact::ContactSum;
use crate::kinematics::vec3::Vec3;
use crate::members::rigid_body::Wrench;
use crate::motion::bonded_bushing::BondedPart;
use crate::motion::bore_friction::FrictionSum;
use crate::motion::coupling::{CoupledMotion, CouplingError};
use crate::motion::race_in_bore::Seat;
use crate::output::series::Column;
use crate::output::session::{HousedParts, LedgerWatch, SessionError};
use crate::solids::bore_equilibrium::BoreState;
use crate::solids::condensation::CondensedBore;
use crate::solids::error::SolidError;
use crate::solids::explicit::ExplicitSolid;
use crate::solids::stress::first_inverted;

/// Contact of a race with its bore at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeatRow {
    /// Force of the bore on the outer race, N, and moment about its centre, N·m.
    pub force: Vec3,
    pub moment: Vec3,
    pub touching: usize,
    /// Deepest penetration, m.
    pub deepest: f64,
    /// Largest contact pressure, Pa.
    pub peak_pressure: f64,
}

impl SeatRow {
    pub fn of_contact(sum: &ContactSum) -> SeatRow {
        SeatRow {
            force: sum.force,
            moment: sum.moment,
            touching: sum.touching,
            deepest: sum.deepest,
            peak_pressure: sum.peak_pressure,
        }
    }

    pub fn of_equilibrium(bore: &CondensedBore, state: &BoreState) -> SeatRow {
        let [y, z, about_y, about_z] = state.load;
        SeatRow {
            force: bore.to_world([0.0, -y, -z]),
            moment: bore.to_world([0.0, -about_y, -about_z]),
            touching: state.touching,
            deepest: state.deepest(),
            peak_pressure: state.pressure(bore).into_iter().fold(0.0, f64::max),
        }
    }

    /// Values in the order of [`seat_columns`].
    pub fn values(&self) -> [f64; 9] {
        let ([x, y, z], [a, b, c]) = (self.force, self.moment);
        let touching = self.touching as f64;
        [x, y, z, a, b, c, touching, self.deepest, self.peak_pressure]
    }
}

/// Columns of one fit; `prefix` starts each name.
pub fn seat_columns(prefix: &str) -> Vec<Column> {
    let axes = ["x", "y", "z"];
    let mut columns: Vec<Column> = Vec::new();
    columns.extend(axes.map(|a| Column::new(format!("{prefix}housing_force_on_outer_{a}"), "N")));
    columns
        .extend(axes.map(|a| Column::new(format!("{prefix}housing_moment_on_outer_{a}"), "N m")));
    columns.push(Column::new(format!("{prefix}bore_nodes_touching"), "1"));
    columns.push(Column::new(format!("{prefix}bore_deepest_penetration"), "m"));
    columns.push(Column::new(format!("{prefix}bore_peak_pressure"), "Pa"));
    columns
}

/// Columns of the friction of one fit. Its force and moment are included in those of the housing.
fn friction_columns(prefix: &str) -> Vec<Column> {
    let mut columns = Vec::new();
    for (what, unit) in [("force", "N"), ("moment", "N m")] {
        let name = |axis| format!("{prefix}friction_{what}_on_outer_{axis}");
        columns.extend(["x", "y", "z"].map(|axis| Column::new(name(axis), unit)));
    }
    columns.push(Column::new(format!("{prefix}bore_nodes_slipping"), "1"));
    for name in ["energy_friction", "heat_friction", "work_friction_load"] {
        columns.push(Column::new(format!("{prefix}{name}"), "J"));
    }
    columns
}

/// Values in the order of [`friction_columns`].
fn friction_values(sum: &FrictionSum) -> [f64; 10] {
    let ([x, y, z], [a, b, c]) = (sum.force, sum.moment);
    [x, y, z, a, b, c, sum.slipping as f64, sum.stored, sum.heat, sum.load_work]
}

/// Column prefix such as `left_`; empty for an unnamed part.
pub fn prefix(name: &Option<String>) -> String {
    name.as_ref().map_or(String::new(), |name| format!("{name}_"))
}

/// Columns in addition to those of bearings. Fits are grouped by solid, as in the exchange; bushings have the columns of
/// springs and their energies.
pub(super) fn explicit_columns(parts: &HousedParts) -> Vec<Column> {
    let HousedParts { solids, seats, bushings, .. } = parts;
    let housings = solids.iter().filter(|solid| solid.shaft.is_none() && solid.cage.is_none());
    let of_solids: Vec<String> = housings.map(|solid| prefix(&solid.name)).collect();
    let by_solid: Vec<&Seat> = (0..solids.len())
        .flat_map(|index| seats.iter().filter(move |s| s.solid == index))
        .collect();
    let of_seats: Vec<String> = by_solid.iter().map(|seat| prefix(&seat.name)).collect();
    let mut columns: Vec<Column> = of_seats.iter().flat_map(|seat| seat_columns(seat)).collect();
    let mut energies = |prefixes: &[String], names: &[&str]| {
        for prefix in prefixes {
            columns.extend(names.iter().map(|name| Column::new(format!("{prefix}{name}"), "J")));
        }
    };
    energies(&of_solids, &["energy_housing_strain", "energy_housing_kinetic"]);
    energies(&of_seats, &["energy_seat", "work_housing_on_outer"]);
    energies(&of_solids, &["work_on_housing", "work_housing_damping"]);
    energies(&of_seats, &["work_fit"]);
    for BondedPart { name, .. } in bushings {
        columns.extend(connection_columns(name));
        let energies = BUSHING_ENERGIES.map(|of| Column::new(format!("{name}_{of}"), "J"));
        columns.extend(energies);
    }
    columns.extend(solids.iter().flat_map(shaft::columns));
    columns.push(Column::new("energy_coupled_residual", "J"));
    for seat in &of_seats {
        let name = |axis| format!("{seat}housing_impulse_on_outer_{axis}");
        columns.extend(["x", "y", "z"].map(|axis| Column::new(name(axis), "N s")));
    }
    let rough = by_solid.iter().filter(|seat| seat.friction.is_some());
    columns.extend(rough.flat_map(|seat| friction_columns(&prefix(&seat.name))));
    columns
}

/// Energies and works of a bushing in elements. Those of the Maxwell elements follow the law of small strain;
/// `energy_finite_strain` is the contribution of finite strain.
const BUSHING_ENERGIES: [&str; 6] = [
    "energy_strain",
    "energy_maxwell",
    "energy_kinetic",
    "energy_dissipated",
    "energy_finite_strain",
    "work_on_bodies",
];

impl Recorder {
    /// Adds a row of bearings and housings in explicit steps.
    ///
    /// # Errors
    /// A value that is not finite, an inverted element, an energy balance that does not close.
    pub(in crate::output) fn record_housed(
        &mut self,
        housed: &mut CoupledMotion,
        watch: &mut LedgerWatch,
        limit: f64,
    ) -> Result<(), SessionError> {
        let (time, coupling_step) = (housed.time(), housed.exchanges);
        for part in &housed.solids {
            check_solid(&part.solid, time, coupling_step).map_err(|source| {
                let name = part.name.clone();
                CouplingError::Solid { name, source }
            })?;
        }
        let snapshot = housed.snapshot()?;
        let residual = snapshot.residual;
        if !watch.record(residual, snapshot.turned_over, snapshot.turned_over, limit) {
            let turned_over = watch.turned_over;
            return Err(SessionError::EnergyOfBoth {
                residual,
                turned_over,
                limit,
                time,
                coupling_step,
            });
        }
        self.record(&housed.simulation, &snapshot.simulation);
        // In the order of [`explicit_columns`].
        let parts = || housed.solids.iter().zip(&snapshot.solids);
        let housings = || parts().filter(|(part, _)| part.kind() == "housing");
        let solids = || housings().map(|(_, solid)| &solid.ledger);
        let seats = || snapshot.solids.iter().flat_map(|solid| &solid.seats);
        let values = &mut self.values;
        seats().for_each(|seat| values.extend(SeatRow::of_contact(&seat.contact).values()));
        solids().for_each(|solid| values.extend([solid.energy.strain, solid.energy.kinetic]));
        seats().for_each(|seat| values.extend([seat.contact.energy, seat.work]));
        solids().for_each(|solid| values.extend([solid.external_work, solid.damping_work]));
        values.extend(seats().map(|seat| seat.growth_work));
        for (of, bushing) in snapshot.bushings.iter().zip(&housed.bushings) {
            let Wrench { force, moment } = of.loads[bushing.second];
            values.extend(force.into_iter().chain(moment));
            values.extend([of.network, of.springs, of.kinetic]);
            // Work up to the time of the rubber, so that the columns sum up to the residual.
            values.extend([of.dissipated, of.beyond, of.work + of.to_come]);
        }
        parts().for_each(|(part, now)| self.record_shaft(part, now));
        let values = &mut self.values;
        values.push(residual);
        values.extend(housed.seats().flat_map(|seat| seat.impulse));
        let rough = housed.seats().zip(seats()).filter(|(seat, _)| seat.friction.is_some());
        values.extend(rough.flat_map(|(_, now)| friction_values(&now.friction)));
        Ok(())
    }
}

/// # Errors
/// A value that is not finite, an inverted element.
fn check_solid(solid: &ExplicitSolid, time: f64, coupling_step: u64) -> Result<(), SolidError> {
    let displacement: Vec<Vec3> = solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
    check_finite(solid, &displacement, time, coupling_step)?;
    match first_inverted(&solid.model, &displacement) {
        Some((element, ratio)) => Err(solid.model.inverted(element, ratio, time, coupling_step)),
        None => Ok(()),
    }
}
