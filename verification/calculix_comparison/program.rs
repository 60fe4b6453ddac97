//! CalculiX: its decks, its output as kept in `kept.json`, and a new run where `ccx` is on the path.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::mesh::write::write_abaqus;
use nalgebra::DMatrix;
use serde::{Deserialize, Serialize};

use super::{DENSITY, FREE_MODES, HELD_MODES, KINDS, Kind, POISSON, RIGID, YOUNG, forces};
use super::{element, largest, mesh, not_understood, oracle};
use crate::case::CaseError;
use crate::context::CaseContext;

/// Nodes whose displacements are kept, spread evenly over the list of nodes.
const PROBES: usize = 24;

/// Output of CalculiX on all decks; SI units.
#[derive(Debug, Deserialize, Serialize)]
pub struct Kept {
    version: String,
    kinds: Vec<Output>,
}

/// Output for one kind of element.
#[derive(Clone, Debug, Deserialize, Serialize)]
pub struct Output {
    /// At [`probes`], m.
    pub displacements: Vec<[f64; 3]>,
    /// Over all nodes, by axis, m.
    pub largest: [f64; 3],
    /// Hz.
    pub held: Vec<f64>,
    /// Hz.
    pub free: Vec<f64>,
    /// Lower triangles of one element's matrices, N/m and kg.
    stiffness: Vec<Vec<f64>>,
    mass: Vec<Vec<f64>>,
}

impl Output {
    pub fn stiffness(&self) -> DMatrix<f64> {
        symmetric(&self.stiffness)
    }

    pub fn mass(&self) -> DMatrix<f64> {
        symmetric(&self.mass)
    }
}

fn symmetric(lower: &[Vec<f64>]) -> DMatrix<f64> {
    DMatrix::from_fn(lower.len(), lower.len(), |i, j| lower[i.max(j)][i.min(j)])
}

fn lower(matrix: &DMatrix<f64>) -> Vec<Vec<f64>> {
    (0..matrix.nrows()).map(|i| (0..=i).map(|j| matrix[(i, j)]).collect()).collect()
}

/// Indices of the nodes whose displacements are kept.
pub fn probes(nodes: usize) -> impl Iterator<Item = usize> {
    (0..PROBES).map(move |i| i * (nodes - 1) / (PROBES - 1))
}

/// The kept output, after a new run has given the same where CalculiX is installed.
pub fn kept(context: &mut CaseContext) -> Result<Vec<Output>, CaseError> {
    let now = rerun()?;
    if let (Some(path), Some(now)) = (env::var_os("CALCULIX_KEEP"), &now) {
        fs::write(path, compact(&serde_json::to_string_pretty(now)?))?;
    }
    let kept: Kept = serde_json::from_str(include_str!("kept.json"))?;
    let text = match &now {
        None => {
            format!("No ccx on the path: compared with the kept output of {} only.", kept.version)
        }
        Some(now) => {
            compare(&now.kinds, &kept.kinds)?;
            format!(
                "A new run of {} gives the kept output of {} to the seven digits that it prints.",
                now.version, kept.version
            )
        }
    };
    context.finding("calculix", text);
    Ok(kept.kinds)
}

/// A list of numbers a line.
fn compact(pretty: &str) -> String {
    let mut text = String::new();
    for line in pretty.lines() {
        let word = line.trim_start();
        let number = word.starts_with(|c: char| c.is_ascii_digit() || c == '-');
        let closes = word.starts_with(']') && !text.ends_with(['\n', ']']);
        if number || closes {
            text.push_str(word);
        } else {
            text.push('\n');
            text.push_str(word);
        }
    }
    text.trim_start().to_string() + "\n"
}

/// # Errors
/// Names the result in which a new run differs from the kept output.
fn compare(now: &[Output], kept: &[Output]) -> Result<(), CaseError> {
    for ((now, kept), kind) in now.iter().zip(kept).zip(&KINDS) {
        let lists: [(&str, [&[f64]; 2], bool); 5] = [
            ("displacements", [now, kept].map(|of| of.displacements.as_flattened()), false),
            ("held frequencies", [now, kept].map(|of| &of.held[..]), true),
            ("free frequencies", [now, kept].map(|of| of.free.get(RIGID..).unwrap_or(&[])), true),
            ("stiffness", [&now.stiffness.concat(), &kept.stiffness.concat()], false),
            ("mass", [&now.mass.concat(), &kept.mass.concat()], false),
        ];
        for (what, [now, kept], relative) in lists {
            let scale = largest(kept.iter().map(|x| x.abs()));
            let difference =
                |(a, b): (&f64, &f64)| (a - b).abs() / if relative { b.abs() } else { scale };
            let difference = largest(now.iter().zip(kept).map(difference));
            let same = now.len() == kept.len() && difference <= 2e-6; // false for NaN
            if !same {
                let name = kind.name;
                return Err(CaseError::message(format!(
                    "{name}: {what} of a new run of CalculiX differ from the kept ones by {difference:.1e}"
                )));
            }
        }
    }
    Ok(())
}

