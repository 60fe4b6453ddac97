//! What a scene of bearings can be asked for: its statics, and the parts whose elements move in a run.

use crate::scene::build::about::SetupError;
use crate::scene::build::assembly::{AssemblyScene, PlacedBearing, Spring};
use crate::scene::resolve::resolved::CageMethod;

impl AssemblyScene {
    /// Checks that no bore has friction, which an equilibrium cannot include.
    ///
    /// # Errors
    ///
    /// The first bore with friction.
    pub fn check_smooth(&self) -> Result<(), SetupError> {
        let rough = |placed: &&PlacedBearing| {
            placed.housing.as_ref().is_some_and(|of| of.settings.friction.is_some())
        };
        let Some(rough) = self.bearings.iter().find(rough) else { return Ok(()) };
        let of = rough.name.as_ref().map_or(String::new(), |name| format!(".{name}"));
        let text = "refused: an equilibrium with friction depends on how the race came to its position, and statics omits \
                    that. Hint: `bearing run` includes friction; leave `friction` out for an equilibrium of smooth bores";
        Err(SetupError::key(&format!("housing{of}.friction"), text))
    }

    /// Checks for `statics`, whose equilibrium is that of an energy.
    ///
    /// # Errors
    ///
    /// The first bore with friction; the first spring with a circulatory force.
    pub fn check_statics(&self) -> Result<(), SetupError> {
        self.check_smooth()?;
        let Some(spring) = self.circulatory() else { return Ok(()) };
        let text = "refused: `yz` and `zy` differ, and an equilibrium of an energy has no circulatory force. Hint: `bearing \
                    modes` and `bearing run` include it";
        Err(SetupError::key(&format!("spring.{}.stiffness", spring.name), text))
    }

    /// The first spring whose `yz` and `zy` differ.
    pub fn circulatory(&self) -> Option<&Spring> {
        self.springs.iter().find(|spring| spring.cross.parts()[1] != 0.0)
    }

    /// Returns whether elements of rubber move in a run.
    pub fn has_bushings_in_elements(&self) -> bool {
        let mut bushings = self.springs.iter().filter_map(|spring| spring.bushing.as_deref());
        bushings.any(|of| of.elements.is_some())
    }

    /// Returns whether elements of a shaft move in a run.
    pub fn has_shafts_in_elements(&self) -> bool {
        let mut beams = self.bodies.iter().filter_map(|body| body.beam.as_deref());
        beams.any(|beam| beam.in_elements.is_some())
    }

    /// Number of cages whose elements move in a run.
    pub fn cages_in_elements(&self) -> usize {
        let cages = self.bearings.iter().filter_map(|of| of.scene.dynamics.flexible_cage.as_ref());
        cages.filter(|cage| cage.method == CageMethod::Explicit).count()
    }

    /// Returns whether elements of a cage move in a run.
    pub fn has_cages_in_elements(&self) -> bool {
        self.cages_in_elements() > 0
    }

    /// Returns whether elements of a bushing, shaft or cage move in a run.
    pub fn has_parts_in_elements(&self) -> bool {
        self.has_bushings_in_elements()
            || self.has_shafts_in_elements()
            || self.has_cages_in_elements()
    }
}
