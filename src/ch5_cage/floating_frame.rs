//! Equations of motion of a flexible solid in a floating frame: a rigid body with component modes.
//!
//! A point at X in the frame is at r = R + A (X + u), u = Σ φ_k q_k. The frame follows the rigid motion: the modes have a
//! modal mass of 1 kg and are orthogonal to all rigid motions, so that the frame's origin is the centre of mass. With
//! the angular velocity ω in axes of the frame,
//!
//! T = ½ m Ṙ² + ½ ω·J ω + ω·Σ q_k q̇_l g_kl + ½ Σ q̇_k²,  J = J₀ + Σ q_k J_k + Σ q_k q_l J_kl,  g_kl = ∫ φ_k × φ_l dm.
//!
//! Lagrange's equations of this T conserve momentum, angular momentum and energy exactly. With h_l = Σ q_k g_kl,
//! b_l = Σ q̇_k g_kl and the angular momentum L = J ω + Σ h_l q̇_l,
//!
//! q̈_l + h_l·ω̇ = Q_l − ω_l² q_l − α q̇_l + ½ ω·(J_l + 2 Σ q_k J_lk) ω − 2 ω·b_l,
//!
//! J ω̇ + Σ h_l q̈_l = τ − ω × L − J̇ ω.
//!
//! Strains are small, but the tension of a spinning solid stiffens its bending: a mode shortens the fibres by its
//! square. That is a part of J_kl about X, −∫ σ₁ : ∇φ_kᵀ ∇φ_l dV with the stress σ₁ of a unit squared speed about X;
//! about Y and Z it is omitted.

use crate::kinematics::strain::Sym3;
use crate::kinematics::vec3::{Vec3, add, add_scaled, cross, dot, scale, sub};

/// Components of a symmetric tensor, in the order of [`Sym3`].
const TENSOR: usize = 6;

/// Constants of a floating frame with n modes, SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FloatingFrame {
    /// kg.
    pub mass: f64,
    /// J₀, kg·m², undeformed.
    pub inertia: Sym3,
    /// ω_k, rad/s.
    pub frequencies: Vec<f64>,
    /// α, 1/s: damping of the deformation, not of the rigid motion.
    pub damping: f64,
    /// J_k, kg·m² per unit: n values for each component.
    pub slope: Vec<f64>,
    /// J_kl, n² values for each component, symmetric in k and l.
    pub curvature: Vec<f64>,
    /// g_kl, n² values for each of X, Y, Z, antisymmetric in k and l.
    pub gyroscopic: Vec<f64>,
}

/// Working memory of one evaluation.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// J_l + Σ q_k J_lk for each component.
    half_slope: Vec<f64>,
    /// h and b.
    coupling: Vec<f64>,
    rate_coupling: Vec<f64>,
}

/// Rates of one evaluation, in axes of the frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameRates {
    /// ω̇.
    pub spin_rate: Vec3,
    /// Power of the damping, W, ≤ 0.
    pub damped: f64,
}

/// Product of a symmetric tensor and a vector.
pub fn tensor_times(of: &Sym3, v: Vec3) -> Vec3 {
    let [xx, yy, zz, xy, yz, zx] = *of;
    [
        xx * v[0] + xy * v[1] + zx * v[2],
        xy * v[0] + yy * v[1] + yz * v[2],
        zx * v[0] + yz * v[1] + zz * v[2],
    ]
}

/// Weights of the components of J in ω·J ω.
fn weights(spin: Vec3) -> Sym3 {
    let [x, y, z] = spin;
    [x * x, y * y, z * z, 2.0 * x * y, 2.0 * y * z, 2.0 * z * x]
}

/// Solution of a symmetric 3 × 3 system.
fn solve(matrix: &Sym3, right: Vec3) -> Vec3 {
    let [xx, yy, zz, xy, yz, zx] = *matrix;
    let (first, second, third) = ([xx, xy, zx], [xy, yy, yz], [zx, yz, zz]);
    let (a, b, c) = (cross(second, third), cross(third, first), cross(first, second));
    let per = 1.0 / dot(first, a);
    scale(add(add(scale(a, right[0]), scale(b, right[1])), scale(c, right[2])), per)
}

/// to += Σ_k factor_k · column k, columns of equal length one after the other.
fn add_columns(columns: &[f64], factors: &[f64], to: &mut [f64]) {
    for (column, factor) in columns.chunks_exact(to.len().max(1)).zip(factors) {
        for (to, value) in to.iter_mut().zip(column) {
            *to += factor * value;
        }
    }
}

impl Scratch {
    pub fn new(count: usize) -> Scratch {
        Scratch {
            half_slope: vec![0.0; TENSOR * count],
            coupling: vec![0.0; 3 * count],
            rate_coupling: vec![0.0; 3 * count],
        }
    }
}

impl FloatingFrame {
    /// Number of modes.
    pub fn count(&self) -> usize {
        self.frequencies.len()
    }

