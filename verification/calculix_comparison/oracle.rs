//! What CalculiX was told and what it answered: its decks and outputs, read here; and the mass
//! matrices of its quadrature. Lengths in mm, forces in N, masses in t, as in the files.

use nalgebra::{DMatrix, Matrix3, SymmetricEigen};
use std::f64::consts::TAU;

/// Mesh of a deck: nodes and elements numbered from 1 without gaps, in that order.
pub struct Deck {
    pub nodes: Vec<[f64; 3]>,
    pub elements: Vec<Vec<usize>>,
    pub held: Vec<usize>,
}

/// Reads `*NODE`, `*ELEMENT` and `*NSET, NSET=HELD`. `None` if a line is not understood.
pub fn deck(text: &str) -> Option<Deck> {
    let mut deck = Deck { nodes: Vec::new(), elements: Vec::new(), held: Vec::new() };
    let mut keyword = "";
    for line in text.lines().filter(|line| !line.starts_with("**")) {
        if line.starts_with('*') {
            keyword = line;
            continue;
        }
        let mut words = line.split(',').map(str::trim);
        let number: usize = words.next()?.parse().ok()?;
        if keyword.starts_with("*NODE") {
            let place: Vec<f64> = words.map(|word| word.parse().ok()).collect::<Option<_>>()?;
            (number == deck.nodes.len() + 1).then_some(())?;
            deck.nodes.push(place.try_into().ok()?);
        } else if keyword.starts_with("*ELEMENT") {
            (number == deck.elements.len() + 1).then_some(())?;
            let nodes: Option<Vec<usize>> =
                words.map(|word| word.parse::<usize>().ok()?.checked_sub(1)).collect();
            deck.elements.push(nodes?);
        } else if keyword == "*NSET, NSET=HELD" {
            deck.held.push(number - 1);
        }
    }
    Some(deck)
}

/// Nodal forces of a `*CLOAD` list, N, for each of `count` nodes.
pub fn loads(text: &str, count: usize) -> Option<Vec<[f64; 3]>> {
    let mut forces = vec![[0.0; 3]; count];
    for line in text.lines() {
        let mut words = line.split(',').map(str::trim);
        let node: usize = words.next()?.parse().ok()?;
        let axis: usize = words.next()?.parse().ok()?;
        *forces.get_mut(node - 1)?.get_mut(axis - 1)? += words.next()?.parse::<f64>().ok()?;
    }
    Some(forces)
}

/// Displacements printed in a `.dat`, mm, of the nodes 1, 2, ….
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

/// A symmetric matrix of `.mas` or `.sti`, put into the order node 1 x, y, z, node 2 x, … by the
/// `.dof` beside it.
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

/// Barycentric places of the quadrature points of an element with this many nodes, of equal weight:
/// one in the middle for 4, the four of degree 2 for 10.
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

/// Corners between which the nodes 5 to 10 lie.
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

/// Masses between the nodes of one element: ρ Σ w NᵢNⱼ over the points that CalculiX uses, 1 or 4,
/// which are too few for the products of shape functions.
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

/// Frequencies with the mass of few points, from modes of another mass matrix under which they are
/// orthonormal: Rayleigh–Ritz over these modes. The error is of second order in what their span misses.
pub fn few_point_frequencies(
    deck: &Deck,
    density: f64,
    frequencies: &[f64],
    shapes: &[Vec<[f64; 3]>],
) -> Option<Vec<f64>> {
    let count = frequencies.len();
    let mut mass = DMatrix::zeros(count, count);
    for element in &deck.elements {
        let of = few_point_mass(&deck.nodes, element, density);
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
