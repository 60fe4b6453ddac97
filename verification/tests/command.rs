//! The `verify` command: exit codes, the report, its threads.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn verify(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_verify")).args(arguments).output().unwrap()
}

fn text(path: &Path) -> String {
    fs::read_to_string(path).unwrap()
}

#[test]
fn a_run_writes_its_report_on_one_thread() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let output = verify(&["--case", "kinematic_frequencies", "--out", out]);
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stdout.is_empty());

    let report: serde_json::Value =
        serde_json::from_str(&text(&folder.path().join("report.json"))).unwrap();
    assert_eq!(report["passed"], true);
    assert_eq!(report["complete"], true);
    if cfg!(target_os = "linux") {
        assert_eq!(report["machine"]["threads"], 1);
    }
    let case = &report["cases"][0];
    for check in case["checks"].as_array().unwrap() {
        for field in ["value", "reference", "tolerance"] {
            assert!(check[field].is_f64(), "{field} of {check}");
        }
        for field in ["quantity", "unit", "reference_kind", "tolerance_reason", "status"] {
            assert!(check[field].as_str().is_some_and(|text| !text.is_empty()), "{field}");
        }
    }
    let html = text(&folder.path().join("report.html"));
    // A case, the source's index and the cases that did not run.
    for needed in
        ["slowest_cage_ratio", "Table 5.4", "reproduced", "Fig. 5.34", "misalignment_moment"]
    {
        assert!(html.contains(needed), "{needed}");
    }
    let kinds = report["totals"]["by_kind"].as_array().unwrap();
    let named: Vec<&str> = kinds.iter().map(|kind| kind["kind"].as_str().unwrap()).collect();
    let all = [
        "published",
        "book",
        "other-program",
        "evidence",
        "closed-form",
        "converged",
        "independent",
        "consistency",
        "stated",
    ];
    assert_eq!(named, all);
    let sum = |list: &serde_json::Value, field: &str| -> u64 {
        list.as_array().unwrap().iter().map(|entry| entry[field].as_u64().unwrap()).sum()
    };
    let checks = case["checks"].as_array().unwrap().len() as u64;
    assert_eq!(sum(&report["totals"]["by_kind"], "checks"), checks);
    assert_eq!(sum(&report["totals"]["by_status"], "checks"), checks);
    assert!(report["not_run"].as_array().unwrap().len() > 20);
    assert_eq!(report["source"].as_array().unwrap().len(), 4);
    // Self-contained: nothing is fetched.
    assert!(html.contains("<svg") && !html.contains("<link") && !html.contains("src="));
    let leftover = fs::read_dir(folder.path())
        .unwrap()
        .any(|entry| entry.unwrap().path().extension().is_some_and(|e| e == "partial"));
    assert!(!leftover);
}

#[test]
fn a_changed_past_exits_1_and_says_which_number() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_string();
    let (golden, out) = (at("golden"), at("out"));
    let case = ["--case", "kinematic_frequencies"];
    let run = || verify(&[&case[..], &["--golden", &golden, "--out", &out]].concat());
    // No golden file yet.
    assert_eq!(run().status.code(), Some(1));
    let accept = |reason: &str| {
        verify(&[&["golden"], &case[..], &["--golden", &golden, "--reason", reason]].concat())
    };
    assert_eq!(accept("  ").status.code(), Some(2));
    assert_eq!(accept("a test").status.code(), Some(0));
    assert_eq!(run().status.code(), Some(0));
    let path = folder.path().join("golden/kinematic_frequencies.json");
    let mut file: serde_json::Value = serde_json::from_str(&text(&path)).unwrap();
    let pinned = file["values"][4]["value"].as_f64().unwrap();
    file["values"][4]["value"] = (pinned * (1.0 + 1e-12)).into();
    fs::write(&path, file.to_string()).unwrap();
    let output = run();
    assert_eq!(output.status.code(), Some(1));
    let name = file["values"][4]["name"].as_str().unwrap();
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(told.contains(name) && told.contains("edited by hand"), "{told}");
    assert!(text(&folder.path().join("out/report.html")).contains("golden changed"));
}

#[test]
fn what_cannot_run_exits_2() {
    let output = verify(&["--case", "no_such_case"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("kinematic_frequencies"));
    assert_eq!(verify(&["--tier", "huge"]).status.code(), Some(2));
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("a_file");
    fs::write(&file, "").unwrap();
    assert_eq!(verify(&["--out", file.to_str().unwrap()]).status.code(), Some(2));
}

/// CalculiX where it is not: the run holds and says so last; where it is required, nothing runs.
#[test]
fn a_run_without_what_it_compares_with_says_so_last() {
    let folder = tempfile::tempdir().unwrap();
    let run = |required: bool| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_verify"));
        command.args(["--case", "calculix_comparison", "--out"]).arg(folder.path().join("report"));
        command.env("PATH", folder.path()).env_remove("REQUIRE_CALCULIX");
        if required {
            command.env("REQUIRE_CALCULIX", "1");
        }
        let output = command.output().unwrap();
        (output.status.code(), String::from_utf8_lossy(&output.stderr).into_owned())
    };
    let (code, said) = run(true);
    assert!(code == Some(2) && said.contains("REQUIRE_CALCULIX"), "{said}");
    assert!(!folder.path().join("report").exists());
    let (code, said) = run(false);
    assert_eq!(code, Some(0), "{said}");
    let last = said.lines().last().unwrap();
    assert!(last.starts_with("SKIPPED calculix_comparison: no ccx on the path"), "{said}");
}
