//! Rigid motions that supports leave free.

use crate::kinematics::vec3::Vec3;
use crate::solids::model::Prescribed;
use nalgebra::{SMatrix, SVector, SymmetricEigen};

/// Names of the six rigid motions, in the order of [`FreeMotions::shares`].
pub const RIGID_MOTIONS: [&str; 6] =
    ["along x", "along y", "along z", "about x", "about y", "about z"];

/// The rigid motions without any prescribed component.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeMotions {
    /// Number, 0 to 6.
    pub count: usize,
    /// Component of each of [`RIGID_MOTIONS`], 0 to 1; rotations about the middle of the body.
    pub shares: [f64; 6],
}

impl FreeMotions {
    /// In words: "along x, about z".
    pub fn names(&self) -> String {
        let free = RIGID_MOTIONS.iter().zip(self.shares).filter(|(_, share)| *share > 1e-6);
        free.map(|(name, _)| *name).collect::<Vec<_>>().join(", ")
    }
}

/// Below this fraction of the square sum of the best supported motion a motion counts as free: supports 1e-4 of the
/// body's size apart still prevent a rotation.
const HELD: f64 = 1e-9;

/// Null space of the prescribed components over the rigid motions; small rotations, scaled by half the body's size.
pub fn free_motions(nodes: &[Vec3], prescribed: &[Prescribed]) -> FreeMotions {
    let (mut low, mut high) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for node in nodes {
        for i in 0..3 {
            low[i] = low[i].min(node[i]);
            high[i] = high[i].max(node[i]);
        }
    }
    let middle = [0, 1, 2].map(|i: usize| 0.5 * (low[i] + high[i]));
    let reach = (0..3).map(|i| 0.5 * (high[i] - low[i])).fold(f64::MIN_POSITIVE, f64::max);
    let mut gram = SMatrix::<f64, 6, 6>::zeros();
    for held in prescribed {
        let Some(node) = nodes.get(held.node as usize) else { continue };
        let [x, y, z] = [0, 1, 2].map(|i: usize| (node[i] - middle[i]) / reach);
        // Displacement t + ω × r along the axis.
        let row = match held.axis {
            0 => [1.0, 0.0, 0.0, 0.0, z, -y],
            1 => [0.0, 1.0, 0.0, -z, 0.0, x],
            2 => [0.0, 0.0, 1.0, y, -x, 0.0],
            // Such a problem is refused when the model is made.
            _ => continue,
        };
        let row = SVector::<f64, 6>::from(row);
        gram += row * row.transpose();
    }
    let eigen = SymmetricEigen::new(gram);
    let largest = eigen.eigenvalues.max().max(1.0);
    let mut free = FreeMotions { count: 0, shares: [0.0; 6] };
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value <= HELD * largest {
            free.count += 1;
            for (share, component) in free.shares.iter_mut().zip(vector.iter()) {
                *share += component * component;
            }
        }
    }
    free
}
