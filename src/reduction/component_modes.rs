//! A linear housing reduced to component modes: natural modes up to a frequency, and static correction modes for its
//! loads.
//!
//! With natural modes φ_k (φᵀMφ = 1) and forces f_j, each a pattern of pressure on the bore, the weight or a load, the
//! basis is φ and ψ_j = K⁻¹f_j − Σ φ_k φ_kᵀf_j/ω_k², the part of the static response beyond the natural modes (residual
//! attachment modes, MacNeal 1971, Rubin 1975). The Rayleigh–Ritz method over both leaves natural modes unchanged,
//! since ψ is orthogonal to them under M and K, and combines the ψ into modes of higher frequencies. The result is
//! diagonal, without coupled masses, and statically exact for every f_j. Interface modes with fixed-interface modes
//! (Craig and Bampton) span the same space, and need an interface of few coordinates first.
//!
//! Patterns are loads of a race on its bore in all directions ([`crate::reduction::load_patterns::pressed`]), and forces
//! of natural modes on the race. Their number is such that under none of them more than a given fraction of the
//! compliance of bore and contact is omitted. Masses are lumped, as in explicit steps.

use crate::ch2_housing::bore_contact::Penalty;
use crate::kinematics::vec3::{Vec3, add_scaled, dot, scale};
use crate::members::housing_fit::Seat;
use crate::members::mount::Mount;
use crate::members::reduced_solid::{ModalLoad, ReducedSolid, Surface, SurfaceNode};
use crate::numeric::dense::DenseSymmetric;
use crate::numeric::profile::Profile;
use crate::numeric::ritz;
use crate::numeric::sparse::FactorError;
use crate::plan::counts::Counts;
use crate::reduction::load_patterns::{LoadPatterns, NOTHING_NEW, patterns};
use crate::solids::bore_equilibrium::BoreState;
use crate::solids::condensation::{CondensedBore, beyond_normals, rim};
use crate::solids::model::SolidModel;
use crate::solids::modes::{Mode, ModeError, ModeOptions, Wanted};
use crate::solids::tangent::MassMatrix;
use nalgebra::{DMatrix, Vector3};
use std::f64::consts::TAU;
use thiserror::Error;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReduceOptions {
    /// Highest natural frequency kept, Hz.
    pub modes_to: f64,
    /// Largest fraction of the compliance omitted under given loads.
    pub left_out: f64,
}

/// Default of this fraction.
pub const LEFT_OUT: f64 = 1e-4;

#[derive(Clone, Debug, PartialEq, Error)]
pub enum ReduceError {
    #[error(transparent)]
    Modes(#[from] ModeError),
    #[error(transparent)]
    Bore(#[from] FactorError),
    #[error("the highest natural frequency is {frequency} Hz; it must be positive and finite")]
    Frequency { frequency: f64 },
    #[error(
        "the housing has more than {most} natural modes below {frequency:.4e} Hz: a reduced body has some dozens; \
         ask for a lower frequency (housing.modes_to)"
    )]
    TooMany { most: usize, frequency: f64 },
}

/// The kept and the omitted part.
#[derive(Clone, Debug, PartialEq)]
pub struct CutOff {
    /// Number of natural modes, patterns of the bore, and responses to weight and loads.
    pub natural: usize,
    pub patterns: usize,
    pub own: usize,
    /// Requested frequency, lowest natural frequency, and lowest omitted one, Hz.
    pub modes_to: f64,
    pub lowest: f64,
    pub first_left_out: f64,
    /// Highest frequency, Hz.
    pub highest: f64,
    /// Largest fraction of the compliance of housing and contact under the given loads that is omitted. To first order
    /// the displacement of the race is too small by as much; a new distribution of pressure multiplies it (by at most
    /// ten, as measured).
    pub static_left_out: f64,
    /// Largest fraction in patterns alone, without inertia of natural modes.
    pub by_patterns: f64,
    /// Bore nodes of possible contact.
    pub nodes: usize,
}

impl CutOff {
    /// Relative error of the displacement at a frequency (Hz) because omitted natural modes are represented by
    /// patterns: at most their fraction of the compliance, amplified as an oscillation of that frequency.
    pub fn dynamic_error(&self, frequency: f64) -> f64 {
        let square = (frequency / self.first_left_out).powi(2);
        if square < 1.0 {
            (self.by_patterns * square / (1.0 - square)).min(1.0)
        } else {
            self.by_patterns.min(1.0)
        }
    }
}

/// A housing in component modes.
#[derive(Clone, Debug, PartialEq)]
pub struct Reduction {
    pub solid: ReducedSolid,
    /// Displacements of all nodes per unit of each mode.
    pub shapes: Vec<Vec<Vec3>>,
    pub cut_off: CutOff,
}

