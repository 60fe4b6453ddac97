//! How far results may be apart: floors of units, scales of vectors and angles, tolerances of channels, what balls
//! without load show.

use super::compare_finds::{
    CLASSES, allowed_at, carries_nothing, compared, pair, read_json, with_class,
};

use bearing_dynamics::output::compare::tolerance::{
    RequestedTolerance, ToleranceClass, Tolerances,
};
use bearing_dynamics::output::compare::{CompareError, Options, compare, report};
use bearing_dynamics::output::series::Series;
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

#[test]
fn the_allowed_difference_is_the_documented_sum() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    // Row 2 of a channel in N: value, largest of the channel, and what may differ.
    let check = |header: &str, rows: [&str; 2], class: ToleranceClass, expected: f64| {
        fs::write(&a, format!("{header}\n{}\n{}\n", rows[0], rows[1])).unwrap();
        let changed = rows[1].replacen("2.0", "1e30", 1);
        fs::write(&b, format!("{header}\n{}\n{changed}\n", rows[0])).unwrap();
        let allowed = allowed_at(&compared(&a, &b, class));
        assert!((allowed / expected - 1.0).abs() <= 1e-12, "{allowed:e} against {expected:e}");
    };
    let [reordered, mixed] = CLASSES;
    // floor share · 100 N + relative · 2 N + share · 500 N
    check("load [N]", ["-500.0", "2.0"], reordered, 100e-10 + 2e-9 + 500e-10);
    check("load [N]", ["-500.0", "2.0"], mixed, 100e-5 + 2e-4 + 500e-5);
    // The components of a vector share the largest; other units and other names do not.
    let row = ["3.0,7.0,9.0,8.0", "2.0,-700.0,9e9,9e9"];
    // Rounding at a radius of 30 mm, whatever the size of what it leaves.
    check("approach [m]", ["3.0", "2.0"], reordered, 1e-14 + 2e-9 + 3e-10);
    check("approach [um]", ["3.0", "2.0"], reordered, 1e-8 + 2e-9 + 3e-10);
    check("approach [mm]", ["3.0", "2.0"], reordered, 1e-11 + 2e-9 + 3e-10);
    check("f_x [N],f_z [N],f_y [N m],load [N]", row, mixed, 100e-5 + 2e-4 + 700e-5);
    // No floor where the unit tells nothing.
    check("reach [furlong]", ["0.0", "2.0"], mixed, 2e-4 + 2e-5);
}

/// A part of an angle's scale: after 20 turns 1e-3 of it would pass a ball that is 4 degrees off.
#[test]
fn an_angle_that_counts_turns_has_the_scale_of_one() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    let given = RequestedTolerance { scale_relative: 1e-3, floors: Vec::new() };
    let options = Options { given: Some(given), ..Options::default() };
    let turns = 6994.0;
    for (unit, degree) in [("deg", 1.0), ("rad", 1f64.to_radians())] {
        let compare_shifted = |last: f64, by: f64| {
            let header = format!("time [s],ball_1_angle [{unit}]");
            let row =
                |of: f64| format!("{header}\n0,{}\n1,{}\n", of * degree, (last + of) * degree);
            fs::write(&a, row(0.0)).unwrap();
            fs::write(&b, row(by)).unwrap();
            compare(&a, &b, &options).unwrap()
        };
        let off = compare_shifted(turns, 4.0);
        assert_eq!(off.differing, 2, "{unit}: {}", report(&off));
        let expected = 1e-3 * 360.0 * degree;
        let allowed = allowed_at(&off);
        assert!((allowed / expected - 1.0).abs() <= 1e-4, "{unit}: {allowed}");
        assert!(compare_shifted(turns, 0.3).equal);
        // A tilt keeps its own scale: 4 thousandths of 0.15 degrees are found.
        assert!(!compare_shifted(0.15, 0.0006).equal);
        assert!(compare_shifted(0.15, 0.0001).equal);
    }
    // And so does what is no angle.
    fs::write(&a, "x [m]\n6994\n").unwrap();
    fs::write(&b, "x [m]\n6998\n").unwrap();
    assert!(compare(&a, &b, &options).unwrap().equal);
}

