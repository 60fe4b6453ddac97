//! Contact of a race with the bore of its housing: force and pressure fields, and a table of the bore nodes.

use crate::ch2_housing::bore_contact::{ContactNode, Penalty};
use crate::kinematics::vec3::{Vec3, dot, scale};
use crate::members::housing_fit::ContactNodeState;
use crate::motion::system::System;
use crate::output::series::{Column, Series, SeriesError};
use crate::output::session::Motion;
use crate::solids::bore_equilibrium::BoreState;
use crate::solids::condensation::CondensedBore;
use crate::solids::model::SolidModel;
use ndarray::Array2;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoreNodeState {
    pub node: u32,
    /// Undeformed position, m.
    pub place: Vec3,
    /// m².
    pub area: f64,
    /// Penetration into the race, m; negative for a gap.
    pub penetration: f64,
    /// Contact force on the node, N.
    pub force: Vec3,
}

/// Bore nodes of a solid at the present time; `model` is the model of this solid. With explicit steps only contact nodes;
/// empty without a bore or before the first equilibrium.
pub fn bore_nodes(motion: &Motion, solid: usize, model: &SolidModel) -> Vec<BoreNodeState> {
    match motion {
        Motion::Solid(_) | Motion::Rubber(_) => Vec::new(),
        Motion::Bearing(simulation) => seat_nodes(&simulation.system, solid),
        Motion::QuasiStaticSequence(sequence) => {
            match (&sequence.latest, sequence.problem.seats.get(solid)) {
                (Some(moment), Some(seat)) => {
                    condensed_nodes(model, seat.bore, &moment.solution.seats[solid])
                }
                _ => Vec::new(),
            }
        }
        Motion::Housed(housed) => {
            let state = |(node, penalty, force): (ContactNode, Penalty, Vec3)| {
                let load = dot(force, force).sqrt();
                BoreNodeState {
                    node: node.node,
                    place: node.place,
                    area: node.area,
                    penetration: load / penalty.of_node(node.area),
                    force,
                }
            };
            housed.nodal_forces(solid).into_iter().map(state).collect()
        }
    }
}

/// Contact nodes of the first fit in a reduced solid; empty without one.
fn seat_nodes(system: &System, solid: usize) -> Vec<BoreNodeState> {
    let mut seats = system.assembly.seats.iter().zip(&system.seats);
    let Some((seat, now)) = seats.find(|(seat, _)| seat.solid == solid) else {
        return Vec::new();
    };
    let surface = &system.assembly.solids[seat.solid].surfaces[seat.surface];
    let state = |touching: &ContactNodeState| {
        let node = &surface.nodes[touching.node];
        let load = touching.load / touching.along;
        BoreNodeState {
            node: node.node,
            place: node.place,
            area: node.area,
            penetration: load / touching.stiffness,
            force: scale(touching.normal, load),
        }
    };
    now.touching.iter().map(state).collect()
}

/// Nodes of a condensed bore in an equilibrium.
pub fn condensed_nodes(
    model: &SolidModel,
    bore: &CondensedBore,
    state: &BoreState,
) -> Vec<BoreNodeState> {
    bore.nodes
        .iter()
        .zip(&state.penetration)
        .zip(bore.nodal_forces(&state.loads))
        .map(|((node, penetration), (_, force))| BoreNodeState {
            node: node.node,
            place: model.problem.nodes[node.node as usize],
            area: node.area,
            penetration: *penetration,
            force,
        })
        .collect()
}

/// Forces (N) and pressures (Pa) at all `nodes` nodes of a mesh.
pub(super) fn on_nodes(bore: &[BoreNodeState], nodes: usize) -> (Vec<Vec3>, Vec<f64>) {
    let (mut forces, mut pressure) = (vec![[0.0; 3]; nodes], vec![0.0; nodes]);
    for state in bore {
        forces[state.node as usize] = state.force;
        pressure[state.node as usize] = pressure_of(state);
    }
    (forces, pressure)
}

fn pressure_of(state: &BoreNodeState) -> f64 {
    dot(state.force, state.force).sqrt() / state.area
}

/// Table with one row per node: position, azimuth from +Y towards +Z, area, penetration, force, pressure.
///
/// # Errors
/// Never for these columns.
pub fn bore_series(bore: &[BoreNodeState]) -> Result<Series, SeriesError> {
    let columns = [
        ("x", "m"),
        ("y", "m"),
        ("z", "m"),
        ("azimuth", "deg"),
        ("area", "m^2"),
        ("penetration", "m"),
        ("force_x", "N"),
        ("force_y", "N"),
        ("force_z", "N"),
        ("pressure", "Pa"),
    ];
    let columns: Vec<Column> =
        columns.iter().map(|(name, unit)| Column::new(*name, *unit)).collect();
    let mut values = Vec::with_capacity(columns.len() * bore.len());
    for state in bore {
        let azimuth = libm::atan2(state.place[2], state.place[1]).to_degrees();
        values.extend(state.place);
        values.extend([azimuth, state.area, state.penetration]);
        values.extend(state.force);
        values.push(pressure_of(state));
    }
    let data = Array2::from_shape_vec((bore.len(), columns.len()), values)
        .expect("every node gives one value per column");
    Series::new(columns, data)
}
