//! How often what is bounded is measured.

/// Whether to measure once more: four turns, and up to 24 while a bound is missed, since what else runs on the
/// processor's memory only lengthens a step, and one that waits for memory more than a plain loop that does not.
pub fn once_more(turn: usize, held: bool) -> bool {
    turn < if held { 4 } else { 24 }
}
