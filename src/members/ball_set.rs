//! One bearing of an assembly with its constants and working memory: contacts of its balls with both races, each other
//! and the cage.

use crate::ch2_housing::bearing::ball_contact::{BallContact, are_apart, ball_contact};
use crate::ch2_housing::bearing::cage::{
    AxisMotion, CageContact, Guidance, guide_contact, pocket_contact,
};
use crate::ch2_housing::bearing::contact::{ContactDamping, normal_load};
use crate::ch2_housing::bearing::slices::Motion;
use crate::kinematics::vec3::{Vec3, add, cross, dot, scale, sub};
use crate::members::bearing::Bearing;
use crate::members::cage_nodes::{CageNodes, CageNow, Deformation, Touched};
use crate::members::contacts::{ContactLaws, ContactTable, Kernel, Want, Work, lane};
use crate::members::dent_table::DentError;
use crate::members::mount::Mount;
use crate::members::raceway_profile::RacewayProfiles;
use crate::members::rigid_body::{BodyKinematics, Wrench, kinematics_at_mount};
use crate::members::section_attachment::{SectionAttachment, kinematics_at_attachment};
use crate::members::state::{
    LANES, LEDGER, Layout, Ledger, ORIENTATION, POSITION, SPIN, VELOCITY, quaternion_rate,
};
use crate::members::steps::BearingSteps;
use crate::members::{contacts, raceway_profile};
use crate::plan::Stage;
use crate::plan::counts::Counts;
use nalgebra::Vector3;

pub struct BallSet {
    /// Stages of each evaluation.
    pub steps: BearingSteps,
    pub layout: Layout,
    pub laws: ContactLaws,
    pub table: ContactTable,
    /// Damping factor of contacts with races, s/m; zero without damping.
    pub damping: f64,
    /// Cosine and sine of each pocket's angle on its cage, from the start of the balls; they rotate with the cage.
    pocket_angles: Vec<[f64; 2]>,
    /// Contacts of the cage with each ball, then with the guiding race at both ends.
    pub pockets: Vec<CageContact>,
    pub guides: [CageContact; 2],
    /// Contact of each ball with the next one; empty if balls cannot meet.
    pub meetings: Vec<BallContact>,
    /// Inner and outer race, as last evaluated.
    pub races: [BodyKinematics; 2],
    pub cage: Option<BodyKinematics>,
    /// Sum of contact forces on each race and moment about its centre.
    pub on_races: [Wrench; 2],
    /// Loads on the cage, about its own centre.
    pub on_cage: Wrench,
    /// Energy stored in contacts of the cage's nodes, J; without nodes it follows from the contacts.
    pub cage_energy: f64,
    /// Modal forces of the normal loads between the cage's nodes and the land, for both ends, N.
    pub guide_modes: [Vec<f64>; 2],
    /// External wrench on each ball, N and N·m, constant within a step; empty without.
    pub outside: Vec<Wrench>,
    /// Error of its dents; there is no motion then.
    pub no_dents: Option<DentError>,
    ball_force: Vec<Vec3>,
    ball_moment: Vec<Vec3>,
}

/// Where the forces of a bearing's contacts go, in addition to its bodies.
pub struct ContactForces<'e> {
    /// Rates of the balls.
    pub rates: &'e mut [f64],
    pub ledger: &'e mut [f64; LEDGER],
    /// Modes of a cage with contact nodes: amplitudes (m), rates (m/s), and modal forces (N).
    pub modes: Option<([&'e [f64]; 2], &'e mut [f64])>,
}

impl BallSet {
    pub fn new(
        bearing: &Bearing,
        steps: BearingSteps,
        layout: Layout,
        bodies: &[BodyKinematics],
    ) -> BallSet {
        let geometry = &bearing.geometry;
        let (raceway_profiles, no_dents) = match raceway_profile::profiles(bearing) {
            Ok(profiles) => (profiles, None),
            Err(error) => (RacewayProfiles::default(), Some(error)),
        };
        let laws = ContactLaws::of(bearing, steps, raceway_profiles);
        let damping = match bearing.damping {
            ContactDamping::HuntCrossley { alpha } => 1.5 * alpha,
            ContactDamping::None => 0.0,
        };
        let azimuths = geometry.azimuths(bearing.ball_phase);
        let meetings = if steps.ball_contact { neighbours(layout.balls) } else { 0 };
        BallSet {
            steps,
            table: ContactTable::new(&layout),
            damping,
            pocket_angles: azimuths.into_iter().map(cosine_and_sine).collect(),
            pockets: vec![CageContact::default(); layout.balls],
            guides: [CageContact::default(); 2],
            meetings: vec![BallContact::default(); meetings],
            races: bearing.mounts.map(|mount| kinematics_at_mount(&bodies[mount.body], &mount)),
            cage: bearing.cage.as_ref().map(|cage| bodies[cage.body]),
            on_races: [Wrench::default(); 2],
            on_cage: Wrench::default(),
            cage_energy: 0.0,
            guide_modes: bearing
                .cage
                .as_ref()
                .and_then(|cage| cage.nodes.as_ref())
                .map_or_else(Default::default, |nodes| {
                    [0, 1].map(|_| vec![0.0; nodes.largest.len()])
                }),
            outside: Vec::new(),
            no_dents,
            ball_force: vec![[0.0; 3]; layout.balls],
            ball_moment: vec![[0.0; 3]; layout.balls],
            laws,
            layout,
        }
    }

