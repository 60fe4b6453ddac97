//! What a problem needs, decided once before anything is computed: a scene pays only for what it
//! has, and can be asked why.

use super::statics::{Condition, StaticProblem};
use crate::ch2_housing::bearing::geometry::BearingKind;

/// One thing the solver could do, whether it does it, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Stage {
    pub name: &'static str,
    pub included: bool,
    pub reason: String,
}

fn stage(name: &'static str, included: bool, reason: impl Into<String>) -> Stage {
    Stage { name, included, reason: reason.into() }
}

/// Stages of a static solution.
pub fn statics(problem: &StaticProblem) -> Vec<Stage> {
    let balls = problem.geometry.ball_count;
    let unknowns = problem.conditions.iter().filter(|c| matches!(c, Condition::Load(_))).count();
    let gravity = problem.gravity.norm() > 0.0 && problem.ball_mass > 0.0;
    let centrifugal = problem.orbital_speed != 0.0 && problem.ball_mass > 0.0;
    let search = match unknowns {
        0 => stage("race equilibrium", false, "all five coordinates are given: one evaluation"),
        n => stage("race equilibrium", true, format!("{n} of 5 coordinates are free")),
    };
    let contact_angle = match problem.geometry.kind {
        BearingKind::DeepGroove => "contact angles follow from the position of both races",
        BearingKind::AngularContact => {
            "contact angles follow from the position of both races, starting at the nominal one"
        }
    };
    vec![
        stage(
            "distance test",
            true,
            format!("{balls} balls, two sightings each; a ball with room costs nothing more"),
        ),
        stage("ball equilibrium", true, contact_angle),
        search,
        if gravity {
            stage("gravity on balls", true, "gravity is given")
        } else {
            let reason = if centrifugal {
                "no gravity is given"
            } else {
                "no gravity: a ball with room is left out"
            };
            stage("gravity on balls", false, reason)
        },
        if centrifugal {
            stage("centrifugal force on balls", true, "asked for, with a speed of the inner race")
        } else {
            stage("centrifugal force on balls", false, "not asked for, or the bearing stands still")
        },
        stage("traction", false, "statics has no sliding: no slices, no spin moment"),
        stage("cage contact", false, "statics keeps each ball at its azimuth"),
        stage("outer race motion", false, "its position is given: no equations for it"),
        stage("flexible bodies", false, "the scene has none: no mesh, no element stage"),
    ]
}
