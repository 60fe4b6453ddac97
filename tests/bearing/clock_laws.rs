//! When a run's steps end: every row and corner is met, once and to the bit, by as few steps as there can be.

use bearing_dynamics::numeric::clock::{Clock, Stop, given_steps};

/// All steps of a clock with the time after each, where the control wants the same step all along.
fn all_stops(clock: &mut Clock, wanted: f64) -> Vec<(f64, Stop)> {
    let mut time = 0.0;
    clock.count_row(time);
    let mut stops = Vec::new();
    loop {
        let stop = clock.next_stop(time, wanted);
        assert!(stop.size > 0.0 && stops.len() < 100_000, "{time} {stop:?}");
        let after = time + stop.size;
        time = stop.at.unwrap_or(after);
        // What is said of the time is what the step comes to.
        assert!((time - after).abs() <= 1e-12 * after, "{after} {stop:?}");
        if stop.row {
            clock.count_row(time);
        }
        stops.push((time, stop));
        if stop.completes {
            return stops;
        }
    }
}

/// Steps of one size, so long that so many of them, and a bit, make the way from one stop to the next.
const RATIOS: [f64; 16] = [
    0.3,
    1.0 - 1e-8,
    1.0,
    1.0 + 1e-8,
    1.0 + 1e-4,
    1.4,
    1.6,
    2.0 - 1e-8,
    2.0,
    2.0 + 1e-8,
    2.3,
    3.0,
    3.7,
    4.0 + 1e-8,
    7.5,
    40.2,
];
const INTERVAL: f64 = 1e-4;

/// As few steps as there can be, no shorter than half of what is wanted unless the way is, and none longer but for
/// rounding.
fn check_way(way: &[f64], length: f64, wanted: f64) {
    let count = (length / wanted - 1e-6).ceil().max(1.0) as usize;
    assert_eq!(way.len(), count, "{} of {wanted} in {length}", length / wanted);
    for size in way {
        assert!(*size <= wanted * (1.0 + 1e-6) * (1.0 + 1e-12), "{size} {wanted}");
        assert!(*size >= length.min(0.5 * wanted) * (1.0 - 1e-7), "{size} {wanted} {length}");
    }
    // What is left is halved before it is less than a step: no short one comes last.
    if let [.., last_but_one, last] = way {
        assert!((last / last_but_one - 1.0).abs() <= 1e-6, "{way:?}");
    }
}

/// Way by way, a step's size for each, up to where `is_stop` says.
fn ways(stops: &[(f64, Stop)], is_stop: impl Fn(&Stop) -> bool) -> Vec<Vec<f64>> {
    let mut ways = vec![Vec::new()];
    for (_, stop) in stops {
        ways.last_mut().unwrap().push(stop.size);
        if is_stop(stop) {
            ways.push(Vec::new());
        }
    }
    ways.pop();
    ways
}

#[test]
fn controlled_steps_meet_every_row_and_corner_in_as_few_as_there_can_be() {
    for ratio in RATIOS {
        let wanted = INTERVAL / ratio;
        let corners = vec![
            1.37 * INTERVAL,
            // On a row, but for rounding to either side.
            3.0 * INTERVAL * (1.0 - 1e-14),
            5.0 * INTERVAL * (1.0 + 1e-14),
            6.2 * INTERVAL,
            6.9 * INTERVAL,
        ];
        let end = 8.0 * INTERVAL;
        let mut clock =
            Clock { end, interval: INTERVAL, corners: corners.clone(), ..Clock::default() };
        let stops = all_stops(&mut clock, wanted);
        let rows: Vec<f64> = stops.iter().filter(|(_, stop)| stop.row).map(|(at, _)| *at).collect();
        assert_eq!(rows.len(), 8, "{ratio}: {rows:?}");
        // By count, whatever the steps add up to; a corner a last digit later is the row.
        let counted = |row: u32| f64::from(row) * INTERVAL;
        let at = |row: u32| if row == 5 { counted(row).max(corners[2]) } else { counted(row) };
        let expected: Vec<f64> = (1..9).map(at).collect();
        assert_eq!(rows, expected, "{ratio}");
        let crossed: Vec<(f64, f64)> =
            stops.iter().filter_map(|(at, stop)| stop.corner.map(|c| (*at, c))).collect();
        let told: Vec<f64> = crossed.iter().map(|(_, corner)| *corner).collect();
        assert_eq!(told, corners, "{ratio}");
        for (at, corner) in crossed {
            assert!(at >= corner && at - corner <= 1e-13 * at, "{ratio}: {at} {corner}");
        }
        assert_eq!(stops.last().unwrap().0, end);
        let lengths = [1.0, 0.37, 0.63, 1.0, 1.0, 1.0, 1.0, 0.2, 0.7, 0.1, 1.0];
        let ways = ways(&stops, |stop| stop.row || stop.corner.is_some());
        assert_eq!(ways.len(), lengths.len(), "{ratio}");
        for (way, length) in ways.iter().zip(lengths) {
            check_way(way, length * INTERVAL, wanted);
        }
    }
}

