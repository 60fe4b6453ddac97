//! Plots of a static solution: load zone, ball force over azimuth, moment over tilt.

use bearing_dynamics::equilibrium::error::StaticsError;
use bearing_dynamics::equilibrium::statics::{
    StaticOptions, StaticProblem, StaticSolution, solve_from,
};
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::plots::{
    Axis, Curve, LoadZone, PolarPlot, Style, XyPlot, load_zone, polar, xy,
};
use bearing_dynamics::output::warnings::{Warning, WarningCode};
use bearing_dynamics::scene::{Plot, Scene};
use nalgebra::SVector;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Positions of the ball set over one ball pitch for the polar plot: 16 give a smooth curve.
const PHASES: usize = 16;
/// Number of tilts on the moment curve, and its largest tilt if the scene gives none (twice that of 3.4.5).
const TILTS: usize = 25;
const LARGEST_TILT_DEGREES: f64 = 0.3;

/// File names of the plots, in the order of [`Plot`].
pub const NAMES: [&str; 3] = ["load_zone.svg", "polar.svg", "moment_tilt.svg"];

/// Writes the requested plots; returns their paths, and a warning for each whose curve could not be computed.
///
/// # Errors
/// A file that cannot be written.
pub fn write(
    folder: &Path,
    scene: &Scene,
    problem: &StaticProblem,
    solution: &StaticSolution,
) -> Result<(Vec<PathBuf>, Vec<Warning>), Box<dyn Error>> {
    let title = scene.title.clone().unwrap_or_else(|| "Bearing".into());
    let (mut written, mut warnings) = (Vec::new(), Vec::new());
    for plot in &scene.plots {
        let (name, svg) = match plot {
            Plot::LoadZone => {
                let zone = LoadZone::new(title.clone(), &problem.geometry, &solution.balls);
                (NAMES[0], load_zone(&zone).map_err(Into::into))
            }
            Plot::Polar => (NAMES[1], force_over_azimuth(&title, problem, solution)),
            Plot::MomentTilt => (NAMES[2], moment_over_tilt(&title, problem)),
        };
        match svg {
            Ok(svg) => {
                let path = folder.join(name);
                write_atomic(&path, svg.as_bytes())?;
                written.push(path);
            }
            Err(error) => warnings.push(Warning::new(
                WarningCode::PictureNotDrawn,
                format!("{name} was not drawn: {error}"),
            )),
        }
    }
    Ok((written, warnings))
}

/// Equilibrium next to another one; if the search from there fails, from the start of the scene's own search.
fn solve_next(
    problem: &StaticProblem,
    start: &SVector<f64, 5>,
) -> Result<StaticSolution, StaticsError> {
    let options = StaticOptions::default();
    solve_from(problem, Some(start), &options).or_else(|_| solve_from(problem, None, &options))
}

/// Normal load between ball and race over the azimuth of the ball.
fn force_over_azimuth(
    title: &str,
    problem: &StaticProblem,
    solution: &StaticSolution,
) -> Result<String, Box<dyn Error>> {
    let pitch = std::f64::consts::TAU / problem.geometry.ball_count as f64;
    let mut turned = problem.clone();
    let mut start = solution.coordinates;
    let mut curves = [Vec::new(), Vec::new()];
    for step in 0..PHASES {
        turned.ball_phase = problem.ball_phase + pitch * step as f64 / PHASES as f64;
        let here = solve_next(&turned, &start)?;
        start = here.coordinates;
        for ball in &here.balls {
            curves[0].push([ball.azimuth, ball.outer.normal_load]);
            curves[1].push([ball.azimuth, ball.inner.normal_load]);
        }
    }
    let [outer, inner] = curves;
    let mut shown = vec![Curve::new("ball on outer race", outer)];
    // Without forces on the balls both curves coincide.
    let differ = solution
        .balls
        .iter()
        .any(|b| (b.inner.normal_load - b.outer.normal_load).abs() > 1e-3 * b.outer.normal_load);
    if differ {
        shown.push(Curve::new("ball on inner race", inner));
    }
    Ok(polar(&PolarPlot {
        title: format!("{title}: normal load over ball azimuth"),
        quantity: "normal load".into(),
        unit: "N".into(),
        curves: shown,
    })?)
}

/// Reaction moment against a prescribed tilt about Y; the other conditions are the scene's.
fn moment_over_tilt(title: &str, problem: &StaticProblem) -> Result<String, Box<dyn Error>> {
    let largest = match problem.conditions[3] {
        Condition::Displacement(tilt) if tilt != 0.0 => tilt.abs(),
        _ => LARGEST_TILT_DEGREES.to_radians(),
    };
    let mut tilted = problem.clone();
    let mut start: Option<SVector<f64, 5>> = None;
    let mut points = Vec::with_capacity(TILTS);
    for step in 0..TILTS {
        let tilt = largest * step as f64 / (TILTS - 1) as f64;
        tilted.conditions[3] = Condition::Displacement(tilt);
        let here = match &start {
            Some(start) => solve_next(&tilted, start)?,
            None => solve_from(&tilted, None, &StaticOptions::default())?,
        };
        start = Some(here.coordinates);
        points.push([tilt.to_degrees(), here.loads[3]]);
    }
    Ok(xy(&XyPlot {
        title: format!("{title}: moment over tilt"),
        x: Axis::linear("tilt about Y", "deg"),
        y: Axis::linear("moment about Y", "N m"),
        style: Style::LinesAndMarkers,
        curves: vec![Curve::new("reaction moment", points)],
    })?)
}
