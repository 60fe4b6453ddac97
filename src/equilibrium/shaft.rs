//! Flexible shafts in an equilibrium: sections follow their body and the modal amplitudes.
//!
//! An attachment adds energy, load and stiffness over the section's own five coordinates s, as over those of any body.
//! They are then transformed to the unknowns q by s(q): the gradient ∂s/∂qᵀ g, the stiffness ∂s/∂qᵀ K ∂s/∂q plus the
//! curvature of s times g. A section has the position of
//! [`Section::place`](crate::members::flexible_shaft::Section::place) in motion.

use crate::equilibrium::lists::{Place, StaticSection, StaticShaft};
use crate::equilibrium::model::{Evaluation, Five, Model};
use crate::kinematics::euler::quaternion;
use crate::members::race_position::InnerRacePosition;
use nalgebra::{DMatrix, DVector, Dyn, Matrix2, Matrix3, OMatrix, U5, Vector3};

/// Position of one section.
pub struct SectionPlace {
    pub coordinates: Five,
    axis: Vector3<f64>,
    /// Vector from the body's centre to the section's.
    arm: Vector3<f64>,
    turn: Matrix3<f64>,
    /// sin τ/τ and its slope over τ², α and β: the section's rotation towards e₂ and e₃.
    bent: [f64; 4],
    /// Shortening towards the body's centre per unit of each bending amplitude; empty if omitted.
    nearer: Vec<f64>,
}

/// First unknown of a section's body (`None` if it is fixed) and of its shaft.
type Firsts = (Option<usize>, usize);

fn along(shape: &[f64], amplitudes: &[f64]) -> f64 {
    shape.iter().zip(amplitudes).map(|(shape, amplitude)| shape * amplitude).sum()
}

impl SectionPlace {
    /// Section of a body at these coordinates, with these amplitudes.
    pub fn new(of: &StaticSection, body: &Five, amplitudes: &[f64]) -> SectionPlace {
        let section = &of.section;
        let (a, rest) = amplitudes.split_at(section.deflection.len());
        let (b, c) = rest.split_at(section.deflection.len());
        let turn = quaternion(0.0, body[3], body[4]).to_rotation_matrix().into_inner();
        // D a and D b.
        let nearer: Vec<f64> = [a, b]
            .into_iter()
            .flat_map(|gone| {
                section.shortening.chunks_exact(gone.len().max(1)).map(|row| along(row, gone))
            })
            .collect();
        let off = Vector3::new(
            section.along + along(&section.stretch, c) - 0.5 * along(&nearer, amplitudes),
            along(&section.deflection, a),
            along(&section.deflection, b),
        );
        let (towards_2, towards_3) = (along(&section.turn, a), along(&section.turn, b));
        let square = towards_2 * towards_2 + towards_3 * towards_3;
        let angle = square.sqrt();
        // Series for small angles.
        let (sine, slope) = if angle < 1e-3 {
            (1.0 - square / 6.0 + square * square / 120.0, -1.0 / 6.0 + square / 60.0)
        } else {
            let sine = libm::sin(angle) / angle;
            (sine, (libm::cos(angle) - sine) / (2.0 * square))
        };
        let axis = turn * Vector3::new(libm::cos(angle), sine * towards_2, sine * towards_3);
        let arm = turn * off;
        let coordinates = Five::from([
            body[0] + arm.x,
            body[1] + arm.y,
            body[2] + arm.z,
            libm::atan2(-axis.z, axis.x),
            libm::asin(axis.y.clamp(-1.0, 1.0)),
        ]);
        let bent = [sine, slope, towards_2, towards_3];
        SectionPlace { coordinates, axis, arm, turn, bent, nearer }
    }

    /// Derivatives of centre and axis by the body's five coordinates and the amplitudes.
    pub fn slopes(&self, of: &StaticSection) -> [Vec<Vector3<f64>>; 2] {
        let section = &of.section;
        let [e1, e2, e3] = [0, 1, 2].map(|i| self.turn.column(i).into_owned());
        let [sine, slope, towards_2, towards_3] = self.bent;
        let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
        let mut centre = axes.to_vec();
        let mut axis = vec![Vector3::zeros(); 3];
        for about in [Vector3::y(), e3] {
            centre.push(about.cross(&self.arm));
            axis.push(about.cross(&self.axis));
        }
        // Derivatives of (cos τ, α sin τ/τ, β sin τ/τ) by α and β.
        let across = 2.0 * slope * towards_2 * towards_3;
        let by_2 =
            Vector3::new(-sine * towards_2, sine + 2.0 * slope * towards_2 * towards_2, across);
        let by_3 =
            Vector3::new(-sine * towards_3, across, sine + 2.0 * slope * towards_3 * towards_3);
        let (by_2, by_3) = (self.turn * by_2, self.turn * by_3);
        for (direction, bends) in [(e2, by_2), (e3, by_3)] {
            centre.extend(section.deflection.iter().map(|w| direction * *w));
            axis.extend(section.turn.iter().map(|turn| bends * *turn));
        }
        for (centre, nearer) in centre[5..].iter_mut().zip(&self.nearer) {
            *centre -= e1 * *nearer;
        }
        centre.extend(section.stretch.iter().map(|s| e1 * *s));
        axis.resize(centre.len(), Vector3::zeros());
        [centre, axis]
    }

