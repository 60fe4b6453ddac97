//! Small vibrations of a bushing over frequency: its dynamic stiffness and damping (3.13)–(3.14).

use crate::ch3_bushing::hysteresis::{Hysteresis, of_complex_stiffness};
use crate::plan::Stage;
use crate::plan::counts::Counts;
use crate::solids::error::SolidError;
use crate::solids::rubber::harmonic::{ComplexStiffness, complex_stiffness};
use crate::solids::rubber::model::RubberModel;
use std::f64::consts::TAU;

/// Relative change of the stiffness by the last vector: the loss factor, a hundredth of it, keeps ten digits.
const TOLERANCE: f64 = 1e-10;

/// Response at one frequency.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Hz; zero is the relaxed network.
    pub frequency: f64,
    pub stiffness: ComplexStiffness,
    pub hysteresis: Hysteresis,
}

/// Response to the motion of the prescribed components, at each of `frequencies` (Hz).
///
/// # Errors
///
/// Those of [`complex_stiffness`].
pub fn vibrations(
    model: &RubberModel,
    frequencies: &[f64],
    ran: &mut Counts,
) -> Result<Vec<Answer>, SolidError> {
    let pulsations: Vec<f64> = frequencies.iter().map(|frequency| TAU * frequency).collect();
    let answers = complex_stiffness(model, 0.0, &pulsations, TOLERANCE)?;
    ran.add(Stage::LinearSystem, frequencies.len() as u64);
    let terms = model.problem.material.maxwell.len();
    ran.add(Stage::Maxwell, (terms * frequencies.len()) as u64);
    let answer = |(frequency, stiffness): (&f64, ComplexStiffness)| Answer {
        frequency: *frequency,
        stiffness,
        hysteresis: of_complex_stiffness(stiffness.storage, stiffness.loss),
    };
    Ok(frequencies.iter().zip(answers).map(answer).collect())
}
