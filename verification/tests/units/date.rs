//! Days of the calendar.

use verification::date::{civil, is_day, today};

#[test]
fn known_days() {
    // Unix times of midnight, divided by 86 400.
    assert_eq!(civil(0), (1970, 1, 1));
    assert_eq!(civil(951_782_400 / 86_400), (2000, 2, 29));
    assert_eq!(civil(1_704_067_200 / 86_400), (2024, 1, 1));
    assert_eq!(civil(4_107_542_400 / 86_400), (2100, 3, 1));
}

#[test]
fn days_are_told_from_other_text() {
    assert!(is_day(&today()) && is_day("2026-11-20"));
    for text in ["", "2026-11", "2026-13-01", "2026-1-01", "20.11.2026", "2026-11-20 "] {
        assert!(!is_day(text), "{text}");
    }
}
