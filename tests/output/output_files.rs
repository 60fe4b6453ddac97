//! Series, results folder, case pack and plots: what is written reads back, and nothing
//! unsound is written.

#[allow(dead_code)]
use crate::output_common;

use bearing_dynamics::equilibrium::statics::{Determinacy, StaticSolution};
use bearing_dynamics::output::atomic::{WriteError, remove_partials};
use bearing_dynamics::output::compare::tolerance::{ToleranceClass, Tolerances};
use bearing_dynamics::output::compare::{Options, compare, report};
use bearing_dynamics::output::pack::{
    About, Manifest, PackError, PackInput, verify_pack, write_pack,
};
use bearing_dynamics::output::results::{ResultsError, static_summary, write_static_results};
use bearing_dynamics::output::series::{Column, Series, SeriesError};
use bearing_dynamics::output::visible::{visible, visible_line};
use bearing_dynamics::plan::{Item, Stage, Subject};
use nalgebra::DVector;
use ndarray::Array2;
use output_common::{run, solution};
use proptest::prelude::*;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn bits(series: &Series) -> Vec<u64> {
    series.data().iter().map(|value| value.to_bits()).collect()
}

/// Any finite number: all magnitudes, subnormals, both zeros.
fn finite() -> impl Strategy<Value = f64> {
    any::<u64>().prop_map(f64::from_bits).prop_filter("finite", |value| value.is_finite())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn csv_and_npy_read_back_to_the_same_bits(
        columns in 1usize..6,
        values in prop::collection::vec(finite(), 0..60),
        name in "[a-zA-Z_,\"'.; µ°-]{0,12}",
        unit in "[a-zA-Z0-9/^.°µ]{0,6}",
    ) {
        let rows = values.len() / columns;
        let data = Array2::from_shape_vec((rows, columns), values[..rows * columns].to_vec()).unwrap();
        let names = (0..columns).map(|i| Column::new(format!("c{i}{name}x"), unit.clone())).collect();
        let series = Series::new(names, data).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let [csv, npy] = ["a.csv", "a.npy"].map(|name| folder.path().join(name));
        series.write_csv(&csv).unwrap();
        series.write_npy(&npy).unwrap();
        for read in [Series::read_csv(&csv).unwrap(), Series::read_npy(&npy).unwrap()] {
            prop_assert_eq!(read.columns(), series.columns());
            prop_assert_eq!(read.data().dim(), series.data().dim());
            prop_assert_eq!(bits(&read), bits(&series));
        }
    }

    #[test]
    fn readers_survive_noise(noise in prop::collection::vec(any::<u8>(), 0..200)) {
        let folder = tempfile::tempdir().unwrap();
        for name in ["a.csv", "a.npy", "a.json"] {
            let path = folder.path().join(name);
            let mut bytes = noise.clone();
            if name == "a.npy" {
                bytes.splice(0..0, *b"\x93NUMPY\x01\x00");
            }
            fs::write(&path, &bytes).unwrap();
            let _ = compare(&path, &path, &Options::default());
        }
    }
}

#[test]
fn names_that_cannot_be_read_back_are_refused() {
    let one = |column: Column| Series::new(vec![column], Array2::zeros((1, 1)));
    for name in ["", " x", "x ", "a[b]", "a]", "a\nb"] {
        assert!(
            matches!(one(Column::new(name, "m")), Err(SeriesError::ColumnName { .. })),
            "{name:?}"
        );
    }
    let twice = vec![Column::new("x", "m"), Column::new("x", "N")];
    assert!(Series::new(twice, Array2::zeros((1, 2))).is_err());
    let result = Series::new(vec![], Array2::zeros((1, 2)));
    assert!(matches!(result, Err(SeriesError::ColumnCount { columns: 0, width: 2 })));
}

#[test]
fn values_that_are_not_finite_are_not_written_and_leave_the_old_file() {
    let folder = tempfile::tempdir().unwrap();
    let [csv, npy] = ["a.csv", "a.npy"].map(|name| folder.path().join(name));
    let column = || vec![Column::new("x", "m")];
    let good = Series::new(column(), Array2::ones((2, 1))).unwrap();
    good.write_csv(&csv).unwrap();
    good.write_npy(&npy).unwrap();
    for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let bad = Series::new(column(), Array2::from_elem((2, 1), value)).unwrap();
        assert!(matches!(bad.write_csv(&csv), Err(SeriesError::NotFinite { row: 0, .. })));
        assert!(matches!(bad.write_npy(&npy), Err(SeriesError::NotFinite { row: 0, .. })));
    }
    assert_eq!(Series::read_csv(&csv).unwrap(), good);
    assert_eq!(Series::read_npy(&npy).unwrap(), good);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 3, "no temporary file is left");
}

