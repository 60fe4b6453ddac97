//! Columns of bearings in a transient run.

mod energy;

use super::Recorder;
use super::seat::{SeatRow, prefix, seat_columns};
use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::cage::Guidance;
use crate::ch2_housing::bearing::slices::{Motion, Sliding, sliding};
use crate::kinematics::vec3::{dot, scale, sub};
use crate::members::ball_set::BallSet;
use crate::members::bearing::Bearing;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::floating_solid::RadiusGauge;
use crate::members::mount::Mount;
use crate::members::rigid_body::{BodyKinematics, Wrench, tilts_of};
use crate::members::sensor::Sensor;
use crate::members::state::{POSITION, SPIN, VELOCITY};
use crate::motion::plan::channel_group;
use crate::motion::simulation::{Simulation, Snapshot};
use crate::output::series::Column;
use crate::plan::Stage;
use crate::plan::channels::ChannelGroup;
use energy::{Term, energy_term, term_name, terms};
use nalgebra::Vector3;
use std::f64::consts::TAU;

/// Recorded channel groups and energy terms of the bearings.
pub(super) struct BearingColumns {
    groups: Vec<ChannelGroup>,
    terms: Vec<Term>,
}

impl BearingColumns {
    /// Adds the columns of the groups that the plan records.
    pub fn new(
        assembly: &Assembly,
        asked: &[ChannelGroup],
        columns: &mut Vec<Column>,
    ) -> BearingColumns {
        let groups: Vec<ChannelGroup> = ChannelGroup::ALL
            .into_iter()
            .filter(|group| channel_group(assembly, asked, *group).does)
            .collect();
        let terms = terms(assembly);
        for &group in &groups {
            add_columns(assembly, group, &terms, columns);
        }
        for seat in &assembly.seats {
            columns.extend(seat_columns(&prefix(&seat.label)));
        }
        let sensors = assembly.sensors.iter().map(Sensor::column);
        columns.extend(sensors.map(|(name, unit)| Column::new(name, unit)));
        BearingColumns { groups, terms }
    }
}

impl Recorder {
    /// Adds a row; `snapshot` must be the simulation's snapshot of the present time.
    pub fn record(&mut self, simulation: &Simulation, snapshot: &Snapshot) {
        let at = self.values.len();
        let before = at.checked_sub(self.columns.len());
        self.values.push(snapshot.time);
        let Some(BearingColumns { groups, terms }) = self.bearing.take() else { return };
        let system = &simulation.system;
        for &group in &groups {
            self.ran.add(Stage::recording(group), 1);
            if group == ChannelGroup::Energy {
                self.values.extend(terms.iter().map(|term| energy_term(*term, snapshot)));
                continue;
            }
            for (set, bearing) in system.sets.iter().zip(&system.assembly.bearings) {
                self.bearing(group, simulation, (set, bearing), before, at);
            }
            if group == ChannelGroup::Races {
                let bodies = system.assembly.bodies.iter().zip(&system.bodies);
                for (index, (body, now)) in bodies.enumerate() {
                    if body.label.is_some() {
                        self.race(now, system.assembly.origin_of(index), 1.0);
                    }
                }
                for (index, shaft) in system.assembly.shafts.iter().enumerate() {
                    for (_, section) in &shaft.probes {
                        let [_, y, z] =
                            system.section_now(&simulation.state, index, section).motion.position;
                        self.values.extend([y, z]);
                    }
                }
            }
            if group == ChannelGroup::Forces {
                for index in 0..system.connections.len() {
                    if system.assembly.connections[index].label.is_some() {
                        let Wrench { force, moment } =
                            system.connection_forces(&simulation.state, index).on[1];
                        self.values.extend(force.into_iter().chain(moment));
                    }
                }
            }
        }
        for seat in &system.seats {
            self.values.extend(SeatRow::of_contact(&seat.contact).values());
        }
        let sensors = &system.assembly.sensors;
        if !sensors.is_empty() {
            self.ran.add(Stage::Sensors, 1);
            let (state, rates) = (&simulation.state, simulation.rates());
            self.values.extend(sensors.iter().map(|of| of.read(system, state, rates)));
        }
        self.bearing = Some(BearingColumns { groups, terms });
    }

