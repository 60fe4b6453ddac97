//! Largest values over all accepted steps, whatever rows are written, from contacts that are evaluated anyway.

use crate::kinematics::vec3::{dot, norm, sub};
use crate::motion::system::System;
use serde::{Deserialize, Serialize};

/// A largest value, the ball it belongs to, counted from 0, and its time, s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extreme {
    pub value: f64,
    pub ball: usize,
    pub time: f64,
}

impl Extreme {
    /// The first of equal values stays, so that recording a state twice changes nothing.
    fn take(&mut self, value: f64, ball: usize, time: f64) {
        if value > self.value {
            *self = Extreme { value, ball, time };
        }
    }
}

/// Contacts below this fraction of the largest load so far do not count for angles.
const RELEVANT_LOAD: f64 = 0.01;

/// Extremes of the contacts with one race.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RaceExtremes {
    /// Normal load, N.
    pub load: Extreme,
    /// Angle in the groove from its bottom to the farther end of the contact ellipse, rad.
    pub edge: Extreme,
    /// Contact angle there, rad, without sign.
    pub edge_angle: f64,
    /// Sine of the contact angle on the side opposite to a positive one.
    pub reversed: Extreme,
}

/// Extremes since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Extremes {
    /// Inner, outer.
    pub races: [RaceExtremes; 2],
    /// Displacement of the inner race's centre from the bearing's position, m.
    pub farthest: Extreme,
    /// Distance between the centres of inner and outer race, m.
    pub apart: Extreme,
    /// Load between neighbouring balls, N.
    pub between_balls: Extreme,
}

impl Extremes {
    /// Records the races and contacts of a bearing as last evaluated.
    pub fn record(&mut self, system: &System, index: usize, time: f64) {
        let (set, bearing) = (&system.sets[index], &system.assembly.bearings[index]);
        let layout = &set.layout;
        let [inner, outer] = [0, 1].map(|side: usize| &set.races[side].motion);
        let [x, y, z] = inner.position;
        self.farthest.take(norm([x - system.assembly.place_of(bearing), y, z]), 0, time);
        self.apart.take(norm(sub(inner.position, outer.position)), 0, time);
        for (ball, meeting) in set.meetings.iter().enumerate() {
            self.between_balls.take(meeting.normal_load, ball, time);
        }
        let axes = [inner.axis, outer.axis];
        let geometry = &bearing.geometry;
        let grooves = [geometry.inner.groove_radius, geometry.outer.groove_radius];
        let sine_of = |edge: f64| libm::sin(edge.min(std::f64::consts::FRAC_PI_2));
        let mut edge_sines = [0, 1].map(|side: usize| sine_of(self.races[side].edge.value));
        for &pair in &set.table.active {
            let (side, ball) = layout.race_and_ball(pair);
            let contact = &set.table.contact[pair];
            let race = &mut self.races[side];
            let load = set.table.load[pair];
            race.load.take(load, ball, time);
            if load < RELEVANT_LOAD * race.load.value {
                continue;
            }
            // A positive contact angle has the ball at +X of the outer groove's centre and at -X of
            // the inner one's.
            let sine = dot(contact.normal, axes[side]) * if side == 0 { -1.0 } else { 1.0 };
            race.reversed.take(-sine, ball, time);
            let law = &set.laws.races[side];
            let half = law.semi_major_factor * contact.overlap.max(0.0).sqrt() / grooves[side];
            // sin(α + ε) <= sin α + sin ε, and that is less than its series: most contacts need no arc sine.
            let square = half * half;
            let sine_of_half = half * (1.0 - square / 6.0 * (1.0 - square / 20.0));
            if sine.abs() + sine_of_half > edge_sines[side] {
                let angle = libm::asin(sine.abs().min(1.0));
                if angle + half > race.edge.value {
                    race.edge = Extreme { value: angle + half, ball, time };
                    race.edge_angle = angle;
                    edge_sines[side] = sine_of(race.edge.value);
                }
            }
        }
    }
}
