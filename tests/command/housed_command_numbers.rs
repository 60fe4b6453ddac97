//! What commands on a bearing in its housing write, against closed forms and the balance of forces,
//! moments and momentum; and what `plan` says of it.

use crate::housed_command_common;

use housed_command_common::*;
use serde_json::Value;
use std::f64::consts::PI;
use std::path::Path;

fn value(of: &Value) -> f64 {
    of["value"].as_f64().unwrap_or(f64::NAN)
}

fn last(path: &Path, name: &str) -> f64 {
    *column(path, name).last().unwrap()
}

/// Radius of the balls of the bearing: what its clearance leaves, m.
const BALL: f64 = 0.5 * (31.953e-3 - 20.047e-3 + 4e-6);

/// A race narrower than its bore, a load that grows slowly against all frequencies.
fn explicit(numerics: &str) -> String {
    let housing = "method = \"explicit\"\nfit.radial = \"2 um\"\nfit_ramp = \"0.3 ms\"\n\
                   width = \"18 mm\"";
    let law = "[contact_damping]\nlaw = \"hunt-crossley\"\nalpha = \"2 s/m\"\n";
    scene_text(housing, &format!("{law}[numerics]\n{numerics}\n"))
        .replace(
            "z = { load = \"-250 N\" }",
            "z = { load = { smooth_ramp = [\"0 N\", \"-250 N\"], duration = \"1.5 ms\" } }",
        )
        .replace("77 1/s", "4000 1/s")
        .replace("axial = 2", "axial = 4")
}

#[test]
fn explicit_results_agree_with_the_loads_and_with_each_other() {
    let place = Place::new();
    let text = explicit("end = \"2.5 ms\"\noutput_interval = \"50 us\"");
    let out = place.path("out");
    succeed(into_folder("run", &place.scene("scene.toml", &text), &out, &[]));
    let (series, bore) = (out.join("series.csv"), out.join("bore.csv"));
    // All that the load gave the bearing the housing has taken, but what still swings.
    let given = 250.0 * (0.5 * 1.5e-3 + 1e-3);
    let impulse = last(&series, "housing_impulse_on_outer_z");
    assert!((impulse / given - 1.0).abs() <= 5e-3, "{impulse} {given}");
    // The middle three of five layers of nodes lie under the race.
    let places = column(&bore, "x");
    assert_eq!(places.len(), 3 * 24, "{places:?}");
    assert!(places.iter().all(|x| x.abs() <= 9e-3), "{places:?}");
    assert_eq!(last(&series, "bore_nodes_touching"), 72.0);
    // Pressure is the stiffness of the seat times penetration.
    let penetration = column(&bore, "penetration");
    for (pressure, sunk) in column(&bore, "pressure").iter().zip(&penetration) {
        assert!((pressure / (2.5e14 * sunk) - 1.0).abs() <= 1e-9, "{pressure} {sunk}");
    }
    let deepest = penetration.iter().copied().fold(0.0, f64::max);
    let seen = last(&series, "bore_deepest_penetration");
    assert!((deepest / seen - 1.0).abs() <= 1e-9, "{deepest} {seen}");
    let force: f64 = column(&bore, "force_z").iter().sum();
    let on_outer = last(&series, "housing_force_on_outer_z");
    assert!((force + on_outer).abs() <= 1e-9 * 250.0, "{force} {on_outer}");
    // The energy turned over: no less than any entry of the ledger, no more than all of them.
    let header = std::fs::read_to_string(&series).unwrap();
    let names = header.lines().next().unwrap().split(',');
    let names = names.filter(|name| name.starts_with("energy_") || name.starts_with("work_"));
    let names = names.filter(|name| !name.contains("residual"));
    let entries: Vec<f64> = names
        .map(|name| {
            let values = column(&series, name.split(' ').next().unwrap());
            values.iter().fold(0.0f64, |most, value| most.max(value.abs()))
        })
        .collect();
    let energy = &json(out.join("summary.json"))["energy"];
    let turned_over = value(&energy["turned_over"]);
    let (largest, sum) = (entries.iter().copied().fold(0.0, f64::max), entries.iter().sum::<f64>());
    assert!(
        turned_over >= 0.999 * largest && turned_over <= 1.001 * sum,
        "{turned_over} {entries:?}"
    );
    let residual = column(&series, "energy_coupled_residual");
    let residual = residual.iter().fold(0.0f64, |most, value| most.max(value.abs()));
    let part = value(&energy["largest_residual_part"]) * turned_over;
    assert!((part / residual - 1.0).abs() <= 1e-6, "{part} {residual}");
}