    /// Adds the values of one bearing for a group.
    fn bearing(
        &mut self,
        group: ChannelGroup,
        simulation: &Simulation,
        (set, bearing): (&BallSet, &Bearing),
        before: Option<usize>,
        row: usize,
    ) {
        let BallSet { layout, table, .. } = set;
        match group {
            ChannelGroup::Races => {
                let place = simulation.system.assembly.place_of(bearing);
                let [inner, outer] = bearing.mounts.map(|mount| facing(&mount));
                self.race(&set.races[0], place, inner);
                if simulation.system.assembly.bodies[bearing.mounts[1].body].moves() {
                    self.race(&set.races[1], place, outer);
                }
            }
            ChannelGroup::Cage => {
                let place = simulation.system.assembly.place_of(bearing);
                self.cage(set, bearing, place, before, row);
                if let Some(radii) = radii(simulation, bearing) {
                    let fold = |from: f64, of: fn(f64, f64) -> f64| radii.clone().fold(from, of);
                    let extremes =
                        [fold(f64::INFINITY, f64::min), fold(f64::NEG_INFINITY, f64::max)];
                    self.values.extend(extremes);
                }
            }
            ChannelGroup::CageRadius => {
                self.values.extend(radii(simulation, bearing).into_iter().flatten());
            }
            ChannelGroup::Orbits => self.orbits(simulation, set, bearing, before, row),
            ChannelGroup::Loads => {
                for ball in 0..layout.balls {
                    self.values.extend([table.load[ball], table.load[layout.padded + ball]]);
                }
            }
            ChannelGroup::Pockets if bearing.cage.is_some() => {
                self.values.extend(set.pockets.iter().map(|contact| contact.normal_load));
            }
            ChannelGroup::Slip => self.slip(simulation, set, facing(&bearing.mounts[1])),
            ChannelGroup::Forces => {
                for loads in &set.on_races {
                    self.values.extend(loads.force);
                }
            }
            ChannelGroup::Moments => {
                for loads in &set.on_races {
                    self.values.extend(loads.moment);
                }
            }
            ChannelGroup::Pockets | ChannelGroup::Energy => {}
        }
    }

    /// Adds the values of a race: x relative to `place` (m), the position of its bearing; `facing` from [`facing`].
    fn race(&mut self, now: &BodyKinematics, place: f64, facing: f64) {
        let [x, y, z] = now.state.position;
        let axis = scale(now.motion.axis, facing);
        self.values.extend([x - place, y, z]);
        self.values.extend(tilts_of(axis).map(f64::to_degrees));
        self.values.extend(now.state.velocity);
        self.values.push(dot(now.state.spin, axis));
    }

    fn cage(
        &mut self,
        set: &BallSet,
        bearing: &Bearing,
        place: f64,
        before: Option<usize>,
        row: usize,
    ) {
        let (Some(caged), Some(now)) = (&bearing.cage, &set.cage) else { return };
        let facing = facing(&bearing.mounts[1]);
        let own_y = now.state.orientation * Vector3::y() * facing;
        let axis = scale(now.motion.axis, facing);
        let speed = dot(now.motion.spin, axis);
        let [x, y, z] = now.motion.position;
        self.values.extend([x - place, y, z]);
        self.values.extend(tilts_of(axis).map(f64::to_degrees));
        self.push_unwrapped(libm::atan2(own_y.z, own_y.y), speed, before, row);
        self.values.push(speed);
        if caged.contacts.guidance != Guidance::Balls {
            self.values.push(set.guides[0].normal_load + set.guides[1].normal_load);
        }
    }

    fn orbits(
        &mut self,
        simulation: &Simulation,
        set: &BallSet,
        bearing: &Bearing,
        before: Option<usize>,
        row: usize,
    ) {
        let layout = set.layout;
        let outer = &set.races[1].state;
        for ball in 0..layout.balls {
            let vector = |component| layout.ball_vector(&simulation.state, component, ball);
            let [_, y, z] = sub(vector(POSITION), outer.position);
            let [_, v, w] = sub(vector(VELOCITY), outer.velocity);
            let speed = (y * w - z * v) / (y * y + z * z);
            self.push_unwrapped(libm::atan2(z, y), speed, before, row);
            self.values.push(speed);
        }
        for side in 0..2 {
            self.values.push(contact_angle(set, bearing, side).to_degrees());
        }
    }

    /// Adds an unwrapped angle in degrees: of the angles that differ by whole turns, the one closest to the prediction from the
    /// row before and the mean speed (the speed is in the next column).
    fn push_unwrapped(&mut self, wrapped: f64, speed: f64, before: Option<usize>, row: usize) {
        let column = self.values.len() - row;
        let angle = match before {
            None => wrapped,
            Some(before) => {
                let previous = &self.values[before..];
                let duration = self.values[row] - previous[0];
                let mean_speed = 0.5 * (previous[column + 1] + speed);
                let expected = previous[column].to_radians() + mean_speed * duration;
                wrapped + TAU * ((expected - wrapped) / TAU).round()
            }
        };
        self.values.push(angle.to_degrees());
    }

