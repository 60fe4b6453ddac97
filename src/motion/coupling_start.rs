//! Start of a coupled motion: equilibrium of bodies, solids and bushings, and the length of the coupling step.

use crate::assembly::lists::Assembly;
use crate::assembly::places::Places;
use crate::equilibrium::statics::StaticsError;
use crate::members::body::Body;
use crate::members::flexible_shaft::ElasticShaft;
use crate::members::rigid_body;
use crate::members::state::{BODY, BodyState};
use crate::motion::bonded_bushing::{BondedBushing, BondedPart};
use crate::motion::coupling::{CoupledMotion, CouplingError, CouplingOptions, SolidPart};
use crate::motion::coupling_step::{check, divided, longest_coupling_step};
use crate::motion::explicit_cage::SteppedCage;
use crate::motion::explicit_shaft::SteppedShaft;
use crate::motion::explicit_solid::{SteppedSolid, seated};
use crate::motion::race_in_bore::Seat;
use crate::motion::simulation::Simulation;
use crate::motion::start;
use crate::plan::Stage;
use crate::solids::contact::closed_limit;
use crate::solids::explicit::{ExplicitMethod, ExplicitSolid, padded};
use crate::solids::step_limit::step_limit;

impl<'p> CoupledMotion<'p> {
    /// Starts in equilibrium. Bodies in solids start at their prescribed position, all others in equilibrium with them,
    /// bearings roll, and solids are at rest with the given displacement.
    ///
    /// # Errors
    ///
    /// No equilibrium; a race that is fixed or on a foundation; options out of range.
    ///
    /// # Panics
    ///
    /// If a housing fit names a body or solid that does not exist.
    pub fn new(
        assembly: impl Into<Assembly>,
        solids: Vec<SolidPart>,
        seats: Vec<Seat>,
        options: &CouplingOptions,
    ) -> Result<CoupledMotion<'p>, CouplingError> {
        CoupledMotion::with_bushings(assembly, solids, seats, Vec::new(), options)
    }

    /// As [`CoupledMotion::new`], with bushings between bodies. The equilibrium is that of springs with the relaxed
    /// stiffness of the rubber elements.
    ///
    /// # Errors
    ///
    /// Those of [`CoupledMotion::new`]; rubber without an equilibrium.
    ///
    /// # Panics
    ///
    /// If a housing fit or bushing names a body or solid that does not exist.
    pub fn with_bushings(
        assembly: impl Into<Assembly>,
        solids: Vec<SolidPart>,
        seats: Vec<Seat>,
        bushings: Vec<BondedPart<'p>>,
        options: &CouplingOptions,
    ) -> Result<CoupledMotion<'p>, CouplingError> {
        let assembly = assembly.into();
        check(&assembly, &seats, options)?;
        let method = ExplicitMethod::CentralDifferences;
        let mut solids: Vec<SteppedSolid> = solids
            .into_iter()
            .map(|SolidPart { name, model, displacement, shaft, cage }| {
                let displacement = padded(displacement);
                let limit = step_limit(&model, &displacement, method);
                let mut solid = ExplicitSolid::at_rest(model, method, limit.step, limit);
                solid.displacement = displacement;
                let shaft =
                    shaft.map(|of| Box::new(SteppedShaft::new(of, &solid.model, &assembly)));
                let cage = cage.map(|of| Box::new(SteppedCage::new(of, &solid.model, &assembly)));
                SteppedSolid { name, solid, steps: 1, seats: Vec::new(), shaft, cage }
            })
            .collect();
        let seats = seated(&assembly, &mut solids, seats);
        let mut bushings = bushings;
        let joined = solids.iter().filter_map(|part| part.shaft.as_ref()).flat_map(|s| &s.joints);
        let held: Vec<usize> = seats
            .iter()
            .map(|seat| seat.mount.body)
            .chain(joined.map(|now| now.joint.body))
            .collect();
        let state = fixed_start(&assembly, &held, &bushings)?;
        let mut simulation = Simulation::from_state(assembly, options.bearing, state, 0.0)?;
        if bushings.iter().any(|part| part.is_moved(&simulation)) {
            for part in &mut bushings {
                let measured = part.measure();
                let named = |source| CouplingError::Bushing { name: part.name.clone(), source };
                measured.map_err(named)?;
            }
            let assembly = simulation.system.assembly;
            let state = fixed_start(&assembly, &held, &bushings)?;
            simulation = Simulation::from_state(assembly, options.bearing, state, 0.0)?;
        }
        let mut on_rubber = Vec::with_capacity(bushings.len());
        for part in bushings {
            let name = part.name.clone();
            let bushing = BondedBushing::new(part, &simulation);
            on_rubber.push(bushing.map_err(|source| CouplingError::Bushing { name, source })?);
        }
        let assembly = &simulation.system.assembly;
        let longest =
            longest_coupling_step(assembly, &seats, &solids, &on_rubber, options.seat_phase)?;
        let steps: Vec<f64> = solids
            .iter()
            .map(|SteppedSolid { solid, seats, shaft, cage, .. }| {
                // With all nodes of all housing fits in contact.
                let closed = seats.iter().fold(solid.limit, |limit, seat| {
                    closed_limit(&solid.model, &seat.seat.nodes, seat.seat.penalty, &limit)
                });
                let closed = cage.as_ref().map_or(closed, |cage| closed.with(cage.added(solid)));
                let closed = shaft.as_ref().map_or(closed, |shaft| closed.with(shaft.added(solid)));
                let longest =
                    shaft.as_ref().map_or(longest, |shaft| longest.min(shaft.braked(solid)));
                (options.solid_fraction * closed.step).min(longest)
            })
            .collect();
        let elements: Vec<usize> =
            solids.iter().map(|part| part.solid.model.problem.elements.len()).collect();
        // The steps of the bodies divide the coupling step or are divided by it.
        let (coupling_step, steps) = divided(&elements, &steps, longest);
        for (part, steps) in solids.iter_mut().zip(steps) {
            part.steps = steps;
        }
        let mut exchange = CoupledMotion::of(simulation, solids, on_rubber, coupling_step);
        exchange.simulation.system.ran.whole.add(Stage::StartEquilibrium, 1);
        exchange.begin()?;
        Ok(exchange)
    }
}