/// Σ of shapes with these amplitudes, node by node.
pub(crate) fn superposed(shapes: &[Vec<Vec3>], amplitudes: &[f64]) -> Vec<Vec3> {
    let mut sum = vec![[0.0; 3]; shapes.first().map_or(0, Vec::len)];
    for (shape, of) in shapes.iter().zip(amplitudes) {
        for (sum, here) in sum.iter_mut().zip(shape) {
            *sum = add_scaled(*sum, *of, *here);
        }
    }
    sum
}

impl Reduction {
    /// Displacements of all nodes for modal coordinates (m), m.
    pub fn displacement(&self, amplitudes: &[f64]) -> Vec<Vec3> {
        superposed(&self.shapes, amplitudes)
    }

    /// Outward displacement of each bore node under outward unit forces on each, by the modes, m/N.
    pub fn compliance(&self) -> DenseSymmetric {
        let surface = &self.solid.surfaces[0];
        let count = surface.nodes.len();
        let mut values = vec![0.0; count * count];
        for (shape, w) in surface.shapes.chunks_exact(count).zip(&self.solid.frequencies) {
            for (column, to) in shape.iter().zip(values.chunks_exact_mut(count)) {
                let factor = column / (w * w);
                to.iter_mut().zip(shape).for_each(|(to, row)| *to += factor * row);
            }
        }
        DenseSymmetric::new(count, values).0
    }

    /// Outward displacement of each bore node under weight and loads at t = 0, m.
    pub fn own(&self) -> Vec<f64> {
        let mut own = vec![0.0; self.solid.surfaces[0].nodes.len()];
        let gone = self.solid.rest(&own_forces(&self.solid, 0.0));
        self.solid.surfaces[0].along_normals(&gone, &mut own);
        own
    }

    /// Modal coordinates in equilibrium under outward loads on the bore nodes (N), weight and loads at t = 0, m.
    pub fn rest(&self, loads: &[f64]) -> Vec<f64> {
        let mut forces = own_forces(&self.solid, 0.0);
        let surface = &self.solid.surfaces[0];
        for (force, shape) in forces.iter_mut().zip(surface.shapes.chunks_exact(loads.len())) {
            *force += shape.iter().zip(loads).map(|(shape, load)| shape * load).sum::<f64>();
        }
        self.solid.rest(&forces)
    }

    /// Additional gap of each bore node compared with displacements along normals, for the last state of a search, m:
    /// the node moves along its own normal alone, as in the modes.
    pub fn beyond_normals(&self, bore: &CondensedBore, state: &BoreState) -> Vec<f64> {
        let surface = &self.solid.surfaces[0];
        let mut outward = vec![0.0; surface.nodes.len()];
        surface.along_normals(&self.rest(&state.loads), &mut outward);
        let moved = surface.nodes.iter().zip(outward).map(|(node, out)| scale(node.normal, out));
        beyond_normals(bore, moved, &state.pose).collect()
    }

    /// The housing fit of a race on `mount`.
    pub fn seat(
        &self,
        bore: &CondensedBore,
        race: Mount,
        solid: usize,
        radius: Profile,
        penalty: Penalty,
    ) -> Seat {
        let width = bore.reach.width;
        Seat {
            name: "its bore".into(),
            label: None,
            race,
            solid,
            surface: 0,
            radius,
            width,
            rim: rim(bore.nodes.iter().map(|node| node.area), width),
            penalty,
            nominal: bore.reach.nominal.position.into(),
            axis: (bore.reach.nominal.orientation * Vector3::x()).into(),
        }
    }
}

/// Modal forces of weight and loads at time `t`, N.
fn own_forces(solid: &ReducedSolid, t: f64) -> Vec<f64> {
    let mut forces = solid.weight.clone();
    for load in &solid.loads {
        let factor = load.profile.value(t);
        forces.iter_mut().zip(&load.forces).for_each(|(to, force)| *to += factor * force);
    }
    forces
}

/// Largest number of natural modes.
const MOST: usize = 400;
/// Residual of natural modes: their frequencies are accurate to its square, and their orthogonality to it.
const RESIDUAL: f64 = 1e-7;
/// Residual of modes that are combined again.
const ROUGH_RESIDUAL: f64 = 1e-4;

