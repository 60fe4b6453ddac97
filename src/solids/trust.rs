//! How far a solid's displacements can be trusted: what its mesh is too coarse for, and what a linear
//! law does not hold for.

use crate::elements::tet4::Tet4;
use crate::elements::tet10::{self, Tet10};
use crate::kinematics::strain::{Sym3, von_mises};
use crate::kinematics::vec3::{Vec3, norm};
use crate::mesh::tet_mesh::{Elements, Order};
use crate::solids::model::{SolidModel, centre, corners};
use crate::solids::stress::point_stresses;

/// What an estimate from the stresses says of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EnergyError {
    /// Strain energy, J.
    pub energy: f64,
    /// Of the stresses' difference from smoothed ones, J: what the mesh is expected to miss.
    pub missing: f64,
}

impl EnergyError {
    /// Missing part of the energy of the exact solution. Under given loads, displacements along them are
    /// too small by as much; under given displacements forces are too large.
    pub fn part(&self) -> f64 {
        let whole = self.energy + self.missing;
        if whole > 0.0 { self.missing / whole } else { 0.0 }
    }

    /// The same, if the truth is `times` the estimate; no mesh misses all.
    pub fn expected(&self, times: f64) -> f64 {
        (times * self.part()).min(0.99)
    }
}

/// Elements through a wall below which they count as one, and as two.
const ONE: f64 = 1.5;
const TWO: f64 = 2.5;
/// With one, two, and more elements through the walls.
const LINEAR: [f64; 3] = [5.0, 2.5, 2.0];
const QUADRATIC: [f64; 3] = [7.0, 4.5, 3.5];

/// The truth over the estimate at most, by the elements through the thinnest walls: jumps of stress see the less of
/// what a mesh misses the fewer elements there are to jump between. At least it is 1.
///
/// Measured on clamped bars, blocks, pads and plates, bent and pulled, at Poisson's ratios of 0.3 to 0.4999
/// (four-node elements: below 0.45), and on a free ring, against fine meshes; tests repeat it.
pub fn at_most(order: Order, through: f64) -> f64 {
    let [one, two, more] = match order {
        Order::Linear => LINEAR,
        Order::Quadratic => QUADRATIC,
    };
    if through < ONE {
        one
    } else if through < TWO {
        two
    } else {
        more
    }
}

/// The error of Zienkiewicz and Zhu (1987): displacements of finite elements are continuous and their
/// stresses are not, so that smoothed stresses σ* (`nodal`, interpolated by the shape functions) are
/// nearer to the truth. The energy of σ* − σ estimates that of the error, ½ ∫ (σ* − σ) : C⁻¹ : (σ* − σ) dV.
///
/// It tends to the error as the mesh becomes finer, and is too small on the meshes of practice: see
/// [`at_most`]. `nodal` is what [`nodal_stresses`](crate::solids::stress::nodal_stresses) gives.
pub fn energy_error(model: &SolidModel, displacement: &[Vec3], nodal: &[Sym3]) -> EnergyError {
    let problem = &model.problem;
    let (shear, lambda) = (problem.material.shear_modulus, problem.material.lambda);
    // Of a stress: its deviator's energy and its mean's, s : s / 4G + (tr σ)² / 18 K.
    let bulk = lambda + 2.0 / 3.0 * shear;
    let density = |s: &Sym3| {
        let trace = s[0] + s[1] + s[2];
        let deviator = [s[0] - trace / 3.0, s[1] - trace / 3.0, s[2] - trace / 3.0];
        let squares = deviator.iter().map(|x| x * x).sum::<f64>()
            + 2.0 * s[3..].iter().map(|x| x * x).sum::<f64>();
        squares / (4.0 * shear) + trace * trace / (18.0 * bulk)
    };
    let less = |a: &Sym3, b: &Sym3| -> Sym3 { std::array::from_fn(|i| a[i] - b[i]) };
    let sound = "elements were checked when the model was made";
    let mut sum = EnergyError::default();
    for (element, at_points) in point_stresses(model, displacement).iter().enumerate() {
        match &problem.elements {
            Elements::Linear(list) => {
                let nodes = &list[element];
                let tet = Tet4::new(&corners(&problem.nodes, nodes)).expect(sound);
                let stress = &at_points[0];
                sum.energy += tet.volume * density(stress);
                let at = nodes.map(|node| less(&nodal[node as usize], stress));
                // The density is quadratic over the element: the four-point rule is exact.
                for point in 0..tet10::POINTS {
                    let shares = tet10::stiffness_rule(point);
                    let mixed = mixed(&shares, &at);
                    sum.missing += 0.25 * tet.volume * density(&mixed);
                }
            }
            Elements::Quadratic(list) => {
                let nodes = &list[element];
                let tet = Tet10::new(&corners(&problem.nodes, nodes)).expect(sound);
                let smooth = nodes.map(|node| nodal[node as usize]);
                for (point, stress) in at_points.iter().enumerate() {
                    let volume = tet.points[point].volume;
                    let shares = tet10::shape_functions(&tet10::stiffness_rule(point));
                    sum.energy += volume * density(stress);
                    sum.missing += volume * density(&less(&mixed(&shares, &smooth), stress));
                }
            }
        }
    }
    sum
}

fn mixed<const N: usize>(shares: &[f64; N], of: &[Sym3; N]) -> Sym3 {
    let mut sum = [0.0; 6];
    for (share, stress) in shares.iter().zip(of) {
        for (sum, s) in sum.iter_mut().zip(stress) {
            *sum += share * s;
        }
    }
    sum
}

/// A value and where it is, undeformed, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placed {
    pub value: f64,
    pub at: Vec3,
}

/// Largest von Mises stress of the elements, Pa, from their stresses.
pub fn largest_von_mises(model: &SolidModel, cells: &[Sym3]) -> Placed {
    let mut most = Placed::default();
    for (element, cell) in cells.iter().enumerate() {
        let value = von_mises(cell);
        if value > most.value {
            most = Placed { value, at: centre(&model.problem, element) };
        }
    }
    most
}

/// Largest displacement, m.
pub fn farthest(model: &SolidModel, displacement: &[Vec3]) -> Placed {
    let mut most = Placed::default();
    for (u, at) in displacement.iter().zip(&model.problem.nodes) {
        let value = norm(*u);
        if value > most.value {
            most = Placed { value, at: *at };
        }
    }
    most
}

/// Diagonal of the box around the undeformed body, m.
pub fn size(model: &SolidModel) -> f64 {
    let ends = [0, 1, 2].map(|axis: usize| {
        let along = model.problem.nodes.iter().map(|node| node[axis]);
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    });
    norm(ends.map(|[low, high]| high - low))
}