#[test]
fn a_run_ends_where_more_energy_is_missing_than_allowed() {
    let place = Place::new();
    let out = place.path("out");
    let run = |limit: f64| {
        let numerics =
            format!("end = \"0.5 ms\"\noutput_interval = \"10 us\"\nenergy_limit = {limit:e}");
        let scene = place.scene("scene.toml", &explicit(&numerics));
        into_folder("run", &scene, &out, &["--fresh"]).output().unwrap()
    };
    assert_eq!(run(1e-3).status.code(), Some(0));
    let part = value(&json(out.join("summary.json"))["energy"]["largest_residual_part"]);
    assert!(part > 0.0 && part <= 1e-4, "{part}");
    assert_eq!(run(2.0 * part).status.code(), Some(0));
    let limit = 0.01 * part;
    let refused = run(limit);
    let message = stderr(&refused);
    assert_eq!(refused.status.code(), Some(2), "{message}");
    assert!(message.contains("unaccounted for at t = "), "{message}");
    let stated = message.split("more than ").nth(1).and_then(|rest| rest.split(' ').next());
    let stated: f64 = stated.unwrap().parse().unwrap();
    assert!((stated / limit - 1.0).abs() <= 1e-9, "{message}");
}

/// The housing takes the moment on the inner race, and what its force has of a lever.
#[test]
fn the_housing_turns_against_the_load() {
    let place = Place::new();
    let load = |further: &str| {
        let text = scene_text("fit.radial = \"2 um\"", further);
        let text =
            text.replace("tilt_y = { tilt = \"0 deg\" }", "tilt_y = { moment = \"0.5 N m\" }");
        place.scene("scene.toml", &text)
    };
    let expected = |[x, y, z]: [f64; 3], [u, v, w]: [f64; 3]| {
        let (along, _, _) = (x - u, y - v, z - w);
        // M + r × F about Y with F = −250 N along Z; Euler angles of 1e-3 rad.
        -(0.5 + 250.0 * along)
    };
    let out = place.path("statics");
    succeed(into_folder("statics", &load(""), &out, &[]));
    let summary = json(out.join("summary.json"));
    let at = |of: &Value| ["x", "y", "z"].map(|axis| value(&of[axis]));
    let housing = &summary["housing"];
    let moment = value(&housing["moment_on_outer"]["y"]);
    let should = expected(at(&summary["inner_race"]["position"]), at(&housing["outer_race"]));
    assert!((moment - should).abs() <= 1e-3 * 0.5, "{moment} {should}");
    let out = place.path("run");
    let run = load("[numerics]\nend = \"1 ms\"\noutput_interval = \"1 ms\"\n");
    succeed(into_folder("run", &run, &out, &[]));
    let series = out.join("series.csv");
    let at = |race: &str| ["x", "y", "z"].map(|axis| last(&series, &format!("{race}_{axis}")));
    let moment = last(&series, "housing_moment_on_outer_y");
    let should = expected(at("inner"), at("outer"));
    assert!((moment - should).abs() <= 1e-3 * 0.5, "{moment} {should}");
}

