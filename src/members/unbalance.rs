//! Unbalance of bodies (4.3.4): an eccentric mass, small compared with the body, u = m e (kg·m).
//!
//! With a prescribed speed its force u (Ω² n − Ω̇ τ) is known, n outwards and τ in the direction of rotation. With a
//! torque Ω̇ is unknown: beyond the kinetic energy contained in the body's, the mass has u Ω τ·v, v the velocity at its
//! position. With q̇ all velocities but the spin, those of modes among them, and b = Σ u ∂(τ·v)/∂q̇,
//!
//! M q̈ = f − b Ω̇,
//!
//! I Ω̇ = T − b·q̈,
//!
//! f with the centrifugal forces, so that Ω̇ = (T − b·M⁻¹f) / (I − b·M⁻¹b). The vibration of the rotor thus takes
//! energy from its spin, and holds a run-up by a weak torque back at the critical speed. Weight acts at the unbalance
//! too, which makes the body a pendulum. The inertia of the mass in tilting is omitted.

use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use crate::members::body::{Body, Drive, DrivenBody, Rotation};
use crate::members::flexible_shaft::{Bend, ElasticShaft, Section, SectionNow};
use crate::members::mount::Mount;
use crate::members::rigid_body::{BodyKinematics, BodyRates, Wrench};
use nalgebra::{UnitQuaternion, Vector3};

/// Outward and tangential direction of an unbalance at `angle` from Y towards Z of `orientation`.
pub(crate) fn directions(orientation: &UnitQuaternion<f64>, angle: f64) -> [Vec3; 2] {
    let (sin, cos) = libm::sincos(angle);
    [[cos, sin], [-sin, cos]].map(|[y, z]| (orientation * Vector3::new(0.0, y, z)).into())
}

/// −u Ω ω × τ, N: rate of the momentum u Ω τ of an unbalance on a body of angular velocity ω. It is the centrifugal
/// force, and an axial force as the axis tilts.
pub(crate) fn turning_momentum(size: f64, spin: f64, angular: Vec3, forward: Vec3) -> Vec3 {
    scale(cross(angular, forward), -size * spin)
}

/// Returns whether a body with an unbalance is driven by a torque.
pub fn is_coupled(of: &Body, index: usize, shafts: &[ElasticShaft]) -> bool {
    let by_torque = of.driven().is_some_and(|of| matches!(of.rotation, Rotation::Torque(_)));
    let on_shaft = |shaft: &ElasticShaft| shaft.body == index && !shaft.unbalances.is_empty();
    by_torque && (of.unbalance != 0.0 || shafts.iter().any(on_shaft))
}

/// b·M⁻¹b of the unbalances of a straight shaft, kg·m²: the smallest axial inertia of such masses, on a shaft of this
/// mass (kg) and transverse moment of inertia (kg·m²) and its modes.
pub fn least_inertia(shaft: &ElasticShaft, mass: f64, transverse: f64) -> f64 {
    let along = |direction: usize| {
        let parts = shaft.unbalances.iter().map(|of| {
            let (sin, cos) = libm::sincos(of.angle);
            (of.size * [cos, sin][direction], &of.section)
        });
        let parts: Vec<(f64, &Section)> = parts.collect();
        let sum = |of: &dyn Fn(&Section) -> f64| {
            parts.iter().map(|(size, section)| size * of(section)).sum::<f64>().powi(2)
        };
        let rigid = sum(&|_| 1.0) / mass + sum(&|section| section.along) / transverse;
        rigid + (0..shaft.count()).map(|k| sum(&|section| section.deflection[k])).sum::<f64>()
    };
    along(0) + along(1)
}

/// A flexible shaft and its entries in the state.
pub(crate) type Bent<'s> = (&'s ElasticShaft, &'s [f64]);

/// The flexible shaft of a body and its entries; `firsts` are those of all shafts.
pub(crate) fn bent_of<'s>(
    shafts: &'s [ElasticShaft],
    firsts: &[usize],
    body: usize,
    state: &'s [f64],
) -> Option<(usize, Bent<'s>)> {
    let index = shafts.iter().position(|shaft| shaft.body == body)?;
    let (shaft, at) = (&shafts[index], firsts[index]);
    Some((at, (shaft, &state[at..at + shaft.entries()])))
}

/// An unbalance at its position: kg·m, outward and tangential direction, kinematics of its section or body.
type Turning<'t> = (f64, [Vec3; 2], &'t BodyKinematics);

/// Calls `of` for each unbalance of a body, with its section.
fn each(
    (body, now): (&Body, &BodyKinematics),
    bent: Option<Bent>,
    mut act: impl FnMut(Turning, Option<(&Section, &SectionNow, &Bend)>),
) {
    if body.unbalance != 0.0 {
        act((body.unbalance, directions(&now.state.orientation, 0.0), now), None);
    }
    let Some((shaft, entries)) = bent else { return };
    let bend = Bend::of(shaft.count(), entries);
    let mount = Mount::at_centre(shaft.body);
    for of in &shaft.unbalances {
        let here = of.section.place(now, &mount, &bend);
        let directions = directions(&here.race.state.orientation, of.angle);
        act((of.size, directions, &here.race), Some((&of.section, &here, &bend)));
    }
}

