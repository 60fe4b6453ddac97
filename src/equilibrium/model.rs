//! Model of an equilibrium search: bodies, their coordinates and axes, and an evaluation.

use crate::equilibrium::bearing::planes;
use crate::equilibrium::housing_fit::SeatPlace;
use crate::equilibrium::lists::{
    Loaded, Place, StaticAssembly, StaticBearing, StaticSection, StaticShaft,
};
use crate::equilibrium::plan::{ASKED_FOR, StaticSteps, items};
use crate::equilibrium::shaft::SectionPlace;
use crate::kinematics::Pose;
use crate::kinematics::euler::quaternion;
use crate::members::flexible_shaft::Section;
use crate::members::race_position::InnerRacePosition;
use crate::members::static_ball::{BallContacts, BallPlane, SettledBall};
use nalgebra::{DMatrix, DVector, Matrix3, SVector, Vector3};

pub(crate) type Five = SVector<f64, 5>;

/// Constants of a search.
pub(crate) struct Model<'a> {
    pub(crate) assembly: &'a StaticAssembly<'a>,
    /// Stages of each evaluation.
    pub(crate) steps: StaticSteps,
    pub(crate) bearings: Vec<BearingModel>,
    /// Axes of each body's coordinates relative to the nominal pose of each housing fit.
    seat_axes: Vec<Pose>,
    /// First unknown of each body; `None` if it is fixed. Coordinates of sections follow all unknowns.
    pub(crate) unknowns: Vec<Option<usize>>,
    /// First amplitude of each flexible shaft.
    shafts: Vec<usize>,
    /// Number of unknowns and dependent coordinates.
    pub(crate) coordinates: usize,
    /// Metres per unit of each unknown: 1 for lengths, a pitch radius (that of a seat, without a bearing) for tilts.
    pub(crate) scale: DVector<f64>,
}

pub(crate) struct BearingModel {
    pub(crate) contacts: BallContacts,
    pub(crate) azimuths: Vec<f64>,
    /// Weight of a ball, N, and centrifugal force per distance from the axis, N/m: as planned.
    pub(crate) weight: Vector3<f64>,
    pub(crate) centrifugal: f64,
    /// Origin of the positions of races and balls.
    pub(crate) origin: Vector3<f64>,
    /// Ball planes of a fixed outer race.
    pub(crate) planes: Vec<BallPlane>,
}

/// Position of a bearing's outer race as far as it is known beforehand; for races that are bodies that of the frame.
fn origin(assembly: &StaticAssembly, bearing: &StaticBearing) -> Vector3<f64> {
    let [inner, outer] = &bearing.mounts;
    if inner.is_direct() && outer.is_direct() {
        return Vector3::zeros();
    }
    match &assembly.bodies[outer.body].place {
        Place::Fixed(pose) => pose.position + pose.orientation * Vector3::x() * outer.along,
        Place::Loaded(loaded) => {
            let [x, y, z, ..] = loaded.start.unwrap_or(loaded.rest);
            loaded.axes().point_to_parent(&Vector3::new(x + outer.along, y, z))
        }
        Place::Section(of) => match &assembly.bodies[assembly.shafts[of.shaft].body].place {
            Place::Loaded(body) => {
                let [x, y, z, ..] = body.start.unwrap_or(body.rest);
                body.axes().point_to_parent(&Vector3::new(x + of.section.along, y, z))
            }
            _ => Vector3::zeros(),
        },
    }
}

/// Pitch radius of a bearing on a section of a body.
fn on_section_of(assembly: &StaticAssembly, body: usize) -> Option<f64> {
    let is_its = |index: usize| match &assembly.bodies[index].place {
        Place::Section(of) => assembly.shafts[of.shaft].body == body,
        _ => false,
    };
    let on_it = |bearing: &&StaticBearing| bearing.mounts.iter().any(|mount| is_its(mount.body));
    assembly.bearings.iter().find(on_it).map(|bearing| bearing.geometry.pitch_radius)
}