/// m r ω² of a ball that goes round with the cage, in equilibria over time; `statics` is not asked.
#[test]
fn balls_press_outwards_in_a_run_and_not_in_statics() {
    let place = Place::new();
    let scene = |speed: &str| {
        let run = "[numerics]\nend = \"1 ms\"\noutput_interval = \"1 ms\"\n";
        let text = scene_text("fit.radial = \"2 um\"", run)
            .replace("[outer_race]\nmotion", &format!("speed = \"{speed}\"\n[outer_race]\nmotion"));
        place.scene("scene.toml", &text)
    };
    let mass = 7850.0 * 4.0 / 3.0 * PI * BALL.powi(3);
    let pitch = 0.5 * (20.047e-3 + 31.953e-3);
    let cage = 0.5 * (1.0 - BALL / pitch) * 2000.0 / 60.0 * 2.0 * PI;
    let force = mass * pitch * cage * cage;
    for (speed, pushed, says) in [
        (
            "2000 rpm",
            force,
            "does  centrifugal force on balls   in `run`, because the cage rotates; \
                             `statics` omits it",
        ),
        ("0 rpm", 0.0, "skips centrifugal force on balls   not requested"),
    ] {
        let out = place.path(&speed.replace(' ', "_"));
        succeed(into_folder("run", &scene(speed), &out, &[]));
        for ball in 1..=8 {
            let load =
                |race: &str| last(&out.join("series.csv"), &format!("ball_{ball}_{race}_load"));
            let found = load("outer") - load("inner");
            // Contact angles, and the ball's way of some µm from the pitch circle.
            assert!((found - pushed).abs() <= 5e-3 * force, "{speed}: {found} {pushed}");
        }
        let said = succeed(command("plan", &scene(speed), &[]));
        assert!(said.contains(says), "{said}");
        let plan = json(out.join("summary.json"))["plan"].to_string();
        assert!(plan.contains(says), "{plan}");
    }
    let out = place.path("statics");
    succeed(into_folder("statics", &scene("2000 rpm"), &out, &[]));
    let loads = |name: &str| column(&out.join("series.csv"), name);
    for (outer, inner) in loads("outer_load").iter().zip(loads("inner_load")) {
        assert!((outer - inner).abs() <= 5e-3 * force, "{outer} {inner}");
    }
}

/// A race far from its bore: nodes come into reach on the way, and the plan does not deny it.
#[test]
fn a_plan_counts_nodes_in_reach_at_the_start_only() {
    let place = Place::new();
    let scene = place.scene(
        "scene.toml",
        &scene_text(
            "method = \"explicit\"\nfit.radial = \"-100 um\"",
            "[numerics]\nend = \"0.8 ms\"\noutput_interval = \"0.1 ms\"\n",
        ),
    );
    let said = succeed(command("plan", &scene, &[]));
    let expected = "at the start 0 bore nodes tested for contact, 72 too far away, sorted again after each \
                    motion of race and bore by 35.5 um";
    assert!(said.contains(expected), "{said}");
    let out = place.path("out");
    succeed(into_folder("run", &scene, &out, &[]));
    let work = &json(out.join("summary.json"))["work"];
    assert!(work["sorts_by_reach"].as_u64() > Some(1), "{work}");
    assert!(work["bore_node_tests"].as_u64() > Some(0), "{work}");
    // All in reach, nothing to sort.
    let tight = scene_text(
        "method = \"explicit\"\nfit.radial = \"1 um\"",
        "[numerics]\nend = \"0.1 ms\"\noutput_interval = \"0.1 ms\"\n",
    );
    let said = succeed(command("plan", &place.scene("tight.toml", &tight), &[]));
    assert!(
        said.contains("at the start 72 bore nodes tested for contact, 0 too far away\n"),
        "{said}"
    );
}

/// The number that stands before `words` in what is said.
fn count_before(said: &str, words: &str) -> u64 {
    let (before, _) = said.split_once(words).unwrap_or_else(|| panic!("no {words:?}: {said}"));
    let number = before.rsplit([' ', '\n']).next().unwrap();
    number.parse().unwrap_or_else(|error| panic!("{number} before {words:?}: {error}"))
}

