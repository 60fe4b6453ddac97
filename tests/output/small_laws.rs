//! Axes, colours, text and reach of what is written.

mod ticks {
    use bearing_dynamics::output::plots::ticks::*;

    fn labels(scale: &Scale) -> Vec<&str> {
        scale.ticks.iter().map(|(_, label)| label.as_str()).collect()
    }

    #[test]
    fn linear_axes_end_on_round_marks_around_the_values() {
        assert_eq!(labels(&linear([0.0, 0.15].into_iter(), 4)), ["0.00", "0.05", "0.10", "0.15"]);
        assert_eq!(labels(&linear([-3.0, 4.0].into_iter(), 4)), ["-4", "-2", "0", "2", "4"]);
        let micro = linear([0.0, 2.3e-6].into_iter(), 5);
        assert_eq!(labels(&micro)[..4], ["0", "5e-7", "1.0e-6", "1.5e-6"]);
        for scale in [linear([5.0].into_iter(), 5), linear([0.0].into_iter(), 5)] {
            assert!(scale.low < scale.high && scale.ticks.len() >= 3, "{scale:?}");
        }
    }

    #[test]
    fn extreme_values_still_make_an_axis() {
        for values in [[-1e200, 1e200], [1e-200, 2e-200], [1e200, 1.0000001e200], [-1e-200, 1e200]]
        {
            let scale = linear(values.into_iter(), 5);
            assert!(scale.ticks.len() >= 2 && scale.ticks.len() <= 20, "{scale:?}");
            for value in values {
                let position = scale.position(value);
                assert!((-1e-6..=1.0 + 1e-6).contains(&position), "{value} at {position}");
            }
        }
    }

    #[test]
    fn logarithmic_axes_mark_decades() {
        let scale = logarithmic([0.03, 400.0].into_iter());
        assert_eq!(labels(&scale), ["0.01", "0.1", "1", "10", "100", "1000"]);
        assert!((scale.position(1.0) - 0.4).abs() <= 1e-12);
        assert!(labels(&logarithmic([2.0, 3.0].into_iter())).contains(&"5"));
        assert!(logarithmic([1e-16, 1e3].into_iter()).ticks.len() <= 10);
    }
}

mod canvas {
    use bearing_dynamics::output::plots::{COLOURS, colour};
    use plotters::prelude::*;

    #[test]
    fn twenty_curves_differ_in_colour() {
        for one in 0..3 * COLOURS.len() {
            for other in 0..one {
                let far = |a: u8, b: u8| u32::from(a.abs_diff(b));
                let (RGBColor(a, b, c), RGBColor(x, y, z)) = (colour(one), colour(other));
                // Far enough to be told apart in a legend.
                assert!(far(a, x) + far(b, y) + far(c, z) >= 30, "{one} {other}");
            }
        }
    }
}

mod bearing {
    use bearing_dynamics::output::pictures::bearing::*;

    #[test]
    fn thinning_keeps_peaks_and_order() {
        let mut points: Vec<[f64; 2]> = (0..100_000).map(|i| [i as f64, 0.0]).collect();
        points[54_321][1] = 7.0;
        points[77_777][1] = -3.0;
        let kept = thin(points.clone(), 1500);
        assert!(kept.len() <= 1502, "{}", kept.len());
        assert!(kept.contains(&[54_321.0, 7.0]) && kept.contains(&[77_777.0, -3.0]));
        assert!(kept.windows(2).all(|pair| pair[0][0] <= pair[1][0]));
        assert_eq!(thin(points[..10].to_vec(), 1500), points[..10]);
    }
}

mod json {
    use bearing_dynamics::output::json::*;

    #[test]
    fn values_are_counted_outside_of_strings() {
        assert_eq!(count_values(br#"{"a,[{\",": [1, 2, {}]}"#), 1 + 1 + 1 + 2 + 1);
        let list = |count: usize| format!("[{}0]", "0,".repeat(count - 1));
        assert!(parse(list(MOST_VALUES - 1).as_bytes()).is_ok());
        assert!(matches!(parse(list(MOST_VALUES).as_bytes()), Err(JsonError::TooMany)));
    }
}

mod visible {
    use bearing_dynamics::output::visible::*;
    use std::borrow::Cow;

    #[test]
    fn nothing_that_a_terminal_obeys_is_left() {
        let title = "\u{1b}[2J\u{9b}31m\r\u{7f}\u{202e}\nµm\t²";
        assert_eq!(visible(title), "\\u001b[2J\\u009b31m\\u000d\\u007f\\u202e\nµm\t²");
        assert_eq!(visible_line("a\nb\tc"), "a\\u000ab\\u0009c");
        assert!(matches!(visible("plain\n"), Cow::Borrowed(_)));
        let json = serde_json::Value::from(title).to_string();
        let read: String = serde_json::from_str(&visible(&json)).unwrap();
        assert_eq!(read, title);
    }
}
