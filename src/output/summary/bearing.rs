//! Summary of bearings in a transient run: time steps, largest loads, speeds.

use super::{Part, RunReport};
use crate::ch2_housing::bearing::ball_contact::peak_pressure;
use crate::ch2_housing::bearing::geometry::BearingGeometry;
use crate::ch2_housing::bearing::hertz::contact_ellipse;
use crate::members::bearing::{BallMeeting, Bearing};
use crate::motion::extremes::{Extreme, Extremes};
use crate::motion::simulation::{Simulation, Stepping};
use crate::output::results::{ResultsError, quantity};
use crate::output::table::RunTable;
use serde_json::{Map, Value, json};
use std::f64::consts::TAU;

pub(super) fn work(simulation: &Simulation) -> Value {
    let work = &simulation.system.work;
    json!({
        "steps": simulation.steps,
        "evaluations": work.evaluations,
        "distance_tests": work.distance_tests,
        "loaded_contacts": work.loaded_contacts,
        "slices": work.slices,
        "pocket_tests": work.pocket_tests,
        "guide_tests": work.guide_tests,
        "ball_tests": work.ball_tests,
        "factorisations": work.factorisations,
        "rejected_steps": work.rejected_steps,
    })
}

pub(super) fn step(simulation: &Simulation, report: &RunReport) -> Part {
    let size = simulation.step_size;
    let mut step = Map::new();
    if let Some(integrator) = report.integrator {
        step.insert("method".into(), json!(integrator.name()));
    }
    if let (Some(control), Some(Stepping::Accuracy(accuracy))) =
        (&simulation.control, report.stepping)
    {
        let memory = &control.memory;
        step.insert("accuracy".into(), json!(accuracy));
        step.insert("accepted".into(), json!(simulation.steps));
        step.insert("rejected".into(), json!(simulation.system.work.rejected_steps));
        step.insert("smallest".into(), quantity("smallest", memory.smallest, "s")?);
        step.insert("largest".into(), quantity("largest", memory.largest, "s")?);
        step.insert("scale".into(), quantity("largest overlap", memory.displacement, "m")?);
        step.insert("reason".into(), json!("error control: the longest step within the accuracy"));
        return Ok(Value::Object(step));
    }
    step.insert("size".into(), quantity("step", size, "s")?);
    let reason = match (&simulation.limit, report.stepping) {
        (Some(limit), Some(Stepping::FractionOfLimit(fraction))) => {
            step.insert("stability_limit".into(), quantity("limit", limit.step, "s")?);
            let shortened = simulation.step_watch.shortened;
            let when = match shortened {
                0 => "at the start",
                _ => "where it was last shortened",
            };
            step.insert("shortened".into(), json!(shortened));
            format!(
                "{fraction} of the stability limit {when}, shortened to a whole number of steps an \
                 output interval; {}",
                limit.reason(&simulation.system.assembly)
            )
        }
        (Some(limit), _) => limit.reason(&simulation.system.assembly),
        (None, _) => "given".into(),
    };
    step.insert("reason".into(), json!(reason));
    if let Some(smallest) = simulation.step_watch.smallest {
        step.insert("smallest_stability_limit".into(), quantity("limit", smallest, "s")?);
    }
    Ok(Value::Object(step))
}

/// Ratios of ball-set speed to inner-race speed, both relative to the outer race, for rolling without slip at the middle
/// of both contacts: outer control, then inner control. With one contact angle the ratio is (1 - γ cos α)/2, γ = r/R.
/// With two it depends on the ball's own axis: spin on the inner race only, (1 - γ cos α_i)/(1 + cos(α_i - α_o)), spin on
/// the outer race only, (cos(α_i - α_o) - γ cos α_o)/(1 + cos(α_i - α_o)), or values in between for spin on both.
fn rolling_ratios(geometry: &BearingGeometry, [inner, outer]: [f64; 2]) -> [f64; 2] {
    let gamma = geometry.ball_radius / geometry.pitch_radius;
    let between = libm::cos(inner - outer);
    [1.0 - gamma * libm::cos(inner), between - gamma * libm::cos(outer)]
        .map(|ratio| ratio / (1.0 + between))
}

/// Mean speeds over the window, and the speeds of pure rolling at the mean contact angles.
pub(super) fn kinematics(
    simulation: &Simulation,
    table: &RunTable,
) -> Result<Option<Value>, ResultsError> {
    each_bearing(simulation, |_, bearing| kinematics_of(bearing, table))
}

