//! `bearing run` of a bearing in its housing by equilibria, one a row.
//!
//! It takes seconds, so that it keeps no state: an interrupted one is started again.

use super::{
    Prepared, along_course, condensed, inertia_estimate, plan, prepare, record, refuse_moving,
    run_settings, run_table, say_notes, search, title, write_bore,
};
use crate::commands::earlier::{Writes, claimed, refuse_half_way, remove_earlier};
use crate::commands::run::{Arguments, pictures};
use crate::commands::solid::say_remarks;
use crate::commands::{CommandResult, Outcome, results_folder, say};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::housed::course::{HousedCourse, bore_nodes};
use bearing_dynamics::output::housed::fields::write_housing_fields;
use bearing_dynamics::output::housed::summary::{
    PEAK_PRESSURE, course_summary, equilibrium_section, field_sections, inertia_section,
};
use bearing_dynamics::output::results::pretty;
use bearing_dynamics::output::solid::fields::{file_name, stresses, write_list};
use bearing_dynamics::output::solid::remarks;
use bearing_dynamics::scene::Document;
use bearing_dynamics::scene::housing::HousedScene;
use bearing_dynamics::scene::housing_problem::excitations;
use bearing_dynamics::scene::statics::static_problem;
use bearing_dynamics::solver::clock::rounded;
use bearing_dynamics::solver::housing::condensed::CondensedBore;
use bearing_dynamics::solver::housing::quasi_static::{CourseError, Moment};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::json;
use std::error::Error;
use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// An estimate, or why there is none.
fn kept<T>(found: Result<Option<T>, Box<dyn Error>>) -> (Option<T>, Option<String>) {
    match found {
        Ok(found) => (found, None),
        Err(error) => (None, Some(error.to_string())),
    }
}

/// How the course ended.
enum End {
    Complete,
    Interrupted,
    Failed(CourseError),
}

pub fn run(arguments: &Arguments, document: &Document, scene: &HousedScene) -> CommandResult {
    if arguments.resume {
        return Err("a quasi-static run takes seconds and keeps no state; start it anew without \
                    --resume"
            .into());
    }
    let settings = run_settings(&arguments.scene, scene)?;
    let folder = results_folder(&arguments.scene, &arguments.out);
    let folder = claimed(&folder, Writes::Run { fresh: arguments.fresh })?;
    if !arguments.fresh {
        refuse_half_way(&folder)?;
    }
    let prepared = prepare(document, scene)?;
    let Prepared { built, setup, mesh_seconds } = &prepared;
    refuse_moving(document, scene)?;
    let interrupted = Arc::new(AtomicBool::new(false));
    let flag = interrupted.clone();
    ctrlc::set_handler(move || flag.store(true, Ordering::Relaxed))?;

    let start = Instant::now();
    let bore = condensed(&prepared)?;
    let condense_seconds = start.elapsed().as_secs_f64();
    let problem = static_problem(&scene.bearing)?;
    let mut course = HousedCourse::new(
        scene,
        setup,
        problem,
        settings.end,
        settings.output_interval,
        &settings.channels,
    );
    say_notes(&prepared)?;
    say(&format!(
        "{} unknowns condensed onto {} bore nodes in {condense_seconds:.2} s\n{} equilibria to t = {} s, \
         a row every {:.4e} s\n",
        bore.sizes.unknowns,
        bore.sizes.kept,
        course.count,
        rounded((course.count - 1) as f64 * course.interval),
        course.interval
    ))?;
    remove_earlier(&folder)?;
    let start = Instant::now();
    let mut fields = Fields { folder: &folder, prepared: &prepared, bore: &bore, list: Vec::new() };
    let end = equilibria(scene, &mut course, &bore, &mut fields, &interrupted)?;
    let seconds = start.elapsed().as_secs_f64();
    let stopped_by = match &end {
        End::Complete => None,
        End::Interrupted => Some("interrupted".to_string()),
        End::Failed(error) => Some(error.to_string()),
    };
    let (mut sections, mut remarks) = (Vec::new(), Vec::new());
    if let Some(moment) = course.latest.clone() {
        fields.write(course.rows() - 1, &moment)?;
        let displacement = bore.displacement(&moment.state.bore.loads);
        let stress = stresses(&setup.model, &displacement);
        sections.push((
            "housing".to_string(),
            equilibrium_section(setup, &bore, &moment.state, &displacement)?,
        ));
        sections.extend(field_sections(built, &displacement, &stress)?);
        remarks = remarks::of_equilibrium(&setup.model, &displacement, &stress);
        sections.push(("housing_remarks".into(), json!(remarks)));
        write_bore(&folder, &bore_nodes(setup, &bore, &moment.state))?;
    }
    // A course that was found is kept, whatever becomes of the estimate.
    let (inertia, no_estimate) = kept(inertia_estimate(scene, setup, &bore));
    let (along, no_course) = kept(along_course(scene, setup, &bore));
    if let Some(estimate) = &inertia {
        let section = inertia_section(estimate, &excitations(scene), along.as_ref())?;
        sections.push(("inertia".into(), section));
    }
    let table = run_table(course.series()?, course.interval, settings.window_start);
    let written = pictures(&folder, &scene.bearing, &table)?;
    table.series.write_csv(&folder.join("series.csv"))?;
    table.series.write_npy(&folder.join("series.npy"))?;
    let seconds_of = vec![
        ("mesh".into(), *mesh_seconds),
        ("condense".into(), condense_seconds),
        ("solve".into(), seconds),
    ];
    let mut record = record(scene, plan::lines(scene, &prepared)?, seconds_of)?;
    record.sections = sections;
    let summary = course_summary(&course, settings.end, &table, stopped_by.as_deref(), &record)?;
    write_atomic(&folder.join("summary.json"), pretty(&summary).as_bytes())?;
    say(&figures(&course, seconds))?;
    say_remarks(&remarks)?;
    if let Some(estimate) = &inertia {
        say(&format!(
            "inertia left out       {}\n",
            plan::verdict(scene, estimate, along.as_ref())
        ))?;
    }
    for why in no_estimate.iter().chain(&no_course) {
        say(&format!("inertia left out       no estimate: {why}\n"))?;
    }
    say(&format!(
        "wrote series, fields, bore, summary and {} plots of {} to {}\n",
        written.len(),
        title(scene),
        folder.display()
    ))?;
    match end {
        End::Complete => Ok(Outcome::Done),
        End::Interrupted => Err(format!(
            "interrupted after {} of {} equilibria; those are in {}, and it keeps no state: run it \
             again",
            course.rows(),
            course.count,
            folder.display()
        )
        .into()),
        End::Failed(error) => {
            Err(format!("{error}; the rows so far are in {}", folder.display()).into())
        }
    }
}

