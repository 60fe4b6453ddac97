//! Channels of the energies and works of a multibody simulation.

use super::channels::Channels;
use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::members::bearing::{BallMeeting, Bearing};
use crate::members::state::Ledger;
use crate::motion::energy::Energy;

/// Terms of the energy balance that can differ from zero in this problem, J.
pub(super) fn energy_channels(assembly: &Assembly, channels: &mut Channels) {
    let any = |of: &dyn Fn(&Bearing) -> bool| assembly.bearings.iter().any(of);
    let cage = any(&|bearing| bearing.cage.is_some());
    let meet = any(&|bearing| bearing.ball_meeting() == BallMeeting::Tested);
    let traction = any(&|bearing| bearing.traction != TractionLaw::None);
    let damping = any(&|bearing| bearing.damping != ContactDamping::None);
    let mut driven = assembly.bodies.iter().filter_map(|body| body.driven());
    let on_foundation = driven
        .any(|body| body.foundation_stiffness != [0.0; 5] || body.foundation_damping != [0.0; 5]);
    // Springs and dashpots between bodies are included in the foundation terms.
    let on_foundation = on_foundation || !assembly.connections.is_empty();
    // The damping of solids is included in the foundation work.
    let solids = !assembly.solids.is_empty();
    let bends = !assembly.shafts.is_empty();
    let flexes = assembly.floating.iter().any(|solid| solid.count() > 0);

    let mut energy = |name: &str, present: bool, read: fn(&Energy) -> f64| {
        if present {
            channels.add(name, "J", move |now| read(&now.snapshot.energy));
        }
    };
    energy("energy_kinetic", true, |of| of.kinetic);
    energy("energy_contact", true, |of| of.contact);
    energy("energy_cage_contact", cage, |of| of.cage_contact);
    energy("energy_gravity", assembly.gravity != [0.0; 3], |of| of.gravity);
    energy("energy_foundation", on_foundation, |of| of.foundation);
    energy("energy_ball_contact", meet, |of| of.ball_contact);
    energy("energy_housing_strain", solids, |of| of.solid_strain);
    energy("energy_housing_kinetic", solids, |of| of.solid_kinetic);
    energy("energy_bending_strain", bends, |of| of.bending_strain);
    energy("energy_bending_kinetic", bends, |of| of.bending_kinetic);
    energy("energy_seat", solids, |of| of.seat);
    energy("energy_cage_strain", flexes, |of| of.cage_strain);

    let mut work = |name: &str, present: bool, entry: Ledger| {
        if present {
            channels.add(name, "J", move |now| now.snapshot.ledger[entry as usize]);
        }
    };
    work("work_traction", traction, Ledger::Traction);
    work("work_contact_damping", damping, Ledger::ContactDamping);
    work("work_cage_friction", cage, Ledger::CageFriction);
    let yields = on_foundation || solids || bends || flexes;
    work("work_foundation_damping", yields, Ledger::Foundation);
    work("work_ball_friction", meet, Ledger::BallFriction);
    work("work_drives", true, Ledger::Drives);
    channels.add("energy_residual", "J", |now| now.snapshot.residual);
}
