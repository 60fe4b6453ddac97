//! A run of a solid from start to end: steps, rows of its time series, the last sound state.
//!
//! Step and grid of rows never change on the way; a run ends at the whole step nearest to its end,
//! so that one that was interrupted, or is extended, goes on with the same bits.

use crate::kinematics::vec3::Vec3;
use crate::output::series::{Column, Series, SeriesError};
use crate::scene::solid::SolidRun;
use crate::scene::solid_problem::{NamedNodes, SolidSetup, Support};
use crate::solver::clock::{rounded, to_digits};
use crate::solver::solid::checkpoint::SolidCheckpoint;
use crate::solver::solid::energy::SolidEnergy;
use crate::solver::solid::explicit::{ExplicitSolid, SolidStepping, padded};
use crate::solver::solid::model::{SolidError, SolidModel};
use crate::solver::solid::step_limit::{SolidStepLimit, step_limit};
use crate::solver::solid::stress::look;
use crate::solver::solid::team::Team;
use ndarray::Array2;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum SolidRunError {
    #[error(transparent)]
    Solid(#[from] SolidError),
    #[error(
        "{residual:.3e} J are unaccounted for at t = {} s, step {step}, more than {limit} of \
         the {turned_over:.3e} J turned over; take a smaller step",
        rounded(*time)
    )]
    Energy { residual: f64, turned_over: f64, limit: f64, time: f64, step: u64 },
    #[error("{rows} rows of {columns} columns do not fit in memory; take a longer output interval")]
    Memory { rows: usize, columns: usize },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    Running,
    /// File of fields number so and so is due at the present state.
    Fields(usize),
    Complete,
}

/// The grid of steps, rows and files.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Grid {
    /// s.
    pub step_size: f64,
    pub steps: u64,
    pub steps_per_row: u64,
    pub rows_per_fields: u64,
}

impl Grid {
    /// A step that follows from the stability limit is shortened so that a whole number of steps
    /// makes an output interval; with a given step the interval is rounded to whole steps.
    pub fn new(run: &SolidRun, limit: &SolidStepLimit) -> Grid {
        let interval = run.output_interval;
        let (step_size, steps_per_row) = match run.stepping {
            SolidStepping::FractionOfLimit(fraction) => {
                // A ratio that is whole but for rounding is whole.
                let steps = interval / (fraction * limit.step) * (1.0 - 1e-12);
                let steps = steps.ceil().max(1.0);
                (interval / steps, steps)
            }
            SolidStepping::Fixed(step) => (step, (interval / step).round().max(1.0)),
        };
        let row = steps_per_row * step_size;
        Grid {
            step_size,
            steps: (run.end / step_size).round().max(1.0) as u64,
            steps_per_row: steps_per_row as u64,
            rows_per_fields: (run.fields_interval / row).round().max(1.0) as u64,
        }
    }

    /// Time between rows, s.
    pub fn interval(&self) -> f64 {
        self.steps_per_row as f64 * self.step_size
    }

    /// Rows at equal intervals up to a step, the first at the start.
    pub fn rows_until(&self, step: u64) -> usize {
        (step / self.steps_per_row) as usize + 1
    }
}

pub struct SolidSession {
    pub solid: ExplicitSolid,
    pub grid: Grid,
    pub energy_limit: f64,
    pub probes: Vec<NamedNodes>,
    pub supports: Vec<Support>,
    columns: Vec<Column>,
    values: Vec<f64>,
    /// Energy held less work done at the start, J: what the ledger is held against.
    pub first_balance: f64,
    /// Largest energy held or exchanged so far, J: what is unaccounted for is measured by it.
    pub turned_over: f64,
    /// Largest energy unaccounted for so far, J.
    pub largest_residual: f64,
    /// Rows on end whose ledger did not close.
    pub rows_open: u32,
    /// At the last row on the grid, or before a last row off it.
    sound: Sound,
    /// Threads that step, and the parts they have once there are several.
    threads: usize,
    team: Option<Team>,
    /// Whether `sound` is what a later run goes on from.
    resume_from_sound: bool,
}

/// A state and what the ledger knew there.
#[derive(Clone, Debug, Default)]
pub struct Sound {
    pub checkpoint: SolidCheckpoint,
    pub turned_over: f64,
    pub largest_residual: f64,
    pub rows_open: u32,
}

