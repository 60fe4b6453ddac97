//! The equations of motion: state in, rates out.

use crate::assembly::lists::Assembly;
use crate::assembly::places::Places;
use crate::assembly::section_attachments::SectionAttachments;
use crate::ch2_housing::bearing::cage::AxisMotion;
use crate::kinematics::vec3::Vec3;
use crate::members::ball_set::{BallSet, ContactForces};
use crate::members::body::Rotation;
use crate::members::connection::{Connection, SpringForces};
use crate::members::contacts::{Kernel, Want, Work};
use crate::members::flexible_shaft::Section;
use crate::members::floating_solid::FloatingNow;
use crate::members::housing_fit::SeatNow;
use crate::members::mount::Mount;
use crate::members::reduced_solid::ModalEnergy;
use crate::members::rigid_body::{BodyKinematics, Wrench, kinematics_at_mount};
use crate::members::section_attachment::{
    SectionAttachment, kinematics_at_attachment, wrench_on_body,
};
use crate::members::state::{BODY, BodyState, LEDGER, Layout, Ledger, ORIENTATION, SPIN, VELOCITY};
use crate::members::unbalance::UnbalanceCoupling;
use crate::members::{raceway_profile, rigid_body};
use crate::motion::plan as motion;
use crate::motion::steps::Steps;
use crate::plan::counts::StageCounts;
use crate::plan::{Item, Stage};

/// An assembly with its constants and working memory.
pub struct System {
    pub assembly: Assembly,
    pub places: Places,
    /// Ball set of each bearing.
    pub sets: Vec<BallSet>,
    /// Contact of each housing fit.
    pub seats: Vec<SeatNow>,
    /// First entry of each reduced solid in the state.
    pub solids: Vec<usize>,
    /// First entry of each connection's Maxwell elements in the state.
    pub connections: Vec<usize>,
    /// First entry of each flexible shaft in the state, and the attachments on it.
    pub shafts: Vec<usize>,
    /// First entry of each floating solid in the state, and its working memory.
    pub floating: Vec<usize>,
    pub floating_now: Vec<FloatingNow>,
    pub holds: SectionAttachments,
    /// Kinematics of each body as last evaluated.
    pub bodies: Vec<BodyKinematics>,
    /// External wrench on each body about its centre, N and N·m. Constant within a step.
    pub outside: Vec<Option<Wrench>>,
    pub driver: Kernel,
    pub work: Work,
    /// Plan items of one evaluation; those that say *does* are run.
    pub plan: Vec<Item>,
    pub(crate) steps: Steps,
    /// Number of runs of each stage.
    pub ran: StageCounts,
    /// Latest time at which profiles are read, s: just before the corner at which a step ends, infinite otherwise.
    pub latest: f64,
    pub(crate) loads: Vec<Wrench>,
    pub(crate) unbalance_coupling: UnbalanceCoupling,
}

impl System {
    pub fn new(assembly: impl Into<Assembly>, driver: Kernel) -> System {
        let assembly = assembly.into();
        let plan = motion::evaluation(&assembly, &[]);
        let steps = Steps::new(&plan, &assembly);
        // Rest positions of the springs until the first evaluation.
        let bodies: Vec<BodyKinematics> =
            assembly.bodies.iter().map(|body| rigid_body::fixed(&body.rest)).collect();
        let sets = assembly
            .bearings
            .iter()
            .zip(Layout::of(&assembly))
            .zip(&steps.bearings)
            .map(|((bearing, layout), steps)| BallSet::new(bearing, *steps, layout, &bodies))
            .collect();
        let places = Places::of(&assembly);
        let seats = assembly.seats.iter();
        System {
            seats: seats.map(|seat| SeatNow::new(seat, &assembly.solids[seat.solid])).collect(),
            solids: places.solids(&assembly),
            connections: places.connections(&assembly),
            shafts: places.shafts(&assembly),
            floating: places.floating(&assembly),
            floating_now: assembly.floating.iter().map(FloatingNow::new).collect(),
            holds: SectionAttachments::new(&assembly, &bodies),
            places,
            sets,
            outside: vec![None; bodies.len()],
            loads: vec![Wrench::default(); bodies.len()],
            unbalance_coupling: UnbalanceCoupling::new(&assembly.shafts),
            bodies,
            work: Work::default(),
            ran: StageCounts::new(
                assembly.bearings.len(),
                assembly.bodies.len(),
                assembly.solids.len(),
                assembly.seats.len(),
            ),
            plan,
            steps,
            latest: f64::INFINITY,
            assembly,
            driver,
        }
    }