/// Numbers in 0 … 1.
fn some_numbers() -> impl FnMut() -> f64 {
    let mut state = 7u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Windows, steps of the housing in each, their length and the end, foretold and taken: for the scene
/// that is shipped and for random ends, rows and stiffnesses of the contact.
#[test]
fn a_plan_foretells_the_windows_of_a_run() {
    let place = Place::new();
    let mut random = some_numbers();
    let mut scenes = vec![shipped("housing_impact.toml")];
    for (index, stiffness) in [2.5e14, 2.5e14, 4e15, 4e15, 1e18].into_iter().enumerate() {
        let interval = 2.0 + 20.0 * random();
        let rows = 1.0 + (4.0 * random()).floor();
        let off = [0.0, 0.2, -0.3][index % 3];
        let numerics = format!(
            "[numerics]\nend = \"{} us\"\noutput_interval = \"{interval} us\"\n",
            interval * (rows + off)
        );
        let housing = format!(
            "method = \"explicit\"\nfit.radial = \"1 um\"\ncontact.stiffness = \"{stiffness} N/m^3\""
        );
        scenes.push(place.scene(&format!("{index}.toml"), &scene_text(&housing, &numerics)));
    }
    for (index, scene) in scenes.iter().enumerate() {
        let plan = succeed(command("plan", scene, &[]));
        let out = place.path(&format!("out-{index}"));
        succeed(into_folder("run", scene, &out, &[]));
        let summary = json(out.join("summary.json"));
        let windows = count_before(&plan, " coupling steps of ");
        let (_, after) = plan.split_once(" coupling steps of ").unwrap();
        let each = match after.contains(", each one step of the housing") {
            true => 1,
            false => count_before(after, " steps of the housing"),
        };
        let (work, step) = (&summary["work"], &summary["step"]);
        assert_eq!(work["windows"], windows, "{plan}");
        assert_eq!(step["housing_steps_per_coupling_step"], each, "{plan}");
        assert_eq!(work["housing_steps"], windows * each, "{plan}");
        let window = value(&step["coupling_step"]);
        assert!(after.starts_with(&format!("{window:.3e} s")), "{window} s: {plan}");
        let time = windows as f64 * window;
        let end = last(&out.join("series.csv"), "time");
        assert!((end / time - 1.0).abs() <= 1e-12, "{end} {time}: {plan}");
        let limit = value(&step["housing_limit"]["step"]);
        assert!(plan.contains(&format!("(limit {limit:.3e} s)")), "{limit}: {plan}");
    }
}

/// The same of courses: equilibria, one a row.
#[test]
fn a_plan_foretells_the_equilibria_of_a_course() {
    let place = Place::new();
    let mut random = some_numbers();
    let mut scenes: Vec<_> = ["housing_a_rotating_load", "interference_fit"]
        .map(|name| shipped(&format!("{name}.toml")))
        .into();
    for (index, off) in [0.0, 0.2, -0.3, 0.0].into_iter().enumerate() {
        let interval = 0.1 + random();
        let rows = 1.0 + (12.0 * random()).floor();
        let numerics = format!(
            "[numerics]\nend = \"{} ms\"\noutput_interval = \"{interval} ms\"\n",
            interval * (rows + off)
        );
        scenes.push(
            place.scene(&format!("{index}.toml"), &scene_text("fit.radial = \"1 um\"", &numerics)),
        );
    }
    for (index, scene) in scenes.iter().enumerate() {
        let plan = succeed(command("plan", scene, &[]));
        let out = place.path(&format!("out-{index}"));
        let said = succeed(into_folder("run", scene, &out, &[]));
        let foretold = count_before(&plan, " equilibria to t = ");
        assert_eq!(json(out.join("summary.json"))["work"]["equilibria"], foretold, "{plan}");
        assert_eq!(column(&out.join("series.csv"), "time").len() as u64, foretold, "{plan}");
        // And to the same time.
        let until = |said: &str| {
            let (_, after) = said.split_once(" equilibria to t = ").unwrap();
            after.split_once(" s,").unwrap().0.to_string()
        };
        assert_eq!(until(&plan), until(&said));
        let time: f64 = until(&plan).parse().unwrap();
        let end = last(&out.join("series.csv"), "time");
        assert!((end / time - 1.0).abs() <= 1e-8, "{end} {time}");
    }
}
