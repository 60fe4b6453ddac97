//! Equilibria one after the other: a search that starts from its last solution, and the load residual of a race in its
//! bore.
//!
//! Statics holds each ball at its azimuth by cage forces, some 1e-5 of the load, since the inner race's normals are
//! slightly out of the outer race's meridian planes. The cage is on the outer race, so that the load on the inner race
//! arrives at the bore completely.

use crate::ch2_housing::bore_contact::Penalty;
use crate::equilibrium::lists::StaticAssembly;
use crate::equilibrium::quasi_static_sequence::QuasiStaticFit;
use crate::equilibrium::statics::{
    AssemblySolution, BallState, StaticOptions, StaticsError, solve_assembly_in,
};
use crate::kinematics::Pose;
use crate::solids::bore_equilibrium::{
    BoreError, BoreSearch, BoreState, Fit, RaceLoad, check_load,
};
use crate::solids::condensation::CondensedBore;
use nalgebra::{SVector, Vector3, Vector4};
use serde::{Deserialize, Serialize};

/// A search that starts from its last solution.
pub struct WarmStartedSearch<'b> {
    bores: Vec<BoreSearch<'b>>,
    options: StaticOptions,
    near: Option<Vec<SVector<f64, 5>>>,
}

/// State from which a search continues with the same bits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SearchMemory {
    /// x, y, z (m), tilts (rad) of each body; `None` before the first solution.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub places: Option<Vec<[f64; 5]>>,
    /// Contact nodes of each bore, ascending.
    pub touching: Vec<Vec<usize>>,
}

impl<'b> WarmStartedSearch<'b> {
    /// With these bores, in the order of the housing fits.
    pub fn new(
        bores: impl IntoIterator<Item = (&'b CondensedBore, Penalty)>,
    ) -> WarmStartedSearch<'b> {
        let bores = bores.into_iter().map(|(bore, penalty)| BoreSearch::new(bore, penalty));
        let options = StaticOptions::default();
        WarmStartedSearch { bores: bores.collect(), options, near: None }
    }

    /// With the bores of these housing fits.
    pub fn of(seats: &[QuasiStaticFit<'b>]) -> WarmStartedSearch<'b> {
        WarmStartedSearch::new(seats.iter().map(|seat| (seat.bore, seat.penalty)))
    }

    /// Bores with the contact of the last solution.
    pub fn bores(&self) -> &[BoreSearch<'b>] {
        &self.bores
    }

    /// Changes of contact nodes in all bores so far.
    pub fn contact_changes(&self) -> usize {
        self.bores.iter().map(|bore| bore.changes).sum()
    }

    /// Sets the start of the next search to these positions; `None` for a cold start.
    pub fn look_near(&mut self, places: Option<&[SVector<f64, 5>]>) {
        self.near = places.map(<[_]>::to_vec);
    }

    pub fn memory(&self) -> SearchMemory {
        let places = self.near.as_ref().map(|near| near.iter().map(|at| (*at).into()).collect());
        let touching = self.bores.iter().map(|bore| bore.touching().to_vec()).collect();
        SearchMemory { places, touching }
    }

    /// Continues from the memory of a search in the same bores.
    ///
    /// # Errors
    ///
    /// See [`BoreSearch::recall`].
    pub fn recall(&mut self, memory: &SearchMemory) -> Result<(), BoreError> {
        let places = memory.places.as_ref();
        self.near = places.map(|places| places.iter().map(|at| SVector::from(*at)).collect());
        let mut bores = self.bores.iter_mut().zip(&memory.touching);
        bores.try_for_each(|(bore, touching)| bore.recall(touching))
    }

    /// Equilibrium of these lists, with the bores of this search.
    ///
    /// # Errors
    ///
    /// No equilibrium from the last one nor from a cold start.
    pub fn solve(&mut self, still: &StaticAssembly<'b>) -> Result<AssemblySolution, StaticsError> {
        let mut look = |near: Option<&[SVector<f64, 5>]>| {
            solve_assembly_in(still, &mut self.bores, near, &self.options)
        };
        let found = match &self.near {
            Some(near) => look(Some(near)).or_else(|_| look(None))?,
            None => look(None)?,
        };
        self.near = Some(found.coordinates.clone());
        Ok(found)
    }
}

/// Load of the balls on the outer race at `race`, force and moment about its centre: contacts and cage forces.
pub fn load_of_balls(
    [mut force, mut moment]: [Vector3<f64>; 2],
    balls: &[BallState],
    race: &Pose,
) -> [Vector3<f64>; 2] {
    for ball in balls {
        let (sin, cos) = libm::sincos(ball.azimuth);
        let around = race.orientation * Vector3::new(0.0, -sin, cos);
        let by_cage = -around * ball.cage_force;
        force += by_cage;
        moment += (ball.position - race.position).cross(&by_cage);
    }
    [force, moment]
}

/// Load residual of a race in its bore over its load.
///
/// # Errors
///
/// An axial load without support.
pub fn unbalanced(
    fit: &Fit,
    on_race: &RaceLoad,
    bore: &BoreState,
    balls: &[BallState],
) -> Result<f64, BoreError> {
    let size = Vector4::new(1.0, 1.0, fit.radius, fit.radius);
    let pull = check_load(fit, on_race)?;
    let on_balls = balls.iter().fold(0.0, |most: f64, ball| most.max(ball.outer.normal_load));
    let load = pull.component_div(&size).amax().max(on_balls);
    let left = (pull - Vector4::from(bore.load)).component_div(&size).amax();
    Ok(if load > 0.0 { left / load } else { left })
}
