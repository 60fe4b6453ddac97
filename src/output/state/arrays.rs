//! Long arrays of a state, in `state-N.npy` with one row per node.

use super::{StateError, entries::Refused, friction_entry};
use crate::output::atomic::write_atomic;
use crate::output::npy;
use crate::output::series::Series;
use crate::output::session::Checkpoint;
use crate::solids::checkpoint::SolidCheckpoint;
use ndarray::{Array2, Axis, Slice};
use std::ops::Range;
use std::path::Path;

/// Number of values per node of a solid.
const WIDTH: usize = 8;

/// Name of the array file of a state after `steps` steps.
pub(super) fn arrays_name(steps: u64) -> String {
    format!("state-{steps}.npy")
}

/// Name of the file with the values of bushings after `coupling_steps` coupling steps.
pub(super) fn bushings_name(coupling_steps: u64) -> String {
    format!("state-{coupling_steps}.bushings.npy")
}

/// Writes the arrays of a checkpoint after `steps` steps: the nodes of all solids in sequence, or of all condensed
/// bores. Returns the name of the file; `None` if there are no arrays.
pub(super) fn write_arrays(
    folder: &Path,
    checkpoint: &Checkpoint,
    steps: u64,
) -> Result<Option<String>, StateError> {
    let (width, values) = match checkpoint {
        Checkpoint::Bearing(_) => return Ok(None),
        Checkpoint::Solid(kept, _) => (WIDTH, of_nodes(kept)),
        Checkpoint::Housed(kept, _) => {
            if !kept.bushings.is_empty() {
                write_table(folder, &bushings_name(kept.exchanges), 1, kept.bushings.concat())?;
            }
            friction_entry::write(folder, kept)?;
            (WIDTH, kept.solids.iter().flat_map(|part| of_nodes(&part.solid)).collect())
        }
        Checkpoint::QuasiStaticSequence(kept) => {
            let mut touches = vec![0.0; kept.nodes.iter().sum()];
            let mut first = 0;
            for (nodes, touching) in kept.nodes.iter().zip(&kept.memory.touching) {
                touching.iter().for_each(|&node| touches[first + node] = 1.0);
                first += nodes;
            }
            (1, touches)
        }
        Checkpoint::Rubber(kept, _) => (1, kept.numbers()),
    };
    let name = arrays_name(steps);
    write_table(folder, &name, width, values)?;
    Ok(Some(name))
}

pub(super) fn write_table(
    folder: &Path,
    name: &str,
    width: usize,
    values: Vec<f64>,
) -> Result<(), StateError> {
    let path = folder.join(name);
    if !values.iter().all(|value| value.is_finite()) {
        return Err(StateError::Damaged { path, what: "a value that is not finite" });
    }
    let table = Array2::from_shape_vec((values.len() / width, width), values)
        .expect("as many numbers for each node");
    Ok(write_atomic(&path, &npy::file(&table))?)
}

fn of_nodes(checkpoint: &SolidCheckpoint) -> Vec<f64> {
    let mut values = Vec::with_capacity(WIDTH * checkpoint.rate.len());
    for (n, (u, v)) in checkpoint.displacement.iter().zip(&checkpoint.rate).enumerate() {
        values.extend([u[0], u[1], u[2], v[0], v[1], v[2]]);
        values.extend([checkpoint.external_work[n], checkpoint.damping_work[n]]);
    }
    values
}

pub(super) fn table(folder: &Path, file: &str, shape: (usize, usize)) -> Result<Series, Refused> {
    if file.contains(['/', '\\']) {
        return Err(Refused::Damaged("its arrays lie elsewhere"));
    }
    let arrays = Series::read_npy(&folder.join(file))?;
    if arrays.data().dim() != shape {
        return Err(Refused::Damaged("its arrays have another shape than the mesh asks for"));
    }
    arrays.check_finite()?;
    Ok(arrays)
}

/// Arrays of a solid from `file` in `folder`, which has `nodes` rows in total; those of this solid are `rows`.
/// Time, steps and work are zero.
pub(super) fn read_arrays(
    folder: &Path,
    file: &str,
    nodes: usize,
    rows: Range<usize>,
) -> Result<SolidCheckpoint, Refused> {
    let arrays = table(folder, file, (nodes, WIDTH))?;
    let own = arrays.data().slice_axis(Axis(0), Slice::from(rows));
    let part = |from: usize| {
        let row = |row: ndarray::ArrayView1<f64>| [row[from], row[from + 1], row[from + 2], 0.0];
        own.rows().into_iter().map(row).collect()
    };
    let column = |at: usize| own.column(at).to_vec();
    Ok(SolidCheckpoint {
        displacement: part(0),
        rate: part(3),
        external_work: column(6),
        damping_work: column(7),
        ..SolidCheckpoint::default()
    })
}

/// Contact nodes of each condensed bore; `nodes` holds the number of nodes of each bore.
pub(super) fn read_touching(
    folder: &Path,
    file: &str,
    nodes: &[usize],
) -> Result<Vec<Vec<usize>>, Refused> {
    let arrays = table(folder, file, (nodes.iter().sum(), 1))?;
    let mut first = 0;
    let of_bore = |&count: &usize| {
        let touches = |&node: &usize| arrays.data()[(first + node, 0)] != 0.0;
        let touching = (0..count).filter(touches).collect();
        first += count;
        touching
    };
    Ok(nodes.iter().map(of_bore).collect())
}

/// Removes arrays of states other than `kept` and the files that belong to it. Files that cannot be removed are left.
pub fn remove_arrays(folder: &Path, kept: &str) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    // "state-12." of "state-12.npy".
    let stem = kept.strip_suffix("npy").filter(|stem| !stem.is_empty());
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        if name.starts_with("state-")
            && name.ends_with(".npy")
            && !stem.is_some_and(|stem| name.starts_with(stem))
        {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}
