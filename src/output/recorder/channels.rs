//! Channels of bearings and bodies in a run: each has its name, its unit and the way its value is read in one place.

use super::Recorder;
use super::bearing::bearing_channels;
use super::energy::energy_channels;
use super::seat::{SeatRow, prefix, seat_columns};
use crate::assembly::lists::Assembly;
use crate::kinematics::vec3::{Vec3, dot, scale};
use crate::members::ball_set::BallSet;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::rigid_body::{BodyKinematics, tilts_of};
use crate::members::sensor::Sensor;
use crate::motion::plan::channel_group;
use crate::motion::simulation::{Simulation, Snapshot};
use crate::output::series::Column;
use crate::plan::Stage;
use crate::plan::channels::ChannelGroup;
use std::f64::consts::TAU;

pub(super) const AXES: [&str; 3] = ["x", "y", "z"];

/// A simulation and its snapshot of the present time.
pub(super) struct Now<'s> {
    pub simulation: &'s Simulation,
    pub snapshot: &'s Snapshot,
}

impl Now<'_> {
    pub fn set(&self, bearing: usize) -> &BallSet {
        &self.simulation.system.sets[bearing]
    }
}

/// Allocates nothing.
type Read = Box<dyn Fn(&Now) -> f64>;

struct Channel {
    column: Column,
    read: Read,
    /// True for an angle (rad) that is recorded in degrees without jumps of whole turns; the next channel is its rate.
    unwraps: bool,
}

/// Channels of a group.
#[derive(Default)]
pub(super) struct Channels {
    /// Of the names that follow.
    pub prefix: String,
    all: Vec<Channel>,
}

impl Channels {
    pub fn add(&mut self, name: &str, unit: &str, read: impl Fn(&Now) -> f64 + 'static) {
        let column = Column::new(format!("{}{name}", self.prefix), unit);
        self.all.push(Channel { column, read: Box::new(read), unwraps: false });
    }

    /// Components along the axes of the scene.
    pub fn add_vector(
        &mut self,
        name: &str,
        unit: &str,
        read: impl Fn(&Now) -> Vec3 + Copy + 'static,
    ) {
        for (i, axis) in AXES.into_iter().enumerate() {
            self.add(&format!("{name}_{axis}"), unit, move |now| read(now)[i]);
        }
    }

    /// An angle (rad) and its rate (rad/s).
    pub fn add_angle(
        &mut self,
        [angle, rate]: [&str; 2],
        read_angle: impl Fn(&Now) -> f64 + 'static,
        read_rate: impl Fn(&Now) -> f64 + 'static,
    ) {
        self.add(angle, "deg", read_angle);
        self.all.last_mut().expect("the channel just added").unwraps = true;
        self.add(rate, "rad/s", read_rate);
    }

    /// Motion of a race or body: x relative to `place` (m); −1 as `facing` turns its axis round.
    pub fn add_body(
        &mut self,
        name: &str,
        place: f64,
        facing: f64,
        of: impl for<'n> Fn(&'n Now<'_>) -> &'n BodyKinematics + Copy + 'static,
    ) {
        let axis = move |now: &Now| scale(of(now).motion.axis, facing);
        self.add_place(name, place, move |now| of(now).state.position, axis);
        self.add_vector(&format!("{name}_velocity"), "m/s", move |now| of(now).state.velocity);
        let speed = move |now: &Now| dot(of(now).state.spin, axis(now));
        self.add(&format!("{name}_speed"), "rad/s", speed);
    }

    /// Position with x relative to `place` (m), and tilts of an axis.
    pub fn add_place(
        &mut self,
        name: &str,
        place: f64,
        position: impl Fn(&Now) -> Vec3 + Copy + 'static,
        axis: impl Fn(&Now) -> Vec3 + Copy + 'static,
    ) {
        self.add_vector(name, "m", move |now| {
            let [x, y, z] = position(now);
            [x - place, y, z]
        });
        for (i, tilt) in ["tilt_y", "tilt_z"].into_iter().enumerate() {
            let read = move |now: &Now| tilts_of(axis(now))[i].to_degrees();
            self.add(&format!("{name}_{tilt}"), "deg", read);
        }
    }
}

/// Recorded channels of bearings and bodies, by group.
pub(super) struct BearingColumns {
    groups: Vec<(ChannelGroup, Channels)>,
}

impl BearingColumns {
    /// Adds the columns of the groups that the plan records, of housing fits and of sensors.
    pub fn new(
        assembly: &Assembly,
        asked: &[ChannelGroup],
        columns: &mut Vec<Column>,
    ) -> BearingColumns {
        let recorded = ChannelGroup::ALL.into_iter();
        let recorded = recorded.filter(|group| channel_group(assembly, asked, *group).does);
        let groups: Vec<_> = recorded.map(|group| (group, channels(assembly, group))).collect();
        let all = groups.iter().flat_map(|(_, channels)| &channels.all);
        columns.extend(all.map(|channel| channel.column.clone()));
        for seat in &assembly.seats {
            columns.extend(seat_columns(&prefix(&seat.label)));
        }
        let sensors = assembly.sensors.iter().map(Sensor::column);
        columns.extend(sensors.map(|(name, unit)| Column::new(name, unit)));
        BearingColumns { groups }
    }
}

