//! Parts of a sweep for machines that share nothing but a folder: each has every `count`-th block of points, and a
//! folder of its own in that of the sweep.

use super::grid::Grid;
use bearing_dynamics::output::json;
use serde_json::Value;
use std::collections::BTreeMap;
use std::error::Error;
use std::ops::Range;
use std::path::{Path, PathBuf};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 0.
    index: usize,
    count: usize,
}

impl Shard {
    /// The whole sweep.
    pub const WHOLE: Shard = Shard { index: 0, count: 1 };

    /// `i/n` as given, or the task of a Slurm array; the whole without either.
    ///
    /// # Errors
    /// A text that is no shard.
    pub fn of(given: Option<&str>) -> Result<Shard, Box<dyn Error>> {
        let number = |name: &str| std::env::var(name).ok()?.parse::<usize>().ok();
        if let Some(given) = given {
            let parts = given.split_once('/').map(|(i, n)| (i.trim().parse(), n.trim().parse()));
            return match parts {
                Some((Ok(index), Ok(count))) if index < count => Ok(Shard { index, count }),
                _ => Err(format!(
                    "--shard {given}: not a shard. Allowed: i/n with i from 0 to n - 1. Hint: write for instance 0/7"
                )
                .into()),
            };
        }
        let [id, count, least, most] =
            ["ID", "COUNT", "MIN", "MAX"].map(|of| number(&format!("SLURM_ARRAY_TASK_{of}")));
        let (Some(id), Some(count), Some(least), Some(most)) = (id, count, least, most) else {
            return Ok(Shard::WHOLE);
        };
        // A part of an array that is submitted again does not know the number of shards.
        let all = least <= 1 && most + 1 == least + count && count > 1;
        if !all {
            return Err(format!(
                "tasks {least} to {most} of a Slurm array of {count} are not the shards from the first to the last. Hint: give \
                 --shard i/n"
            )
            .into());
        }
        Ok(Shard { index: id - least, count })
    }

    pub fn is_whole(self) -> bool {
        self.count == 1
    }

    /// Blocks of `size` points that are this shard's.
    pub fn blocks(self, grid: &Grid, size: usize) -> impl Iterator<Item = Range<usize>> {
        grid.blocks(size).skip(self.index).step_by(self.count)
    }

    /// Number of points of this shard.
    pub fn len(self, grid: &Grid, size: usize) -> usize {
        self.blocks(grid, size).map(|block| block.len()).sum()
    }

    /// Folder of this shard in that of the sweep.
    pub fn folder(self, sweep: &Path) -> PathBuf {
        match self.is_whole() {
            true => sweep.to_path_buf(),
            false => sweep.join(format!("shard-{}-of-{}", self.index, self.count)),
        }
    }
}

/// Folders of all shards of a sweep, in their order.
///
/// # Errors
/// No shard, one that is missing or unfinished, shards of two divisions, one of another scene, grid or version.
pub fn all_of(sweep: &Path, of: &str, hash: &str) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut found: BTreeMap<(usize, usize), PathBuf> = BTreeMap::new();
    let entries = std::fs::read_dir(sweep)
        .map_err(|error| format!("cannot read {}: {error}", sweep.display()))?;
    for entry in entries {
        let path = entry?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let parts = name.strip_prefix("shard-").and_then(|rest| rest.split_once("-of-"));
        if let Some((Ok(index), Ok(count))) = parts.map(|(i, n)| (i.parse(), n.parse())) {
            found.insert((count, index), path);
        }
    }
    let Some((&(count, _), _)) = found.first_key_value() else {
        return Err(format!("{}: no shards; run them with --shard i/n", sweep.display()).into());
    };
    let many = found.last_key_value().is_some_and(|(&(other, _), _)| other != count);
    if many {
        let text = "shards of two divisions; remove those of one";
        return Err(format!("{}: {text}", sweep.display()).into());
    }
    let mut folders = Vec::with_capacity(count);
    for index in 0..count {
        let missing = || format!("{}: shard {index} of {count} is missing", sweep.display());
        let folder = found.remove(&(count, index)).ok_or_else(missing)?;
        let record = json::read(&folder.join("sweep.json"))?;
        if record["hash"] != hash || record["of"] != of {
            let text = "belongs to another scene, other values or another version";
            return Err(format!("{}: {text}", folder.display()).into());
        }
        if record["complete"] != true {
            return Err(
                format!("{}: unfinished; the same command resumes it", folder.display()).into()
            );
        }
        folders.push(folder);
    }
    Ok(folders)
}

/// Points without a solution of a shard, with their messages.
pub fn failures(folder: &Path) -> Result<BTreeMap<usize, String>, Box<dyn Error>> {
    let record = json::read(&folder.join("sweep.json"))?;
    let entry =
        |of: &Value| Some((of["point"].as_u64()? as usize, of["message"].as_str()?.to_string()));
    Ok(record["failures"].as_array().into_iter().flatten().filter_map(entry).collect())
}

/// Checks that the points of all shards are those of the grid, each once.
pub fn check_points(points: &[usize], grid: &Grid) -> Result<(), Box<dyn Error>> {
    let mut sorted = points.to_vec();
    sorted.sort_unstable();
    if let Some(pair) = sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(format!("point {} is in two shards", pair[0]).into());
    }
    match (0..grid.len()).find(|point| sorted.binary_search(point).is_err()) {
        None if sorted.len() == grid.len() => Ok(()),
        None => Err("a shard has a point that the grid does not have".into()),
        Some(point) => Err(format!("point {point} is in no shard").into()),
    }
}
