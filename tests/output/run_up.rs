//! Amplitudes of a run-up, turn by turn.

use bearing_dynamics::output::run_up::turns;

/// A slow sweep of y = 3 + A cos θ + B cos 2θ: 1X is A, half peak-to-peak that of both.
#[test]
fn a_turn_has_its_once_per_turn_part_and_its_peaks() {
    let (once, twice, interval) = (2.0, 0.5, 1e-4);
    let (mut speed, mut angle): (Vec<f64>, f64) = (Vec::new(), 0.4);
    let mut values = Vec::new();
    for row in 0..20_000 {
        let now = 100.0 + 1e-2 * row as f64;
        if row > 0 {
            angle += 0.5 * (now + speed[row - 1]) * interval;
        }
        values.push(3.0 + once * angle.cos() + twice * (2.0 * angle).cos());
        speed.push(now);
    }
    let found = turns(&speed, &values, interval);
    let whole = (angle - 0.4) / std::f64::consts::TAU;
    // A turn ends at the first row past it.
    assert!(found.len() as f64 <= whole && found.len() as f64 >= 0.98 * whole, "{}", found.len());
    // Highest at θ = 0, 2.5; lowest where 2 sin θ + sin 2θ = 0, at π or where cos θ = −1: −1.5.
    for turn in &found {
        assert!((turn.once_per_turn - once).abs() <= 5e-3 * once, "{turn:?}");
        assert!((turn.half_peak_to_peak - 2.0).abs() <= 5e-3 * 2.0, "{turn:?}");
        assert!(turn.speed >= 100.0 && turn.speed <= 300.0, "{turn:?}");
    }
    // Four rows a turn are too few.
    assert!(turns(&[100.0; 100], &[1.0; 100], 0.25 * std::f64::consts::TAU / 100.0).is_empty());
    assert!(turns(&[], &[], 1.0).is_empty());
}

/// A turn backwards has the amplitudes of one forwards.
#[test]
fn turns_of_either_sense_are_alike() {
    let speed: Vec<f64> = (0..5000).map(|row| 200.0 + 1e-2 * row as f64).collect();
    let values: Vec<f64> = (0..5000).map(|row| (0.02 * row as f64).sin()).collect();
    let back: Vec<f64> = speed.iter().map(|speed| -speed).collect();
    let [forwards, backwards] = [&speed, &back].map(|speed| turns(speed, &values, 1e-4));
    assert!(forwards.len() >= 15, "{}", forwards.len());
    assert_eq!(forwards.len(), backwards.len());
    for (forwards, backwards) in forwards.iter().zip(&backwards) {
        assert_eq!(forwards.half_peak_to_peak, backwards.half_peak_to_peak);
        assert_eq!(forwards.once_per_turn, backwards.once_per_turn);
        assert_eq!(forwards.speed.abs(), backwards.speed.abs());
    }
}
