//! Patterns of force on a bore with static correction modes in a reduced housing: the loads of a race.

use crate::ch2_housing::bore_contact::Penalty;
use crate::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBody, StaticSeat};
use crate::equilibrium::statics::{StaticOptions, StaticsError, solve_assembly_in};
use crate::kinematics::Pose;
use crate::kinematics::vec3::{Vec3, cross};
use crate::members::body::Condition;
use crate::members::mount::Mount;
use crate::numeric::dense::DenseFactor;
use crate::numeric::sparse::FactorError;
use crate::solids::bore_equilibrium::{
    BoreError, BoreSearch, BoreState, Fit, RaceLoad, check_load,
};
use crate::solids::condensation::{CondensedBore, lever};
use nalgebra::SVector;
use std::f64::consts::TAU;

/// Directions of force in [`pressed`]: contact patches overlap from one to the next.
const DIRECTIONS: usize = 48;

/// Axial positions of the force in [`pressed`], over the width, in addition to the middle: within the race, and with a
/// moment that lifts one end, as from a bent shaft.
const LEVERS: [f64; 4] = [-0.25, 0.25, -1.0, 1.0];

/// Loads on the nodes of a bore, N, for which its compliance must be accurate.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadPatterns {
    /// Loads with correction modes of their own: a race that is displaced, tilted and grown in contact all round, so
    /// that nothing is omitted while all nodes touch; and the race at the start of a run.
    pub own: Vec<Vec<f64>>,
    pub others: Vec<Vec<f64>>,
}

/// Largest loads on a race, in any direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LargestLoads<'s> {
    /// N.
    pub force: f64,
    /// Pure moment, N·m.
    pub moment: f64,
    /// State at the start of a run, whose loads may have unknown levers.
    pub start: Option<&'s BoreState>,
}

fn in_bore(source: BoreError) -> StaticsError {
    StaticsError::Seat { of: String::new(), source }
}

/// A race alone in its bore under `load`, searched from its last pose.
///
/// A loose race without load keeps its position; of several positions the nearest is found.
///
/// # Errors
///
/// A load that the bore cannot carry.
pub fn race_under_load(
    search: &mut BoreSearch,
    fit: &Fit,
    load: &RaceLoad,
) -> Result<BoreState, StaticsError> {
    check_load(fit, load).map_err(in_bore)?;
    let [_, y, z] = load.force.map(Condition::Load);
    let [_, about_y, about_z] = load.moment.map(Condition::Load);
    let place = Place::Loaded(Loaded {
        axes: None,
        conditions: [Condition::Displacement(0.0), y, z, about_y, about_z],
        springs: [0.0; 5],
        rest: [0.0; 5],
        start: Some([0.0; 5]),
        room: fit.radius,
    });
    let seat = StaticSeat {
        name: None,
        mount: Mount::at_centre(0),
        nominal: Pose::identity(),
        bore: search.bore(),
        penalty: search.penalty(),
        fit: *fit,
    };
    let assembly = StaticAssembly {
        bodies: vec![StaticBody { name: "the outer race".into(), place }],
        seats: vec![seat],
        ..StaticAssembly::default()
    };
    let [y, z, tilt_y, tilt_z] = search.pose();
    let near = [SVector::from([0.0, y, z, tilt_y, tilt_z])];
    let bores = std::slice::from_mut(search);
    let mut solution = solve_assembly_in(&assembly, bores, Some(&near), &StaticOptions::default())?;
    Ok(solution.seats.remove(0))
}

