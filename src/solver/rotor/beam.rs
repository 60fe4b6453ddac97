//! A stepped, hollow shaft with discs as matrices over stations along its axis.
//!
//! X is the axis, Z up. The lateral coordinates of a station are y, z (m) and the turns about Y and Z (rad), right-handed:
//! where the shaft only bends, turn_z = dy/dx and turn_y = −dz/dx. With spin Ω about X their motion is
//! M q̈ + Ω G q̇ + K q = loads (N, N, N·m, N·m); stretch along the axis is a bar, apart from them.

use crate::ch4_rotor::beam::{Element, NODES, PlaneMatrix, Section, ShearCoefficient};
use crate::ch4_rotor::disc;
use nalgebra::{DMatrix, DVector};
use thiserror::Error;

/// Coordinates of a station, in this order: y, z (m), turn_y, turn_z (rad).
pub const STATION: usize = 4;

/// Elements of a shaft of which nothing else is said; more where places ask for stations.
const ELEMENTS: f64 = 8.0;

/// A length of one section and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BeamSegment {
    /// m.
    pub length: f64,
    pub outer_diameter: f64,
    /// m; zero where it is full.
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
    /// No element is longer than this, m.
    pub longest_element: f64,
    pub shear_coefficient: ShearCoefficient,
}

/// A shaft over its stations.
#[derive(Clone, Debug, PartialEq)]
pub struct BeamMatrices {
    /// m along X.
    pub stations: Vec<f64>,
    /// Over y, z, turn_y, turn_z of each station, one station after the other. kg, kg·m, kg·m².
    pub mass: DMatrix<f64>,
    pub stiffness: DMatrix<f64>,
    /// Per rad/s of spin about X; skew-symmetric.
    pub gyroscopic: DMatrix<f64>,
    /// Over x of each station.
    pub axial_mass: DMatrix<f64>,
    pub axial_stiffness: DMatrix<f64>,
    /// Over deflection and turn in one plane of all stations of an element, for each element: [`Element::shortening`].
    pub shortening: Vec<[PlaneMatrix; NODES - 1]>,
}

#[derive(Clone, Debug, PartialEq, Error)]
pub enum BeamError {
    #[error("a shaft has no segment")]
    NoSegment,
    #[error("segment {number} of the shaft: its {what} is {value}, which has to be {wanted}")]
    Segment { number: usize, what: &'static str, value: f64, wanted: &'static str },
    #[error("disc {number} on the shaft: its {what} is {value}, which has to be {wanted}")]
    Disc { number: usize, what: &'static str, value: f64, wanted: &'static str },
    #[error("the longest element of a shaft is {0} m: it has to be a length")]
    Element(f64),
    #[error("the shear coefficient is {0}: it has to be above 0")]
    ShearCoefficient(f64),
    #[error("the place at {at} m is not on the shaft, which is from 0 to {length} m")]
    OffShaft { at: f64, length: f64 },
    #[error("the shaft would have {0} elements, at most 500 are solved")]
    Elements(f64),
}

/// Above this a dense solution is not what one wants.
const MOST_ELEMENTS: f64 = 500.0;

impl Beam {
    /// Without discs, in 8 elements of five stations or a few more, with Cowper's shear coefficient.
    pub fn new(segments: Vec<BeamSegment>) -> Beam {
        let length: f64 = segments.iter().map(|segment| segment.length).sum();
        Beam {
            segments,
            discs: Vec::new(),
            longest_element: length / ELEMENTS * (1.0 + 1e-9),
            shear_coefficient: ShearCoefficient::default(),
        }
    }

    /// m.
    pub fn length(&self) -> f64 {
        self.segments.iter().map(|segment| segment.length).sum()
    }

