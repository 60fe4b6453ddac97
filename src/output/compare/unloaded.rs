//! Positions of balls without load, which are not compared.
//!
//! The position of a ball that carries no load is not determined: it has clearance to both races. Its position, the
//! gaps to both races and its contact angles are a choice of the program. They are not compared, nor are the semi-axes
//! and the pressure, which grow with the cube root of a load of rounding; its loads, which are zero, are.
//!
//! A ball with one loaded contact, under its weight for example, does not count: its position is determined.

use crate::output::compare::channels::{Leaf, LeafValue};
use crate::output::series::Series;
use std::collections::HashSet;

/// Channels that follow from a ball's position alone, and those of its contact ellipses, as in `series.csv`.
const PLACE: [&str; 13] = [
    "position_x",
    "position_y",
    "position_z",
    "inner_approach",
    "inner_contact_angle",
    "outer_approach",
    "outer_contact_angle",
    "inner_semi_major",
    "inner_semi_minor",
    "inner_peak_pressure",
    "outer_semi_major",
    "outer_semi_minor",
    "outer_peak_pressure",
];

/// Text of the report for the values not compared.
pub const NOTE: &str =
    "position, approach, contact_angle, semi-axes and peak_pressure of balls without load";

/// For each row of a table of balls, true if the ball carries no load; `None` for other tables.
pub fn unloaded_rows(series: &Series) -> Option<Vec<bool>> {
    series.column("ball")?;
    let (inner, outer) = (series.column("inner_load")?, series.column("outer_load")?);
    Some(
        inner
            .iter()
            .zip(outer.iter())
            .map(|(inner, outer)| (*inner, *outer) == (0.0, 0.0))
            .collect(),
    )
}

/// Returns whether a column follows from the position of a ball alone.
pub fn is_place(column: &str) -> bool {
    PLACE.contains(&column)
}

/// Paths of the leaves of a summary that follow from the position of a ball without load.
pub fn unloaded_places(leaves: &[Leaf]) -> HashSet<&str> {
    let idle_contacts: HashSet<&str> = leaves
        .iter()
        .filter(|leaf| leaf.value == LeafValue::Real(0.0))
        .filter_map(|leaf| leaf.path.strip_suffix(".load"))
        .collect();
    let is_unloaded = |ball: &str| {
        ["inner", "outer"]
            .iter()
            .all(|race| idle_contacts.contains(format!("{ball}.{race}").as_str()))
    };
    // `balls[3].inner.approach`, in an assembly `bearings.left.balls[3].inner.approach`.
    let follows = |path: &&str| {
        let Some((ball, name)) = path.split_once("].") else { return false };
        let is_ball = ball.rsplit('.').next().is_some_and(|last| last.starts_with("balls["));
        is_ball && is_place(&name.replace('.', "_")) && is_unloaded(&format!("{ball}]"))
    };
    leaves.iter().map(|leaf| leaf.path.as_str()).filter(follows).collect()
}