    /// Updates both races and the cage from their bodies.
    pub fn place(
        &mut self,
        bearing: &Bearing,
        holds: &[Option<SectionAttachment>; 2],
        bodies: &[BodyKinematics],
    ) {
        for ((race, hold), mount) in self.races.iter_mut().zip(holds).zip(&bearing.mounts) {
            *race = kinematics_at_attachment(hold, &bodies[mount.body], mount);
        }
        self.cage = bearing.cage.as_ref().map(|cage| bodies[cage.body]);
    }

    /// Loads on balls, races and cage at their present positions; rates of the balls.
    #[allow(clippy::too_many_arguments)]
    pub fn evaluate(
        &mut self,
        bearing: &Bearing,
        gravity: Option<Vec3>,
        driver: Kernel,
        want: Want,
        state: &[f64],
        ContactForces { rates, ledger, modes }: ContactForces,
        work: &mut Work,
        ran: &mut Counts,
    ) {
        let BallSet { layout, laws, table, damping, races: [inner, outer], steps, .. } = self;
        let set =
            contacts::Set { laws, layout, races: [inner, outer], damping: *damping, steps: *steps };
        contacts::evaluate(driver, set, state, want, table, work, ran);
        match gravity {
            Some(gravity) => {
                self.ball_force.fill(scale(gravity, bearing.ball.mass));
                ran.add(Stage::Gravity, self.ball_force.len() as u64);
            }
            None => self.ball_force.fill([0.0; 3]),
        }
        self.ball_moment.fill([0.0; 3]);
        for (ball, of) in self.outside.iter().enumerate() {
            self.ball_force[ball] = add(self.ball_force[ball], of.force);
            self.ball_moment[ball] = of.moment;
            let [velocity, spin] =
                [VELOCITY, SPIN].map(|part| self.layout.ball_vector(state, part, ball));
            ledger[Ledger::Foundation as usize] += dot(of.force, velocity) + dot(of.moment, spin);
        }
        self.on_races = [Wrench::default(); 2];
        self.on_cage = Wrench::default();
        self.add_race_contacts(state, ledger);
        if self.steps.ball_contact {
            self.add_ball_contacts(bearing, state, ledger, work, ran);
        }
        match (modes, bearing.cage.as_ref().and_then(|cage| cage.nodes.as_ref())) {
            (Some((modes, forces)), Some(nodes)) => {
                let modal = (modes, forces);
                self.add_node_contacts((bearing, nodes), state, modal, ledger, work, ran);
            }
            _ => {
                if self.steps.pockets {
                    self.add_pocket_contacts(bearing, state, ledger, work, ran);
                }
                if self.steps.guide {
                    self.add_guide_contacts(bearing, ledger, work, ran);
                }
            }
        }
        self.ball_rates(bearing, state, rates);
    }

    /// Over blocks of [`LANES`] balls, component by component; padding does not move.
    fn ball_rates(&self, bearing: &Bearing, state: &[f64], rates: &mut [f64]) {
        let layout = self.layout;
        for first in (0..layout.padded).step_by(LANES) {
            let count = LANES.min(layout.balls - first);
            let at = |component: usize| layout.ball(component) + first;
            let mut put = |component: usize, values: &[f64; LANES]| {
                rates[at(component)..at(component) + LANES].copy_from_slice(values);
            };
            let q = [0, 1, 2, 3].map(|i| lane(&layout, state, ORIENTATION + i, first));
            let spin = [0, 1, 2].map(|i| lane(&layout, state, SPIN + i, first));
            let mut turning = [[0.0; LANES]; 4];
            for l in 0..LANES {
                let q = [q[0][l], q[1][l], q[2][l], q[3][l]];
                let rate = quaternion_rate(q, [spin[0][l], spin[1][l], spin[2][l]]);
                for i in 0..4 {
                    turning[i][l] = rate[i];
                }
            }
            for (i, turning) in turning.iter().enumerate() {
                put(ORIENTATION + i, turning);
            }
            for i in 0..3 {
                put(POSITION + i, &lane(&layout, state, VELOCITY + i, first));
                let (mut force, mut moment) = ([0.0; LANES], [0.0; LANES]);
                for l in 0..count {
                    force[l] = self.ball_force[first + l][i];
                    moment[l] = self.ball_moment[first + l][i];
                }
                put(VELOCITY + i, &force.map(|force| force / bearing.ball.mass));
                put(SPIN + i, &moment.map(|moment| moment / bearing.ball.axial));
            }
        }
    }

