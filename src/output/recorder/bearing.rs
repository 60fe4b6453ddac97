//! Channels of a bearing in a transient run.

use super::channels::{Channels, Now};
use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::cage::Guidance;
use crate::ch2_housing::bearing::slices::{Motion, Sliding, sliding};
use crate::kinematics::vec3::{dot, scale, sub};
use crate::members::ball_set::BallSet;
use crate::members::bearing::Bearing;
use crate::members::floating_solid::RadiusGauge;
use crate::members::mount::Mount;
use crate::members::state::{POSITION, SPIN, VELOCITY};
use crate::plan::channels::ChannelGroup;
use nalgebra::Vector3;

const RACES: [&str; 2] = ["inner", "outer"];

/// Adds the channels of a group of the bearing with this index.
pub(super) fn bearing_channels(
    assembly: &Assembly,
    index: usize,
    group: ChannelGroup,
    channels: &mut Channels,
) {
    let bearing = &assembly.bearings[index];
    let balls = 0..bearing.geometry.ball_count;
    let facings = bearing.mounts.map(|mount| facing(&mount));
    match group {
        ChannelGroup::Races => {
            let place = assembly.place_of(bearing);
            for side in 0..2 {
                if side == 0 || assembly.bodies[bearing.mounts[1].body].moves() {
                    channels.add_body(RACES[side], place, facings[side], move |now| {
                        &now.set(index).races[side]
                    });
                }
            }
        }
        ChannelGroup::Cage => cage_channels(assembly, index, facings[1], channels),
        ChannelGroup::Orbits => {
            for ball in balls {
                let names = ["angle", "orbital_speed"].map(|of| format!("ball_{}_{of}", ball + 1));
                channels.add_angle(
                    names.each_ref().map(String::as_str),
                    move |now| {
                        let [[_, y, z], _] = about_outer(now, index, ball);
                        libm::atan2(z, y)
                    },
                    move |now| {
                        let [[_, y, z], [_, v, w]] = about_outer(now, index, ball);
                        (y * w - z * v) / (y * y + z * z)
                    },
                );
            }
            let nominal = bearing.geometry.contact_angle;
            for (side, race) in RACES.into_iter().enumerate() {
                channels.add(&format!("mean_{race}_contact_angle"), "deg", move |now| {
                    contact_angle(now.set(index), side, nominal).to_degrees()
                });
            }
        }
        ChannelGroup::Loads => {
            for ball in balls {
                for (side, race) in RACES.into_iter().enumerate() {
                    let name = format!("ball_{}_{race}_load", ball + 1);
                    channels.add(&name, "N", move |now| {
                        let BallSet { layout, table, .. } = now.set(index);
                        table.load[side * layout.padded + ball]
                    });
                }
            }
        }
        ChannelGroup::CageRadius => {
            for (of, gauge) in gauges(assembly, bearing).iter().enumerate() {
                let name = format!("cage_radius_{:.0}", gauge.angle.to_degrees());
                channels.add(&name, "m", move |now| radius_change(now, index, of));
            }
        }
        ChannelGroup::Pockets if bearing.cage.is_some() => {
            for ball in balls {
                let name = format!("ball_{}_pocket_load", ball + 1);
                channels.add(&name, "N", move |now| now.set(index).pockets[ball].normal_load);
            }
        }
        ChannelGroup::Slip => {
            for ball in balls {
                for (side, race) in RACES.into_iter().enumerate() {
                    let here = move |now: &Now| slip(now, (index, ball, side), facings[1]);
                    let name = format!("ball_{}_{race}", ball + 1);
                    let of = |what: &str| format!("{name}_{what}");
                    channels.add(&of("slip_rolling"), "m/s", move |now| here(now).slip[0]);
                    channels.add(&of("slip_transverse"), "m/s", move |now| here(now).slip[1]);
                    channels.add(&of("spin"), "rad/s", move |now| here(now).relative_spin[2]);
                }
            }
        }
        ChannelGroup::Forces => {
            for (side, race) in RACES.into_iter().enumerate() {
                channels.add_vector(&format!("contact_force_on_{race}"), "N", move |now| {
                    now.set(index).on_races[side].force
                });
            }
        }
        ChannelGroup::Moments => {
            for (side, race) in RACES.into_iter().enumerate() {
                channels.add_vector(&format!("contact_moment_on_{race}"), "N m", move |now| {
                    now.set(index).on_races[side].moment
                });
            }
        }
        ChannelGroup::Pockets | ChannelGroup::Energy => {}
    }
}

