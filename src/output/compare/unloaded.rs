//! Where a ball without load is shown.
//!
//! A ball that carries nothing has room between the races, and no law says where in it. A program
//! shows it somewhere, and its position, the gaps to both races and the angles under which it sees
//! them follow from that choice. They are not held against a candidate that chose another place;
//! that its loads are zero is.
//!
//! A ball with one loaded contact (its weight, say) is no such ball: its place is determined.

use crate::output::compare::channels::{Leaf, LeafValue};
use crate::output::series::Series;
use std::collections::HashSet;

/// What follows from a ball's place alone; as in `series.csv`.
const PLACE: [&str; 7] = [
    "position_x",
    "position_y",
    "position_z",
    "inner_approach",
    "inner_contact_angle",
    "outer_approach",
    "outer_contact_angle",
];

/// What a report says of the values left out.
pub const NOTE: &str = "position, approach and contact_angle of balls without load";

/// For each row of a table of balls, whether the ball carries nothing; `None` for other tables.
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

/// Whether a column says only where a ball is.
pub fn is_place(column: &str) -> bool {
    PLACE.contains(&column)
}

/// Paths of the leaves of a summary that say where a ball is which carries nothing.
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
    leaves
        .iter()
        .map(|leaf| leaf.path.as_str())
        .filter(|path| {
            path.strip_prefix("balls[").and_then(|rest| rest.split_once("].")).is_some_and(
                |(index, name)| {
                    is_place(&name.replace('.', "_")) && is_unloaded(&format!("balls[{index}]"))
                },
            )
        })
        .collect()
}