/// Returns whether one housing fit is the only external load on the bodies.
pub(crate) fn is_alone(
    assembly: &Assembly,
    solids: &[SteppedSolid],
    bushings: &[BondedBushing],
) -> bool {
    let mut brakes =
        assembly.bodies.iter().filter_map(Body::driven).flat_map(|b| b.foundation_damping);
    let seats: usize = solids.iter().map(|part| part.seats.len()).sum();
    seats == 1
        && solids.iter().all(|part| part.shaft.is_none() && part.cage.is_none())
        && bushings.is_empty()
        && assembly.connections.is_empty()
        && brakes.all(|damping| damping == 0.0)
}

/// Equilibrium with bodies in and on solids fixed at their start, and bushings replaced by springs.
fn fixed_start(
    assembly: &Assembly,
    in_solids: &[usize],
    bushings: &[BondedPart],
) -> Result<Vec<f64>, StaticsError> {
    let mut held = assembly.clone();
    held.connections.extend(bushings.iter().map(|part| part.spring.clone()));
    for body in in_solids {
        held.bodies[*body].fix();
    }
    let mut state = start::at_equilibrium(&held)?;
    // The ledger entries of the springs follow those of the other connections and precede flexible shafts and floating solids.
    let [own, with_springs] = [assembly, &held].map(|of| Places::of(of).ledger());
    let bent: usize = assembly.shafts.iter().map(ElasticShaft::entries).sum();
    let bent = bent + assembly.floating.iter().map(|solid| 2 * solid.count()).sum::<usize>();
    state.drain(own - bent..with_springs - bent);
    for &body in in_solids {
        if held.bodies[body].driven().is_some() {
            // The body rotates, and its balls roll.
            continue;
        }
        let still: BodyState = rigid_body::fixed(&assembly.bodies[body].rest).state;
        let at = Places::of(&held).body(body);
        state[at..at + BODY].copy_from_slice(&still.to_array());
    }
    Ok(state)
}