    /// Normal and tangential contact forces on balls and races, in the order of the pairs.
    fn add_race_contacts(&mut self, state: &[f64], ledger: &mut [f64; LEDGER]) {
        if self.steps.damping {
            ledger[Ledger::ContactDamping as usize] += self.damping_power();
        }
        let has_traction = self.steps.traction;
        for &pair in &self.table.active {
            let (side, ball) = self.layout.race_and_ball(pair);
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
            // The race has the opposite force at the same point.
            let position = self.layout.ball_vector(state, POSITION, ball);
            let from_race = sub(position, self.races[side].motion.position);
            let race_arm = add(from_race, arm);
            let loads = &mut self.on_races[side];
            loads.force = sub(loads.force, force);
            loads.moment = sub(loads.moment, add(cross(race_arm, force), moment));
        }
        // The tangential force of a profile acts through the ball's centre.
        for profiled in &self.table.profiled {
            let (side, ball) = self.layout.race_and_ball(profiled.pair);
            self.ball_force[ball] = add(self.ball_force[ball], profiled.aside);
            let centre = self.layout.ball_vector(state, POSITION, ball);
            let race = self.races[side].motion.position;
            let loads = &mut self.on_races[side];
            loads.add_at(race, centre, scale(profiled.aside, -1.0));
            if profiled.couple != [0.0; 3] {
                self.ball_moment[ball] = add(self.ball_moment[ball], profiled.couple);
                loads.moment = sub(loads.moment, profiled.couple);
            }
        }
    }

    /// Power of contact damping, W, ≤ 0. A contact that opens faster than its damping allows carries no load, so that
    /// it is not active, but dissipates its stored energy.
    fn damping_power(&self) -> f64 {
        let mut power = 0.0;
        for (side, law) in self.laws.races.iter().enumerate() {
            for ball in 0..self.layout.balls {
                let pair = side * self.layout.padded + ball;
                let contact = &self.table.contact[pair];
                let elastic = match self.table.profiled(pair) {
                    Some(profiled) => profiled.elastic,
                    None => normal_load(law.stiffness, contact.overlap),
                };
                power -= (self.table.load[pair] - elastic) * contact.closing_speed;
            }
        }
        power
    }

    /// Contacts of each ball with the next one, if they can meet. Balls keep their order in the grooves, so that
    /// neighbours in number are neighbours in azimuth.
    fn add_ball_contacts(
        &mut self,
        bearing: &Bearing,
        state: &[f64],
        ledger: &mut [f64; LEDGER],
        work: &mut Work,
        ran: &mut Counts,
    ) {
        let Some(law) = bearing.ball_contact else { return };
        work.ball_tests += self.meetings.len() as u64;
        ran.add(Stage::BallContact, self.meetings.len() as u64);
        let radius = self.laws.ball_radius;
        let place = |ball: usize| self.layout.ball_vector(state, POSITION, ball);
        let mut there = place(0);
        for one in 0..self.meetings.len() {
            let other = if one + 1 == self.layout.balls { 0 } else { one + 1 };
            let here = there;
            there = place(other);
            if are_apart(radius, here, there) {
                // Nothing to clear.
                if self.meetings[one].overlap != 0.0 {
                    self.meetings[one] = BallContact::default();
                }
                continue;
            }
            let [moving, met] = [(one, here), (other, there)].map(|(ball, position)| Motion {
                position,
                velocity: self.layout.ball_vector(state, VELOCITY, ball),
                spin: self.layout.ball_vector(state, SPIN, ball),
            });
            let Some(contact) = ball_contact(&law, radius, &moving, &met) else { continue };
            self.meetings[one] = contact;
            self.ball_force[one] = sub(self.ball_force[one], contact.force);
            self.ball_force[other] = add(self.ball_force[other], contact.force);
            // Arm and force are both opposite: the moment is the same on either ball.
            let moment = cross(contact.arm, contact.force);
            self.ball_moment[one] = sub(self.ball_moment[one], moment);
            self.ball_moment[other] = sub(self.ball_moment[other], moment);
            ledger[Ledger::BallFriction as usize] += contact.power;
        }
    }

