//! A shaft at rest as few of its stations feel it: all others eliminated.

use super::beam::{BeamMatrices, STATION};
use nalgebra::{DMatrix, DVector};

/// A force (N) and a moment (N·m) on a station.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StationLoad {
    pub station: usize,
    /// Along X, Y, Z and about Y, Z.
    pub load: [f64; 5],
}

/// Stiffness and loads over x, y, z (m), turn_y, turn_z (rad) of the stations that were kept, one after the other.
#[derive(Clone, Debug, PartialEq)]
pub struct CondensedBeam {
    pub stiffness: DMatrix<f64>,
    pub loads: DVector<f64>,
}

impl BeamMatrices {
    /// What is felt at the stations `kept` when `loads` act on the shaft; [`None`] where what is between them could move
    /// freely, as it does if no station is kept.
    pub fn condensed(&self, kept: &[usize], loads: &[StationLoad]) -> Option<CondensedBeam> {
        if kept.is_empty() {
            return None;
        }
        let stations = self.stations.len();
        let mut axial = DVector::zeros(stations);
        let mut lateral = DVector::zeros(STATION * stations);
        for StationLoad { station, load: [x, own @ ..] } in loads {
            axial[*station] += x;
            for (i, value) in own.iter().enumerate() {
                lateral[STATION * station + i] += value;
            }
        }
        let own: Vec<usize> = kept.iter().flat_map(|&station| self.coordinates(station)).collect();
        let [stretch, pull] = schur(&self.axial_stiffness, &axial, kept)?;
        let [bending, load] = schur(&self.stiffness, &lateral, &own)?;
        // x of a station, then its lateral coordinates.
        let part = |i: usize| (i / 5, i % 5);
        let stiffness =
            DMatrix::from_fn(5 * kept.len(), 5 * kept.len(), |i, j| match (part(i), part(j)) {
                ((a, 0), (b, 0)) => stretch[(a, b)],
                ((_, 0), _) | (_, (_, 0)) => 0.0,
                ((a, i), (b, j)) => bending[(STATION * a + i - 1, STATION * b + j - 1)],
            });
        let loads = DVector::from_fn(5 * kept.len(), |i, _| match part(i) {
            (a, 0) => pull[(a, 0)],
            (a, i) => load[(STATION * a + i - 1, 0)],
        });
        Some(CondensedBeam { stiffness, loads })
    }
}

/// Stiffness over the coordinates `kept` and the load there (one column), the others in equilibrium.
fn schur(
    stiffness: &DMatrix<f64>,
    load: &DVector<f64>,
    kept: &[usize],
) -> Option<[DMatrix<f64>; 2]> {
    let mut is_kept = vec![false; load.len()];
    kept.iter().for_each(|&i| is_kept[i] = true);
    let gone: Vec<usize> = (0..load.len()).filter(|&i| !is_kept[i]).collect();
    let part = |rows: &[usize], columns: &[usize]| {
        DMatrix::from_fn(rows.len(), columns.len(), |i, j| stiffness[(rows[i], columns[j])])
    };
    let at = |rows: &[usize]| DMatrix::from_fn(rows.len(), 1, |i, _| load[rows[i]]);
    let cross = part(kept, &gone);
    let factor = part(&gone, &gone).cholesky()?;
    let left = part(kept, kept) - &cross * factor.solve(&cross.transpose());
    let loads = at(kept) - &cross * factor.solve(&at(&gone));
    Some([(&left + left.transpose()) * 0.5, loads])
}