/// Natural modes up to a frequency, and the frequency of the first one beyond, Hz.
///
/// # Errors
///
/// More than some hundred modes; those of [`CondensedBore::modes`].
pub fn natural_modes(
    model: &SolidModel,
    bore: &CondensedBore,
    frequency: f64,
    mass: MassMatrix,
) -> Result<(Vec<Mode>, f64), ReduceError> {
    if !(frequency > 0.0 && frequency.is_finite()) {
        return Err(ReduceError::Frequency { frequency });
    }
    let wanted = Wanted::UpTo { frequency, most: MOST };
    natural(model, bore, wanted, (mass, RESIDUAL)).map_err(|error| match error {
        ModeError::MoreThan { most, frequency } => ReduceError::TooMany { most, frequency },
        other => other.into(),
    })
}

/// The lowest natural modes (consistent masses), with frequencies accurate to 1e-8, and the frequency of the first one
/// beyond, Hz.
///
/// # Errors
///
/// Those of [`CondensedBore::modes`].
pub fn lowest_modes(
    model: &SolidModel,
    bore: &CondensedBore,
    count: usize,
) -> Result<(Vec<Mode>, f64), ReduceError> {
    let wanted = Wanted::Lowest((count + 1).min(bore.unknowns().count));
    Ok(natural(model, bore, wanted, (MassMatrix::Consistent, ROUGH_RESIDUAL))?)
}

/// All but the last of the requested modes, and the frequency of that, Hz; infinite if there is none.
fn natural(
    model: &SolidModel,
    bore: &CondensedBore,
    wanted: Wanted,
    (mass, tolerance): (MassMatrix, f64),
) -> Result<(Vec<Mode>, f64), ModeError> {
    let options = ModeOptions { wanted, mass, tolerance };
    let mut modes = bore.modes(model, &options)?.modes;
    let is_last = match wanted {
        Wanted::Lowest(count) => count == modes.len() && count < bore.unknowns().count,
        Wanted::UpTo { frequency, .. } => {
            modes.last().is_some_and(|mode| mode.frequency > frequency)
        }
    };
    let next = if is_last { modes.pop() } else { None };
    Ok((modes, next.map_or(f64::INFINITY, |mode| mode.frequency)))
}

/// A force on the solid and its static response beyond natural modes.
pub(crate) struct Answer {
    pub forces: Vec<(u32, Vec3)>,
    pub shape: Vec<Vec3>,
}

/// Reduces `model`, condensed as `bore`, for contact of stiffness `penalty`, with static corrections for `loads`, see
/// [`crate::reduction::load_patterns::pressed`].
///
/// # Errors
///
/// See [`ReduceError`].
pub fn reduce(
    model: &SolidModel,
    bore: &CondensedBore,
    penalty: Penalty,
    loads: &LoadPatterns,
    options: &ReduceOptions,
) -> Result<Reduction, ReduceError> {
    let (modes, first_left_out) = natural_modes(model, bore, options.modes_to, MassMatrix::Lumped)?;
    let lowest = modes.first().map_or(first_left_out, |mode| mode.frequency);
    let natural: Vec<(f64, Vec<Vec3>)> =
        modes.into_iter().map(|mode| (TAU * mode.frequency, mode.shape)).collect();
    let outward: Vec<Vec3> = bore
        .nodes
        .iter()
        .map(|node| bore.to_world([0.0, node.normal[0], node.normal[1]]))
        .collect();
    let at_bore = |shape: &[Vec3]| -> Vec<f64> {
        let nodes = bore.nodes.iter().zip(&outward);
        nodes.map(|(node, out)| dot(shape[node.node as usize], *out)).collect()
    };

    let kept = patterns(bore, penalty, &natural, loads, options.left_out, at_bore)?;
    let own = own_loads(model);
    let all = own.iter().map(|(forces, _)| forces.clone());
    let on_bore = kept.vectors.iter().map(|pattern| bore.nodal_forces(pattern).collect());
    let loads: Vec<Vec<(u32, Vec3)>> = all.chain(on_bore).collect();
    let responses = bore.responses_to(&loads);
    let beyond_natural = |(forces, mut shape): (Vec<(u32, Vec3)>, Vec<Vec3>)| {
        for (frequency, known) in &natural {
            let share = work(&forces, known) / (frequency * frequency);
            for (s, k) in shape.iter_mut().zip(known) {
                *s = add_scaled(*s, -share, *k);
            }
        }
        Answer { forces, shape }
    };
    let answers: Vec<Answer> = loads.into_iter().zip(responses).map(beyond_natural).collect();
    let (count, first_pattern) = (natural.len(), own.len());
    let mut all = natural;
    all.extend(combine(&answers, &model.mass));
    let (frequencies, shapes): (Vec<f64>, Vec<Vec<Vec3>>) = all.into_iter().unzip();

    let nodes = bore.nodes.iter().zip(&outward).map(|(node, &normal)| SurfaceNode {
        node: node.node,
        place: model.problem.nodes[node.node as usize],
        normal,
        area: node.area,
    });
    let surface = Surface {
        nodes: nodes.collect(),
        shapes: shapes.iter().flat_map(|shape| at_bore(shape)).collect(),
    };
    let mut weight = vec![0.0; shapes.len()];
    let mut of_loads = Vec::new();
    for (forces, profile) in &own {
        let forces: Vec<f64> = shapes.iter().map(|shape| work(forces, shape)).collect();
        match profile {
            None => weight = forces,
            Some(profile) => of_loads.push(ModalLoad { forces, profile: profile.clone() }),
        }
    }
    let cut_off = CutOff {
        natural: count,
        patterns: shapes.len() - count - first_pattern.min(shapes.len() - count),
        own: first_pattern,
        modes_to: options.modes_to,
        lowest,
        first_left_out,
        highest: frequencies.iter().fold(0.0, |most: f64, w| most.max(w / TAU)),
        static_left_out: kept.left_out,
        by_patterns: kept.by_patterns,
        nodes: bore.nodes.len(),
    };
    let solid = ReducedSolid {
        name: "the housing".into(),
        start: vec![0.0; frequencies.len()],
        frequencies,
        damping: model.problem.damping,
        weight,
        loads: of_loads,
        surfaces: vec![surface],
    };
    Ok(Reduction { solid, shapes, cut_off })
}

