//! `bearing check SCENE --mesh FILE`: writes the meshes of a scene's solid or housings, with their sets.

use super::{CommandResult, Outcome, print};
use bearing_dynamics::mesh::tet_mesh::TetMesh;
use bearing_dynamics::mesh::write::{write_abaqus, write_gmsh};
use bearing_dynamics::output::atomic::write_atomic;
use bearing_dynamics::output::fields::mesh_with_sets;
use std::error::Error;
use std::path::{Path, PathBuf};

/// Set of all elements in a Gmsh file of a mesh without element sets.
const ALL: &str = "all";

/// File for meshes, in m. A named bearing's mesh has that name in its file name: `block.left.msh`.
pub struct MeshFile<'a> {
    path: &'a Path,
    ending: &'a str,
}

impl MeshFile<'_> {
    /// # Errors
    /// An unknown file extension.
    pub fn of(path: &Path) -> Result<MeshFile<'_>, Box<dyn Error>> {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        if !["msh", "inp", "vtu"].contains(&ending) {
            return Err(format!(
                "--mesh {}: unknown file extension; name a Gmsh file .msh, an Abaqus or CalculiX input file .inp, or a ParaView file .vtu",
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

    /// Writes each mesh; returns the lines to print.
    ///
    /// # Errors
    /// A file that exists or cannot be written, a set name that the format does not allow, no mesh.
    pub fn write(&self, meshes: &[(Option<&str>, &TetMesh)]) -> Result<String, Box<dyn Error>> {
        if meshes.is_empty() {
            return Err("--mesh: the scene has no solid and no housing in elements".into());
        }
        let paths: Vec<PathBuf> = meshes.iter().map(|(name, _)| self.named(*name)).collect();
        if let Some(existing) = paths.iter().find(|path| path.exists()) {
            let existing = existing.display();
            return Err(format!("--mesh: {existing} exists; remove it or name another file").into());
        }
        let mut lines = String::new();
        for ((_, mesh), path) in meshes.iter().zip(paths) {
            let bytes = match self.ending {
                "msh" => write_gmsh(&with_all_elements(mesh))?.into_bytes(),
                "inp" => write_abaqus(mesh)?.into_bytes(),
                _ => mesh_with_sets(mesh)?,
            };
            write_atomic(&path, &bytes)?;
            lines += &format!(
                "wrote {}, in m, in the coordinates of the scene, with all its sets\n",
                path.display()
            );
        }
        Ok(lines)
    }
}

/// Readers of Gmsh files, Gmsh itself among them when it saves again, expect every element in a physical group.
fn with_all_elements(mesh: &TetMesh) -> TetMesh {
    let mut mesh = mesh.clone();
    let is_taken = mesh.node_sets.contains_key(ALL);
    if mesh.element_sets.is_empty() && !is_taken {
        mesh.element_sets.insert(ALL.into(), (0..mesh.elements.len() as u32).collect());
    }
    mesh
}

/// Prints the last lines of a check: the meshes written, if any.
pub fn print_written(written: Option<String>) -> CommandResult {
    written.map_or(Ok(()), |text| print(&text))?;
    Ok(Outcome::Done)
}
