//! Sensors of a run: columns, spectra, pictures, and what is said of them.

use crate::command_line_common::{changed, done, files, json, read, scene, text, write};
use std::collections::BTreeMap;
use std::path::Path;
use tempfile::tempdir;

/// The shipped scene with a soon end.
fn short(end: &str) -> String {
    let mut content = read(Path::new(&scene("cage_telemeter.toml")));
    for (from, to) in [
        ("end = \"1.5 s\"", format!("end = \"{end}\"")),
        ("window_start = \"0.3 s\"", "window_start = \"1 ms\"".to_string()),
        ("[\"0 rpm\", \"600 rpm\"]", "[\"600 rpm\", \"610 rpm\"]".to_string()),
        ("output_interval = \"0.15 ms\"", "output_interval = \"0.1 ms\"".to_string()),
    ] {
        content = changed(&content, from, &to);
    }
    content
}

#[test]
fn sensors_have_columns_spectra_and_pictures() {
    let root = tempdir().unwrap();
    let path = write(root.path(), "a.toml", &short("6 ms"));
    let out = root.path().join("out");
    let planned = done(&["plan", &path]);
    assert!(
        planned.contains("sensors") && planned.contains("telemeter, top: read at every output")
    );
    let checked = done(&["check", &path]);
    assert!(
        checked.contains("sensor telemeter") && checked.contains("natural frequency 34.50"),
        "{checked}"
    );
    let understood: serde_json::Value =
        serde_json::from_str(&done(&["check", &path, "--json"])).unwrap();
    assert_eq!(understood["scene"]["sensor"]["telemeter"]["kind"], "telemeter", "{understood}");
    done(&["run", &path, "--out", &text(&out)]);
    let columns = read(&out.join("series.columns.json"));
    for column in ["telemeter_reflection", "top_acceleration"] {
        assert!(columns.contains(column), "{columns}");
    }
    let written = files(&out);
    for file in [
        "series_sensor_telemeter.svg",
        "series_sensor_top.svg",
        "spectrum_sensor_telemeter.svg",
        "spectrum_sensor_top.svg",
    ] {
        assert!(written.iter().any(|other| other == file), "{written:?}");
    }
    let summary = json(&out.join("summary.json"));
    let last = &summary["final"]["telemeter_reflection"];
    assert!(last["unit"] == "1" && last["value"].as_f64().unwrap() < 1.0, "{last}");
    assert_eq!(summary["final"]["top_acceleration"]["unit"], "m/s^2");
    // Once a row, as the plan says.
    let stages = summary["stages"].as_array().unwrap();
    let sensors = stages.iter().find(|stage| stage["stage"] == "sensors").expect("sensors");
    assert_eq!(sensors["ran"], summary["output"]["rows"], "{sensors}");

    // The way there does not show.
    let half = write(root.path(), "b.toml", &short("3 ms"));
    let halves = root.path().join("halves");
    done(&["run", &half, "--out", &text(&halves)]);
    done(&["run", &path, "--out", &text(&halves), "--resume"]);
    assert_eq!(read(&out.join("series.csv")), read(&halves.join("series.csv")));

    // Sensors change nothing of the motion.
    let content = short("6 ms");
    let (first, end) = (content.find("[sensor.").unwrap(), content.find("[numerics]").unwrap());
    let without = format!("{}{}", &content[..first], &content[end..]);
    let without = write(root.path(), "c.toml", &without);
    let alone = root.path().join("alone");
    done(&["run", &without, "--out", &text(&alone)]);
    let (with, alone) = (read(&out.join("series.csv")), read(&alone.join("series.csv")));
    for (with, alone) in with.lines().zip(alone.lines()) {
        assert!(with.starts_with(alone), "{with}\n{alone}");
    }
}

