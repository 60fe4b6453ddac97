//! Key figures that `bearing run` prints at its end.

use bearing_dynamics::equilibrium::quasi_static_sequence::QuasiStaticSequence;
use bearing_dynamics::motion::simulation::Simulation;
use bearing_dynamics::numeric::clock::{display_time, to_digits};
use bearing_dynamics::output::recorder::seat::prefix;
use bearing_dynamics::output::session::{Motion, Session};
use bearing_dynamics::output::summary::housing::PEAK_PRESSURE;
use bearing_dynamics::output::table::RunTable;
use bearing_dynamics::scene::text::units::plain;
use serde_json::Value;

type Lines = Vec<(String, String)>;

/// Displacements of the races, largest loads, energy residual and effort. Means are over the rows of the averaging
/// window; extremes are over all steps of a single bearing, or over all rows of one in a housing.
pub fn key_figures(session: &Session, table: &RunTable, seconds: f64) -> String {
    let mut lines = Lines::new();
    match &session.motion {
        Motion::Bearing(simulation) => of_bearing(simulation, table, &mut lines),
        Motion::Solid(_) | Motion::Rubber(_) => {}
        Motion::Housed(housed) => {
            for bearing in &housed.simulation.system.assembly.bearings {
                let of = bearing.prefix();
                let [y, z] =
                    ["y", "z"].map(|axis| 1e6 * largest(table, &format!("{of}outer_{axis}")));
                let text = format!("{y:.6} um along y, {z:.6} um along z");
                lines.push((format!("{}outer race, farthest", of.replace('_', " ")), text));
            }
        }
        Motion::QuasiStaticSequence(sequence) => {
            let bearings = &sequence.problem.assembly.bearings;
            bearings.iter().for_each(|of| race_displacements(table, &of.prefix(), &mut lines));
        }
    }
    match &session.motion {
        Motion::Housed(housed) => {
            housed.seats().for_each(|seat| lines.push(of_bore(table, &seat.seat.name)));
        }
        Motion::Bearing(simulation) => {
            let seats = &simulation.system.assembly.seats;
            lines.extend(seats.iter().map(|seat| of_bore(table, &seat.label)));
        }
        Motion::QuasiStaticSequence(sequence) => {
            lines.extend(sequence.problem.seats.iter().map(|seat| of_bore(table, &seat.name)));
        }
        Motion::Solid(_) => {}
        Motion::Rubber(moving) => {
            let maxwell = &moving.solid.model().problem.material.maxwell;
            of_supports(session, table, !maxwell.is_empty(), &mut lines);
        }
    }
    if session.motion.is_balanced_whole() {
        let (most, of) = (session.watch.largest_residual, session.watch.turned_over);
        let text = format!("{most:.3e} J at most, of {of:.3e} J exchanged");
        lines.push(("energy unaccounted for".into(), text));
    }
    let done = session.motion.done();
    lines.push(match &session.motion {
        Motion::Bearing(_) | Motion::Solid(_) => {
            ("steps".into(), format!("{done} in {seconds:.2} s"))
        }
        Motion::Housed(housed) => {
            let of_bearing = housed.simulation.steps;
            let mut text = format!("{done} in {seconds:.2} s; ");
            for kind in ["housing", "shaft", "cage"] {
                let of_kind = housed.solids.iter().filter(|part| part.kind() == kind);
                let steps: u64 = of_kind.map(|part| part.solid.steps).sum();
                if steps > 0 {
                    text += &format!("{steps} steps of the {kind}, ");
                }
            }
            for bushing in &housed.bushings {
                text += &format!("{} steps of the bushing {}, ", bushing.steps_done(), bushing.name);
            }
            text += &format!("{of_bearing} of the bearing");
            ("coupling steps".into(), text)
        }
        Motion::QuasiStaticSequence(sequence) => ("equilibria".into(), effort(sequence, seconds)),
        Motion::Rubber(moving) => {
            let (iterations, factorisations) = moving.solid.work();
            let text = format!(
                "{} in {seconds:.2} s, {} rejected; {iterations} iterations, {factorisations} factorisations",
                moving.solid.counts.accepted, moving.solid.counts.undone
            );
            ("steps".into(), text)
        }
    });
    lines.iter().map(|(label, value)| format!("{label:<22} {value}\n")).collect()
}

