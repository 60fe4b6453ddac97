//! Flexible shafts in the matrix of a linearly implicit step. Each attachment section is a massless hub, whose six
//! velocities follow from those of its body and of the modes.
//!
//! Balls, joints and solids are eliminated into sections as into bodies; the small matrix over bodies and sections is
//! then projected onto bodies and bending modes. The shortening of second order in bending is omitted: the method is of
//! third order with any matrix.

use crate::kinematics::vec3::{Vec3, cross, scale, sub};
use crate::members::mount::Mount;
use crate::members::section_attachment::SectionAttachment;
use crate::motion::elimination::LdltMatrix;
use crate::motion::linearised::{Hub, Linearised, Shapes, to_basis};
use crate::motion::system::System;

/// A hub without mass and prescribed velocities.
pub(crate) const FREE: Hub = Hub {
    at: 0,
    basis: [[0.0; 3]; 3],
    inertia: [0.0; 6],
    stiffness: [0.0; 6],
    damping: [0.0; 6],
    free: [1.0; 6],
    prescribed: [0.0; 6],
};

/// A section of a flexible body.
#[derive(Clone, Debug, Default)]
pub struct SectionHub {
    /// Index of its hub, and of its body's hub.
    pub hub: usize,
    pub body: Option<usize>,
    /// Index of the shaft in the assembly.
    pub shaft: usize,
    /// Its six velocities: one column for each free velocity of its body, then for each mode along e₂, e₃ and the axis.
    rows: [Vec<f64>; 6],
}

/// One for each attachment of [`crate::assembly::section_attachments::SectionAttachments::all`], numbered after the
/// bodies.
pub(crate) fn sections(
    system: &System,
    hub_of: &[Option<usize>],
    bodies: usize,
) -> Vec<SectionHub> {
    let all = system.holds.all(&system.assembly).enumerate();
    let section = |(number, (hold, mount)): (usize, (&SectionAttachment, Mount))| {
        let columns = 6 + 2 * hold.section.deflection.len() + hold.section.stretch.len();
        SectionHub {
            hub: bodies + number,
            body: hub_of[mount.body],
            shaft: hold.shaft,
            rows: std::array::from_fn(|_| vec![0.0; columns]),
        }
    };
    all.map(section).collect()
}

/// Modal equations of all shafts, along e₂, e₃ and the axis of each.
pub(crate) fn shapes(system: &System) -> Vec<Shapes> {
    let shafts = system.assembly.shafts.iter().zip(&system.shafts);
    let of = shafts.map(|(shaft, &at)| {
        let stiffness: Vec<f64> = shaft.frequencies().map(|w| w * w).collect();
        let damping = shaft.damping + shaft.internal_damping;
        Shapes { at, stiffness, damping }
    });
    of.collect()
}

/// Updates directions and dependence of all sections; the `hubs` of bodies are up to date.
pub(crate) fn update(sections: &mut [SectionHub], hubs: &mut [Hub], system: &System) {
    let all = system.holds.all(&system.assembly);
    for (section, (hold, mount)) in sections.iter_mut().zip(all) {
        let body = &system.bodies[mount.body];
        let now = &hold.now;
        let [own2, own3] = now.race.tilt_directions;
        hubs[section.hub].basis = [now.axis, own2, own3];
        let hub = hubs[section.hub];
        let arm = sub(now.race.motion.position, body.motion.position);
        let [e2, e3] = body.tilt_directions;
        let (free, prescribed) = match section.body {
            Some(body) => (hubs[body].free, hubs[body].prescribed),
            None => ([0.0; 6], [0.0; 6]),
        };
        let mut driven = [0.0; 6];
        for column in 0..6 {
            let (linear, turning) = match column {
                0..3 => (std::array::from_fn(|i| f64::from(i == column)), [0.0; 3]),
                // Each section spins about its own axis.
                3 => ([0.0; 3], now.axis),
                _ => {
                    let about = body.tilt_directions[column - 4];
                    (cross(about, arm), about)
                }
            };
            let six = to_basis(&hub, linear, turning);
            for ((row, driven), value) in section.rows.iter_mut().zip(&mut driven).zip(six) {
                *driven += value * prescribed[column];
                row[column] = value * free[column];
            }
        }
        hubs[section.hub].prescribed = driven;
        let count = hold.section.deflection.len();
        for k in 0..count {
            let (deflection, turn) = (hold.section.deflection[k], hold.section.turn[k]);
            let bent = |linear: Vec3, turning: Vec3| {
                to_basis(&hub, scale(linear, deflection), scale(turning, turn))
            };
            let both = [bent(e2, e3), bent(e3, scale(e2, -1.0))];
            for (side, six) in both.into_iter().enumerate() {
                for (row, value) in section.rows.iter_mut().zip(six) {
                    row[6 + side * count + k] = value;
                }
            }
        }
        for (k, stretch) in hold.section.stretch.iter().enumerate() {
            let six = to_basis(&hub, scale(body.motion.axis, *stretch), [0.0; 3]);
            for (row, value) in section.rows.iter_mut().zip(six) {
                row[6 + 2 * count + k] = value;
            }
        }
    }
}

/// The small matrix with sections projected onto bodies and modes, and its working memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Bending {
    /// For each unknown over hubs: its index after the projection, or its part of the section.
    from: Vec<Unknown>,
    /// Over bodies and bending modes.
    matrix: LdltMatrix,
    right: Vec<f64>,
    /// Indices of the columns of a section's rows after the projection.
    columns: Vec<Vec<usize>>,
    /// First bending mode of each shaft.
    first: Vec<usize>,
    product: Vec<f64>,
}

