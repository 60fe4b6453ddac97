//! A scene and its assembly.

use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::build::motion::DynamicsError;
use std::cell::OnceCell;

/// A scene and the lists of its bodies, bearings and shafts. They are built once, at first use, because those of a
/// shaft of tetrahedra take seconds.
pub struct Lists<'s> {
    pub scene: &'s AssemblyScene,
    assembly: OnceCell<Assembly>,
}

impl<'s> Lists<'s> {
    pub fn of(scene: &'s AssemblyScene) -> Lists<'s> {
        Lists { scene, assembly: OnceCell::new() }
    }

    /// With an assembly that exists already.
    pub fn made(scene: &'s AssemblyScene, assembly: Option<Assembly>) -> Lists<'s> {
        Lists { scene, assembly: assembly.map_or_else(OnceCell::new, OnceCell::from) }
    }

    /// Assembly of the scene.
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
