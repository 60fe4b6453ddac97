//! From the text of a scene to the numbers the solver gets, each by a formula of its own.

use bearing_dynamics::ch2_housing::bearing::hertz::HertzContact;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::scene;
use bearing_dynamics::scene::Format;
use bearing_dynamics::scene::build::statics::{kinematic_ratios, static_problem};
use nalgebra::Vector3;
use std::f64::consts::PI;

/// Ceramic balls, two steels, and an outer race that is moved and tilted about both axes.
const SCENE: &str = r#"
defaults = "dissertation"
[bearing]
kind = "angular-contact"
balls = 13
ball_phase = "20 deg"
hertz = "hamrock-brewe"
pitch_radius = "28 mm"
contact_angle = "25 deg"

[bearing.inner_race]
groove_radius = "5.2 mm"
material = { youngs_modulus = "210 GPa", poisson_ratio = 0.3, density = "7850 kg/m^3" }

[bearing.outer_race]
groove_radius = "5.3 mm"
material = { youngs_modulus = "195 GPa", poisson_ratio = 0.28, density = "7900 kg/m^3" }

[bearing.ball]
radius = "5 mm"
material = { youngs_modulus = "310 GPa", poisson_ratio = 0.27, density = "3200 kg/m^3" }

[inner_race]
x = { load = "300 N" }
y = { displacement = "3 um" }
z = { load = "-0.2 kN" }
tilt_y = { moment = "1.5 N m" }
tilt_z = { tilt = "0.1 deg" }
speed = "18000 rpm"

[outer_race]
x = "11 um"
y = "-12 um"
z = "13 um"
tilt_y = "0.3 deg"
tilt_z = "-0.2 deg"

[ball_forces]
gravity = ["1 m/s^2", "2 m/s^2", "-9.81 m/s^2"]
centrifugal = true
"#;

const BALL: f64 = 5e-3;
const PITCH: f64 = 28e-3;

fn assert_close(what: &str, ours: f64, expected: f64) {
    // A dozen operations on numbers of which none is a difference of nearly equal ones.
    let error = (ours - expected).abs();
    assert!(error <= 1e-13 * expected.abs(), "{what}: {ours:e} is not {expected:e}");
}

/// Hamrock and Brewe's fit as in their report: k = 1.0339 a^0.636, E = 1.0003 + 0.5968/a,
/// F = 1.5277 + 0.6023 ln a for a = R_y/R_x, and F_N = π k E' √(2 E R/(9 F³)) δ^1.5.
fn assert_contact(what: &str, ours: &HertzContact, race: f64, groove: f64, modulus: f64) {
    let rolling = 1.0 / (1.0 / BALL + 1.0 / race);
    let across = 1.0 / (1.0 / BALL - 1.0 / groove);
    let a = across / rolling;
    let k = 1.0339 * a.powf(0.636);
    let e = 1.0003 + 0.5968 / a;
    let f = 1.5277 + 0.6023 * a.ln();
    let r = rolling * across / (rolling + across);
    // The relative radius across a groove is a difference that takes two digits.
    let stiffness = PI * k * modulus * (2.0 * e * r / (9.0 * f.powi(3))).sqrt();
    let error = (ours.stiffness / stiffness - 1.0).abs();
    assert!(error <= 1e-12, "K_H {what}: {} is not {stiffness}", ours.stiffness);
    assert_close(what, ours.effective_modulus, modulus);
    assert_close(what, ours.radius_rolling, rolling);
}

