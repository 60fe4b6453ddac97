//! A stepped, hollow shaft with discs as matrices over stations along its axis.
//!
//! X is the axis, Z up. The lateral coordinates of a station are y, z (m) and the rotations about Y and Z (rad),
//! right-handed: in pure bending turn_z = dy/dx and turn_y = −dz/dx. With spin Ω about X the equation of motion is
//! M q̈ + Ω G q̇ + K q = loads (N, N, N·m, N·m); axial stretch is a separate bar. The same matrices follow from
//! tetrahedra condensed onto the stations ([`crate::members::condensed_shaft`]), if a shaft has a mesh.

use crate::ch4_rotor::beam::{Element, NODES, PlaneMatrix, Section, ShearCoefficient, shortening};
use crate::ch4_rotor::disc;
use crate::members::condensed_shaft::SolidShaftError;
use crate::members::meshed_shaft::{ShaftMesh, stations as within};
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Coordinates of a station, in this order: y, z (m), turn_y, turn_z (rad).
pub const STATION: usize = 4;

/// Default number of elements of a shaft; requested stations add to it.
const ELEMENTS: f64 = 8.0;

/// A length of constant section and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamSegment {
    /// m.
    pub length: f64,
    pub outer_diameter: f64,
    /// m; zero for a solid section.
    pub inner_diameter: f64,
    /// kg/m³.
    pub density: f64,
    /// Pa.
    pub youngs_modulus: f64,
    pub poisson_ratio: f64,
}

/// A rigid disc or ring; its centre is on the shaft's axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamDisc {
    /// m from the shaft's first end.
    pub at: f64,
    /// kg.
    pub mass: f64,
    /// Inertia about the axis (polar), kg·m².
    pub axial: f64,
    /// Inertia about a diameter, kg·m².
    pub transverse: f64,
}

/// A shaft from x = 0 on.
#[derive(Clone, Debug, PartialEq)]
pub struct Beam {
    pub segments: Vec<BeamSegment>,
    pub discs: Vec<BeamDisc>,
    /// Longest element, m.
    pub longest_element: f64,
    pub shear_coefficient: ShearCoefficient,
    /// Tetrahedra instead of beam theory for the segments.
    pub mesh: Option<ShaftMesh>,
}

/// A shaft over its stations.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamMatrices {
    /// m along X.
    pub stations: Vec<f64>,
    /// Over y, z, turn_y, turn_z of each station, one station after the other: kg, kg·m, kg·m².
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// Per rad/s of spin about X; skew-symmetric.
    pub gyroscopic: DMatrix<f64>,
    /// Over x of each station.
    pub axial_mass: DMatrix<f64>,
    pub axial_stiffness: DMatrix<f64>,
    /// For each element, over deflection and rotation in one plane of its stations: see [`shortening`].
    pub shortening: Vec<[PlaneMatrix; NODES - 1]>,
}