    /// The shaft in elements that end at its ends, its steps, its discs and the places `at` (m from its first end), and in
    /// between where they would be too long; places nearer to each other than 1e-9 of the length are one. Loads and supports
    /// belong to such places: stations within an element carry no jump of the shear force.
    ///
    /// # Errors
    /// Values that no shaft has; places that are not on it.
    pub fn matrices(&self, at: &[f64]) -> Result<BeamMatrices, BeamError> {
        self.check()?;
        let (ends, segments) = self.elements(at)?;
        let mut stations = vec![0.0];
        for end in ends.windows(2) {
            let part = |n: usize| n as f64 / (NODES - 1) as f64;
            stations.extend((1..NODES - 1).map(|n| end[0] + (end[1] - end[0]) * part(n)));
            stations.push(end[1]);
        }
        let count = stations.len();
        let lateral = || DMatrix::zeros(STATION * count, STATION * count);
        let mut matrices = BeamMatrices {
            mass: lateral(),
            stiffness: lateral(),
            gyroscopic: lateral(),
            axial_mass: DMatrix::zeros(count, count),
            axial_stiffness: DMatrix::zeros(count, count),
            shortening: Vec::with_capacity(segments.len()),
            stations,
        };
        for (number, &segment) in segments.iter().enumerate() {
            let element = self.element(&self.segments[segment], ends[number + 1] - ends[number]);
            matrices.add_element((NODES - 1) * number, &element);
        }
        for disc in &self.discs {
            let station = matrices.station(disc.at).expect("discs have stations");
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

    fn check(&self) -> Result<(), BeamError> {
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

    /// Ends of all elements, and the segment that each element belongs to.
    fn elements(&self, at: &[f64]) -> Result<(Vec<f64>, Vec<usize>), BeamError> {
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

/// Places that are nearer to each other than this part of the shaft's length are one.
const NEAR: f64 = 1e-9;

/// Coordinates of a station that bend in the plane of Y, and of Z; factors from (deflection, turn of the section towards it).
const PLANES: [([usize; 2], [f64; 2]); 2] = [([0, 3], [1.0, 1.0]), ([1, 2], [1.0, -1.0])];

type ElementPlaces = [(usize, f64); 2 * NODES];

/// Where the coordinates of an element that begins at a station stand, and their signs, in each plane.
fn element_places(first: usize) -> [ElementPlaces; 2] {
    PLANES.map(|(coordinates, signs)| {
        std::array::from_fn(|i| (STATION * (first + i / 2) + coordinates[i % 2], signs[i % 2]))
    })
}

impl BeamMatrices {
    /// The station that stands at a place (m along X), if one does.
    pub fn station(&self, at: f64) -> Option<usize> {
        station_at(&self.stations, at)
    }

    /// Its coordinates in the matrices.
    pub fn coordinates(&self, station: usize) -> std::ops::Range<usize> {
        STATION * station..STATION * (station + 1)
    }

    fn add_element(&mut self, first: usize, element: &Element) {
        let rotary = element.rotary_mass();
        let mass = element.translational_mass() + rotary;
        let stiffness = element.stiffness();
        let planes = element_places(first);
        for places in &planes {
            add(&mut self.mass, places, places, &mass);
            add(&mut self.stiffness, places, places, &stiffness);
        }
        // ∫ 2ρI (s_y ṡ_z − s_z ṡ_y): the turns towards Y and Z of round sections.
        let gyroscopic = rotary * 2.0;
        add(&mut self.gyroscopic, &planes[0], &planes[1], &gyroscopic);
        add(&mut self.gyroscopic, &planes[1], &planes[0], &-gyroscopic);
        let [stiffness, mass] = element.bar();
        let mut view = self.axial_stiffness.fixed_view_mut::<NODES, NODES>(first, first);
        view += stiffness;
        let mut view = self.axial_mass.fixed_view_mut::<NODES, NODES>(first, first);
        view += mass;
        self.shortening.push(element.shortening());
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

    /// Lateral rigid motions: along y, along z, turns about Y and about Z at x = `pivot` (m).
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

/// Of places in order, the one at `at`.
pub(super) fn station_at(stations: &[f64], at: f64) -> Option<usize> {
    let length = stations.last()? - stations.first()?;
    let next = stations.partition_point(|&x| x < at - NEAR * length);
    (stations.get(next)? - at <= NEAR * length).then_some(next)
}

fn add(
    to: &mut DMatrix<f64>,
    rows: &ElementPlaces,
    columns: &ElementPlaces,
    element: &PlaneMatrix,
) {
    for (i, &(row, row_sign)) in rows.iter().enumerate() {
        for (j, &(column, column_sign)) in columns.iter().enumerate() {
            to[(row, column)] += row_sign * column_sign * element[(i, j)];
        }
    }
}
