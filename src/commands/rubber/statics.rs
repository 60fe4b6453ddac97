//! `bearing statics` of a solid of rubber: relaxed equilibrium and response to small vibrations.

use super::{Prepared, plan, prepare, refuse_free};
use crate::commands::asked::Asked;
use crate::commands::earlier::Writes;
use crate::commands::memory::refuse_beyond;
use crate::commands::solid::statics::{WRITTEN, table, write};
use crate::commands::solid::{print_mesh_notes, record};
use crate::commands::{CommandResult, Outcome, interruption, placed, print};
use bearing_dynamics::numeric::clock::display_time;
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::rubber_stresses;
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::summary::rubber::{
    self as summary, harmonic_section, harmonic_series,
};
use bearing_dynamics::output::warnings::{lines, solid::of_rubber};
use bearing_dynamics::plan::counts::Counts;
use bearing_dynamics::scene::build::rubber::vibrating;
use bearing_dynamics::scene::resolve::solid_scene::{Harmonic, RubberScene};
use bearing_dynamics::scene::{Document, SolidScene};
use bearing_dynamics::solids::memory;
use bearing_dynamics::solids::rubber::relaxed::{RelaxedError, relaxed_while};
use bearing_dynamics::solids::rubber::vibration::{Answer, vibrations};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

pub const HARMONIC: &str = "harmonic.csv";
/// Table of the equilibria before a failed one.
const CURVE: &str = "curve.csv";

pub fn run(asked: &Asked, scene: &SolidScene, rubber: &RubberScene) -> CommandResult {
    let Asked { path, document, .. } = asked;
    let folder = asked.folder(Writes::Statics)?;
    let prepared = prepare(document, scene, rubber)?;
    let Prepared { built, setup, free, mesh_seconds } = &prepared;
    refuse_free(path, free)?;
    let time = scene.run.as_ref().map_or(0.0, |run| run.end);
    let start = Instant::now();
    let model = &setup.model;
    refuse_beyond(&memory::rubber(model), "")?;
    let watch = Watch::new()?;
    let found = relaxed_while(model, time, |part| watch.record(part));
    watch.bar.finish_and_clear();
    let found = found.map_err(|error| keep_curve(&prepared, folder.as_deref(), error))?;
    let mut seconds =
        vec![("mesh".into(), *mesh_seconds), ("solve".into(), start.elapsed().as_secs_f64())];
    let start = Instant::now();
    let mut ran = found.ran;
    let responses = match &rubber.harmonic {
        Some(asked) => Some((asked, responses(document, &prepared, asked, &mut ran)?)),
        None => None,
    };
    if responses.is_some() {
        seconds.push(("vibrations".into(), start.elapsed().as_secs_f64()));
    }
    let stress = rubber_stresses(model, &found.state)?;
    let mut record = record(document, scene, plan::items(scene, rubber, &prepared, None), seconds);
    record.ran.solids = vec![ran];
    let section = match &responses {
        Some((asked, responses)) => Some(harmonic_section(&asked.set, axis(asked), responses)?),
        None => None,
    };
    let (mut summary, series) =
        summary::rubber_statics(setup, built, (time, &found), &stress, section, &record)?;
    let warnings = of_rubber(model, &found.state.displacement)?;
    summary["warnings"] = json!(warnings);
    print_mesh_notes(built)?;
    print(&format!("relaxed, under loads and displacements of t = {} s\n", display_time(time)))?;
    print(&table(&summary))?;
    if let Some((asked, responses)) = &responses {
        print(&harmonic_table(asked, responses))?;
    }
    print(&lines(&warnings))?;
    let Some(folder) = folder else { return Ok(Outcome::Done) };
    write(&folder, &built.mesh, &found.state.displacement, &stress, &series)?;
    let mut files = WRITTEN + 1;
    if let Some((_, responses)) = &responses {
        harmonic_series(responses)?.write_csv(&folder.join(HARMONIC))?;
        files += 1;
    }
    write_atomic(&folder.join("summary.json"), pretty(&summary).as_bytes())?;
    print(&format!("wrote {files} files to {}\n", folder.display()))?;
    Ok(Outcome::Done)
}

