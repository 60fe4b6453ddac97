//! Length of the coupling step, and what cannot be coupled.

use crate::assembly::lists::Assembly;
use crate::members::body::Rotation;
use crate::motion::bonded_bushing::BondedBushing;
use crate::motion::coupling::{CouplingError, CouplingOptions};
use crate::motion::explicit_cage::stiffest;
use crate::motion::explicit_shaft::BRAKED;
use crate::motion::explicit_solid::SteppedSolid;
use crate::motion::race_in_bore::Seat;

/// Phase of a body on a shaft section in a coupling step, rad. Its motion relative to the section is fast and not of
/// interest.
const JOINT_PHASE: f64 = 0.5;
/// Phase of a ball in its pocket in a coupling step, rad: the energy of an impact is kept within a few 1e-4.
const POCKET_PHASE: f64 = 0.125;

/// Longest coupling step, s, within the phase limits of each body on its housing fits, bushings and shafts. Stiffnesses
/// over squared phases add up.
pub(crate) fn longest_coupling_step(
    assembly: &Assembly,
    seats: &[Seat],
    solids: &[SteppedSolid],
    bushings: &[BondedBushing],
    phase: f64,
) -> Result<f64, CouplingError> {
    let cages = || solids.iter().filter_map(|part| part.cage.as_ref());
    let joints = || solids.iter().filter_map(|part| part.shaft.as_ref()).flat_map(|s| &s.joints);
    if seats.is_empty()
        && bushings.is_empty()
        && joints().next().is_none()
        && cages().next().is_none()
    {
        return Err(CouplingError::NoSeat { seat: String::new() });
    }
    let mut most = 0.0f64;
    for cage in cages() {
        let bearing = &assembly.bearings[cage.part.bearing];
        let phase = phase / POCKET_PHASE;
        let radius = bearing.geometry.ball_radius;
        most = most.max(phase * phase * stiffest(&cage.part.nodes, radius, bearing.ball.mass));
    }
    for (index, body) in assembly.bodies.iter().enumerate() {
        let mut sums = [0.0; 2];
        let mut about_axis = 0.0;
        let mut braked = [0.0; 2];
        let [x, y, z, ..] = body.rest;
        for seat in seats.iter().filter(|seat| seat.mount.body == index) {
            let [shift, tilt, turn] = seat.stiffness([x, y, z]);
            if shift.is_nan() || shift <= 0.0 {
                return Err(CouplingError::NoSeat { seat: seat.suffix() });
            }
            about_axis += turn;
            sums = [sums[0] + shift, sums[1] + tilt];
        }
        let sleeves =
            |bushing: &&BondedBushing| bushing.sleeves.iter().any(|now| now.sleeve.body == index);
        for bushing in bushings.iter().filter(sleeves) {
            let ([shift, tilt], weight) = (bushing.stiffness, phase / bushing.coupling_phase);
            let weight = weight * weight;
            sums = [sums[0] + weight * shift, sums[1] + weight * tilt];
        }
        for now in joints().filter(|now| now.joint.body == index) {
            let ([shift, tilt], weight) = (now.joint.stiffness(), phase / JOINT_PHASE);
            let weight = weight * weight;
            sums = [sums[0] + weight * shift, sums[1] + weight * tilt];
            braked = [braked[0] + now.joint.damping()[0], braked[1] + now.joint.damping()[1]];
        }
        let Some(inertia) = body.inertia() else { continue };
        // Damping is treated as a spring that requires the same coupling step.
        for (rate, of) in braked.into_iter().zip([inertia.mass, inertia.transverse]) {
            let rate = phase * rate / (BRAKED * of);
            most = most.max(rate * rate);
        }
        most = most.max((sums[0] / inertia.mass).max(sums[1] / inertia.transverse));
        // Only friction turns a race in its bore back; a race with prescribed speed is not affected.
        if body.driven().is_none_or(|race| matches!(race.rotation, Rotation::Torque(_))) {
            most = most.max(about_axis / inertia.axial);
        }
    }
    let coupling_step = phase / most.sqrt();
    // A massless body, or NaN.
    if coupling_step > 0.0 {
        Ok(coupling_step)
    } else {
        Err(CouplingError::NoCouplingStep { coupling_step })
    }
}

/// Number of steps of each solid in a coupling step, and its length, s. The coupling step is a whole number of steps of
/// one solid, each at most its `step` (s), and at most `longest` (s). Of all candidates the one with the fewest element
/// evaluations per second is taken; of two equal ones the longer.
pub(crate) fn divided(elements: &[usize], step: &[f64], longest: f64) -> (f64, Vec<usize>) {
    let mut best: Option<(f64, f64, Vec<usize>)> = None;
    for whole in step {
        let coupling_step = ((longest / whole) as usize).max(1) as f64 * whole;
        let steps: Vec<usize> = step
            .iter()
            .map(|step| ((coupling_step / step * (1.0 - 1e-12)).ceil() as usize).max(1))
            .collect();
        let each = elements.iter().zip(&steps).map(|(elements, steps)| (elements * steps) as f64);
        let cost = each.sum::<f64>() / coupling_step;
        let better = |(least, length, _): &(f64, f64, Vec<usize>)| {
            cost < *least || (cost == *least && coupling_step > *length)
        };
        if best.as_ref().is_none_or(better) {
            best = Some((cost, coupling_step, steps));
        }
    }
    best.map_or((longest, Vec::new()), |(_, coupling_step, steps)| (coupling_step, steps))
}

/// # Errors
///
/// Options out of range; a race that is fixed or on a foundation.
pub(crate) fn check(
    assembly: &Assembly,
    seats: &[Seat],
    options: &CouplingOptions,
) -> Result<(), CouplingError> {
    let ranges = [
        ("the fraction of the solid's step limit", options.solid_fraction, 1.0),
        ("the phase of a housing fit in a coupling step", options.seat_phase, 1.9),
    ];
    for (name, value, most) in ranges {
        if !(value > 0.0 && value <= most) {
            return Err(CouplingError::Option { name, value, most });
        }
    }
    for seat in seats {
        let body = &assembly.bodies[seat.mount.body];
        let race = body.name.clone();
        let Some(driven) = body.driven() else { return Err(CouplingError::FixedRace { race }) };
        if driven.foundation_stiffness.iter().chain(&driven.foundation_damping).any(|k| *k != 0.0) {
            return Err(CouplingError::Foundation { race });
        }
    }
    Ok(())
}
