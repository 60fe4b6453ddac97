//! The points of a sweep: a grid over the varied keys, the last one fastest.

use crate::commands::assembly::lists::Lists;
use crate::commands::assembly::still;
use bearing_dynamics::output::state::hexadecimal;
use bearing_dynamics::scene::build::assembly::AssemblyScene;
use bearing_dynamics::scene::tables::keys;
use bearing_dynamics::scene::{Document, SceneError, Subject, SweepAxis, resolve, resolve_subject};
use sha2::{Digest, Sha256};
use std::error::Error;
use std::ops::Range;

pub struct Grid {
    pub axes: Vec<SweepAxis>,
    /// All keys change together, value by value.
    together: bool,
}

/// More points than this in one sweep are taken for a mistake.
const MOST_POINTS: usize = 100_000_000;

impl Grid {
    /// Axes from `key=values` texts, or from the scene's own table if there are none.
    pub fn new(
        document: &Document,
        vary: &[String],
        together: bool,
    ) -> Result<Grid, Box<dyn Error>> {
        let mut axes: Vec<SweepAxis> = Vec::new();
        for text in vary {
            let Some((key, values)) = text.split_once('=') else {
                return Err(format!(
                    "--vary {text}: no '='; write --vary \"bearing.clearance.radial=5 um, 0 um\""
                )
                .into());
            };
            axes.push(document.axis(key.trim(), values.trim())?);
        }
        if vary.is_empty() {
            axes = document.sweep();
        }
        if axes.is_empty() {
            return Err(format!(
                "{}: nothing to vary; give --vary KEY=VALUES or a [sweep] table",
                document.name()
            )
            .into());
        }
        for (i, axis) in axes.iter().enumerate() {
            let Some(leads) = keys::find_named(&axis.key) else { continue };
            for other in &axes[..i] {
                if other.key == axis.key {
                    return Err(format!("{} is varied twice", axis.key).into());
                }
                let excludes = keys::find_named(&other.key).is_some_and(|second| {
                    (second.name, second.item) == (leads.name, leads.item)
                        && leads.key.rivals().any(|rival| rival.path == second.key.path)
                });
                if excludes {
                    return Err(format!(
                        "{} and {} exclude each other; vary one of them",
                        other.key, axis.key
                    )
                    .into());
                }
            }
        }
        let together = together || (vary.is_empty() && document.sweeps_together());
        if together {
            let first = axes[0].len();
            if let Some(other) = axes.iter().find(|axis| axis.len() != first) {
                return Err(format!(
                    "{} has {first} values and {} has {}; keys that vary together need as many of each",
                    axes[0].key,
                    other.key,
                    other.len()
                )
                .into());
            }
            return Ok(Grid { axes, together });
        }
        let points = axes.iter().try_fold(1usize, |points, axis| points.checked_mul(axis.len()));
        match points {
            Some(points) if points <= MOST_POINTS => Ok(Grid { axes, together }),
            _ => {
                Err(format!("the grid has more than {MOST_POINTS} points; vary fewer values")
                    .into())
            }
        }
    }

    pub fn len(&self) -> usize {
        let axes = if self.together { &self.axes[..1] } else { &self.axes };
        axes.iter().map(SweepAxis::len).product()
    }

    /// Points of each block of `size`.
    pub fn blocks(&self, size: usize) -> impl Iterator<Item = Range<usize>> {
        let points = self.len();
        (0..points).step_by(size).map(move |first| first..(first + size).min(points))
    }

    /// Index on every axis of a point.
    pub fn indices(&self, point: usize) -> Vec<usize> {
        if self.together {
            return vec![point; self.axes.len()];
        }
        let mut rest = point;
        let mut indices = vec![0; self.axes.len()];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = rest % axis.len();
            rest /= axis.len();
        }
        indices
    }

    /// The document of a point.
    pub fn document(&self, document: &Document, point: usize) -> Result<Document, SceneError> {
        let mut document = document.clone();
        for (axis, index) in self.axes.iter().zip(self.indices(point)) {
            if let Some(value) = axis.value(index) {
                document.set(&axis.key, &value)?;
            }
        }
        Ok(document)
    }

    /// The scene of a point.
    pub fn scene(&self, document: &Document, point: usize) -> Result<AssemblyScene, SceneError> {
        let document = self.document(document, point)?;
        match resolve_subject(&document)? {
            Subject::Assembly(scene) => Ok(*scene),
            // Refused, with the reason.
            Subject::Solid(_) => Ok(AssemblyScene::alone(resolve(&document)?)),
        }
    }

    /// Refuses a sweep of statics none of whose points describes a bearing, with what is wrong at the first.
    pub fn check(&self, document: &Document) -> Result<(), Box<dyn Error>> {
        if self.axes.iter().any(|axis| axis.key == "housing.method") {
            let text = "housing.method: statics of a flexible housing is one for all methods, and a \
                        rigid one has another table; sweep the two by themselves";
            return Err(text.into());
        }
        self.check_any(|point| {
            let scene = self.scene(document, point)?;
            scene.check_statics()?;
            still(&Lists::of(&scene)).map(|_| ())
        })
    }

    /// The error of the first point if all have one. Looks at up to `LOOKS` points, evenly spread over the grid.
    pub fn check_any(
        &self,
        problem: impl Fn(usize) -> Result<(), Box<dyn Error>>,
    ) -> Result<(), Box<dyn Error>> {
        const LOOKS: usize = 1000;
        let Err(first) = problem(0) else { return Ok(()) };
        let mut others = (0..self.len()).step_by(self.len().div_ceil(LOOKS)).skip(1);
        if others.any(|point| problem(point).is_ok()) { Ok(()) } else { Err(first) }
    }

    /// SHA-256 of scene, axes and program version, to which the rows of an unfinished sweep belong. `mesh` is the content of
    /// the mesh files of the scene.
    pub fn hash(&self, document: &Document, mesh: &[u8]) -> String {
        let mut hash = Sha256::new();
        hash.update(document.written_out(&[]).to_string());
        hash.update(mesh);
        hash.update(format!("{:?} {} {}", self.axes, self.together, env!("CARGO_PKG_VERSION")));
        hexadecimal(hash)
    }
}
