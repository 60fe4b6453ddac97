//! Effect of inertia on a quasi-static result, (f/f_n)²: fastest excitation over lowest natural frequency.

use super::Fallible;
use super::housing::Housing;
use super::modes::housing_modes;
use bearing_dynamics::equilibrium::quasi_static_limit::lowest_frequency;
use bearing_dynamics::equilibrium::quasi_static_sequence::{EquilibriumAt, QuasiStaticProblem};
use bearing_dynamics::equilibrium::warm_started_search::WarmStartedSearch;
use bearing_dynamics::numeric::clock::to_digits;
use bearing_dynamics::output::results::quantity;
use bearing_dynamics::reduction::fixed_interface_modes::vibrating_housing;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::excitations::{Excitation, excitations};
use serde_json::{Value, json};

/// Natural modes kept for each housing: four give the lowest frequency of a pillow block to 1e-5.
const NATURAL: usize = 4;

/// The lowest natural frequency and the fastest excitation of a scene with housings.
pub struct FrequencyRatio {
    /// Hz.
    lowest: f64,
    fastest: Excitation,
}

impl FrequencyRatio {
    /// Ratio at the equilibrium `found`; `None` without a periodic excitation, or if a body has no stiffness.
    ///
    /// # Errors
    /// If the natural modes of a housing are not found.
    pub fn of(
        scene: &AssemblyScene,
        problem: &QuasiStaticProblem,
        housings: &[Housing],
        search: &WarmStartedSearch,
        found: &EquilibriumAt,
    ) -> Fallible<Option<FrequencyRatio>> {
        let all = excitations(scene).into_iter();
        let Some(fastest) = all.max_by(|a, b| a.frequency.total_cmp(&b.frequency)) else {
            return Ok(None);
        };
        let bodies = problem.moving();
        let mut masses = Vec::new();
        for ((bore, seat), housing) in search.bores().iter().zip(&problem.seats).zip(housings) {
            let body = seat.body(&problem.assembly);
            let Some(race) = bodies.iter().position(|of| of.body == body) else { continue };
            let (natural, _) = housing_modes(housing, bore.bore(), NATURAL)?;
            masses.push(vibrating_housing(
                bore,
                &housing.setup.model,
                race,
                &natural,
                seat.damping,
            ));
        }
        let lowest = lowest_frequency(&found.solution.with_shapes, &bodies, &masses);
        Ok(lowest.filter(|lowest| *lowest > 0.0).map(|lowest| FrequencyRatio { lowest, fastest }))
    }

    fn squared(&self) -> f64 {
        (self.fastest.frequency / self.lowest).powi(2)
    }

    /// Section of the summary.
    ///
    /// # Errors
    /// A value that is not finite.
    pub fn section(&self) -> Fallible<Value> {
        Ok(json!({
            "lowest_frequency": quantity("frequency", self.lowest, "Hz")?,
            "fastest_excitation": self.fastest.what,
            "fastest_frequency": quantity("frequency", self.fastest.frequency, "Hz")?,
            "frequency_ratio_squared": quantity("ratio", self.squared(), "1")?,
        }))
    }

    pub fn text(&self) -> String {
        format!(
            "(f/f_n)² = {} of the displacement caused by {} ({} Hz); lowest natural frequency {} Hz",
            to_digits(self.squared(), 2),
            self.fastest.what,
            to_digits(self.fastest.frequency, 4),
            to_digits(self.lowest, 4)
        )
    }
}