/// A small but ordinary value of each unit, put together from forces of 100 N, levers of a centimetre,
/// lengths of 0.1 mm and the like; a tolerance class takes its share of it.
#[test]
fn the_floor_of_every_unit_is_its_share_of_a_small_ordinary_value() {
    const UM: f64 = 1e-6;
    const MRAD: f64 = 1e-3;
    let length = 1e-4;
    let table = [
        ("m", length),
        ("mm", length / 1e-3),
        ("um", length / UM),
        ("N", 100.0),
        ("N m", 100.0 * 0.01),
        ("deg", 1e-3),
        ("rad", 1e-5),
        ("Pa", 1e6),
        ("MPa", 1.0),
        ("N/m", 1.0 / UM),
        ("N/rad", 1.0 / MRAD),
        ("N m/m", 1.0 / MRAD),
        ("N m/rad", 1e-3 / MRAD),
        ("N/m^1.5", 1.0 / (UM * UM.sqrt())),
        ("s", 1e-6),
        ("Hz", 1e-3),
        ("rad/s", 1e-3),
        ("m/s", 1e-3),
        ("m/s^2", 1e-3),
        ("kg", 1e-6),
        ("J", 1e-6),
        ("1", 1e-3),
        ("", 0.0),
        ("furlong", 0.0),
    ];
    let root = tempfile::tempdir().unwrap();
    let [reference, candidate] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    let column = |path: &Path, unit: &str, value: f64| {
        let header = if unit.is_empty() { "x".into() } else { format!("x [{unit}]") };
        fs::write(path, format!("{header}\n0\n{value:?}\n")).unwrap();
    };
    for (unit, ordinary) in table {
        column(&reference, unit, 0.0);
        let equal = |options: &Options, value: f64| {
            column(&candidate, unit, value);
            compare(&reference, &candidate, options).unwrap().equal
        };
        let given = RequestedTolerance { scale_relative: 1e-2, floors: Vec::new() };
        let given = Options { given: Some(given), ..Options::default() };
        for (options, share) in [
            (with_class(ToleranceClass::F64Reordered), 1e-10),
            (with_class(ToleranceClass::Mixed), 1e-5),
            (given, 1e-3 * 1e-2),
        ] {
            let floor = share * ordinary;
            assert!(equal(&options, 0.99 * floor), "{unit}: {floor:e}");
            assert!(!equal(&options, 1.01 * floor + 1e-300), "{unit}: {floor:e}");
        }
    }
}

