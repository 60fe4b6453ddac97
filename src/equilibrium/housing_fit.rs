//! A race in a flexible bore in the equilibrium search: energy, load and stiffness over the coordinates of its body,
//! with the bore nodes eliminated.

use crate::equilibrium::bearing::motion_of_race;
use crate::equilibrium::model::{Evaluation, Five, Model};
use crate::equilibrium::statics::StaticsError;
use crate::members::mount::Mount;
use crate::members::race_position::InnerRacePosition;
use crate::solids::bore_equilibrium::BoreSearch;
use nalgebra::{Matrix3, SMatrix, Vector3, Vector4};

/// Position of a race in its bore, and its derivatives by the coordinates of its body.
pub struct SeatPlace {
    /// y, z (m), tilts about Y and Z (rad) from the nominal pose, in its axes.
    pub pose: [f64; 4],
    /// Derivatives of the pose by each coordinate of the body.
    by: SMatrix<f64, 4, 5>,
    /// `None` if the body's coordinates are those of the housing fit.
    race: Option<InnerRacePosition>,
}

impl SeatPlace {
    /// For a race that is its body, with coordinates relative to the nominal pose.
    pub(crate) fn direct(coordinates: &Five) -> SeatPlace {
        let by = SMatrix::<f64, 4, 5>::from_fn(|i, j| if j == i + 1 { 1.0 } else { 0.0 });
        let pose = [coordinates[1], coordinates[2], coordinates[3], coordinates[4]];
        SeatPlace { pose, by, race: None }
    }

    pub(crate) fn is_direct(&self) -> bool {
        self.race.is_none()
    }

    /// For a race in the nominal axes; its body's coordinates are rotated by `axes` relative to them.
    pub fn new(race: InnerRacePosition, mount: &Mount, axes: &Matrix3<f64>) -> SeatPlace {
        let (centre, a) = (&race.centre, &race.axis);
        let tilts = [libm::atan2(-a.z, a.x), libm::asin(a.y.clamp(-1.0, 1.0))];
        let motion = motion_of_race(&race, mount, axes);
        let mut by = SMatrix::<f64, 4, 5>::zeros();
        by.fixed_view_mut::<2, 5>(0, 0).copy_from(&motion.fixed_view::<2, 5>(1, 0));
        let across = a.x * a.x + a.z * a.z;
        let (turns, _) = race.turning();
        for (column, d) in turns.iter().enumerate() {
            by[(2, 3 + column)] = (a.z * d.x - a.x * d.z) / across;
            by[(3, 3 + column)] = d.y / across.sqrt();
        }
        SeatPlace { pose: [centre.y, centre.z, tilts[0], tilts[1]], by, race: Some(race) }
    }

    /// Load along the coordinates of the body, from one along the four coordinates of the housing fit.
    pub fn load(&self, load: &Vector4<f64>) -> Five {
        self.by.transpose() * load
    }

    /// Stiffness over the coordinates of the body, from that of the housing fit and its load, with the curvature of the
    /// coordinates.
    pub fn stiffness(
        &self,
        stiffness: &SMatrix<f64, 4, 4>,
        load: &Vector4<f64>,
        mount: &Mount,
    ) -> SMatrix<f64, 5, 5> {
        let mut whole = self.by.transpose() * stiffness * self.by;
        let Some(race) = &self.race else { return whole };
        let a = &race.axis;
        let across = a.x * a.x + a.z * a.z;
        let (turns, [xi_xi, xi_lambda, lambda_lambda]) = race.turning();
        let (_, centres) = race.along(mount);
        let force = Vector3::new(0.0, load[0], load[1]);
        for (u, v, second, centre) in [
            (0, 0, xi_xi, centres[0]),
            (0, 1, xi_lambda, centres[1]),
            (1, 1, lambda_lambda, centres[2]),
        ] {
            let (p, q) = (&turns[u], &turns[v]);
            let slope = 2.0 * (a.x * q.x + a.z * q.z);
            let tilt_y = (q.z * p.x + a.z * second.x - q.x * p.z - a.x * second.z) / across
                - (a.z * p.x - a.x * p.z) * slope / (across * across);
            let tilt_z = second.y / across.sqrt() - 0.5 * p.y * slope / (across * across.sqrt());
            let bend = load[2] * tilt_y + load[3] * tilt_z + force.dot(&centre);
            whole[(3 + u, 3 + v)] += bend;
            if u != v {
                whole[(3 + v, 3 + u)] += bend;
            }
        }
        whole
    }
}

/// Adds energy, load and stiffness of one housing fit.
///
/// # Errors
///
/// Contact that does not converge.
pub(crate) fn add_seat(
    model: &Model,
    index: usize,
    search: &mut BoreSearch,
    here: &mut Evaluation,
) -> Result<(), StaticsError> {
    let seat = &model.assembly.seats[index];
    let Some(first) = model.first_unknown(seat.mount.body) else { return Ok(()) };
    let place = model.seat_place(index, &here.at);
    let answer = search
        .answer(&seat.fit, place.pose)
        .map_err(|source| StaticsError::Seat { of: seat.suffix(), source })?;
    here.energy += answer.energy;
    here.seat_noise += answer.rounding;
    let mut rows = here.gradient.fixed_rows_mut::<5>(first);
    rows += place.load(&answer.load);
    let mut block = here.stiffness.fixed_view_mut::<5, 5>(first, first);
    block += place.stiffness(&answer.stiffness, &answer.load, &seat.mount);
    Ok(())
}
