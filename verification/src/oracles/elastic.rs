//! A linear elastic body of tetrahedra, as the compliance of some of its nodes.
//!
//! Places of nodes and the nodes of elements are given; stiffness, numbering and solution are made
//! here: B-less element stiffness λ ∇N ∇Nᵀ + μ (∇Nᵀ ∇N 1 + ∇N ∇Nᵀ) by quadrature, reverse
//! Cuthill–McKee numbering, Cholesky's factor row by row within its envelope.

use nalgebra::DMatrix;

type Vec3 = [f64; 3];

/// SI units.
pub struct ElasticBody {
    pub nodes: Vec<Vec3>,
    /// Four nodes each, or ten: corners, then between corners 12, 23, 31, 14, 24, 34.
    pub elements: Vec<Vec<usize>>,
    /// Nodes that do not move.
    pub held: Vec<usize>,
    pub young: f64,
    pub poisson: f64,
}

/// Barycentric coordinates and weights: one point for four nodes; for ten Hammer's four points of degree two, which
/// belong to the element's definition, since on curved sides another rule is another element.
fn points(nodes: usize) -> Vec<([f64; 4], f64)> {
    if nodes == 4 {
        return vec![([0.25; 4], 1.0 / 6.0)];
    }
    let near = 0.25 + 0.15 * 5f64.sqrt();
    let far = (1.0 - near) / 3.0;
    let point = |corner: usize| std::array::from_fn(|i| if i == corner { near } else { far });
    (0..4).map(|corner| (point(corner), 1.0 / 24.0)).collect()
}

/// ∂N/∂ξ at barycentric coordinates `l`; ξ are the second to fourth of them.
pub fn slopes(nodes: usize, l: [f64; 4]) -> Vec<Vec3> {
    let along = |by: [f64; 4]| [by[1] - by[0], by[2] - by[0], by[3] - by[0]];
    let corner = |c: usize| {
        let mut by = [0.0; 4];
        by[c] = if nodes == 4 { 1.0 } else { 4.0 * l[c] - 1.0 };
        along(by)
    };
    let side = |[a, b]: [usize; 2]| {
        let mut by = [0.0; 4];
        (by[a], by[b]) = (4.0 * l[b], 4.0 * l[a]);
        along(by)
    };
    let sides: &[[usize; 2]] =
        if nodes == 4 { &[] } else { &[[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]] };
    (0..4).map(corner).chain(sides.iter().map(|s| side(*s))).collect()
}

/// ∂N/∂x of all nodes, and the volume of a unit of ξ.
fn gradients(places: &[Vec3], l: [f64; 4]) -> (Vec<Vec3>, f64) {
    let slopes = slopes(places.len(), l);
    // x_i by ξ_j, its cofactors and determinant.
    let mut m = [[0.0; 3]; 3];
    for (place, slope) in places.iter().zip(&slopes) {
        for i in 0..3 {
            for j in 0..3 {
                m[i][j] += place[i] * slope[j];
            }
        }
    }
    let cofactor = |i: usize, j: usize| {
        let (i1, i2, j1, j2) = ((i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3);
        m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1]
    };
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    let by_place = |slope: &Vec3| -> Vec3 {
        std::array::from_fn(|i| {
            (0..3).map(|j| slope[j] * cofactor(i, j)).sum::<f64>() / determinant
        })
    };
    (slopes.iter().map(by_place).collect(), determinant)
}

impl ElasticBody {
    /// Stiffness of one element, row by row; three rows a node.
    fn element(&self, of: &[usize]) -> Vec<Vec<f64>> {
        let places: Vec<Vec3> = of.iter().map(|&n| self.nodes[n]).collect();
        let mu = 0.5 * self.young / (1.0 + self.poisson);
        let lambda = 2.0 * mu * self.poisson / (1.0 - 2.0 * self.poisson);
        let mut stiffness = vec![vec![0.0; 3 * of.len()]; 3 * of.len()];
        for (l, weight) in points(of.len()) {
            let (by, volume) = gradients(&places, l);
            for (a, na) in by.iter().enumerate() {
                for (b, nb) in by.iter().enumerate() {
                    let product = na[0] * nb[0] + na[1] * nb[1] + na[2] * nb[2];
                    for i in 0..3 {
                        for j in 0..3 {
                            let same = if i == j { product } else { 0.0 };
                            let density = lambda * na[i] * nb[j] + mu * (na[j] * nb[i] + same);
                            stiffness[3 * a + i][3 * b + j] += weight * volume * density;
                        }
                    }
                }
            }
        }
        stiffness
    }

