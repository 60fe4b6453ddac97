//! Equilibria and short runs of many rigid ball bearings at once.
#![forbid(unsafe_code)]
// Rows and columns of small matrices are indices, as in the formulas.
#![allow(clippy::needless_range_loop)]

mod batch;
mod conform;
mod first_search;
mod lanes;
mod motion;
mod scene;
mod statics;

use scene::{Outcome, Stop};
use serde_json::Value;
use std::path::Path;
use std::process::ExitCode;

const USAGE: &str = "usage: fast batch BATCH.json OUT.csv | fast statics|run RESOLVED.json OUT";

fn load(path: &str) -> Outcome<Value> {
    if path.ends_with(".toml") {
        return Err(Stop::Unclaimed("a scene in TOML".into()));
    }
    let text = std::fs::read_to_string(path).map_err(|error| Stop::Error(format!("{path}: {error}")))?;
    serde_json::from_str(&text).map_err(|error| Stop::Error(format!("{path}: {error}")))
}

fn save(path: &Path, text: &[u8]) -> Outcome<()> {
    std::fs::write(path, text).map_err(|error| Stop::Error(format!("{}: {error}", path.display())))
}

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let result = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["batch", input, out] => load(input).and_then(|input| save(Path::new(out), &batch::solve(&input)?)),
        [kind, resolved, out] => load(resolved).and_then(|resolved| {
            let (summary, series) = conform::solve(&scene::read(&resolved, kind)?)?;
            let out = Path::new(out);
            std::fs::create_dir_all(out).map_err(|error| Stop::Error(format!("{}: {error}", out.display())))?;
            save(&out.join("series.csv"), &series)?;
            save(&out.join("summary.json"), format!("{summary:#}").as_bytes())
        }),
        _ => Err(Stop::Error(USAGE.into())),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Stop::Unclaimed(feature)) => {
            eprintln!("{feature} is not claimed");
            ExitCode::from(3)
        }
        Err(Stop::Error(message)) => {
            eprintln!("{message}");
            ExitCode::FAILURE
        }
    }
}