/// A ledger that does not close at this many rows on end fails a run. One alone may be a blow to a
/// body at rest: what a step leaves of it is much of the little that has been turned over.
const MOST_ROWS_OPEN: u32 = 5;

/// Where a run stood when its state was kept.
#[derive(Clone, Debug)]
pub struct Kept {
    pub checkpoint: SolidCheckpoint,
    pub grid: Grid,
    pub limit: SolidStepLimit,
    pub first_balance: f64,
    pub turned_over: f64,
    pub largest_residual: f64,
    pub rows_open: u32,
    /// Rows so far, one after the other.
    pub values: Vec<f64>,
}

impl SolidSession {
    /// Starts a run and records its first row.
    ///
    /// # Errors
    /// A model that cannot be set up, a step beyond the limit, more rows than fit in memory.
    pub fn start(
        setup: &SolidSetup,
        run: &SolidRun,
        threads: usize,
    ) -> Result<SolidSession, SolidRunError> {
        let model = SolidModel::labelled(setup.problem.clone(), setup.labels.clone())?;
        let still = vec![[0.0; 4]; model.mass.len()];
        let limit = step_limit(&model, &still, run.method);
        let grid = Grid::new(run, &limit);
        let mut session = SolidSession::at_start(setup, run, model, limit, grid)?;
        session.threads = threads;
        session.first_balance = session.solid.ledger().balance();
        session.record()?;
        session.keep();
        Ok(session)
    }

    /// Goes on from a kept state, perhaps to another end.
    ///
    /// # Errors
    /// As [`SolidSession::start`].
    ///
    /// # Panics
    /// If the checkpoint is of another mesh.
    pub fn resume(
        setup: &SolidSetup,
        run: &SolidRun,
        kept: Kept,
        threads: usize,
    ) -> Result<SolidSession, SolidRunError> {
        let model = SolidModel::labelled(setup.problem.clone(), setup.labels.clone())?;
        let steps = (run.end / kept.grid.step_size).round().max(1.0) as u64;
        let grid = Grid { steps, ..kept.grid };
        let mut session = SolidSession::at_start(setup, run, model, kept.limit, grid)?;
        session.solid.restore(&kept.checkpoint);
        session.threads = threads;
        session.first_balance = kept.first_balance;
        session.turned_over = kept.turned_over;
        session.largest_residual = kept.largest_residual;
        session.rows_open = kept.rows_open;
        // A last row off the grid was that of the earlier end.
        let rows = grid.rows_until(kept.checkpoint.steps);
        session.values.extend(kept.values.into_iter().take(rows * session.columns.len()));
        session.keep();
        Ok(session)
    }

    fn at_start(
        setup: &SolidSetup,
        run: &SolidRun,
        model: SolidModel,
        limit: SolidStepLimit,
        grid: Grid,
    ) -> Result<SolidSession, SolidRunError> {
        let still = vec![[0.0; 4]; model.mass.len()];
        let stepping = SolidStepping::Fixed(grid.step_size);
        let velocity = padded(setup.velocity.clone());
        let solid = ExplicitSolid::with_limit(model, run.method, stepping, limit, still, velocity)?;
        let columns = columns(&setup.probes, &setup.supports);
        let rows = grid.rows_until(grid.steps) + 1;
        let mut values = Vec::new();
        let wanted = rows.checked_mul(columns.len());
        if wanted.is_none_or(|wanted| values.try_reserve_exact(wanted).is_err()) {
            return Err(SolidRunError::Memory { rows, columns: columns.len() });
        }
        Ok(SolidSession {
            sound: Sound::default(),
            resume_from_sound: false,
            threads: 1,
            team: None,
            solid,
            grid,
            energy_limit: run.energy_limit,
            probes: setup.probes.clone(),
            supports: setup.supports.clone(),
            columns,
            values,
            first_balance: 0.0,
            turned_over: 0.0,
            largest_residual: 0.0,
            rows_open: 0,
        })
    }

