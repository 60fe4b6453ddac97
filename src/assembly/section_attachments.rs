//! Attachments of bearings, connections and housing fits on flexible bodies.

use crate::assembly::lists::Assembly;
use crate::members::flexible_shaft::Bend;
use crate::members::mount::Mount;
use crate::members::rigid_body::BodyKinematics;
use crate::members::section_attachment::SectionAttachment;

/// Section attachments of every mount of an assembly; `None` on rigid bodies.
#[derive(Clone, Debug, Default)]
pub struct SectionAttachments {
    /// Inner and outer race of each bearing.
    pub bearings: Vec<[Option<SectionAttachment>; 2]>,
    /// Both ends.
    pub connections: Vec<[Option<SectionAttachment>; 2]>,
    pub seats: Vec<Option<SectionAttachment>>,
}

impl SectionAttachments {
    pub fn new(assembly: &Assembly, bodies: &[BodyKinematics]) -> SectionAttachments {
        let hold = |mount: &Mount| {
            let shaft = assembly.shafts.iter().position(|shaft| shaft.body == mount.body)?;
            let section = assembly.shafts[shaft].shapes.section(mount.along);
            let unbent = vec![0.0; assembly.shafts[shaft].entries()];
            let now = section.place(
                &bodies[mount.body],
                mount,
                &Bend::of(section.deflection.len(), &unbent),
            );
            Some(SectionAttachment { shaft, section, now })
        };
        SectionAttachments {
            bearings: assembly.bearings.iter().map(|of| of.mounts.each_ref().map(hold)).collect(),
            connections: assembly
                .connections
                .iter()
                .map(|of| of.ends.each_ref().map(hold))
                .collect(),
            seats: assembly.seats.iter().map(|of| hold(&of.race)).collect(),
        }
    }

    /// Updates all sections from their bodies; `shafts` are the first entries of each in the state.
    pub fn place(
        &mut self,
        assembly: &Assembly,
        shafts: &[usize],
        bodies: &[BodyKinematics],
        state: &[f64],
    ) {
        let put = |hold: &mut Option<SectionAttachment>, mount: &Mount| {
            let Some(hold) = hold else { return };
            let bend = assembly.shafts[hold.shaft].bend(shafts[hold.shaft], state);
            hold.now = hold.section.place(&bodies[mount.body], mount, &bend);
        };
        for (holds, of) in self.bearings.iter_mut().zip(&assembly.bearings) {
            holds.iter_mut().zip(&of.mounts).for_each(|(hold, mount)| put(hold, mount));
        }
        for (holds, of) in self.connections.iter_mut().zip(&assembly.connections) {
            holds.iter_mut().zip(&of.ends).for_each(|(hold, mount)| put(hold, mount));
        }
        for (hold, of) in self.seats.iter_mut().zip(&assembly.seats) {
            put(hold, &of.race);
        }
    }

    /// All sections in the order of bearings, connections and housing fits, with their mounts.
    pub fn all<'h>(
        &'h self,
        assembly: &'h Assembly,
    ) -> impl Iterator<Item = (&'h SectionAttachment, Mount)> {
        let bearings = self.bearings.iter().zip(&assembly.bearings);
        let bearings = bearings.flat_map(|(holds, of)| holds.iter().zip(of.mounts));
        let connections = self.connections.iter().zip(&assembly.connections);
        let connections = connections.flat_map(|(holds, of)| holds.iter().zip(of.ends));
        let seats = self.seats.iter().zip(assembly.seats.iter().map(|seat| seat.race));
        let all = bearings.chain(connections).chain(seats);
        all.filter_map(|(hold, mount)| Some((hold.as_ref()?, mount)))
    }
}