    fn slip(&mut self, simulation: &Simulation, set: &BallSet, facing: f64) {
        let BallSet { layout, table, laws, races, .. } = set;
        for ball in 0..layout.balls {
            for (side, race) in races.iter().enumerate() {
                let pair = side * layout.padded + ball;
                let mut here = Sliding::default();
                // Without contact there is no sliding.
                if table.load[pair] > 0.0 {
                    let vector = |component| layout.ball_vector(&simulation.state, component, ball);
                    let contact = &table.contact[pair];
                    here = sliding(
                        &Motion {
                            position: vector(POSITION),
                            velocity: vector(VELOCITY),
                            spin: vector(SPIN),
                        },
                        &Motion {
                            position: race.motion.position,
                            velocity: race.motion.velocity,
                            spin: race.motion.spin,
                        },
                        scale(race.motion.axis, facing),
                        contact.outward,
                        contact.normal,
                        laws.ball_radius - 0.5 * contact.overlap,
                    );
                }
                self.values.extend(here.slip);
                self.values.push(here.relative_spin[2]);
            }
        }
    }
}

/// Gauges of a bearing's flexible cage.
fn gauges<'s>(assembly: &'s Assembly, bearing: &Bearing) -> Option<&'s [RadiusGauge]> {
    let nodes = bearing.cage.as_ref()?.nodes.as_ref()?;
    let gauges = &assembly.floating[nodes.floating].gauges[..];
    (!gauges.is_empty()).then_some(gauges)
}

/// Changes of the radius of a bearing's flexible cage, m.
fn radii<'s>(
    simulation: &'s Simulation,
    bearing: &Bearing,
) -> Option<impl Iterator<Item = f64> + Clone + use<'s>> {
    let system = &simulation.system;
    let gauges = gauges(&system.assembly, bearing)?;
    let solid = bearing.cage.as_ref()?.nodes.as_ref()?.floating;
    let [gone, _] =
        system.assembly.floating[solid].split(system.deformed(&simulation.state, solid));
    Some(gauges.iter().map(move |gauge| gauge.shape.iter().zip(gone).map(|(s, q)| s * q).sum()))
}

/// 1, or −1 for a reversed bearing: half a turn about Z reverses its X and Y.
fn facing(mount: &Mount) -> f64 {
    if mount.reversed { -1.0 } else { 1.0 }
}

/// Mean contact angle on one race weighted by ball load, rad; the nominal one without contact.
/// Positive if the inner race is pushed towards the bearing's own +X.
fn contact_angle(set: &BallSet, bearing: &Bearing, side: usize) -> f64 {
    let table = &set.table;
    let sign = if side == 0 { -1.0 } else { 1.0 };
    let (mut sum, mut load) = (0.0, 0.0);
    for &pair in table.active.iter().filter(|&&pair| set.layout.race_and_ball(pair).0 == side) {
        let sine = sign * dot(table.contact[pair].normal, set.races[side].motion.axis);
        sum += table.load[pair] * libm::asin(sine.clamp(-1.0, 1.0));
        load += table.load[pair];
    }
    if load > 0.0 { sum / load } else { bearing.geometry.contact_angle }
}

const RACE_COLUMNS: [(&str, &str); 9] = [
    ("x", "m"),
    ("y", "m"),
    ("z", "m"),
    ("tilt_y", "deg"),
    ("tilt_z", "deg"),
    ("velocity_x", "m/s"),
    ("velocity_y", "m/s"),
    ("velocity_z", "m/s"),
    ("speed", "rad/s"),
];

fn add_columns(
    assembly: &Assembly,
    group: ChannelGroup,
    terms: &[Term],
    columns: &mut Vec<Column>,
) {
    if group == ChannelGroup::Energy {
        columns.extend(terms.iter().map(|term| Column::new(term_name(*term), "J")));
        return;
    }
    for bearing in &assembly.bearings {
        bearing_columns(assembly, bearing, group, columns);
    }
    if group == ChannelGroup::Races {
        for label in assembly.bodies.iter().filter_map(|body| body.label.as_ref()) {
            let own = RACE_COLUMNS.map(|(name, unit)| Column::new(format!("{label}_{name}"), unit));
            columns.extend(own);
        }
        columns.extend(probe_columns(assembly));
    }
    if group == ChannelGroup::Forces {
        let labels = assembly.connections.iter().filter_map(|joint| joint.label.as_ref());
        columns.extend(labels.flat_map(|label| connection_columns(label)));
    }
}

