//! Choice between the two integrators with error control, from the assembly alone.
//!
//! The stability limit of `dormand-prince` is set by the decay of slip at the steep onset of traction; `rosenbrock` has no
//! such limit. Where traction does not limit the step, both methods resolve the oscillation of rattling balls, and
//! `dormand-prince` needs less work per step. Balls that stay loaded do not rattle: `rosenbrock` then takes steps of
//! several periods.

use crate::assembly::lists::Assembly;
use crate::motion::simulation::{Integrator, RunOptions};
use crate::motion::start::at_equilibrium;
use crate::motion::step_watch::{Stiffness, stiffness};
use crate::motion::system::System;

/// Largest slip decay rate over contact frequency for `dormand-prince` where balls may rattle: in a cage, or without load
/// within a clearance.
const RATTLING: f64 = 10.0;
/// The same where balls stay loaded.
const LOADED: f64 = 1.0;

/// Integrator of a run whose scene names none, and the reason in a few words.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    pub integrator: Integrator,
    pub reason: String,
}

/// Integrator with error control for an assembly. Traction is judged in equilibrium after the last corner of loads and
/// prescribed motions, when a run-up has reached its speed.
pub fn choose(assembly: &Assembly) -> Choice {
    let rosenbrock = |reason: String| Choice { integrator: Integrator::Rosenbrock, reason };
    if !assembly.solids.is_empty() {
        return rosenbrock("a solid is reduced to modes, which are stiff".into());
    }
    let Some(system) = at_last_corner(assembly) else {
        return rosenbrock("no equilibrium in which to judge traction".into());
    };
    let Stiffness { oscillation, decay } = stiffness(&system);
    let ratio = if decay > 0.0 { decay / oscillation.sqrt() } else { 0.0 };
    let rattles = assembly.bearings.iter().zip(&system.sets).any(|(bearing, set)| {
        let all_loaded = set.table.active.len() == 2 * bearing.geometry.ball_count;
        bearing.cage.is_some() || (bearing.geometry.radial_clearance > 0.0 && !all_loaded)
    });
    let (limit, why) = match rattles {
        true => (RATTLING, "a cage or clearance lets balls rattle"),
        false => (LOADED, "balls stay loaded"),
    };
    let ratio_text = format!("slip decay rate over contact frequency is {ratio:.3}");
    if ratio <= limit {
        let reason = format!("{ratio_text}, not above {limit}: traction is not stiff ({why})");
        return Choice { integrator: Integrator::DormandPrince, reason };
    }
    rosenbrock(format!("{ratio_text}, above {limit}: traction is stiff ({why})"))
}

/// Evaluated in equilibrium, rolling.
fn at_last_corner(assembly: &Assembly) -> Option<System> {
    let time = assembly.corners().last().copied().unwrap_or(0.0);
    let later = assembly.from_time(time);
    let state = at_equilibrium(&later).ok()?;
    let mut system = System::new(later, RunOptions::default().driver);
    system.evaluate(0.0, &state, &mut vec![0.0; state.len()]);
    Some(system)
}