/// Files of fields of a course.
struct Fields<'f> {
    folder: &'f Path,
    prepared: &'f Prepared,
    bore: &'f CondensedBore,
    /// Row, time and name of each.
    list: Vec<(usize, f64, String)>,
}

impl Fields<'_> {
    fn write(&mut self, row: usize, moment: &Moment) -> Result<(), Box<dyn Error>> {
        if self.list.last().is_some_and(|(last, ..)| *last == row) {
            return Ok(());
        }
        let Prepared { built, setup, .. } = self.prepared;
        let displacement = self.bore.displacement(&moment.state.bore.loads);
        let stress = stresses(&setup.model, &displacement);
        let nodes = bore_nodes(setup, self.bore, &moment.state);
        let name = file_name("fields", self.list.len());
        let path = self.folder.join(&name);
        write_housing_fields(&path, &built.mesh, &displacement, None, &stress, &nodes)?;
        self.list.push((row, moment.time, name));
        let all: Vec<(f64, String)> =
            self.list.iter().map(|(_, time, name)| (*time, name.clone())).collect();
        write_list(self.folder, &all)?;
        Ok(())
    }
}

/// Rows until the end, a signal or an error.
fn equilibria(
    scene: &HousedScene,
    course: &mut HousedCourse,
    bore: &CondensedBore,
    fields: &mut Fields,
    interrupted: &AtomicBool,
) -> Result<End, Box<dyn Error>> {
    let every = scene
        .housing
        .fields_interval
        .map(|interval| (interval / course.interval).round().max(1.0) as usize);
    let mut search = search(scene, bore);
    // Hidden by itself when standard error is not a terminal.
    let bar = ProgressBar::new(course.count as u64);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {msg}, {eta} left") {
        bar.set_style(style);
    }
    let end = loop {
        if course.rows() >= course.count {
            break End::Complete;
        }
        if interrupted.load(Ordering::Relaxed) {
            break End::Interrupted;
        }
        if let Err(error) = course.next(&mut search) {
            break End::Failed(error);
        }
        let row = course.rows() - 1;
        if let (Some(every), Some(moment)) = (every, &course.latest)
            && row.is_multiple_of(every)
        {
            fields.write(row, &moment.clone())?;
        }
        if !bar.is_hidden() {
            bar.set_position(course.rows() as u64);
            bar.set_message(format!("equilibrium {} of {}", course.rows(), course.count));
        }
    };
    bar.finish_and_clear();
    Ok(end)
}

/// The few numbers that the run ends with.
fn figures(course: &HousedCourse, seconds: f64) -> String {
    let mut text = String::new();
    let Ok(series) = course.series() else { return text };
    let mut line = |label: &str, value: String| {
        let _ = writeln!(text, "{label:<22} {value}");
    };
    for race in ["inner", "outer"] {
        let (Some(y), Some(z)) =
            (series.column(&format!("{race}_y")), series.column(&format!("{race}_z")))
        else {
            continue;
        };
        let most = y.iter().zip(z).map(|(y, z)| libm::hypot(*y, *z)).fold(0.0, f64::max);
        line(&format!("{race} race, farthest"), format!("{:.6} um across the axis", 1e6 * most));
    }
    let largest = |name: &str| {
        series.column(name).map_or(0.0, |values| values.iter().copied().fold(0.0, f64::max))
    };
    line(
        "bore",
        format!(
            "penetration up to {:.6} um, up to {} nodes touching, pressure up to {:.4} MPa, {PEAK_PRESSURE}",
            1e6 * largest("bore_deepest_penetration"),
            largest("bore_nodes_touching"),
            1e-6 * largest("bore_peak_pressure")
        ),
    );
    line(
        "equilibria",
        format!(
            "{} in {seconds:.2} s, {} rounds, {} changes of contact, unbalanced part of the load up to \
             {:.1e}",
            course.rows(),
            course.rounds,
            course.contact_changes,
            course.largest_residual
        ),
    );
    text
}
