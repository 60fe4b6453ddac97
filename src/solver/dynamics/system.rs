//! The equations of motion: state in, rates out.

use super::contacts::{self, ContactLaws, ContactTable, Driver, Want, Work};
use super::model::{BallMeeting, DynamicProblem, RaceBody, Rotation};
use super::race::{self, RaceLoads, RaceNow};
use super::state::{
    BODY, BodyState, LEDGER, Layout, Ledger, ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate,
};
use crate::ch2_housing::bearing::ball_contact::{BallContact, ball_contact};
use crate::ch2_housing::bearing::cage::{
    AxisMotion, CageContact, Guidance, guide_contact, pocket_contact,
};
use crate::ch2_housing::bearing::contact::{ContactDamping, RaceLaw, normal_load};
use crate::ch2_housing::bearing::geometry::Raceway;
use crate::ch2_housing::bearing::hertz::{HertzContact, contact_ellipse};
use crate::ch2_housing::bearing::traction::{Motion, Slices, TractionLaw};
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// A problem with everything precomputed and room to work in.
pub struct System {
    pub problem: DynamicProblem,
    pub layout: Layout,
    pub laws: ContactLaws,
    pub driver: Driver,
    pub table: ContactTable,
    pub work: Work,
    /// Damping factor of each pair in s/m; zero without damping.
    pub damping: Vec<f64>,
    /// Contacts of the cage with each ball, then with the guiding race at both ends.
    pub pockets: Vec<CageContact>,
    pub guides: [CageContact; 2],
    /// Each ball with the next one; empty where they cannot meet.
    pub meetings: Vec<BallContact>,
    /// Profiles are read no later than this, s: in a step that ends at a corner, just before it, so
    /// that no stage sees what comes after. Infinite otherwise.
    pub latest: f64,
    /// What a housing does to the outer race, about its centre; stays as it is within a step.
    pub housing_load: RaceLoads,
    fixed_outer: RaceNow,
    ball_force: Vec<Vec3>,
    ball_moment: Vec<Vec3>,
}

/// Everything at one instant that outputs are made of.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    pub inner: RaceNow,
    pub outer: RaceNow,
    pub cage: Option<AxisMotion>,
    /// Sum of contact forces on each race and moment about its centre.
    pub on_inner: RaceLoads,
    pub on_outer: RaceLoads,
}

fn race_law(raceway: &Raceway, hertz: &HertzContact, ball_radius: f64, outward: f64) -> RaceLaw {
    // a ∝ W^(1/3) and W = K δ^(3/2), so a = a(K)·√δ.
    RaceLaw {
        centre_axial: raceway.centre_axial,
        centre_radius: raceway.centre_radius,
        room: raceway.groove_radius - ball_radius,
        stiffness: hertz.stiffness,
        semi_major_factor: contact_ellipse(hertz, hertz.stiffness).semi_major,
        outward,
    }
}

impl System {
    pub fn new(problem: DynamicProblem, driver: Driver) -> System {
        let layout = Layout::new(problem.geometry.ball_count, problem.cage.is_some());
        let radius = problem.geometry.ball_radius;
        // The deformed surface lies between ball and groove: R = 2 r_g r_b/(r_g + r_b).
        let curvature = |groove: f64| {
            if problem.heathcote { 0.25 * (groove + radius) / (groove * radius) } else { 0.0 }
        };
        let laws = ContactLaws {
            races: [
                race_law(&problem.geometry.inner, &problem.inner_contact, radius, -1.0),
                race_law(&problem.geometry.outer, &problem.outer_contact, radius, 1.0),
            ],
            ball_radius: radius,
            traction: problem.traction.clone(),
            slices: Slices::new(if problem.traction == TractionLaw::None {
                1
            } else {
                problem.slices
            }),
            curvature: [
                curvature(problem.geometry.inner.groove_radius),
                curvature(problem.geometry.outer.groove_radius),
            ],
        };
        let alpha = match problem.damping {
            ContactDamping::HuntCrossley { alpha } => 1.5 * alpha,
            ContactDamping::None | ContactDamping::LankaraniNikravesh { .. } => 0.0,
        };
        let meetings = match problem.ball_meeting() {
            BallMeeting::Tested => neighbours(layout.balls),
            BallMeeting::NoLaw | BallMeeting::KeptApart { .. } => 0,
        };
        System {
            table: ContactTable::new(&layout),
            damping: vec![alpha; 2 * layout.padded],
            pockets: vec![CageContact::default(); layout.balls],
            guides: [CageContact::default(); 2],
            meetings: vec![BallContact::default(); meetings],
            ball_force: vec![[0.0; 3]; layout.balls],
            ball_moment: vec![[0.0; 3]; layout.balls],
            work: Work::default(),
            latest: f64::INFINITY,
            housing_load: RaceLoads::default(),
            fixed_outer: race::fixed(&problem.outer_start),
            problem,
            layout,
            laws,
            driver,
        }
    }