fn channels(assembly: &Assembly, group: ChannelGroup) -> Channels {
    let mut channels = Channels::default();
    if group == ChannelGroup::Energy {
        energy_channels(assembly, &mut channels);
        return channels;
    }
    for (index, bearing) in assembly.bearings.iter().enumerate() {
        channels.prefix = bearing.prefix();
        bearing_channels(assembly, index, group, &mut channels);
    }
    channels.prefix.clear();
    match group {
        ChannelGroup::Races => {
            for (index, body) in assembly.bodies.iter().enumerate() {
                let Some(label) = &body.label else { continue };
                let place = assembly.origin_of(index);
                channels
                    .add_body(label, place, 1.0, move |now| &now.simulation.system.bodies[index]);
            }
            for (index, shaft) in assembly.shafts.iter().enumerate() {
                for (probe, name) in probe_names(assembly, shaft).enumerate() {
                    for (i, axis) in [(1, "y"), (2, "z")] {
                        channels.add(&format!("{name}_{axis}"), "m", move |now| {
                            let Simulation { system, state, .. } = now.simulation;
                            let (_, section) = &system.assembly.shafts[index].probes[probe];
                            system.section_now(state, index, section).motion.position[i]
                        });
                    }
                }
            }
        }
        ChannelGroup::Forces => {
            for (index, connection) in assembly.connections.iter().enumerate() {
                let Some(label) = &connection.label else { continue };
                let on_second = move |now: &Now| {
                    let Simulation { system, state, .. } = now.simulation;
                    system.connection_forces(state, index).on[1]
                };
                channels
                    .add_vector(&format!("{label}_force"), "N", move |now| on_second(now).force);
                channels.add_vector(&format!("{label}_moment"), "N m", move |now| {
                    on_second(now).moment
                });
            }
        }
        _ => {}
    }
    channels
}

fn probe_names(assembly: &Assembly, shaft: &ElasticShaft) -> impl Iterator<Item = String> {
    let label = assembly.bodies[shaft.body].label.as_deref().unwrap_or("shaft");
    shaft.probes.iter().map(move |(name, _)| format!("{label}_{name}"))
}

/// Columns of the probes of flexible shafts.
pub(super) fn probe_columns(assembly: &Assembly) -> Vec<Column> {
    let names = assembly.shafts.iter().flat_map(|shaft| probe_names(assembly, shaft));
    names
        .flat_map(|name| ["y", "z"].map(|axis| Column::new(format!("{name}_{axis}"), "m")))
        .collect()
}

/// Columns of the load on the second body of a bushing in elements, as of a connection.
pub(super) fn connection_columns(label: &str) -> impl Iterator<Item = Column> {
    let of = |what: &str, axis| format!("{label}_{what}_{axis}");
    let forces = AXES.map(|axis| Column::new(of("force", axis), "N"));
    forces.into_iter().chain(AXES.map(|axis| Column::new(of("moment", axis), "N m")))
}

impl Recorder {
    /// Adds a row; `snapshot` must be the simulation's snapshot of the present time.
    pub fn record(&mut self, simulation: &Simulation, snapshot: &Snapshot) {
        let row = self.values.len();
        let before = row.checked_sub(self.columns.len());
        self.values.push(snapshot.time);
        let Some(BearingColumns { groups }) = &self.bearing else { return };
        let (values, now) = (&mut self.values, Now { simulation, snapshot });
        for (group, Channels { all, .. }) in groups {
            self.ran.add(Stage::recording(*group), 1);
            for (index, channel) in all.iter().enumerate() {
                let read = (channel.read)(&now);
                values.push(match channel.unwraps {
                    true => unwrapped(read, (all[index + 1].read)(&now), values, before, row),
                    false => read,
                });
            }
        }
        let system = &simulation.system;
        for seat in &system.seats {
            values.extend(SeatRow::of_contact(&seat.contact).values());
        }
        let sensors = &system.assembly.sensors;
        if !sensors.is_empty() {
            self.ran.add(Stage::Sensors, 1);
            let (state, rates) = (&simulation.state, simulation.rates());
            values.extend(sensors.iter().map(|of| of.read(system, state, rates)));
        }
    }
}

/// Unwrapped angle in degrees, the next of `values`: of the angles that differ by whole turns, the one closest to the
/// prediction from the row before and the mean rate (the rate is in the next column).
fn unwrapped(wrapped: f64, rate: f64, values: &[f64], before: Option<usize>, row: usize) -> f64 {
    let angle = match before {
        None => wrapped,
        Some(before) => {
            let (previous, column) = (&values[before..], values.len() - row);
            let duration = values[row] - previous[0];
            let mean_rate = 0.5 * (previous[column + 1] + rate);
            let expected = previous[column].to_radians() + mean_rate * duration;
            wrapped + TAU * ((expected - wrapped) / TAU).round()
        }
    };
    angle.to_degrees()
}
