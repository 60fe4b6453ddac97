//! Energies of a state: kinetic, contacts, gravity, springs, reduced solids and their housing fits.

use crate::ch2_housing::bearing::cage::cage_energy;
use crate::ch2_housing::bearing::contact::strain_energy;
use crate::ch2_housing::bearing::inertia::Inertia;
use crate::kinematics::vec3::{Vec3, dot};
use crate::members::state::{POSITION, SPIN, VELOCITY};
use crate::members::unbalance::{bent_of, energies};
use crate::motion::system::System;
use serde::{Deserialize, Serialize};

/// Energy at one instant, J.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    pub kinetic: f64,
    /// Stored in ball–race contacts.
    pub contact: f64,
    /// Stored in cage contacts.
    pub cage_contact: f64,
    /// −m g·r of all bodies and reduced solids.
    pub gravity: f64,
    /// Stored in springs to the ground and between bodies.
    pub foundation: f64,
    /// Stored in contacts between balls.
    pub ball_contact: f64,
    /// Motion and strain of reduced solids.
    pub solid_kinetic: f64,
    pub solid_strain: f64,
    /// Strain of flexible cages; their motion is in `kinetic`.
    pub cage_strain: f64,
    /// Bending of shafts.
    pub bending_kinetic: f64,
    pub bending_strain: f64,
    /// Stored in race–bore contacts.
    pub seat: f64,
}

impl Energy {
    /// Sum of the sizes of all terms, J.
    pub fn held(&self) -> f64 {
        // Only gravity has a sign.
        self.total() - self.gravity + self.gravity.abs()
    }

    pub fn total(&self) -> f64 {
        self.kinetic
            + self.contact
            + self.cage_contact
            + self.gravity
            + self.foundation
            + self.ball_contact
            + (self.solid_kinetic + self.solid_strain + self.seat)
            + (self.bending_kinetic + self.bending_strain)
            + self.cage_strain
    }
}

impl System {
    /// Energies of a state; call after [`System::evaluate`] at the same state.
    pub fn energy(&self, state: &[f64]) -> Energy {
        let assembly = &self.assembly;
        let mut energy = Energy::default();
        let mut add_body = |inertia: &Inertia, axis: Vec3, body: &[Vec3; 3]| {
            let Inertia { mass, axial, transverse, .. } = *inertia;
            let [position, velocity, spin] = *body;
            let about_axis = dot(spin, axis);
            energy.kinetic += 0.5 * mass * dot(velocity, velocity)
                + 0.5 * transverse * dot(spin, spin)
                + 0.5 * (axial - transverse) * about_axis * about_axis;
            energy.gravity -= mass * dot(assembly.gravity, position);
        };
        for (set, bearing) in self.sets.iter().zip(&assembly.bearings) {
            for i in 0..set.layout.balls {
                let vector = |component| set.layout.ball_vector(state, component, i);
                let body = [vector(POSITION), vector(VELOCITY), vector(SPIN)];
                add_body(&bearing.ball, [1.0, 0.0, 0.0], &body);
            }
        }
        let floats = |body: usize| assembly.floating.iter().any(|solid| solid.body == body);
        for (index, (body, now)) in assembly.bodies.iter().zip(&self.bodies).enumerate() {
            let Some(inertia) = body.inertia() else { continue };
            // The rotation of a floating solid is in its own energy.
            let spin = if floats(index) { [0.0; 3] } else { now.state.spin };
            add_body(inertia, now.motion.axis, &[now.state.position, now.state.velocity, spin]);
        }
        for (set, bearing) in self.sets.iter().zip(&assembly.bearings) {
            if let Some(cage) = &bearing.cage {
                if cage.nodes.is_some() {
                    energy.cage_contact += set.cage_energy;
                } else if !cage.in_elements {
                    for contact in set.pockets.iter().chain(&set.guides) {
                        energy.cage_contact +=
                            cage_energy(&cage.contacts.force, contact.penetration);
                    }
                }
            }
            for (race, law) in set.laws.races.iter().enumerate() {
                for i in 0..set.layout.balls {
                    let overlap = set.table.contact[race * set.layout.padded + i].overlap;
                    energy.contact += strain_energy(law.stiffness, overlap);
                }
            }
            if let Some(law) = &bearing.ball_contact {
                for meeting in &set.meetings {
                    energy.ball_contact += strain_energy(law.stiffness, meeting.overlap);
                }
            }
        }
        for (index, solid) in assembly.floating.iter().enumerate() {
            let entries = self.deformed(state, index);
            let [kinetic, strain] = solid.energy(&self.bodies[solid.body], entries);
            energy.kinetic += kinetic;
            energy.cage_strain += strain;
        }
        for (body, now) in assembly.bodies.iter().zip(&self.bodies) {
            let Some(driven) = body.driven() else { continue };
            for i in 0..5 {
                let value = if i < 3 { now.state.position[i] } else { now.tilts()[i - 3] };
                let stretch = value - body.rest[i];
                energy.foundation += 0.5 * driven.foundation_stiffness[i] * stretch * stretch;
            }
        }
        for index in 0..assembly.connections.len() {
            energy.foundation += self.connection_forces(state, index).energy;
        }
        for solid in 0..assembly.solids.len() {
            let of = self.energy_of_solid(state, solid);
            energy.solid_kinetic += of.kinetic;
            energy.solid_strain += of.strain;
            energy.gravity += of.gravity;
        }
        for index in
            self.steps.moving.iter().copied().filter(|&of| self.steps.bodies[of].unbalance_coupled)
        {
            let bent = bent_of(&assembly.shafts, &self.shafts, index, state).map(|(_, bent)| bent);
            let of = (&assembly.bodies[index], &self.bodies[index]);
            let [kinetic, weight] = energies(of, bent, assembly.gravity);
            energy.kinetic += kinetic;
            energy.gravity += weight;
        }
        for (index, shaft) in assembly.shafts.iter().enumerate() {
            let of = shaft.energy(self.bent(state, index));
            energy.bending_kinetic += of.kinetic;
            energy.bending_strain += of.strain;
        }
        energy.seat = self.seats.iter().map(|seat| seat.contact.energy).sum();
        energy
    }
}
