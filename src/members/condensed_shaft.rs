//! Matrices of a shaft of tetrahedra over stations along its axis, instead of a beam's.
//!
//! The coordinates of a station ([`RotorSection`]) are the mean displacement of a section and its best-fit rotation.
//! The solid is condensed onto them: for a unit of each it takes the displacement of least strain energy, so that slow
//! loads on stations have the exact response; masses are those of these displacements. Omitted is motion within
//! sections and between stations, far above the frequencies of a bending shaft.
//!
//! A rotating axisymmetric body is described in space (Eulerian): with displacements u in axes that do not rotate, its
//! matter moves with ∂u/∂t + Ω ∂u/∂θ. A field u of bending towards Y and the same towards Z, u′, are of one harmonic
//! around: ∂u/∂θ = e × u − u′, without a numerical derivative. ∫ρ u̇·∂u/∂θ is the gyroscopic matrix; terms of Ω² are
//! ρΩ²r²/E (1e-6) of the stiffness, and omitted. The inertia and stiffness of a body that is not axisymmetric would
//! change in these axes with every turn: it is refused.

use crate::ch4_rotor::beam::{NODES, shortening};
use crate::ch4_rotor::section::RotorSection;
use crate::kinematics::vec3::{Vec3, dot, sub};
use crate::members::beam::{BeamMatrices, PlaneMatrices};
use crate::members::revolution::{
    AXES, CENTRED, NONE, centre_of_round, momenta, refuse_unlike, rigid,
};
use crate::mesh::MeshError;
use crate::mesh::tet_mesh::{Face, TetMesh};
use crate::mesh::vector_area::vector_areas;
use crate::numeric::profile::Profile;
use crate::numeric::sparse::{Factor, FactorError};
use crate::solids::error::SolidError;
use crate::solids::model::{Prescribed, SolidModel, SolidProblem};
use crate::solids::tangent::{PRESCRIBED, Unknowns, pattern, stiffness};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum SolidShaftError {
    #[error(transparent)]
    Mesh(#[from] MeshError),
    #[error(transparent)]
    Solid(#[from] SolidError),
    #[error(transparent)]
    Factor(#[from] FactorError),
    #[error(
        "no element of the shaft ends at {at} m: a bearing, load or disc needs a layer of nodes at its position"
    )]
    NoLayer { at: f64 },
    #[error("the section at {at} m has its centre {off} m off the axis X")]
    OffAxis { at: f64, off: f64 },
    #[error(
        "a rotating shaft in reduced form must be axisymmetric: {what} has a relative difference of \
         {part:.1e} between two directions normal to the axis; at most {most:.0e} is allowed"
    )]
    NotRound { what: &'static str, part: f64, most: f64 },
    #[error(
        "the segments have different materials; a shaft meshed with tetrahedra has one material"
    )]
    Materials,
}

/// Number of right-hand sides solved at once.
const BLOCK: usize = 32;

