//! Flexible bodies in the static problem of an assembly: a section for each mount, load and unbalance.

use crate::assembly::lists::Assembly;
use crate::equilibrium::lists::{Place, StaticAssembly, StaticBody, StaticSection, StaticShaft};
use crate::kinematics::euler::{about, quaternion};
use crate::members::body::{prescribed_angle, prescribed_speed};
use crate::members::flexible_shaft::{Section, Unbalance};
use crate::members::mount::Mount;
use nalgebra::{SVector, Vector3};

type Five = SVector<f64, 5>;

/// Adds modes and sections at time `t` and mounts bearings and connections on them, without the forces of unbalances
/// (see [`unbalance_loads`]).
pub(crate) fn add(assembly: &Assembly, t: f64, still: &mut StaticAssembly) {
    for (index, shaft) in assembly.shafts.iter().enumerate() {
        still.shafts.push(StaticShaft::new(shaft.body, &shaft.shapes));
        let place = |at: &str, section: Section, loads: [f64; 5]| StaticBody {
            name: format!("{} at {at}", assembly.bodies[shaft.body].name),
            place: Place::Section(Box::new(StaticSection { shaft: index, section, loads })),
        };
        for (at, mount) in mounts(assembly) {
            if mount.body == shaft.body && still.attachment_of(&mount) == mount {
                let section = shaft.shapes.section(mount.along);
                still.bodies.push(place(&at, section, [0.0; 5]));
            }
        }
        for (at, section) in &shaft.probes {
            still.bodies.push(place(at, section.clone(), [0.0; 5]));
        }
        for load in &shaft.loads {
            let [x, y, z] = [0, 1, 2].map(|i| load.force[i].value(t));
            still.bodies.push(place("its load", load.section.clone(), [x, y, z, 0.0, 0.0]));
        }
        for unbalance in &shaft.unbalances {
            still.bodies.push(place("its unbalance", unbalance.section.clone(), [0.0; 5]));
        }
    }
    let mut bearings = std::mem::take(&mut still.bearings);
    let mut connections = std::mem::take(&mut still.connections);
    let mounts = bearings.iter_mut().flat_map(|bearing| &mut bearing.mounts);
    let mounts = mounts.chain(connections.iter_mut().flat_map(|joint| &mut joint.ends));
    mounts.for_each(|mount| *mount = still.attachment_of(mount));
    (still.bearings, still.connections) = (bearings, connections);
}

/// Mounts of bearings, connections and housing fits, with names.
fn mounts(assembly: &Assembly) -> impl Iterator<Item = (String, Mount)> {
    let bearings = assembly.bearings.iter().flat_map(|of| {
        let name = of.name.as_ref().map_or("the bearing".into(), |name| format!("bearing {name}"));
        of.mounts.map(|mount| (name.clone(), mount))
    });
    let connections = &assembly.connections;
    let connections =
        connections.iter().flat_map(|of| of.ends.map(|mount| (of.name.clone(), mount)));
    let seats = assembly.seats.iter().map(|seat| ("its housing fit".into(), seat.race));
    bearings.chain(connections).chain(seats)
}

/// Static bodies with unbalances, each with its unbalance and the rotating body, in their order.
fn unbalanced<'a>(
    assembly: &'a Assembly,
    still: &StaticAssembly,
) -> Vec<(usize, &'a Unbalance, usize)> {
    let mut all = Vec::new();
    for (index, shaft) in assembly.shafts.iter().enumerate() {
        let its = |(_, body): &(usize, &StaticBody)| match &body.place {
            Place::Section(of) => of.shaft == index,
            _ => false,
        };
        let sections: Vec<usize> =
            still.bodies.iter().enumerate().filter(its).map(|of| of.0).collect();
        // Unbalances are the last sections.
        let first = sections.len() - shaft.unbalances.len();
        let own = sections[first..].iter().zip(&shaft.unbalances);
        all.extend(own.map(|(&body, unbalance)| (body, unbalance, shaft.body)));
    }
    all
}

/// Centrifugal forces of unbalances on sections at time `t`, each over the coordinates of its static body, for these
/// tilts of the sections.
pub(crate) fn unbalance_loads(
    assembly: &Assembly,
    still: &StaticAssembly,
    t: f64,
    at: &[Five],
) -> Vec<(usize, Five)> {
    let load = |(body, unbalance, spins): (usize, &Unbalance, usize)| {
        let spins = &assembly.bodies[spins];
        let speed = prescribed_speed(spins, t);
        let size = unbalance.size * speed * speed;
        let angle = unbalance.angle + prescribed_angle(spins, t);
        let turned = about(Vector3::x(), angle) * Vector3::y();
        let along = quaternion(0.0, at[body][3], at[body][4]) * turned * size;
        (size != 0.0).then(|| (body, Five::from([along.x, along.y, along.z, 0.0, 0.0])))
    };
    unbalanced(assembly, still).into_iter().filter_map(load).collect()
}
