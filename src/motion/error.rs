//! Errors at the start or during a simulation.

use crate::equilibrium::statics::StaticsError;
use crate::members::dent_table::DentError;
use crate::numeric::clock::display_time;
use thiserror::Error;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum SimulationError {
    #[error(transparent)]
    Start(#[from] StaticsError),
    #[error(transparent)]
    Dent(#[from] DentError),
    #[error("the step is {0} s; it must be positive and finite")]
    Step(f64),
    #[error("the accuracy is {0}; it must be positive and finite")]
    Accuracy(f64),
    #[error(
        "Runge-Kutta of fourth order has no estimate of its error and takes no accuracy; give a step \
         (numerics.step, numerics.step_fraction) or another integrator (rosenbrock, dormand-prince)"
    )]
    NoErrorEstimate,
    #[error(
        "numerics.accuracy is relative to contact deformation, and the scene has no bearing. Hint: write numerics.step, or \
         leave numerics.integrator out; the step then follows from the stability limit"
    )]
    NothingToMeasure,
    #[error(
        "numerics.step_fraction, a fraction of the stability limit, is allowed for Runge-Kutta of fourth \
         order only; for {0} write numerics.accuracy or numerics.step"
    )]
    FractionOfOther(&'static str),
    #[error(
        "no step is short enough at t = {at} s, step {step}: even with a step of {size:.3e} s the error is \
         {error:.3e} times the allowed error",
        at = display_time(*time)
    )]
    StepVanished { time: f64, step: u64, size: f64, error: f64 },
    #[error(
        "no contact is stiff at the start, so no step follows from it; give a step \
         (numerics.step)"
    )]
    NoStep,
    #[error(
        "the step of {size:.3e} s is longer than the largest stable step, {limit:.3e} s, at t = {at} s, step \
         {step} ({reason}): oscillations would grow, or the direction of sliding would alternate from step to \
         step. Hint: write a shorter numerics.step, or leave it out; the program then chooses the step",
        at = display_time(*time)
    )]
    StepTooLong { size: f64, limit: f64, reason: String, time: f64, step: u64 },
    #[error(
        "{body} has a value that is not finite at t = {at} s, step {step}",
        at = display_time(*time)
    )]
    NotFinite { body: String, time: f64, step: u64 },
    #[error(
        "{ball} has left its races at t = {at} s, step {step}: it is {distance:.3e} m from \
         the pitch circle, farther than its radius of {ball_radius:.3e} m",
        at = display_time(*time)
    )]
    BallOutside { ball: String, time: f64, step: u64, distance: f64, ball_radius: f64 },
    #[error(
        "the inner race has left {bearing} at t = {at} s, step {step}: it is displaced by {distance:.3e} m \
         {way}, more than the {allowed:.3e} m of a ball's radius plus the total clearance; nothing holds it \
         against its loads or prescribed motion (balls gathered on one side, an axial load that opens the \
         bearing?)",
        at = display_time(*time)
    )]
    RaceLeft {
        bearing: String,
        way: &'static str,
        distance: f64,
        allowed: f64,
        time: f64,
        step: u64,
    },
    #[error(
        "{one} is {depth:.3e} m inside {other} at t = {at} s, step {step}, deeper than a tenth of a ball's \
         radius ({allowed:.3e} m), the limit of the contact law; {advice}",
        at = display_time(*time)
    )]
    Inside {
        one: String,
        other: String,
        depth: f64,
        allowed: f64,
        time: f64,
        step: u64,
        advice: String,
    },
    #[error(
        "{cage} does not fit at the start: it would penetrate {other} by {depth:.3e} m, more than the \
         {allowed:.3e} m of the contacts of the races. Hint: check the direction of the loads, \
         bearing.cage.pocket_radius and race_clearance, or start in nominal positions (numerics.start = \
         \"nominal\")"
    )]
    CageInTheWay { cage: String, other: String, depth: f64, allowed: f64 },
    #[error(
        "{body} has left its bearing at t = {at} s, step {step}: its centre is {distance:.3e} m off the axis \
         of the outer race, more than the {allowed:.3e} m available to its ring. Cylindrical pockets hold a \
         cage axially and circumferentially, not radially. Hint: guide it by a race (bearing.cage.guidance) \
         or use spherical pockets (bearing.cage.pocket)",
        at = display_time(*time)
    )]
    CageLeft { body: String, distance: f64, allowed: f64, time: f64, step: u64 },
    #[error(
        "{body} has flown off at t = {at} s, step {step}: it is {distance:.3e} m from where it stood along \
         {coordinate}, farther than {allowed:.3e} m; nothing holds it against the loads: hold the coordinate by \
         a displacement or a spring",
        at = display_time(*time)
    )]
    FlownOff {
        body: String,
        coordinate: &'static str,
        distance: f64,
        allowed: f64,
        time: f64,
        step: u64,
    },
    #[error(
         "{spring} is {how}, the limit of its law, at t = {at} s, step {step}. Hint: check whether the \
          connected bodies move too far (unstable whirl, wrong load or unit, a load that changes from the \
          start of the run), or whether the spring resists the rotation of the shaft (turn_x)",
        at = display_time(*time)
    )]
    SpringBeyond { spring: String, how: String, time: f64, step: u64 },
    #[error(
        "{spring} is pushed through the wall of its bushing at t = {at} s, step {step}: its sleeves are \
         displaced by {across:.3e} m across the axis, more than the wall of {wall:.3e} m; check loads and \
         their units, or use a thicker wall",
        at = display_time(*time)
    )]
    ThroughWall { spring: String, across: f64, wall: f64, time: f64, step: u64 },
    #[error(
         "{body} has left {seat} at t = {at} s, step {step}: it is displaced by {distance:.3e} m {way}; {allowed:.3e} m \
          are allowed",
        at = display_time(*time)
    )]
    LeftSeat {
        body: String,
        seat: String,
        way: &'static str,
        distance: f64,
        allowed: f64,
        time: f64,
        step: u64,
    },
    #[error(
        "{body} has tilted by {tilt:.3e} rad in {seat} at t = {at} s, step {step}, farther than the {allowed:.3e} rad up to \
         which a race lies in its seat: nothing there holds it; check the width of the seat, its clearance, and what \
         turns the race",
        at = display_time(*time)
    )]
    TiltedInSeat { body: String, seat: String, tilt: f64, allowed: f64, time: f64, step: u64 },
    #[error(
        "{body} bends too far for small bending at t = {at} s, step {step}: its section {along} m from its centre is turned by \
         {turn:.3e} rad against it, more than {allowed} rad; check loads, unbalance, speed and their units",
        at = display_time(*time)
    )]
    BentTooFar { body: String, along: f64, turn: f64, allowed: f64, time: f64, step: u64 },
    #[error(
         "the energy balance is violated: {residual:.3e} J of {turned_over:.3e} J are unaccounted for at \
         t = {at} s, step {step} (limit {limit}); take a smaller step or accuracy (numerics.step, \
         numerics.accuracy), or allow more (numerics.energy_limit)",
        at = display_time(*time)
    )]
    Energy { residual: f64, turned_over: f64, time: f64, step: u64, limit: f64 },
}
