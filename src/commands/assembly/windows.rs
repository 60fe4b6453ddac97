//! Coupling steps of bodies and explicit solids in `bearing plan`.

use bearing_dynamics::motion::bonded_bushing::BondedBushing;
use bearing_dynamics::motion::coupling::CoupledMotion;
use bearing_dynamics::motion::explicit_solid::SteppedSolid;
use bearing_dynamics::motion::simulation::Stepping;
use bearing_dynamics::numeric::clock::{to_digits, whole_number};
use bearing_dynamics::output::session::HousedParts;
use bearing_dynamics::scene::RunSettings;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use std::error::Error;

/// Number and length of the coupling steps, and the steps of each solid within one, at the start of a run.
pub fn windows_text(
    scene: &AssemblyScene,
    parts: HousedParts,
    run: &RunSettings,
) -> Result<String, Box<dyn Error>> {
    let (housed, per_row) = parts.started(run.output_interval)?;
    let all = whole_number(run.end, run.output_interval) * per_row;
    let mut nodes = String::new();
    for seat in housed.seats() {
        let (tested, outside_range) = seat.counts();
        let of = seat.seat.suffix();
        nodes += &format!(
            "; at the start {tested} bore nodes{of} tested for contact, {outside_range} too far away"
        );
        if outside_range > 0 {
            let moved = to_digits(0.5e6 * seat.seat.reach, 3);
            nodes += &format!(", sorted again after each motion of race and bore by {moved} um");
        }
    }
    let steps = |part: &SteppedSolid| {
        let of = part.name.as_ref().map_or(String::new(), |name| format!(" {name}"));
        let limit = part.solid.limit.step;
        let what = part.kind();
        let of = if of.strip_prefix(' ') == Some(what) { String::new() } else { of };
        format!("{} of the {what}{of} (limit {limit:.3e} s)", steps_of(part.steps))
    };
    let mut solids: Vec<String> = housed.solids.iter().map(steps).collect();
    let of_bushing =
        |of: &BondedBushing| format!("{} of the bushing {}", steps_of(of.steps), of.name);
    solids.extend(housed.bushings.iter().map(of_bushing));
    let cut = cut_to_coupling_step(scene, &housed, run);
    Ok(format!(
        "{all} coupling steps of {:.3e} s to t = {} s, each {} and steps of the bearing up to {:.3e} s{cut}{nodes}",
        housed.coupling_step,
        run.end,
        solids.join(" and "),
        housed.simulation.step_size
    ))
}

/// Requested steps that are shortened, because no step is longer than a coupling step.
fn cut_to_coupling_step(
    scene: &AssemblyScene,
    housed: &CoupledMotion,
    run: &RunSettings,
) -> String {
    let shorter = |of: f64, than: f64| of < than * (1.0 - 1e-9);
    let (coupling_step, mut text) = (housed.coupling_step, String::new());
    let step = housed.simulation.step_size;
    if let Stepping::Fixed(given) = run.options.stepping
        && shorter(step, given)
    {
        text += &format!("; numerics.step = {given:e} s is cut to the coupling step");
    }
    for (part, placed) in
        housed.solids.iter().zip(scene.bearings.iter().filter_map(|placed| placed.housing.as_ref()))
    {
        let settings = &placed.settings;
        let is_default =
            settings.defaults_used.iter().any(|used| used.key.ends_with("step_fraction"));
        let resulting = coupling_step / part.steps as f64 / part.solid.limit.step;
        if !is_default && part.steps == 1 && shorter(resulting, settings.step_fraction) {
            text += &format!(
                "; housing.step_fraction = {} becomes {}, as its step is cut to the coupling step",
                settings.step_fraction,
                to_digits(resulting, 2)
            );
        }
    }
    text
}

fn steps_of(count: usize) -> String {
    if count == 1 { "one step".into() } else { format!("{count} steps") }
}