/// Sampling, filter and envelope act on spectra alone; defect lines are in the summary and in the pictures.
#[test]
fn acquisition_and_defect_lines_are_in_spectra_alone() {
    let root = tempdir().unwrap();
    let sensor = "[sensor.side]\nkind = \"accelerometer\"\non = \"outer_race\"\ndirection = \"fixed\"\n\
                  azimuth = \"-45 deg\"\nsampling = \"2 kHz\"\nlow_pass = \"1.5 kHz\"\n\
                  envelope_band = [\"100 Hz\", \"900 Hz\"]\n\n[numerics]";
    let content = changed(&short("60 ms"), "[numerics]", sensor);
    let path = write(root.path(), "a.toml", &content);
    let out = root.path().join("out");
    let checked = done(&["check", &path]);
    assert!(
        checked.contains("fixed direction, azimuth -45.00 deg, elevation 0.00 deg"),
        "{checked}"
    );
    done(&["run", &path, "--out", &text(&out)]);
    let written = files(&out);
    for file in [
        "spectrum_side_acceleration.csv",
        "spectrum_side_acceleration_envelope.csv",
        "spectrum_envelope_side.svg",
        "spectrum_sensor_side.svg",
    ] {
        assert!(written.iter().any(|other| other == file), "{written:?}");
    }
    let spectrum = read(&out.join("spectrum.csv"));
    assert!(spectrum.contains("top_acceleration") && !spectrum.contains("side_acceleration"));
    let summary = json(&out.join("summary.json"));
    let spectra = &summary["spectra"];
    let side = &spectra["channels"]["side_acceleration"];
    assert_eq!(side["sampling"]["value"], 2000.0, "{side}");
    assert_eq!(side["low_pass"]["value"], 1500.0, "{side}");
    assert!(spectra["channels"]["top_acceleration"]["low_pass"].is_null());
    let envelope = &spectra["channels"]["side_acceleration_envelope"];
    assert_eq!(envelope["envelope_band"][1]["value"], 900.0, "{envelope}");
    // 11 balls: BPFO is 11 times FTF; the outer race does not rotate.
    let lines = &spectra["lines"]["bearings"][0]["frequencies"];
    let frequency = |name: &str| lines[name]["value"].as_f64().unwrap();
    assert!((frequency("BPFO") / frequency("FTF") - 11.0).abs() <= 1e-9, "{lines}");
    assert!((frequency("BPFO") + frequency("BPFI") - 11.0 * frequency("shaft")).abs() <= 1e-9);
    assert!(lines["outer race"].is_null(), "{lines}");
    let at = &side["lines"]["3 BPFO"];
    let (bin, width) = (&at["bin_frequency"]["value"], &side["bin_width"]["value"]);
    let off = (bin.as_f64().unwrap() - frequency("3 BPFO")) / width.as_f64().unwrap();
    assert!(off.abs() <= 1.5 && at["amplitude"]["unit"] == "m/s^2", "{at}");
    assert!(at["bins_from_nearest"].is_i64() && at["not_separated_from"].is_array(), "{at}");
    let picture = read(&out.join("spectrum_sensor_top.svg"));
    assert!(picture.contains("BPFI") && picture.contains("side lobes -31 dB"));

    // The same rows, filtered or not; a run without these keys replaces the files.
    let plain = content.replace("sampling = \"2 kHz\"\nlow_pass = \"1.5 kHz\"\n", "");
    let plain = plain.replace("envelope_band = [\"100 Hz\", \"900 Hz\"]\n", "");
    let rows = read(&out.join("series.csv"));
    let path = write(root.path(), "b.toml", &plain);
    done(&["run", &path, "--out", &text(&out)]);
    assert_eq!(read(&out.join("series.csv")), rows);
    let written = files(&out);
    assert!(!written.iter().any(|file| file.contains("envelope")), "{written:?}");
    assert!(!written.iter().any(|file| file == "spectrum_side_acceleration.csv"), "{written:?}");
    assert!(read(&out.join("spectrum.csv")).contains("side_acceleration"));
}