    /// ∂s/∂q over the same, from the derivatives of centre and axis, and those of the axis by the section's tilts.
    pub fn motion(
        &self,
        [centre, axis]: &[Vec<Vector3<f64>>; 2],
    ) -> (OMatrix<f64, U5, Dyn>, Tilts) {
        let ([by_xi, by_lambda], [xi_xi, xi_lambda, _]) =
            InnerRacePosition::new(&self.coordinates).turning();
        let per = [by_xi / by_xi.norm_squared(), by_lambda / by_lambda.norm_squared()];
        let motion = OMatrix::<f64, U5, Dyn>::from_fn(centre.len(), |i, j| match i {
            0..3 => centre[j][i],
            _ => per[i - 3].dot(&axis[j]),
        });
        (motion, Tilts { per, xi_xi, xi_lambda })
    }

    /// Curvature of s(q) times the gradient `gradient` over s.
    pub fn curvature(
        &self,
        of: &StaticSection,
        gradient: &Five,
        slopes: &[Vec<Vector3<f64>>; 2],
        (motion, tilts): (&OMatrix<f64, U5, Dyn>, &Tilts),
    ) -> DMatrix<f64> {
        let section = &of.section;
        let bending = section.deflection.len();
        let force = Vector3::new(gradient[0], gradient[1], gradient[2]);
        let pull = force.dot(&self.turn.column(0));
        let axis_slope = tilts.per[0] * gradient[3] + tilts.per[1] * gradient[4];
        let e3 = self.turn.column(2).into_owned();
        let [_, _, towards_2, towards_3] = self.bent;
        let [centre, axis] = slopes;
        let count = centre.len();
        let mut curved = DMatrix::zeros(count, count);
        let abouts = [Vector3::y(), e3];
        // Tilts of the body rotate everything; the first of two tilts rotates the axis of the second.
        for (one, about) in abouts.iter().enumerate() {
            for other in one..2 {
                let [centre, axis] =
                    [self.arm, self.axis].map(|v| about.cross(&abouts[other].cross(&v)));
                curved[(3 + one, 3 + other)] = force.dot(&centre) + axis_slope.dot(&axis);
            }
            for k in 5..count {
                curved[(3 + one, k)] =
                    force.dot(&about.cross(&centre[k])) + axis_slope.dot(&about.cross(&axis[k]));
            }
        }
        // Second derivatives of (cos τ, α sin τ/τ, β sin τ/τ) for small rotations.
        let second = |v: [f64; 3]| axis_slope.dot(&(self.turn * Vector3::from(v)));
        let both = second([0.0, -towards_3 / 3.0, -towards_2 / 3.0]);
        let bent = [
            [second([-1.0, -towards_2, -towards_3 / 3.0]), both],
            [both, second([-1.0, -towards_2 / 3.0, -towards_3])],
        ];
        for i in 0..2 * bending {
            for j in i..2 * bending {
                let turns = section.turn[i % bending] * section.turn[j % bending];
                curved[(5 + i, 5 + j)] = bent[i / bending][j / bending] * turns;
                if i / bending == j / bending && !section.shortening.is_empty() {
                    let nearer = section.shortening[(i % bending) * bending + j % bending];
                    curved[(5 + i, 5 + j)] -= pull * nearer;
                }
            }
        }
        curved.fill_lower_triangle_with_upper_triangle();
        // Less what the stiffness over the section's tilts contains.
        let cross = axis_slope.dot(&tilts.xi_lambda);
        let counted = Matrix2::new(axis_slope.dot(&tilts.xi_xi), cross, cross, 0.0);
        let tilting = motion.fixed_rows::<2>(3);
        curved - tilting.transpose() * counted * tilting
    }
}