    pub fn body_state(&self, state: &[f64], body: usize) -> BodyState {
        let at = self.places.body(body);
        BodyState::from_slice(&state[at..at + BODY])
    }

    /// Updates all bodies to time `t`, with prescribed motions.
    fn place(&mut self, t: f64, state: &[f64]) {
        let t = t.min(self.latest);
        for &index in &self.steps.moving {
            let here = self.body_state(state, index);
            self.bodies[index] = rigid_body::body_now(&self.assembly.bodies[index], t, here);
        }
        self.holds.place(&self.assembly, &self.shafts, &self.bodies, state);
        let holds = &self.holds.bearings;
        for ((set, bearing), holds) in self.sets.iter_mut().zip(&self.assembly.bearings).zip(holds)
        {
            set.place(bearing, holds, &self.bodies);
        }
    }

    /// Forces of a connection; call after [`System::evaluate`] at the same state.
    pub fn connection_forces(&self, state: &[f64], connection: usize) -> SpringForces {
        let (at, ends) = (self.connections[connection], self.ends(connection));
        let connection = &self.assembly.connections[connection];
        let elongated = &state[at..at + 6 * connection.maxwell().len()];
        connection.forces(ends.each_ref(), elongated)
    }

    /// [`Connection::reach`] as evaluated last.
    pub(crate) fn extension(&self, connection: usize) -> [f64; 3] {
        self.assembly.connections[connection].extension(self.ends(connection).each_ref())
    }

    /// Kinematics of both ends of a connection as last evaluated.
    fn ends(&self, connection: usize) -> [BodyKinematics; 2] {
        let holds = &self.holds.connections[connection];
        let ends = &self.assembly.connections[connection].ends;
        [0, 1].map(|end| {
            kinematics_at_attachment(&holds[end], &self.bodies[ends[end].body], &ends[end])
        })
    }

    /// Rates of the state vector at time `t`.
    pub fn evaluate(&mut self, t: f64, state: &[f64], rates: &mut [f64]) {
        self.evaluate_with(Want::Forces, t, state, rates);
    }

    /// As [`System::evaluate`], with the slopes of traction if requested.
    pub fn evaluate_with(&mut self, want: Want, t: f64, state: &[f64], rates: &mut [f64]) {
        self.work.evaluations += 1;
        self.place(t, state);
        let gravity = self.steps.gravity.then_some(self.assembly.gravity);
        let mut ledger = [0.0; LEDGER];
        self.loads.fill(Wrench::default());
        self.shaft_rates(t, state, rates, &mut ledger);
        for now in &mut self.floating_now {
            now.forces.fill(0.0);
        }
        let Assembly { bearings, shafts, floating, .. } = &self.assembly;
        let bent = (shafts.as_slice(), self.shafts.as_slice(), state);
        let holds = &self.holds;
        for (((set, bearing), own), holds) in
            self.sets.iter_mut().zip(bearings).zip(&mut self.ran.bearings).zip(&holds.bearings)
        {
            let (driver, work) = (self.driver, &mut self.work);
            let caged = bearing.cage.as_ref().and_then(|cage| cage.nodes.as_ref());
            let modes = caged.map(|nodes| {
                let (solid, at) = (&floating[nodes.floating], self.floating[nodes.floating]);
                let entries = &state[at..at + 2 * solid.count()];
                (solid.split(entries), &mut self.floating_now[nodes.floating].forces[..])
            });
            let forces = ContactForces { rates, ledger: &mut ledger, modes };
            set.evaluate(bearing, gravity, driver, want, state, forces, work, own);
            self.ran.whole.add(Stage::Gravity, own.take(Stage::Gravity));
            for (side, mount) in bearing.mounts.iter().enumerate() {
                let attached = (&set.races[side], &self.bodies[mount.body]);
                let loads = &set.on_races[side];
                let loads = wrench_on_body((&holds[side], mount), attached, loads, bent, rates);
                self.loads[mount.body].add(&loads);
            }
            if let Some(cage) = &bearing.cage {
                self.loads[cage.body].add(&set.on_cage);
            }
        }
        let connections: &[Connection] =
            if self.steps.springs { &self.assembly.connections } else { &[] };
        for (index, connection) in connections.iter().enumerate() {
            let (at, ends) = (self.connections[index], self.ends(index));
            let elements = connection.maxwell();
            let elongated = &state[at..at + 6 * elements.len()];
            let forces = connection.forces([&ends[0], &ends[1]], elongated);
            for (k, element) in elements.iter().enumerate() {
                for i in 0..6 {
                    let e = at + 6 * k + i;
                    rates[e] = forces.rates[i] - state[e] / element.relaxation_time;
                }
            }
            ledger[Ledger::Foundation as usize] += forces.loss;
            for (end, mount) in connection.ends.iter().enumerate() {
                let attached = (&ends[end], &self.bodies[mount.body]);
                let hold = &holds.connections[index][end];
                let loads = wrench_on_body((hold, mount), attached, &forces.on[end], bent, rates);
                self.loads[mount.body].add(&loads);
            }
            self.ran.whole.add(Stage::Springs, 1);
        }
        self.solid_rates(t, state, rates, &mut ledger);
        for moving in 0..self.steps.moving.len() {
            self.body_rates(self.steps.moving[moving], t, state, rates, &mut ledger);
        }
        let at = self.places.ledger();
        rates[at..at + LEDGER].copy_from_slice(&ledger);
        self.ran.whole.add(Stage::Ledger, 1);
    }