/// Bending in one plane, over the deflection (m) and the rotation of the section towards it (rad) at each station; both
/// planes of an axisymmetric shaft are equal.
#[derive(Clone, Debug, PartialEq)]
pub struct PlaneMatrices {
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// Axial inertia tilted by the rotations: times Ω it couples the planes.
    pub axial_inertia: DMatrix<f64>,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum BeamError {
    #[error("a shaft has no segment")]
    NoSegment,
    #[error("segment {number} of the shaft: its {what} is {value}; it must be {wanted}")]
    Segment { number: usize, what: &'static str, value: f64, wanted: &'static str },
    #[error("disc {number} on the shaft: its {what} is {value}; it must be {wanted}")]
    Disc { number: usize, what: &'static str, value: f64, wanted: &'static str },
    #[error("the longest element of a shaft is {0} m; it must be positive")]
    Element(f64),
    #[error("the shear coefficient is {0}; it must be above 0")]
    ShearCoefficient(f64),
    #[error("the position {at} m is not on the shaft, which extends from 0 to {length} m")]
    OffShaft { at: f64, length: f64 },
    #[error("the shaft would have {0} elements; at most 500 are allowed")]
    Elements(f64),
    #[error(transparent)]
    Solid(#[from] SolidShaftError),
}

/// Limit for dense matrices.
const MOST_ELEMENTS: f64 = 500.0;

impl Beam {
    /// A shaft without discs, in 8 elements of five stations or a few more, with Cowper's shear coefficient.
    pub fn new(segments: Vec<BeamSegment>) -> Beam {
        let length: f64 = segments.iter().map(|segment| segment.length).sum();
        Beam {
            segments,
            discs: Vec::new(),
            longest_element: length / ELEMENTS * (1.0 + 1e-9),
            shear_coefficient: ShearCoefficient::default(),
            mesh: None,
        }
    }

    /// Length, m.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.length).sum()
    }

    /// Matrices of the shaft. Elements end at its ends, its steps, its discs and the positions `at` (m from its first
    /// end), and are subdivided to the longest element; positions within 1e-9 of the length are merged. Loads and
    /// supports belong to such positions: stations within an element carry no jump of the shear force.
    ///
    /// # Errors
    ///
    /// Invalid dimensions or materials; positions off the shaft.
    pub fn matrices(&self, at: &[f64]) -> Result<BeamMatrices, BeamError> {
        self.check()?;
        let (ends, segments) = self.elements(at)?;
        let mut stations = vec![0.0];
        for end in ends.windows(2) {
            stations.extend(within(end[0], end[1]).split_off(1));
        }
        let mut matrices = match &self.mesh {
            Some(mesh) => self.tetrahedra(mesh, &ends, &segments, stations)?,
            None => {
                let mut matrices = BeamMatrices::empty(stations);
                for (number, &segment) in segments.iter().enumerate() {
                    let length = ends[number + 1] - ends[number];
                    let element = self.element(&self.segments[segment], length);
                    matrices.add_element((NODES - 1) * number, &element);
                }
                matrices
            }
        };
        for disc in &self.discs {
            let station = matrices.station(disc.at).expect("each disc has a station");
            matrices.add_disc(station, disc);
        }
        Ok(matrices)
    }

    fn element(&self, segment: &BeamSegment, length: f64) -> Element {
        let &BeamSegment { density, youngs_modulus, poisson_ratio, .. } = segment;
        let section = Section {
            outer_diameter: segment.outer_diameter,
            inner_diameter: segment.inner_diameter,
        };
        let kappa = self.shear_coefficient.of(&section, poisson_ratio);
        Element::new(&section, length, youngs_modulus, poisson_ratio, density, kappa)
    }

    pub(crate) fn check(&self) -> Result<(), BeamError> {
        if self.segments.is_empty() {
            return Err(BeamError::NoSegment);
        }
        for (index, segment) in self.segments.iter().enumerate() {
            let number = index + 1;
            let wrong = |what, value, wanted| BeamError::Segment { number, what, value, wanted };
            let positive = [
                ("length", segment.length),
                ("outer diameter", segment.outer_diameter),
                ("density", segment.density),
                ("Young's modulus", segment.youngs_modulus),
            ];
            for (what, value) in positive {
                if !(value > 0.0 && value.is_finite()) {
                    return Err(wrong(what, value, "above 0"));
                }
            }
            let inner = segment.inner_diameter;
            if !(0.0 <= inner && inner < segment.outer_diameter) {
                return Err(wrong("inner diameter", inner, "0 or more, below the outer one"));
            }
            let nu = segment.poisson_ratio;
            if !(-1.0 < nu && nu <= 0.5) {
                return Err(wrong("Poisson ratio", nu, "above -1, at most 0.5"));
            }
        }
        for (index, disc) in self.discs.iter().enumerate() {
            let values = [
                ("mass", disc.mass),
                ("axial inertia", disc.axial),
                ("transverse inertia", disc.transverse),
            ];
            for (what, value) in values {
                if !(value >= 0.0 && value.is_finite()) {
                    let (number, wanted) = (index + 1, "0 or more");
                    return Err(BeamError::Disc { number, what, value, wanted });
                }
            }
        }
        let is_length = self.longest_element > 0.0;
        if !is_length {
            return Err(BeamError::Element(self.longest_element));
        }
        match self.shear_coefficient {
            ShearCoefficient::Given(value) if !(value > 0.0 && value.is_finite()) => {
                Err(BeamError::ShearCoefficient(value))
            }
            _ => Ok(()),
        }
    }

    /// Ends of all elements, and the segment of each element.
    pub(crate) fn elements(&self, at: &[f64]) -> Result<(Vec<f64>, Vec<usize>), BeamError> {
        let length = self.length();
        let near = NEAR * length;
        let discs = self.discs.iter().map(|disc| disc.at);
        let asked: Vec<f64> = discs.chain(at.iter().copied()).collect();
        if let Some(&at) = asked.iter().find(|&&at| !(-near <= at && at <= length + near)) {
            return Err(BeamError::OffShaft { at, length });
        }
        let (mut ends, mut segments) = (vec![0.0], Vec::new());
        let mut start = 0.0;
        for (index, segment) in self.segments.iter().enumerate() {
            let end = start + segment.length;
            let inside = asked.iter().copied().filter(|&x| start + near < x && x < end - near);
            let mut stops: Vec<f64> = inside.chain([end]).collect();
            stops.sort_by(f64::total_cmp);
            stops.dedup_by(|late, early| *late - *early <= near);
            let mut from = start;
            for to in stops {
                let elements = ((to - from) / self.longest_element).ceil().max(1.0);
                if elements + segments.len() as f64 > MOST_ELEMENTS {
                    return Err(BeamError::Elements(elements + segments.len() as f64));
                }
                for n in 1..=elements as usize {
                    ends.push(from + (to - from) * (n as f64 / elements));
                    segments.push(index);
                }
                from = to;
            }
            start = end;
        }
        Ok((ends, segments))
    }
}

/// Positions closer than this fraction of the shaft's length are merged.
const NEAR: f64 = 1e-9;

/// Coordinates of a station for bending in the plane of Y, and of Z, and their factors (deflection, rotation towards
/// it).
const PLANES: [([usize; 2], [f64; 2]); 2] = [([0, 3], [1.0, 1.0]), ([1, 2], [1.0, -1.0])];

/// Indices of the coordinates of `count` stations from `first` on, and their signs, in each plane.
fn places(first: usize, count: usize) -> [Vec<(usize, f64)>; 2] {
    PLANES.map(|(coordinates, signs)| {
        let place = |i: usize| (STATION * (first + i / 2) + coordinates[i % 2], signs[i % 2]);
        (0..2 * count).map(place).collect()
    })
}

impl BeamMatrices {
    /// Index of the station at a position (m along X), if there is one.
    pub fn station(&self, at: f64) -> Option<usize> {
        station_at(&self.stations, at)
    }