#[derive(Clone, Copy, Debug)]
enum Unknown {
    Kept(usize),
    Section { number: usize, part: usize },
}

impl Bending {
    pub(crate) fn new(linearised: &Linearised, before: usize) -> Bending {
        let bodies = 6 * linearised.bodies();
        let mut size = bodies;
        let first = linearised.shafts.iter().map(|shaft| {
            let first = size;
            size += shaft.stiffness.len();
            first
        });
        let first: Vec<usize> = first.collect();
        let columns = linearised.sections.iter().map(|section| {
            let shaft = &linearised.shafts[section.shaft];
            let from = first[section.shaft];
            // The columns of a body without equations are zero.
            let own = 6 * section.body.unwrap_or(0);
            (own..own + 6).chain(from..from + shaft.stiffness.len()).collect()
        });
        let unknown = |index: usize| match index {
            _ if index < bodies => Unknown::Kept(index),
            _ => Unknown::Section { number: (index - bodies) / 6, part: (index - bodies) % 6 },
        };
        Bending {
            from: (0..before).map(unknown).collect(),
            matrix: LdltMatrix::new(size),
            right: vec![0.0; size],
            columns: columns.collect(),
            product: vec![0.0; size],
            first,
        }
    }

    /// Projects `schur` and factors it.
    pub(crate) fn factor(&mut self, linearised: &Linearised, scale: f64, schur: &mut LdltMatrix) {
        let Bending { from, matrix, columns, first, product, .. } = self;
        matrix.clear();
        for (shaft, first) in linearised.shafts.iter().zip(&*first) {
            for (k, stiffness) in shaft.stiffness.iter().enumerate() {
                let at = first + k;
                *matrix.at(at, at) = 1.0 + scale * (shaft.damping + scale * stiffness);
            }
        }
        for (row, of) in from.iter().enumerate() {
            // Row of S P, then Pᵀ on its left.
            product.fill(0.0);
            for (column, to) in from.iter().enumerate() {
                let value = *schur.at(row.min(column), row.max(column));
                match *to {
                    _ if value == 0.0 => {}
                    Unknown::Kept(to) => product[to] += value,
                    Unknown::Section { number, part } => {
                        let own = &linearised.sections[number].rows[part];
                        for (to, own) in columns[number].iter().zip(own) {
                            product[*to] += value * own;
                        }
                    }
                }
            }
            match *of {
                Unknown::Kept(to) => matrix.add_to_row(to, to, 1.0, &product[to..]),
                Unknown::Section { number, part } => {
                    let own = &linearised.sections[number].rows[part];
                    for (&to, own) in columns[number].iter().zip(own) {
                        matrix.add_to_row(to, to, *own, &product[to..]);
                    }
                }
            }
        }
        matrix.factor();
    }

    /// Displacements of sections from those of bodies and modes in `r`.
    pub(crate) fn displace(&self, linearised: &Linearised, r: &[f64], moved: &mut [[f64; 6]]) {
        for section in &linearised.sections {
            let shaft = &linearised.shafts[section.shaft];
            let body = section.body.map_or([0.0; 6], |body| moved[body]);
            let gone = &r[shaft.at..shaft.at + shaft.stiffness.len()];
            for (moved, row) in moved[section.hub].iter_mut().zip(&section.rows) {
                let all = body.iter().chain(gone);
                *moved = row.iter().zip(all).map(|(row, by)| row * by).sum();
            }
        }
    }

    /// Replaces right-hand sides by the rates of all hubs, and writes those of the modes into `w`.
    pub(crate) fn solve(
        &mut self,
        linearised: &Linearised,
        scale: f64,
        r: &[f64],
        hubs: &mut [f64],
        w: &mut [f64],
    ) {
        let Bending { from, matrix, right, columns, first, .. } = self;
        for (shaft, first) in linearised.shafts.iter().zip(&*first) {
            let count = shaft.stiffness.len();
            for (k, stiffness) in shaft.stiffness.iter().enumerate() {
                right[first + k] = r[shaft.at + count + k] - scale * stiffness * r[shaft.at + k];
            }
        }
        for (force, to) in hubs.iter().zip(from.iter()) {
            if let Unknown::Kept(to) = *to {
                right[to] = *force;
            }
        }
        for (section, columns) in linearised.sections.iter().zip(columns.iter()) {
            for (row, force) in section.rows.iter().zip(&hubs[6 * section.hub..]) {
                for (to, own) in columns.iter().zip(row) {
                    right[*to] += own * force;
                }
            }
        }
        matrix.solve(right);
        for (rate, to) in hubs.iter_mut().zip(from.iter()) {
            *rate = match *to {
                Unknown::Kept(to) => right[to],
                Unknown::Section { number, part } => {
                    let own = linearised.sections[number].rows[part].iter();
                    own.zip(&columns[number]).map(|(own, to)| own * right[*to]).sum()
                }
            };
        }
        for (shaft, first) in linearised.shafts.iter().zip(&*first) {
            let count = shaft.stiffness.len();
            for k in 0..count {
                let rate = right[first + k];
                w[shaft.at + k] = r[shaft.at + k] + scale * rate;
                w[shaft.at + count + k] = rate;
            }
        }
    }
}
