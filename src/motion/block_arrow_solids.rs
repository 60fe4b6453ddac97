//! Reduced solids in the matrix of a linearly implicit step: their modes are eliminated into the hubs of the races in
//! their bores.
//!
//! Let D be the diagonal of the modal equations, S the modes at the contact nodes, L the levers of the hubs there, k
//! the contact stiffnesses. Rates q of modes and h of hubs give the nodal forces p = hγ k (S (u + hγ q) + L (m + hγ
//! h)), where u and m are the displacements in the right-hand side. With D q = f − Sᵀp one equation for each contact
//! node remains, (1/(h²γ² k) + S D⁻¹ Sᵀ) p = S (D⁻¹ f + u/hγ) + L (h + m/hγ). If there are more contact nodes than
//! modes, as in a tight fit of a fine mesh, the modal equations with the contact springs, D + h²γ² Sᵀ k S, are solved
//! instead.

use crate::members::reduced_solid::{Surface, SurfaceNode};
use crate::motion::elimination::LdltMatrix;
use crate::motion::linearised::{Linearised, SeatRow, Shapes};
use crate::motion::system::System;

/// Modes added to the matrix at a time; each pass over it is memory traffic.
const TOGETHER: usize = 4;

/// Row of a cage instead of a node.
const NO_NODE: SurfaceNode = SurfaceNode { node: 0, place: [0.0; 3], normal: [0.0; 3], area: 0.0 };

/// Part of the matrix of one solid, and its working memory.
#[derive(Clone, Debug)]
pub(crate) struct SolidBlock {
    /// Index in [`Linearised::seats`] of each housing fit, and its modes at the bore surface.
    seats: Vec<(usize, SeatShapes)>,
    /// Hubs of the races in its bores, in order.
    hubs: Vec<usize>,
    /// Contact nodes, with the index of their housing fit above.
    rows: Vec<(usize, SeatRow)>,
    /// D⁻¹.
    yielding: Vec<f64>,
    /// True if the equations are those of the modes.
    by_shapes: bool,
    /// Factored matrix, and its inverse times the coupling to each hub: L, or B = h²γ² Sᵀ k L.
    matrix: LdltMatrix,
    levered: Vec<Vec<[f64; 6]>>,
    coupled: Vec<Vec<[f64; 6]>>,
    /// p of each contact node; f and D⁻¹ f + u/hγ of each mode.
    pushes: Vec<f64>,
    forces: Vec<f64>,
    gone: Vec<f64>,
    /// Some modes at the contact nodes.
    columns: [Vec<f64>; TOGETHER],
}

#[derive(Clone, Debug)]
struct SeatShapes {
    hubs: [Option<usize>; 2],
    surface: Surface,
    by_node: Vec<f64>,
    outward: Vec<f64>,
}

impl SeatShapes {
    /// Hubs with the lever of a row on each.
    fn levers<'r>(
        &self,
        row: &'r SeatRow,
    ) -> impl Iterator<Item = (usize, &'r [f64; 6])> + use<'r> {
        let hubs = self.hubs.into_iter().zip(&row.levers);
        hubs.filter_map(|(hub, lever)| Some((hub?, lever)))
    }
}