#[test]
fn the_end_shortens_the_last_controlled_step_alone() {
    for ratio in RATIOS {
        let wanted = INTERVAL / ratio;
        let clock = |end| Clock { end, interval: INTERVAL, ..Clock::default() };
        let longer = all_stops(&mut clock(8.0 * INTERVAL), wanted);
        for end in [4.01, 4.5, 4.99, 5.0].map(|end| end * INTERVAL) {
            let stops = all_stops(&mut clock(end), wanted);
            let (last, before) = stops.split_last().unwrap();
            assert_eq!(before, &longer[..before.len()], "{ratio}");
            assert_eq!((last.0, last.1.row), (end, true));
            let next = &longer[before.len()];
            assert!(last.1.size <= next.1.size * (1.0 + 2e-6), "{ratio} {end}: {last:?} {next:?}");
        }
    }
}

#[test]
fn given_steps_divide_the_way_to_a_corner_evenly_and_are_as_many_as_foretold() {
    for ratio in
        RATIOS.into_iter().filter(|ratio| *ratio > 1.0 && !(1e-9..1e-5).contains(&ratio.fract()))
    {
        let steps_per_row = ratio.round() as u64;
        let step = INTERVAL / steps_per_row as f64;
        // Ways between stops of so many steps and a bit.
        let corners =
            [INTERVAL + ratio.fract() * step, 3.0 * INTERVAL + 0.4 * step, 5.5 * INTERVAL];
        // And two within one row.
        let mut corners = corners.to_vec();
        corners.extend([4.31 * INTERVAL, 4.77 * INTERVAL]);
        corners.sort_by(f64::total_cmp);
        let end = 6.0 * INTERVAL;
        let mut clock = Clock {
            end,
            interval: INTERVAL,
            step,
            steps_per_row,
            corners: corners.clone(),
            ..Clock::default()
        };
        let stops = all_stops(&mut clock, 0.0);
        assert_eq!(stops.len() as u64, given_steps(&corners, INTERVAL, end, step), "{ratio}");
        let rows: Vec<f64> = stops.iter().filter(|(_, stop)| stop.row).map(|(at, _)| *at).collect();
        assert_eq!(rows.len(), 6, "{ratio}: {rows:?}");
        for (row, at) in (1..).zip(&rows) {
            // A corner less than a millionth of a step after a row takes the row with it.
            assert!((at - row as f64 * INTERVAL).abs() <= 1e-6 * step, "{ratio}: {rows:?}");
        }
        assert_eq!(stops.last().unwrap().0, end);
        for way in ways(&stops, |stop| stop.row || stop.corner.is_some()) {
            let length: f64 = way.iter().sum();
            // Whole but for rounding is whole.
            let count = (length / step - 2e-9).ceil().max(1.0) as usize;
            assert_eq!(way.len(), count, "{ratio}: {} steps", length / step);
            for size in &way {
                assert!((size * count as f64 / length - 1.0).abs() <= 1e-9, "{ratio}: {way:?}");
            }
        }
    }
}
