//! Commands on a scene of bearings, and the functions that they share.

pub mod check;
pub mod housing;
pub mod housings;
pub mod inertia;
pub mod lists;
pub mod modes;
pub mod plan;
pub mod shapes;
pub mod statics;
mod whirl;
mod windows;

use super::echo;
use bearing_dynamics::equilibrium::lists::StaticAssembly;
use bearing_dynamics::motion::plan::race_freedom;
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::results::RunRecord;
use bearing_dynamics::plan::Item;
use bearing_dynamics::scene::build::assembly::{
    AssemblyScene, Carrier, PlacedBearing, PlacedHousing,
};
use bearing_dynamics::scene::build::statics::{static_problem, still_lists};
use bearing_dynamics::scene::resolve::housing_scene::HousingMethod;
use bearing_dynamics::scene::{DefaultUsed, Document};
use lists::Lists;
use std::error::Error;

type Fallible<T> = Result<T, Box<dyn Error>>;

/// Defaults in use: of bodies and springs, of a run without bearings, then of each bearing, its fit and its housing; for a quasi-static
/// sequence without those of motion.
pub fn defaults(scene: &AssemblyScene) -> Vec<DefaultUsed> {
    const OF_MOTION: [&str; 8] = [
        "traction",
        "contact_damping",
        "ball_contact",
        "numerics.start",
        "numerics.integrator",
        "numerics.step_fraction",
        "numerics.accuracy",
        "numerics.energy_limit",
    ];
    let of_bearing = |placed: &PlacedBearing| {
        let mut all = echo::defaults(&placed.scene);
        let Some(PlacedHousing { settings, solid }) = &placed.housing else { return all };
        for used in &mut all {
            if used.reason.starts_with("where the outer race starts") {
                used.reason =
                    "where the outer race starts, before loads and the housing move it".into();
            }
        }
        if settings.method == HousingMethod::QuasiStatic {
            all.retain(|used| !OF_MOTION.iter().any(|part| used.key.starts_with(part)));
        }
        all.extend_from_slice(&settings.defaults_used);
        all.extend_from_slice(&solid.defaults_used);
        all
    };
    let of_plain = scene.plain.iter().flat_map(|plain| echo::defaults(plain));
    let of_bearings = scene.bearings.iter().flat_map(of_bearing);
    let mut all: Vec<_> =
        scene.defaults_used.iter().cloned().chain(of_plain).chain(of_bearings).collect();
    // A shaft in elements starts undeformed.
    let undeformed = scene.has_shafts_in_elements();
    all.retain(|used| !(undeformed && used.key == "numerics.start"));
    all
}

/// Static problem of the scene; for a single bearing under the given loads with a fixed outer race, unless that
/// moves by itself.
pub fn still(lists: &Lists) -> Fallible<StaticAssembly<'static>> {
    Ok(match lists.scene.one_still().filter(|one| one.housing.is_none()) {
        Some(alone) => static_problem(&alone.scene)?.assembly(),
        None => still_lists(lists.scene, lists.assembly()?),
    })
}

/// Scene, plan, assumptions and defaults for the summary.
pub fn record(
    document: &Document,
    lists: &Lists,
    plan: Vec<Item>,
    seconds: Vec<(String, f64)>,
) -> RunRecord {
    let (assumptions, defaults) = (&lists.scene.common().assumptions, defaults(lists.scene));
    super::record(document, plan, assumptions, &defaults, seconds)
}

/// Name of a bearing; "bearing" for a single one.
pub fn name_of(placed: &PlacedBearing) -> &str {
    placed.name.as_deref().unwrap_or("bearing")
}

/// Mounting of bearings, motion and mass of bodies, and springs, one line each.
///
/// # Errors
/// As [`AssemblyScene::assembly`].
pub fn lines(lists: &Lists) -> Fallible<Vec<(String, String)>> {
    let (scene, assembly) = (lists.scene, lists.assembly()?);
    let mut lines = Vec::new();
    for placed in &scene.bearings {
        let mounting = |carrier: &Carrier, own: &str| {
            let on = match carrier {
                Carrier::Own { .. } => own.to_string(),
                Carrier::Body { index, .. } => format!("body.{}", scene.bodies[*index].name),
            };
            format!("{on} at {:.4} mm", 1e3 * carrier.at())
        };
        let [inner, outer] = &placed.carriers;
        let orientation = if placed.reversed { ", reversed" } else { "" };
        lines.push((
            format!("bearing {}", name_of(placed)),
            format!(
                "inner race on {}, outer race on {}{orientation}",
                mounting(inner, "a body of its own"),
                mounting(outer, "a body of its own")
            ),
        ));
    }
    // The scene's bodies come first.
    for (body, made) in scene.bodies.iter().zip(&assembly.bodies) {
        let mass = made.inertia().map_or(0.0, |inertia| inertia.mass);
        let mass_text =
            if mass > 0.0 { format!("{} kg; ", to_digits(mass, 6)) } else { String::new() };
        lines.push((format!("body {}", body.name), mass_text + &race_freedom(&body.race)));
    }
    for spring in &scene.springs {
        let [from, to] = spring.ends.map(|end| scene.name_of_end(end.at));
        let relaxing = match spring.maxwell.len() {
            0 => String::new(),
            1 => ", 1 Maxwell element".into(),
            count => format!(", {count} Maxwell elements"),
        };
        lines.push((format!("spring {}", spring.name), format!("from {from} to {to}{relaxing}")));
        if let Some(bushing) = &spring.bushing {
            let [x, y, _, turn_x, turn_y, _] = spring.stiffness;
            lines.push((
                format!("bushing {}", spring.name),
                format!(
                    "relaxed {x:.4e} N/m along, {y:.4e} N/m across, {turn_x:.4e} N m/rad about its axis, {turn_y:.4e} \
                     N m/rad tilting; to {} Hz its springs fit its vibrations with an error of {:.1e} at most",
                    bushing.fastest,
                    bushing.misses.iter().copied().fold(0.0, f64::max)
                ),
            ));
        }
    }
    Ok(lines)
}