/// Work of forces along a displacement, J.
pub(crate) fn work(forces: &[(u32, Vec3)], displacement: &[Vec3]) -> f64 {
    forces.iter().map(|(node, force)| dot(*force, displacement[*node as usize])).sum()
}

/// Nodes and the forces on them, N.
type NodalForces = Vec<(u32, Vec3)>;

/// Weight (without a profile) and loads (at profile value 1) of a solid.
fn own_loads(model: &SolidModel) -> Vec<(NodalForces, Option<Profile>)> {
    let problem = &model.problem;
    let mut own = Vec::new();
    if problem.gravity != [0.0; 3] {
        let mut weight = vec![[0.0; 4]; model.mass.len()];
        model.add_weight(&mut weight, &mut Counts::default());
        let forces = (0u32..).zip(weight).map(|(node, [x, y, z, _])| (node, [x, y, z]));
        own.push((forces.collect(), None));
    }
    let loads = problem.loads.iter().map(|load| (load.forces.clone(), Some(load.profile.clone())));
    own.extend(loads);
    own
}

/// Frequencies (rad/s, ascending) and modes of unit modal mass spanned by the responses.
pub(crate) fn combine(answers: &[Answer], mass: &[f64]) -> Vec<(f64, Vec<Vec3>)> {
    let size = answers.len();
    let energy = DMatrix::from_fn(size, size, |i, j| {
        let of = |i: usize, j: usize| work(&answers[i].forces, &answers[j].shape);
        0.5 * (of(i, j) + of(j, i))
    });
    let mut inertia = DMatrix::zeros(size, size);
    for (i, one) in answers.iter().enumerate() {
        for (j, other) in answers[..=i].iter().enumerate() {
            let pairs = one.shape.iter().zip(&other.shape).zip(mass);
            inertia[(i, j)] = pairs.map(|((a, b), m)| m * dot(*a, *b)).sum::<f64>();
            inertia[(j, i)] = inertia[(i, j)];
        }
    }
    let unit: Vec<f64> = (0..size)
        .map(|i| if energy[(i, i)] > 0.0 { 1.0 / energy[(i, i)].sqrt() } else { 0.0 })
        .collect();
    let scaled = DMatrix::from_fn(size, size, |i, j| unit[i] * energy[(i, j)] * unit[j]);
    // Columns of unit energy.
    let basis = ritz::independent(scaled, |i| unit[i], NOTHING_NEW);
    let projected = basis.transpose() * inertia * &basis;
    let descending = |a: &f64, b: &f64| b.total_cmp(a);
    let (values, vectors) = ritz::sorted(0.5 * (&projected + projected.transpose()), descending);
    let shape = |(k, value): (usize, f64)| {
        let per_root = 1.0 / value.sqrt();
        let shares = &basis * vectors.column(k) * per_root;
        let mut shape = vec![[0.0; 3]; mass.len()];
        for (answer, share) in answers.iter().zip(shares.iter()) {
            for (to, from) in shape.iter_mut().zip(&answer.shape) {
                *to = add_scaled(*to, *share, *from);
            }
        }
        (per_root, shape)
    };
    values.into_iter().enumerate().map(shape).collect()
}
