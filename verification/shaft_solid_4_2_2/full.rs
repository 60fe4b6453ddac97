//! The whole solid, without reduction: a free shaft's bending, its sag, and its vibration between sections that are held.

use bearing_dynamics::ch4_rotor::section::RotorSection;
use bearing_dynamics::members::condensed_shaft::section;
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{Prescribed, SolidModel};
use bearing_dynamics::solids::modes::{Mode, ModeOptions, modes};
use bearing_dynamics::solids::tangent::{
    MassMatrix, Unknowns, mass, mass_pattern, pattern, stiffness,
};
use nalgebra::{DMatrix, SymmetricEigen};
use std::f64::consts::TAU;

use super::LENGTH;
use crate::case::CaseError;
use crate::solids::{STEEL, Vec3, constant_load, free_body};

fn motion(section: &RotorSection, shape: &[Vec3]) -> Vec3 {
    section.motion(|node| shape[node as usize])[0]
}

/// Frequencies (Hz) of the lowest bending motions of the free shaft, the mean of each pair, and how far pairs lie apart.
pub fn free_bending(mesh: &TetMesh, pairs: usize) -> Result<(Vec<f64>, f64), CaseError> {
    let model = SolidModel::new(free_body(mesh, STEEL))?;
    // Six rigid ones, and turns about the axis and stretches in between.
    let found = modes(&model, &ModeOptions::new(6 + 2 * pairs + 2))?.modes;
    let end = section(mesh, 0.0)?;
    let bends = |mode: &&Mode| {
        let [along, y, z] = motion(&end, &mode.shape);
        let largest = mode.shape.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
        mode.frequency > 10.0 && y.hypot(z) > 0.1 * largest && y.hypot(z) > along.abs()
    };
    let all: Vec<f64> = found.iter().filter(bends).map(|mode| mode.frequency).collect();
    let means = all.chunks_exact(2).map(|pair| 0.5 * (pair[0] + pair[1])).take(pairs).collect();
    let apart = all.chunks_exact(2).map(|pair| pair[1] / pair[0] - 1.0);
    Ok((means, apart.fold(0.0, f64::max)))
}

/// Sag (m) under 1 N in the middle between sections held in the mean at both ends, by Newton's method on the whole solid.
pub fn sag(mesh: &TetMesh) -> Result<f64, CaseError> {
    let [left, mid, right] = [0.0, 0.5 * LENGTH, LENGTH].map(|at| section(mesh, at));
    let (left, mid, right) = (left?, mid?, right?);
    // So small that it stays linear to 1e-8.
    let force = 0.1;
    let mut problem = free_body(mesh, STEEL);
    let half = |of: &RotorSection| of.forces([0.0, 0.5 * force, 0.0], [0.0; 3]).collect::<Vec<_>>();
    let down = mid.forces([0.0, -force, 0.0], [0.0; 3]);
    problem
        .loads
        .push(constant_load(half(&left).into_iter().chain(half(&right)).chain(down).collect()));
    // Loads balance: six components that hold it bear nothing.
    let nearest = |to: Vec3| {
        let off = |p: &Vec3| (0..3).map(|i| (p[i] - to[i]).powi(2)).sum::<f64>();
        let nodes = (0u32..).zip(&mesh.nodes);
        nodes.min_by(|a, b| off(a.1).total_cmp(&off(b.1))).map_or(0, |(node, _)| node)
    };
    let [a, b, c] = [[0.0; 3], [LENGTH, 0.0, 0.0], [0.0, 1.0, 0.0]].map(nearest);
    problem.prescribed = [(a, 0), (a, 1), (a, 2), (b, 1), (b, 2), (c, 2)]
        .map(|(node, axis)| Prescribed { node, axis, profile: Profile::Constant(0.0) })
        .into();
    let bent = equilibrium(&SolidModel::new(problem)?, 0.0, &EquilibriumOptions::default())?;
    let of = |section: &RotorSection| motion(section, &bent.displacement)[1];
    Ok((0.5 * (of(&left) + of(&right)) - of(&mid)) / force)
}