    /// Its coordinates in the matrices.
    pub fn coordinates(&self, station: usize) -> std::ops::Range<usize> {
        STATION * station..STATION * (station + 1)
    }

    fn empty(stations: Vec<f64>) -> BeamMatrices {
        let count = stations.len();
        let lateral = || DMatrix::zeros(STATION * count, STATION * count);
        BeamMatrices {
            mass: lateral(),
            stiffness: lateral(),
            gyroscopic: lateral(),
            axial_mass: DMatrix::zeros(count, count),
            axial_stiffness: DMatrix::zeros(count, count),
            shortening: Vec::new(),
            stations,
        }
    }

    /// Matrices of an axisymmetric shaft; `axial` are mass and stiffness along the axis.
    pub(crate) fn of_planes(
        stations: Vec<f64>,
        plane: &PlaneMatrices,
        axial: [DMatrix<f64>; 2],
        shortening: Vec<[PlaneMatrix; NODES - 1]>,
    ) -> BeamMatrices {
        let count = stations.len();
        let [axial_mass, axial_stiffness] = axial;
        let mut matrices = BeamMatrices {
            axial_mass,
            axial_stiffness,
            shortening,
            ..BeamMatrices::empty(stations)
        };
        matrices.add_planes(0, count, plane);
        matrices
    }

