//! A flexible rotating body: a rigid body with its six coordinates, loads and drives, and bending modes that are
//! orthogonal to its rigid motions.
//!
//! Modes are in axes e₂, e₃ that follow the body's tilt and not its spin, one amplitude along each: a_k and b_k. A
//! section at x is displaced from the body's axis by u = Σ w_k (a_k e₂ + b_k e₃), and rotated relative to the body by Σ
//! θ_k (a_k e₃ − b_k e₂). Stretching modes, one amplitude c_k each, move it along the axis, as does bending, since the
//! axis keeps its length: by −½ (a·D a + b·D b). With a modal mass of 1 kg each,
//!
//! ä + Ω (G ḃ − g ω₂) + α ȧ + ω² a = Q_a,
//!
//! b̈ − Ω (G ȧ + g ω₃) + α ḃ + ω² b = Q_b,
//!
//! c̈ + α ċ + ω² c = Q_c,
//!
//! Ω the spin, ω₂ and ω₃ the body's tilt rates, G_kl = ∫ θ_k θ_l dJ and g_k = ∫ θ_k dJ over the inertia J about the
//! axis; the body has the moment −Ω (g·ȧ e₂ + g·ḃ e₃). This is exact for axisymmetric shafts to first order in the
//! amplitudes. Second-order terms other than D (angular momentum of a whirl as the axis tilts, change of the transverse
//! inertia, inertia of the shortening) are omitted: 1e-6 for deflections of a thousandth of the length. Each section
//! rotates about its own axis, and the drive of the spin rotates each about its own axis, so that a change of speed
//! excites no mode. A shaft does not twist.
//!
//! Loads on a section, about its displaced centre, act on body and modes by the transpose of its motion: the sum of
//! forces on the body and the power are the same.

use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use crate::members::mount::Mount;
use crate::members::reduced_solid::ModalEnergy;
use crate::members::rigid_body::{BodyKinematics, Wrench};
use crate::members::shaft_modes::ShaftShapes;
use crate::members::unbalance::{directions, turning_momentum};
use crate::numeric::profile::Profile;
use crate::plan::Stage;
use crate::plan::counts::Counts;
use nalgebra::{Quaternion, UnitQuaternion};

/// Bending of one body of an assembly.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ElasticShaft {
    /// Index in [`crate::assembly::lists::Assembly::bodies`].
    pub body: usize,
    pub shapes: ShaftShapes,
    /// Damping of bending in axes that do not rotate, α, 1/s.
    pub damping: f64,
    /// Internal damping of bending, in rotating axes, 1/s. Above a critical speed it feeds the whirl.
    pub internal_damping: f64,
    pub loads: Vec<ShaftLoad>,
    pub unbalances: Vec<Unbalance>,
    /// Recorded sections, by name.
    pub probes: Vec<(String, Section)>,
}

/// Modes at one position along a shaft.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Section {
    /// Position from the body's centre, m.
    pub along: f64,
    /// Per unit of each mode: m, rad.
    pub deflection: Vec<f64>,
    pub turn: Vec<f64>,
    /// Per unit of each stretching mode, m.
    pub stretch: Vec<f64>,
    /// [`ShaftShapes::shortening`], row by row.
    pub shortening: Vec<f64>,
}

/// A force at the centre of a section.
#[derive(Clone, Debug, PartialEq)]
pub struct ShaftLoad {
    pub section: Section,
    /// Along X, Y, Z, N.
    pub force: [Profile; 3],
}

/// An unbalance.
#[derive(Clone, Debug, PartialEq)]
pub struct Unbalance {
    pub section: Section,
    /// Mass times eccentricity, kg·m.
    pub size: f64,
    /// Angle from the body's own Y towards its Z, rad.
    pub angle: f64,
}