impl SolidBlock {
    /// Of solid `index`.
    pub(crate) fn new(system: &System, linearised: &Linearised, index: usize) -> SolidBlock {
        let seats = linearised.seats.iter().enumerate().filter(|(_, joint)| joint.solid == index);
        let seats: Vec<(usize, SeatShapes)> = seats
            .map(|(number, joint)| {
                let surface = match system.assembly.seats.get(number) {
                    Some(seat) => system.assembly.solids[index].surfaces[seat.surface].clone(),
                    None => {
                        Surface { nodes: vec![NO_NODE; 2], shapes: vec![0.0; joint.shapes.len()] }
                    }
                };
                let (by_node, outward) = (surface.by_node(), vec![0.0; surface.nodes.len()]);
                (number, SeatShapes { hubs: joint.hubs, surface, by_node, outward })
            })
            .collect();
        let mut hubs: Vec<usize> = seats.iter().flat_map(|(_, seat)| seat.hubs).flatten().collect();
        hubs.sort_unstable();
        hubs.dedup();
        let nodes = seats.iter().map(|(_, seat)| seat.outward.len()).sum();
        let shapes = linearised.solids[index].stiffness.len();
        SolidBlock {
            rows: Vec::with_capacity(nodes),
            yielding: vec![0.0; shapes],
            matrix: LdltMatrix::new(nodes.max(shapes)),
            by_shapes: false,
            levered: hubs.iter().map(|_| Vec::with_capacity(nodes.max(shapes))).collect(),
            coupled: hubs.iter().map(|_| Vec::with_capacity(shapes)).collect(),
            pushes: Vec::with_capacity(nodes),
            forces: vec![0.0; shapes],
            gone: vec![0.0; shapes],
            columns: std::array::from_fn(|_| Vec::with_capacity(nodes)),
            seats,
            hubs,
        }
    }

    /// Factors it for hγ = `scale`, and adds the stiffness of the contact nodes between hubs to `schur`.
    pub(crate) fn factor(
        &mut self,
        linearised: &Linearised,
        solid: &Shapes,
        scale: f64,
        schur: &mut LdltMatrix,
    ) {
        let SolidBlock { seats, rows, yielding, matrix, by_shapes, .. } = self;
        for (yielding, stiffness) in yielding.iter_mut().zip(&solid.stiffness) {
            *yielding = 1.0 / (1.0 + scale * (solid.damping + scale * stiffness));
        }
        rows.clear();
        for (own, (number, seat)) in seats.iter_mut().enumerate() {
            let joint = &linearised.seats[*number];
            if !joint.shapes.is_empty() {
                seat.by_node.copy_from_slice(&joint.shapes);
                let count = seat.outward.len();
                let shapes = joint.shapes.len() / count;
                for (i, shape) in seat.surface.shapes.iter_mut().enumerate() {
                    *shape = joint.shapes[(i % count) * shapes + i / count];
                }
            }
            rows.extend(linearised.seats[*number].nodes.iter().map(|row| (own, *row)));
        }
        *by_shapes = rows.len() > yielding.len();
        if *by_shapes {
            self.factor_shapes(scale, schur);
            return;
        }
        matrix.resize(rows.len());
        for (i, (_, row)) in rows.iter().enumerate() {
            *matrix.at(i, i) = 1.0 / (scale * scale * row.stiffness);
        }
        self.add_shapes();
        self.matrix.factor();
        self.couple_hubs(schur);
    }

    /// D + h²γ² Sᵀ k S, and its coupling to the hubs.
    fn factor_shapes(&mut self, scale: f64, schur: &mut LdltMatrix) {
        let SolidBlock { seats, hubs, rows, yielding, matrix, levered, coupled, .. } = self;
        let shapes = yielding.len();
        matrix.resize(shapes);
        for (k, yielding) in yielding.iter().enumerate() {
            *matrix.at(k, k) = 1.0 / yielding;
        }
        for coupled in coupled.iter_mut() {
            coupled.clear();
            coupled.resize(shapes, [0.0; 6]);
        }
        for (own, row) in rows.iter() {
            let seat = &seats[*own].1;
            let of_node = &seat.by_node[row.node * shapes..][..shapes];
            let weight = scale * scale * row.stiffness;
            for (k, shape) in of_node.iter().enumerate() {
                matrix.add_to_row(k, k, weight * row.along * row.along * shape, &of_node[k..]);
            }
            let Some(hub) = seat.hubs[0] else { continue };
            let coupled = hubs.iter().zip(coupled.iter_mut()).filter(|(of, _)| **of == hub);
            let lever = &row.levers[0];
            let push = lever.map(|lever| weight * row.along * lever);
            for (to, shape) in coupled.flat_map(|(_, coupled)| coupled).zip(of_node) {
                (0..6).for_each(|i| to[i] += push[i] * shape);
            }
            for i in 0..6 {
                let (at, push) = (6 * hub + i, weight * lever[i]);
                schur.add_to_row(at, at, push, &lever[i..]);
            }
        }
        matrix.factor();
        for (number, (hub, levered)) in hubs.iter().zip(levered).enumerate() {
            levered.clone_from(&coupled[number]);
            matrix.solve_six(levered);
            for (other, coupled) in hubs.iter().zip(coupled.iter()).take(number + 1) {
                for (coupled, held) in coupled.iter().zip(levered.iter()) {
                    for i in 0..6 {
                        let from = if other == hub { i } else { 0 };
                        schur.add_to_row(6 * other + i, 6 * hub + from, -coupled[i], &held[from..]);
                    }
                }
            }
        }
    }

