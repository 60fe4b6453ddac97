//! Timoshenko beam model of the shaft: circular section, rotary inertia, five-node element.
//!
//! One bending plane at a time; the unknowns at each node are the deflection w (m) and the section rotation s (rad).
//! Both are interpolated by quartic polynomials. These contain the cubic solution for loads at the element ends, so
//! that such loads are solved exactly and slender shafts do not lock. Frequency errors are of eighth order in the
//! element length (sixth order for slender shafts); the usual two-node element with static shape functions has
//! second-order errors where shear matters.

use nalgebra::{SMatrix, SVector};
use std::f64::consts::PI;

/// Nodes of an element, equally spaced, including its ends.
pub const NODES: usize = 5;

/// Square matrix over w, s of each node.
pub type PlaneMatrix = SMatrix<f64, { 2 * NODES }, { 2 * NODES }>;
type PlaneVector = SVector<f64, { 2 * NODES }>;

/// Solid or hollow circular section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Section {
    /// m.
    pub outer_diameter: f64,
    /// m; zero for a solid section.
    pub inner_diameter: f64,
}

impl Section {
    /// m².
    pub fn area(&self) -> f64 {
        let [a, b] = [self.outer_diameter, self.inner_diameter];
        PI / 4.0 * (a * a - b * b)
    }

    /// Second moment of area about a diameter, m⁴; half the polar second moment.
    pub fn second_moment(&self) -> f64 {
        let [a, b] = [self.outer_diameter, self.inner_diameter];
        PI / 64.0 * (a * a * a * a - b * b * b * b)
    }
}

/// Shear coefficient formula.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub enum ShearCoefficient {
    /// From the static beam: 6(1+ν)/(7+6ν) for a solid section (G. R. Cowper, J. Appl. Mech. 33, 1966).
    #[default]
    Cowper,
    /// From vibrations: 6(1+ν)²/(7+12ν+4ν²) for a solid section (J. R. Hutchinson, J. Appl. Mech. 68, 2001).
    Hutchinson,
    Given(f64),
}

impl ShearCoefficient {
    /// Shear coefficient κ of a section for a Poisson ratio.
    pub fn of(self, section: &Section, poisson_ratio: f64) -> f64 {
        let nu = poisson_ratio;
        let m2 = {
            let m = section.inner_diameter / section.outer_diameter;
            m * m
        };
        match self {
            ShearCoefficient::Given(value) => value,
            ShearCoefficient::Cowper => {
                let sum = (1.0 + m2) * (1.0 + m2);
                6.0 * (1.0 + nu) * sum / ((7.0 + 6.0 * nu) * sum + (20.0 + 12.0 * nu) * m2)
            }
            ShearCoefficient::Hutchinson => {
                let [sum, m4] = [(1.0 + m2) * (1.0 + m2), m2 * m2];
                6.0 * sum * (1.0 + nu) * (1.0 + nu)
                    / (7.0
                        + 34.0 * m2
                        + 7.0 * m4
                        + nu * (12.0 + 48.0 * m2 + 12.0 * m4)
                        + nu * nu * (4.0 + 16.0 * m2 + 4.0 * m4))
            }
        }
    }
}

/// Beam element of uniform section and material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Element {
    /// m.
    pub length: f64,
    /// EI, N·m².
    pub bending: f64,
    /// κGA, N.
    pub shear: f64,
    /// EA, N.
    pub stretch: f64,
    /// ρA, kg/m.
    pub line_mass: f64,
    /// ρI, kg·m: rotary inertia per metre about a diameter; half the polar value.
    pub line_inertia: f64,
}

impl Element {
    /// `youngs_modulus` in Pa, `density` in kg/m³, `kappa` the shear coefficient.
    pub fn new(
        section: &Section,
        length: f64,
        youngs_modulus: f64,
        poisson_ratio: f64,
        density: f64,
        kappa: f64,
    ) -> Element {
        let [area, moment] = [section.area(), section.second_moment()];
        let shear_modulus = youngs_modulus / (2.0 * (1.0 + poisson_ratio));
        Element {
            length,
            bending: youngs_modulus * moment,
            shear: kappa * shear_modulus * area,
            stretch: youngs_modulus * area,
            line_mass: density * area,
            line_inertia: density * moment,
        }
    }