/// Progress bar of loads and displacements, and the interrupt flag.
struct Watch {
    bar: ProgressBar,
    interrupted: Arc<AtomicBool>,
}

impl Watch {
    /// # Errors
    /// If the signal handler cannot be installed.
    fn new() -> Result<Watch, Box<dyn Error>> {
        // Hidden by itself when standard error is not a terminal.
        let bar = ProgressBar::new(1000);
        let style = "{elapsed} {bar:30} {percent} % of loads and displacements, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style);
        }
        // A second interrupt ends the process at once.
        Ok(Watch { bar, interrupted: interruption(|| std::process::exit(2))? })
    }

    fn record(&self, part: f64) -> bool {
        self.bar.set_position((1000.0 * part) as u64);
        // After the last part there is nothing to interrupt.
        part >= 1.0 || !self.interrupted.load(Ordering::Relaxed)
    }
}

/// Writes the equilibria before a failed one, and adds advice to its error.
fn keep_curve(prepared: &Prepared, folder: Option<&Path>, error: RelaxedError) -> Box<dyn Error> {
    const LOST: &str = "; reduce loads and displacements, refine the mesh where it is bonded, or use `bearing run`: \
                        with Maxwell elements it can follow slow folding further";
    let (reached, advice) = match &error {
        RelaxedError::Lost { reached, .. } => (reached, LOST),
        RelaxedError::Stopped { reached, .. } => (reached, ""),
        RelaxedError::Rubber(_) => return error.into(),
    };
    let (count, text) = (reached.len(), error.to_string());
    let Some(folder) = folder.filter(|_| count > 0) else {
        return format!("{text}{advice}").into();
    };
    // Results of an earlier command are kept.
    let earlier = match folder.join("summary.json").exists() {
        true => ", next to the earlier results",
        false => "",
    };
    let curve = summary::reached_series(&prepared.setup, reached);
    let written = curve
        .map_err(Box::<dyn Error>::from)
        .and_then(|curve| Ok(curve.write_csv(&folder.join(CURVE))?));
    match written {
        Ok(()) => {
            format!("{text}; {count} equilibria up to there are in {CURVE}{earlier}{advice}").into()
        }
        Err(also) => format!("{text}; {CURVE} could not be written: {also}{advice}").into(),
    }
}

fn responses(
    document: &Document,
    prepared: &Prepared,
    asked: &Harmonic,
    ran: &mut Counts,
) -> Result<Vec<Answer>, Box<dyn std::error::Error>> {
    let model = vibrating(&prepared.setup, asked)
        .map_err(|error| placed(document, error.about(), error))?;
    Ok(vibrations(&model, &asked.frequencies, ran)?)
}

fn axis(asked: &Harmonic) -> &'static str {
    ["x", "y", "z"][asked.axis]
}

fn harmonic_table(asked: &Harmonic, responses: &[Answer]) -> String {
    let mut text =
        format!("small vibrations of \"{}\" along {}, about rest\n", asked.set, axis(asked));
    let _ = writeln!(
        text,
        "{:>14}{:>16}{:>16}{:>16}{:>12}",
        "frequency, Hz", "K', N/m", "K'', N/m", "K_d, N/m", "eta_d"
    );
    for response in responses {
        let (stiffness, of) = (&response.stiffness, &response.hysteresis);
        let _ = writeln!(
            text,
            "{:>14}{:>16.1}{:>16.1}{:>16.1}{:>12.5}",
            display_time(response.frequency),
            stiffness.storage,
            stiffness.loss,
            of.dynamic_stiffness,
            of.damping_ratio
        );
    }
    text
}
