//! Table of a dent's contact law, from a half-space loaded by the ball at many approaches and positions.

use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use crate::ch3_bushing::dent::{DentShape, DentTable, spline};
use crate::members::half_space::{Grid, Influence, Pressed, press};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use thiserror::Error;

/// Resolution of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fineness {
    /// Cells of the half-space across the contact in each direction; even.
    pub cells: usize,
    /// Intervals of the table in q and σ.
    pub intervals: [usize; 2],
}

impl Fineness {
    /// Resolution of runs: forces of the dents of section 3.4.4 within 1 % of much finer tables.
    pub const USUAL: Fineness = Fineness { cells: 40, intervals: [28, 16] };
    /// A shoulder of a micrometre carries load before the surface around it, on fewer cells: forty give an error of 2 %
    /// of a load that such a dent changes by 2 %, eighty 0.2 %.
    pub const SHOULDERED: Fineness = Fineness { cells: 80, ..Fineness::USUAL };

    /// Resolution for a dent of this shape.
    pub fn of(shape: &DentShape) -> Fineness {
        if shape.shoulder_height > 0.0 { Fineness::SHOULDERED } else { Fineness::USUAL }
    }

    /// Largest number of half-space solutions.
    pub fn solves(&self) -> usize {
        2 * self.intervals[0] * (self.intervals[1] + 1) + 2
    }
}

/// Largest pressure of the undented contact in a table, Pa: the static capacity of ball bearings (ISO 76).
pub const LARGEST_PRESSURE: f64 = 4.2e9;
/// Tolerance of the gap in contact, in parts of the largest overclosure.
const CLOSED: f64 = 1e-5;
/// Points across a dent in the search for the first contact.
const SEARCHED: usize = 80;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum DentError {
    #[error(
        "the contact over a dent of {diameter} m at an approach of {approach} m does not converge; \
          try a less steep dent"
    )]
    NoContact { diameter: f64, approach: f64 },
}

/// A ball over a dented race.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DentedContact {
    pub shape: DentShape,
    /// Relative radii in the rolling direction and across the groove, m.
    pub radii: [f64; 2],
    /// Largest approach of the table, m.
    pub deepest: f64,
}

impl DentedContact {
    pub fn new(shape: DentShape, hertz: &HertzContact) -> DentedContact {
        // p ∝ W^(1/3) ∝ √δ.
        let at_one = contact_ellipse(hertz, hertz.stiffness).peak_pressure;
        let ratio = LARGEST_PRESSURE / at_one;
        DentedContact {
            shape,
            radii: [hertz.radius_rolling, hertz.radius_transverse],
            deepest: ratio * ratio,
        }
    }

    /// Gap at a point, m, when the surfaces just touch without the dent.
    fn undented(&self, [x, y]: [f64; 2]) -> f64 {
        0.5 * (x * x / self.radii[0] + y * y / self.radii[1])
    }

    fn gap(&self, [x, y]: [f64; 2], dent: [f64; 2]) -> f64 {
        let r = libm::hypot(x - dent[0], y - dent[1]);
        self.undented([x, y]) + self.shape.depth_at(r)
    }

    /// Smallest gap, m: displacement of the ball before it touches anything.
    fn free_drop(&self, dent: [f64; 2]) -> f64 {
        let reach = self.shape.reach();
        let start = if libm::hypot(dent[0], dent[1]) >= reach { 0.0 } else { f64::INFINITY };
        let at = |i: usize| (2.0 * i as f64 / SEARCHED as f64 - 1.0) * reach;
        let points = (0..=SEARCHED).flat_map(|i| (0..=SEARCHED).map(move |j| [at(i), at(j)]));
        points.fold(start, |least, [x, y]| least.min(self.gap([dent[0] + x, dent[1] + y], dent)))
    }

    fn spread(&self) -> [f64; 2] {
        self.radii.map(|radius| (2.0 * radius).sqrt())
    }
}

/// A half-space for all approaches of a contact with a dent on one of its two axes: its grid grows with the overlap,
/// and is mirrored at that axis.
pub struct Bed {
    contact: DentedContact,
    influence: Influence,
    /// Its x is along the axis with the dent.
    unit: Grid,
    /// 0 for the rolling direction, 1 for the one across the groove.
    direction: usize,
    /// Energy of the undented contact over δ^{5/2}.
    undented: f64,
}

impl Bed {
    /// # Errors
    ///
    /// An undented contact that does not converge.
    pub fn new(contact: DentedContact, cells: usize, direction: usize) -> Result<Bed, DentError> {
        let spread = contact.spread();
        let [x, y] = [spread[direction], spread[1 - direction]];
        let size = |half: f64| 2.0 * half / cells as f64;
        let unit = Grid { nx: cells, ny: cells / 2, hx: size(x), hy: size(y), mirrored: true };
        let influence = Influence::new(unit);
        let mut bed = Bed { contact, influence, unit, direction, undented: 0.0 };
        // All approaches are similar.
        let approach = contact.deepest;
        bed.undented = bed.solve(0.0, approach, None, None)?.energy / five_halves(approach);
        Ok(bed)
    }

