//! A shaft's segments as a mesh of tetrahedra with a layer of nodes at each of its stations.

use crate::ch2_housing::linear_elastic::LinearElastic;
use crate::ch4_rotor::beam::NODES;
use crate::members::beam::{Beam, BeamError, BeamMatrices, BeamSegment};
use crate::members::condensed_shaft;
use crate::members::condensed_shaft::SolidShaftError;
use crate::mesh::generate::{ShaftStep, stepped_shaft, uniform};
use crate::mesh::{Order, TetMesh};
use crate::solids::model::{DampedMotion, SolidProblem};

/// Mesh parameters of a shaft.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShaftMesh {
    /// Ten-node elements, or four-node ones as in the source.
    pub order: Order,
    /// Longest layer of cells along the axis, m.
    pub longest_layer: f64,
    /// Cells around; a multiple of 8.
    pub around: usize,
    /// Cells in the ring about the core of the innermost radius.
    pub radial: usize,
}

impl Beam {
    /// Mesh of its segments between the `ends` of elements (m), element by element.
    ///
    /// # Errors
    ///
    /// Dimensions refused by the generator.
    pub fn tetrahedral(
        &self,
        mesh: &ShaftMesh,
        (ends, segments): (&[f64], &[usize]),
    ) -> Result<TetMesh, SolidShaftError> {
        let mut steps: Vec<ShaftStep> = Vec::new();
        let mut before = None;
        for (pair, &segment) in ends.windows(2).zip(segments) {
            let of = &self.segments[segment];
            if before != Some(segment) {
                steps.push(ShaftStep {
                    layers: vec![pair[0]],
                    inner_radius: 0.5 * of.inner_diameter,
                    outer_radius: 0.5 * of.outer_diameter,
                });
                before = Some(segment);
            }
            let Some(step) = steps.last_mut() else { continue };
            let stations = stations(pair[0], pair[1]);
            for between in stations.windows(2) {
                let layers = ((between[1] - between[0]) / mesh.longest_layer).ceil().max(1.0);
                step.layers.extend(uniform(between[0], between[1], layers as usize).split_off(1));
            }
        }
        let solid = stepped_shaft(&steps, mesh.around, mesh.radial)?;
        Ok(match mesh.order {
            Order::Linear => solid.mesh,
            Order::Quadratic => solid.quadratic()?.mesh,
        })
    }

    /// Mesh of its segments as a free solid, with layers of nodes at the positions `at` (m from its first end); `None`
    /// for a beam.
    ///
    /// # Errors
    ///
    /// See [`Beam::matrices`].
    pub fn solid(&self, at: &[f64]) -> Result<Option<(TetMesh, SolidProblem)>, BeamError> {
        self.check()?;
        let (ends, segments) = self.elements(at)?;
        self.mesh.as_ref().map(|mesh| self.free(mesh, &ends, &segments)).transpose()
    }

    pub(crate) fn tetrahedra(
        &self,
        mesh: &ShaftMesh,
        ends: &[f64],
        segments: &[usize],
        stations: Vec<f64>,
    ) -> Result<BeamMatrices, BeamError> {
        let (mesh, problem) = self.free(mesh, ends, segments)?;
        Ok(condensed_shaft::matrices(&mesh, &problem, stations)?)
    }

    fn free(
        &self,
        mesh: &ShaftMesh,
        ends: &[f64],
        segments: &[usize],
    ) -> Result<(TetMesh, SolidProblem), BeamError> {
        let of = |segment: &BeamSegment| {
            [segment.youngs_modulus, segment.poisson_ratio, segment.density]
        };
        let [youngs_modulus, poisson_ratio, density] = of(&self.segments[0]);
        if self.segments.iter().any(|segment| of(segment) != of(&self.segments[0])) {
            return Err(SolidShaftError::Materials.into());
        }
        let material =
            LinearElastic::new(youngs_modulus, poisson_ratio).map_err(|_| BeamError::Segment {
                number: 1,
                what: "Poisson ratio",
                value: poisson_ratio,
                wanted: "above -1, below 0.5",
            })?;
        let mesh = self.tetrahedral(mesh, (ends, segments))?;
        let problem = SolidProblem {
            nodes: mesh.nodes.clone(),
            elements: mesh.elements.clone(),
            material,
            density,
            damping: 0.0,
            damped_motion: DampedMotion::Absolute,
            prescribed: Vec::new(),
            loads: Vec::new(),
            gravity: [0.0; 3],
        };
        Ok((mesh, problem))
    }
}

/// Stations of an element from one end to the other.
pub(crate) fn stations(from: f64, to: f64) -> Vec<f64> {
    uniform(from, to, NODES - 1)
}