    /// [`SolidBlock::subtract_forces`] with the modal equations; the modal rates at fixed hubs are left in `gone`.
    fn subtract_modal_forces(
        &mut self,
        scale: f64,
        places: &[f64],
        moved: &[[f64; 6]],
        to: &mut [f64],
    ) {
        let SolidBlock { seats, hubs, rows, matrix, coupled, forces, gone, .. } = self;
        let shapes = forces.len();
        for (_, seat) in seats.iter_mut() {
            seat.surface.along_normals(places, &mut seat.outward);
        }
        for (own, row) in rows.iter() {
            let seat = &seats[*own].1;
            let lever = seat.hubs[0].map_or(0.0, |hub| inner(&row.levers[0], &moved[hub]));
            let push = scale * row.stiffness * (row.along * seat.outward[row.node] + lever);
            let of_node = &seat.by_node[row.node * shapes..][..shapes];
            forces.iter_mut().zip(of_node).for_each(|(to, shape)| *to -= row.along * push * shape);
            let Some(hub) = seat.hubs[0] else { continue };
            (0..6).for_each(|j| to[6 * hub + j] -= row.levers[0][j] * push);
        }
        gone.clone_from(forces);
        matrix.solve(gone);
        for (hub, coupled) in hubs.iter().zip(coupled) {
            for (coupled, gone) in coupled.iter().zip(&*gone) {
                (0..6).for_each(|j| to[6 * hub + j] -= coupled[j] * gone);
            }
        }
    }

    /// S D⁻¹ Sᵀ.
    fn add_shapes(&mut self) {
        let SolidBlock { seats, rows, yielding, matrix, columns, .. } = self;
        let shapes = yielding.len();
        for first in (0..shapes).step_by(TOGETHER) {
            let mut factors = [0.0; TOGETHER];
            for (t, (column, factor)) in columns.iter_mut().zip(&mut factors).enumerate() {
                column.clear();
                let Some(yielding) = yielding.get(first + t) else {
                    column.resize(rows.len(), 0.0);
                    continue;
                };
                *factor = *yielding;
                column.extend(rows.iter().map(|(own, row)| {
                    row.along * seats[*own].1.by_node[row.node * shapes + first + t]
                }));
            }
            let [a, b, c, d] = &*columns;
            for i in 0..rows.len() {
                let of = [a[i], b[i], c[i], d[i]];
                let [fa, fb, fc, fd] = std::array::from_fn(|t| factors[t] * of[t]);
                let row = matrix.row_from(i);
                for ((((to, a), b), c), d) in
                    row.iter_mut().zip(&a[i..]).zip(&b[i..]).zip(&c[i..]).zip(&d[i..])
                {
                    *to += (fa * a + fb * b) + (fc * c + fd * d);
                }
            }
        }
    }