fn cage_channels(assembly: &Assembly, index: usize, facing: f64, channels: &mut Channels) {
    let bearing = &assembly.bearings[index];
    let Some(caged) = &bearing.cage else { return };
    let body = caged.body;
    let of = move |now: &Now| now.set(index).cage.unwrap_or(now.simulation.system.bodies[body]);
    let axis = move |now: &Now| scale(of(now).motion.axis, facing);
    let place = assembly.place_of(bearing);
    channels.add_place("cage", place, move |now| of(now).motion.position, axis);
    channels.add_angle(
        ["cage_angle", "cage_speed"],
        move |now| {
            let own_y = of(now).state.orientation * Vector3::y() * facing;
            libm::atan2(own_y.z, own_y.y)
        },
        move |now| dot(of(now).motion.spin, axis(now)),
    );
    if caged.contacts.guidance != Guidance::Balls {
        channels.add("cage_guide_load", "N", move |now| {
            let guides = &now.set(index).guides;
            guides[0].normal_load + guides[1].normal_load
        });
    }
    let count = gauges(assembly, bearing).len();
    if count > 0 {
        let fold = move |now: &Now, from: f64, of: fn(f64, f64) -> f64| {
            (0..count).map(|gauge| radius_change(now, index, gauge)).fold(from, of)
        };
        channels.add("cage_radius_smallest", "m", move |now| fold(now, f64::INFINITY, f64::min));
        channels.add("cage_radius_largest", "m", move |now| fold(now, f64::NEG_INFINITY, f64::max));
    }
}

/// Position and velocity of a ball relative to the outer race.
fn about_outer(now: &Now, bearing: usize, ball: usize) -> [[f64; 3]; 2] {
    let set = now.set(bearing);
    let outer = &set.races[1].state;
    let vector = |component| set.layout.ball_vector(&now.simulation.state, component, ball);
    [sub(vector(POSITION), outer.position), sub(vector(VELOCITY), outer.velocity)]
}

/// Sliding of a ball on a race at the middle of their contact; zero without contact.
fn slip(now: &Now, (bearing, ball, side): (usize, usize, usize), facing: f64) -> Sliding {
    let BallSet { layout, table, laws, races, .. } = now.set(bearing);
    let pair = side * layout.padded + ball;
    if table.load[pair] <= 0.0 {
        return Sliding::default();
    }
    let vector = |component| layout.ball_vector(&now.simulation.state, component, ball);
    let (contact, race) = (&table.contact[pair], &races[side].motion);
    sliding(
        &Motion { position: vector(POSITION), velocity: vector(VELOCITY), spin: vector(SPIN) },
        &Motion { position: race.position, velocity: race.velocity, spin: race.spin },
        scale(race.axis, facing),
        contact.outward,
        contact.normal,
        laws.ball_radius - 0.5 * contact.overlap,
    )
}

/// Gauges of a bearing's flexible cage; none of another.
fn gauges<'s>(assembly: &'s Assembly, bearing: &Bearing) -> &'s [RadiusGauge] {
    let nodes = bearing.cage.as_ref().and_then(|cage| cage.nodes.as_ref());
    nodes.map_or(&[], |nodes| &assembly.floating[nodes.floating].gauges)
}

/// Change of the radius of a bearing's flexible cage at a gauge, m.
fn radius_change(now: &Now, bearing: usize, gauge: usize) -> f64 {
    let system = &now.simulation.system;
    let cage = system.assembly.bearings[bearing].cage.as_ref();
    let Some(nodes) = cage.and_then(|cage| cage.nodes.as_ref()) else { return 0.0 };
    let solid = &system.assembly.floating[nodes.floating];
    let [amplitudes, _] = solid.split(system.deformed(&now.simulation.state, nodes.floating));
    solid.gauges[gauge].shape.iter().zip(amplitudes).map(|(shape, of)| shape * of).sum()
}

/// 1, or −1 for a reversed bearing: half a turn about Z reverses its X and Y.
fn facing(mount: &Mount) -> f64 {
    if mount.reversed { -1.0 } else { 1.0 }
}

/// Mean contact angle on one race weighted by ball load, rad; the nominal one without contact.
/// Positive if the inner race is pushed towards the bearing's own +X.
fn contact_angle(set: &BallSet, side: usize, nominal: f64) -> f64 {
    let table = &set.table;
    let sign = if side == 0 { -1.0 } else { 1.0 };
    let (mut sum, mut load) = (0.0, 0.0);
    for &pair in table.active.iter().filter(|&&pair| set.layout.race_and_ball(pair).0 == side) {
        let sine = sign * dot(table.contact[pair].normal, set.races[side].motion.axis);
        sum += table.load[pair] * libm::asin(sine.clamp(-1.0, 1.0));
        load += table.load[pair];
    }
    if load > 0.0 { sum / load } else { nominal }
}