/// Frequencies (Hz, ascending, each direction) below `limit` Hz of the whole shaft whose end sections may turn but not move across the
/// axis in the mean: subspace iteration on the whole solid, every iterate put right by forces on these sections.
pub fn pinned(mesh: &TetMesh, limit: f64) -> Result<Vec<f64>, CaseError> {
    const VECTORS: usize = 12;
    const ROUNDS: usize = 16;
    let model = SolidModel::new(free_body(mesh, STEEL))?;
    let unknowns = Unknowns::new(&model);
    let size = unknowns.count;
    let mut masses = mass_pattern(&model.problem, &unknowns);
    mass(&model, &unknowns, MassMatrix::Consistent, &mut masses);
    let shift = (TAU * 200.0).powi(2);
    let mut shifted = pattern(&model.problem, &unknowns);
    stiffness(&model, &unknowns, &vec![[0.0; 3]; mesh.nodes.len()], &mut shifted);
    shifted.add_scaled(shift, &masses);
    let factor = unknowns.factor(&shifted)?;
    let mut holds = DMatrix::zeros(size, 4);
    for (end, at) in [0.0, LENGTH].into_iter().enumerate() {
        let section = section(mesh, at)?;
        for axis in [1, 2] {
            let mut force = [0.0; 3];
            force[axis] = 1.0;
            for (node, of) in section.forces(force, [0.0; 3]) {
                for i in 0..3 {
                    holds[(unknowns.of[node as usize][i], 2 * end + axis - 1)] += of[i];
                }
            }
        }
    }
    let mut answers = holds.clone();
    factor.solve_columns(answers.as_mut_slice(), 4);
    let compliance = (holds.tr_mul(&answers)).lu();
    let product = |of: &bearing_dynamics::numeric::sparse::SymmetricMatrix, x: &DMatrix<f64>| {
        let mut y = DMatrix::zeros(size, x.ncols());
        for (to, from) in
            y.as_mut_slice().chunks_exact_mut(size).zip(x.as_slice().chunks_exact(size))
        {
            of.multiply(from, to);
        }
        y
    };
    // Any start that is no motion of its own.
    let mut vectors =
        DMatrix::from_fn(size, VECTORS, |i, j| ((i * (2 * j + 7) + 13 * j) as f64).sin());
    let mut squares = Vec::new();
    for _ in 0..ROUNDS {
        let mut next = product(&masses, &vectors);
        factor.solve_columns(next.as_mut_slice(), VECTORS);
        let wrong = holds.tr_mul(&next);
        let back = compliance.solve(&wrong).ok_or_else(|| CaseError::message("holds are one"))?;
        next -= &answers * back;
        let (k, m) = (product(&shifted, &next), product(&masses, &next));
        let (k, m) = (next.tr_mul(&k), next.tr_mul(&m));
        let half = ((&m + m.transpose()) * 0.5)
            .cholesky()
            .ok_or_else(|| CaseError::message("vectors are one"))?
            .l();
        let solve = |b: &DMatrix<f64>| half.solve_lower_triangular(b);
        let reduced = solve(&k).and_then(|x| solve(&x.transpose()));
        let reduced = reduced.ok_or_else(|| CaseError::message("vectors are one"))?;
        let eigen = SymmetricEigen::new((&reduced + reduced.transpose()) * 0.5);
        let turned = half.transpose().solve_upper_triangular(&eigen.eigenvectors);
        vectors = next * turned.ok_or_else(|| CaseError::message("vectors are one"))?;
        squares = eigen.eigenvalues.iter().map(|square| square - shift).collect();
    }
    squares.sort_by(f64::total_cmp);
    let hertz = squares.into_iter().map(|square| square.max(0.0).sqrt() / TAU);
    Ok(hertz.filter(|f| *f > 10.0 && *f < limit).collect())
}
