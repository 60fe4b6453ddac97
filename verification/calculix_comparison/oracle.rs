//! Reader of CalculiX' output files, and mass matrices integrated with its few quadrature points.

use nalgebra::{DMatrix, Matrix3, SymmetricEigen};
use std::f64::consts::TAU;

/// Displacements printed in a `.dat`, m, of the nodes 1, 2, ….
pub fn displacements(dat: &str) -> Option<Vec<[f64; 3]>> {
    let mut found = Vec::new();
    for line in dat.lines().skip_while(|line| !line.contains("displacements")).skip(1) {
        if line.trim().is_empty() {
            continue;
        }
        let mut words = line.split_whitespace();
        (words.next()?.parse::<usize>().ok()? == found.len() + 1).then_some(())?;
        let values: Option<Vec<f64>> = words.map(|word| word.parse().ok()).collect();
        found.push(values?.try_into().ok()?);
    }
    Some(found)
}

/// Frequencies printed in a `.dat`, Hz, from the eigenvalues; negative for a negative eigenvalue.
pub fn frequencies(dat: &str) -> Option<Vec<f64>> {
    let mut found = Vec::new();
    let table = dat.lines().skip_while(|line| !line.contains("E I G E N V A L U E"));
    for line in table.skip(1).take_while(|line| !line.contains("P A R T")) {
        let mut words = line.split_whitespace();
        if words.next().and_then(|word| word.parse::<usize>().ok()) != Some(found.len() + 1) {
            continue;
        }
        let eigenvalue: f64 = words.next()?.parse().ok()?;
        found.push(eigenvalue.signum() * eigenvalue.abs().sqrt() / TAU);
    }
    (!found.is_empty()).then_some(found)
}

/// A symmetric matrix of `.mas` or `.sti`, sorted by the `.dof` into the order node 1 x, y, z, node 2 x, ….
pub fn matrix(text: &str, dof: &str) -> Option<DMatrix<f64>> {
    let place: Option<Vec<usize>> = dof
        .split_whitespace()
        .map(|word| {
            let (node, axis) = word.split_once('.')?;
            Some(3 * (node.parse::<usize>().ok()? - 1) + axis.parse::<usize>().ok()? - 1)
        })
        .collect();
    let place = place?;
    let mut matrix = DMatrix::from_element(place.len(), place.len(), f64::NAN);
    for line in text.lines() {
        let mut words = line.split_whitespace();
        let row = place.get(words.next()?.parse::<usize>().ok()? - 1)?;
        let column = place.get(words.next()?.parse::<usize>().ok()? - 1)?;
        let value = words.next()?.parse().ok()?;
        matrix[(*row, *column)] = value;
        matrix[(*column, *row)] = value;
    }
    Some(matrix)
}

/// Barycentric coordinates of CalculiX' quadrature points, of equal weight: one for a four-node element,
/// the four of degree 2 for a ten-node element.
fn points(nodes_per_element: usize) -> Vec<[f64; 4]> {
    if nodes_per_element == 4 {
        return vec![[0.25; 4]];
    }
    let root = 5f64.sqrt();
    let point = |far: usize| {
        std::array::from_fn(
            |i| if i == far { (5.0 + 3.0 * root) / 20.0 } else { (5.0 - root) / 20.0 },
        )
    };
    (0..4).map(point).collect()
}

/// Corner nodes of the mid-side nodes 5 to 10.
const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]];

/// Shape functions of an element with 4 or 10 nodes, and their derivatives by each of the four
/// barycentric coordinates.
fn shapes(nodes_per_element: usize, l: [f64; 4]) -> (Vec<f64>, Vec<[f64; 4]>) {
    let unit = |i: usize, value: f64| std::array::from_fn(|j| if i == j { value } else { 0.0 });
    if nodes_per_element == 4 {
        return (l.to_vec(), (0..4).map(|i| unit(i, 1.0)).collect());
    }
    let mut values: Vec<f64> = l.iter().map(|l| l * (2.0 * l - 1.0)).collect();
    let mut slopes: Vec<[f64; 4]> = (0..4).map(|i| unit(i, 4.0 * l[i] - 1.0)).collect();
    for [a, b] in EDGES {
        values.push(4.0 * l[a] * l[b]);
        let mut slope = [0.0; 4];
        (slope[a], slope[b]) = (4.0 * l[b], 4.0 * l[a]);
        slopes.push(slope);
    }
    (values, slopes)
}

/// Mass matrix of one element over its nodes, kg: ρ Σ w NᵢNⱼ over CalculiX' 1 or 4 points, which do not
/// integrate the products of shape functions exactly.
pub fn few_point_mass(nodes: &[[f64; 3]], element: &[usize], density: f64) -> DMatrix<f64> {
    let count = element.len();
    let points = points(count);
    let mut mass = DMatrix::zeros(count, count);
    for l in &points {
        let (values, slopes) = shapes(count, *l);
        let map = Matrix3::from_fn(|axis, k| {
            let along =
                |(node, slope): (&usize, &[f64; 4])| nodes[*node][axis] * (slope[k + 1] - slope[0]);
            element.iter().zip(&slopes).map(along).sum::<f64>()
        });
        let share = density * map.determinant() / 6.0 / points.len() as f64;
        mass += DMatrix::from_fn(count, count, |i, j| share * values[i] * values[j]);
    }
    mass
}

/// Frequencies (Hz) with the mass of few points: Rayleigh–Ritz over modes that are orthonormal under the
/// exact mass.
pub fn few_point_frequencies(
    nodes: &[[f64; 3]],
    elements: &[Vec<usize>],
    density: f64,
    frequencies: &[f64],
    shapes: &[Vec<[f64; 3]>],
) -> Option<Vec<f64>> {
    let count = frequencies.len();
    let mut mass = DMatrix::zeros(count, count);
    for element in elements {
        let of = few_point_mass(nodes, element, density);
        for axis in 0..3 {
            let motion =
                DMatrix::from_fn(element.len(), count, |n, mode| shapes[mode][element[n]][axis]);
            mass += motion.transpose() * &of * motion;
        }
    }
    let inverse = mass.cholesky()?.l().try_inverse()?;
    let stiffness =
        DMatrix::from_fn(
            count,
            count,
            |i, j| if i == j { (TAU * frequencies[i]).powi(2) } else { 0.0 },
        );
    let mut squares: Vec<f64> = SymmetricEigen::new(&inverse * stiffness * inverse.transpose())
        .eigenvalues
        .iter()
        .copied()
        .collect();
    squares.sort_by(f64::total_cmp);
    Some(squares.into_iter().map(|square| square.max(0.0).sqrt() / TAU).collect())
}
