//! Columns of a quasi-static sequence: races, bodies, loads and housing fits.

use super::Recorder;
use super::seat::{SeatRow, prefix, seat_columns};
use crate::equilibrium::quasi_static_sequence::{QuasiStaticProblem, QuasiStaticSequence};
use crate::members::mount::Mount;
use crate::output::series::Column;

/// Columns of bearings, other bodies and housings, with or without the ball loads.
pub(super) fn columns(problem: &QuasiStaticProblem, with_loads: bool) -> Vec<Column> {
    let bearings = &problem.assembly.bearings;
    let mut columns = Vec::new();
    let mut place = |of: String| {
        for (name, unit) in
            [("x", "m"), ("y", "m"), ("z", "m"), ("tilt_y", "deg"), ("tilt_z", "deg")]
        {
            columns.push(Column::new(format!("{of}_{name}"), unit));
        }
    };
    for (bearing, side) in moving_races(problem) {
        place(format!("{}{}", bearings[bearing].prefix(), RACES[side]));
    }
    problem.assembly.bodies.iter().filter_map(|body| body.label.clone()).for_each(place);
    columns.extend(super::channels::probe_columns(&problem.assembly));
    for bearing in bearings {
        for race in RACES {
            let name = |axis| format!("{}contact_force_on_{race}_{axis}", bearing.prefix());
            columns.extend(["x", "y", "z"].map(|axis| Column::new(name(axis), "N")));
        }
    }
    for seat in &problem.seats {
        columns.extend(seat_columns(&prefix(&seat.name)));
    }
    for seat in &problem.seats {
        for name in ["energy_housing_strain", "energy_seat"] {
            columns.push(Column::new(format!("{}{name}", prefix(&seat.name)), "J"));
        }
    }
    for bearing in bearings.iter().filter(|_| with_loads) {
        for ball in 1..=bearing.geometry.ball_count {
            for race in RACES {
                columns
                    .push(Column::new(format!("{}ball_{ball}_{race}_load", bearing.prefix()), "N"));
            }
        }
    }
    columns
}

const RACES: [&str; 2] = ["inner", "outer"];

/// Bearing and side of the races that may move.
fn moving_races(problem: &QuasiStaticProblem) -> Vec<(usize, usize)> {
    let all = (0..problem.assembly.bearings.len()).flat_map(|bearing| [(bearing, 0), (bearing, 1)]);
    all.filter(|(bearing, side)| problem.moves(*bearing, *side)).collect()
}

/// Coordinates with tilts in degrees.
fn in_degrees([x, y, z, tilt_y, tilt_z]: [f64; 5]) -> [f64; 5] {
    [x, y, z, tilt_y.to_degrees(), tilt_z.to_degrees()]
}

impl Recorder {
    /// Adds a row of the latest equilibrium, in the order of [`columns`].
    pub(in crate::output) fn record_equilibrium(&mut self, sequence: &QuasiStaticSequence) {
        let (Some(moment), problem) = (&sequence.latest, &sequence.problem) else { return };
        let found = &moment.solution;
        let full = self.values.len() + self.columns.len();
        self.values.push(moment.time);
        for (bearing, side) in moving_races(problem) {
            self.values.extend(in_degrees(problem.race(found, bearing, side)));
        }
        for (index, body) in problem.assembly.bodies.iter().enumerate() {
            if body.label.is_some() {
                let mut at = found.place(&problem.assembly, index);
                at[0] -= problem.assembly.origin_of(index);
                self.values.extend(in_degrees(at));
            }
        }
        for (index, shaft) in problem.assembly.shafts.iter().enumerate() {
            for (_, section) in &shaft.probes {
                let at = problem.section(found, index, section, &Mount::at_centre(shaft.body));
                let [_, y, z] = at.state.position;
                self.values.extend([y, z]);
            }
        }
        for force in found.bearings.iter().flat_map(|bearing| &bearing.forces) {
            self.values.extend(force.iter());
        }
        for (seat, state) in problem.seats.iter().zip(&found.seats) {
            self.values.extend(SeatRow::of_equilibrium(seat.bore, state).values());
        }
        for state in &found.seats {
            self.values.extend([state.elastic_energy, state.contact_energy]);
        }
        // Only as many ball loads as there are columns for.
        let loads = found.bearings.iter().flat_map(|bearing| &bearing.balls);
        let loads = loads.flat_map(|ball| [ball.inner.normal_load, ball.outer.normal_load]);
        self.values.extend(loads.take(full - self.values.len()));
    }
}