/// Each reading at a line is the amplitude in the written bin of the spectrum, the highest of the nearest bin and its
/// neighbours.
#[test]
fn readings_at_lines_are_those_of_their_bins() {
    let root = tempdir().unwrap();
    let path = write(
        root.path(),
        "scene.toml",
        "[bearing]\nkind = \"deep-groove\"\nballs = 9\npitch_radius = \"19.25 mm\"\nclearance = { radial = \"10 um\" }\n\
         inner_race = { conformity = 0.515 }\nouter_race = { conformity = 0.525 }\nball = { diameter = \"7.938 mm\" }\n\
         [inner_race]\nspeed = \"9000 rpm\"\nx = { load = \"100 N\" }\nz = { load = \"-500 N\" }\n\
         [outer_race]\nmotion = \"5-dof\"\n[outer_race.foundation]\nstiffness = { x = \"1e8 N/m\", y = \"1e8 N/m\", \
         z = \"1e8 N/m\", tilt_y = \"1e5 N m/rad\", tilt_z = \"1e5 N m/rad\" }\n\
         [sensor.top]\nkind = \"accelerometer\"\non = \"outer_race\"\nradius = \"30 mm\"\nangle = \"90 deg\"\nsampling = \"10 kHz\"\n\
         [traction]\nlaw = \"none\"\n[numerics]\nend = \"50 ms\"\noutput_interval = \"50 us\"\naccuracy = 1e-3\n\
         [output]\nplots = [\"spectrum\"]\nchannels = [\"races\"]\nwindow_start = \"10 ms\"\n",
    );
    let out = root.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    let spectra = &json(&out.join("summary.json"))["spectra"];
    let number = |of: &serde_json::Value| of["value"].as_f64().unwrap_or_else(|| panic!("{of}"));
    let mut offsets = BTreeMap::new();
    for (channel, of) in spectra["channels"].as_object().unwrap() {
        let sampled = channel == "top_acceleration";
        let file = if sampled { "spectrum_top_acceleration.csv" } else { "spectrum.csv" };
        let table = read(&out.join(file));
        let mut lines = table.lines();
        let names = lines.next().unwrap().split(',');
        let column = names.map(|name| name.split(' ').next().unwrap()).position(|of| of == channel);
        let rows: Vec<[f64; 2]> = lines
            .map(|line| {
                let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
                [cells[0], cells[column.expect(channel)]]
            })
            .collect();
        let width = rows[1][0];
        for (line, at) in of["lines"].as_object().unwrap() {
            let frequency = number(&spectra["lines"]["bearings"][0]["frequencies"][line]);
            let nearest = (frequency / width).round() as usize;
            let bin = (number(&at["bin_frequency"]) / width).round() as usize;
            // Decimal digits of a frequency.
            let error = (rows[bin][0] / number(&at["bin_frequency"]) - 1.0).abs();
            assert!(error <= 1e-12, "{channel} {line}: {at} {}", rows[bin][0]);
            let offset = bin as i64 - nearest as i64;
            assert_eq!(at["bins_from_nearest"], offset, "{channel} {line}: {at} {frequency}");
            let highest =
                rows[nearest - 1..=nearest + 1].iter().map(|row| row[1]).fold(0.0, f64::max);
            let amplitude = number(&at["amplitude"]);
            assert!(amplitude == rows[bin][1] && amplitude == highest, "{channel} {line}: {at}");
            *offsets.entry(offset).or_insert(0) += 1;
        }
    }
    // Bins on both sides of the nearest one, many times.
    let often = [-1, 0, 1].map(|offset| offsets.get(&offset).copied().unwrap_or(0));
    assert!(often.iter().all(|count| *count >= 5) && offsets.len() == 3, "{offsets:?}");
}

