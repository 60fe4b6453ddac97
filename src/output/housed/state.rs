//! The state of bearing and housing in explicit steps: `state.json`, with the housing's nodes in
//! `state-N.npy` beside it (N the number of windows) and the rows so far in `series.npy`.

use crate::output::atomic::{WriteError, remove_partials};
use crate::output::housed::session::{HousedRunError, HousedSession, RowGrid, Watch};
use crate::output::journal::{self, JournalError, SERIES, STATE, Stopped};
use crate::output::series::{Series, SeriesError};
use crate::output::solid::fields::FOLDER;
use crate::output::solid::state::{
    LimitEntry, SolidStateError, read_arrays, remove_arrays, write_arrays,
};
use crate::output::state::{self as bearing_state, StateError, StateFile, StateRecord};
use crate::solver::channels::ChannelGroup;
use crate::solver::dynamics::model::DynamicProblem;
use crate::solver::housing::checkpoint::{HousedCheckpoint, Windows};
use crate::solver::housing::exchange::{
    ExchangeError, ExchangeOptions, Growth, HousedBearing, Seat,
};
use crate::solver::solid::checkpoint::SolidCheckpoint;
use crate::solver::solid::explicit::SolidWork;
use crate::solver::solid::model::SolidModel;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Content of `state.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HousedStateFile {
    /// As that of a bearing alone; its rows are those of both.
    pub bearing: StateFile,
    pub housing: HousingEntry,
}

/// The housing and what the two exchange.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HousingEntry {
    /// File with one row a node: displacement (m), rate (m/s), work of loads and of damping (J).
    pub arrays: String,
    /// s.
    pub time: f64,
    pub steps: u64,
    pub window: f64,
    pub steps_per_window: usize,
    pub windows_per_row: u64,
    pub rows_per_fields: u64,
    pub limit: LimitEntry,
    pub exchanges: u64,
    /// N·s.
    pub impulse: [f64; 3],
    /// Work (J), radius (m) and load (N) of an interference that grows in.
    pub growth: [f64; 3],
    pub tested: u64,
    pub sorts: u64,
    /// J.
    pub first: [f64; 2],
    pub turned_over: f64,
    pub largest_residual: f64,
    pub rows_open: u32,
    /// Force evaluations and elements in them.
    pub work: [u64; 2],
}

#[derive(Debug, Error)]
pub enum HousedStateError {
    #[error(
        "{} belongs to another scene or mesh: only end and plots may change from one part of a run \
         to the next, and a fit_ramp that is not written is a tenth of the end; write it, choose another \
         --out, or start anew (--fresh)",
        path.display()
    )]
    Scene { path: PathBuf },
    #[error(transparent)]
    Bearing(#[from] StateError),
    #[error(transparent)]
    Housing(#[from] SolidStateError),
    #[error(transparent)]
    Journal(#[from] JournalError),
    #[error(transparent)]
    Series(#[from] SeriesError),
    #[error(transparent)]
    Exchange(#[from] ExchangeError),
    #[error(transparent)]
    Run(#[from] HousedRunError),
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// What a run is made of.
#[derive(Clone, Debug)]
pub struct HousedParts {
    pub problem: DynamicProblem,
    pub model: SolidModel,
    pub seat: Seat,
    pub options: ExchangeOptions,
}

/// What a run is asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct HousedRequest {
    /// s.
    pub end: f64,
    pub output_interval: f64,
    /// `None`: at the end only.
    pub fields_interval: Option<f64>,
    pub channels: Vec<ChannelGroup>,
    pub energy_limit: f64,
}

impl HousedRequest {
    /// Rows and files for windows of a given number a row.
    pub fn grid(&self, interval: f64, windows_per_row: u64) -> RowGrid {
        let rows = (self.end / interval).round().max(1.0) as u64;
        let fields = self.fields_interval.map(|fields| (fields / interval).round().max(1.0) as u64);
        RowGrid { windows_per_row, rows, rows_per_fields: fields.unwrap_or(u64::MAX) }
    }
}

/// Sha256 of what decides every bit of a run but its length.
pub fn fingerprint(parts: &HousedParts, request: &HousedRequest) -> String {
    let mut hash = Sha256::new();
    let solid = &parts.model.problem;
    for value in solid.nodes.iter().flatten() {
        hash.update(value.to_bits().to_le_bytes());
    }
    for node in solid.elements.all_nodes() {
        hash.update(node.to_le_bytes());
    }
    // Debug text has every field, and the shortest decimals that tell two numbers apart.
    let laws = (solid.material, solid.density, solid.damping, solid.damped_motion, solid.gravity);
    let loads = (&solid.prescribed, &solid.loads);
    let groups: Vec<&str> = ChannelGroup::ALL
        .into_iter()
        .filter(|group| request.channels.contains(group))
        .map(|group| group.name())
        .collect();
    hash.update(format!("{} {laws:?} {loads:?}", env!("CARGO_PKG_VERSION")));
    let HousedParts { problem, seat, options, .. } = parts;
    hash.update(format!("{problem:?} {seat:?} {options:?} {groups:?} {:?}", request.energy_limit));
    journal::hexadecimal(hash)
}

/// Writes `series.npy`, the arrays and `state.json` of a session into its results folder.
///
/// # Errors
/// A number that is not finite (the state there stays), a file that cannot be written.
pub fn save(
    folder: &Path,
    session: &HousedSession,
    end: f64,
    record: &StateRecord,
) -> Result<(), HousedStateError> {
    let (checkpoint, watch) = session.kept();
    let span = (end, session.grid.windows_per_row);
    let rows = session.kept_rows();
    let bearing = bearing_state::state_file(&checkpoint.bearing, rows, span, record);
    bearing_state::check_finite(&bearing)?;
    let windows = session.housed.windows();
    let arrays = format!("state-{}.npy", checkpoint.exchanges);
    let housing = HousingEntry {
        arrays: arrays.clone(),
        time: checkpoint.solid.time,
        steps: checkpoint.solid.steps,
        window: windows.window,
        steps_per_window: windows.solid_steps,
        windows_per_row: session.grid.windows_per_row,
        rows_per_fields: session.grid.rows_per_fields,
        limit: LimitEntry::of(&windows.limit),
        exchanges: checkpoint.exchanges,
        impulse: checkpoint.impulse,
        growth: [checkpoint.growth.work, checkpoint.growth.radius, checkpoint.growth.load],
        tested: checkpoint.tested,
        sorts: checkpoint.sorts,
        first: checkpoint.first,
        turned_over: watch.turned_over,
        largest_residual: watch.largest_residual,
        rows_open: watch.rows_open,
        work: [checkpoint.solid.work.evaluations, checkpoint.solid.work.elements],
    };
    let sums =
        [watch.turned_over, watch.largest_residual, checkpoint.first[0], checkpoint.first[1]];
    if !sums.iter().chain(&checkpoint.impulse).chain(&housing.growth).all(|value| value.is_finite())
    {
        let path = folder.join(STATE);
        return Err(SolidStateError::Damaged { path, what: "a value that is not finite" }.into());
    }
    session.series()?.write_npy(&folder.join(SERIES))?;
    write_arrays(&folder.join(&arrays), &checkpoint.solid)?;
    journal::write(folder, &HousedStateFile { bearing, housing })?;
    remove_partials(&folder.join(FOLDER));
    remove_arrays(folder, &arrays);
    Ok(())
}

/// Reads `state.json` of a results folder; `None` if there is none.
///
/// # Errors
/// A file that cannot be read or is no state of a bearing in a housing.
pub fn read(folder: &Path) -> Result<Option<HousedStateFile>, HousedStateError> {
    Ok(journal::read(folder)?)
}

/// The session that goes on where `file`, read from `folder`, was written.
///
/// # Errors
/// A state of another version or scene, one that is damaged or lacks its rows, an end that has
/// already passed.
pub fn resume(
    folder: &Path,
    file: &HousedStateFile,
    parts: HousedParts,
    request: &HousedRequest,
) -> Result<HousedSession, HousedStateError> {
    let path = folder.join(STATE);
    let (bearing, housing) = (&file.bearing, &file.housing);
    journal::check_version(folder, &bearing.version)?;
    if bearing.fingerprint != fingerprint(&parts, request) {
        return Err(HousedStateError::Scene { path });
    }
    let damaged =
        |what| -> HousedStateError { SolidStateError::Damaged { path: path.clone(), what }.into() };
    let steps = housing.window > 0.0 && housing.steps_per_window > 0 && housing.windows_per_row > 0;
    if !steps || housing.rows_per_fields == 0 || bearing.step_size <= 0.0 {
        return Err(damaged("no step from one row to the next"));
    }
    let interval = housing.window * housing.windows_per_row as f64;
    let follows = |interval: f64, end: f64| interval == end / 1000.0;
    let same = bearing.output_interval == request.output_interval
        || (follows(bearing.output_interval, bearing.end)
            && follows(request.output_interval, request.end));
    if !same {
        let (kept, asked) = (bearing.output_interval, request.output_interval);
        return Err(SolidStateError::Interval { path, what: "rows", kept, asked }.into());
    }
    let grid = request.grid(interval, housing.windows_per_row);
    if grid.rows_per_fields != housing.rows_per_fields {
        let seconds = |rows: u64| rows as f64 * interval;
        let (kept, asked) = (seconds(housing.rows_per_fields), seconds(grid.rows_per_fields));
        return Err(SolidStateError::Interval { path, what: "fields", kept, asked }.into());
    }
    if grid.rows * grid.windows_per_row < housing.exchanges {
        return Err(SolidStateError::Past { time: bearing.time, end: request.end }.into());
    }
    bearing_state::check_finite(bearing)?;
    let of_bearing = bearing_state::checkpoint(bearing);
    if !of_bearing.fits(&parts.problem.assembly()) {
        return Err(damaged("its lists have other lengths than the bearing asks for"));
    }
    let arrays = read_arrays(folder, &housing.arrays, parts.model.problem.nodes.len())?;
    let checkpoint = HousedCheckpoint {
        bearing: of_bearing,
        solid: SolidCheckpoint {
            time: housing.time,
            steps: housing.steps,
            work: SolidWork { evaluations: housing.work[0], elements: housing.work[1] },
            ..arrays
        },
        exchanges: housing.exchanges,
        impulse: housing.impulse,
        growth: Growth {
            work: housing.growth[0],
            radius: housing.growth[1],
            load: housing.growth[2],
        },
        tested: housing.tested,
        sorts: housing.sorts,
        first: housing.first,
    };
    let windows = Windows {
        window: housing.window,
        solid_steps: housing.steps_per_window,
        limit: housing.limit.to_limit(),
    };
    let HousedParts { problem, model, seat, options } = parts;
    let housed =
        HousedBearing::from_checkpoint(problem, model, seat, &options, &windows, &checkpoint)?;
    let watch = Watch {
        turned_over: housing.turned_over,
        largest_residual: housing.largest_residual,
        rows_open: housing.rows_open,
    };
    let series = Series::read_npy(&folder.join(SERIES))?;
    let (channels, limit) = (&request.channels, request.energy_limit);
    HousedSession::resume(housed, grid, channels, limit, watch, &series)?
        .ok_or_else(|| damaged("the rows beside it are not those of this run"))
}

/// Whether a run stands still half way.
pub fn is_unfinished(file: &HousedStateFile) -> bool {
    matches!(file.bearing.stopped, Stopped::Interrupted | Stopped::Running)
}
