//! Invariants of the repository: imports, equations, words and length of pages.

mod architecture;
mod equations_map;
mod words;