/// Both offsets are vectors of their own: across each other they are not as along each other.
#[test]
fn each_offset_of_a_telemeter_has_its_own_angle() {
    let root = tempdir().unwrap();
    let first = |offset: &str, runout: &str| {
        let angles = format!(
            "offset = \"1.27 mm\"\noffset_angle = \"{offset}\"\nrunout = \"1.27 mm\"\nrunout_angle = \"{runout}\""
        );
        let content = changed(&short("2 ms"), "offset = \"1.27 mm\"\nrunout = \"0.1 mm\"", &angles);
        let path = write(root.path(), "angles.toml", &content);
        let out = root.path().join(format!("{offset}{runout}"));
        done(&["run", &path, "--out", &text(&out)]);
        let rows = read(&out.join("series.csv"));
        let mut lines = rows.lines().map(|line| line.split(',').collect::<Vec<_>>());
        let names = lines.next().unwrap();
        let at = names.iter().position(|name| name.starts_with("telemeter_reflection")).unwrap();
        lines.next().unwrap()[at].parse::<f64>().unwrap()
    };
    let [along, across, other] =
        [["0 deg", "0 deg"], ["0 deg", "90 deg"], ["90 deg", "0 deg"]].map(|[a, b]| first(a, b));
    // The cage has not turned yet: only the distance of the two axes counts, 0 or √2 · 1.27 mm.
    assert!((across - other).abs() <= 1e-3 * (across - along).abs(), "{along} {across} {other}");
    assert!((across - along).abs() >= 1e-4, "{along} {across}");
    let turned = first("90 deg", "90 deg");
    assert!((turned - along).abs() <= 1e-3 * (across - along).abs(), "{along} {turned}");
}

/// The whirl of a cage is about the axis of an outer race that moves.
#[test]
fn whirl_of_a_cage_follows_from_its_columns() {
    let root = tempdir().unwrap();
    let content = changed(
        &short("20 ms"),
        "x = { load = \"-445 N\" }\n",
        "x = { load = \"-445 N\" }\nz = { load = \"-200 N\" }\n",
    );
    let content =
        content.replace("y = \"1e8 N/m\"\nz = \"1e8 N/m\"", "y = \"1e6 N/m\"\nz = \"1e6 N/m\"");
    let path = write(root.path(), "soft.toml", &content);
    let out = root.path().join("out");
    done(&["run", &path, "--out", &text(&out)]);
    let rows = read(&out.join("series.csv"));
    let mut lines = rows.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = lines.next().unwrap();
    let index = |name: &str| names.iter().position(|own| own.starts_with(name)).unwrap();
    let at = ["time", "cage_y", "cage_z", "outer_y", "outer_z"].map(index);
    let window: Vec<[f64; 2]> = lines
        .map(|line| at.map(|i| line[i].parse::<f64>().unwrap()))
        .filter(|[time, ..]| *time >= 1e-3)
        .map(|[_, cage_y, cage_z, outer_y, outer_z]| [cage_y - outer_y, cage_z - outer_z])
        .collect();
    let count = window.len() as f64;
    let distance = window.iter().map(|[y, z]| y.hypot(*z)).sum::<f64>() / count;
    let mean = [0, 1].map(|i| window.iter().map(|at| at[i]).sum::<f64>() / count);
    let turned = |a: &[f64; 2], b: &[f64; 2]| {
        let by = b[1].atan2(b[0]) - a[1].atan2(a[0]);
        by - std::f64::consts::TAU * (by / std::f64::consts::TAU).round()
    };
    let turns: f64 = window.windows(2).map(|pair| turned(&pair[0], &pair[1])).sum();
    let summary = json(&out.join("summary.json"));
    let expected = [
        ("cage_mean_distance", distance),
        ("cage_rest", mean[0].hypot(mean[1]) / distance),
        ("cage_whirl_turns", turns / std::f64::consts::TAU),
    ];
    for (name, expected) in expected {
        let found = leaf(&summary, name).unwrap_or_else(|| panic!("{name}: {summary}"));
        // Nine digits of columns that are thousands of times the distance.
        assert!(
            (found - expected).abs() <= 1e-6 * expected.abs().max(1e-3),
            "{name}: {found} {expected}"
        );
    }
}

/// The number of this name, wherever it is in a summary.
fn leaf(of: &serde_json::Value, name: &str) -> Option<f64> {
    match of {
        serde_json::Value::Object(map) => {
            let own = map.get(name).and_then(|found| found["value"].as_f64());
            own.or_else(|| map.values().find_map(|below| leaf(below, name)))
        }
        _ => None,
    }
}