#[test]
fn every_number_of_a_hybrid_bearing_arrives() {
    let scene = scene::read_str(SCENE, Format::Toml, "hybrid.toml").unwrap();
    let problem = static_problem(&scene).unwrap();
    let angle = 25.0 * PI / 180.0;
    assert_close("ball radius", problem.geometry.ball_radius, BALL);
    assert_close("contact angle", problem.geometry.contact_angle, angle);
    assert_close("ball phase", problem.ball_phase, PI / 9.0);
    assert_eq!(problem.geometry.ball_count, 13);

    // 4/3 π r³ of 3200 kg/m³: 1.676 g.
    assert_close("mass", problem.ball_mass, 3200.0 * PI * 125e-9 * 4.0 / 3.0);
    // 18000 rpm are 600 π rad/s; the ball set turns at ½ (1 − γ) of it, γ = 5/28 cos 25°.
    let gamma = 5.0 / 28.0 * angle.cos();
    assert_close("orbital speed", problem.orbital_speed, 300.0 * PI * (1.0 - gamma));
    assert_eq!(problem.gravity, Vector3::new(1.0, 2.0, -9.81));

    // Races along the contact normal: it meets the axis PITCH/cos α from the ball centre.
    let to_axis = PITCH / angle.cos();
    let (ball, inner, outer) = (0.9271 / 310e9, 0.91 / 210e9, 0.9216 / 195e9);
    assert_contact("inner", &problem.inner_contact, to_axis - BALL, 5.2e-3, 2.0 / (ball + inner));
    assert_contact("outer", &problem.outer_contact, -to_axis - BALL, 5.3e-3, 2.0 / (ball + outer));

    let [x, y, z, tilt_y, tilt_z] = problem.conditions;
    assert_eq!(x, Condition::Load(300.0));
    assert_eq!((z, tilt_y), (Condition::Load(-200.0), Condition::Load(1.5)));
    let (Condition::Displacement(y), Condition::Displacement(tilt_z)) = (y, tilt_z) else {
        panic!("{y:?}, {tilt_z:?}");
    };
    assert_close("y", y, 3e-6);
    assert_close("tilt_z", tilt_z, PI / 1800.0);
}

#[test]
fn an_outer_race_stands_as_its_tilts_say() {
    let scene = scene::read_str(SCENE, Format::Toml, "hybrid.toml").unwrap();
    let problem = static_problem(&scene).unwrap();
    let outer = problem.outer_pose;
    for (name, ours, expected) in [
        ("x", outer.position.x, 11e-6),
        ("y", outer.position.y, -12e-6),
        ("z", outer.position.z, 13e-6),
    ] {
        assert_close(name, ours, expected);
    }
    assert_eq!(problem.frame.position, Vector3::zeros());
    assert!(problem.frame.orientation.angle() == 0.0);
    // ξ about Y takes the axis from +X towards −Z, λ about the tilted Z towards +Y (2.16).
    let (xi, lambda) = (0.3 * PI / 180.0, -0.2 * PI / 180.0);
    let axes = [
        (Vector3::x(), [lambda.cos() * xi.cos(), lambda.sin(), -lambda.cos() * xi.sin()]),
        (Vector3::y(), [-lambda.sin() * xi.cos(), lambda.cos(), lambda.sin() * xi.sin()]),
        (Vector3::z(), [xi.sin(), 0.0, xi.cos()]),
    ];
    for (axis, cosines) in axes {
        let turned = outer.orientation * axis;
        let error = (turned - Vector3::from(cosines)).amax();
        // Unit vectors; a wrong sign moves one by 0.007.
        assert!(error <= 1e-15, "{axis:?} is turned to {turned:?}, not {cosines:?}");
    }
}

#[test]
fn frequencies_count_at_the_contact_angle() {
    let scene = scene::read_str(SCENE, Format::Toml, "hybrid.toml").unwrap();
    let ours = kinematic_ratios(&scene);
    // A ball rolls on circles of radius PITCH ∓ r cos α; at the inner one the race runs with 1, at
    // the outer one it stands. Half the inner point's speed moves the ball centre.
    let (inner, outer) = {
        let offset = BALL * (25.0 * PI / 180.0).cos();
        (PITCH - offset, PITCH + offset)
    };
    let cage = 0.5 * inner / PITCH;
    assert_close("cage", ours.cage, cage);
    assert_close("outer", ours.ball_pass_outer, 13.0 * cage);
    assert_close("inner", ours.ball_pass_inner, 13.0 * (1.0 - cage));
    // Seen from the cage the outer circle passes the ball with cage · outer.
    assert_close("spin", ours.ball_spin, cage * outer / BALL);
}

#[test]
fn without_its_switch_there_is_no_centrifugal_force() {
    let text = SCENE.replace("centrifugal = true", "centrifugal = false");
    let scene = scene::read_str(&text, Format::Toml, "hybrid.toml").unwrap();
    assert_eq!(static_problem(&scene).unwrap().orbital_speed, 0.0);
}