/// Kinetic energy u Ω τ·v of the unbalances of a body driven by a torque, and the energy of their weight, J.
pub(crate) fn energies(
    of: (&Body, &BodyKinematics),
    bent: Option<Bent>,
    gravity: Vec3,
) -> [f64; 2] {
    let spin = dot(of.1.motion.spin, of.1.motion.axis);
    let mut energies = [0.0; 2];
    each(of, bent, |(size, [outwards, forward], race), _| {
        energies[0] += size * spin * dot(forward, race.motion.velocity);
        energies[1] -= size * dot(gravity, outwards);
    });
    energies
}

/// Inertial loads of a body's unbalances per rad/s² of Ω̇, negated: b.
#[derive(Clone, Debug, Default)]
pub(crate) struct UnbalanceCoupling {
    on_body: Wrench,
    /// Modal forces of its shaft, as in [`crate::members::flexible_shaft::Section::take`].
    on_shapes: Vec<f64>,
}

impl UnbalanceCoupling {
    /// With memory for these shafts.
    pub(crate) fn new(shafts: &[ElasticShaft]) -> UnbalanceCoupling {
        let most = shafts.iter().map(ElasticShaft::amplitudes).max();
        UnbalanceCoupling { on_body: Wrench::default(), on_shapes: vec![0.0; most.unwrap_or(0)] }
    }

    /// Updates the unbalances of a body, and adds their weight at their positions to its loads.
    pub(crate) fn update(
        &mut self,
        of: (&Body, &BodyKinematics),
        bent: Option<Bent>,
        gravity: Vec3,
        pushes: &mut [f64],
        loads: &mut Wrench,
    ) {
        let UnbalanceCoupling { on_body, on_shapes } = self;
        *on_body = Wrench::default();
        on_shapes.fill(0.0);
        each(of, bent, |(size, [outwards, forward], _), section| {
            let force = Wrench { force: scale(forward, size), moment: [0.0; 3] };
            // About the axis only: across it weight is balanced by the inertia of the mass in tilting, which is
            // omitted.
            let axis = of.1.motion.axis;
            let pull = add_scaled(gravity, -dot(gravity, axis), axis);
            let moment = scale(cross(outwards, pull), size);
            let weight = Wrench { force: [0.0; 3], moment };
            match section {
                None => {
                    on_body.add(&force);
                    loads.add(&weight);
                }
                Some((section, here, bend)) => {
                    on_body.add(&section.take((of.1, bend), here, &force, on_shapes));
                    loads.add(&section.take((of.1, bend), here, &weight, pushes));
                }
            }
        });
    }

    /// Adds the inertial loads of the unbalances to a body and its modes. `free` are the rates without them, `pushes`
    /// the modal accelerations.
    pub(crate) fn add_to(
        &self,
        (body, now): (&DrivenBody, &BodyKinematics),
        free: &BodyRates,
        pushes: &mut [f64],
        loads: &mut Wrench,
    ) {
        let Wrench { force, moment } = self.on_body;
        let (axis, spin) = (now.motion.axis, now.motion.spin);
        let tilting = add_scaled(spin, -dot(spin, axis), axis);
        // dω/dt across the axis contains Ω ȧ, which belongs to the spin that rotates with the axis.
        let turned = scale(cross(tilting, axis), dot(spin, axis));
        let tilted = sub(free.spin_rate, turned);
        let inertia = &body.inertia;
        let of_shapes = self.on_shapes.iter().zip(&*pushes);
        let taken = dot(force, free.acceleration)
            + dot(moment, tilted)
            + of_shapes.map(|(coupling, push)| coupling * push).sum::<f64>();
        let moved = |given: &Drive| matches!(given, Drive::Load(_));
        let across = (0..3).filter(|&i| moved(&body.drives[i])).map(|i| force[i] * force[i]);
        let about = now.tilt_directions.iter().zip(&body.drives[3..]);
        let about = about.filter(|(_, drive)| moved(drive)).map(|(e, _)| dot(moment, *e).powi(2));
        let given_way = across.sum::<f64>() / inertia.mass
            + about.sum::<f64>() / inertia.transverse
            + self.on_shapes.iter().map(|coupling| coupling * coupling).sum::<f64>();
        let own = dot(free.spin_rate, axis);
        // An eccentric mass has an axial inertia, which is part of the body's: a body with less is invalid, and its
        // motion is NaN.
        let left = Some(inertia.axial - given_way).filter(|left| *left > 0.0);
        let rate = (inertia.axial * own - taken) / left.unwrap_or(f64::NAN);
        loads.force = add_scaled(loads.force, -rate, force);
        let on_axis = inertia.axial * (rate - own);
        loads.moment = add(loads.moment, add_scaled(scale(moment, -rate), on_axis, axis));
        for (push, coupling) in pushes.iter_mut().zip(&self.on_shapes) {
            *push -= rate * coupling;
        }
    }
}
