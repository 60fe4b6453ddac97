//! A rigid shaft on two bearings in two housings, against a solution of its own.

use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::equilibrium::lists::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticBody, StaticSeat,
};
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::members::body::Condition;
use bearing_dynamics::members::mount::Mount;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::solids::condensation::CondensedBore;
use nalgebra::{DMatrix, Vector3};

use super::{Placed, STIFFNESS, apart, body};
use crate::bearings::{self, Hertz};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housings::{self, BEARING, BORE_RADIUS};
use crate::oracles::seated::{Distance, Seat, SeatNode};
use crate::oracles::seated_shaft::{End, ShaftInBores, equilibrium};
use crate::solids::Vec3;

/// Housings, places along the shaft (m), fits (m) and phases of the balls (rad) of both ends.
const HOUSINGS: [char; 2] = ['C', 'A'];
const ALONG: [f64; 2] = [-40e-3, 65e-3];
const INTERFERENCE: [f64; 2] = [0.0, 1e-6];
const PHASE: [f64; 2] = [0.0, 0.3];
/// On the shaft: N, N·m.
const LOADS: [f64; 5] = [60.0, 180.0, -450.0, 3.0, -2.0];

fn assembly<'b>(bores: &'b [CondensedBore; 2]) -> Result<StaticAssembly<'b>, CaseError> {
    let at = |x: f64| Pose { position: Vector3::new(x, 0.0, 0.0), ..Pose::identity() };
    let free = |axes: Option<Box<Pose>>, conditions: [Condition; 5]| {
        let (springs, rest, start) = ([0.0; 5], [0.0; 5], Some([0.0; 5]));
        Place::Loaded(Loaded { axes, conditions, springs, rest, start, room: BORE_RADIUS })
    };
    let shaft = free(None, LOADS.map(Condition::Load));
    let mut assembly = StaticAssembly {
        bodies: vec![StaticBody { name: "the shaft".into(), place: shaft }],
        ..StaticAssembly::default()
    };
    let none = Condition::Load(0.0);
    for (side, bore) in bores.iter().enumerate() {
        let race = free(
            Some(Box::new(at(ALONG[side]))),
            [Condition::Displacement(0.0), none, none, none, none],
        );
        let name = Some(["left", "right"][side].to_string());
        assembly.bodies.push(StaticBody { name: "the outer race".into(), place: race });
        let alone = bearings::problem(&BEARING, Hertz::Fit, PHASE[side], [none; 5])?;
        let mount = Mount::at_centre(1 + side);
        assembly.bearings.push(StaticBearing {
            name: name.clone(),
            geometry: alone.geometry,
            inner_contact: alone.inner_contact,
            outer_contact: alone.outer_contact,
            mounts: [Mount { body: 0, along: ALONG[side], reversed: false }, mount],
            azimuths: alone.geometry.azimuths(PHASE[side]),
            weight: Vector3::zeros(),
            centrifugal: 0.0,
        });
        let (nominal, fit) = (at(ALONG[side]), housings::fit(INTERFERENCE[side]));
        let penalty = Penalty::default();
        assembly.seats.push(StaticSeat { name, mount, nominal, bore, penalty, fit });
    }
    Ok(assembly)
}

/// The oracle's: places of nodes, elements, held nodes and the nodes' shares of the bores are given to it.
fn theirs(nodes: &[Vec<SeatNode>; 2], compliances: &[DMatrix<f64>; 2]) -> ShaftInBores {
    let ends: Vec<End> = (0..2)
        .map(|side| End {
            bearing: bearings::oracle(&BEARING, Hertz::Fit, PHASE[side]),
            seat: Seat {
                nodes: nodes[side].clone(),
                compliance: &compliances[side],
                radius: BORE_RADIUS + INTERFERENCE[side],
                distance: Distance::FirstOrder,
            },
            along: ALONG[side],
        })
        .collect();
    // A little along the load, so that races touch.
    let way = 1e-7 / LOADS[1].hypot(LOADS[2]);
    let aside = [way * LOADS[1], way * LOADS[2]];
    let outer = [[aside[0], aside[1], 0.0, 0.0]; 2];
    equilibrium(&ends, &LOADS, ([0.0, aside[0], aside[1], 0.0, 0.0], &outer))
}