/// The section of a mesh at x = `at` (m): faces of elements that end there, on the side of the smaller area at a step.
///
/// # Errors
///
/// No such faces, or faces off the axis.
pub fn section(mesh: &TetMesh, at: f64) -> Result<RotorSection, SolidShaftError> {
    let near = 1e-7 * mesh.size();
    let (mut below, mut above) = (Vec::new(), Vec::new());
    for element in 0..mesh.elements.len() as u32 {
        let middle: f64 =
            mesh.corner_points(element as usize).iter().map(|place| 0.25 * place.x).sum();
        for side in 0..4 {
            let face = Face { element, side };
            let lies = |node: u32| (mesh.nodes[node as usize][0] - at).abs() <= near;
            if mesh.face_corners(face).into_iter().all(lies) {
                if middle < at { below.push(face) } else { above.push(face) }
            }
        }
    }
    let of = |faces: &[Face]| {
        let areas = (0u32..).zip(vector_areas(mesh, faces));
        // Faces on one side only; corners of curved six-node faces may have a slightly negative share.
        let carrying: Vec<(u32, f64)> =
            areas.map(|(node, area)| (node, area[0])).filter(|(_, area)| *area != 0.0).collect();
        let way = carrying.iter().map(|(_, area)| area).sum::<f64>().signum();
        let nodes: Vec<(u32, Vec3, f64)> = carrying
            .into_iter()
            .map(|(node, area)| (node, mesh.nodes[node as usize], way * area))
            .collect();
        RotorSection::new(&nodes)
    };
    let found = match [of(&below), of(&above)] {
        [Some(one), Some(other)] => Some(if one.area <= other.area { one } else { other }),
        [one, other] => one.or(other),
    };
    let section = found.ok_or(SolidShaftError::NoLayer { at })?;
    let off = libm::hypot(section.centre[1], section.centre[2]);
    if off > CENTRED * section.area.sqrt() {
        return Err(SolidShaftError::OffAxis { at, off });
    }
    Ok(section)
}

/// A free solid and its sections.
struct Body<'m> {
    problem: &'m SolidProblem,
    sections: &'m [RotorSection],
    /// Its centre of mass, m, the origin of rigid rotations.
    origin: Vec3,
    factor: Factor,
    unknowns: Unknowns,
}

/// Loads on stations, the corresponding rigid motions, and their values at the stations.
struct Coordinates {
    /// Force and moment per unit of each.
    loads: Vec<(usize, [Vec3; 2])>,
    /// Velocity and angular velocity.
    rigid: Vec<[Vec3; 2]>,
}

/// Displacements of all nodes per unit of each coordinate, one a column, their momenta, and the stiffness.
struct Condensed {
    fields: DMatrix<f64>,
    momenta: DMatrix<f64>,
    stiffness: DMatrix<f64>,
}

/// Matrices of a solid about X over `stations` (m, ascending, equally spaced within every four intervals).
///
/// # Errors
/// See [`SolidShaftError`].
pub fn matrices(
    mesh: &TetMesh,
    problem: &SolidProblem,
    stations: Vec<f64>,
) -> Result<BeamMatrices, SolidShaftError> {
    let sections: Vec<RotorSection> =
        stations.iter().map(|at| section(mesh, *at)).collect::<Result<_, _>>()?;
    let body = Body::new(problem, &sections)?;
    let [towards_y, towards_z] = [0, 1].map(|plane| body.bending(plane));
    let stretching = Coordinates {
        loads: (0..sections.len()).map(|at| (at, [AXES[0], NONE])).collect(),
        rigid: vec![[AXES[0], NONE]],
    };
    let along = body.condensed(&stretching);
    let (y, z) = (body.condensed(&towards_y), body.condensed(&towards_z));
    let [mass_y, mass_z] = [&y, &z].map(Condensed::mass);
    refuse_unlike(&mass_y, &y.stiffness, &mass_z, &z.stiffness)?;
    // e × M u, against u′.
    let mut turned = DMatrix::zeros(y.momenta.nrows(), y.momenta.ncols());
    for node in 0..turned.nrows() / 3 {
        turned.row_mut(3 * node + 1).copy_from(&-y.momenta.row(3 * node + 2));
        turned.row_mut(3 * node + 2).copy_from(&y.momenta.row(3 * node + 1));
    }
    let mass = (mass_y + mass_z) * 0.5;
    let axial_inertia = (&mass - symmetric(&(z.fields.transpose() * &turned))) * 2.0;
    let ends: Vec<f64> = stations.iter().step_by(NODES - 1).copied().collect();
    let shortening = ends.windows(2).map(|ends| shortening(ends[1] - ends[0])).collect();
    let plane = PlaneMatrices { mass, stiffness: (y.stiffness + z.stiffness) * 0.5, axial_inertia };
    Ok(BeamMatrices::of_planes(stations, &plane, [along.mass(), along.stiffness], shortening))
}