/// Largest displacement of the sections of a shaft per unit of each amplitude.
fn amplitude_scales(assembly: &StaticAssembly, shaft: usize) -> Vec<f64> {
    let of = &assembly.shafts[shaft];
    let mut reach = vec![0.0f64; of.springs.len()];
    for body in &assembly.bodies {
        let Place::Section(place) = &body.place else { continue };
        if place.shaft == shaft {
            let Section { deflection, stretch, .. } = &place.section;
            let all = deflection.iter().chain(deflection).chain(stretch);
            reach.iter_mut().zip(all).for_each(|(reach, own)| *reach = reach.max(own.abs()));
        }
    }
    // A mode that moves no section stays at its spring.
    reach.into_iter().map(|reach| if reach > 0.0 { reach } else { 1.0 }).collect()
}

impl<'a> Model<'a> {
    pub(crate) fn new(assembly: &'a StaticAssembly) -> Self {
        let mut unknowns = Vec::with_capacity(assembly.bodies.len());
        let mut scale = Vec::new();
        for (index, body) in assembly.bodies.iter().enumerate() {
            unknowns.push(match body.place {
                Place::Fixed(_) | Place::Section(_) => None,
                Place::Loaded(_) => {
                    let is_on_body = |bearing: &&StaticBearing| {
                        bearing.mounts.iter().any(|mount| mount.body == index)
                    };
                    let own = assembly.bearings.iter().find(is_on_body);
                    let seat = assembly.seats.iter().find(|seat| seat.mount.body == index);
                    let pitch = match (own, seat) {
                        (Some(bearing), _) => bearing.geometry.pitch_radius,
                        (None, Some(seat)) => seat.fit.radius,
                        (None, None) => on_section_of(assembly, index).unwrap_or(1.0),
                    };
                    scale.extend([1.0, 1.0, 1.0, pitch, pitch]);
                    Some(scale.len() - 5)
                }
            });
        }
        let mut shafts = Vec::with_capacity(assembly.shafts.len());
        for shaft in 0..assembly.shafts.len() {
            shafts.push(scale.len());
            scale.extend(amplitude_scales(assembly, shaft));
        }
        let mut coordinates = scale.len();
        for (first, body) in unknowns.iter_mut().zip(&assembly.bodies) {
            if matches!(body.place, Place::Section(_)) {
                *first = Some(coordinates);
                coordinates += 5;
            }
        }
        let plan = items(assembly, Vec::new(), ASKED_FOR);
        let steps = StaticSteps::new(&plan, assembly);
        let bearings = assembly.bearings.iter().zip(&steps.ball_forces);
        let bearings = bearings.map(|(bearing, [weighed, flung])| {
            let mut of = BearingModel {
                contacts: bearing.contacts(),
                azimuths: bearing.azimuths.clone(),
                weight: if *weighed { bearing.weight } else { Vector3::zeros() },
                centrifugal: if *flung { bearing.centrifugal } else { 0.0 },
                origin: origin(assembly, bearing),
                planes: Vec::new(),
            };
            if let Place::Fixed(pose) = &assembly.bodies[bearing.mounts[1].body].place {
                let mut held = Vec::with_capacity(of.azimuths.len());
                planes(bearing, &of, pose, &mut held);
                of.planes = held;
            }
            of
        });
        let bearings: Vec<BearingModel> = bearings.collect();
        let seat_axes = assembly.seats.iter().map(|seat| {
            let axes = match &assembly.bodies[seat.mount.body].place {
                Place::Loaded(loaded) => loaded.axes(),
                Place::Fixed(_) | Place::Section(_) => Pose::identity(),
            };
            axes.relative_to(&seat.nominal)
        });
        let seat_axes = seat_axes.collect();
        let scale = DVector::from_vec(scale);
        Model { assembly, steps, bearings, seat_axes, unknowns, shafts, coordinates, scale }
    }