    /// Contact at an approach (m) with a dent at this position along the axis (m), or without one. Cells cover all
    /// possible contact of a highest point `shoulder` (m) above the surface.
    ///
    /// # Errors
    ///
    /// Conjugate gradients that do not converge.
    pub fn solve(
        &self,
        shoulder: f64,
        approach: f64,
        dent: Option<f64>,
        guess: Option<&[f64]>,
    ) -> Result<Pressed, DentError> {
        let scale = (approach + shoulder).sqrt();
        let gap = (0..self.unit.cells()).map(|cell| {
            let [along, aside] = self.unit.middle(cell).map(|at| at * scale);
            let point = if self.direction == 0 { [along, aside] } else { [aside, along] };
            let below = dent
                .map_or(0.0, |dent| self.contact.shape.depth_at(libm::hypot(along - dent, aside)));
            self.contact.undented(point) + below
        });
        let gap: Vec<f64> = gap.collect();
        press(&self.influence, scale, &gap, approach, guess, CLOSED)
            .ok_or(DentError::NoContact { diameter: self.contact.shape.diameter, approach })
    }

    /// Approach of the undented contact with this `energy`, m.
    fn equivalent(&self, energy: f64) -> f64 {
        libm::pow(energy / self.undented, 0.4)
    }
}

fn five_halves(approach: f64) -> f64 {
    approach * approach * approach.sqrt()
}

/// Number of tables kept by [`usual_table`].
const REMEMBERED: usize = 8;

/// The table of runs. It depends on the contact alone and takes seconds: the latest are kept, since plans and the
/// points of a sweep need it repeatedly. A table that is being computed is waited for.
///
/// # Errors
///
/// See [`dent_table`].
pub fn usual_table(contact: &DentedContact) -> Result<Arc<DentTable>, DentError> {
    type Made = OnceLock<Result<Arc<DentTable>, DentError>>;
    static LATEST: Mutex<Vec<(DentedContact, Arc<Made>)>> = Mutex::new(Vec::new());
    let made = {
        let mut latest = LATEST.lock().unwrap_or_else(PoisonError::into_inner);
        let known = latest.iter().position(|(other, _)| other == contact);
        let entry = known.map_or_else(|| (*contact, Arc::default()), |at| latest.remove(at));
        latest.insert(0, entry.clone());
        latest.truncate(REMEMBERED);
        entry.1
    };
    made.get_or_init(|| dent_table(contact, Fineness::of(&contact.shape)).map(Arc::new)).clone()
}

/// Table of a dent's law.
///
/// # Errors
///
/// A contact that does not converge.
pub fn dent_table(contact: &DentedContact, fineness: Fineness) -> Result<DentTable, DentError> {
    let bed = |direction| Bed::new(*contact, fineness.cells, direction);
    let beds = [bed(0)?, bed(1)?];
    let [rows, columns] = fineness.intervals;
    let shoulder = contact.shape.shoulder_height;
    let (reach, spread) = (contact.shape.reach(), contact.spread());
    let deepest = (contact.deepest + shoulder).sqrt();
    let mut values = [vec![0.0; (rows + 1) * (columns + 1)], vec![0.0; (rows + 1) * (columns + 1)]];
    for row in 0..=rows {
        let q = deepest * row as f64 / rows as f64;
        let approach = q * q - shoulder;
        for (direction, (bed, values)) in beds.iter().zip(&mut values).enumerate() {
            // The undented contact on the same cells is the reference, so that errors of the grid cancel.
            let flat = if approach > 0.0 {
                let found = bed.solve(shoulder, approach, None, None)?;
                bed.equivalent(found.energy) / approach
            } else {
                1.0
            };
            let mut last: Option<Vec<f64>> = None;
            for column in 0..columns {
                let sigma = column as f64 / columns as f64;
                let along = sigma * (reach + spread[direction] * q);
                let free =
                    contact.free_drop(if direction == 0 { [along, 0.0] } else { [0.0, along] });
                let drop = if approach <= free {
                    free
                } else {
                    let found = bed.solve(shoulder, approach, Some(along), last.as_deref())?;
                    let drop = approach - bed.equivalent(found.energy) / flat;
                    last = Some(found.pressure);
                    drop
                };
                values[row * (columns + 1) + column] = drop;
            }
        }
    }
    let coefficients = values.map(|values| splined(&values, rows, columns));
    Ok(DentTable { shoulder, reach, spread, deepest, intervals: fineness.intervals, coefficients })
}

/// Splines through values in rows of equal q: along σ, then along q.
fn splined(values: &[f64], rows: usize, columns: usize) -> Vec<f64> {
    let by_row: Vec<Vec<f64>> = values.chunks(columns + 1).map(|row| spline(row, true)).collect();
    let mut coefficients = vec![0.0; (rows + 3) * (columns + 3)];
    for column in 0..columns + 3 {
        let values: Vec<f64> = by_row.iter().map(|row| row[column]).collect();
        for (row, value) in spline(&values, false).into_iter().enumerate() {
            coefficients[row * (columns + 3) + column] = value;
        }
    }
    coefficients
}
