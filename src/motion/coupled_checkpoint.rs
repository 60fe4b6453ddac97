//! Checkpoint of a coupled motion, from which it continues with the same bits.

use crate::assembly::lists::Assembly;
use crate::kinematics::vec3::Vec3;
use crate::members::rigid_body::Wrench;
use crate::motion::bonded_bushing::{BondedBushing, BondedPart, BondedRubber, SleeveNow};
use crate::motion::bore_friction::NodeSpring;
use crate::motion::checkpoint::Checkpoint;
use crate::motion::coupling::{CoupledMotion, CouplingError, CouplingOptions, SolidPart};
use crate::motion::explicit_cage::SteppedCage;
use crate::motion::explicit_shaft::SteppedShaft;
use crate::motion::explicit_solid::{SteppedSolid, seated};
use crate::motion::race_in_bore::{Growth, Seat};
use crate::motion::simulation::Simulation;
use crate::solids::checkpoint::SolidCheckpoint;
use crate::solids::error::SolidError;
use crate::solids::explicit::{ExplicitMethod, ExplicitSolid};
use crate::solids::rubber::checkpoint::RubberCheckpoint;
use crate::solids::step_limit::SolidStepLimit;
use serde::{Deserialize, Serialize};

/// State at the end of a coupling step.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CouplingCheckpoint {
    pub simulation: Checkpoint,
    pub solids: Vec<SteppedCheckpoint>,
    pub bushings: Vec<BushingCheckpoint>,
    pub exchanges: u64,
    /// Initial energy in the ledger, J.
    pub first: f64,
}

/// A solid and its housing fits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SteppedCheckpoint {
    pub solid: SolidCheckpoint,
    pub seats: Vec<SeatCheckpoint>,
    /// Numbers of a shaft or cage in addition to its elements; empty for other solids.
    pub attached: Vec<f64>,
}

#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SeatCheckpoint {
    /// Impulse on the race since the start, N·s.
    pub impulse: Vec3,
    /// Work on its body since the start, J.
    pub work: f64,
    pub growth: Growth,
    pub tested: u64,
    pub sorts: u64,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub friction: Option<FrictionCheckpoint>,
}

/// History of the friction of a housing fit.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct FrictionCheckpoint {
    /// Nodes in contact in the last step, ascending.
    pub springs: Vec<NodeSpring>,
    /// Friction heat since the start, J; see [`FrictionSum`](crate::motion::bore_friction::FrictionSum).
    pub heat: f64,
    pub load_work: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BushingCheckpoint {
    /// Longest step of the rubber, s.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub most: Option<f64>,
    pub sleeves: [SleeveCheckpoint; 2],
    pub rubber: RubberInBushing,
}

/// A sleeve, and the motion of its body at the beginning of the coupling step.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SleeveCheckpoint {
    pub loads: [Wrench; 2],
    pub velocity: Vec3,
    pub spin: Vec3,
    pub work: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum RubberInBushing {
    Explicit(Box<SolidCheckpoint>),
    Implicit(Box<RubberCheckpoint>),
}

impl BondedBushing<'_> {
    pub fn checkpoint(&self) -> BushingCheckpoint {
        let of_sleeve = |now: &SleeveNow| SleeveCheckpoint {
            loads: now.loads,
            velocity: now.from.velocity,
            spin: now.from.spin,
            work: now.work,
        };
        BushingCheckpoint {
            most: self.most,
            sleeves: self.sleeves.each_ref().map(of_sleeve),
            rubber: match &self.rubber {
                BondedRubber::Explicit(solid) => {
                    RubberInBushing::Explicit(Box::new(solid.checkpoint()))
                }
                BondedRubber::Implicit(solid) => {
                    RubberInBushing::Implicit(Box::new(solid.checkpoint()))
                }
            },
        }
    }

    /// Continues in coupling steps of this length (s).
    fn restore(&mut self, coupling_step: f64, kept: &BushingCheckpoint) -> Result<(), SolidError> {
        self.most = kept.most;
        self.step_in(coupling_step);
        for (now, kept) in self.sleeves.iter_mut().zip(&kept.sleeves) {
            (now.loads, now.work) = (kept.loads, kept.work);
            (now.from.velocity, now.from.spin) = (kept.velocity, kept.spin);
        }
        match (&mut self.rubber, &kept.rubber) {
            (BondedRubber::Explicit(solid), RubberInBushing::Explicit(kept)) => solid.restore(kept),
            (BondedRubber::Implicit(solid), RubberInBushing::Implicit(kept)) => {
                solid.restore(kept)?;
            }
            _ => panic!("a checkpoint of another kind of bushing"),
        }
        Ok(())
    }
}

/// Step sizes chosen at the start.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CouplingSteps {
    /// Coupling step, s.
    pub coupling_step: f64,
    /// Of each solid: steps in a coupling step, and what limits them.
    pub solids: Vec<(usize, SolidStepLimit)>,
}