    fn race_state(&self, state: &[f64], at: usize) -> BodyState {
        BodyState::from_slice(&state[at..at + BODY])
    }

    /// Both races at time `t`, prescribed motions imposed.
    pub fn races(&self, t: f64, state: &[f64]) -> (RaceNow, RaceNow) {
        let t = t.min(self.latest);
        let inner = race::now(&self.problem.inner, t, self.race_state(state, self.layout.inner()));
        let outer = match &self.problem.outer {
            Some(body) => race::now(body, t, self.race_state(state, self.layout.outer())),
            None => self.fixed_outer,
        };
        (inner, outer)
    }

    pub(super) fn cage_motion(&self, state: &[f64]) -> Option<AxisMotion> {
        self.problem.cage.as_ref()?;
        let body = self.race_state(state, self.layout.cage());
        Some(AxisMotion {
            position: body.position,
            velocity: body.velocity,
            spin: body.spin,
            axis: body.axis(),
        })
    }

    /// Rates of the whole state vector at time `t`.
    pub fn evaluate(&mut self, t: f64, state: &[f64], rates: &mut [f64]) -> Instant {
        self.evaluate_with(Want::Forces, t, state, rates)
    }

    /// As [`System::evaluate`], with the slopes of traction if they are wanted.
    pub fn evaluate_with(
        &mut self,
        want: Want,
        t: f64,
        state: &[f64],
        rates: &mut [f64],
    ) -> Instant {
        self.work.evaluations += 1;
        let (inner, outer) = self.races(t, state);
        contacts::evaluate(
            self.driver,
            &self.laws,
            &self.layout,
            state,
            [&inner, &outer],
            &self.damping,
            want,
            &mut self.table,
            &mut self.work,
        );
        let layout = self.layout;
        let mass = self.problem.ball.mass;
        let weight = scale(self.problem.gravity, mass);
        self.ball_force.fill(weight);
        self.ball_moment.fill([0.0; 3]);
        let mut ledger = [0.0; LEDGER];
        let mut on_races = [RaceLoads::default(); 2];
        self.add_race_contacts(state, [&inner, &outer], &mut on_races, &mut ledger);
        let [mut on_inner, mut on_outer] = on_races;
        self.add_ball_contacts(state, &mut ledger);
        let cage = self.cage_motion(state);
        let mut on_cage = RaceLoads::default();
        if let Some(motion) = &cage {
            self.add_cage_contacts(state, motion, &inner, &outer, &mut on_cage, &mut ledger);
            let guiding = match self.guidance() {
                Guidance::InnerRace => Some((&mut on_inner, &inner)),
                Guidance::OuterRace => Some((&mut on_outer, &outer)),
                Guidance::Balls => None,
            };
            if let Some((loads, race)) = guiding {
                for contact in &self.guides {
                    add_load(loads, race.motion.position, contact.point, contact.force);
                }
            }
        }
        let instant = Instant { inner, outer, cage, on_inner, on_outer };

        for ball in 0..layout.balls {
            let force = self.ball_force[ball];
            let moment = self.ball_moment[ball];
            for i in 0..3 {
                rates[layout.ball(POSITION + i) + ball] = state[layout.ball(VELOCITY + i) + ball];
                rates[layout.ball(VELOCITY + i) + ball] = force[i] / mass;
                rates[layout.ball(SPIN + i) + ball] = moment[i] / self.problem.ball.axial;
            }
            let q = [0, 1, 2, 3].map(|i| state[layout.ball(ORIENTATION + i) + ball]);
            let turning = quaternion_rate(q, layout.ball_vector(state, SPIN, ball));
            for (i, value) in turning.into_iter().enumerate() {
                rates[layout.ball(ORIENTATION + i) + ball] = value;
            }
        }
        self.race_rates(t, &instant, rates, &mut ledger);
        if let (Some(body), Some(motion)) = (&self.problem.cage, &cage) {
            let force = add_scaled(on_cage.force, body.inertia.mass, self.problem.gravity);
            let (acceleration, spin_rate) =
                race::free_rates(&body.inertia, motion.axis, motion.spin, force, on_cage.moment);
            let at = layout.cage();
            write_body(rates, at, &self.race_state(state, at), acceleration, spin_rate);
        }
        let at = layout.ledger();
        rates[at..at + LEDGER].copy_from_slice(&ledger);
        instant
    }