#[test]
fn a_tolerance_file_beside_the_reference_decides_per_channel() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let column = series.columns().iter().position(|c| c.name == "inner_peak_pressure").unwrap();
    let mut data = series.data().clone();
    data[(6, column)] *= 1.0 + 1e-6;
    let altered = Series::new(series.columns().to_vec(), data).unwrap();
    altered.write_csv(&candidate.join("series.csv")).unwrap();
    let outcome = |text: &str| {
        fs::write(reference.join("tolerances.json"), text).unwrap();
        compare(&reference, &candidate, &Options::default())
    };
    assert!(!outcome("{}").unwrap().equal);
    assert!(outcome(r#"{"class": "mixed"}"#).unwrap().equal);
    let named = |entry: &str| format!(r#"{{"channels": {{"inner_peak_pressure": {entry}}}}}"#);
    assert!(outcome(&named(r#"{"class": "mixed"}"#)).unwrap().equal);
    assert!(outcome(&named(r#"{"relative": 2e-6}"#)).unwrap().equal);
    assert!(!outcome(&named(r#"{"relative": 5e-7}"#)).unwrap().equal);
    let ignored = outcome(&named(r#"{"class": "ignored"}"#)).unwrap();
    assert!(ignored.equal && ignored.ignored.contains(&"series.csv: inner_peak_pressure".into()));
    // The user's own choice of a default goes before the file's.
    fs::write(reference.join("tolerances.json"), r#"{"class": "mixed"}"#).unwrap();
    assert!(!compared(&reference, &candidate, ToleranceClass::F64Exact).equal);

    for refused in [
        r#"{"class": "loose"}"#,
        r#"{"class": "ignored"}"#,
        r#"{"tolerance": 1}"#,
        r#"{"channels": {"inner_peak_presure": {"class": "mixed"}}}"#,
        r#"{"channels": {"inner_load": {"relative": -1}}}"#,
        r#"{"channels": {"inner_load": {"relative": 1e-3, "class": "ignored"}}}"#,
    ] {
        assert!(matches!(outcome(refused), Err(CompareError::Tolerance(_))), "{refused}");
    }
}

#[test]
fn where_a_ball_without_load_is_shown_is_its_programs_choice() {
    let (_root, reference, candidate) = pair();
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let number = |name: &str| series.columns().iter().position(|c| c.name == name).unwrap();
    let idle = (0..8).find(|&row| carries_nothing(&series, row)).unwrap();
    let loaded = (0..8).find(|&row| !carries_nothing(&series, row)).unwrap();
    let given = candidate.join("series.csv");
    let outcome = |cells: &[(usize, &str, f64)], class: ToleranceClass| {
        let mut data = series.data().clone();
        cells.iter().for_each(|(row, name, value)| data[(*row, number(name))] = *value);
        fs::write(&given, Series::new(series.columns().to_vec(), data).unwrap().to_csv().unwrap())
            .unwrap();
        compared(&reference.join("series.csv"), &given, class)
    };
    let [reordered, _] = CLASSES;
    let elsewhere = [(idle, "position_y", 0.03), (idle, "inner_approach", -1e-6)];
    let result = outcome(&elsewhere, reordered);
    assert!(result.equal, "{}", report(&result));
    assert!(report(&result).contains("balls without load"), "{}", report(&result));
    // Not so for the same program, for a loaded ball, for what is no number, or with a load.
    assert!(!outcome(&elsewhere, ToleranceClass::F64Exact).equal);
    assert!(!outcome(&[(loaded, "position_y", 0.03)], reordered).equal);
    outcome(&[(idle, "position_y", 123.25)], reordered);
    fs::write(&given, fs::read_to_string(&given).unwrap().replace("123.25", "NaN")).unwrap();
    assert!(!compared(&reference.join("series.csv"), &given, reordered).equal);
    assert!(!outcome(&[(idle, "inner_load", 1e-3)], reordered).equal);
    // One loaded contact determines where the ball is.
    let mut data = series.data().clone();
    data[(idle, number("outer_load"))] = 0.07;
    let weighs = Series::new(series.columns().to_vec(), data.clone()).unwrap();
    fs::write(reference.join("series.csv"), weighs.to_csv().unwrap()).unwrap();
    data[(idle, number("inner_approach"))] -= 1e-6;
    fs::write(&given, Series::new(series.columns().to_vec(), data).unwrap().to_csv().unwrap())
        .unwrap();
    let result = compared(&reference.join("series.csv"), &given, reordered);
    assert_eq!(result.first_divergence.unwrap().channel, "inner_approach");
}

/// In a summary as in a table: one loaded contact determines where the ball is.
#[test]
fn a_summary_leaves_out_where_balls_without_load_are_shown_and_nothing_else() {
    let (_root, reference, candidate) = pair();
    let (expected, given) = (reference.join("summary.json"), candidate.join("summary.json"));
    let summary = read_json(&expected);
    let series = Series::read_csv(&reference.join("series.csv")).unwrap();
    let idle = (0..8).find(|&row| carries_nothing(&series, row)).unwrap();
    let loaded = (0..8).find(|&row| !carries_nothing(&series, row)).unwrap();
    let at = |ball: usize, what: &str| format!("/balls/{ball}/{what}/value");
    let put = |value: &Value, changes: &[(String, Value)]| {
        let mut altered = value.clone();
        for (pointer, to) in changes {
            *altered.pointer_mut(pointer).unwrap_or_else(|| panic!("{pointer}")) = to.clone();
        }
        altered
    };
    let outcome = |from: &Value, changes: &[(String, Value)], class| {
        fs::write(&expected, from.to_string()).unwrap();
        fs::write(&given, put(from, changes).to_string()).unwrap();
        compared(&expected, &given, class)
    };
    let [reordered, _] = CLASSES;
    let elsewhere = [
        (at(idle, "position/y"), json!(0.03)),
        (at(idle, "inner/approach"), json!(-1e-6)),
        (at(idle, "outer/contact_angle"), json!(12.5)),
    ];
    let result = outcome(&summary, &elsewhere, reordered);
    assert!(result.equal && report(&result).contains("balls without load"), "{}", report(&result));
    assert!(!outcome(&summary, &elsewhere, ToleranceClass::F64Exact).equal);
    assert!(!outcome(&summary, &[(at(idle, "position/y"), Value::Null)], reordered).equal);
    assert!(!outcome(&summary, &[(at(idle, "inner/load"), json!(1e-3))], reordered).equal);
    assert!(!outcome(&summary, &[(at(loaded, "position/y"), json!(0.03))], reordered).equal);
    for race in ["inner", "outer"] {
        let held = put(&summary, &[(at(idle, &format!("{race}/load")), json!(0.07))]);
        for change in &elsewhere {
            let result = outcome(&held, std::slice::from_ref(change), reordered);
            assert!(!result.equal && result.differing == 1, "{race}: {}", report(&result));
        }
    }
    // The same in an assembly, by name of the bearing.
    let below = |(pointer, to): &(String, Value)| (format!("/bearings/left{pointer}"), to.clone());
    let assembly = json!({ "bearings": { "left": { "balls": summary["balls"] } } });
    let moved: Vec<_> = elsewhere.iter().map(below).collect();
    assert!(outcome(&assembly, &moved, reordered).equal);
    let loaded = below(&(at(loaded, "position/y"), json!(0.03)));
    assert!(!outcome(&assembly, &[loaded], reordered).equal);
}

/// A quantity may have a place next to its value; a program that gives none has the same quantity.
#[test]
fn a_quantity_with_a_place_is_that_quantity() {
    let root = tempfile::tempdir().unwrap();
    let [expected, given] = ["a.json", "b.json"].map(|name| root.path().join(name));
    let place =
        json!({ "largest": { "value": 2.0, "unit": "Pa", "at": { "value": 1.0, "unit": "m" } } });
    fs::write(&expected, json!({ "largest": { "value": 2.0, "unit": "Pa" } }).to_string()).unwrap();
    fs::write(&given, place.to_string()).unwrap();
    let [reordered, _] = CLASSES;
    assert!(compared(&expected, &given, reordered).equal);
    let other = place.to_string().replace("2.0", "2.1");
    fs::write(&given, other).unwrap();
    let result = compared(&expected, &given, reordered);
    assert_eq!(result.first_divergence.unwrap().channel, "largest");
}

#[test]
fn tolerances_read_back_as_written() {
    let text = r#"{"class":"mixed","channels":{"a":{"class":"ignored","reason":"why"}}}"#;
    let tolerances: Tolerances = serde_json::from_str(text).unwrap();
    assert_eq!(serde_json::to_string(&tolerances).unwrap(), text);
}

#[test]
fn a_direction_is_the_same_a_turn_further() {
    let write = |name: &str, values: [f64; 3], unit: &str| {
        let root = tempfile::tempdir().unwrap();
        let path = root.path().join(name);
        let rows: String =
            values.iter().enumerate().map(|(i, value)| format!("{i},{value:?}\n")).collect();
        fs::write(&path, format!("time [s],cage_angle [{unit}]\n{rows}")).unwrap();
        (root, path)
    };
    let differing = |reference: [f64; 3], candidate: [f64; 3], unit: &str, class| {
        let (_a, reference) = write("a.csv", reference, unit);
        let (_b, candidate) = write("b.csv", candidate, unit);
        compared(&reference, &candidate, class).differing
    };
    let usual = ToleranceClass::F64Reordered;
    assert_eq!(differing([-45.0, 0.0, 180.0], [315.0, 360.0, -180.0], "deg", usual), 0);
    let tau = std::f64::consts::TAU;
    assert_eq!(differing([-1.0, 0.0, 3.0], [tau - 1.0, -tau, 3.0], "rad", usual), 0);
    // Not half a turn, not two, not in metres, and not to the bit.
    assert_eq!(differing([-45.0, 0.0, 1.0], [135.0, 720.0, 1.0], "deg", usual), 2);
    assert_eq!(differing([-45.0, 0.0, 1.0], [315.0, 0.0, 1.0], "m", usual), 1);
    let exact = ToleranceClass::F64Exact;
    assert_eq!(differing([-45.0, 0.0, 1.0], [315.0, 0.0, 1.0], "deg", exact), 1);
}

/// Means and extremes over time of the components of one vector share a scale.
#[test]
fn extremes_over_time_share_the_scale_of_their_vector() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    for of in ["mean", "smallest", "largest", "peak_to_peak"] {
        let header = format!("inner_y.{of} [m],inner_z.{of} [m]");
        fs::write(&a, format!("{header}\n2.0,-500.0\n")).unwrap();
        fs::write(&b, format!("{header}\n1e30,-500.0\n")).unwrap();
        let allowed = allowed_at(&compared(&a, &b, CLASSES[0]));
        // Floor, relative part, and a share of the larger component.
        let expected = 1e-14 + 2e-9 + 500e-10;
        assert!((allowed / expected - 1.0).abs() <= 1e-12, "{of}: {allowed:e}");
    }
}

/// Tolerances are measured from the largest differences: NaN, which a maximum would lose, counts as another kind of value.
#[test]
fn a_value_that_is_not_a_number_is_part_of_no_spread() {
    let root = tempfile::tempdir().unwrap();
    let [a, b] = ["a.csv", "b.csv"].map(|name| root.path().join(name));
    fs::write(&a, "load [N]\n1.0\n2.0\n").unwrap();
    fs::write(&b, "load [N]\nNaN\n2.5\n").unwrap();
    let found = compare(&a, &b, &Options::default()).unwrap();
    let spread = found.channels[0].spread;
    assert_eq!((spread.unlike, spread.largest, spread.relative), (1, 0.5, 0.25));
    assert!(!found.equal);
}
