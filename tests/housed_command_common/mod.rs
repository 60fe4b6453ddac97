//! A small bearing in a coarse ring.
#![allow(dead_code)]

pub(crate) use crate::solid_command_common as solids;

#[allow(unused_imports)]
pub use solids::{
    Place, column_of as column, command, into_folder, json, shipped, stderr, succeed,
};

pub const BEARING: &str = r#"title = "A bearing in a ring"
defaults = "dissertation"
[assumptions]
ring = "as coarse as a test needs"
[bearing]
kind = "deep-groove"
balls = 8
length = "20 mm"
clearance = { radial = "-4 um" }
[bearing.inner_race]
radius = "20.047 mm"
groove_radius = "6.013 mm"
[bearing.outer_race]
radius = "31.953 mm"
groove_radius = "6.310 mm"
outer_radius = "35.527 mm"
"#;

pub const RACES: &str = r#"[inner_race]
z = { load = "-250 N" }
tilt_y = { tilt = "0 deg" }
tilt_z = { tilt = "0 deg" }
[outer_race]
motion = "5-dof"
[traction]
law = "none"
"#;

pub const RING: &str = r#"[solid]
damping = "77 1/s"
[solid.mesh]
generate = "housing-d"
bore_radius = "35.527 mm"
outer_radius = "50 mm"
depth = "20 mm"
cells = { around = 24, radial = 1, axial = 2 }
order = 1
[[solid.fixed]]
set = "fixed"
x = true
y = true
z = true
"#;

/// A scene of these parts, with `[housing]` and what else is given.
pub fn scene_text(housing: &str, further: &str) -> String {
    format!("{BEARING}{RACES}[housing]\n{housing}\n{RING}{further}\n")
}