/// Derivatives of a section's axis by its own tilts: reciprocal first and second derivatives.
pub struct Tilts {
    per: [Vector3<f64>; 2],
    xi_xi: Vector3<f64>,
    xi_lambda: Vector3<f64>,
}

/// Energy, load and stiffness of the modal springs.
pub(crate) fn add_shaft(shaft: &StaticShaft, first: usize, here: &mut Evaluation) {
    for (k, spring) in shaft.springs.iter().enumerate() {
        let i = first + k;
        let gone = here.at[i];
        here.energy += 0.5 * spring * gone * gone;
        here.gradient[i] += spring * gone;
        here.stiffness[(i, i)] += spring;
    }
}

/// Dependence of a section on the unknowns.
pub(crate) struct Moved<'m> {
    of: &'m StaticSection,
    /// First of its own coordinates, which follow the unknowns.
    own: usize,
    place: SectionPlace,
    slopes: [Vec<Vector3<f64>>; 2],
    pub(crate) motion: OMatrix<f64, U5, Dyn>,
    tilts: Tilts,
    /// Columns of the motion, and the unknown of each.
    pub(crate) columns: Vec<(usize, usize)>,
}

/// All sections, in the order of their bodies.
pub(crate) fn sections<'m>(model: &'m Model, at: &DVector<f64>) -> Vec<Moved<'m>> {
    let follow = |(own, of): (usize, &'m StaticSection)| {
        let place = model.section_place(of, at);
        let slopes = place.slopes(of);
        let (motion, tilts) = place.motion(&slopes);
        let columns = columns(model.firsts_of(of), motion.ncols()).collect();
        Moved { of, own, place, slopes, motion, tilts, columns }
    };
    all_sections(model).map(follow).collect()
}

fn all_sections<'m>(model: &'m Model) -> impl Iterator<Item = (usize, &'m StaticSection)> {
    let bodies = model.assembly.bodies.iter().zip(&model.unknowns);
    bodies.filter_map(|(body, first)| match (&body.place, first) {
        (Place::Section(of), Some(first)) => Some((*first, of.as_ref())),
        _ => None,
    })
}

/// Adds the curvature of the sections' positions times the gradient.
pub(crate) fn add_curvature(moved: &[Moved], here: &mut Evaluation) {
    for Moved { of, own, place, slopes, motion, tilts, columns } in moved {
        let gradient: Five = here.gradient.fixed_rows::<5>(*own).into_owned();
        let curved = place.curvature(of, &gradient, slopes, (motion, tilts));
        for &(i, to) in columns {
            for &(j, and) in columns {
                here.stiffness[(to, and)] += curved[(i, j)];
            }
        }
    }
}

/// Transforms gradient and stiffness over sections, which follow the unknowns, to the unknowns.
pub(crate) fn onto_unknowns(model: &Model, moved: &[Moved], here: &mut Evaluation) {
    let unknowns = model.scale.len();
    for Moved { own, motion, columns, .. } in moved {
        let gradient: Five = here.gradient.fixed_rows::<5>(*own).into_owned();
        let block = here.stiffness.columns(*own, 5).into_owned();
        for &(j, to) in columns {
            here.gradient[to] += motion.column(j).dot(&gradient);
            let mut column = here.stiffness.column_mut(to);
            column += &block * motion.column(j);
        }
    }
    for Moved { own, motion, columns, .. } in moved {
        let block = here.stiffness.rows(*own, 5).into_owned();
        for &(i, to) in columns {
            let mut row = here.stiffness.row_mut(to);
            row += motion.column(i).transpose() * &block;
        }
    }
    here.gradient.resize_vertically_mut(unknowns, 0.0);
    here.stiffness.resize_mut(unknowns, unknowns, 0.0);
}

/// Transforms rows over sections, which follow the unknowns, to the unknowns.
pub(crate) fn rows_onto_unknowns(
    model: &Model,
    moved: &[Moved],
    mut rows: DMatrix<f64>,
) -> DMatrix<f64> {
    for Moved { own, motion, columns, .. } in moved {
        let block = rows.columns(*own, 5).into_owned();
        for &(j, to) in columns {
            let mut column = rows.column_mut(to);
            column += &block * motion.column(j);
        }
    }
    rows.columns(0, model.scale.len()).into_owned()
}

/// Columns of a section's motion, and the index of each unknown.
fn columns((body, shaft): Firsts, count: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..count).filter_map(move |i| Some((i, if i < 5 { body? + i } else { shaft + i - 5 })))
}
