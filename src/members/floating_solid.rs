//! A flexible solid on a rotating body: component modes in a floating frame ([`crate::ch5_cage::floating_frame`]).

use crate::ch5_cage::floating_frame::{FloatingFrame, Scratch};
use crate::kinematics::vec3::Vec3;
use crate::members::rigid_body::BodyKinematics;
use nalgebra::{UnitQuaternion, Vector3};

/// Deformation of one body of an assembly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FloatingSolid {
    /// Index in [`crate::assembly::lists::Assembly::bodies`].
    pub body: usize,
    pub frame: FloatingFrame,
    /// Rings of places whose change of radius is recorded, each place by its modes.
    pub gauges: Vec<RadiusGauge>,
}

/// Radial displacement at one azimuth, averaged over the places given.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadiusGauge {
    /// Azimuth in the body's axes, rad.
    pub angle: f64,
    /// Radial displacement per unit of each mode.
    pub shape: Vec<f64>,
}

/// Working memory of a floating solid.
#[derive(Clone, Debug, Default)]
pub struct FloatingNow {
    /// Modal forces of its contacts, N.
    pub forces: Vec<f64>,
    pub scratch: Scratch,
}

/// `vector` in axes of a body at `orientation`.
pub fn into_frame(orientation: &UnitQuaternion<f64>, vector: Vec3) -> Vec3 {
    orientation.inverse_transform_vector(&Vector3::from(vector)).into()
}

/// `vector`, given in axes of a body at `orientation`, in inertial axes.
pub fn out_of_frame(orientation: &UnitQuaternion<f64>, vector: Vec3) -> Vec3 {
    (orientation * Vector3::from(vector)).into()
}

impl FloatingSolid {
    /// Number of modes.
    pub fn count(&self) -> usize {
        self.frame.count()
    }

    /// Amplitudes (m) and their rates (m/s), from the entries of the state.
    pub fn split<'s>(&self, entries: &'s [f64]) -> [&'s [f64]; 2] {
        let (gone, speeds) = entries.split_at(self.count());
        [gone, speeds]
    }

    /// Rates of the entries under the modal forces in `now`; returns the angular acceleration of the body in inertial
    /// axes and the power of the damping (W). `moment` is about the body's centre in inertial axes, N·m.
    pub fn rates(
        &self,
        body: &BodyKinematics,
        moment: Vec3,
        entries: &[f64],
        now: &mut FloatingNow,
        rates: &mut [f64],
    ) -> (Vec3, f64) {
        let orientation = &body.state.orientation;
        let parts = self.split(entries);
        let (going, accelerations) = rates.split_at_mut(self.count());
        going.copy_from_slice(parts[1]);
        accelerations.copy_from_slice(&now.forces);
        let [spin, moment] = [body.state.spin, moment].map(|of| into_frame(orientation, of));
        let done = self.frame.rates(spin, moment, parts, accelerations, &mut now.scratch);
        (out_of_frame(orientation, done.spin_rate), done.damped)
    }

    /// Kinetic energy of rotation and deformation, and strain energy, J.
    pub fn energy(&self, body: &BodyKinematics, entries: &[f64]) -> [f64; 2] {
        self.frame.energy(into_frame(&body.state.orientation, body.state.spin), self.split(entries))
    }

    /// Angular momentum about the centre of mass in inertial axes, N·m·s.
    pub fn angular_momentum(&self, body: &BodyKinematics, entries: &[f64]) -> Vec3 {
        let orientation = &body.state.orientation;
        let spin = into_frame(orientation, body.state.spin);
        out_of_frame(orientation, self.frame.angular_momentum(spin, self.split(entries)))
    }
}

impl FloatingNow {
    pub fn new(solid: &FloatingSolid) -> FloatingNow {
        FloatingNow { forces: vec![0.0; solid.count()], scratch: Scratch::new(solid.count()) }
    }
}
