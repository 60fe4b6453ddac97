//! A scene and what the solver takes of it.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::motion::DynamicsError;
use std::cell::OnceCell;

/// A scene and the lists of its bodies, bearings and shafts, which are made where they are asked for first, and once: those
/// of a shaft of tetrahedra take seconds.
pub struct Lists<'s> {
    pub scene: &'s AssemblyScene,
    assembly: OnceCell<Assembly>,
}

impl<'s> Lists<'s> {
    pub fn of(scene: &'s AssemblyScene) -> Lists<'s> {
        Lists { scene, assembly: OnceCell::new() }
    }

    /// With the lists that have been made already.
    pub fn made(scene: &'s AssemblyScene, assembly: Option<Assembly>) -> Lists<'s> {
        Lists { scene, assembly: assembly.map_or_else(OnceCell::new, OnceCell::from) }
    }

    /// The scene's lists.
    ///
    /// # Errors
    /// As [`AssemblyScene::assembly`].
    pub fn assembly(&self) -> Result<&Assembly, DynamicsError> {
        if let Some(made) = self.assembly.get() {
            return Ok(made);
        }
        let made = self.scene.assembly()?;
        Ok(self.assembly.get_or_init(|| made))
    }
}