    /// Place of each node in an order in which neighbours are near: Cuthill and McKee's, backwards.
    fn order(&self) -> Vec<usize> {
        let mut beside = vec![Vec::new(); self.nodes.len()];
        for element in &self.elements {
            for &a in element {
                beside[a].extend(element.iter().copied().filter(|&b| b != a));
            }
        }
        for list in &mut beside {
            list.sort_unstable();
            list.dedup();
        }
        let search = |from: usize| {
            let mut found = vec![false; beside.len()];
            let mut row = vec![from];
            found[from] = true;
            let mut next = 0;
            while next < row.len() {
                let mut new: Vec<usize> =
                    beside[row[next]].iter().copied().filter(|&n| !found[n]).collect();
                new.sort_by_key(|&n| beside[n].len());
                new.iter().for_each(|&n| found[n] = true);
                row.extend(new);
                next += 1;
            }
            row
        };
        // The last of a search is at an end of the body; a body in pieces leaves nodes out.
        let mut row = search(0);
        for _ in 0..3 {
            row = search(row[row.len() - 1]);
        }
        let mut place = vec![usize::MAX; self.nodes.len()];
        row.iter().rev().enumerate().for_each(|(at, &node)| place[node] = at);
        place
    }

    /// Displacement of `of` under unit forces on them: three rows and columns a node, m/N.
    pub fn compliance(&self, of: &[usize]) -> DMatrix<f64> {
        let place = self.order();
        // Held nodes take no row; the others keep their order.
        let mut rows = vec![usize::MAX; self.nodes.len()];
        let mut free: Vec<usize> = (0..self.nodes.len()).collect();
        free.retain(|n| place[*n] != usize::MAX && !self.held.contains(n));
        free.sort_by_key(|&n| place[n]);
        free.iter().enumerate().for_each(|(at, &n)| rows[n] = 3 * at);

        let mut factor = Envelope::new(3 * free.len());
        for element in &self.elements {
            let low = element.iter().map(|&n| rows[n]).min().unwrap_or(0);
            for &n in element.iter().filter(|&&n| rows[n] != usize::MAX) {
                (0..3).for_each(|i| factor.reach(rows[n] + i, low));
            }
        }
        factor.allocate();
        for element in &self.elements {
            let stiffness = self.element(element);
            for (a, &na) in element.iter().enumerate() {
                for (b, &nb) in element.iter().enumerate() {
                    if rows[na] == usize::MAX || rows[nb] == usize::MAX {
                        continue;
                    }
                    for i in 0..3 {
                        for j in 0..3 {
                            let (row, column) = (rows[na] + i, rows[nb] + j);
                            if column <= row {
                                factor.add(row, column, stiffness[3 * a + i][3 * b + j]);
                            }
                        }
                    }
                }
            }
        }
        factor.factorise();
        let mut all = DMatrix::zeros(3 * of.len(), 3 * of.len());
        for column in 0..3 * of.len() {
            let mut x = vec![0.0; 3 * free.len()];
            if rows[of[column / 3]] == usize::MAX {
                continue;
            }
            x[rows[of[column / 3]] + column % 3] = 1.0;
            factor.solve(&mut x);
            for row in 0..3 * of.len() {
                let node = rows[of[row / 3]];
                all[(row, column)] = if node == usize::MAX { 0.0 } else { x[node + row % 3] };
            }
        }
        all
    }
}

/// Lower triangle of a symmetric matrix, each row from its first entry on.
struct Envelope {
    first: Vec<usize>,
    rows: Vec<Vec<f64>>,
}

impl Envelope {
    fn new(size: usize) -> Envelope {
        Envelope { first: (0..size).collect(), rows: Vec::new() }
    }

    fn reach(&mut self, row: usize, column: usize) {
        self.first[row] = self.first[row].min(column);
    }

    fn allocate(&mut self) {
        self.rows = self.first.iter().enumerate().map(|(i, f)| vec![0.0; i + 1 - f]).collect();
    }

    fn add(&mut self, row: usize, column: usize, value: f64) {
        self.rows[row][column - self.first[row]] += value;
    }

    /// Cholesky. A body that is not held gives numbers that are none.
    fn factorise(&mut self) {
        for i in 0..self.rows.len() {
            let (done, rest) = self.rows.split_at_mut(i);
            let (row, first) = (&mut rest[0], self.first[i]);
            for j in first..i {
                let (other, from) = (&done[j], self.first[j].max(first));
                let product = dot(
                    &row[from - first..j - first],
                    &other[from - self.first[j]..j - self.first[j]],
                );
                row[j - first] = (row[j - first] - product) / other[j - self.first[j]];
            }
            let own = dot(&row[..i - first], &row[..i - first]);
            row[i - first] = (row[i - first] - own).sqrt();
        }
    }

    fn solve(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            let (row, first) = (&self.rows[i], self.first[i]);
            x[i] = (x[i] - dot(&row[..i - first], &x[first..i])) / row[i - first];
        }
        for i in (0..x.len()).rev() {
            let (row, first) = (&self.rows[i], self.first[i]);
            let value = x[i] / row[i - first];
            x[i] = value;
            for (x, entry) in x[first..i].iter_mut().zip(row) {
                *x -= value * entry;
            }
        }
    }
}

/// In eight sums, so that the processor can take them side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let whole = a.len() / 8 * 8;
    for (a, b) in a[..whole].chunks_exact(8).zip(b[..whole].chunks_exact(8)) {
        for i in 0..8 {
            sums[i] += a[i] * b[i];
        }
    }
    let rest: f64 = a[whole..].iter().zip(&b[whole..]).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}
