//! Implicit steps and small vibrations of the four-node elements of explicit steps.
//!
//! A four-node element is treated as a ten-node element whose mid-side nodes have no shape function and whose
//! quadrature points all have one gradient. Volumes around corner nodes are then its nodal volumes
//! ([`crate::elements::tet4_nodal`]); one patch for each element gives the source's element, which locks. Everything
//! for ten-node elements applies; only the cost is that of ten nodes.

use crate::elements::tet4::Tet4;
use crate::elements::tet10::{POINTS, Point, Tet10};
use crate::solids::error::SolidError;
use crate::solids::model::corners;
use crate::solids::rubber::explicit::RubberBody;
use crate::solids::rubber::model::{Patch, RubberModel, RubberProblem};
use crate::solids::rubber::tet_forces::MeanStress;

impl RubberBody {
    /// The same body and elements for implicit steps: without inertia, mass and gravity.
    ///
    /// # Errors
    ///
    /// Those of [`RubberBody::model`] and [`RubberModel::new`].
    pub fn implicit(&self) -> Result<RubberModel, SolidError> {
        // Checks elements and supports.
        self.model()?;
        let sound = "elements were checked when the model was made";
        let tets: Vec<Tet10> = self
            .elements
            .iter()
            .map(|element| widened(&Tet4::new(&corners(&self.nodes, element)).expect(sound)))
            .collect();
        let elements: Vec<[u32; 10]> = self
            .elements
            .iter()
            .map(|[a, b, c, d]| [*a, *b, *c, *d, *a, *a, *a, *a, *a, *a])
            .collect();
        let problem = RubberProblem {
            nodes: self.nodes.clone(),
            elements,
            material: self.material.clone(),
            prescribed: self.prescribed.clone(),
            loads: self.loads.clone(),
        };
        match self.mean_stress {
            MeanStress::AroundNodes => RubberModel::of_elements(problem, tets, None),
            MeanStress::OfElement => {
                let own = |(element, nodes): (u32, &[u32; 10])| {
                    let mut nodes = nodes[..4].to_vec();
                    nodes.sort_unstable();
                    let volume = tets[element as usize].points.iter().map(|p| p.volume).sum();
                    Patch { elements: (0..4).map(|c| (element, c)).collect(), nodes, volume }
                };
                let patches = (0u32..).zip(&problem.elements).map(own).collect();
                let patches_of = (0..problem.elements.len() as u32).map(|e| [e; 4]).collect();
                RubberModel::of_elements(problem, tets, Some((patches, patches_of)))
            }
        }
    }
}

/// A ten-node element with six inactive nodes.
fn widened(tet: &Tet4) -> Tet10 {
    let [a, b, c] = tet.gradients;
    let last = [0, 1, 2].map(|i: usize| -(a[i] + b[i] + c[i]));
    let mut gradients = [[0.0; 3]; 10];
    gradients[..4].copy_from_slice(&[a, b, c, last]);
    let point = Point { gradients, volume: tet.volume / POINTS as f64 };
    Tet10 { points: [point; POINTS] }
}