    /// Rates of the flexible shafts without the forces of their attachments.
    fn shaft_rates(
        &mut self,
        t: f64,
        state: &[f64],
        rates: &mut [f64],
        ledger: &mut [f64; LEDGER],
    ) {
        let time = t.min(self.latest);
        for &(index, steps) in &self.steps.shafts {
            let (shaft, at) = (&self.assembly.shafts[index], self.shafts[index]);
            let body = &self.assembly.bodies[shaft.body];
            let acceleration = match body.driven().map(|driven| &driven.rotation) {
                Some(Rotation::Speed(profile)) => Some(profile.rate(time)),
                Some(Rotation::Torque(_)) => None,
                None => Some(0.0),
            };
            let entries = at..at + shaft.entries();
            let (now, own) = (&self.bodies[shaft.body], &mut self.ran.bodies[shaft.body]);
            let bent = (now, &state[entries.clone()]);
            let done = shaft.rates(steps, time, acceleration, bent, &mut rates[entries], own);
            ledger[Ledger::Foundation as usize] += done.damped;
            ledger[Ledger::Drives as usize] += done.driven;
            self.loads[shaft.body].add(&done.on_body);
        }
    }

    /// Rates of the reduced solids; sums the forces of their housing fits on bodies.
    fn solid_rates(
        &mut self,
        t: f64,
        state: &[f64],
        rates: &mut [f64],
        ledger: &mut [f64; LEDGER],
    ) {
        let t = t.min(self.latest);
        let Assembly { solids, seats, shafts, .. } = &self.assembly;
        let bent = (shafts.as_slice(), self.shafts.as_slice(), state);
        for &(index, steps) in &self.steps.solids {
            let (solid, at) = (&solids[index], self.solids[index]);
            let (gone, speeds) = state[at..at + 2 * solid.count()].split_at(solid.count());
            let (to, accelerations) = rates[at..at + 2 * solid.count()].split_at_mut(solid.count());
            to.copy_from_slice(speeds);
            let own = &mut self.ran.solids[index];
            let [damped, driven] =
                solid.accelerations(steps, t, [gone, speeds], accelerations, own);
            ledger[Ledger::Foundation as usize] += damped;
            ledger[Ledger::Drives as usize] += driven;
        }
        for &index in &self.steps.seats {
            let (seat, now) = (&seats[index], &mut self.seats[index]);
            let (solid, at) = (&solids[seat.solid], self.solids[seat.solid]);
            let body = &self.bodies[seat.race.body];
            let hold = &self.holds.seats[index];
            let race = kinematics_at_attachment(hold, body, &seat.race);
            let gone = &state[at..at + solid.count()];
            let pushes = &mut rates[at + solid.count()..at + 2 * solid.count()];
            let loads = now.evaluate(seat, solid, &race, t, gone, pushes);
            let attached = (&race, body);
            let loads = wrench_on_body((hold, &seat.race), attached, &loads, bent, rates);
            self.loads[seat.race.body].add(&loads);
            // Growth of the race does work against the contact.
            ledger[Ledger::Drives as usize] += now.contact.radial_load * seat.radius.rate(t);
            self.ran.seats[index].add(Stage::Seat, 1);
        }
    }