#[test]
fn the_summary_holds_the_solution_with_units() {
    let solution = solution();
    let summary = static_summary(&solution, &run()).unwrap();
    let quantity = |pointer: &str| {
        let found = summary.pointer(pointer).unwrap_or_else(|| panic!("no {pointer}"));
        (found["value"].as_f64().unwrap(), found["unit"].as_str().unwrap().to_string())
    };
    assert_eq!(quantity("/inner_race/position/z"), (-8.9e-6, "m".into()));
    assert_eq!(quantity("/inner_race/position/tilt_y"), (1.1e-4f64.to_degrees(), "deg".into()));
    assert_eq!(quantity("/inner_race/loads/tilt_y"), (0.31, "N m".into()));
    assert_eq!(quantity("/outer_race/contact_force/z"), (-1500.0, "N".into()));
    assert_eq!(quantity("/stiffness/x/tilt_z"), (solution.stiffness[(0, 4)], "N/rad".into()));
    assert_eq!(quantity("/stiffness/tilt_z/x"), (solution.stiffness[(4, 0)], "N m/m".into()));
    assert_eq!(quantity("/seconds/solve"), (7.3e-5, "s".into()));
    let ball = &solution.balls[5];
    assert_eq!(quantity("/balls/5/outer/load"), (ball.outer.normal_load, "N".into()));
    assert_eq!(
        quantity("/balls/5/inner/force_on_race/y"),
        (ball.inner.force_on_race.y, "N".into())
    );
    assert_eq!(summary["solver"]["iterations"], 6);
    assert_eq!(summary["program"]["version"], env!("CARGO_PKG_VERSION"));
    assert_eq!(summary["determinacy"]["kind"], "determinate");
    let loaded = solution.balls.iter().filter(|ball| ball.inner.normal_load > 0.0).count();
    assert!(loaded > 0 && loaded < 8);
    assert_eq!(summary["load_zone"]["balls_loaded_inner"], loaded);
    assert_eq!(summary["assumptions"]["ball_phase"], "0 deg: not stated");
    assert_eq!(summary["contacts"]["inner"]["stiffness"]["unit"], "N/m^1.5");
}

#[test]
fn an_indeterminate_solution_says_so() {
    let mut solution = solution();
    let direction = DVector::from_vec(vec![0.0, 1.0, 0.0, 0.0, 0.0]);
    solution.determinacy = Determinacy::Indeterminate { free_directions: vec![direction] };
    let summary = static_summary(&solution, &run()).unwrap();
    assert_eq!(summary["determinacy"]["kind"], "indeterminate");
    assert_eq!(summary["determinacy"]["free_directions"][0]["y"]["value"], 1.0);
}

#[test]
fn series_and_summary_agree() {
    let folder = tempfile::tempdir().unwrap();
    let files = write_static_results(folder.path(), &solution(), &run()).unwrap();
    assert_eq!(files.len(), 4);
    assert!(files.iter().all(|file| file.exists()));
    let series = Series::read_npy(&folder.path().join("series.npy")).unwrap();
    let summary: Value =
        serde_json::from_slice(&fs::read(folder.path().join("summary.json")).unwrap()).unwrap();
    for (row, ball) in summary["balls"].as_array().unwrap().iter().enumerate() {
        for race in ["inner", "outer"] {
            for name in ["load", "approach", "contact_angle", "semi_major", "peak_pressure"] {
                let column = series.column(&format!("{race}_{name}")).unwrap();
                assert_eq!(ball[race][name]["value"].as_f64().unwrap(), column[row]);
            }
        }
    }
    let header = fs::read_to_string(folder.path().join("series.csv")).unwrap();
    assert!(header.starts_with("ball [1],azimuth [deg],"));
}

