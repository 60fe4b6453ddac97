//! Rings: a thick one under inner pressure against Lamé, a thin free one against Ritz.

use bearing_dynamics::kinematics::strain::principal;
use bearing_dynamics::mesh::generate::{RingMesh, ring};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::model::{SolidModel, SolidProblem};
use bearing_dynamics::solids::stress::nodal_stresses;

use super::{
    conclude, explicit_sentence, frequency_by_modes, frequency_by_steps, off, record, settle, timed,
};
use crate::case::CaseError;
use crate::oracles::lame::Ends;
use crate::oracles::ring::Plane;
use crate::pareto::{ParetoContext, Study, cheapest_ways};
use crate::solid_bodies::{thick_ring, thin_ring};
use crate::solids::{STEEL, Vec3, free_body, mesh_of, name_of};

pub const DEFLECTION: Study = Study {
    id: "solid_ring_deflection",
    title: "Thick ring under inner pressure, motion of its bore",
    error_label: "error of the bore's displacement",
    more_errors: &["error of the hoop stress at the bore"],
    run: ring_deflection,
};

pub const FREQUENCY: Study = Study {
    id: "solid_ring_frequency",
    title: "Thin free ring, first natural frequency",
    error_label: "error of the frequency",
    more_errors: &[],
    run: ring_frequency,
};

/// A thin ring that ovals without stretching of its middle line.
pub fn oval_shape(mesh: &TetMesh, radius: f64) -> Vec<Vec3> {
    let at = |place: &Vec3| {
        let [_, y, z] = *place;
        let (angle, r) = (z.atan2(y), y.hypot(z));
        let radial = (2.0 * angle).cos();
        // −½ sin 2θ on the middle line, and the rotation of the sections off it.
        let hoop = (2.0 * angle).sin() * (1.5 * (r - radius) / radius - 0.5);
        let (c, s) = (angle.cos(), angle.sin());
        [0.0, radial * c - hoop * s, radial * s + hoop * c]
    };
    mesh.nodes.iter().map(at).collect()
}

fn ring_deflection(context: &mut ParetoContext) -> Result<(), CaseError> {
    let radius = thick_ring::BODY.inner_radius;
    let exact = thick_ring::exact();
    let (moves, hoop) = (exact.displacement(radius, Ends::Free), exact.stresses(radius)[1]);
    let ten = [(12, 1), (16, 2), (24, 3), (40, 6)];
    let four = [(24, 3), (48, 6), (96, 12), (144, 18)];
    for (order, meshes) in [(Order::Linear, four), (Order::Quadratic, ten)] {
        for (around, radial) in meshes {
            let (mesh, problem) = thick_ring::pressed(order, around, radial, Ends::Free)?;
            let series = format!("{}, equilibrium", name_of(order));
            let solve = || {
                let model = SolidModel::new(problem.clone())?;
                let found = settle(&model)?;
                let outwards = |n: usize| thick_ring::outwards(mesh.nodes[n], found[n]);
                Ok((thick_ring::mean(&mesh, "inner", outwards)?, None))
            };
            let model = SolidModel::new(problem.clone())?;
            let stresses = nodal_stresses(&model, &settle(&model)?);
            let largest = |n: usize| principal(&stresses[n])[0];
            let stress = thick_ring::mean(&mesh, "inner", largest)?;
            let found = timed(series, &mesh, solve)?;
            record(context, &[found], |value| vec![off(value, moves), off(stress, hoop)]);
        }
    }
    conclude(context, "the bore's displacement");
    context.sentence(format!(
        "The {}",
        cheapest_ways(context.points(), 1, "the hoop stress at the bore")
    ));
    context.sentence("Reference: Lamé, ends free; stresses are means over the bore's nodes.");
    Ok(())
}

fn ring_frequency(context: &mut ParetoContext) -> Result<(), CaseError> {
    let exact = thin_ring::exact().frequency(2, Plane::In);
    let mean = 0.5 * (thin_ring::BODY.inner_radius + thin_ring::BODY.outer_radius);
    let body = |order, (around, radial, axial)| -> Result<(TetMesh, SolidProblem), CaseError> {
        let cells = RingMesh { around, radial, axial, radial_growth: 1.0 };
        let mesh = mesh_of(&ring(&thin_ring::BODY, &cells)?, order)?;
        let problem = free_body(&mesh, STEEL);
        Ok((mesh, problem))
    };
    let ten = [(16, 1, 1), (24, 1, 1), (32, 1, 1), (48, 1, 1), (64, 1, 1), (96, 1, 1), (96, 2, 3)];
    let four = [(64, 1, 2), (96, 2, 3), (192, 4, 6), (288, 6, 9)];
    for (order, meshes) in [(Order::Linear, &four[..]), (Order::Quadratic, &ten)] {
        for &cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let shape = oval_shape(&mesh, mean);
            let series = format!("{}, modes", name_of(order));
            let solve = || Ok((frequency_by_modes(&problem, 6, 2, &shape)?, None));
            record(context, &[timed(series, &mesh, solve)?], |value| vec![off(value, exact)]);
        }
    }
    for (order, meshes) in [(Order::Linear, &four[..2]), (Order::Quadratic, &ten[..6])] {
        for &cells in meshes {
            let (mesh, problem) = body(order, cells)?;
            let shape = oval_shape(&mesh, mean);
            let series = format!("{}, explicit steps", name_of(order));
            let swing = || frequency_by_steps(&problem, &shape, exact);
            record(context, &[timed(series, &mesh, swing)?], |value| vec![off(value, exact)]);
        }
    }
    conclude(context, "the frequency");
    context.sentence(format!(
        "Reference: {exact:.2} Hz by Ritz' method in cylindrical coordinates, two waves in the plane."
    ));
    context.sentence(explicit_sentence());
    Ok(())
}