fn symmetric(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    (matrix + matrix.transpose()) * 0.5
}

impl Condensed {
    fn mass(&self) -> DMatrix<f64> {
        symmetric(&(self.fields.transpose() * &self.momenta))
    }
}

impl<'m> Body<'m> {
    fn new(
        problem: &'m SolidProblem,
        sections: &'m [RotorSection],
    ) -> Result<Body<'m>, SolidShaftError> {
        let mut held = problem.clone();
        held.prescribed = pins(&problem.nodes);
        held.loads.clear();
        let model = SolidModel::new(held)?;
        let origin = centre_of_round(problem)?;
        let unknowns = Unknowns::new(&model);
        let mut matrix = pattern(&model.problem, &unknowns);
        stiffness(&model, &unknowns, &vec![NONE; problem.nodes.len()], &mut matrix);
        let factor = unknowns.factor(&matrix)?;
        Ok(Body { problem, sections, origin, factor, unknowns })
    }

    /// Deflection and rotation of every section towards Y (0) or Z (1).
    fn bending(&self, plane: usize) -> Coordinates {
        // The rotation from X towards Y, and towards Z.
        let turn = [AXES[2], [0.0, -1.0, 0.0]][plane];
        let both = |at: usize| [(at, [AXES[1 + plane], NONE]), (at, [NONE, turn])];
        Coordinates {
            loads: (0..self.sections.len()).flat_map(both).collect(),
            rigid: vec![[AXES[1 + plane], NONE], [NONE, turn]],
        }
    }

    fn rigid(&self, [velocity, spin]: [Vec3; 2]) -> DVector<f64> {
        rigid(&self.problem.nodes, self.origin, [velocity, spin])
    }

    /// Displacements of all nodes under loads on stations, with fixed pins.
    fn answers(&self, loads: &[Vec<(u32, Vec3)>]) -> DMatrix<f64> {
        let (size, nodes) = (self.unknowns.count, self.problem.nodes.len());
        let mut fields = DMatrix::zeros(3 * nodes, loads.len());
        for (block, loads) in loads.chunks(BLOCK).enumerate() {
            let mut right = vec![0.0; size * loads.len()];
            for (column, forces) in right.chunks_exact_mut(size).zip(loads) {
                for (node, force) in forces {
                    for (of, value) in self.unknowns.of[*node as usize].into_iter().zip(force) {
                        if of != PRESCRIBED {
                            column[of] += value;
                        }
                    }
                }
            }
            self.factor.solve_columns(&mut right, loads.len());
            for (column, found) in right.chunks_exact(size).enumerate() {
                let mut to = fields.column_mut(BLOCK * block + column);
                for (row, of) in self.unknowns.of.iter().flatten().enumerate() {
                    if *of != PRESCRIBED {
                        to[row] = found[*of];
                    }
                }
            }
        }
        fields
    }

    /// Displacements of least strain energy per unit of each coordinate: K u = B λ with Bᵀu = 1 for one and 0 for the
    /// others, λ in balance.
    fn condensed(&self, of: &Coordinates) -> Condensed {
        let loads: Vec<Vec<(u32, Vec3)>> = of
            .loads
            .iter()
            .map(|&(at, [force, moment])| self.sections[at].forces(force, moment).collect())
            .collect();
        let answers = self.answers(&loads);
        let rigid: Vec<DVector<f64>> = of.rigid.iter().map(|motion| self.rigid(*motion)).collect();
        let rigid = DMatrix::from_columns(&rigid);
        let felt = |fields: &DMatrix<f64>| {
            DMatrix::from_fn(loads.len(), fields.ncols(), |row, column| {
                let work = loads[row].iter().map(|(node, force)| {
                    let first = 3 * *node as usize;
                    (0..3).map(|i| force[i] * fields[(first + i, column)]).sum::<f64>()
                });
                work.sum()
            })
        };
        let (count, free) = (loads.len(), of.rigid.len());
        // Moments over a length to scale as forces, flexibilities over the largest: rows of one size.
        let lever = self.sections.iter().map(|section| section.area.sqrt()).fold(0.0, f64::max);
        let motions = of.loads.iter().map(|(_, motion)| motion).chain(&of.rigid);
        let unit: Vec<f64> =
            motions.map(|[_, turn]| if *turn == NONE { 1.0 } else { 1.0 / lever }).collect();
        let mut flexible = felt(&answers);
        let moved = felt(&rigid);
        for i in 0..count {
            for j in 0..count {
                flexible[(i, j)] *= unit[i] * unit[j];
            }
        }
        let softest = flexible.amax();
        let mut whole = DMatrix::zeros(count + free, count + free);
        whole.view_mut((0, 0), (count, count)).copy_from(&(symmetric(&flexible) / softest));
        for i in 0..count {
            for j in 0..free {
                let value = unit[i] * moved[(i, j)] * unit[count + j];
                whole[(i, count + j)] = value;
                whole[(count + j, i)] = value;
            }
        }
        let mut wanted = DMatrix::zeros(count + free, count);
        wanted.view_mut((0, 0), (count, count)).fill_with_identity();
        let found = whole.full_piv_lu().solve(&wanted).unwrap_or_else(|| wanted.clone() * f64::NAN);
        // λ and the rigid parts per unit of each coordinate.
        let loads =
            DMatrix::from_fn(count, count, |i, j| found[(i, j)] * unit[i] * unit[j] / softest);
        let shifts =
            DMatrix::from_fn(free, count, |i, j| found[(count + i, j)] * unit[count + i] * unit[j]);
        let mut fields = answers * &loads + rigid * shifts;
        // Rigid motions out of the plane are fixed by the pins: an axisymmetric body has none of them.
        let others = AXES.map(|axis| [[axis, NONE], [NONE, axis]]).into_iter().flatten();
        let others = others.filter(|[shift, turn]| {
            let along = |motion: &[Vec3; 2]| dot(motion[0], *shift) + dot(motion[1], *turn) != 0.0;
            !of.rigid.iter().any(along)
        });
        let others: Vec<DVector<f64>> = others.map(|motion| self.rigid(motion)).collect();
        let others = DMatrix::from_columns(&others);
        let swept = momenta(self.problem, &others);
        let inertia = swept
            .tr_mul(&others)
            .try_inverse()
            .unwrap_or_else(|| others.tr_mul(&others) * f64::NAN);
        fields -= &others * (inertia * swept.tr_mul(&fields));
        let momenta = momenta(self.problem, &fields);
        Condensed { momenta, fields, stiffness: symmetric(&loads) }
    }
}

/// Six components that fix a body without strain: a node, the farthest from it along X, and the farthest from the axis
/// of both.
fn pins(nodes: &[Vec3]) -> Vec<Prescribed> {
    let best = |of: &dyn Fn(&Vec3) -> f64| {
        let mut best = (0, f64::NEG_INFINITY);
        for (node, place) in nodes.iter().enumerate() {
            let value = of(place);
            if value > best.1 {
                best = (node, value);
            }
        }
        best.0
    };
    let first = best(&|place| -place[0]);
    let last = best(&|place| place[0]);
    let away = |place: &Vec3| {
        let [_, y, z] = sub(*place, nodes[first]);
        [y, z]
    };
    let third = best(&|place| {
        let [y, z] = away(place);
        libm::hypot(y, z)
    });
    // Across its distance.
    let [y, z] = away(&nodes[third]);
    let across = if y.abs() >= z.abs() { 2 } else { 1 };
    [(first, 0), (first, 1), (first, 2), (last, 1), (last, 2), (third, across)]
        .map(|(node, axis)| Prescribed { node: node as u32, axis, profile: Profile::Constant(0.0) })
        .into()
}
