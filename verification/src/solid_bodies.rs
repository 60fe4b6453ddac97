//! Bodies that cases and studies of flexible solids share: meshes with supports and loads.

/// The clamped beam of the case `cantilever_timoshenko`.
pub mod cantilever {
    use bearing_dynamics::mesh::generate::bar;
    use bearing_dynamics::mesh::{Order, TetMesh};
    use bearing_dynamics::solids::model::SolidProblem;

    use crate::case::CaseError;
    use crate::oracles::timoshenko::{Beam, shear_coefficient};
    use crate::solids::{STEEL, Vec3, free_body, mesh_of, prescribe, surface_force};

    /// Square section, m; length ten times its side.
    pub const SIDE: f64 = 0.01;
    pub const LENGTH: f64 = 0.1;
    /// N; bends the beam by a hundred thousandth of its length, so that it stays linear.
    pub const FORCE: f64 = 0.5;

    pub fn beam() -> Beam {
        Beam {
            length: LENGTH,
            area: SIDE * SIDE,
            inertia: SIDE.powi(4) / 12.0,
            young: STEEL.young,
            poisson: STEEL.poisson,
            density: STEEL.density,
            shear_coefficient: shear_coefficient(SIDE, SIDE, STEEL.poisson),
        }
    }

    /// The half of the beam at y ≥ 0, clamped at x = 0; cells along, across the half and in height.
    pub fn half_beam(
        order: Order,
        cells: [usize; 3],
    ) -> Result<(TetMesh, SolidProblem), CaseError> {
        let mut solid = bar([LENGTH, 0.5 * SIDE, SIDE], cells)?;
        for place in &mut solid.mesh.nodes {
            place[1] += 0.25 * SIDE;
        }
        let mesh = mesh_of(&solid, order)?;
        let mut problem = free_body(&mesh, STEEL);
        prescribe(&mut problem, |[x, y, z]| {
            let clamped = x < 1e-9;
            let diagonal = (y - z.abs()).abs() < 1e-9;
            [
                clamped.then_some(0.0),
                (y < 1e-9).then_some(0.0),
                (clamped && diagonal).then_some(0.0),
            ]
        });
        Ok((mesh, problem))
    }

    /// Half of [`FORCE`] over the free end.
    pub fn tip_load(mesh: &TetMesh) -> Result<Vec<(u32, Vec3)>, CaseError> {
        let stress = FORCE / (SIDE * SIDE);
        Ok(surface_force(mesh, mesh.surface_set("x_high")?, |_, _| [0.0, 0.0, stress]))
    }

    /// Mean over the section that `load` pulls at, as a beam's deflection is, m.
    pub fn deflection(load: &[(u32, Vec3)], displacement: &[Vec3]) -> f64 {
        let work = load.iter().map(|(node, force)| force[2] * displacement[*node as usize][2]);
        work.sum::<f64>() / (0.5 * FORCE)
    }
}

/// The ring under inner pressure of the case `thick_ring_lame`.
pub mod thick_ring {
    use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
    use bearing_dynamics::mesh::{Order, TetMesh};
    use bearing_dynamics::solids::model::SolidProblem;

    use crate::case::CaseError;
    use crate::oracles::lame::{Ends, ThickRing};
    use crate::solids::{STEEL, Vec3, constant_load, free_body, mesh_of, prescribe, surface_force};

    /// m; outer over inner radius 2.
    pub const BODY: Ring = Ring { inner_radius: 0.02, outer_radius: 0.04, width: 5e-3 };
    /// Pa; strains of a few millionths, so that the ring stays linear.
    const PRESSURE: f64 = 2e5;

    pub fn exact() -> ThickRing {
        ThickRing {
            inner: BODY.inner_radius,
            outer: BODY.outer_radius,
            young: STEEL.young,
            poisson: STEEL.poisson,
            pressure: PRESSURE,
        }
    }

    /// The ring on planes of symmetry under its pressure.
    pub fn pressed(
        order: Order,
        around: usize,
        radial: usize,
        ends: Ends,
    ) -> Result<(TetMesh, SolidProblem), CaseError> {
        let cells = RingMesh { around, radial, axial: 1, radial_growth: 1.15 };
        let mesh = mesh_of(&ring(&BODY, &cells)?, order)?;
        let mut problem = free_body(&mesh, STEEL);
        let end = 0.5 * BODY.width;
        prescribe(&mut problem, |[x, y, z]| {
            let held = match ends {
                Ends::Held => x.abs() > end - 1e-9,
                Ends::Free => x < 1e-9 - end,
            };
            // Nodes on the planes of symmetry stay on them.
            let on = |across: f64| (across.abs() < 1e-9).then_some(0.0);
            [held.then_some(0.0), on(y), on(z)]
        });
        let inner = mesh.surface_set("inner")?;
        let load = surface_force(&mesh, inner, |_, n| n.map(|n| -PRESSURE * n));
        problem.loads.push(constant_load(load));
        Ok((mesh, problem))
    }

    /// Mean of something over the nodes of a set.
    pub fn mean(mesh: &TetMesh, set: &str, of: impl Fn(usize) -> f64) -> Result<f64, CaseError> {
        let nodes = mesh.node_set(set)?;
        Ok(nodes.iter().map(|n| of(*n as usize)).sum::<f64>() / nodes.len() as f64)
    }

    /// The part of `u` that leads away from the axis.
    pub fn outwards([_, y, z]: Vec3, u: Vec3) -> f64 {
        (u[1] * y + u[2] * z) / y.hypot(z)
    }
}

/// The ring of the case `free_ring_modes`.
pub mod thin_ring {
    use bearing_dynamics::mesh::generate::Ring;

    use crate::oracles::ring;
    use crate::solids::STEEL;

    /// m: a twentieth of the mean radius thick, so that the thin ring's formula is near.
    pub const BODY: Ring = Ring { inner_radius: 0.04875, outer_radius: 0.05125, width: 4e-3 };

    pub fn exact() -> ring::Ring {
        ring::Ring {
            inner: BODY.inner_radius,
            outer: BODY.outer_radius,
            width: BODY.width,
            young: STEEL.young,
            poisson: STEEL.poisson,
            density: STEEL.density,
        }
    }
}

/// The cage of the case `cage_modes_table_5_3`.
pub mod cage {
    use bearing_dynamics::mesh::generate::Cage;

    /// Table 5.3; pockets are radial cylinders, and the width follows from the mass.
    pub const LITERAL: Cage = Cage {
        pocket_count: 11,
        pocket_radius: 6.5e-3,
        inner_radius: 29.125e-3,
        outer_radius: 33.375e-3,
        width: 18.010e-3,
        relief: None,
    };

    /// First pairs in and out of the plane of the literal cage, Hz: converged on fine meshes of ten-node
    /// elements by two other finite-element programs. Kept as these two numbers alone: unlike
    /// `calculix_comparison` there are neither decks nor output to run anew.
    pub const CONVERGED: [f64; 2] = [2271.5, 3959.0];
}