/// Kinematic frequencies, speeds and slips of balls and cage, and the highest peak of each spectrum, from the summary.
pub fn rotation(summary: &Value) -> String {
    const LINES: [(&str, &str); 3] = [
        ("BPFO", "ball_pass_outer_frequency"),
        ("BPFI", "ball_pass_inner_frequency"),
        ("BSF", "ball_spin_frequency"),
    ];
    const PARTS: [(&str, &str); 2] = [("ball set", "ball_set"), ("cage", "cage")];
    let kinematics = &summary["kinematics"];
    let sections: Vec<(String, &Value)> = match kinematics.as_object() {
        Some(_) if kinematics["inner_race_speed"].is_object() => vec![(String::new(), kinematics)],
        Some(named) => named.iter().map(|(name, of)| (format!("{name} "), of)).collect(),
        None => Vec::new(),
    };
    let value = |of: &Value, key: &str| of[key]["value"].as_f64();
    let mut lines = Lines::new();
    for (name, of) in sections {
        let found = |(label, key): &(&str, &str)| Some((label.to_string(), value(of, key)?));
        let mut frequencies: Vec<(String, f64)> = LINES.iter().filter_map(found).collect();
        if let Some(spin) = value(of, "ball_spin_frequency") {
            frequencies.push(("2 BSF".into(), 2.0 * spin));
        }
        let texts: Vec<_> = frequencies.iter().map(|(l, f)| format!("{l} {f:.3} Hz")).collect();
        if !texts.is_empty() {
            lines.push((format!("{name}frequencies"), texts.join(", ")));
        }
        for (label, key) in PARTS {
            let Some(frequency) = value(of, &format!("{key}_frequency")) else { continue };
            let slip = value(of, &format!("{key}_slip"))
                .map_or(String::new(), |slip| format!(", slip {:.3} %", 1e2 * slip));
            lines.push((format!("{name}{label}"), format!("{frequency:.3} Hz{slip}")));
        }
    }
    let friction = &summary["friction"];
    // None without traction.
    if let Some(power) = value(friction, "power_loss").filter(|power| *power != 0.0) {
        let torque = value(friction, "torque")
            .map_or(String::new(), |torque| format!(", friction torque {:.4} N mm", 1e3 * torque));
        lines.push((
            "friction".into(),
            format!("power loss {} W{torque}", plain(to_digits(power, 5))),
        ));
    }
    let channels = summary["spectra"]["channels"].as_object();
    for (channel, of) in channels.into_iter().flatten() {
        let highest = &of["peaks"][0];
        let (Some(frequency), Some(amplitude)) =
            (value(highest, "frequency"), value(highest, "amplitude"))
        else {
            continue;
        };
        let unit = highest["amplitude"]["unit"].as_str().unwrap_or("");
        let text =
            format!("highest peak {frequency:.3} Hz, {} {unit}", plain(to_digits(amplitude, 5)));
        lines.push((format!("spectrum {channel}"), text));
    }
    lines.iter().map(|(label, value)| format!("{label:<22} {value}\n")).collect()
}

/// Largest force of each support along each axis, and its value at the end.
fn of_supports(session: &Session, table: &RunTable, has_maxwell: bool, lines: &mut Lines) {
    for support in &session.recorder.supports {
        for axis in support.axes().into_iter().map(|axis| ["x", "y", "z"][axis]) {
            let column = format!("reaction_{}_{axis}", support.name);
            let (most, all) = (largest(table, &column), table.all(&column).unwrap_or_default());
            let last = all.last().copied().unwrap_or(0.0);
            let text = format!("{most:.6} N at most, {last:.6} N at the end");
            lines.push((format!("{} along {axis}", support.name), text));
        }
    }
    let lost = table.all("energy_viscous").unwrap_or_default();
    if let Some(lost) = lost.last().filter(|_| has_maxwell) {
        lines.push((
            "viscous energy".into(),
            format!("{lost:.6} J at the end, stored or dissipated"),
        ));
        let last = |name: &str| table.all(name).and_then(|all| all.last().copied()).unwrap_or(0.0);
        let of = ["maxwell", "dissipated", "finite_strain", "residual"];
        let [springs, dashpots, beyond, rest] = of.map(|of| last(&format!("energy_{of}")));
        let text = format!(
            "{springs:.6} J in Maxwell springs, {dashpots:.6} J dissipated; {beyond:.3e} J by finite strain, {rest:.3e} J \
             unaccounted for"
        );
        lines.push(("by small strain".into(), text));
    }
}