    /// Contacts of the cage with each ball.
    fn add_pocket_contacts(
        &mut self,
        bearing: &Bearing,
        state: &[f64],
        ledger: &mut [f64; LEDGER],
        work: &mut Work,
        ran: &mut Counts,
    ) {
        let (Some(caged), Some(now)) = (&bearing.cage, &self.cage) else { return };
        let law = &caged.contacts;
        let cage = &now.motion;
        let orientation = now.state.orientation;
        let [e2, e3]: [Vec3; 2] =
            [(orientation * Vector3::y()).into(), (orientation * Vector3::z()).into()];
        for ball in 0..self.layout.balls {
            let [cos, sin] = self.pocket_angles[ball];
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
            self.on_cage.add_at(cage.position, contact.point, scale(contact.force, -1.0));
            ledger[Ledger::CageFriction as usize] += contact.power;
        }
        work.pocket_tests += self.layout.balls as u64;
        ran.add(Stage::Pockets, self.layout.balls as u64);
    }

    /// Contacts of the cage's nodes with each ball and with the guiding race; adds modal forces of the cage.
    fn add_node_contacts(
        &mut self,
        (bearing, nodes): (&Bearing, &CageNodes),
        state: &[f64],
        (modes, forces): ([&[f64]; 2], &mut [f64]),
        ledger: &mut [f64; LEDGER],
        work: &mut Work,
        ran: &mut Counts,
    ) {
        let (Some(caged), Some(cage)) = (&bearing.cage, self.cage) else { return };
        let bound = nodes.bound(modes[0]);
        let now = CageNow { body: &cage, deformation: Deformation::Modes(modes), bound };
        self.cage_energy = 0.0;
        for ball in 0..self.layout.balls {
            let motion = AxisMotion {
                position: self.layout.ball_vector(state, POSITION, ball),
                velocity: self.layout.ball_vector(state, VELOCITY, ball),
                spin: self.layout.ball_vector(state, SPIN, ball),
                axis: [1.0, 0.0, 0.0],
            };
            let found = nodes.pocket(ball, &now, &motion, self.laws.ball_radius, forces);
            self.pockets[ball] = found.contact;
            self.ball_force[ball] = add(self.ball_force[ball], found.on_other.force);
            self.ball_moment[ball] = add(self.ball_moment[ball], found.on_other.moment);
            self.take_contact(&found, ledger);
            work.pocket_tests += found.tested;
        }
        ran.add(Stage::Pockets, self.layout.balls as u64);
        let Some(side) = guiding_side(caged.contacts.guidance) else { return };
        let race = &self.races[side].motion;
        let found = nodes.land(&now, race, forces, &mut self.guide_modes);
        for (end, found) in found.iter().enumerate() {
            self.guides[end] = found.contact;
            self.on_races[side].add(&found.on_other);
            self.take_contact(found, ledger);
            work.guide_tests += found.tested;
        }
        ran.add(Stage::Guide, 2);
    }

    fn take_contact(&mut self, found: &Touched, ledger: &mut [f64; LEDGER]) {
        self.on_cage.add(&found.on_cage);
        self.cage_energy += found.energy;
        ledger[Ledger::CageFriction as usize] += found.contact.power;
    }

    /// Contacts of both ends of the cage with its guiding race.
    fn add_guide_contacts(
        &mut self,
        bearing: &Bearing,
        ledger: &mut [f64; LEDGER],
        work: &mut Work,
        ran: &mut Counts,
    ) {
        let (Some(caged), Some(now)) = (&bearing.cage, &self.cage) else { return };
        let (law, cage) = (&caged.contacts, &now.motion);
        let Some(side) = guiding_side(law.guidance) else { return };
        let race = &self.races[side].motion;
        work.guide_tests += 2;
        ran.add(Stage::Guide, 2);
        for (contact, end) in self.guides.iter_mut().zip([-1.0, 1.0]) {
            *contact = guide_contact(law, cage, race, end);
            self.on_cage.add_at(cage.position, contact.point, scale(contact.force, -1.0));
            self.on_races[side].add_at(race.position, contact.point, contact.force);
            ledger[Ledger::CageFriction as usize] += contact.power;
        }
    }
}

fn cosine_and_sine(angle: f64) -> [f64; 2] {
    let (sine, cosine) = libm::sincos(angle);
    [cosine, sine]
}

/// Index of the guiding race of a cage; `None` for guidance by balls.
pub fn guiding_side(guidance: Guidance) -> Option<usize> {
    match guidance {
        Guidance::InnerRace => Some(0),
        Guidance::OuterRace => Some(1),
        Guidance::Balls => None,
    }
}

/// Loads at a mount on its body: the same force, and its moment about the body's centre.
pub fn onto_body(
    mount: &Mount,
    race: &BodyKinematics,
    body: &BodyKinematics,
    loads: &Wrench,
) -> Wrench {
    if mount.along == 0.0 {
        return *loads;
    }
    let arm = sub(race.motion.position, body.motion.position);
    Wrench { force: loads.force, moment: add(loads.moment, cross(arm, loads.force)) }
}

/// Number of pairs of neighbouring balls.
pub fn neighbours(balls: usize) -> usize {
    if balls < 3 { balls.saturating_sub(1) } else { balls }
}