#[test]
fn a_solution_that_is_not_finite_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("results");
    type Alter = Box<dyn Fn(&mut StaticSolution)>;
    let mut alterations: Vec<Alter> = vec![
        Box::new(|s| s.coordinates[3] = f64::NAN),
        Box::new(|s| s.stiffness[(2, 1)] = f64::INFINITY),
        Box::new(|s| s.moment_on_outer.y = f64::NAN),
        Box::new(|s| s.residual = f64::NAN),
    ];
    for index in 0..3 {
        alterations.push(Box::new(move |s| s.balls[4].position[index] = f64::NAN));
        alterations.push(Box::new(move |s| s.balls[4].outer.force_on_race[index] = f64::NAN));
    }
    alterations.push(Box::new(|s| s.balls[7].inner.peak_pressure = f64::NAN));
    alterations.push(Box::new(|s| s.balls[7].inner.approach = f64::NEG_INFINITY));
    for alter in &alterations {
        let mut solution = solution();
        alter(&mut solution);
        let result = write_static_results(&target, &solution, &run());
        assert!(matches!(result, Err(ResultsError::NotFinite { .. })), "{result:?}");
    }
    let mut record = run();
    record
        .sections
        .push(("frequencies".into(), json!({ "bpfo": { "value": f64::NAN, "unit": "Hz" } })));
    let result = write_static_results(&target, &solution(), &record);
    assert!(matches!(result, Err(ResultsError::Null { .. })));
    record.sections = vec![("balls".into(), json!(1))];
    let result = write_static_results(&target, &solution(), &record);
    assert!(matches!(result, Err(ResultsError::SectionName { .. })));
    assert!(!target.exists());
}

fn about() -> About {
    let (kind, generated_by) = ("statics".into(), "this program".into());
    About { kind, tags: vec!["tilt".into()], level: 1, generated_by }
}

fn tolerances(class: ToleranceClass) -> Tolerances {
    Tolerances { class: Some(class), ..Tolerances::default() }
}

/// Writes a pack of the results of [`solution`] with this scene and these files.
fn pack(
    folder: &Path,
    scene: [&str; 2],
    files: &[(String, Vec<u8>)],
    class: ToleranceClass,
) -> Result<Manifest, PackError> {
    let results = tempfile::tempdir().unwrap();
    write_static_results(results.path(), &solution(), &run()).unwrap();
    let table = fs::read(results.path().join("series.csv")).unwrap();
    let summary = fs::read(results.path().join("summary.json")).unwrap();
    let input = PackInput {
        scene_name: scene[0],
        scene_text: scene[1],
        files,
        summary: &serde_json::from_slice(&summary).unwrap(),
        tables: &[("series.csv".into(), table)],
        tolerances: &tolerances(class),
        about: about(),
    };
    write_pack(folder, &input)
}

