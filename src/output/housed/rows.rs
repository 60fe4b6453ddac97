//! Columns of the seat in a housing, the same whichever way it is solved.

use crate::ch2_housing::bore_contact::ContactSum;
use crate::kinematics::vec3::Vec3;
use crate::output::series::Column;
use crate::solver::housing::bore_equilibrium::BoreState;
use crate::solver::housing::condensed::CondensedBore;

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
