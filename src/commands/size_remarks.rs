//! Sizes that are allowed and hardly meant: a key read as another one, a radius written as a diameter, a wrong unit.

use crate::commands::bushing_remarks::beside_its_race;
use crate::commands::scene_remarks::too_thick;
use bearing_dynamics::ch2_housing::bearing::traction::TractionLaw;
use bearing_dynamics::scene::assembly::AssemblyScene;
use bearing_dynamics::scene::excitations::excitations;
use bearing_dynamics::scene::solid::Law;
use bearing_dynamics::scene::{CageInRun, Scene};
use bearing_dynamics::solver::clock::to_digits;

/// Grooves of bearings have 0.505 to 0.54 of the ball's diameter; an osculation of that size read as a conformity, or the other way
/// round, makes 0.93 to 0.99.
const WIDE_GROOVE: f64 = 0.6;
/// Lengths of cages along the axis, over the ball's diameter.
const CAGE_LENGTHS: [f64; 2] = [0.8, 2.5];
/// Of a bearing alone.
pub fn of_bearing(scene: &Scene) -> Vec<String> {
    let mut said = Vec::new();
    let ball = 2.0 * scene.geometry.ball_radius;
    let grooves = [("inner", &scene.geometry.inner), ("outer", &scene.geometry.outer)];
    for (race, groove) in grooves {
        let part = groove.groove_radius / ball;
        if part > WIDE_GROOVE {
            said.push(format!(
                "the {race} groove's radius is {} of the ball's diameter, where 0.505 to 0.54 is usual: check groove_radius; `conformity` is \
                 groove radius over ball diameter, `osculation` ball radius over groove radius",
                to_digits(part, 3)
            ));
        }
    }
    let dynamics = &scene.dynamics;
    if let CageInRun::Body(cage) = &dynamics.cage {
        let length = cage.contacts.length;
        if !(CAGE_LENGTHS[0] * ball..=CAGE_LENGTHS[1] * ball).contains(&length) {
            said.push(format!(
                "the cage is {} mm long around balls of {} mm: check bearing.cage.mass, its unit and the cage's radii, or bearing.cage.length",
                to_digits(1e3 * length, 4),
                to_digits(1e3 * ball, 4)
            ));
        }
    }
    if dynamics.slices == 1 && dynamics.traction != TractionLaw::None {
        said.push(
            "traction.slices = 1: slip does not vary along contacts, most friction from spin is left out"
                .into(),
        );
    }
    said
}

/// Of each bearing, with its name, and of bushings.
pub fn of_sizes(scene: &AssemblyScene) -> Vec<String> {
    let bearings = scene.bearings.iter().flat_map(|placed| {
        let before = placed.name.as_ref().map_or(String::new(), |name| format!("bearing {name}: "));
        of_bearing(&placed.scene).into_iter().map(move |said| format!("{before}{said}"))
    });
    let springs = scene.springs.iter().filter_map(|spring| beside_its_race(scene, spring));
    let materials = strange_materials(scene);
    bearings
        .chain(springs)
        .chain(faster_than_fitted(scene))
        .chain(materials)
        .chain(too_thick(scene))
        .collect()
}

/// Of a modulus (Pa), a density (kg/m³) and gravity (m/s²) what is neither metal, ceramic nor plastic, nor on a planet.
const MODULI: [f64; 2] = [0.5e9, 1000e9];
const DENSITIES: [f64; 2] = [500.0, 25_000.0];
const STRONG_GRAVITY: f64 = 50.0;

/// Of races, balls, shafts and housings, and of gravity.
fn strange_materials(scene: &AssemblyScene) -> Vec<String> {
    let mut found: Vec<(String, f64, f64)> = Vec::new();
    for placed in &scene.bearings {
        let of = placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
        let of_bearing = &placed.scene;
        for (part, material) in [
            ("inner race", of_bearing.inner_material),
            ("outer race", of_bearing.outer_material),
            ("balls", of_bearing.ball_material),
        ] {
            found.push((format!("the {part}{of}"), material.youngs_modulus, material.density));
        }
        if let Some(housing) = &placed.housing
            && let Law::LinearElastic { youngs_modulus, .. } = housing.solid.law
        {
            found.push((format!("the housing{of}"), youngs_modulus, housing.solid.density));
        }
    }
    for body in &scene.bodies {
        let segments = body.beam.iter().flat_map(|beam| &beam.beam.segments);
        found.extend(segments.map(|segment| {
            (format!("body.{}", body.name), segment.youngs_modulus, segment.density)
        }));
    }
    let outside = |value: f64, range: [f64; 2]| !(range[0]..=range[1]).contains(&value);
    let mut said = Vec::new();
    for (what, modulus, density) in found {
        if outside(modulus, MODULI) {
            said.push(format!(
                "{what}: a modulus of {} GPa, where plastics have 1 to 5, metals and ceramics 40 to 700: check the unit",
                to_digits(1e-9 * modulus, 3)
            ));
        }
        if outside(density, DENSITIES) {
            said.push(format!(
                "{what}: a density of {} kg/m^3, where plastics have about 1000, metals and ceramics 1700 to 20 000: check the unit",
                to_digits(density, 3)
            ));
        }
    }
    let gravity = scene.common().gravity.iter().map(|part| part * part).sum::<f64>().sqrt();
    if gravity > STRONG_GRAVITY {
        said.push(format!(
            "gravity is {} m/s^2, 9.81 on earth: check the unit",
            to_digits(gravity, 3)
        ));
    }
    said.dedup();
    said
}

/// What drives the scene faster than the springs of a bushing were fitted for.
fn faster_than_fitted(scene: &AssemblyScene) -> Option<String> {
    let fitted = scene.springs.iter().filter_map(|spring| Some((spring, spring.bushing.as_ref()?)));
    let fitted = fitted.filter(|(_, bushing)| bushing.elements.is_none());
    let (spring, bushing) = fitted.min_by(|a, b| a.1.fastest.total_cmp(&b.1.fastest))?;
    let driven = excitations(scene).into_iter().filter(|of| of.repeats);
    let fast = driven.max_by(|a, b| a.frequency.total_cmp(&b.frequency))?;
    (fast.frequency > bushing.fastest).then(|| {
        format!(
            "{} ({} Hz) is faster than the {} Hz to which the springs of {} answer as its rubber does; beyond they are as stiff as there: write \
             a higher spring.{}.bushing.fastest",
            fast.what,
            to_digits(fast.frequency, 4),
            to_digits(bushing.fastest, 4),
            spring.name,
            spring.name
        )
    })
}
