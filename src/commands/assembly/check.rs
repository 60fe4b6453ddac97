//! `bearing check` of a scene of bearings.

use super::housing::Housing;
use super::lists::Lists;
use super::plan::of_housings;
use super::{defaults, housings, lines};
use crate::commands::CommandResult;
use crate::commands::check::{Line, print_json, print_lines};
use crate::commands::check_mesh::{MeshFile, print_written};
use crate::commands::echo::{geometry, inertia, numerics, through};
use crate::commands::run::{planned_request, request};
use bearing_dynamics::ch2_housing::bearing::geometry::BearingKind;
use bearing_dynamics::ch5_cage::raceway_profile::{RacewayProfile, Spall, Surface};
use bearing_dynamics::motion::plan::race_freedom;
use bearing_dynamics::motion::simulation::Stepping;
use bearing_dynamics::output::fields::size::fields_size;
use bearing_dynamics::output::session::table_size;
use bearing_dynamics::output::summary::housing::seat_section;
use bearing_dynamics::output::summary::solid::mesh_section;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::motion::dynamic_problem;
use bearing_dynamics::scene::build::sensors::{Direction, SceneSensor, SceneSensorKind};
use bearing_dynamics::scene::build::statics::static_problem;
use bearing_dynamics::scene::resolve::housing_scene::HousingMethod;
use bearing_dynamics::scene::{CageInRun, CageMethod, Document, RunSettings, Scene};
use serde_json::{Value, json};

pub fn run(
    document: &Document,
    mut scene: AssemblyScene,
    json: bool,
    mesh: Option<MeshFile>,
) -> CommandResult {
    let housings = housings::prepare(document, &scene)?;
    for placed in &scene.bearings {
        static_problem(&placed.scene)?;
        if placed.housing.is_some() {
            dynamic_problem(&placed.scene)?;
        }
    }
    housings::refuse(document, &scene, &housings)?;
    let mut made = None;
    if let Some(settings) = scene.run().cloned() {
        let assembly = scene.assembly()?;
        let mut request = request(scene.common(), &settings);
        if housings.is_empty() {
            (request, _) = planned_request(&scene, &settings, &assembly);
            table_size(assembly.clone(), &request)?;
        }
        made = Some(assembly);
        let run = RunSettings { options: request.options, ..settings };
        let common = scene.bearings.first_mut().map(|placed| &mut placed.scene);
        if let Some(common) = common.or(scene.plain.as_deref_mut()) {
            common.dynamics.run = Some(run);
        }
    }
    let scene = &scene;
    let (common, defaults) = (scene.common(), defaults(scene));
    let meshes: Vec<_> = housings.iter().map(|of| (of.name.as_deref(), &of.built.mesh)).collect();
    let written = mesh.map(|file| file.write(&meshes)).transpose()?;
    if !json {
        let mounting = match scene.one() {
            Some(_) => Vec::new(),
            None => lines(&Lists::made(scene, made))?,
        };
        let lines = |line: &mut Line| of_scene(scene, &housings, mounting, line);
        print_lines(document, &common.title, lines, &common.assumptions, &defaults)?;
        return print_written(written);
    }
    let mut found = json!({});
    let mut put = |part: &str, bearing: &Option<String>, value: Value| match bearing {
        Some(name) => found[part][name] = value,
        None => found[part] = value,
    };
    for placed in &scene.bearings {
        put("geometry", &placed.name, geometry(&placed.scene)?);
    }
    for housing in &housings {
        put("seat", &housing.name, seat_section(&housing.setup)?);
        put("mesh", &housing.name, mesh_section(&housing.built)?);
    }
    if let Some(run) = scene.run() {
        found["body_inertia"] = inertia(Lists::made(scene, made).assembly()?)?;
        if scene.housing_method() != Some(HousingMethod::QuasiStatic) {
            found["numerics"] = numerics(run)?;
        }
    }
    print_json(document, found, &common.assumptions, &defaults)
}

/// Bearings, their housings and their mounting (`mounting`), one line each.
fn of_scene(
    scene: &AssemblyScene,
    housings: &[Housing],
    mounting: Vec<(String, String)>,
    line: &mut Line,
) {
    for (index, placed) in scene.bearings.iter().enumerate() {
        if let Some(name) = &placed.name {
            line("bearing", format!("\"{name}\""));
        }
        bearing_lines(&placed.scene, line);
        for housing in housings.iter().filter(|housing| housing.bearing == index) {
            housing.lines().into_iter().for_each(|(label, text)| line(&label, text));
        }
    }
    if scene.one().is_none() {
        mounting.into_iter().for_each(|(label, text)| line(&label, text));
    }
    sensors(scene).into_iter().for_each(|(label, text)| line(&label, text));
    for (label, value) in of_run(scene, housings) {
        line(label, value);
    }
}