    fn add_planes(&mut self, first: usize, count: usize, plane: &PlaneMatrices) {
        let planes = places(first, count);
        for places in &planes {
            add(&mut self.mass, places, places, (1.0, &plane.mass));
            add(&mut self.stiffness, places, places, (1.0, &plane.stiffness));
        }
        // ∫ 2ρI (s_y ṡ_z − s_z ṡ_y), s the rotations of round sections towards Y and Z.
        add(&mut self.gyroscopic, &planes[0], &planes[1], (1.0, &plane.axial_inertia));
        add(&mut self.gyroscopic, &planes[1], &planes[0], (-1.0, &plane.axial_inertia));
    }

    fn add_element(&mut self, first: usize, element: &Element) {
        let dense = |matrix: PlaneMatrix| {
            DMatrix::from_iterator(2 * NODES, 2 * NODES, matrix.iter().copied())
        };
        let rotary = element.rotary_mass();
        let plane = PlaneMatrices {
            mass: dense(element.translational_mass() + rotary),
            stiffness: dense(element.stiffness()),
            axial_inertia: dense(rotary * 2.0),
        };
        self.add_planes(first, NODES, &plane);
        let [stiffness, mass] = element.bar();
        let mut view = self.axial_stiffness.fixed_view_mut::<NODES, NODES>(first, first);
        view += stiffness;
        let mut view = self.axial_mass.fixed_view_mut::<NODES, NODES>(first, first);
        view += mass;
        self.shortening.push(shortening(element.length));
    }

    fn add_disc(&mut self, station: usize, disc: &BeamDisc) {
        let first = STATION * station;
        for (i, value) in
            [disc.mass, disc.mass, disc.transverse, disc.transverse].iter().enumerate()
        {
            self.mass[(first + i, first + i)] += value;
        }
        let mut turns = self.gyroscopic.fixed_view_mut::<2, 2>(first + 2, first + 2);
        turns += disc::gyroscopic(disc.axial);
        self.axial_mass[(station, station)] += disc.mass;
    }

    /// Lateral rigid motions: along y, along z, rotations about Y and about Z at x = `pivot` (m).
    pub fn rigid_motions(&self, pivot: f64) -> [DVector<f64>; 4] {
        let mut motions = [0; 4].map(|_| DVector::zeros(STATION * self.stations.len()));
        for (station, x) in self.stations.iter().enumerate() {
            let first = STATION * station;
            motions[0][first] = 1.0;
            motions[1][first + 1] = 1.0;
            motions[2][first + 1] = -(x - pivot);
            motions[2][first + 2] = 1.0;
            motions[3][first] = x - pivot;
            motions[3][first + 3] = 1.0;
        }
        motions
    }
}

/// Index of the station at `at` among sorted positions.
pub(crate) fn station_at(stations: &[f64], at: f64) -> Option<usize> {
    let length = stations.last()? - stations.first()?;
    let next = stations.partition_point(|&x| x < at - NEAR * length);
    (stations.get(next)? - at <= NEAR * length).then_some(next)
}

fn add(
    to: &mut DMatrix<f64>,
    rows: &[(usize, f64)],
    columns: &[(usize, f64)],
    (factor, of): (f64, &DMatrix<f64>),
) {
    for (i, &(row, row_sign)) in rows.iter().enumerate() {
        for (j, &(column, column_sign)) in columns.iter().enumerate() {
            to[(row, column)] += row_sign * column_sign * factor * of[(i, j)];
        }
    }
}