    /// J_l + Σ q_k J_lk of each component, and J.
    fn inertia_at(&self, gone: &[f64], half_slope: &mut [f64]) -> Sym3 {
        let count = self.count();
        half_slope.copy_from_slice(&self.slope);
        let mut inertia = self.inertia;
        for c in 0..TENSOR {
            let here = &mut half_slope[c * count..(c + 1) * count];
            add_columns(&self.curvature[c * count * count..(c + 1) * count * count], gone, here);
            inertia[c] += here.iter().zip(gone).map(|(slope, gone)| slope * gone).sum::<f64>();
        }
        inertia
    }

    /// Σ a_k g_kl for each l, component by component.
    fn coupled(&self, amplitudes: &[f64], to: &mut [f64]) {
        let count = self.count();
        to.fill(0.0);
        for c in 0..3 {
            let matrix = &self.gyroscopic[c * count * count..(c + 1) * count * count];
            add_columns(matrix, amplitudes, &mut to[c * count..(c + 1) * count]);
        }
    }

    /// Angular acceleration of the frame and accelerations of the modes. `accelerations` holds the modal forces Q (N)
    /// before and q̈ (m/s²) after; `moment` is τ about the centre of mass, N·m, `spin` ω, both in axes of the frame.
    pub fn rates(
        &self,
        spin: Vec3,
        moment: Vec3,
        [gone, speeds]: [&[f64]; 2],
        accelerations: &mut [f64],
        scratch: &mut Scratch,
    ) -> FrameRates {
        let count = self.count();
        let Scratch { half_slope, coupling, rate_coupling } = scratch;
        let mut inertia = self.inertia_at(gone, half_slope);
        self.coupled(gone, coupling);
        self.coupled(speeds, rate_coupling);
        let weights = weights(spin);
        let mut damped = 0.0;
        let mut momentum = tensor_times(&inertia, spin);
        let mut growth = [0.0; TENSOR];
        let mut of_modes = [0.0; 3];
        for l in 0..count {
            let mut centrifugal = 0.0;
            for c in 0..TENSOR {
                let slope = 2.0 * half_slope[c * count + l] - self.slope[c * count + l];
                centrifugal += weights[c] * slope;
                growth[c] += slope * speeds[l];
            }
            let at = |of: &[f64]| [of[l], of[count + l], of[2 * count + l]];
            let (h, b) = (at(coupling), at(rate_coupling));
            let stiffness = self.frequencies[l] * self.frequencies[l];
            accelerations[l] += 0.5 * centrifugal
                - 2.0 * dot(spin, b)
                - stiffness * gone[l]
                - self.damping * speeds[l];
            damped -= self.damping * speeds[l] * speeds[l];
            momentum = add_scaled(momentum, speeds[l], h);
            of_modes = add_scaled(of_modes, accelerations[l], h);
            let [x, y, z] = h;
            for (to, product) in inertia.iter_mut().zip([x * x, y * y, z * z, x * y, y * z, z * x])
            {
                *to -= product;
            }
        }
        let right = sub(sub(moment, cross(spin, momentum)), tensor_times(&growth, spin));
        let spin_rate = solve(&inertia, sub(right, of_modes));
        for (l, acceleration) in accelerations.iter_mut().enumerate() {
            let h = [coupling[l], coupling[count + l], coupling[2 * count + l]];
            *acceleration -= dot(h, spin_rate);
        }
        FrameRates { spin_rate, damped }
    }

    /// Angular momentum about the centre of mass in axes of the frame, N·m·s.
    pub fn angular_momentum(&self, spin: Vec3, [gone, speeds]: [&[f64]; 2]) -> Vec3 {
        let count = self.count();
        let mut scratch = Scratch::new(count);
        let inertia = self.inertia_at(gone, &mut scratch.half_slope);
        self.coupled(gone, &mut scratch.coupling);
        let h = &scratch.coupling;
        let of_modes = |c: usize| -> f64 {
            h[c * count..(c + 1) * count].iter().zip(speeds).map(|(h, speed)| h * speed).sum()
        };
        add(tensor_times(&inertia, spin), [0, 1, 2].map(of_modes))
    }

    /// Kinetic energy of rotation and deformation, and strain energy, J.
    pub fn energy(&self, spin: Vec3, [gone, speeds]: [&[f64]; 2]) -> [f64; 2] {
        let mut scratch = Scratch::new(self.count());
        let inertia = self.inertia_at(gone, &mut scratch.half_slope);
        let of_frame = dot(spin, tensor_times(&inertia, spin));
        let momentum = self.angular_momentum(spin, [gone, speeds]);
        // ω·L has the coupling twice as often as T has.
        let coupling = dot(spin, momentum) - of_frame;
        let (mut kinetic, mut strain) = (0.5 * of_frame + coupling, 0.0);
        for ((gone, speed), frequency) in gone.iter().zip(speeds).zip(&self.frequencies) {
            kinetic += 0.5 * speed * speed;
            strain += 0.5 * (frequency * gone) * (frequency * gone);
        }
        [kinetic, strain]
    }
}