fn sensors(scene: &AssemblyScene) -> Vec<(String, String)> {
    let of = |sensor: &SceneSensor| {
        let text = match &sensor.kind {
            SceneSensorKind::Accelerometer { at, along, radius, angle, direction } => format!(
                "accelerometer on {}, {:.4} mm along its axis, {:.4} mm from it at {:.2} deg, {}",
                scene.name_of_place(*at),
                1e3 * along,
                1e3 * radius,
                angle.to_degrees(),
                match direction {
                    Direction::Fixed { azimuth, elevation } => format!(
                        "fixed direction, azimuth {:.2} deg, elevation {:.2} deg",
                        azimuth.to_degrees(),
                        elevation.to_degrees()
                    ),
                    other => other.name().to_string(),
                }
            ),
            SceneSensorKind::Telemeter { circuit, distance, .. } => format!(
                "telemeter, {:.4} mm from its transceiver, measured at {:.4} MHz, natural frequency {:.4} MHz",
                1e3 * distance,
                1e-6 * circuit.frequency,
                1e-6 * circuit.natural_frequency()
            ),
        };
        (format!("sensor {}", sensor.name), text)
    };
    scene.sensors.iter().map(of).collect()
}

fn bearing_lines(scene: &Scene, line: &mut Line) {
    let (geometry, sizes) = (&scene.geometry, &scene.dimensions);
    let kind = match geometry.kind {
        BearingKind::DeepGroove => "deep-groove",
        BearingKind::AngularContact => "angular-contact",
    };
    line("bearing", format!("{kind}, {} balls", geometry.ball_count));
    line(
        "ball radius",
        format!(
            "{:.6} mm in use, {:.6} mm nominal",
            1e3 * geometry.ball_radius,
            1e3 * sizes.nominal_ball_radius
        ),
    );
    let made = match sizes.radial_clearance {
        0.0 => String::new(),
        _ => {
            let part = through(sizes.clearance_through).replace('-', " ");
            format!(", made through the {part}")
        }
    };
    line(
        "clearance",
        format!(
            "{:+.4} um radial = {:+.4} um diametral{made}",
            1e6 * sizes.radial_clearance,
            1e6 * sizes.diametral_clearance
        ),
    );
    for (label, race) in [("inner race", &sizes.inner_race), ("outer race", &sizes.outer_race)] {
        line(
            label,
            format!(
                "radius {:.4} mm, groove {:.4} mm = {:.5} of the ball diameter = osculation {:.5}",
                1e3 * race.radius,
                1e3 * race.groove_radius,
                race.conformity,
                race.osculation
            ),
        );
    }
    line("pitch radius", format!("{:.4} mm", 1e3 * geometry.pitch_radius));
    line("contact angle", format!("{:.4} deg (nominal)", geometry.contact_angle.to_degrees()));
    for profile in &scene.dynamics.raceway_profiles {
        line(profile_label(profile), profile_text(profile));
    }
    if !scene.dynamics.ball_deviations.is_empty() {
        let deviations = scene.dynamics.ball_deviations.iter();
        let all: Vec<String> = deviations.map(|of| format!("{:+.4}", 1e6 * of)).collect();
        line("ball deviations", format!("{} um of radius, ball 1 first", all.join(" ")));
    }
}

fn profile_label(profile: &RacewayProfile) -> &'static str {
    match profile {
        RacewayProfile::Dent(_) => "dent",
        RacewayProfile::Spall(_) => "spall",
        RacewayProfile::Waviness(_) => "waviness",
    }
}