    /// Writes the coordinates of all sections, which follow from the unknowns.
    pub(crate) fn follow(&self, at: &mut DVector<f64>) {
        if self.coordinates == self.scale.len() {
            return;
        }
        at.resize_vertically_mut(self.coordinates, 0.0);
        for (body, first) in self.assembly.bodies.iter().zip(&self.unknowns) {
            if let (Place::Section(of), Some(first)) = (&body.place, first) {
                let place = self.section_place(of, at);
                at.fixed_rows_mut::<5>(*first).copy_from(&place.coordinates);
            }
        }
    }

    pub(crate) fn section_place(&self, of: &StaticSection, at: &DVector<f64>) -> SectionPlace {
        let body = self.coordinates(self.assembly.shafts[of.shaft].body, at);
        SectionPlace::new(of, &body, self.amplitudes(of.shaft, at))
    }

    pub(crate) fn amplitudes<'v>(&self, shaft: usize, at: &'v DVector<f64>) -> &'v [f64] {
        let first = self.shafts[shaft];
        &at.as_slice()[first..first + self.assembly.shafts[shaft].springs.len()]
    }

    /// First unknowns of a section's body and of its shaft.
    pub(crate) fn firsts_of(&self, of: &StaticSection) -> (Option<usize>, usize) {
        (self.unknowns[self.assembly.shafts[of.shaft].body], self.shafts[of.shaft])
    }

    /// First coordinate of each section and the loads along them.
    pub(crate) fn section_loads(&self) -> impl Iterator<Item = (usize, &[f64; 5])> {
        let bodies = self.assembly.bodies.iter().zip(&self.unknowns);
        bodies.filter_map(|(body, first)| match &body.place {
            Place::Section(of) => Some(((*first)?, &of.loads)),
            _ => None,
        })
    }

    /// Number of unknowns of bodies.
    pub(crate) fn bodies_end(&self) -> usize {
        self.shafts.first().copied().unwrap_or(self.scale.len())
    }

    /// First amplitude of each shaft.
    pub(crate) fn shafts(&self) -> impl Iterator<Item = (&StaticShaft, usize)> {
        self.assembly.shafts.iter().zip(self.shafts.iter().copied())
    }

    pub(crate) fn loaded(&self) -> impl Iterator<Item = (usize, usize, &Loaded)> {
        let bodies = self.assembly.bodies.iter().zip(&self.unknowns).enumerate();
        bodies.filter_map(|(index, (body, first))| match (&body.place, first) {
            (Place::Loaded(loaded), Some(first)) => Some((index, *first, loaded)),
            _ => None,
        })
    }

    /// Coordinates of a body.
    pub(crate) fn coordinates(&self, body: usize, at: &DVector<f64>) -> Five {
        match (&self.assembly.bodies[body].place, self.unknowns[body]) {
            (Place::Loaded(_) | Place::Section(_), Some(first)) => {
                at.fixed_rows::<5>(first).into_owned()
            }
            (Place::Fixed(pose), _) => five(pose),
            _ => Five::zeros(),
        }
    }

    /// Axes of a body's coordinates; `None` for those of the assembly.
    pub(crate) fn axes(&self, body: usize) -> Option<&Pose> {
        match &self.assembly.bodies[body].place {
            Place::Loaded(loaded) => loaded.axes.as_deref(),
            Place::Fixed(_) => None,
            Place::Section(of) => self.axes(self.assembly.shafts[of.shaft].body),
        }
    }

    /// Returns whether a body's coordinates are along the assembly's own axes.
    pub(crate) fn is_plain(&self, body: usize) -> bool {
        self.axes(body).is_none()
    }

    /// The axes of a body's coordinates in the assembly's frame.
    pub(crate) fn turn(&self, body: usize) -> Matrix3<f64> {
        let turn = |axes: &Pose| axes.orientation.to_rotation_matrix().into_inner();
        self.axes(body).map_or(Matrix3::identity(), turn)
    }

    /// Axes of a body's two tilts, in the assembly's frame.
    pub(crate) fn tilt_axes(&self, body: usize, at: &DVector<f64>) -> [Vector3<f64>; 2] {
        let q = self.coordinates(body, at);
        let own = [Vector3::y(), quaternion(0.0, q[3], q[4]) * Vector3::z()];
        match self.axes(body) {
            Some(axes) => own.map(|axis| axes.orientation * axis),
            None => own,
        }
    }

    /// A body in the assembly's frame.
    pub(crate) fn pose(&self, body: usize, at: &DVector<f64>) -> Pose {
        let q = self.coordinates(body, at);
        let own = Pose {
            position: Vector3::new(q[0], q[1], q[2]),
            orientation: quaternion(0.0, q[3], q[4]),
        };
        self.axes(body).map_or(own, |axes| own.seen_from_parent_of(axes))
    }

    /// A race of a bearing, its centre from the bearing's origin.
    pub(crate) fn race(&self, bearing: usize, side: usize, at: &DVector<f64>) -> InnerRacePosition {
        let mount = &self.assembly.bearings[bearing].mounts[side];
        let coordinates = self.coordinates(mount.body, at);
        let origin = &self.bearings[bearing].origin;
        match self.axes(mount.body) {
            None => InnerRacePosition::mounted(&coordinates, mount, origin),
            Some(axes) => {
                let from_origin = Pose { position: axes.position - origin, ..*axes };
                InnerRacePosition::mounted(&coordinates, mount, &Vector3::zeros())
                    .seen_from_parent_of(&from_origin)
            }
        }
    }

    /// Position of a race in its bore.
    pub(crate) fn seat_place(&self, seat: usize, at: &DVector<f64>) -> SeatPlace {
        let (mount, axes) = (&self.assembly.seats[seat].mount, &self.seat_axes[seat]);
        let coordinates = self.coordinates(mount.body, at);
        let own = axes.position == Vector3::zeros() && axes.orientation.imag() == Vector3::zeros();
        if own && mount.is_direct() {
            return SeatPlace::direct(&coordinates);
        }
        let race = InnerRacePosition::mounted(&coordinates, mount, &Vector3::zeros());
        let turn = axes.orientation.to_rotation_matrix().into_inner();
        SeatPlace::new(race.seen_from_parent_of(axes), mount, &turn)
    }

    /// The first housing fit of a body.
    pub(crate) fn seat_of(&self, body: usize) -> Option<usize> {
        self.assembly.seats.iter().position(|seat| seat.mount.body == body)
    }

    pub(crate) fn first_unknown(&self, body: usize) -> Option<usize> {
        self.unknowns[body]
    }
}