    /// Modal coordinates of a reduced solid (m) and their rates (m/s).
    pub fn shapes_of<'s>(&self, state: &'s [f64], solid: usize) -> (&'s [f64], &'s [f64]) {
        let (at, count) = (self.solids[solid], self.assembly.solids[solid].count());
        state[at..at + 2 * count].split_at(count)
    }

    /// Entries of a flexible shaft.
    pub fn bent<'s>(&self, state: &'s [f64], shaft: usize) -> &'s [f64] {
        let at = self.shafts[shaft];
        &state[at..at + self.assembly.shafts[shaft].entries()]
    }

    /// Kinematics of a race of a bearing in a state, whatever was evaluated last; prescribed motions are not imposed.
    pub fn race_of(&self, state: &[f64], bearing: usize, side: usize) -> BodyKinematics {
        let mount = &self.assembly.bearings[bearing].mounts[side];
        let body = BodyKinematics::new(self.body_state(state, mount.body));
        self.on_body(&self.holds.bearings[bearing][side], state, &body, mount)
    }

    /// Motion of [`System::race_of`] without derived quantities.
    pub(crate) fn race_motion(&self, state: &[f64], bearing: usize, side: usize) -> AxisMotion {
        let mount = &self.assembly.bearings[bearing].mounts[side];
        if self.holds.bearings[bearing][side].is_none() && mount.is_direct() {
            return rigid_body::axis_motion(&self.body_state(state, mount.body));
        }
        self.race_of(state, bearing, side).motion
    }

    /// Kinematics of an attachment on a body, with the bending of a state.
    pub fn on_body(
        &self,
        hold: &Option<SectionAttachment>,
        state: &[f64],
        body: &BodyKinematics,
        mount: &Mount,
    ) -> BodyKinematics {
        match hold {
            None => kinematics_at_mount(body, mount),
            Some(hold) => {
                let shaft = &self.assembly.shafts[hold.shaft];
                let bend = shaft.bend(self.shafts[hold.shaft], state);
                hold.section.place(body, mount, &bend).race
            }
        }
    }

    /// Kinematics of a section of a flexible shaft in a state; prescribed motions are not imposed.
    pub fn section_now(&self, state: &[f64], shaft: usize, section: &Section) -> BodyKinematics {
        let (of, at) = (&self.assembly.shafts[shaft], self.shafts[shaft]);
        let now = BodyKinematics::new(self.body_state(state, of.body));
        section.place(&now, &Mount::at_centre(of.body), &of.bend(at, state)).race
    }

    /// Acceleration of a body's centre (m/s²) and its angular acceleration (rad/s²), inertial axes, from the rates.
    pub fn acceleration_of(&self, rates: &[f64], body: usize) -> [Vec3; 2] {
        let at = self.places.body(body);
        [VELOCITY, SPIN].map(|part| [0, 1, 2].map(|i| rates[at + part + i]))
    }

    /// Entries of a floating solid.
    pub fn deformed<'s>(&self, state: &'s [f64], solid: usize) -> &'s [f64] {
        let at = self.floating[solid];
        &state[at..at + 2 * self.assembly.floating[solid].count()]
    }

    /// Energy of a reduced solid in a state.
    pub fn energy_of_solid(&self, state: &[f64], solid: usize) -> ModalEnergy {
        let (gone, speeds) = self.shapes_of(state, solid);
        self.assembly.solids[solid].energy(gone, speeds)
    }

    /// Writes prescribed positions and rates into the state, and normalises quaternions.
    pub fn tidy(&self, t: f64, state: &mut [f64]) {
        let t = t.min(self.latest);
        for &index in &self.steps.moving {
            let body = &self.assembly.bodies[index];
            let mut now = rigid_body::body_now(body, t, self.body_state(state, index)).state;
            now.orientation.renormalize();
            let at = self.places.body(index);
            state[at..at + BODY].copy_from_slice(&now.to_array());
        }
        for set in &self.sets {
            let layout = &set.layout;
            for ball in 0..layout.balls {
                let parts = [0, 1, 2, 3].map(|i| layout.ball(ORIENTATION + i) + ball);
                let square: f64 = parts.iter().map(|&at| state[at] * state[at]).sum();
                let per_length = 1.0 / square.sqrt();
                for at in parts {
                    state[at] *= per_length;
                }
            }
        }
    }

    /// Longest step, s, in which every ball meets every profile on its path; infinite without profiles.
    pub(crate) fn longest_past_profiles(&self, state: &[f64]) -> f64 {
        let profiled = self.sets.iter().filter(|set| set.steps.raceway_profiles);
        profiled
            .fold(f64::INFINITY, |least, set| least.min(raceway_profile::longest_step(set, state)))
    }
}
