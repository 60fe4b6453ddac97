//! What is stored in a state: kinetic energy, contacts, gravity, springs.

use super::model::RaceBody;
use super::state::{POSITION, SPIN, VELOCITY};
use super::system::{Instant, System};
use crate::ch2_housing::bearing::cage::cage_energy;
use crate::ch2_housing::bearing::contact::strain_energy;
use crate::kinematics::vec3::{Vec3, dot};

/// Energy at one instant, J.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Energy {
    pub kinetic: f64,
    /// Stored in ball–race contacts.
    pub contact: f64,
    /// Stored in cage contacts.
    pub cage_contact: f64,
    /// −m g·r of all bodies.
    pub gravity: f64,
    /// Stored in the foundation's springs.
    pub foundation: f64,
    /// Stored in contacts between balls.
    pub ball_contact: f64,
}

impl Energy {
    pub fn total(&self) -> f64 {
        self.kinetic
            + self.contact
            + self.cage_contact
            + self.gravity
            + self.foundation
            + self.ball_contact
    }
}

impl System {
    /// Energies of a state; call after [`System::evaluate`] at the same state.
    pub fn energy(&self, state: &[f64], instant: &Instant) -> Energy {
        let problem = &self.problem;
        let layout = &self.layout;
        let mut energy = Energy::default();
        let mut add_body =
            |mass: f64, axial: f64, transverse: f64, axis: Vec3, body: &[Vec3; 3]| {
                let [position, velocity, spin] = *body;
                let about_axis = dot(spin, axis);
                energy.kinetic += 0.5 * mass * dot(velocity, velocity)
                    + 0.5 * transverse * dot(spin, spin)
                    + 0.5 * (axial - transverse) * about_axis * about_axis;
                energy.gravity -= mass * dot(problem.gravity, position);
            };
        let ball = &problem.ball;
        for i in 0..layout.balls {
            let vector = |component| layout.ball_vector(state, component, i);
            let body = [vector(POSITION), vector(VELOCITY), vector(SPIN)];
            add_body(ball.mass, ball.axial, ball.transverse, [1.0, 0.0, 0.0], &body);
        }
        let races =
            [(Some(&problem.inner), &instant.inner), (problem.outer.as_ref(), &instant.outer)];
        for (body, now) in races {
            if let Some(RaceBody { inertia, .. }) = body {
                let parts = [now.state.position, now.state.velocity, now.state.spin];
                add_body(inertia.mass, inertia.axial, inertia.transverse, now.motion.axis, &parts);
            }
        }
        if let (Some(body), Some(cage)) = (&problem.cage, &instant.cage) {
            let parts = [cage.position, cage.velocity, cage.spin];
            let inertia = &body.inertia;
            add_body(inertia.mass, inertia.axial, inertia.transverse, cage.axis, &parts);
            for contact in self.pockets.iter().chain(&self.guides) {
                energy.cage_contact += cage_energy(&body.contacts.force, contact.penetration);
            }
        }
        for (race, law) in self.laws.races.iter().enumerate() {
            for i in 0..layout.balls {
                let overlap = self.table.contact[race * layout.padded + i].overlap;
                energy.contact += strain_energy(law.stiffness, overlap);
            }
        }
        if let Some(law) = &problem.ball_contact {
            for meeting in &self.meetings {
                energy.ball_contact += strain_energy(law.stiffness, meeting.overlap);
            }
        }
        for (body, now) in races {
            let Some(body) = body else { continue };
            let start =
                if std::ptr::eq(body, &problem.inner) { [0.0; 5] } else { problem.outer_start };
            for i in 0..5 {
                let value = if i < 3 { now.state.position[i] } else { now.tilts()[i - 3] };
                let stretch = value - start[i];
                energy.foundation += 0.5 * body.foundation_stiffness[i] * stretch * stretch;
            }
        }
        energy
    }
}