/// Position and tilts of a pose.
fn five(pose: &Pose) -> Five {
    let axis = pose.orientation * Vector3::x();
    let tilts = [libm::atan2(-axis.z, axis.x), libm::asin(axis.y.clamp(-1.0, 1.0))];
    let p = pose.position;
    Five::from([p.x, p.y, p.z, tilts[0], tilts[1]])
}

/// An evaluation at one position of the bodies.
#[derive(Clone, Default)]
pub(crate) struct Evaluation {
    pub(crate) at: DVector<f64>,
    /// Energy of contacts and springs minus the work of loads and body forces, J.
    pub(crate) energy: f64,
    pub(crate) gradient: DVector<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    pub(crate) largest_ball_load: f64,
    /// Largest stiffness against one coordinate outside of housing fits, N/m.
    pub(crate) stiffest: f64,
    /// Forces without an energy, N.
    pub(crate) without_energy: f64,
    /// Rounding of the loads of all housing fits, N.
    pub(crate) seat_noise: f64,
    /// Balls of each bearing.
    pub(crate) balls: Vec<Vec<Option<SettledBall>>>,
    /// Ball planes of outer races that are not fixed.
    pub(crate) planes: Vec<Vec<BallPlane>>,
}

impl Evaluation {
    pub(crate) fn planes<'e>(&'e self, model: &'e Model, bearing: usize) -> &'e [BallPlane] {
        let moved = &self.planes[bearing];
        if moved.is_empty() { &model.bearings[bearing].planes } else { moved }
    }
}
