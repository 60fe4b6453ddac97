//! The tilted bearing: its numbers at every phase, and every reading of what is printed.

use verification::oracles::misalignment::{baseline, readings};

#[test]
fn moment_and_tilts_at_every_phase() {
    for phase in [0.0, 5.0, 11.25, 15.0, 22.5, 45.0] {
        let found = baseline(phase);
        // The ball phase changes the moment by 0.06 %.
        assert!((found.moment_at_0_15_degrees - 6.4206).abs() <= 0.0021, "{found:?}");
        for (tilt, known) in found.tilt_degrees.iter().zip([0.0941, 0.1343, 0.1795]) {
            assert!((tilt - known).abs() <= 1e-4, "{found:?}");
        }
    }
}

#[test]
fn no_reading_meets_all_four_published_numbers() {
    let readings = readings();
    for row in &readings {
        let [low, middle, high] = row.tilt_degrees;
        println!(
            "{:50} {:8.4} {low:8.4} {middle:8.4} {high:8.4} {:.0e}",
            row.name, row.moment_at_0_15_degrees, row.residual
        );
        let lower_rows = (low - 0.094).abs() <= 0.0015 && (middle - 0.134).abs() <= 0.0015;
        let last_row = (high - 0.175).abs() <= 0.0015;
        assert!(!(lower_rows && last_row), "{row:?} explains the 10 N·m row");
    }
    assert!(readings.iter().all(|row| row.residual <= 1e-6));
}