#[test]
fn a_pack_accepts_its_own_results_and_notices_any_change_to_its_files() {
    let root = tempfile::tempdir().unwrap();
    let (folder, candidate) = (root.path().join("pack"), root.path().join("candidate"));
    let scene = ["scene.toml", "title = \"deep groove\"\n"];
    let mesh = [("mesh/housing.msh".to_string(), b"$MeshFormat".to_vec())];
    for class in [ToleranceClass::F64Exact, ToleranceClass::F64Reordered, ToleranceClass::Mixed] {
        pack(&folder, scene, &mesh, class).unwrap();
        // Another solver: other iterations, another plan.
        let (mut other, mut record) = (solution(), run());
        other.iterations += 3;
        let why = "all at once";
        record.plan = vec![Item::does(Stage::Equilibrium, Subject::Whole, why)];
        write_static_results(&candidate, &other, &record).unwrap();
        let result = compare(&folder, &candidate, &Options::default()).unwrap();
        assert!(result.equal, "{}", report(&result));
    }
    let manifest = verify_pack(&folder).unwrap();
    assert_eq!((manifest.sha256.len(), &manifest.about), (7, &about()));
    for name in manifest.sha256.keys() {
        let path = folder.join(name);
        let bytes = fs::read(&path).unwrap();
        let mut altered = bytes.clone();
        altered[bytes.len() / 2] ^= 1;
        fs::write(&path, altered).unwrap();
        match verify_pack(&folder) {
            Err(PackError::Hash { name: found, .. }) => assert_eq!(found, *name),
            other => panic!("{name}: {other:?}"),
        }
        fs::remove_file(&path).unwrap();
        assert!(matches!(verify_pack(&folder), Err(PackError::Read { .. })));
        fs::write(&path, bytes).unwrap();
    }
    fs::write(folder.join("extra.csv"), "x\n1\n").unwrap();
    assert!(matches!(verify_pack(&folder), Err(PackError::Unlisted { .. })));
    // Only a sweep has no summary.
    let mut without = manifest.clone();
    without.sha256.remove("summary.json");
    fs::write(folder.join("manifest.json"), serde_json::to_string(&without).unwrap()).unwrap();
    match verify_pack(&folder) {
        Err(PackError::Incomplete { name }) => assert_eq!(name, "summary.json"),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_hash_is_sha256() {
    // FIPS 180-2, appendix B.1: the message "abc".
    let expected = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";
    let root = tempfile::tempdir().unwrap();
    let folder = root.path().join("pack");
    let manifest = pack(&folder, ["scene.toml", "abc"], &[], ToleranceClass::Mixed).unwrap();
    assert_eq!(manifest.sha256["scene.toml"], expected);
}

#[test]
fn a_pack_does_not_mix_with_other_files() {
    let root = tempfile::tempdir().unwrap();
    fs::write(root.path().join("thesis.txt"), "mine").unwrap();
    let new = root.path().join("new");
    let class = ToleranceClass::Mixed;
    for name in ["../scene.toml", "", "summary.json", "manifest.json", "/scene.toml"] {
        let result = pack(&new, [name, ""], &[], class);
        assert!(matches!(result, Err(PackError::SceneName { .. })), "{name:?}");
        let result = pack(root.path(), ["scene.toml", ""], &[], class);
        assert!(matches!(result, Err(PackError::Foreign { .. })));
    }
    // Meshes that are elsewhere, or would be taken for parts of the pack.
    for name in ["../a.msh", "/a.msh", "b/../a.msh", "./a.msh", "summary.json", "scene.toml"] {
        let files = [(name.to_string(), Vec::new())];
        let result = pack(&new, ["scene.toml", ""], &files, class);
        assert!(matches!(result, Err(PackError::Elsewhere { .. })), "{name:?}");
    }
    assert!(!new.exists());
}

/// What a killed process left goes, what another one may be writing stays, and so does the rest.
#[test]
fn half_written_files_of_killed_runs_are_removed() {
    let folder = tempfile::tempdir().unwrap();
    // Process numbers end at 2²² on Linux; this one runs nowhere.
    let dead = u32::MAX - 1;
    let own = std::process::id();
    let names = [
        format!(".state.json.{dead}.partial"),
        format!(".series.npy.{own}.partial"),
        "notes.partial".to_string(),
        ".notes.partial".to_string(),
        format!("state.json.{dead}.partial"),
    ];
    for name in &names {
        fs::write(folder.path().join(name), "half").unwrap();
    }
    remove_partials(folder.path());
    let left = names.iter().filter(|name| folder.path().join(name).exists()).collect::<Vec<_>>();
    assert_eq!(left, names[1..].iter().collect::<Vec<_>>());
    remove_partials(&folder.path().join("missing"));
}

/// All that turns the direction of writing, and the separators of lines and paragraphs.
#[test]
fn no_character_that_turns_the_writing_is_passed_on() {
    let turning = [0x200e..=0x200f, 0x2028..=0x202e, 0x2066..=0x2069];
    for code in turning.into_iter().flatten() {
        let text = format!("a{}b", char::from_u32(code).unwrap());
        let shown = format!("a\\u{code:04x}b");
        assert_eq!([visible(&text), visible_line(&text)], [shown.as_str(), shown.as_str()]);
    }
}

/// What a full disk leaves to go on from depends on what could be kept.
#[test]
fn advice_on_a_full_disk_is_about_what_was_kept() {
    let folder = tempfile::tempdir().unwrap();
    let said = |file: &str| {
        let error = WriteError {
            path: folder.path().join(file),
            source: std::io::ErrorKind::StorageFull.into(),
        };
        error.to_string()
    };
    let files = ["series.csv", "fields/fields_000001.vtu"];
    for file in files {
        assert!(said(file).contains("there is no state to resume from"), "{}", said(file));
        assert!(!said(file).contains("--resume"), "{}", said(file));
    }
    fs::write(folder.path().join("sweep.json"), "").unwrap();
    assert!(
        said("sweep.json").contains("run the sweep again: it continues after the finished points")
    );
    fs::write(folder.path().join("state.json"), "{}").unwrap();
    for file in files {
        assert!(
            said(file).contains("continue from the last saved state with --resume"),
            "{}",
            said(file)
        );
    }
    let other = WriteError {
        path: folder.path().join("series.csv"),
        source: std::io::ErrorKind::PermissionDenied.into(),
    };
    assert!(!other.to_string().contains("Free disk space"), "{other}");
}
