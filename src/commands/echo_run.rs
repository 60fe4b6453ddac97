//! Motion, numerics and output of a scene as JSON with units.

use bearing_dynamics::assembly::bearing_alone::{CageBody, DynamicProblem};
use bearing_dynamics::ch2_housing::bearing::cage::{CageForce, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::bearing::inertia::Inertia;
use bearing_dynamics::ch2_housing::bearing::traction::{ExponentialCurve, TractionLaw};
use bearing_dynamics::ch3_bushing::dent::Dent;
use bearing_dynamics::ch5_cage::raceway_profile::{RacewayProfile, Spall, Surface, Waviness};
use bearing_dynamics::equilibrium::statics::COORDINATE_NAMES;
use bearing_dynamics::members::bearing::BallMeeting;
use bearing_dynamics::members::body::{Drive, DrivenBody, RotatingLoad, Rotation};
use bearing_dynamics::motion::simulation::{Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::results::{ResultsError, quantity};
use bearing_dynamics::scene::build::assembly::SceneBody;
use bearing_dynamics::scene::{Assumption, DefaultUsed, Plot, RunPlot, RunSettings, Scene};
use serde_json::{Map, Value, json};

type Echo = Result<Value, ResultsError>;

/// Defaults in use; for a run also those of its motion, without those of statics alone.
pub fn defaults(scene: &Scene) -> Vec<DefaultUsed> {
    let mut all = scene.defaults_used.clone();
    if scene.dynamics.run.is_none() {
        return all;
    }
    // In a run the centrifugal force follows from the motion of the balls.
    all.retain(|used| used.key != "ball_forces.centrifugal");
    let outer_moves = scene.dynamics.outer.is_some();
    for used in all.iter_mut().filter(|used| outer_moves && used.key.starts_with("outer_race.")) {
        used.reason = "where the outer race starts, before loads and foundation move it".into();
    }
    all.extend_from_slice(&scene.dynamics.defaults_used);
    all
}

pub fn notes(assumptions: &[Assumption], defaults: &[DefaultUsed]) -> [(&'static str, Value); 2] {
    let assumption = |a: &Assumption| json!({ "name": a.name, "text": a.text });
    let default =
        |used: &DefaultUsed| json!({ "key": used.key, "value": used.value, "reason": used.reason });
    [
        ("assumptions", assumptions.iter().map(assumption).collect()),
        ("defaults", defaults.iter().map(default).collect()),
    ]
}

/// Numerical settings of a run, under the keys of the scene.
pub fn numerics(run: &RunSettings) -> Echo {
    let options = &run.options;
    let (name, value, unit) = match options.stepping {
        Stepping::Fixed(step) => ("step", step, "s"),
        Stepping::FractionOfLimit(part) => ("step_fraction", part, "1"),
        Stepping::Accuracy(accuracy) => ("accuracy", accuracy, "1"),
    };
    Ok(json!({
        "end": quantity("end", run.end, "s")?,
        "integrator": options.integrator.name(),
        name: quantity(name, value, unit)?,
        "start": match options.start {
            Start::Equilibrium => "equilibrium",
            Start::Nominal => "nominal",
        },
        "output_interval": quantity("output_interval", run.output_interval, "s")?,
        "energy_limit": quantity("energy_limit", options.energy_limit, "1")?,
    }))
}

/// Output: columns, averaging window and plots of a run, or the plots of statics.
pub fn output(scene: &Scene) -> Echo {
    let of_statics = |plot: &Plot| match plot {
        Plot::LoadZone => "load-zone",
        Plot::Polar => "polar",
        Plot::MomentTilt => "moment-tilt",
    };
    let Some(run) = &scene.dynamics.run else {
        let plots: Vec<&str> = scene.plots.iter().map(of_statics).collect();
        return Ok(json!({ "plots": plots }));
    };
    let of_run = |plot: &RunPlot| match plot {
        RunPlot::Orbit => "orbit",
        RunPlot::Spectrum => "spectrum",
        RunPlot::Series => "series",
        RunPlot::SlipSpin => "slip-spin",
        RunPlot::RunUp => "run-up",
    };
    // Statics and runs have polar plots.
    let polar = scene.plots.iter().filter(|plot| **plot == Plot::Polar).map(of_statics);
    let plots: Vec<&str> = scene.dynamics.plots.iter().map(of_run).chain(polar).collect();
    Ok(json!({
        "plots": plots,
        "channels": run.channels.iter().map(|group| group.name()).collect::<Vec<_>>(),
        "window_start": quantity("window_start", run.window_start, "s")?,
    }))
}

pub fn motion(problem: &DynamicProblem) -> Echo {
    let mut echo = Map::new();
    echo.insert("ball".into(), json!({ "inertia": inertia(&problem.ball)? }));
    echo.insert("inner_race".into(), race(&problem.inner)?);
    if let Some(outer) = &problem.outer {
        echo.insert("outer_race".into(), race(outer)?);
    }
    if let Some(given) = &problem.cage {
        echo.insert("cage".into(), cage(given)?);
    }
    echo.insert("traction".into(), traction(problem)?);
    echo.insert("contact_damping".into(), damping(&problem.damping)?);
    for profile in &problem.raceway_profiles {
        let (list, value) = match profile {
            RacewayProfile::Dent(of) => ("dents", dent(of)?),
            RacewayProfile::Spall(of) => ("spalls", spall(of)?),
            RacewayProfile::Waviness(of) => ("waviness", waviness(of)?),
        };
        if let Value::Array(list) = echo.entry(list).or_insert_with(|| json!([])) {
            list.push(value);
        }
    }
    if !problem.ball_deviations.is_empty() {
        let deviations = problem.ball_deviations.iter();
        let all = deviations.map(|of| quantity("deviation", *of, "m"));
        let all = all.collect::<Result<_, ResultsError>>()?;
        echo.insert("ball_deviations".into(), Value::Array(all));
    }
    if !matches!(problem.assembly().bearings[0].ball_meeting(), BallMeeting::KeptApart { .. }) {
        echo.insert("ball_contact".into(), ball_contact(problem)?);
    }
    rotating_loads(&mut echo, problem.rotating_load.as_ref(), problem.unbalance)?;
    Ok(Value::Object(echo))
}

pub fn body(body: &SceneBody) -> Echo {
    let mut echo = race(&body.race)?;
    if let Value::Object(map) = &mut echo {
        rotating_loads(map, body.rotating_load.as_ref(), body.unbalance)?;
    }
    Ok(echo)
}

fn rotating_loads(
    echo: &mut Map<String, Value>,
    load: Option<&RotatingLoad>,
    unbalance: f64,
) -> Result<(), ResultsError> {
    if let Some(load) = load {
        let load = json!({
            "force": profile(&load.force, "N")?,
            "speed": profile(&load.speed, "rad/s")?,
            "phase": quantity("phase", load.phase.to_degrees(), "deg")?,
        });
        echo.insert("rotating_load".into(), load);
    }
    if unbalance != 0.0 {
        echo.insert("unbalance".into(), quantity("unbalance", unbalance, "kg m")?);
    }
    Ok(())
}

pub fn inertia(inertia: &Inertia) -> Echo {
    Ok(json!({
        "mass": quantity("mass", inertia.mass, "kg")?,
        "axial": quantity("axial", inertia.axial, "kg m^2")?,
        "transverse": quantity("transverse", inertia.transverse, "kg m^2")?,
    }))
}

fn race(body: &DrivenBody) -> Echo {
    let mut echo = Map::new();
    echo.insert("inertia".into(), inertia(&body.inertia)?);
    for (i, name) in COORDINATE_NAMES.iter().enumerate() {
        let (motion_unit, load_unit) = if i < 3 { ("m", "N") } else { ("rad", "N m") };
        let entry = match &body.drives[i] {
            Drive::Load(given) => json!({ "load": profile(given, load_unit)? }),
            Drive::Motion(given) => json!({ "displacement": profile(given, motion_unit)? }),
        };
        echo.insert((*name).into(), entry);
    }
    let (name, entry) = match &body.rotation {
        Rotation::Speed(given) => ("speed", profile(given, "rad/s")?),
        Rotation::Torque(given) => ("torque", profile(given, "N m")?),
    };
    echo.insert(name.into(), entry);
    let (stiffness, damping) = (&body.foundation_stiffness, &body.foundation_damping);
    if stiffness.iter().chain(damping).any(|value| *value != 0.0) {
        let mut foundation = [Map::new(), Map::new()];
        for (i, name) in COORDINATE_NAMES.iter().enumerate() {
            let units = if i < 3 { ["N/m", "N s/m"] } else { ["N m/rad", "N m s/rad"] };
            for ((part, value), unit) in
                foundation.iter_mut().zip([stiffness[i], damping[i]]).zip(units)
            {
                part.insert((*name).into(), quantity(name, value, unit)?);
            }
        }
        let [stiffness, damping] = foundation;
        echo.insert("foundation".into(), json!({ "stiffness": stiffness, "damping": damping }));
    }
    Ok(Value::Object(echo))
}

fn cage(body: &CageBody) -> Echo {
    let contacts = &body.contacts;
    let (law, stiffness, unit) = match contacts.force {
        CageForce::Penalty { stiffness } => ("penalty", stiffness, "N/m"),
        CageForce::Hertz { stiffness } => ("hertz", stiffness, "N/m^1.5"),
    };
    Ok(json!({
        "inertia": inertia(&body.inertia)?,
        "pocket": match contacts.pocket {
            Pocket::Cylindrical => "cylindrical",
            Pocket::Spherical => "spherical",
        },
        "guidance": contacts.guidance.name(),
        "pocket_radius": quantity("pocket_radius", contacts.pocket_radius, "m")?,
        "pocket_pitch_radius":
            quantity("pocket_pitch_radius", contacts.pocket_pitch_radius, "m")?,
        "guide_radius": quantity("guide_radius", contacts.guide_radius, "m")?,
        "race_clearance": quantity("race_clearance", contacts.race_clearance, "m")?,
        "length": quantity("length", contacts.length, "m")?,
        "contact_law": law,
        "contact_stiffness": quantity("contact_stiffness", stiffness, unit)?,
        "friction": quantity("friction", contacts.friction, "1")?,
        "regularisation_speed":
            quantity("regularisation_speed", contacts.regularisation_speed, "m/s")?,
    }))
}

fn traction(problem: &DynamicProblem) -> Echo {
    let curve = |curve: &ExponentialCurve, unit: &str| -> Echo {
        Ok(json!({
            "b": quantity("b", curve.b, unit)?,
            "c": quantity("c", curve.c, unit)?,
            "d": quantity("d", curve.d, "1")?,
        }))
    };
    let law = match &problem.traction {
        TractionLaw::None => return Ok(json!({ "law": "none" })),
        TractionLaw::Constant { coefficient, regularisation_speed } => json!({
            "law": "constant",
            "coefficient": quantity("coefficient", *coefficient, "1")?,
            "regularisation_speed":
                quantity("regularisation_speed", *regularisation_speed, "m/s")?,
        }),
        TractionLaw::SlideToRoll { curve: given, entrainment_floor } => json!({
            "law": "slide-to-roll",
            "curve": curve(given, "1")?,
            "entrainment_floor": quantity("entrainment_floor", *entrainment_floor, "m/s")?,
        }),
        TractionLaw::SlipSpeed { curve: given } => {
            json!({ "law": "slip-speed", "curve": curve(given, "s/m")? })
        }
    };
    Ok(json!({
        "law": law,
        "slices": problem.slices,
        "points_across": problem.points_across,
        "differential_sliding": problem.differential_sliding,
    }))
}

fn damping(damping: &ContactDamping) -> Echo {
    Ok(match damping {
        ContactDamping::None => json!({ "law": "none" }),
        ContactDamping::HuntCrossley { alpha } => {
            json!({ "law": "hunt-crossley", "alpha": quantity("alpha", *alpha, "s/m")? })
        }
    })
}

fn dent(dent: &Dent) -> Echo {
    let shape = &dent.shape;
    Ok(json!({
        "race": if dent.side == 0 { "inner" } else { "outer" },
        "angle": quantity("angle", dent.angle.to_degrees(), "deg")?,
        "groove_angle": quantity("groove_angle", dent.groove_angle.to_degrees(), "deg")?,
        "diameter": quantity("diameter", shape.diameter, "m")?,
        "depth": quantity("depth", shape.depth, "m")?,
        "shoulder_height": quantity("shoulder_height", shape.shoulder_height, "m")?,
        "shoulder_width": quantity("shoulder_width", shape.shoulder_width, "m")?,
    }))
}

fn place(on: &Surface) -> Result<Map<String, Value>, ResultsError> {
    let (name, angle, groove_angle) = match on {
        Surface::Race { side: 0, angle, groove_angle } => (json!("inner"), angle, groove_angle),
        Surface::Race { angle, groove_angle, .. } => (json!("outer"), angle, groove_angle),
        Surface::Ball { ball, angle, groove_angle } => {
            (json!(format!("ball {}", ball + 1)), angle, groove_angle)
        }
    };
    let mut echo = Map::new();
    echo.insert("on".into(), name);
    echo.insert("angle".into(), quantity("angle", angle.to_degrees(), "deg")?);
    let up = quantity("groove_angle", groove_angle.to_degrees(), "deg")?;
    echo.insert("groove_angle".into(), up);
    Ok(echo)
}

fn spall(Spall { shape, on }: &Spall) -> Echo {
    let mut echo = place(on)?;
    let sizes = [
        ("length", shape.length),
        ("width", shape.width),
        ("edge_radius", shape.edge_radius),
        ("depth", shape.depth),
    ];
    // A spall on a ball is round.
    for (name, value) in sizes.into_iter().filter(|(_, value)| value.is_finite()) {
        echo.insert(name.into(), quantity(name, value, "m")?);
    }
    Ok(Value::Object(echo))
}

fn waviness(wave: &Waviness) -> Echo {
    let mut echo = place(&wave.on)?;
    if let Surface::Race { .. } = wave.on {
        echo.remove("angle");
        echo.remove("groove_angle");
        echo.insert("phase".into(), quantity("phase", wave.phase.to_degrees(), "deg")?);
    }
    echo.insert("order".into(), json!(wave.order));
    echo.insert("amplitude".into(), quantity("amplitude", wave.amplitude, "m")?);
    Ok(Value::Object(echo))
}

fn ball_contact(problem: &DynamicProblem) -> Echo {
    let Some(law) = &problem.ball_contact else { return Ok(json!({ "law": "none" })) };
    Ok(json!({
        "law": "hertz",
        "stiffness": quantity("stiffness", law.stiffness, "N/m^1.5")?,
        "friction": quantity("friction", law.friction, "1")?,
        "regularisation_speed": quantity("regularisation_speed", law.regularisation_speed, "m/s")?,
    }))
}

fn pairs(points: &[[f64; 2]], x_unit: &str, y_unit: &str) -> Echo {
    let pair =
        |[x, y]: &[f64; 2]| Ok(json!([quantity("x", *x, x_unit)?, quantity("y", *y, y_unit)?]));
    Ok(json!(points.iter().map(pair).collect::<Result<Vec<Value>, ResultsError>>()?))
}

/// A function of time with its unit; a constant becomes a plain quantity.
pub(super) fn profile(profile: &Profile, unit: &str) -> Echo {
    let value = |name: &str, value: f64| quantity(name, value, unit);
    let second = |name: &str, value: f64| quantity(name, value, "s");
    Ok(match profile {
        Profile::Constant(constant) => value("constant", *constant)?,
        Profile::Ramp { from, to, start, duration } => json!({
            "ramp": [value("from", *from)?, value("to", *to)?],
            "start": second("start", *start)?,
            "duration": second("duration", *duration)?,
        }),
        Profile::SmoothRamp { from, to, start, duration } => json!({
            "smooth_ramp": [value("from", *from)?, value("to", *to)?],
            "start": second("start", *start)?,
            "duration": second("duration", *duration)?,
        }),
        Profile::Table { points } => json!({ "table": pairs(points, "s", unit)? }),
        Profile::Harmonic { mean, amplitude, frequency, phase } => json!({
            "mean": value("mean", *mean)?,
            "amplitude": value("amplitude", *amplitude)?,
            "frequency": quantity("frequency", *frequency, "Hz")?,
            "phase": quantity("phase", phase.to_degrees(), "deg")?,
        }),
        Profile::HalfSine { base, peak, start, duration } => json!({
            "half_sine": value("peak", *peak)?,
            "base": value("base", *base)?,
            "start": second("start", *start)?,
            "duration": second("duration", *duration)?,
        }),
    })
}