impl<'p> CoupledMotion<'p> {
    /// Writes the present state. Contact nodes are sorted first, so that both continuations test the same nodes.
    pub fn checkpoint_into(&mut self, checkpoint: &mut CouplingCheckpoint) {
        self.simulation.checkpoint_into(&mut checkpoint.simulation);
        checkpoint.solids.resize_with(self.solids.len(), SteppedCheckpoint::default);
        for (part, kept) in self.solids.iter_mut().zip(&mut checkpoint.solids) {
            part.sort(&self.simulation);
            part.solid.checkpoint_into(&mut kept.solid);
            kept.seats.clear();
            kept.seats.extend(part.seats.iter().map(|seat| SeatCheckpoint {
                impulse: seat.impulse,
                work: seat.work,
                growth: seat.growth,
                tested: seat.tested,
                sorts: seat.sorts,
                friction: seat.friction.as_ref().map(|of| FrictionCheckpoint {
                    springs: of.springs.clone(),
                    heat: of.sum.heat,
                    load_work: of.sum.load_work,
                }),
            }));
            kept.attached = match (&part.shaft, &part.cage) {
                (Some(shaft), _) => shaft.numbers(),
                (_, Some(cage)) => cage.numbers(),
                _ => Vec::new(),
            };
        }
        checkpoint.bushings = self.bushings.iter().map(BondedBushing::checkpoint).collect();
        checkpoint.exchanges = self.exchanges;
        checkpoint.first = self.first;
    }

    pub fn coupling_steps(&self) -> CouplingSteps {
        let of = |part: &SteppedSolid| (part.steps, part.solid.limit);
        CouplingSteps {
            coupling_step: self.coupling_step,
            solids: self.solids.iter().map(of).collect(),
        }
    }

    /// Continues from a checkpoint of the same assembly, solids, housing fits, bushings and options.
    ///
    /// # Errors
    ///
    /// An invalid step size.
    ///
    /// # Panics
    ///
    /// If the checkpoint has another number of balls, solids, nodes, housing fits or bushings.
    pub fn from_checkpoint(
        assembly: impl Into<Assembly>,
        solids: Vec<SolidPart>,
        seats: Vec<Seat>,
        bushings: Vec<BondedPart<'p>>,
        options: &CouplingOptions,
        coupling_steps: &CouplingSteps,
        checkpoint: &CouplingCheckpoint,
    ) -> Result<CoupledMotion<'p>, CouplingError> {
        assert_eq!(solids.len(), coupling_steps.solids.len());
        let assembly = assembly.into();
        let method = ExplicitMethod::CentralDifferences;
        let mut solids: Vec<SteppedSolid> = solids
            .into_iter()
            .zip(&coupling_steps.solids)
            .map(|(SolidPart { name, model, shaft, cage, .. }, &(steps, limit))| {
                let step = coupling_steps.coupling_step / steps as f64;
                let solid = ExplicitSolid::at_rest(model, method, step, limit);
                let shaft =
                    shaft.map(|of| Box::new(SteppedShaft::new(of, &solid.model, &assembly)));
                let cage = cage.map(|of| Box::new(SteppedCage::new(of, &solid.model, &assembly)));
                SteppedSolid { name, solid, steps, seats: Vec::new(), shaft, cage }
            })
            .collect();
        seated(&assembly, &mut solids, seats);
        let simulation =
            Simulation::from_checkpoint(assembly, options.bearing, &checkpoint.simulation)?;
        assert_eq!(bushings.len(), checkpoint.bushings.len());
        let mut on_rubber = Vec::with_capacity(bushings.len());
        for (part, kept) in bushings.into_iter().zip(&checkpoint.bushings) {
            let name = part.name.clone();
            let made = BondedBushing::unmoved(part, &simulation);
            let restored = made.and_then(|mut bushing| {
                bushing.restore(coupling_steps.coupling_step, kept)?;
                Ok(bushing)
            });
            on_rubber.push(restored.map_err(|source| CouplingError::Bushing { name, source })?);
        }
        let mut exchange =
            CoupledMotion::of(simulation, solids, on_rubber, coupling_steps.coupling_step);
        exchange.exchanges = checkpoint.exchanges;
        exchange.first = checkpoint.first;
        for (part, kept) in exchange.solids.iter_mut().zip(&checkpoint.solids) {
            part.solid.restore(&kept.solid);
            part.sort(&exchange.simulation);
            if let Some(shaft) = &mut part.shaft {
                shaft.restore(&kept.attached);
            }
            if let Some(cage) = &mut part.cage {
                cage.restore(&kept.attached);
            }
            assert_eq!(part.seats.len(), kept.seats.len());
            for (seat, kept) in part.seats.iter_mut().zip(&kept.seats) {
                seat.impulse = kept.impulse;
                seat.work = kept.work;
                seat.growth = kept.growth;
                seat.tested = kept.tested;
                seat.sorts = kept.sorts;
                assert_eq!(seat.friction.is_some(), kept.friction.is_some());
                if let (Some(of), Some(kept)) = (&mut seat.friction, &kept.friction) {
                    of.springs.clone_from(&kept.springs);
                    (of.sum.heat, of.sum.load_work) = (kept.heat, kept.load_work);
                }
            }
        }
        Ok(exchange)
    }
}