/// One section per bearing under its name; for a single bearing the section itself.
fn each_bearing(
    simulation: &Simulation,
    of: impl Fn(usize, &Bearing) -> Result<Option<Value>, ResultsError>,
) -> Result<Option<Value>, ResultsError> {
    let mut named = Map::new();
    for (index, bearing) in simulation.system.assembly.bearings.iter().enumerate() {
        let section = of(index, bearing)?;
        match (&bearing.name, section) {
            (None, section) => return Ok(section),
            (Some(name), Some(section)) => {
                named.insert(name.clone(), section);
            }
            (Some(_), None) => {}
        }
    }
    Ok((!named.is_empty()).then_some(Value::Object(named)))
}

fn kinematics_of(bearing: &Bearing, table: &RunTable) -> Result<Option<Value>, ResultsError> {
    let (geometry, prefix) = (&bearing.geometry, bearing.prefix());
    let mean = |channel: &str| {
        let values = table.windowed(&format!("{prefix}{channel}"))?;
        Some(values.iter().sum::<f64>() / values.len() as f64)
    };
    let Some([inner, outer]) = table.race_speeds(&prefix) else { return Ok(None) };
    if inner == 0.0 && outer == 0.0 {
        return Ok(None);
    }
    let nominal = geometry.contact_angle;
    let actual = ["mean_inner_contact_angle", "mean_outer_contact_angle"].map(mean);
    let (angles, named) = match actual {
        [Some(inner), Some(outer)] => (
            [inner.to_radians(), outer.to_radians()],
            "the mean contact angles over the window, weighted by ball load",
        ),
        _ => (
            [nominal; 2],
            "the nominal contact angle, because the channels `orbits` are not recorded",
        ),
    };
    let speeds_at = |angles: [f64; 2]| {
        rolling_ratios(geometry, angles).map(|ratio| ratio * inner + (1.0 - ratio) * outer)
    };
    let [outer_control, inner_control] = speeds_at(angles);
    let (low, high) = (outer_control.min(inner_control), outer_control.max(inner_control));
    let mut section = Map::new();
    let speed = |value: f64| quantity("speed", value, "rad/s");
    let frequency = |value: f64| quantity("frequency", value / TAU, "Hz");
    let angle = |value: f64| quantity("contact angle", value.to_degrees(), "deg");
    section.insert("inner_race_speed".into(), speed(inner)?);
    section.insert("inner_race_frequency".into(), frequency(inner)?);
    if outer != 0.0 {
        section.insert("outer_race_speed".into(), speed(outer)?);
        section.insert("outer_race_frequency".into(), frequency(outer)?);
    }
    section.insert("rolling_at".into(), json!(named));
    section.insert("inner_contact_angle".into(), angle(angles[0])?);
    section.insert("outer_contact_angle".into(), angle(angles[1])?);
    section.insert("nominal_contact_angle".into(), angle(nominal)?);
    section.insert("rolling_cage_speed_outer_control".into(), speed(outer_control)?);
    section.insert("rolling_cage_frequency_outer_control".into(), frequency(outer_control)?);
    section.insert("rolling_cage_speed_inner_control".into(), speed(inner_control)?);
    section.insert("rolling_cage_frequency_inner_control".into(), frequency(inner_control)?);
    let at_nominal = speeds_at([nominal; 2])[0];
    section.insert("rolling_cage_speed_at_nominal_angle".into(), speed(at_nominal)?);
    let of = "relative to the nearer of outer and inner control; zero between them";
    section.insert("slip_is".into(), json!(of));
    let orbital: Option<Vec<f64>> =
        (1..=geometry.ball_count).map(|ball| mean(&format!("ball_{ball}_orbital_speed"))).collect();
    let balls = orbital.map(|speeds| speeds.iter().sum::<f64>() / speeds.len() as f64);
    for (name, measured) in [("ball_set", balls), ("cage", mean("cage_speed"))] {
        let Some(measured) = measured else { continue };
        section.insert(format!("{name}_speed"), speed(measured)?);
        section.insert(format!("{name}_frequency"), frequency(measured)?);
        let rolling = measured.clamp(low, high);
        if rolling != 0.0 {
            let slip = 1.0 - measured / rolling;
            section.insert(format!("{name}_slip"), quantity("slip", slip, "1")?);
        }
    }
    let lines = table.defect_lines();
    let own = lines.iter().filter(|of| of.prefix == prefix).flat_map(|of| &of.lines);
    for line in own.filter(|line| line.order == 1) {
        let key = match line.name.rsplit(' ').next() {
            Some("BPFO") => "ball_pass_outer_frequency",
            Some("BPFI") => "ball_pass_inner_frequency",
            Some("BSF") => "ball_spin_frequency",
            _ => continue,
        };
        section.insert(key.into(), quantity(key, line.frequency, "Hz")?);
    }
    if let Some(whirl) = cage_whirl(table, &prefix) {
        section.insert("cage_mean_distance".into(), quantity("distance", whirl.distance, "m")?);
        section.insert("cage_whirl_turns".into(), quantity("turns", whirl.turns, "1")?);
        section.insert("cage_rest".into(), quantity("rest", whirl.rest, "1")?);
    }
    Ok(Some(Value::Object(section)))
}

