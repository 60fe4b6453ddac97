//! Bearings on one shaft, as scenes.
#![allow(dead_code)]

/// A bearing of Table 5.3 for either end.
pub const BEARING: &str = r#"
defaults = "dissertation"
[bearing]
kind = "angular-contact"
balls = 11
pitch_radius = "30 mm"
contact_angle = "35 deg"
inner_race = { groove_radius = "6.6 mm" }
outer_race = { groove_radius = "6.6 mm" }
ball = { radius = "5.953 mm" }
"#;

/// Two of them back to back, preloaded.
pub const ENDS: &str = r#"
[bearing.left]
inner_at = "-40 mm"
[bearing.right]
inner_at = "40 mm"
reversed = true
[outer_race.left]
x = "-6 um"
[outer_race.right]
x = "6 um"
"#;

/// What they carry.
pub const SHAFT: &str = r#"
[body.shaft]
speed = "1000 rpm"
x = { load = "100 N" }
y = { load = "30 N" }
z = { load = "-500 N" }
tilt_y = { moment = "35 N m" }
inertia = { mass = "0.67 kg", axial = "7.5e-5 kg m^2", transverse = "8.4e-4 kg m^2" }
"#;

/// A moment of a run without traction.
pub const RUN: &str = r#"
[numerics]
end = "2 ms"
step = "1 us"
output_interval = "0.1 ms"
[traction]
law = "none"
"#;