/// Columns of the probes of flexible shafts.
pub(super) fn probe_columns(assembly: &Assembly) -> Vec<Column> {
    let of_shaft = |shaft: &ElasticShaft| {
        let label = assembly.bodies[shaft.body].label.as_deref().unwrap_or("shaft");
        let of = |name: &str, axis| Column::new(format!("{label}_{name}_{axis}"), "m");
        let names = shaft.probes.iter();
        names.flat_map(|(name, _)| [of(name, "y"), of(name, "z")]).collect::<Vec<_>>()
    };
    assembly.shafts.iter().flat_map(of_shaft).collect()
}

/// Columns of the load on the second body of the connection with this label.
pub(super) fn connection_columns(label: &str) -> impl Iterator<Item = Column> {
    let of = |what: &str, axis| format!("{label}_{what}_{axis}");
    let forces = AXES.map(|axis| Column::new(of("force", axis), "N"));
    forces.into_iter().chain(AXES.map(|axis| Column::new(of("moment", axis), "N m")))
}

const AXES: [&str; 3] = ["x", "y", "z"];

fn bearing_columns(
    assembly: &Assembly,
    bearing: &Bearing,
    group: ChannelGroup,
    columns: &mut Vec<Column>,
) {
    let prefix = bearing.prefix();
    let mut add = |name: String, unit: &str| {
        columns.push(Column::new(format!("{prefix}{name}"), unit));
    };
    let balls = 1..=bearing.geometry.ball_count;
    match group {
        ChannelGroup::Races => {
            let moves = assembly.bodies[bearing.mounts[1].body].moves();
            for race in ["inner"].into_iter().chain(moves.then_some("outer")) {
                for (name, unit) in RACE_COLUMNS {
                    add(format!("{race}_{name}"), unit);
                }
            }
        }
        ChannelGroup::Cage => {
            let Some(cage) = &bearing.cage else { return };
            for (name, unit) in [
                ("x", "m"),
                ("y", "m"),
                ("z", "m"),
                ("tilt_y", "deg"),
                ("tilt_z", "deg"),
                ("angle", "deg"),
                ("speed", "rad/s"),
            ] {
                add(format!("cage_{name}"), unit);
            }
            if cage.contacts.guidance != Guidance::Balls {
                add("cage_guide_load".into(), "N");
            }
            if gauges(assembly, bearing).is_some() {
                add("cage_radius_smallest".into(), "m");
                add("cage_radius_largest".into(), "m");
            }
        }
        ChannelGroup::Orbits => {
            for ball in balls {
                add(format!("ball_{ball}_angle"), "deg");
                add(format!("ball_{ball}_orbital_speed"), "rad/s");
            }
            for race in ["inner", "outer"] {
                add(format!("mean_{race}_contact_angle"), "deg");
            }
        }
        ChannelGroup::Loads => balls.for_each(|ball| {
            add(format!("ball_{ball}_inner_load"), "N");
            add(format!("ball_{ball}_outer_load"), "N");
        }),
        ChannelGroup::CageRadius => {
            for gauge in gauges(assembly, bearing).unwrap_or_default() {
                add(format!("cage_radius_{:.0}", gauge.angle.to_degrees()), "m");
            }
        }
        ChannelGroup::Pockets if bearing.cage.is_some() => {
            balls.for_each(|ball| add(format!("ball_{ball}_pocket_load"), "N"));
        }
        ChannelGroup::Slip => balls.for_each(|ball| {
            for race in ["inner", "outer"] {
                add(format!("ball_{ball}_{race}_slip_rolling"), "m/s");
                add(format!("ball_{ball}_{race}_slip_transverse"), "m/s");
                add(format!("ball_{ball}_{race}_spin"), "rad/s");
            }
        }),
        ChannelGroup::Forces => {
            for race in ["inner", "outer"] {
                for axis in AXES {
                    add(format!("contact_force_on_{race}_{axis}"), "N");
                }
            }
        }
        ChannelGroup::Moments => {
            for race in ["inner", "outer"] {
                for axis in AXES {
                    add(format!("contact_moment_on_{race}_{axis}"), "N m");
                }
            }
        }
        ChannelGroup::Pockets | ChannelGroup::Energy => {}
    }
}
