//! Columns of the energies and works of a multibody simulation.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::ch2_housing::bearing::traction::TractionLaw;
use crate::members::bearing::{BallMeeting, Bearing};
use crate::members::state::Ledger;
use crate::motion::simulation::Snapshot;

/// Terms of the energy balance that a problem can have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Term {
    Kinetic,
    Contact,
    CageContact,
    Gravity,
    Foundation,
    BallContact,
    SolidStrain,
    SolidKinetic,
    BendingStrain,
    BendingKinetic,
    Seat,
    CageStrain,
    Work(Ledger),
    Residual,
}

/// Terms that can differ from zero in this problem.
pub(super) fn terms(assembly: &Assembly) -> Vec<Term> {
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
    let terms = [
        (Term::Kinetic, true),
        (Term::Contact, true),
        (Term::CageContact, cage),
        (Term::Gravity, assembly.gravity != [0.0; 3]),
        (Term::Foundation, on_foundation),
        (Term::BallContact, meet),
        (Term::SolidStrain, solids),
        (Term::SolidKinetic, solids),
        (Term::BendingStrain, bends),
        (Term::BendingKinetic, bends),
        (Term::Seat, solids),
        (Term::CageStrain, flexes),
        (Term::Work(Ledger::Traction), traction),
        (Term::Work(Ledger::ContactDamping), damping),
        (Term::Work(Ledger::CageFriction), cage),
        (Term::Work(Ledger::Foundation), on_foundation || solids || bends || flexes),
        (Term::Work(Ledger::BallFriction), meet),
        (Term::Work(Ledger::Drives), true),
        (Term::Residual, true),
    ];
    terms.into_iter().filter(|(_, present)| *present).map(|(term, _)| term).collect()
}

pub(super) fn term_name(term: Term) -> &'static str {
    match term {
        Term::Kinetic => "energy_kinetic",
        Term::Contact => "energy_contact",
        Term::CageContact => "energy_cage_contact",
        Term::Gravity => "energy_gravity",
        Term::Foundation => "energy_foundation",
        Term::BallContact => "energy_ball_contact",
        Term::SolidStrain => "energy_housing_strain",
        Term::SolidKinetic => "energy_housing_kinetic",
        Term::BendingStrain => "energy_bending_strain",
        Term::BendingKinetic => "energy_bending_kinetic",
        Term::Seat => "energy_seat",
        Term::CageStrain => "energy_cage_strain",
        Term::Work(Ledger::Traction) => "work_traction",
        Term::Work(Ledger::ContactDamping) => "work_contact_damping",
        Term::Work(Ledger::CageFriction) => "work_cage_friction",
        Term::Work(Ledger::Foundation) => "work_foundation_damping",
        Term::Work(Ledger::BallFriction) => "work_ball_friction",
        Term::Work(Ledger::Drives) => "work_drives",
        Term::Residual => "energy_residual",
    }
}

pub(super) fn energy_term(term: Term, snapshot: &Snapshot) -> f64 {
    match term {
        Term::Kinetic => snapshot.energy.kinetic,
        Term::Contact => snapshot.energy.contact,
        Term::CageContact => snapshot.energy.cage_contact,
        Term::Gravity => snapshot.energy.gravity,
        Term::Foundation => snapshot.energy.foundation,
        Term::BallContact => snapshot.energy.ball_contact,
        Term::SolidStrain => snapshot.energy.solid_strain,
        Term::SolidKinetic => snapshot.energy.solid_kinetic,
        Term::BendingStrain => snapshot.energy.bending_strain,
        Term::BendingKinetic => snapshot.energy.bending_kinetic,
        Term::Seat => snapshot.energy.seat,
        Term::CageStrain => snapshot.energy.cage_strain,
        Term::Work(entry) => snapshot.ledger[entry as usize],
        Term::Residual => snapshot.residual,
    }
}