fn of_bore(table: &RunTable, name: &Option<String>) -> (String, String) {
    let of = prefix(name);
    let largest = |column: &str| largest(table, &format!("{of}{column}"));
    let deepest = 1e6 * largest("bore_deepest_penetration");
    let touching = largest("bore_nodes_touching");
    let pressure = 1e-6 * largest("bore_peak_pressure");
    let text = format!(
        "penetration up to {deepest:.6} um, up to {touching} contact nodes, pressure up to \
         {pressure:.4} MPa, {PEAK_PRESSURE}"
    );
    (format!("{}bore", of.replace('_', " ")), text)
}

/// Largest absolute value of a column over all rows.
fn largest(table: &RunTable, name: &str) -> f64 {
    table.all(name).unwrap_or_default().iter().fold(0.0f64, |a, b| a.max(b.abs()))
}

fn effort(sequence: &QuasiStaticSequence, seconds: f64) -> String {
    let effort = &sequence.effort;
    format!(
        "{} in {seconds:.2} s, {} iterations, {} changes of contact, relative residual up to \
         {:.1e}",
        sequence.found, effort.iterations, effort.contact_changes, effort.largest_residual
    )
}

fn race_displacements(table: &RunTable, of: &str, lines: &mut Lines) {
    for race in ["inner", "outer"] {
        let [y, z] = ["y", "z"].map(|axis| table.all(&format!("{of}{race}_{axis}")));
        let (Some(y), Some(z)) = (y, z) else { continue };
        let most = y.iter().zip(&z).map(|(y, z)| libm::hypot(*y, *z)).fold(0.0, f64::max);
        let text = format!("{:.6} um across the axis", 1e6 * most);
        lines.push((format!("{}{race} race, farthest", of.replace('_', " ")), text));
    }
}

fn of_bearing(simulation: &Simulation, table: &RunTable, lines: &mut Lines) {
    let mut line = |label: &str, value: String| lines.push((label.into(), value));
    let names = ["inner_x", "inner_y", "inner_z"];
    if let [Some(x), Some(y), Some(z)] = names.map(|name| table.windowed(name))
        && !x.is_empty()
    {
        let mean = [x, y, z].map(|values| 1e6 * values.iter().sum::<f64>() / values.len() as f64);
        let [x, y, z] = mean.map(|value| format!("{value:.6}"));
        line("inner race, mean", format!("{x}, {y}, {z} um (x, y, z over the window)"));
    }
    for (extremes, bearing) in simulation.extremes.iter().zip(&simulation.system.assembly.bearings)
    {
        let of = bearing.name.as_ref().map_or(String::new(), |name| format!("{name} "));
        let farthest = &extremes.farthest;
        let at = display_time(farthest.time);
        let place = format!("{:.6} um at t = {at} s", 1e6 * farthest.value);
        line(&format!("{of}inner race, farthest"), place);
        let [inner, outer] = extremes.races.map(|race| race.load);
        let (load, race) =
            if outer.value > inner.value { (outer, "outer") } else { (inner, "inner") };
        if load.value > 0.0 {
            let (ball, at) = (load.ball + 1, display_time(load.time));
            let value = format!("{:.6} N, ball {ball}, {race} race, at t = {at} s", load.value);
            line(&format!("{of}largest ball load"), value);
        }
        let between = &extremes.between_balls;
        if between.value > 0.0 {
            let balls = bearing.geometry.ball_count;
            let (one, other) = (between.ball + 1, (between.ball + 1) % balls + 1);
            let at = display_time(between.time);
            let value = format!("{:.6} N, balls {one} and {other}, at t = {at} s", between.value);
            line(&format!("{of}largest between balls"), value);
        }
    }
    if table.all("energy_residual").is_some() {
        let most = largest(table, "energy_residual").max(simulation.largest_residual());
        line("energy unaccounted for", format!("{most:.3e} J at most"));
    }
    let shortened = simulation.step_watch.shortened;
    if shortened > 0 {
        let size = simulation.step_size;
        line(
            "step",
            format!("shortened {shortened} times where contacts got stiffer, to {size:.4e} s"),
        );
    }
}
