//! Table of a dent's contact law, from a half-space loaded by the ball at many approaches and positions.

use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use crate::ch3_bushing::dent::{DIRECTIONS, DentShape, DentTable, directions, spline};
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
        DIRECTIONS * self.intervals[0] * (self.intervals[1] + 1) + 3
    }
}

/// Largest pressure of the undented contact in a table, Pa: the static capacity of ball bearings (ISO 76).
pub const LARGEST_PRESSURE: f64 = 4.2e9;
/// Most cells in each direction where the dent is on neither axis of the contact: there a solution takes four times as
/// long.
const OFF_AXES: usize = 40;
/// Tolerance of the gap in contact, in parts of the largest overclosure: energies err by its square.
const CLOSED: f64 = 1e-4;
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

/// Positions of dents for which a half-space is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DentOn {
    /// The axis of the contact in the rolling direction, at which its cells are mirrored.
    Rolling,
    /// The axis across the groove, likewise.
    Across,
    Anywhere,
}

/// A half-space for all approaches of a contact with a dent: its grid grows with the overlap.
pub struct Bed {
    contact: DentedContact,
    influence: Influence,
    /// Its x is along the axis with the dent.
    unit: Grid,
    on: DentOn,
    /// Energy of the undented contact over δ^{5/2}.
    undented: f64,
}

impl Bed {
    /// # Errors
    ///
    /// An undented contact that does not converge.
    pub fn new(contact: DentedContact, cells: usize, on: DentOn) -> Result<Bed, DentError> {
        let [rolling, across] = contact.spread();
        let [x, y] = if on == DentOn::Across { [across, rolling] } else { [rolling, across] };
        let size = |half: f64| 2.0 * half / cells as f64;
        let mirrored = on != DentOn::Anywhere;
        let ny = if mirrored { cells / 2 } else { cells };
        let unit = Grid { nx: cells, ny, hx: size(x), hy: size(y), mirrored };
        let influence = Influence::new(unit);
        let mut bed = Bed { contact, influence, unit, on, undented: 0.0 };
        // All approaches are similar.
        let approach = contact.deepest;
        bed.undented = bed.solve(0.0, approach, None, None)?.energy / five_halves(approach);
        Ok(bed)
    }

    /// Contact at an approach (m) with a dent at this position along the rolling direction and across the groove (m), or
    /// without one. Cells cover all possible contact of a highest point `shoulder` (m) above the surface.
    ///
    /// # Errors
    ///
    /// Conjugate gradients that do not converge.
    pub fn solve(
        &self,
        shoulder: f64,
        approach: f64,
        dent: Option<[f64; 2]>,
        guess: Option<&[f64]>,
    ) -> Result<Pressed, DentError> {
        let scale = (approach + shoulder).sqrt();
        let gap = (0..self.unit.cells()).map(|cell| {
            let [x, y] = self.unit.middle(cell).map(|at| at * scale);
            let point = if self.on == DentOn::Across { [y, x] } else { [x, y] };
            dent.map_or_else(|| self.contact.undented(point), |dent| self.contact.gap(point, dent))
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
    let beds = [
        Bed::new(*contact, fineness.cells, DentOn::Rolling)?,
        Bed::new(*contact, fineness.cells.min(OFF_AXES), DentOn::Anywhere)?,
        Bed::new(*contact, fineness.cells, DentOn::Across)?,
    ];
    let [rows, columns] = fineness.intervals;
    let shoulder = contact.shape.shoulder_height;
    let (reach, spread) = (contact.shape.reach(), contact.spread());
    let deepest = (contact.deepest + shoulder).sqrt();
    let directions = directions();
    let mut values = [(); DIRECTIONS].map(|()| vec![0.0; (rows + 1) * (columns + 1)]);
    for row in 0..=rows {
        let q = deepest * row as f64 / rows as f64;
        let approach = q * q - shoulder;
        // The undented contact on the same cells is the reference, so that errors of the grid cancel.
        let flat = |bed: &Bed| -> Result<f64, DentError> {
            if approach <= 0.0 {
                return Ok(1.0);
            }
            Ok(bed.equivalent(bed.solve(shoulder, approach, None, None)?.energy) / approach)
        };
        let flats = [flat(&beds[0])?, flat(&beds[1])?, flat(&beds[2])?];
        for (direction, values) in values.iter_mut().enumerate() {
            let sine = directions[direction][0];
            let ellipse = [(1.0 - sine).sqrt(), sine.sqrt()];
            let on =
                [0, 1, 2][usize::from(direction > 0) + usize::from(direction == DIRECTIONS - 1)];
            let mut last: Option<Vec<f64>> = None;
            // At the centre, the first column, all directions have the same value.
            for column in usize::from(on > 0)..columns {
                let sigma = column as f64 / columns as f64;
                let dent = [0, 1].map(|i| sigma * ellipse[i] * (reach + spread[i] * q));
                let free = contact.free_drop(dent);
                let drop = if approach <= free {
                    free
                } else {
                    let bed = &beds[on];
                    let found = bed.solve(shoulder, approach, Some(dent), last.as_deref())?;
                    let drop = approach - bed.equivalent(found.energy) / flats[on];
                    last = Some(found.pressure);
                    drop
                };
                values[row * (columns + 1) + column] = drop;
            }
        }
        let centre = values[0][row * (columns + 1)];
        values.iter_mut().for_each(|values| values[row * (columns + 1)] = centre);
    }
    let coefficients = values.map(|values| splined(&values, rows, columns));
    let intervals = fineness.intervals;
    Ok(DentTable { shoulder, reach, spread, deepest, intervals, coefficients, directions })
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