    /// At most `steps` steps, fewer where fields are due or the end comes.
    ///
    /// # Errors
    /// A value that is not finite, an inverted element, an energy ledger that does not close;
    /// [`SolidSession::resumable`] then is the state at the last row.
    pub fn advance(&mut self, steps: u64) -> Result<Progress, SolidRunError> {
        let target = self.solid.steps + steps;
        while self.solid.steps < target {
            if self.solid.steps >= self.grid.steps {
                return Ok(Progress::Complete);
            }
            let done = self.step_to_row(target);
            self.resume_from_sound |= done.is_err();
            if let Some(index) = done? {
                return Ok(Progress::Fields(index));
            }
        }
        Ok(Progress::Running)
    }

    /// Steps to the next row, the end, or `target` before them; the number of the file of fields
    /// that is due there.
    fn step_to_row(&mut self, target: u64) -> Result<Option<usize>, SolidRunError> {
        let next_row = (self.solid.steps / self.grid.steps_per_row + 1) * self.grid.steps_per_row;
        let count = next_row.min(self.grid.steps).min(target) - self.solid.steps;
        if self.threads > 1 {
            let team = self.team.get_or_insert_with(|| Team::new(&self.solid, self.threads));
            team.advance(count)?;
            team.gather(&mut self.solid);
        } else {
            for _ in 0..count {
                self.solid.step(|_, _, _| {})?;
            }
        }
        let steps = self.solid.steps;
        let on_grid = steps.is_multiple_of(self.grid.steps_per_row);
        if !on_grid && steps < self.grid.steps {
            return Ok(None);
        }
        if !on_grid {
            // A longer run would not look here: it goes on from before.
            self.keep();
            self.resume_from_sound = true;
            self.record()?;
            return Ok(None);
        }
        self.record()?;
        self.keep();
        let row = steps / self.grid.steps_per_row;
        let due = row.is_multiple_of(self.grid.rows_per_fields);
        Ok(due.then_some((row / self.grid.rows_per_fields) as usize))
    }

    /// Displacements at the present time, m.
    pub fn displacement(&self) -> Vec<Vec3> {
        self.solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect()
    }

    fn record(&mut self) -> Result<(), SolidRunError> {
        let (time, step) = (self.solid.time, self.solid.steps);
        let displacement = self.displacement();
        if let Some(node) = displacement.iter().position(|u| !u.iter().all(|x| x.is_finite())) {
            return Err(self.solid.model.not_finite(node, time, step).into());
        }
        let seen = look(&self.solid.model, &displacement);
        if let Some((element, ratio)) = seen.inverted {
            return Err(self.solid.model.inverted(element, ratio, time, step).into());
        }
        let ledger = self.solid.ledger();
        let SolidEnergy { strain, kinetic } = ledger.energy;
        let (external, damping) = (ledger.external_work, ledger.damping_work);
        let residual = ledger.balance() - self.first_balance;
        for energy in [strain + kinetic, external.abs(), damping.abs()] {
            self.turned_over = self.turned_over.max(energy);
        }
        self.largest_residual = self.largest_residual.max(residual.abs());
        let closes = residual.abs() <= self.energy_limit * self.turned_over;
        self.rows_open = if closes { 0 } else { self.rows_open + 1 };
        // Written as it is so that a residual that is not a number is refused as well.
        let sound = self.rows_open < MOST_ROWS_OPEN && residual.is_finite();
        if !sound {
            let (turned_over, limit) = (self.turned_over, self.energy_limit);
            return Err(SolidRunError::Energy { residual, turned_over, limit, time, step });
        }
        let largest = displacement.iter().map(length).fold(0.0, f64::max);
        self.values.extend([time, strain, kinetic, external, damping, residual, largest]);
        self.values.push(seen.von_mises);
        for probe in &self.probes {
            self.values.extend(mean(&displacement, &probe.nodes));
        }
        let reactions = self.reactions();
        for support in &self.supports {
            self.values.extend(support.total(&reactions));
        }
        Ok(())
    }

    fn keep(&mut self) {
        self.solid.checkpoint_into(&mut self.sound.checkpoint);
        self.sound.turned_over = self.turned_over;
        self.sound.largest_residual = self.largest_residual;
        self.sound.rows_open = self.rows_open;
    }