    /// Adds Lᵀ times the factored levers to the upper triangle over hubs.
    fn couple_hubs(&mut self, schur: &mut LdltMatrix) {
        let SolidBlock { seats, hubs, rows, matrix, levered, .. } = self;
        for (hub, levered) in hubs.iter().zip(levered) {
            levered.clear();
            levered.extend(rows.iter().map(|(own, row)| {
                let mut own = seats[*own].1.levers(row).filter(|(of, _)| of == hub);
                own.next().map_or([0.0; 6], |(_, lever)| *lever)
            }));
            matrix.solve_six(levered);
            for ((own, row), held) in rows.iter().zip(levered) {
                for (other, lever) in seats[*own].1.levers(row).filter(|(other, _)| other <= hub) {
                    for i in 0..6 {
                        let from = if other == *hub { i } else { 0 };
                        let held = held.map(|held| lever[i] * held);
                        schur.add_to_row(6 * other + i, 6 * hub + from, 1.0, &held[from..]);
                    }
                }
            }
        }
    }

    /// Subtracts the forces of displacements in `r` (hubs: `moved`) and of modal forces from the right-hand sides of
    /// the hubs.
    pub(crate) fn subtract_forces(
        &mut self,
        solid: &Shapes,
        scale: f64,
        r: &[f64],
        moved: &[[f64; 6]],
        hubs: &mut [f64],
    ) {
        let SolidBlock { seats, rows, yielding, matrix, pushes, forces, gone, .. } = self;
        let shapes = yielding.len();
        let (places, speeds) = r[solid.at..solid.at + 2 * shapes].split_at(shapes);
        for (k, yielding) in yielding.iter().enumerate() {
            forces[k] = speeds[k] - scale * solid.stiffness[k] * places[k];
            gone[k] = yielding * forces[k] + places[k] / scale;
        }
        if self.by_shapes {
            self.subtract_modal_forces(scale, places, moved, hubs);
            return;
        }
        for (_, seat) in seats.iter_mut() {
            seat.surface.along_normals(gone, &mut seat.outward);
        }
        pushes.clear();
        pushes.extend(rows.iter().map(|(own, row)| {
            let seat = &seats[*own].1;
            let lever = seat.levers(row).map(|(hub, lever)| inner(lever, &moved[hub]));
            let lever: f64 = lever.sum();
            row.along * seat.outward[row.node] + lever / scale
        }));
        matrix.solve(pushes);
        for ((own, row), push) in rows.iter().zip(&*pushes) {
            for (hub, lever) in seats[*own].1.levers(row) {
                for j in 0..6 {
                    hubs[6 * hub + j] -= lever[j] * push;
                }
            }
        }
    }

    /// Modal rates from the rates of the hubs, after [`SolidBlock::subtract_forces`].
    pub(crate) fn follow(
        &mut self,
        solid: &Shapes,
        scale: f64,
        r: &[f64],
        rates: &[[f64; 6]],
        w: &mut [f64],
    ) {
        let SolidBlock { seats, hubs, rows, yielding, levered, pushes, forces, gone, .. } = self;
        let shapes = yielding.len();
        if self.by_shapes {
            for (hub, levered) in hubs.iter().zip(levered) {
                for (gone, held) in gone.iter_mut().zip(levered) {
                    *gone -= inner(held, &rates[*hub]);
                }
            }
            for (k, rate) in gone.iter().enumerate() {
                w[solid.at + k] = r[solid.at + k] + scale * rate;
                w[solid.at + shapes + k] = *rate;
            }
            return;
        }
        for (hub, levered) in hubs.iter().zip(levered) {
            for (push, held) in pushes.iter_mut().zip(levered) {
                *push += inner(held, &rates[*hub]);
            }
        }
        for ((own, row), push) in rows.iter().zip(&*pushes) {
            let by = row.along * push;
            let shapes = &seats[*own].1.by_node[row.node * shapes..][..shapes];
            forces.iter_mut().zip(shapes).for_each(|(to, shape)| *to -= by * shape);
        }
        let at = solid.at;
        for (k, (force, yielding)) in forces.iter().zip(&*yielding).enumerate() {
            let rate = force * yielding;
            w[at + k] = r[at + k] + scale * rate;
            w[at + shapes + k] = rate;
        }
    }
}

fn inner(a: &[f64; 6], b: &[f64; 6]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
