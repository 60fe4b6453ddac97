//! What the repository promises about itself: imports, equations.

mod architecture;
mod equations_map;