    pub(super) fn guidance(&self) -> Guidance {
        self.problem.cage.as_ref().map_or(Guidance::Balls, |cage| cage.contacts.guidance)
    }

    /// Normal and tangential contact forces on balls and races, in the order of the pairs.
    fn add_race_contacts(
        &mut self,
        state: &[f64],
        races: [&RaceNow; 2],
        on_races: &mut [RaceLoads; 2],
        ledger: &mut [f64; LEDGER],
    ) {
        if self.problem.damping != ContactDamping::None {
            ledger[Ledger::ContactDamping as usize] += self.damping_power();
        }
        let has_traction = self.laws.traction != TractionLaw::None;
        for &pair in &self.table.active {
            let (side, ball) = (pair / self.layout.padded, pair % self.layout.padded);
            let contact = &self.table.contact[pair];
            let load = self.table.load[pair];
            let mut force = scale(contact.normal, -load);
            let arm = scale(contact.normal, self.laws.ball_radius - 0.5 * contact.overlap);
            let mut moment = [0.0; 3];
            if has_traction {
                let traction = &self.table.traction[pair];
                force = add(force, traction.force);
                moment = traction.moment;
                ledger[Ledger::Traction as usize] += traction.power;
            }
            self.ball_force[ball] = add(self.ball_force[ball], force);
            let about_ball = add(cross(arm, force), moment);
            self.ball_moment[ball] = add(self.ball_moment[ball], about_ball);
            // The race feels the opposite force at the same point.
            let position = self.layout.ball_vector(state, POSITION, ball);
            let from_race = sub(position, races[side].motion.position);
            let race_arm = add(from_race, arm);
            let loads = &mut on_races[side];
            loads.force = sub(loads.force, force);
            loads.moment = sub(loads.moment, add(cross(race_arm, force), moment));
        }
    }

    /// Power of contact damping, W, ≤ 0. A contact that opens faster than its damping allows
    /// carries no load, so that it is not an active one, but loses what it has stored.
    fn damping_power(&self) -> f64 {
        let mut power = 0.0;
        for (side, law) in self.laws.races.iter().enumerate() {
            for ball in 0..self.layout.balls {
                let pair = side * self.layout.padded + ball;
                let contact = &self.table.contact[pair];
                let elastic = normal_load(law.stiffness, contact.overlap);
                power -= (self.table.load[pair] - elastic) * contact.closing_speed;
            }
        }
        power
    }

    /// Contacts of each ball with the next one, where they can meet. Grooves keep the balls in their
    /// order, so that neighbours in number are neighbours in azimuth.
    fn add_ball_contacts(&mut self, state: &[f64], ledger: &mut [f64; LEDGER]) {
        let Some(law) = self.problem.ball_contact else { return };
        self.work.ball_tests += self.meetings.len() as u64;
        for one in 0..self.meetings.len() {
            let other = (one + 1) % self.layout.balls;
            let [here, there] = [one, other].map(|ball| Motion {
                position: self.layout.ball_vector(state, POSITION, ball),
                velocity: self.layout.ball_vector(state, VELOCITY, ball),
                spin: self.layout.ball_vector(state, SPIN, ball),
            });
            let Some(contact) = ball_contact(&law, self.laws.ball_radius, &here, &there) else {
                // Nothing is written where nothing was.
                if self.meetings[one].overlap != 0.0 {
                    self.meetings[one] = BallContact::default();
                }
                continue;
            };
            self.meetings[one] = contact;
            self.ball_force[one] = sub(self.ball_force[one], contact.force);
            self.ball_force[other] = add(self.ball_force[other], contact.force);
            // Arm and force are both the opposite: the same moment on either ball.
            let moment = cross(contact.arm, contact.force);
            self.ball_moment[one] = sub(self.ball_moment[one], moment);
            self.ball_moment[other] = sub(self.ball_moment[other], moment);
            ledger[Ledger::BallFriction as usize] += contact.power;
        }
    }

