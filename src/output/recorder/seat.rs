//! Columns of the seat in a housing, the same whichever way it is solved, and of what stands beside it:
//! the housing in explicit steps, or the races in equilibrium.

use super::{Recorder, solid::check_finite};
use crate::ch2_housing::bore_contact::ContactSum;
use crate::kinematics::vec3::Vec3;
use crate::output::course::{Course, outer_place};
use crate::output::series::Column;
use crate::output::session::{LedgerWatch, SessionError};
use crate::solver::dynamics::state::Ledger;
use crate::solver::housing::bore_equilibrium::BoreState;
use crate::solver::housing::condensed::CondensedBore;
use crate::solver::housing::exchange::HousedBearing;
use crate::solver::solid::stress::first_inverted;

/// The seat at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SeatRow {
    /// Of the bore on the outer race, N, and about its centre, N·m.
    pub force: Vec3,
    pub moment: Vec3,
    pub touching: usize,
    /// m.
    pub deepest: f64,
    /// Pa.
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

    /// In the order of [`seat_columns`].
    pub fn values(&self) -> [f64; 9] {
        let ([x, y, z], [a, b, c]) = (self.force, self.moment);
        let touching = self.touching as f64;
        [x, y, z, a, b, c, touching, self.deepest, self.peak_pressure]
    }
}

pub fn seat_columns() -> Vec<Column> {
    let axes = ["x", "y", "z"];
    let mut columns: Vec<Column> = Vec::new();
    columns.extend(axes.map(|a| Column::new(format!("housing_force_on_outer_{a}"), "N")));
    columns.extend(axes.map(|a| Column::new(format!("housing_moment_on_outer_{a}"), "N m")));
    columns.push(Column::new("bore_nodes_touching", "1"));
    columns.push(Column::new("bore_deepest_penetration", "m"));
    columns.push(Column::new("bore_peak_pressure", "Pa"));
    columns
}

/// Beside the bearing's own.
pub(super) fn explicit_columns() -> Vec<Column> {
    let mut columns = seat_columns();
    for name in [
        "energy_housing_strain",
        "energy_housing_kinetic",
        "energy_seat",
        "work_housing_on_outer",
        "work_on_housing",
        "work_housing_damping",
        "work_fit",
        "energy_coupled_residual",
    ] {
        columns.push(Column::new(name, "J"));
    }
    columns.extend(
        ["x", "y", "z"].map(|a| Column::new(format!("housing_impulse_on_outer_{a}"), "N s")),
    );
    columns
}

/// Of equilibria, with the loads of so many balls.
pub(super) fn equilibrium_columns(balls: usize) -> Vec<Column> {
    let mut columns = Vec::new();
    for race in ["inner", "outer"] {
        for (name, unit) in
            [("x", "m"), ("y", "m"), ("z", "m"), ("tilt_y", "deg"), ("tilt_z", "deg")]
        {
            columns.push(Column::new(format!("{race}_{name}"), unit));
        }
    }
    for race in ["inner", "outer"] {
        let axes = ["x", "y", "z"];
        columns.extend(axes.map(|a| Column::new(format!("contact_force_on_{race}_{a}"), "N")));
    }
    columns.extend(seat_columns());
    columns.push(Column::new("energy_housing_strain", "J"));
    columns.push(Column::new("energy_seat", "J"));
    for ball in 1..=balls {
        columns.push(Column::new(format!("ball_{ball}_inner_load"), "N"));
        columns.push(Column::new(format!("ball_{ball}_outer_load"), "N"));
    }
    columns
}

impl Recorder {
    /// Adds a row of bearing and housing in explicit steps.
    ///
    /// # Errors
    /// A value that is not finite, an inverted element, a ledger that does not close.
    pub(in crate::output) fn record_housed(
        &mut self,
        housed: &mut HousedBearing,
        watch: &mut LedgerWatch,
        limit: f64,
    ) -> Result<(), SessionError> {
        let (time, window) = (housed.time(), housed.exchanges);
        let displacement: Vec<Vec3> =
            housed.solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
        check_finite(&housed.solid, &displacement, time, window)?;
        if let Some((element, ratio)) = first_inverted(&housed.solid.model, &displacement) {
            return Err(housed.solid.model.inverted(element, ratio, time, window).into());
        }
        let snapshot = housed.snapshot()?;
        let residual = snapshot.residual;
        if !watch.see(residual, snapshot.turned_over, limit) {
            let turned_over = watch.turned_over;
            return Err(SessionError::EnergyOfBoth { residual, turned_over, limit, time, window });
        }
        self.record(&housed.bearing, &snapshot.bearing);
        let solid = &snapshot.solid;
        self.values.extend(SeatRow::of_contact(&snapshot.contact).values());
        self.values.extend([
            solid.energy.strain,
            solid.energy.kinetic,
            snapshot.contact.energy,
            snapshot.bearing.ledger[Ledger::Foundation as usize],
            solid.external_work,
            solid.damping_work,
            snapshot.growth_work,
            residual,
        ]);
        self.values.extend(housed.impulse);
        Ok(())
    }

    /// Adds a row of the latest equilibrium.
    pub(in crate::output) fn record_equilibrium(&mut self, course: &Course) {
        let Some(moment) = &course.latest else { return };
        let (bore, state) = (course.bore(), &moment.state);
        let inner = &state.bearing.coordinates;
        let [x, y, z, tilt_y, tilt_z] = outer_place(bore, state);
        let degrees = f64::to_degrees;
        let full = self.values.len() + self.columns.len();
        self.values.push(moment.time);
        self.values.extend([inner[0], inner[1], inner[2], degrees(inner[3]), degrees(inner[4])]);
        self.values.extend([x, y, z, degrees(tilt_y), degrees(tilt_z)]);
        self.values.extend(state.bearing.force_on_inner.iter());
        self.values.extend(state.bearing.force_on_outer.iter());
        self.values.extend(SeatRow::of_equilibrium(bore, &state.bore).values());
        self.values.extend([state.bore.elastic_energy, state.bore.contact_energy]);
        // As far as the loads of balls are recorded.
        let loads = state.bearing.balls.iter();
        let loads = loads.flat_map(|ball| [ball.inner.normal_load, ball.outer.normal_load]);
        self.values.extend(loads.take(full - self.values.len()));
    }
}