fn profile_text(profile: &RacewayProfile) -> String {
    let place = |on: &Surface| match on {
        Surface::Race { side, .. } if *side == 0 => "inner race".to_string(),
        Surface::Race { .. } => "outer race".to_string(),
        Surface::Ball { ball, .. } => format!("ball {}", ball + 1),
    };
    match profile {
        RacewayProfile::Dent(dent) => format!(
            "{} race at {:.4} deg, {:.4} deg up the groove: {:.4} um wide, {:.4} um deep, shoulder {:.4} um high",
            if dent.side == 0 { "inner" } else { "outer" },
            dent.angle.to_degrees(),
            dent.groove_angle.to_degrees(),
            1e6 * dent.shape.diameter,
            1e6 * dent.shape.depth,
            1e6 * dent.shape.shoulder_height
        ),
        RacewayProfile::Spall(Spall { shape, on }) => {
            let (Surface::Race { angle, groove_angle, .. }
            | Surface::Ball { angle, groove_angle, .. }) = on;
            let wide = match shape.width.is_finite() {
                true => format!(", {:.4} mm wide", 1e3 * shape.width),
                false => String::new(),
            };
            format!(
                "{} at {:.4} deg, {:.4} deg up: {:.4} mm long{wide}, {:.4} um deep, edges of {:.4} mm",
                place(on),
                angle.to_degrees(),
                groove_angle.to_degrees(),
                1e3 * shape.length,
                1e6 * shape.depth,
                1e3 * shape.edge_radius
            )
        }
        RacewayProfile::Waviness(wave) => format!(
            "{}: {} waves of {:.4} um, phase {:.4} deg",
            place(&wave.on),
            wave.order,
            1e6 * wave.amplitude,
            wave.phase.to_degrees()
        ),
    }
}

fn of_run(scene: &AssemblyScene, housings: &[Housing]) -> Vec<(&'static str, String)> {
    let Some(run) = scene.run() else { return Vec::new() };
    let (end, interval) = (run.end, run.output_interval);
    let rows = format!("to t = {end} s, a row every {interval} s");
    let mut lines = Vec::new();
    match (scene.housing_method(), housings.first().map(|of| &of.scene.housing)) {
        (Some(HousingMethod::QuasiStatic), _) => {
            lines.push(("run", format!("to t = {end} s, an equilibrium every {interval} s")));
            lines.push(("motion", "quasi-static: inertia is left out".into()));
        }
        (Some(HousingMethod::Reduced), _) => {
            lines.push(("run", rows));
            lines.push(("steps", format!("{}, of bearing and housing together", stepping(run))));
        }
        (Some(HousingMethod::Explicit), Some(housing)) => {
            let steps = format!(
                "coupling steps of phase {} of the race-bore contact; the housing by central differences, {} \
                 of the largest stable step; the bearing by {}",
                housing.coupling_phase,
                housing.step_fraction,
                stepping(run)
            );
            lines.extend([("run", rows), ("steps", steps)]);
        }
        _ => lines.push(("run", format!("to t = {end} s by {}", stepping(run)))),
    }
    if scene.housing_method() != Some(HousingMethod::QuasiStatic)
        && let Some(one) = scene.one()
    {
        lines.extend(bodies(&one.scene));
    }
    if !housings.is_empty() || scene.has_shafts_in_elements() || scene.has_cages_in_elements() {
        let mut solids = of_housings(housings);
        // Shafts are not meshed here.
        let beams = scene.bodies.iter().filter_map(|body| body.beam.as_deref());
        let shafts = beams.filter(|beam| beam.in_elements.is_some()).count();
        let cages = scene.cages_in_elements();
        if shafts + cages > 0 {
            solids = vec![0.0; solids.len() + shafts + cages];
        }
        let fields = fields_size(end, interval, run.fields_interval, &solids);
        lines.push(("fields", fields.to_string()));
    }
    lines
}

fn stepping(run: &RunSettings) -> String {
    let steps = match run.options.stepping {
        Stepping::Fixed(step) => format!("a step of {step:e} s"),
        Stepping::FractionOfLimit(part) => format!("{part} of the largest stable step"),
        Stepping::Accuracy(accuracy) => format!("steps for an accuracy of {accuracy}"),
    };
    format!("{}, {steps}", run.options.integrator.name())
}

/// Motion of each body of a bearing in a run.
fn bodies(scene: &Scene) -> Vec<(&'static str, String)> {
    let dynamics = &scene.dynamics;
    let outer = match &dynamics.outer {
        Some(body) => race_freedom(body),
        None => "fixed in space".into(),
    };
    let cage = match &dynamics.cage {
        CageInRun::Body(_) => match dynamics.flexible_cage.as_ref().map(|cage| cage.method) {
            Some(CageMethod::Explicit) => "elements in explicit steps".into(),
            Some(CageMethod::Reduced) => "modes in a frame with six coordinates".into(),
            _ => "a rigid body with six coordinates".into(),
        },
        CageInRun::LeftOut(reason) => format!("left out: {reason}"),
    };
    let balls = "six coordinates each, with gyroscopic and centrifugal effects";
    vec![
        ("inner race motion", race_freedom(&dynamics.inner)),
        ("outer race motion", outer),
        ("ball motion", balls.into()),
        ("cage motion", cage),
    ]
}