pub(super) fn compare(context: &mut CaseContext) -> Result<(), CaseError> {
    let placed = Placed::at_home();
    let mut bores = Vec::new();
    let (mut nodes, mut compliances) = (Vec::new(), Vec::new());
    for letter in HOUSINGS {
        let mesh = housings::mesh(letter, Order::Quadratic, [16, 1, 1])?;
        let bore = housings::condensed(&mesh, &housings::solid(&mesh)?)?;
        let body = body(&mesh, &placed)?;
        let of: Vec<usize> = bore.nodes.iter().map(|node| node.node as usize).collect();
        let node = |(&n, node): (&usize, &bearing_dynamics::solids::condensation::BoreNode)| {
            SeatNode { place: body.nodes[n], stiffness: STIFFNESS * node.area }
        };
        nodes.push(of.iter().zip(&bore.nodes).map(node).collect::<Vec<SeatNode>>());
        compliances.push(body.compliance(&of));
        bores.push(bore);
    }
    let two = |what: &str| CaseError::message(format!("two {what}"));
    let bores: [CondensedBore; 2] = bores.try_into().map_err(|_| two("bores"))?;
    let nodes: [Vec<SeatNode>; 2] = nodes.try_into().map_err(|_| two("lists of nodes"))?;
    let compliances = compliances.try_into().map_err(|_| two("compliances"))?;
    let ours = solve_assembly(&assembly(&bores)?, None, &StaticOptions::default())?;
    let oracle = theirs(&nodes, &compliances);

    let metres = |q: &[f64; 4]| [q[0], q[1], BORE_RADIUS * q[2], BORE_RADIUS * q[3]];
    let newtons = |q: &[f64; 4]| [q[0], q[1], q[2] / BORE_RADIUS, q[3] / BORE_RADIUS];
    let pitch = BEARING.pitch_radius;
    let shaft = |c: &[f64; 5]| [c[0], c[1], c[2], pitch * c[3], pitch * c[4]];
    let flat = |forces: &[Vec3]| forces.iter().flatten().copied().collect::<Vec<f64>>();
    let mut figures = vec![(
        "shaft".to_string(),
        "shaft's place and tilts",
        apart(&shaft(&ours.coordinates[0].into()), &shaft(&oracle.shaft)),
    )];
    for side in 0..2 {
        let (state, name) = (&ours.seats[side], ["left", "right"][side]);
        let forces: Vec<Vec3> = bores[side].nodal_forces(&state.loads).map(|(_, f)| f).collect();
        for (what, text, error) in [
            (
                "outer",
                "outer race's displacement and tilts",
                apart(&metres(&state.pose), &metres(&oracle.outer[side])),
            ),
            (
                "load",
                "load of the race on its bore, moments over its radius",
                apart(&newtons(&state.load), &newtons(&oracle.loads[side])),
            ),
            (
                "forces",
                "forces on the bore's nodes",
                apart(&flat(&forces), &flat(&oracle.forces[side])),
            ),
        ] {
            figures.push((format!("{name}_{what}"), text, error));
        }
    }
    for (id, text, error) in figures {
        context.check(
            Check::new(
                &format!("two_{id}"),
                &format!("shaft in two housings, {}: {text}, largest difference over the largest of them", id.replace('_', " ")),
                "1",
                error,
            )
            .independent(
                0.0,
                "own stiffness, factor, contact and Newton's method over shaft, races and nodes, to first order in displacements",
            )
            .absolute(1e-9, "statics is solved to 1e-11 of its loads; soft tilts of races in their bores multiply that by up to a hundred"),
        );
    }
    let sum = |i: usize| ours.seats.iter().map(|state| state.load[i]).sum::<f64>();
    let most = LOADS[1].hypot(LOADS[2]);
    let left = (sum(0) - LOADS[1]).abs().max((sum(1) - LOADS[2]).abs()) / most;
    context.check(
        Check::new(
            "two_sum",
            "forces of both races on their bores less the load on the shaft, over it",
            "1",
            left,
        )
        .consistency(0.0, "our forces on the bores against the applied loads")
        .absolute(
            1e-11,
            "the last step of Newton's leaves some ulps of the pitch radius times the stiffness",
        ),
    );
    context.golden(
        "two_left_outer",
        1e9 * ours.seats[0].pose[0].hypot(ours.seats[0].pose[1]),
        "nm",
        GoldenTolerance { relative: 1e-7, absolute: 0.0 },
    );
    context.work("Newton iterations, shaft in two housings", ours.iterations as u64);
    Ok(())
}