/// Motion of a cage's centre about the axis of the outer race over the window.
struct Whirl {
    /// Mean distance, m.
    distance: f64,
    /// Turns about the axis.
    turns: f64,
    /// Distance of the mean place over the mean distance: 1 at rest, 0 for a full whirl.
    rest: f64,
}

/// `None` without the cage's columns, and for a cage that stays on the axis.
fn cage_whirl(table: &RunTable, prefix: &str) -> Option<Whirl> {
    let column = |name: &str| table.windowed(&format!("{prefix}{name}"));
    let [cage_y, cage_z] = [column("cage_y")?, column("cage_z")?];
    let (outer_y, outer_z) = match (column("outer_y"), column("outer_z")) {
        (Some(y), Some(z)) => (y, z),
        _ => {
            let still = vec![0.0; cage_y.len()];
            (still.clone(), still)
        }
    };
    let places = || (0..cage_y.len()).map(|i| [cage_y[i] - outer_y[i], cage_z[i] - outer_z[i]]);
    let count = cage_y.len() as f64;
    let distance = places().map(|[y, z]| y.hypot(z)).sum::<f64>() / count;
    let mean = places().fold([0.0; 2], |sum, [y, z]| [sum[0] + y / count, sum[1] + z / count]);
    let angle = |[[y, z], [v, w]]: [[f64; 2]; 2]| (y * w - z * v).atan2(y * v + z * w);
    let turns = places().zip(places().skip(1)).map(|(a, b)| angle([a, b])).sum::<f64>() / TAU;
    // A cage on the axis has no side.
    (distance > 0.0).then(|| Whirl { distance, turns, rest: mean[0].hypot(mean[1]) / distance })
}

/// Largest values over all steps, including those between rows.
pub(super) fn extremes(simulation: &Simulation) -> Part {
    let sections = each_bearing(simulation, |index, bearing| {
        extremes_of(&simulation.extremes[index], bearing).map(Some)
    })?;
    Ok(sections.unwrap_or_default())
}

fn extremes_of(extremes: &Extremes, bearing: &Bearing) -> Part {
    let mut section = Map::new();
    for (name, extreme) in
        [("inner_race_farthest", extremes.farthest), ("races_farthest_apart", extremes.apart)]
    {
        let entry = json!({
            "distance": quantity(name, extreme.value, "m")?,
            "time": quantity("time", extreme.time, "s")?,
        });
        section.insert(name.into(), entry);
    }
    let contacts = [("inner_race", &bearing.inner_contact), ("outer_race", &bearing.outer_contact)];
    for ((name, contact), race) in contacts.into_iter().zip(&extremes.races) {
        let load = race.load.value;
        let at = |extreme: &Extreme| -> Result<[(&'static str, Value); 2], ResultsError> {
            Ok([("ball", json!(extreme.ball + 1)), ("time", quantity("time", extreme.time, "s")?)])
        };
        let mut largest = Map::new();
        largest.insert("load".into(), quantity("load", load, "N")?);
        let pressure = contact_ellipse(contact, load).peak_pressure;
        largest.insert("peak_pressure".into(), quantity("pressure", pressure, "Pa")?);
        largest.extend(at(&race.load)?.map(|(key, value)| (key.to_string(), value)));
        let mut edge = Map::new();
        let angle = |value: f64| quantity("angle", value.to_degrees(), "deg");
        edge.insert("ellipse_reaches".into(), angle(race.edge.value)?);
        edge.insert("contact_angle".into(), angle(race.edge_angle)?);
        edge.extend(at(&race.edge)?.map(|(key, value)| (key.to_string(), value)));
        section
            .insert(name.into(), json!({ "largest_load": largest, "farthest_from_bottom": edge }));
    }
    if let Some(law) =
        bearing.ball_contact.filter(|_| bearing.ball_meeting() == BallMeeting::Tested)
    {
        let (between, balls) = (&extremes.between_balls, bearing.geometry.ball_count);
        let pressure = peak_pressure(&law, bearing.geometry.ball_radius, between.value);
        let largest = json!({
            "load": quantity("load", between.value, "N")?,
            "peak_pressure": quantity("pressure", pressure, "Pa")?,
            "balls": [between.ball + 1, (between.ball + 1) % balls + 1],
            "time": quantity("time", between.time, "s")?,
        });
        section.insert("between_balls".into(), json!({ "largest_load": largest }));
    }
    section.insert("of".into(), json!("every accepted step, including those between rows"));
    Ok(Value::Object(section))
}