/// Loads of a race on its bore: under a force in directions all round, with and without moments, under a pure moment
/// about axes all round, and as at the start of a run, rotated all round; and their differences from those of the fit
/// alone, which move the race in a tight fit.
///
/// # Errors
///
/// A bore that does not hold the race.
pub fn pressed(
    bore: &CondensedBore,
    penalty: Penalty,
    fit: &Fit,
    hardest: &LargestLoads,
) -> Result<LoadPatterns, StaticsError> {
    let mut search = BoreSearch::new(bore, penalty);
    let alone = race_under_load(&mut search, fit, &RaceLoad::default())?.loads;
    let mut others = Vec::with_capacity(2 * (LEVERS.len() + 3) * DIRECTIONS);
    let mut add = |load: &RaceLoad| -> Result<(), StaticsError> {
        let loads = race_under_load(&mut search, fit, load)?.loads;
        others.push(loads.iter().zip(&alone).map(|(p, alone)| p - alone).collect());
        others.push(loads);
        Ok(())
    };
    for i in 0..DIRECTIONS {
        let (sin, cos) = libm::sincos(TAU * i as f64 / DIRECTIONS as f64);
        let across = |[y, z]: [f64; 2]| [0.0, y * cos - z * sin, y * sin + z * cos];
        let force = across([hardest.force, 0.0]);
        add(&RaceLoad { force, moment: [0.0; 3] })?;
        let levered = LEVERS.map(|lever| {
            let moment = cross([lever * bore.reach.width, 0.0, 0.0], force);
            RaceLoad { force, moment }
        });
        let turned = RaceLoad { force: [0.0; 3], moment: across([hardest.moment, 0.0]) };
        let turned = (hardest.moment > 0.0).then_some(turned);
        let start = hardest.start.map(|start| {
            let [y, z, about_y, about_z] = start.load;
            RaceLoad { force: across([y, z]), moment: across([about_y, about_z]) }
        });
        for load in levered.iter().chain(&turned).chain(&start) {
            // A race on its rim, or loose under a moment, may have no equilibrium: other samples cover it.
            let _ = add(load);
        }
    }
    let mut own = closed(bore, penalty).map_err(|error| in_bore(error.into()))?;
    own.extend(hardest.start.map(|start| start.loads.clone()));
    Ok(LoadPatterns { own, others })
}

/// Loads in full contact: solutions of (C + 1/k) p = g for 1 m or 1 rad of each coordinate of the race, and for 1 m of
/// growth.
fn closed(bore: &CondensedBore, penalty: Penalty) -> Result<Vec<Vec<f64>>, FactorError> {
    let moved = (0..4).flat_map(|axis| bore.nodes.iter().map(move |node| lever(node)[axis]));
    let mut all: Vec<f64> = moved.chain(bore.nodes.iter().map(|_| 1.0)).collect();
    all_touching(bore, penalty)?.solve_columns(&mut all, 5);
    Ok(all.chunks_exact(bore.nodes.len()).map(<[f64]>::to_vec).collect())
}

/// C + 1/k with C the compliance of the bore and k its contact: the compliance of all nodes in contact.
fn all_touching(bore: &CondensedBore, penalty: Penalty) -> Result<DenseFactor, FactorError> {
    let everyone: Vec<usize> = (0..bore.nodes.len()).collect();
    let softness = bore.nodes.iter().map(|node| 1.0 / penalty.of_node(node.area));
    bore.compliance.factor(&everyone, &softness.collect::<Vec<_>>())
}

/// Forces on the race by natural modes (frequency in rad/s, outward displacements) up to a frequency.
fn ringing(
    bore: &CondensedBore,
    penalty: Penalty,
    shapes: &[(f64, Vec<f64>)],
    below: f64,
) -> Result<Vec<Vec<f64>>, FactorError> {
    let mut all: Vec<f64> = Vec::new();
    for (_, shape) in shapes.iter().filter(|(frequency, _)| *frequency <= below) {
        all.extend(shape);
    }
    let nodes = bore.nodes.len();
    let count = all.len() / nodes;
    if count > 0 {
        all_touching(bore, penalty)?.solve_columns(&mut all, count);
    }
    Ok(all.chunks_exact(nodes).map(<[f64]>::to_vec).collect())
}

/// Natural modes up to this fraction of the highest have corrections for their forces on the race: by default those up
/// to the frequency of a ball. Without them a tight bore is too stiff against these modes, an error of 1 % in an
/// impact.
const RINGING: f64 = 0.5;

/// Fraction of the largest energy below which a combination of responses is rounding of the others.
pub(crate) const NOTHING_NEW: f64 = 1e-10;

/// Patterns of force on the bore with static correction modes.
pub(crate) struct Patterns {
    pub vectors: Vec<Vec<f64>>,
    pub left_out: f64,
    pub by_patterns: f64,
}

/// A load and its displacement of the bore nodes beyond natural modes, m.
#[derive(Clone)]
struct Pattern {
    load: Vec<f64>,
    moved: Vec<f64>,
}

fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl Pattern {
    fn energy(&self) -> f64 {
        inner(&self.load, &self.moved)
    }

    fn add_scaled(&mut self, factor: f64, other: &Pattern) {
        self.load.iter_mut().zip(&other.load).for_each(|(to, p)| *to += factor * p);
        self.moved.iter_mut().zip(&other.moved).for_each(|(to, u)| *to += factor * u);
    }

    /// `None` if it is rounding of others.
    fn of_unit_energy(mut self) -> Option<Pattern> {
        let energy = self.energy();
        if energy <= NOTHING_NEW {
            return None;
        }
        let unit = 1.0 / energy.sqrt();
        self.load.iter_mut().chain(&mut self.moved).for_each(|of| *of *= unit);
        Some(self)
    }

    /// Removes the components along others, of unit energy.
    fn beyond(mut self, others: &[Pattern]) -> Pattern {
        for other in others {
            self.add_scaled(-inner(&other.load, &self.moved), other);
        }
        self
    }
}

/// Patterns for the `own` loads, and for as many of the others and of the forces of natural modes as are needed for an
/// omitted compliance of at most `tolerance` under any of them: in each turn the load with the largest omitted part,
/// relative to its whole compliance.
pub(crate) fn patterns(
    bore: &CondensedBore,
    penalty: Penalty,
    natural: &[(f64, Vec<Vec3>)],
    loads: &LoadPatterns,
    tolerance: f64,
    at_bore: impl Fn(&[Vec3]) -> Vec<f64>,
) -> Result<Patterns, FactorError> {
    let everyone: Vec<usize> = (0..bore.nodes.len()).collect();
    let shapes: Vec<(f64, Vec<f64>)> =
        natural.iter().map(|(frequency, shape)| (*frequency, at_bore(shape))).collect();
    // Of unit compliance with contact; `None` without compliance.
    let pattern = |load: &Vec<f64>| -> Option<Pattern> {
        let mut moved = vec![0.0; load.len()];
        bore.compliance.add_product(&everyone, load, &mut moved);
        let springs = load.iter().zip(&bore.nodes).map(|(p, n)| p * p / penalty.of_node(n.area));
        let whole = inner(load, &moved) + springs.sum::<f64>();
        if whole <= 0.0 {
            return None;
        }
        for (frequency, shape) in &shapes {
            let share = inner(shape, load) / (frequency * frequency);
            moved.iter_mut().zip(shape).for_each(|(to, along)| *to -= share * along);
        }
        let unit = 1.0 / whole.sqrt();
        let of_unit = |of: &[f64]| of.iter().map(|p| unit * p).collect();
        Some(Pattern { load: of_unit(load), moved: of_unit(&moved) })
    };
    let mut by_patterns = 0.0f64;
    let mut found = |loads: &[Vec<f64>]| -> Vec<Pattern> {
        let found: Vec<Pattern> = loads.iter().filter_map(pattern).collect();
        by_patterns = found.iter().map(Pattern::energy).fold(by_patterns, f64::max);
        found
    };
    let (own, mut rest) = (found(&loads.own), found(&loads.others));
    let ringing = match shapes.last() {
        Some((highest, _)) => ringing(bore, penalty, &shapes, RINGING * highest)?,
        None => Vec::new(),
    };
    rest.extend(found(&ringing));
    let mut kept: Vec<Pattern> = Vec::new();
    for new in own {
        kept.extend(new.beyond(&kept).of_unit_energy());
    }
    rest = rest.into_iter().map(|pattern| pattern.beyond(&kept)).collect();
    // The least represented load is next.
    let least = |rest: &[Pattern]| {
        let left = rest.iter().map(Pattern::energy).enumerate();
        left.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0))
    };
    let (mut next, mut left_out) = least(&rest);
    while left_out > tolerance {
        let Some(new) = rest.swap_remove(next).of_unit_energy() else { break };
        kept.push(new);
        let last = &kept[kept.len() - 1..];
        rest = rest.into_iter().map(|pattern| pattern.beyond(last)).collect();
        (next, left_out) = least(&rest);
    }
    let vectors = kept.into_iter().map(|pattern| pattern.load).collect();
    Ok(Patterns { vectors, left_out, by_patterns: by_patterns - left_out })
}