    /// Pocket and guide contacts of the cage.
    fn add_cage_contacts(
        &mut self,
        state: &[f64],
        cage: &AxisMotion,
        inner: &RaceNow,
        outer: &RaceNow,
        on_cage: &mut RaceLoads,
        ledger: &mut [f64; LEDGER],
    ) {
        let Some(body) = &self.problem.cage else { return };
        let law = &body.contacts;
        let orientation = self.race_state(state, self.layout.cage()).orientation;
        let [e2, e3]: [Vec3; 2] =
            [(orientation * Vector3::y()).into(), (orientation * Vector3::z()).into()];
        for ball in 0..self.layout.balls {
            // Pocket directions turn with the cage from where the balls started.
            let angle = self.problem.ball_phase + TAU * ball as f64 / self.layout.balls as f64;
            let (sin, cos) = libm::sincos(angle);
            let towards = add(scale(e2, cos), scale(e3, sin));
            let motion = AxisMotion {
                position: self.layout.ball_vector(state, POSITION, ball),
                velocity: self.layout.ball_vector(state, VELOCITY, ball),
                spin: self.layout.ball_vector(state, SPIN, ball),
                axis: [1.0, 0.0, 0.0],
            };
            let contact = pocket_contact(law, cage, towards, &motion, self.laws.ball_radius);
            self.pockets[ball] = contact;
            if contact.normal_load == 0.0 {
                continue;
            }
            self.ball_force[ball] = add(self.ball_force[ball], contact.force);
            let arm = sub(contact.point, motion.position);
            self.ball_moment[ball] = add(self.ball_moment[ball], cross(arm, contact.force));
            add_load(on_cage, cage.position, contact.point, scale(contact.force, -1.0));
            ledger[Ledger::CageFriction as usize] += contact.power;
        }
        self.work.pocket_tests += self.layout.balls as u64;
        let race = match law.guidance {
            Guidance::Balls => return,
            Guidance::InnerRace => inner,
            Guidance::OuterRace => outer,
        };
        self.work.guide_tests += 2;
        for (contact, side) in self.guides.iter_mut().zip([-1.0, 1.0]) {
            *contact = guide_contact(law, cage, &race.motion, side);
            add_load(on_cage, cage.position, contact.point, scale(contact.force, -1.0));
            ledger[Ledger::CageFriction as usize] += contact.power;
        }
    }