/// Runs CalculiX on every deck in a temporary folder; `None` where there is no `ccx` on the path.
fn rerun() -> Result<Option<Kept>, CaseError> {
    let version = match Command::new("ccx").arg("-v").output() {
        Ok(output) => String::from_utf8_lossy(&output.stdout).trim().to_string(),
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.into()),
    };
    let folder = env::temp_dir().join(format!("calculix-comparison-{}", std::process::id()));
    fs::create_dir_all(&folder)?;
    let kinds = KINDS.iter().map(|kind| output(kind, &folder)).collect::<Result<_, _>>();
    // Nothing is lost if a temporary folder stays.
    let _ = fs::remove_dir_all(&folder);
    Ok(Some(Kept { version, kinds: kinds? }))
}

fn output(kind: &Kind, folder: &Path) -> Result<Output, CaseError> {
    let mesh = mesh(kind)?;
    let run = |job: &str, mesh: &TetMesh, step: &str| run(folder, kind, job, mesh, step);
    let held = "*BOUNDARY\nx_low,1,3\n";
    let mut loads = String::new();
    for (node, force) in forces(&mesh)?.iter().enumerate() {
        for (axis, force) in force.iter().enumerate().filter(|(_, force)| **force != 0.0) {
            loads += &format!("{}, {}, {force:.12e}\n", node + 1, axis + 1);
        }
    }
    let statics = format!("{held}*STEP\n*STATIC\n*CLOAD\n{loads}*NODE PRINT, NSET=all_nodes\nU\n");
    let all = run("static", &mesh, &statics)?.read("dat", oracle::displacements)?;
    let modes = |job: &str, support: &str, count: usize| {
        let step = format!("{support}*STEP\n*FREQUENCY\n{count}\n");
        run(job, &mesh, &step)?.read("dat", oracle::frequencies)
    };
    let matrices =
        run("element", &element::mesh(kind)?, "*STEP\n*FREQUENCY, SOLVER=MATRIXSTORAGE\n")?;
    let dof = matrices.read("dof", |text| Some(text.to_string()))?;
    let matrix = |end: &str| matrices.read(end, |text| oracle::matrix(text, &dof));
    Ok(Output {
        displacements: probes(all.len()).map(|node| all[node]).collect(),
        largest: [0, 1, 2].map(|axis| largest(all.iter().map(|u| u[axis].abs()))),
        held: modes("held", held, HELD_MODES)?,
        free: modes("free", "", FREE_MODES)?,
        stiffness: lower(&matrix("sti")?),
        mass: lower(&matrix("mas")?),
    })
}

/// Files of one job, without their extension.
struct Job(PathBuf);

impl Job {
    fn read<T>(&self, end: &str, parse: impl Fn(&str) -> Option<T>) -> Result<T, CaseError> {
        let text = fs::read_to_string(self.0.with_extension(end))?;
        parse(&text).ok_or_else(|| not_understood(&format!("{}.{end}", self.0.display())))
    }
}

fn run(
    folder: &Path,
    kind: &Kind,
    job: &str,
    mesh: &TetMesh,
    step: &str,
) -> Result<Job, CaseError> {
    let name = format!("{}_{job}", kind.tag);
    let deck = format!(
        "{}*MATERIAL, NAME=STEEL\n*ELASTIC\n{YOUNG}, {POISSON}\n*DENSITY\n{DENSITY}\n\
         *SOLID SECTION, ELSET=all_elements, MATERIAL=STEEL\n{step}*END STEP\n",
        write_abaqus(mesh)?
    );
    let place = folder.join(&name);
    fs::write(place.with_extension("inp"), deck)?;
    let output = Command::new("ccx")
        .args(["-i", &name])
        .current_dir(folder)
        .env("OMP_NUM_THREADS", "1")
        .output()?;
    if !output.status.success() {
        let text = String::from_utf8_lossy(&output.stdout);
        return Err(CaseError::message(format!("ccx -i {name}: {}: {text}", output.status)));
    }
    Ok(Job(place))
}