    /// Forces of the supports on the nodes at the time of the last ledger, N; zero on free
    /// components.
    fn reactions(&self) -> Vec<Vec3> {
        let (model, forces) = (&self.solid.model, self.solid.forces());
        let mut reactions = vec![[0.0; 3]; forces.len()];
        for held in &model.problem.prescribed {
            let (node, axis) = (held.node as usize, held.axis);
            let inertia = model.mass[node] * held.profile.acceleration(self.solid.time);
            reactions[node][axis] = inertia - forces[node][axis];
        }
        reactions
    }

    /// Rows recorded so far.
    pub fn rows(&self) -> usize {
        self.values.len() / self.columns.len()
    }

    /// A row of the table, in the order of the columns.
    pub fn row(&self, row: usize) -> &[f64] {
        let width = self.columns.len();
        &self.values[row * width..(row + 1) * width]
    }

    /// Time of a row as people write it, s: of rows on the grid by their number, so that the rounding
    /// of many steps does not show.
    pub fn row_time(&self, row: usize) -> f64 {
        let time = self.row(row)[0];
        let on_grid = row as f64 * self.grid.interval();
        let is_on_grid = (time - on_grid).abs() <= 1e-6 * self.grid.interval();
        to_digits(if is_on_grid { on_grid } else { time }, 12)
    }

    pub fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// All rows as a table.
    ///
    /// # Errors
    /// Names of probes and supports that are alike.
    pub fn series(&self) -> Result<Series, SeriesError> {
        Series::new(self.columns.clone(), self.data())
    }

    /// As [`SolidSession::series`], with the times of its rows as people write them.
    ///
    /// # Errors
    /// As there.
    pub fn readable_series(&self) -> Result<Series, SeriesError> {
        let mut data = self.data();
        for (row, time) in data.column_mut(0).iter_mut().enumerate() {
            *time = self.row_time(row);
        }
        Series::new(self.columns.clone(), data)
    }

    fn data(&self) -> Array2<f64> {
        let shape = (self.rows(), self.columns.len());
        Array2::from_shape_vec(shape, self.values.clone())
            .expect("every row gives one value per column")
    }

    /// What a later run goes on from: the present state; after a failure that of the last row, and
    /// of a run whose last row is off the grid that before this row.
    pub fn resumable(&self) -> Sound {
        if self.resume_from_sound {
            return self.sound.clone();
        }
        Sound {
            checkpoint: self.solid.checkpoint(),
            turned_over: self.turned_over,
            largest_residual: self.largest_residual,
            rows_open: self.rows_open,
        }
    }

    /// Rows at equal intervals: all but a last one that the end of the run has put off the grid.
    pub fn rows_on_grid(&self) -> usize {
        self.grid.rows_until(self.solid.steps).min(self.rows())
    }
}

/// Length of a vector.
pub fn length(v: &Vec3) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// Mean of vectors over nodes.
pub fn mean(of: &[Vec3], nodes: &[u32]) -> Vec3 {
    sum(of, nodes).map(|total| total / nodes.len() as f64)
}

/// Sum of vectors over nodes.
pub fn sum(of: &[Vec3], nodes: &[u32]) -> Vec3 {
    let mut total = [0.0; 3];
    for node in nodes {
        for i in 0..3 {
            total[i] += of[*node as usize][i];
        }
    }
    total
}

/// Columns of the probes and supports.
pub fn probe_columns(probes: &[NamedNodes], supports: &[Support]) -> Vec<Column> {
    let mut columns = Vec::new();
    for probe in probes {
        columns.extend(["x", "y", "z"].map(|a| Column::new(format!("{}_{a}", probe.name), "m")));
    }
    for support in supports {
        for axis in support.axes() {
            let name = format!("reaction_{}_{}", support.name, ["x", "y", "z"][axis]);
            columns.push(Column::new(name, "N"));
        }
    }
    columns
}

fn columns(probes: &[NamedNodes], supports: &[Support]) -> Vec<Column> {
    let mut columns = vec![Column::new("time", "s")];
    for name in ["energy_strain", "energy_kinetic", "work_external", "work_damping"] {
        columns.push(Column::new(name, "J"));
    }
    columns.push(Column::new("energy_residual", "J"));
    columns.push(Column::new("largest_displacement", "m"));
    columns.push(Column::new("largest_von_mises", "Pa"));
    columns.extend(probe_columns(probes, supports));
    columns
}