    /// Rates of both races.
    fn race_rates(&self, t: f64, instant: &Instant, rates: &mut [f64], ledger: &mut [f64; LEDGER]) {
        let t = t.min(self.latest);
        let problem = &self.problem;
        let mut loads = instant.on_inner;
        loads.force = add_scaled(loads.force, problem.inner.inertia.mass, problem.gravity);
        let mut turning = [0.0; 3];
        if let Some(load) = &problem.rotating_load {
            turning = load.force(t);
        }
        if problem.unbalance != 0.0 {
            // m e Ω² along the race's own Y, which turns with it, and m e dΩ/dt against its Z.
            let state = &instant.inner.state;
            let direction = |of: Vector3<f64>| -> Vec3 { (state.orientation * of).into() };
            let speed = dot(state.spin, instant.inner.motion.axis);
            let centrifugal = problem.unbalance * speed * speed;
            turning = add_scaled(turning, centrifugal, direction(Vector3::y()));
            if let Rotation::Speed(profile) = &problem.inner.rotation {
                let lagging = problem.unbalance * profile.rate(t);
                turning = add_scaled(turning, -lagging, direction(Vector3::z()));
            }
        }
        loads.force = add(loads.force, turning);
        ledger[Ledger::Drives as usize] += dot(turning, instant.inner.state.velocity);
        self.body_rates(
            t,
            &problem.inner,
            &instant.inner,
            &[0.0; 5],
            &loads,
            self.layout.inner(),
            rates,
            ledger,
        );
        if let Some(body) = &problem.outer {
            let mut loads = instant.on_outer;
            loads.force = add_scaled(loads.force, body.inertia.mass, problem.gravity);
            let RaceLoads { force, moment } = self.housing_load;
            loads.force = add(loads.force, force);
            loads.moment = add(loads.moment, moment);
            let BodyState { velocity, spin, .. } = instant.outer.state;
            ledger[Ledger::Foundation as usize] += dot(force, velocity) + dot(moment, spin);
            self.body_rates(
                t,
                body,
                &instant.outer,
                &problem.outer_start,
                &loads,
                self.layout.outer(),
                rates,
                ledger,
            );
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn body_rates(
        &self,
        t: f64,
        body: &RaceBody,
        now: &RaceNow,
        start: &[f64; 5],
        loads: &RaceLoads,
        at: usize,
        rates: &mut [f64],
        ledger: &mut [f64; LEDGER],
    ) {
        let result = race::rates(body, t, now, start, loads);
        write_body(rates, at, &now.state, result.acceleration, result.spin_rate);
        ledger[Ledger::Drives as usize] += result.drive_power;
        ledger[Ledger::Foundation as usize] += result.foundation_power;
    }

    /// Writes prescribed positions and rates into the state, and makes quaternions unit again.
    pub fn tidy(&self, t: f64, state: &mut [f64]) {
        let (inner, outer) = self.races(t, state);
        let write = |state: &mut [f64], at: usize, body: BodyState| {
            let mut body = body;
            body.orientation.renormalize();
            state[at..at + BODY].copy_from_slice(&body.to_array());
        };
        write(state, self.layout.inner(), inner.state);
        if self.problem.outer.is_some() {
            write(state, self.layout.outer(), outer.state);
        }
        if self.layout.has_cage {
            let at = self.layout.cage();
            write(state, at, self.race_state(state, at));
        }
        for ball in 0..self.layout.balls {
            let parts = [0, 1, 2, 3].map(|i| self.layout.ball(ORIENTATION + i) + ball);
            let square: f64 = parts.iter().map(|&at| state[at] * state[at]).sum();
            let per_length = 1.0 / square.sqrt();
            for at in parts {
                state[at] *= per_length;
            }
        }
    }
}

/// Pairs of balls that lie next to each other.
pub fn neighbours(balls: usize) -> usize {
    if balls < 3 { balls.saturating_sub(1) } else { balls }
}

fn add_load(loads: &mut RaceLoads, centre: Vec3, point: Vec3, force: Vec3) {
    loads.force = add(loads.force, force);
    loads.moment = add(loads.moment, cross(sub(point, centre), force));
}

fn write_body(
    rates: &mut [f64],
    at: usize,
    state: &BodyState,
    acceleration: Vec3,
    spin_rate: Vec3,
) {
    let q = state.orientation;
    rates[at + POSITION..at + POSITION + 3].copy_from_slice(&state.velocity);
    rates[at + ORIENTATION..at + ORIENTATION + 4]
        .copy_from_slice(&quaternion_rate([q.w, q.i, q.j, q.k], state.spin));
    rates[at + VELOCITY..at + VELOCITY + 3].copy_from_slice(&acceleration);
    rates[at + SPIN..at + SPIN + 3].copy_from_slice(&spin_rate);
}

impl System {
    /// Lankarani and Nikravesh: a contact that has just begun takes its speed of approach as v₀.
    /// History changes here and nowhere else, once a step; call after [`System::evaluate`]. Returns
    /// whether a damping factor has changed.
    pub fn commit_damping(&mut self, was_loaded: &mut [bool]) -> bool {
        let ContactDamping::LankaraniNikravesh { restitution, slowest } = self.problem.damping
        else {
            return false;
        };
        let mut changed = false;
        for race in 0..2 {
            for ball in 0..self.layout.balls {
                let pair = race * self.layout.padded + ball;
                let contact = &self.table.contact[pair];
                let loaded = contact.overlap > 0.0;
                let before = self.damping[pair];
                if loaded && !was_loaded[pair] {
                    let approach = contact.closing_speed.abs().max(slowest);
                    self.damping[pair] = 0.75 * (1.0 - restitution * restitution) / approach;
                } else if !loaded {
                    self.damping[pair] = 0.0;
                }
                was_loaded[pair] = loaded;
                changed |= self.damping[pair] != before;
            }
        }
        changed
    }
}
