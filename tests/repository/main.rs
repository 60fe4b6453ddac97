//! What the repository promises about itself: imports, equations.

#[path = "../call_graph/mod.rs"]
mod call_graph;

mod architecture;
mod equations_map;
