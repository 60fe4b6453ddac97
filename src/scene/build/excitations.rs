//! Excitations of bearings, bodies and housings, and their frequencies: a quasi-static sequence must be slow compared
//! with natural frequencies.

use crate::members::body::{Drive, DrivenBody, RotatingLoad, Rotation};
use crate::numeric::profile::Profile;
use crate::scene::build::assembly::{AssemblyScene, Carrier, PlacedBearing};
use crate::scene::build::statics::kinematic_ratios;
use std::f64::consts::TAU;

/// An excitation of bodies and housings, and its frequency.
#[derive(Clone, Debug, PartialEq)]
pub struct Excitation {
    pub what: String,
    /// Hz.
    pub frequency: f64,
    /// True for a periodic excitation, false for a ramp.
    pub repeats: bool,
    /// True for the ripple of a load as balls pass it.
    pub is_ripple: bool,
}

/// All excitations of a scene.
pub fn excitations(scene: &AssemblyScene) -> Vec<Excitation> {
    let mut found = Vec::new();
    let end = scene.run().map_or(0.0, |run| run.end);
    for (key, race) in driven(scene) {
        add_drives(&mut found, &key, race);
    }
    for body in &scene.bodies {
        let key = format!("body.{}", body.name);
        add_turning(
            &mut found,
            &key,
            &format!("the rotation of the load on {key}"),
            &body.rotating_load,
            end,
        );
    }
    for placed in &scene.bearings {
        of_bearing(&mut found, scene, placed, end);
    }
    found
}

/// Bodies, and races that are bodies of their own, with the key of the table that drives them.
pub fn driven(scene: &AssemblyScene) -> impl Iterator<Item = (String, &DrivenBody)> {
    let bodies = scene.bodies.iter().map(|body| (format!("body.{}", body.name), &body.race));
    let races = scene.bearings.iter().flat_map(|placed| {
        let of = &placed.scene.dynamics;
        let name = placed.name.as_ref().map_or(String::new(), |name| format!(".{name}"));
        let own = |side: usize| matches!(placed.carriers[side], Carrier::Own { .. });
        let inner = own(0).then(|| (format!("inner_race{name}"), &of.inner));
        let outer = of.outer.as_ref().filter(|_| own(1));
        inner.into_iter().chain(outer.map(|outer| (format!("outer_race{name}"), outer)))
    });
    bodies.chain(races)
}

fn of_bearing(
    found: &mut Vec<Excitation>,
    scene: &AssemblyScene,
    placed: &PlacedBearing,
    end: f64,
) {
    let dynamics = &placed.scene.dynamics;
    let load = match placed.carriers[0] {
        Carrier::Own { .. } => {
            let key = match &placed.name {
                Some(name) => format!("inner_race.{name}"),
                None => "inner_race".into(),
            };
            let turns = match &placed.name {
                Some(name) => format!("the rotation of the load on {name}"),
                None => "the rotation of the load".into(),
            };
            add_turning(found, &key, &turns, &dynamics.rotating_load, end);
            &dynamics.rotating_load
        }
        Carrier::Body { index, .. } => &scene.bodies[index].rotating_load,
    };
    let cage = kinematic_ratios(&placed.scene).cage;
    let outer = match placed.carriers[1] {
        Carrier::Own { .. } => dynamics.outer.as_ref().map(|outer| &outer.rotation),
        Carrier::Body { index, .. } => Some(&scene.bodies[index].race.rotation),
    };
    let turns = |rotation: &Rotation, t: f64| match rotation {
        Rotation::Speed(speed) => speed.value(t),
        Rotation::Torque(_) => 0.0,
    };
    // The load rotates relative to balls that orbit too.
    let against_balls = most(end, |t| {
        let load = load.as_ref().map_or(0.0, |load| load.speed.value(t));
        let outer = outer.map_or(0.0, |outer| turns(outer, t));
        load - (outer + cage * (turns(&dynamics.inner.rotation, t) - outer))
    }) / TAU;
    let balls = placed.scene.geometry.ball_count as f64;
    let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of {name}"));
    let passing = format!("balls{of} passing the load");
    let (frequency, repeats, is_ripple) = (balls * against_balls, true, true);
    if frequency > 0.0 {
        found.push(Excitation { what: passing, frequency, repeats, is_ripple });
    }
    if let Some(ramp) = placed.housing.as_ref().and_then(|housing| housing.settings.fit_ramp) {
        add(found, format!("the growth of the fit{of}"), 0.5 / ramp, false);
    }
}

fn add(found: &mut Vec<Excitation>, what: String, frequency: f64, repeats: bool) {
    if frequency > 0.0 {
        found.push(Excitation { what, frequency, repeats, is_ripple: false });
    }
}

/// A prescribed load or motion over time.
fn add_profile(found: &mut Vec<Excitation>, what: String, profile: &Profile) {
    add(found, what, frequency(profile), profile.cycles() > 0.0);
}

fn add_drives(found: &mut Vec<Excitation>, key: &str, body: &DrivenBody) {
    let names = ["x", "y", "z", "tilt_y", "tilt_z"];
    for (name, drive) in names.iter().zip(&body.drives) {
        let (Drive::Load(profile) | Drive::Motion(profile)) = drive;
        add_profile(found, format!("{key}.{name}"), profile);
    }
}

fn add_turning(
    found: &mut Vec<Excitation>,
    key: &str,
    turns: &str,
    load: &Option<RotatingLoad>,
    end: f64,
) {
    let Some(load) = load else { return };
    add_profile(found, format!("{key}.rotating_load.force"), &load.force);
    add(found, turns.into(), largest(&load.speed, end) / TAU, true);
}

/// Largest magnitude of a speed up to the end of a run.
pub fn largest(profile: &Profile, end: f64) -> f64 {
    most(end, |t| profile.value(t))
}

/// Largest magnitude over time. Speeds are ramps and tables; a hundred samples are sufficient.
fn most(end: f64, of: impl Fn(f64) -> f64) -> f64 {
    (0..=100).map(|i| of(end * f64::from(i) / 100.0).abs()).fold(0.0, f64::max)
}

/// Frequency of an oscillation with the slope of the profile, Hz; 0 for a constant one.
pub fn frequency(profile: &Profile) -> f64 {
    match profile {
        Profile::Constant(_) => 0.0,
        Profile::Ramp { from, to, duration, .. }
        | Profile::SmoothRamp { from, to, duration, .. } => {
            if from == to {
                0.0
            } else {
                0.5 / duration
            }
        }
        Profile::HalfSine { duration, .. } => 0.5 / duration,
        Profile::Harmonic { frequency, .. } => *frequency,
        Profile::Table { points } => {
            let steps = points.windows(2).filter(|pair| pair[0][1] != pair[1][1]);
            steps.map(|pair| 0.5 / (pair[1][0] - pair[0][0])).fold(0.0, f64::max)
        }
    }
}