    /// Bending and shear stiffness: ∫ EI s′² + κGA (w′ − s)².
    pub fn stiffness(&self) -> PlaneMatrix {
        self.integral(|at| {
            let [bending, shear] = [at.curvature, at.slope - at.turn];
            bending * bending.transpose() * self.bending + shear * shear.transpose() * self.shear
        })
    }

    /// Translational mass matrix.
    pub fn translational_mass(&self) -> PlaneMatrix {
        self.integral(|at| at.deflection * at.deflection.transpose() * self.line_mass)
    }

    /// Rotary mass matrix for section rotation about a diameter. Twice this matrix couples the two bending planes as
    /// the gyroscopic matrix per rad/s of spin, because the polar inertia of a circular section is twice the diametral
    /// one.
    pub fn rotary_mass(&self) -> PlaneMatrix {
        self.integral(|at| at.turn * at.turn.transpose() * self.line_inertia)
    }

    /// Axial stiffness (N/m) and mass (kg) of a bar over the axial displacements of the nodes.
    pub fn bar(&self) -> [SMatrix<f64, NODES, NODES>; 2] {
        let mut matrices = [SMatrix::zeros(); 2];
        for (place, weight) in GAUSS {
            let [shapes, slopes] = lagrange(place).map(SVector::from);
            matrices[0] += slopes * slopes.transpose() * (weight * self.stretch / self.length);
            matrices[1] += shapes * shapes.transpose() * (weight * self.line_mass * self.length);
        }
        matrices
    }

    fn integral(&self, of: impl Fn(&ShapeFunctions) -> PlaneMatrix) -> PlaneMatrix {
        let mut sum = PlaneMatrix::zeros();
        for (place, weight) in GAUSS {
            sum += of(&ShapeFunctions::at(place, self.length)) * (weight * self.length);
        }
        sum
    }
}

/// ∫ w′² between each pair of neighbouring nodes of an element of `length` (m), m: half of it is their axial approach
/// when the shaft bends without stretching.
pub fn shortening(length: f64) -> [PlaneMatrix; NODES - 1] {
    let part = 1.0 / (NODES - 1) as f64;
    std::array::from_fn(|interval| {
        let mut sum = PlaneMatrix::zeros();
        for (place, weight) in GAUSS {
            let slope = ShapeFunctions::at((interval as f64 + place) * part, length).slope;
            sum += slope * slope.transpose() * (weight * part * length);
        }
        sum
    })
}

/// Shape functions at one position: contribution of each unit coordinate.
struct ShapeFunctions {
    deflection: PlaneVector,
    slope: PlaneVector,
    turn: PlaneVector,
    curvature: PlaneVector,
}

impl ShapeFunctions {
    fn at(place: f64, length: f64) -> ShapeFunctions {
        let [shapes, slopes] = lagrange(place);
        let spread = |values: [f64; NODES], first: usize, factor: f64| {
            let mut vector = PlaneVector::zeros();
            for (node, value) in values.iter().enumerate() {
                vector[2 * node + first] = value * factor;
            }
            vector
        };
        ShapeFunctions {
            deflection: spread(shapes, 0, 1.0),
            slope: spread(slopes, 0, 1.0 / length),
            turn: spread(shapes, 1, 1.0),
            curvature: spread(slopes, 1, 1.0 / length),
        }
    }
}

/// Lagrange polynomials of the nodes and their derivatives at `place` (0 to 1).
fn lagrange(place: f64) -> [[f64; NODES]; 2] {
    let node = |i: usize| i as f64 / (NODES - 1) as f64;
    let others = |i: usize| (0..NODES).filter(move |&j| j != i);
    let shape = std::array::from_fn(|i| {
        others(i).map(|j| (place - node(j)) / (node(i) - node(j))).product()
    });
    let slope = std::array::from_fn(|i| {
        let without = |k: usize| others(i).filter(move |&j| j != k);
        let terms = others(i).map(|k| {
            let rest: f64 = without(k).map(|j| (place - node(j)) / (node(i) - node(j))).product();
            rest / (node(i) - node(k))
        });
        terms.sum()
    });
    [shape, slope]
}

/// Five-point Gauss–Legendre rule on [0, 1]: points and weights. Exact to degree nine; the mass matrices have degree
/// eight.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_24),
    (0.5, 0.284_444_444_444_444_45),
    (0.769_234_655_052_841_6, 0.239_314_335_249_683_24),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];