/// Amplitudes of a shaft and their rates, from the state.
#[derive(Clone, Copy, Debug)]
pub struct Bend<'s> {
    /// Amplitudes along e₂, e₃ and the axis, m.
    pub gone: [&'s [f64]; 3],
    /// Rates, m/s, in axes that do not rotate about the shaft's.
    pub speed: [&'s [f64]; 3],
}

impl<'s> Bend<'s> {
    /// `count` bending modes.
    pub fn of(count: usize, entries: &'s [f64]) -> Bend<'s> {
        let (gone, speed) = entries.split_at(entries.len() / 2);
        let parts = |of: &'s [f64]| [&of[..count], &of[count..2 * count], &of[2 * count..]];
        Bend { gone: parts(gone), speed: parts(speed) }
    }
}

/// A section at one instant.
#[derive(Clone, Copy, Debug)]
pub struct SectionNow {
    /// Kinematics of a race on it.
    pub race: BodyKinematics,
    /// Its rotation relative to the body, rad, and its own axis; inertial axes.
    pub turn: Vec3,
    pub axis: Vec3,
}

fn sum(shape: &[f64], amplitudes: &[f64]) -> f64 {
    shape.iter().zip(amplitudes).map(|(shape, amplitude)| shape * amplitude).sum()
}

/// Rotation by a vector of at most a few degrees.
fn turned_by(turn: Vec3) -> UnitQuaternion<f64> {
    let angle = dot(turn, turn).sqrt();
    // sin(θ/2)/θ by its series, which includes zero.
    let factor =
        if angle < 1e-4 { 0.5 - angle * angle / 48.0 } else { libm::sin(0.5 * angle) / angle };
    let [x, y, z] = scale(turn, factor);
    UnitQuaternion::new_unchecked(Quaternion::new(libm::cos(0.5 * angle), x, y, z))
}

/// Part of a body's angular velocity that tilts its axis.
fn tilting(body: &BodyKinematics) -> Vec3 {
    let axis = body.motion.axis;
    add_scaled(body.motion.spin, -dot(body.motion.spin, axis), axis)
}

impl Section {
    /// The section of a bent body, with an attachment as `mount` says.
    pub fn place(&self, body: &BodyKinematics, mount: &Mount, bend: &Bend) -> SectionNow {
        let [e2, e3] = body.tilt_directions;
        let across = |shape: &[f64], of: [&[f64]; 3]| [sum(shape, of[0]), sum(shape, of[1])];
        let lateral = |[a, b]: [f64; 2]| add(scale(e2, a), scale(e3, b));
        let turning = |[a, b]: [f64; 2]| add(scale(e3, a), scale(e2, -b));
        let off = lateral(across(&self.deflection, bend.gone));
        let turn = turning(across(&self.turn, bend.gone));
        let turn_rate = turning(across(&self.turn, bend.speed));
        let own = &body.motion;
        let tilting = tilting(body);
        let (shorter, shortening) = self.shorter(bend);
        let along = self.along + sum(&self.stretch, bend.gone[2]) - shorter;
        let arm = add_scaled(off, along, own.axis);
        let mut state = body.state;
        state.position = add(state.position, arm);
        let shaking = lateral(across(&self.deflection, bend.speed));
        let stretching = sum(&self.stretch, bend.speed[2]) - shortening;
        let shaking = add_scaled(shaking, stretching, own.axis);
        state.velocity = add(add(state.velocity, cross(tilting, arm)), shaking);
        state.orientation = turned_by(turn) * state.orientation;
        let axis = state.axis();
        let bending = add_scaled(turn_rate, 0.5, cross(turn, turn_rate));
        state.spin = add(add_scaled(tilting, dot(own.spin, own.axis), axis), bending);
        if mount.reversed {
            // Half a turn about Z, as on a rigid body.
            state.orientation *= UnitQuaternion::new_unchecked(Quaternion::new(0.0, 0.0, 0.0, 1.0));
        }
        SectionNow { race: BodyKinematics::new(state), turn, axis }
    }

    /// Acceleration of the section's centre, m/s², and its angular acceleration, rad/s², inertial axes: time derivatives
    /// of the velocities of [`Section::place`] without reversal.
    ///
    /// `linear` and `angular` are those of the body, `rates` the rates of `bend`. Third-order terms in the rotation of the
    /// section are omitted.
    pub fn acceleration(
        &self,
        body: &BodyKinematics,
        bend: &Bend,
        [linear, angular]: [Vec3; 2],
        rates: &Bend,
    ) -> [Vec3; 2] {
        let [e2, e3] = body.tilt_directions;
        let own = &body.motion;
        let across = |shape: &[f64], of: [&[f64]; 3]| [sum(shape, of[0]), sum(shape, of[1])];
        let lateral = |[a, b]: [f64; 2]| add(scale(e2, a), scale(e3, b));
        let turning = |[a, b]: [f64; 2]| add(scale(e3, a), scale(e2, -b));
        // The rates in the state contain the rotation of e₂ and e₃ about the axis, ξ̇ sin λ.
        let twist = dot(own.spin, e2) * own.axis[1] / body.cos_lambda;
        let untwisted = |shape: &[f64]| {
            let ([u, v], [du, dv]) = (across(shape, bend.speed), across(shape, rates.speed));
            [du - twist * v, dv + twist * u]
        };
        let tilting = tilting(body);
        let (spin, spin_rate) = (dot(own.spin, own.axis), dot(angular, own.axis));
        let axis_rate = cross(tilting, own.axis);
        let tilting_rate = add_scaled(add_scaled(angular, -spin_rate, own.axis), -spin, axis_rate);

        let (shorter, shortening) = self.shorter(bend);
        let along = self.along + sum(&self.stretch, bend.gone[2]) - shorter;
        let arm = add_scaled(lateral(across(&self.deflection, bend.gone)), along, own.axis);
        let stretching = sum(&self.stretch, bend.speed[2]) - shortening;
        let shaking =
            add_scaled(lateral(across(&self.deflection, bend.speed)), stretching, own.axis);
        let stretching_rate =
            sum(&self.stretch, rates.speed[2]) - self.shortening_rate(bend, rates);
        let relative = add_scaled(lateral(untwisted(&self.deflection)), stretching_rate, own.axis);
        // Carried with the tilt: ω̇ × r + ω × (ω × r) + 2 ω × v.
        let carried = add_scaled(cross(tilting, arm), 2.0, shaking);
        let carried = add(cross(tilting_rate, arm), cross(tilting, carried));
        let linear = add(add(linear, carried), relative);

        let turn = turning(across(&self.turn, bend.gone));
        let rate = turning(across(&self.turn, bend.speed));
        let turn_rate = add(rate, cross(tilting, turn));
        let second = add(turning(untwisted(&self.turn)), cross(tilting, rate));
        let bending = add_scaled(second, 0.5, add(cross(turn_rate, rate), cross(turn, second)));
        let now = self.place(body, &Mount::at_centre(0), bend);
        let own_axis_rate = cross(now.race.state.spin, now.axis);
        let spinning = add(scale(now.axis, spin_rate), scale(own_axis_rate, spin));
        [linear, add(add(tilting_rate, spinning), bending)]
    }

    /// Second time derivative of the displacement of [`Section::shorter`], m/s².
    fn shortening_rate(&self, bend: &Bend, rates: &Bend) -> f64 {
        let mut rate = 0.0;
        for side in 0..2 {
            let (gone, speed) = (bend.gone[side], bend.speed[side]);
            for (k, row) in self.shortening.chunks_exact(gone.len().max(1)).enumerate() {
                rate +=
                    rates.speed[side][k] * sum(row, gone) + speed[k] * sum(row, rates.gone[side]);
            }
        }
        rate
    }

    /// Rotation relative to its body, rad.
    pub fn turned(&self, bend: &Bend) -> f64 {
        libm::hypot(sum(&self.turn, bend.gone[0]), sum(&self.turn, bend.gone[1]))
    }

    /// Axial displacement of the section towards the body's centre by bending, and its rate, m and m/s.
    fn shorter(&self, bend: &Bend) -> (f64, f64) {
        let (mut shorter, mut rate) = (0.0, 0.0);
        for (gone, speed) in bend.gone.iter().zip(&bend.speed).take(2) {
            for (k, row) in self.shortening.chunks_exact(gone.len().max(1)).enumerate() {
                let slope = sum(row, gone);
                shorter += 0.5 * gone[k] * slope;
                rate += speed[k] * slope;
            }
        }
        (shorter, rate)
    }

    /// Wrench on a bent body, about its centre, of loads on a section; adds the modal forces (N) along e₂, e₃ and the
    /// axis to `pushes`.
    pub fn take(
        &self,
        (body, bend): (&BodyKinematics, &Bend),
        now: &SectionNow,
        loads: &Wrench,
        pushes: &mut [f64],
    ) -> Wrench {
        let [e2, e3] = body.tilt_directions;
        let Wrench { force, moment } = *loads;
        let on_turn = add_scaled(moment, -0.5, cross(now.turn, moment));
        let force_across = [dot(force, e2), dot(force, e3)];
        let moment_across = [dot(on_turn, e3), -dot(on_turn, e2)];
        let axis = body.motion.axis;
        let count = self.deflection.len();
        let (bending, stretching) = pushes.split_at_mut(2 * count);
        for (k, push) in bending.iter_mut().enumerate() {
            let (side, k) = (k / count, k % count);
            *push += self.deflection[k] * force_across[side] + self.turn[k] * moment_across[side];
        }
        let pull = dot(force, axis);
        if pull != 0.0 {
            for (k, row) in self.shortening.chunks_exact(count.max(1)).enumerate() {
                for (side, gone) in bend.gone.iter().enumerate().take(2) {
                    bending[side * count + k] -= pull * sum(row, gone);
                }
            }
        }
        for (push, stretch) in stretching.iter_mut().zip(&self.stretch) {
            *push += stretch * pull;
        }
        let arm = sub(now.race.motion.position, body.motion.position);
        let about_centre = add(moment, cross(arm, force));
        // The spin is driven about the section's own axis.
        let about_axis = dot(moment, now.axis) - dot(about_centre, axis);
        Wrench { force, moment: add_scaled(about_centre, about_axis, axis) }
    }
}

/// Powers, and the moment on the body.
#[derive(Clone, Copy, Debug, Default)]
pub struct ShaftRates {
    /// Power of damping and of loads, W.
    pub damped: f64,
    pub driven: f64,
    pub on_body: Wrench,
}

/// Terms in the equations of a shaft.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShaftSteps {
    pub loads: bool,
    pub damping: bool,
}

impl ElasticShaft {
    /// Number of bending modes in one plane.
    pub fn count(&self) -> usize {
        self.shapes.frequencies.len()
    }

    /// Number of amplitudes a, b and c.
    pub fn amplitudes(&self) -> usize {
        2 * self.count() + self.shapes.stretch_frequencies.len()
    }

    /// Sections with loads or probes.
    pub fn sections(&self) -> impl Iterator<Item = &Section> {
        let loads = self.loads.iter().map(|load| &load.section);
        let unbalances = self.unbalances.iter().map(|unbalance| &unbalance.section);
        loads.chain(unbalances).chain(self.probes.iter().map(|(_, section)| section))
    }

    /// Natural frequencies of a, b and c, rad/s.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> {
        let ShaftShapes { frequencies, stretch_frequencies, .. } = &self.shapes;
        frequencies.iter().chain(frequencies).chain(stretch_frequencies).copied()
    }

    /// Number of entries in the state: amplitudes and rates.
    pub fn entries(&self) -> usize {
        2 * self.amplitudes()
    }

    /// Rates of the amplitudes under springs, gyroscopic moments, damping, loads and unbalances; attachments add to
    /// them. `acceleration` of a prescribed spin, rad/s²; `None` for a spin driven by a torque, whose unbalances are in
    /// [`crate::members::unbalance`].
    pub fn rates(
        &self,
        steps: ShaftSteps,
        t: f64,
        acceleration: Option<f64>,
        (body, entries): (&BodyKinematics, &[f64]),
        rates: &mut [f64],
        ran: &mut Counts,
    ) -> ShaftRates {
        let count = self.count();
        let bend = Bend::of(count, entries);
        let [e2, e3] = body.tilt_directions;
        let own = &body.motion;
        let spin = dot(own.spin, own.axis);
        let tilting = [dot(own.spin, e2), dot(own.spin, e3)];
        // e₂ and e₃ rotate about the axis by ξ̇ sin λ.
        let twist = tilting[0] * own.axis[1] / body.cos_lambda;
        let mut done = ShaftRates::default();
        let (going, pushed) = rates.split_at_mut(self.amplitudes());
        for k in 0..count {
            let [a, b] = [bend.gone[0][k], bend.gone[1][k]];
            let [u, v] = [bend.speed[0][k], bend.speed[1][k]];
            going[k] = u + twist * b;
            going[count + k] = v - twist * a;
            let row = &self.shapes.gyroscopic[k * count..(k + 1) * count];
            let [across_u, across_v] = [0, 1].map(|side| sum(row, bend.speed[side]));
            let tilt = self.shapes.tilt_coupling[k];
            let stiffness = self.shapes.frequencies[k] * self.shapes.frequencies[k];
            pushed[k] = twist * v - stiffness * a - spin * (across_v - tilt * tilting[0]);
            pushed[count + k] = -twist * u - stiffness * b + spin * (across_u + tilt * tilting[1]);
        }
        for (k, frequency) in self.shapes.stretch_frequencies.iter().enumerate() {
            going[2 * count + k] = bend.speed[2][k];
            pushed[2 * count + k] = -(frequency * frequency) * bend.gone[2][k];
        }
        let coupling = &self.shapes.tilt_coupling;
        let [along, across] = [0, 1].map(|side| spin * sum(coupling, bend.speed[side]));
        done.on_body.moment = add(scale(e2, -along), scale(e3, -across));
        ran.add(Stage::Reduced, 1);
        if steps.damping {
            self.damp(spin, &bend, own.axis, pushed, &mut done);
            ran.add(Stage::Damping, 1);
        }
        if steps.loads {
            self.load(t, acceleration, (body, &bend), pushed, &mut done);
            ran.add(Stage::Loads, (self.loads.len() + self.unbalances.len()) as u64);
        }
        done
    }

    /// Damping in axes that do not rotate, and in rotating ones: −c (q̇ − Ω × q), whose moment acts on the spin.
    fn damp(&self, spin: f64, bend: &Bend, axis: Vec3, pushed: &mut [f64], done: &mut ShaftRates) {
        let count = self.count();
        let mut moment = 0.0;
        for k in 0..count {
            let [a, b] = [bend.gone[0][k], bend.gone[1][k]];
            let [u, v] = [bend.speed[0][k], bend.speed[1][k]];
            let own = [u + spin * b, v - spin * a];
            let inside = own.map(|own| -self.internal_damping * own);
            let push = [inside[0] - self.damping * u, inside[1] - self.damping * v];
            pushed[k] += push[0];
            pushed[count + k] += push[1];
            moment -= a * inside[1] - b * inside[0];
            done.damped += inside[0] * own[0] + inside[1] * own[1];
            done.damped -= self.damping * (u * u + v * v);
        }
        let along = self.damping + self.internal_damping;
        for (push, speed) in pushed[2 * count..].iter_mut().zip(bend.speed[2]) {
            *push -= along * speed;
            done.damped -= along * speed * speed;
        }
        done.on_body.moment = add_scaled(done.on_body.moment, moment, axis);
    }

    /// Modal forces of internal damping of a bent shaft that spins about a fixed axis, N: across the deflection, as
    /// fibres are stretched and compressed in turn.
    pub fn dragged(&self, spin: f64, amplitudes: &[f64]) -> Vec<f64> {
        let count = self.count();
        let drag = self.internal_damping * spin;
        let (a, rest) = amplitudes.split_at(count);
        let towards_2 = rest[..count].iter().map(|b| -drag * b);
        let towards_3 = a.iter().map(|a| drag * a);
        towards_2.chain(towards_3).chain(rest[count..].iter().map(|_| 0.0)).collect()
    }

    fn load(
        &self,
        t: f64,
        acceleration: Option<f64>,
        (body, bend): (&BodyKinematics, &Bend),
        pushed: &mut [f64],
        done: &mut ShaftRates,
    ) {
        let mount = Mount::at_centre(self.body);
        let mut push = |section: &Section, works: bool, force: &dyn Fn(&SectionNow) -> Vec3| {
            let now = section.place(body, &mount, bend);
            let force = force(&now);
            if works {
                done.driven += dot(force, now.race.motion.velocity);
            }
            let loads = Wrench { force, moment: [0.0; 3] };
            done.on_body.add(&section.take((body, bend), &now, &loads, pushed));
        };
        for load in &self.loads {
            push(&load.section, true, &|_| [0, 1, 2].map(|i| load.force[i].value(t)));
        }
        let spin = dot(body.motion.spin, body.motion.axis);
        for unbalance in &self.unbalances {
            push(&unbalance.section, acceleration.is_some(), &|now| {
                let now = &now.race.state;
                let [outwards, forward] = directions(&now.orientation, unbalance.angle);
                // m e Ω² outwards and m e dΩ/dt backwards.
                match acceleration {
                    Some(rate) => add_scaled(
                        scale(outwards, unbalance.size * spin * spin),
                        -unbalance.size * rate,
                        forward,
                    ),
                    None => turning_momentum(unbalance.size, spin, now.spin, forward),
                }
            });
        }
    }

    /// Energy of bending; the rigid motion is the body's.
    pub fn energy(&self, entries: &[f64]) -> ModalEnergy {
        let (gone, speed) = entries.split_at(self.amplitudes());
        let mut energy = ModalEnergy::default();
        for ((gone, speed), frequency) in gone.iter().zip(speed).zip(self.frequencies()) {
            energy.kinetic += 0.5 * speed * speed;
            energy.strain += 0.5 * (frequency * gone) * (frequency * gone);
        }
        energy
    }
}
