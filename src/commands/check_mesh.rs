//! `bearing check SCENE --mesh FILE`: the meshes of a scene's solid or housings as they were understood, with their sets.

use super::{CommandResult, Outcome, say};
use bearing_dynamics::mesh::tet_mesh::TetMesh;
use bearing_dynamics::mesh::write::{write_abaqus, write_gmsh};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::mesh_with_sets;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Where meshes go, in m; one of a bearing with a name has it in its own: `block.left.msh`.
pub struct MeshFile<'a> {
    path: &'a Path,
    ending: &'a str,
}

impl MeshFile<'_> {
    /// # Errors
    /// An ending that tells no format.
    pub fn of(path: &Path) -> Result<MeshFile<'_>, Box<dyn Error>> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if !["msh", "inp", "vtu"].contains(&ending) {
            return Err(format!(
                "--mesh {}: the name's ending tells the format, and this one is not known; name a Gmsh file .msh, an Abaqus or CalculiX \
                 input file .inp, a ParaView file .vtu",
                path.display()
            )
            .into());
        }
        Ok(MeshFile { path, ending })
    }

    fn named(&self, name: Option<&str>) -> PathBuf {
        match name {
            Some(name) => self.path.with_extension(format!("{name}.{}", self.ending)),
            None => self.path.to_path_buf(),
        }
    }

    /// Writes each mesh and says so.
    ///
    /// # Errors
    /// A file that is there already, one that cannot be written, a name of a set that the format has no place for, no mesh at all.
    pub fn write(&self, meshes: &[(Option<&str>, &TetMesh)]) -> Result<String, Box<dyn Error>> {
        if meshes.is_empty() {
            return Err("--mesh: the scene has no solid and no housing in elements".into());
        }
        let paths: Vec<PathBuf> = meshes.iter().map(|(name, _)| self.named(*name)).collect();
        if let Some(there) = paths.iter().find(|path| path.exists()) {
            let there = there.display();
            return Err(format!("--mesh: {there} exists; remove it or name another file").into());
        }
        let mut said = String::new();
        for ((_, mesh), path) in meshes.iter().zip(paths) {
            let bytes = match self.ending {
                "msh" => write_gmsh(mesh)?.into_bytes(),
                "inp" => write_abaqus(mesh)?.into_bytes(),
                _ => mesh_with_sets(mesh)?,
            };
            write_atomic(&path, &bytes)?;
            said += &format!(
                "wrote {}, in m, where it stands in the scene and with all its sets\n",
                path.display()
            );
        }
        Ok(said)
    }
}

/// Says what was written, if anything was: the last lines of a check.
pub fn say_written(written: Option<String>) -> CommandResult {
    written.map_or(Ok(()), |text| say(&text))?;
    Ok(Outcome::Done)
}
