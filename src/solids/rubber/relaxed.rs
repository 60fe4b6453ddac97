//! The relaxed equilibrium of a solid of rubber, long after all loads.

use crate::kinematics::vec3::Vec3;
use crate::numeric::profile::Profile;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::error::{SolidError, StepFailure};
use crate::solids::rubber::checkpoint::RubberState;
use crate::solids::rubber::measures::network_energy;
use crate::solids::rubber::model::RubberModel;
use crate::solids::rubber::path_following::PathLimits;
use crate::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use thiserror::Error;

/// An equilibrium, and its cost.
#[derive(Clone, Debug)]
pub struct Relaxed {
    pub state: RubberState,
    /// Forces of the supports on all nodes, N.
    pub reactions: Vec<Vec3>,
    /// Energy of the network, J.
    pub energy: f64,
    /// Number of load steps.
    pub steps: u64,
    pub iterations: usize,
    pub factorisations: usize,
    pub ran: Counts,
}

/// No equilibrium under all, or a part, of the supports and loads.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RelaxedError {
    #[error(transparent)]
    Rubber(#[from] SolidError),
    #[error(
        "no equilibrium was found beyond {:.3} % of the given loads and displacements: {failure}", 100.0 * part
    )]
    Lost { part: f64, failure: StepFailure, reached: Vec<Reached> },
    #[error("interrupted at {:.3} % of the given loads and displacements", 100.0 * part)]
    Stopped { part: f64, reached: Vec<Reached> },
}

/// An intermediate equilibrium.
#[derive(Clone, Debug, PartialEq)]
pub struct Reached {
    /// Fraction of supports and loads.
    pub part: f64,
    pub displacement: Vec<Vec3>,
    /// Forces of the supports on all nodes, N.
    pub reactions: Vec<Vec3>,
}

/// A load step changes strains by 2 % unless it is a two-hundredth of the whole: at 5 % a bonded bushing whose path
/// ends at 6.87 mm of 20 mm of rubber was found beyond the end. The jump of that bushing loses 0.7 % of the work of a
/// tenth of a millimetre; the error of the trapezoidal rule falls with the square of the step, so that a smooth step
/// passes when it is short enough.
const WAY: PathLimits = PathLimits { strain: 0.02, short: 0.005, lost: 3e-3 };

/// Equilibrium under the supports and loads at time `t` (s), increased together at once or in as many steps as needed.
///
/// # Errors
///
/// No equilibrium; a body that is free to move; no memory.
pub fn relaxed(model: &RubberModel, t: f64) -> Result<Relaxed, RelaxedError> {
    relaxed_while(model, t, |_| true)
}

/// As [`relaxed`]; stops when the function that is called with each intermediate equilibrium returns `false`.
///
/// # Errors
///
/// The same; [`RelaxedError::Stopped`].
pub fn relaxed_while(
    model: &RubberModel,
    t: f64,
    mut go_on: impl FnMut(f64) -> bool,
) -> Result<Relaxed, RelaxedError> {
    let ramp = |to: f64| Profile::Ramp { from: 0.0, to, start: 0.0, duration: 1.0 };
    let mut model = model.clone();
    model.problem.material.maxwell.clear();
    for held in &mut model.problem.prescribed {
        held.profile = ramp(held.profile.value(t));
    }
    for load in &mut model.problem.loads {
        load.profile = ramp(load.profile.value(t));
    }
    let stepping = Stepping::Fixed(1.0);
    let options =
        StepOptions { stepping, smallest: 1e-7, way: Some(WAY), ..StepOptions::default() };
    let mut solid = RubberSolid::new(&model, options)?;
    let mut reached = Vec::new();
    let ended = solid.advance_while(1.0, |solid| {
        let (displacement, reactions) = (solid.displacement().to_vec(), solid.support_forces());
        reached.push(Reached { part: solid.time(), displacement, reactions });
        go_on(solid.time())
    });
    match ended {
        Ok(()) => {}
        Err(SolidError::NoEquilibrium { time, failure, .. }) => {
            return Err(RelaxedError::Lost { part: time, failure, reached });
        }
        Err(SolidError::Stopped { time }) => {
            return Err(RelaxedError::Stopped { part: time, reached });
        }
        Err(other) => return Err(other.into()),
    }
    let state = solid.state().clone();
    let lost = |failure| RelaxedError::Lost { part: 1.0, failure, reached: Vec::new() };
    let energy = network_energy(&model, &state.displacement).map_err(lost)?;
    let (iterations, factorisations) = solid.work();
    let mut ran = *solid.ran();
    let steps = ran.take(Stage::Implicit);
    ran.add(Stage::SolidStatics, steps);
    let reactions = solid.support_forces();
    Ok(Relaxed { state, reactions, energy, steps, iterations, factorisations, ran })
}
