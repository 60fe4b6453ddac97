//! The equilibrium search: Newton's method with a trust radius on the energy, over the coordinates of all loaded
//! bodies. Balls are in equilibrium at every evaluation.
//!
//! Each bearing, connection, shaft and housing fit adds energy, force and stiffness over the coordinates of its bodies,
//! with its own unknowns eliminated: balls in equilibrium, bore nodes in contact or not.

use crate::equilibrium::bearing::add_bearing;
use crate::equilibrium::connection::add_connection;
use crate::equilibrium::housing_fit::add_seat;
use crate::equilibrium::lists::{Loaded, Place, StaticAssembly, StaticBearing};
use crate::equilibrium::model::{Evaluation, Five, Model};
use crate::equilibrium::shaft::{add_curvature, add_shaft, onto_unknowns, sections};
use crate::equilibrium::start;
use crate::equilibrium::statics::{StaticOptions, StaticsError};
use crate::members::connection::Connection;
use crate::members::static_ball::energy_noise;
use crate::plan::Stage;
use crate::plan::counts::StageCounts;
use crate::solids::bore_equilibrium::BoreSearch;
use nalgebra::{DMatrix, DVector, Vector3};

/// First trust radius without bearings, m; it grows by itself.
const WITHOUT_BEARING: f64 = 1e-4;

/// Artificial stiffness of a body in a bore, as a fraction of its largest stiffness: a race without contact, or in
/// contact with one row of nodes, keeps its position in directions without support. Its force vanishes in equilibrium.
const HINT: f64 = 1e-8;

/// A residual up to this many times the tolerance may be rounding error.
const ROUNDED: f64 = 1e2;

/// Fraction of the first trust radius within which the search steps across a change of contact nodes.
const NEAR: f64 = 1e-2;

/// Smallest step, as a fraction of the first trust radius.
const LEAST: f64 = 1e-6;

/// Gradient and stiffness over metres, as [`Search::scaled`] gives them.
pub(crate) struct Scaled {
    gradient: DVector<f64>,
    pub(crate) stiffness: DMatrix<f64>,
}

impl Scaled {
    /// Change of the energy in the quadratic model for a step in metres, J.
    fn change(&self, step: &DVector<f64>) -> f64 {
        self.gradient.dot(step) + 0.5 * step.dot(&(&self.stiffness * step))
    }
}

pub(crate) struct Search<'a, 'b> {
    pub(crate) model: &'a Model<'a>,
    options: &'a StaticOptions,
    /// Contact in the bore of each housing fit.
    pub(crate) bores: &'a mut [BoreSearch<'b>],
    pub(crate) loads: DVector<f64>,
    pub(crate) free: Vec<bool>,
    /// Unknown, stiffness and unloaded position of each spring to the ground.
    pub(crate) springs: Vec<(usize, f64, f64)>,
    pub(crate) saddles_left: usize,
    pub(crate) iterations: usize,
    pub(crate) contact_evaluations: usize,
    /// Number of runs of each stage.
    pub(crate) ran: StageCounts,
    spare: Option<Evaluation>,
}

impl<'a, 'b> Search<'a, 'b> {
    pub(crate) fn new(
        model: &'a Model<'a>,
        options: &'a StaticOptions,
        bores: &'a mut [BoreSearch<'b>],
    ) -> Self {
        let count = model.scale.len();
        let mut loads = DVector::zeros(count);
        let mut free = vec![false; count];
        let mut springs = Vec::new();
        for (_, first, body) in model.loaded() {
            for i in 0..5 {
                if body.prescribed(i).is_none() {
                    loads[first + i] = body.load(i);
                    free[first + i] = true;
                }
                if body.springs[i] != 0.0 {
                    springs.push((first + i, body.springs[i], body.rest[i]));
                }
            }
        }
        for (shaft, first) in model.shafts() {
            free[first..first + shaft.springs.len()].fill(true);
            loads.rows_mut(first, shaft.loads.len()).copy_from_slice(&shaft.loads);
        }
        Search {
            model,
            options,
            bores,
            loads,
            free,
            springs,
            saddles_left: 0,
            iterations: 0,
            contact_evaluations: 0,
            ran: StageCounts::new(
                model.assembly.bearings.len(),
                model.assembly.bodies.len(),
                model.assembly.seats.len(),
                model.assembly.seats.len(),
            ),
            spare: None,
        }
    }

    /// Start of the search.
    pub(crate) fn start(&self) -> DVector<f64> {
        let mut at = DVector::zeros(self.free.len());
        for (index, first, body) in self.model.loaded() {
            let start = match body.start {
                Some(start) => Five::from(start),
                None => self.guess(index, body),
            };
            at.fixed_rows_mut::<5>(first).copy_from(&start);
        }
        for (shaft, first) in self.model.shafts() {
            at.rows_mut(first, shaft.start.len()).copy_from_slice(&shaft.start);
        }
        self.impose(&mut at);
        at
    }

    /// Coordinates after a change of the unknowns.
    pub(crate) fn moved(&self, from: &DVector<f64>, by: &DVector<f64>) -> DVector<f64> {
        let mut at = from.clone();
        let mut unknowns = at.rows_mut(0, by.len());
        unknowns += by;
        at
    }

    /// The same for a step in metres.
    fn stepped(&self, from: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        self.moved(from, &step.component_div(&self.model.scale))
    }

    /// Largest stiffness against one coordinate of a body, or a displacement of a section, N/m.
    fn stiffest(&self, here: &Evaluation) -> f64 {
        let of_bodies = (0..self.model.bodies_end())
            .map(|i| here.stiffness[(i, i)] / self.model.scale[i].powi(2));
        let behind = self.free.len()..self.model.coordinates;
        let of_sections = behind.step_by(5).flat_map(|first| first..first + 3);
        let of_sections = of_sections.map(|i| here.stiffness[(i, i)]);
        of_bodies.chain(of_sections).fold(0.0, f64::max)
    }

    /// Sets prescribed coordinates to their values.
    pub(crate) fn impose(&self, at: &mut DVector<f64>) {
        for (_, first, body) in self.model.loaded() {
            for i in 0..5 {
                if let Some(value) = body.prescribed(i) {
                    at[first + i] = value;
                }
            }
        }
    }

    /// Estimated position of a body with one inner race and a fixed outer race.
    fn guess(&self, body: usize, loaded: &Loaded) -> Five {
        let on_it = |bearing: &&StaticBearing| bearing.mounts[0].body == body;
        let bearing = self.model.assembly.bearings.iter().find(on_it);
        let Some(bearing) = bearing else { return Five::zeros() };
        let outer = &self.model.assembly.bodies[bearing.mounts[1].body].place;
        let origin = match outer {
            Place::Fixed(pose) => loaded.axes().point_to_body(&pose.position),
            Place::Loaded(under) => {
                let [x, y, z, ..] = under.start.unwrap_or([0.0; 5]);
                let there = under.axes().point_to_parent(&Vector3::new(x, y, z));
                loaded.axes().point_to_body(&there)
            }
            Place::Section(_) => return Five::zeros(),
        };
        let loads = [0, 1, 2, 3, 4].map(|i| loaded.load(i));
        start::guess(&bearing.geometry, &bearing.contacts(), &loads, &origin)
    }

    /// # Errors
    ///
    /// Contact in a bore that does not converge.
    pub(crate) fn evaluate(&mut self, at: &DVector<f64>) -> Result<Evaluation, StaticsError> {
        let (unknowns, count) = (self.free.len(), self.model.coordinates);
        let bearings = self.model.bearings.len();
        let mut here = self.spare.take().unwrap_or_else(|| Evaluation {
            gradient: DVector::zeros(count),
            stiffness: DMatrix::zeros(count, count),
            balls: vec![Vec::new(); bearings],
            planes: vec![Vec::new(); bearings],
            ..Evaluation::default()
        });
        here.at.clone_from(at);
        self.model.follow(&mut here.at);
        here.energy = -self.loads.dot(&here.at.rows(0, unknowns));
        if count == unknowns {
            here.gradient.copy_from(&self.loads);
        } else {
            here.gradient.resize_vertically_mut(count, 0.0);
            here.gradient.rows_mut(0, unknowns).copy_from(&self.loads);
            here.stiffness.resize_mut(count, count, 0.0);
            self.load_sections(&mut here);
        }
        here.gradient.neg_mut();
        here.stiffness.fill(0.0);
        here.largest_ball_load = 0.0;
        here.seat_noise = 0.0;
        here.without_energy = 0.0;
        let steps = &self.model.steps;
        let springs: &[_] = if steps.foundation { &self.springs } else { &[] };
        for &(i, spring, rest) in springs {
            let stretch = at[i] - rest;
            here.energy += 0.5 * spring * stretch * stretch;
            here.gradient[i] += spring * stretch;
            here.stiffness[(i, i)] += spring;
            self.ran.whole.add(Stage::Foundation, 1);
        }
        for index in 0..bearings {
            let own = &mut self.ran.bearings[index];
            add_bearing(self.model, index, &mut here, &mut self.contact_evaluations, own);
        }
        let connections: &[_] = if steps.springs { &self.model.assembly.connections } else { &[] };
        for connection in connections {
            add_connection(self.model, connection, &mut here);
            self.ran.whole.add(Stage::Springs, 1);
        }
        for (shaft, first) in self.model.shafts() {
            add_shaft(shaft, first, &mut here);
            self.ran.whole.add(Stage::Springs, 1);
        }
        here.stiffest = self.stiffest(&here);
        for (index, bore) in self.bores.iter_mut().enumerate().filter(|(i, _)| steps.seats[*i]) {
            add_seat(self.model, index, bore, &mut here)?;
            self.ran.seats[index].add(Stage::Seat, 1);
            self.ran.solids[index].add(Stage::QuasiStatic, 1);
        }
        if self.model.coordinates > unknowns {
            let moved = sections(self.model, &here.at);
            add_curvature(&moved, &mut here);
            onto_unknowns(self.model, &moved, &mut here);
        }
        self.ran.whole.add(Stage::Evaluation, 1);
        Ok(here)
    }

    /// Work and gradient (without its sign) of loads on sections.
    fn load_sections(&self, here: &mut Evaluation) {
        for (first, loads) in self.model.section_loads() {
            let loads = Five::from(*loads);
            here.energy -= loads.dot(&here.at.fixed_rows::<5>(first));
            here.gradient.fixed_rows_mut::<5>(first).copy_from(&loads);
        }
    }

    /// Sum of the magnitudes of the loads' work from the origin of the coordinates, J.
    fn worked(&self, of: &Evaluation) -> f64 {
        let unknowns = self.loads.iter().zip(of.at.iter());
        let sections = self.model.section_loads().flat_map(|(first, loads)| {
            loads.iter().enumerate().map(move |(i, load)| load * of.at[first + i])
        });
        let sections: f64 = sections.map(f64::abs).sum();
        unknowns.map(|(load, at)| (load * at).abs()).sum::<f64>() + sections
    }

    /// Largest load residual over the free coordinates, N.
    pub(crate) fn residual(&self, here: &Evaluation) -> f64 {
        (0..self.free.len())
            .filter(|&i| self.free[i])
            .map(|i| (here.gradient[i] / self.model.scale[i]).abs())
            .fold(0.0, f64::max)
    }

    /// Largest pitch radius, or distance of a section from its body's centre, m.
    fn lever(&self) -> f64 {
        let StaticAssembly { bearings, bodies, .. } = self.model.assembly;
        let along = bodies.iter().filter_map(|body| match &body.place {
            Place::Section(of) => Some(of.section.along.abs()),
            _ => None,
        });
        let pitch = bearings.iter().map(|bearing| bearing.geometry.pitch_radius);
        pitch.chain(along).fold(0.0, f64::max)
    }

    /// Largest load, N.
    pub(crate) fn applied(&self) -> f64 {
        // Moments on sections over a metre.
        let on_sections = self.model.section_loads().flat_map(|(_, loads)| *loads);
        let largest = self.loads.component_div(&self.model.scale).amax();
        on_sections.fold(largest, |most, load| most.max(load.abs()))
    }

    /// Residual at which to stop, N.
    fn allowed(&self, here: &Evaluation) -> f64 {
        let applied = self.applied();
        // Rounding of positions (some ulps of the pitch radius) times the stiffness remains.
        let noise = 8.0 * f64::EPSILON * self.lever() * here.stiffest + here.seat_noise;
        self.options.tolerance * applied.max(here.largest_ball_load) + noise
    }

    /// Rounding of the energy, J.
    fn noise(&self, load: f64) -> f64 {
        let bearings = self.model.assembly.bearings.iter();
        bearings
            .map(|bearing| {
                let geometry = &bearing.geometry;
                energy_noise(load, geometry.pitch_radius) * geometry.ball_count as f64
            })
            .sum()
    }

    /// First trust radius, m.
    pub(crate) fn step_scale(&self) -> f64 {
        let largest = |coordinates: std::ops::Range<usize>| {
            self.model
                .loaded()
                .flat_map(|(_, _, body)| coordinates.clone().map(|i| body.load(i).abs()))
                .chain(
                    self.model
                        .section_loads()
                        .flat_map(|(_, loads)| coordinates.clone().map(|i| loads[i].abs())),
                )
                .fold(0.0, f64::max)
        };
        let (force, moment) = (largest(0..3), largest(3..5));
        let bearings = self.model.assembly.bearings.iter().zip(&self.model.bearings);
        if self.model.bearings.is_empty() {
            return WITHOUT_BEARING;
        }
        bearings
            .map(|(bearing, of)| start::step_scale(&bearing.geometry, &of.contacts, force, moment))
            .fold(0.0, f64::max)
    }

    /// Newton's method with a trust radius on the energy.
    pub(crate) fn descend(&mut self, here: &mut Evaluation) -> Result<(), StaticsError> {
        let mut radius = self.step_scale();
        let begun = self.iterations;
        loop {
            self.ran.whole.add(Stage::Equilibrium, 1);
            let residual = self.residual(here);
            let allowed = self.allowed(here);
            if residual <= allowed {
                // A solution found again stays the same to the bit.
                return if self.iterations > begun { self.polish(here, residual) } else { Ok(()) };
            }
            if self.iterations >= self.options.max_iterations {
                return self.give_up(here, residual, allowed);
            }
            self.iterations += 1;
            let scaled = self.scaled(here);
            let step = self.newton_step(&scaled, radius);
            let there = self.evaluate(&self.stepped(&here.at, &step))?;
            let predicted = scaled.change(&step);
            let change = there.energy - here.energy;
            // Near the end rounding dominates the change of energy, and the residual decides alone.
            let mut noise = self.noise(here.largest_ball_load.max(there.largest_ball_load));
            let assembly = self.model.assembly;
            let springs = !(assembly.connections.is_empty() && assembly.shafts.is_empty());
            if springs || !assembly.seats.is_empty() {
                // Springs may have far more energy than contacts, nearly cancelled by the loads' work.
                let size = |of: &Evaluation| of.energy.abs() + 2.0 * self.worked(of);
                noise += 16.0 * f64::EPSILON * size(here).max(size(&there));
            }
            noise += here.without_energy * step.norm();
            let quieter = self.residual(&there) < residual;
            let rounded = residual <= ROUNDED * allowed;
            // A residual that grows while the energy falls less than its rounding: a change as predicted is real.
            let falls =
                !rounded && change < 0.0 && (change - predicted).abs() <= 0.5 * predicted.abs();
            let accepted =
                change < (1e-4 * predicted).min(-noise) || (change <= noise && quieter) || falls;
            if accepted {
                if change < 0.75 * predicted && step.norm() > 0.9 * radius {
                    radius *= 3.0;
                }
                self.spare = Some(std::mem::replace(here, there));
                self.check_travel(here)?;
            } else {
                if !assembly.seats.is_empty() && step.norm() <= NEAR * self.step_scale() {
                    // A node coming into contact bends the gradient: beyond it the next Newton step returns to the
                    // minimum.
                    let next = self.newton_step(&self.scaled(&there), step.norm());
                    let beyond = self.evaluate(&self.stepped(&there.at, &next))?;
                    if beyond.energy - here.energy <= noise
                        && self.residual(&beyond) < 0.5 * residual
                    {
                        self.spare = Some(std::mem::replace(here, beyond));
                        continue;
                    }
                }
                self.spare = Some(there);
                if rounded && change.abs() <= noise {
                    // The residual is rounding.
                    return Ok(());
                }
                radius = 0.25 * radius.min(step.norm());
                if change.abs() <= noise
                    && radius <= LEAST * self.step_scale()
                    && self.is_falling(here)
                {
                    // At a saddle, which is left along its gradient: the residual grows on the way down.
                    return Ok(());
                }
            }
        }
    }

    /// # Errors
    ///
    /// A search that left a saddle and ended at another one.
    pub(crate) fn check_balance(&self, here: &Evaluation) -> Result<(), StaticsError> {
        let (residual, allowed) = (self.residual(here), self.allowed(here));
        if !self.model.steps.search || residual <= ROUNDED * allowed {
            return Ok(());
        }
        self.give_up(here, residual, allowed)
    }

    /// One more Newton step if several bearings support the bodies: rounding may leave soft coordinates (tilts of a
    /// race in its bore) far less accurate than the rest, and the error falls quadratically.
    fn polish(&mut self, here: &mut Evaluation, residual: f64) -> Result<(), StaticsError> {
        let StaticAssembly { bearings, connections, seats, shafts, .. } = self.model.assembly;
        let no_spring = connections.iter().all(Connection::is_void) && shafts.is_empty();
        let one_holds = bearings.len() <= 1 && no_spring && seats.is_empty();
        let strict = self.options.tolerance * self.applied().max(here.largest_ball_load);
        if one_holds || residual <= 1e-2 * strict {
            return Ok(());
        }
        let step = self.newton_step(&self.scaled(here), self.step_scale());
        let there = self.evaluate(&self.stepped(&here.at, &step))?;
        if self.residual(&there) < residual {
            *here = there;
        }
        Ok(())
    }

    /// Gradient and stiffness over metres (tilts times pitch radius); prescribed coordinates have a unit diagonal, so
    /// that their step is zero.
    pub(crate) fn scaled(&self, here: &Evaluation) -> Scaled {
        let mut gradient = here.gradient.component_div(&self.model.scale);
        let mut stiffness = here.stiffness.clone();
        let count = self.free.len();
        for i in 0..count {
            for j in 0..count {
                stiffness[(i, j)] /= self.model.scale[i] * self.model.scale[j];
                if !(self.free[i] && self.free[j]) {
                    stiffness[(i, j)] = 0.0;
                }
            }
            if !self.free[i] {
                gradient[i] = 0.0;
            }
        }
        Scaled { gradient, stiffness }
    }

    /// Step in metres: Newton's if the stiffness is positive definite, otherwise with the identity added as necessary;
    /// never longer than `radius`.
    fn newton_step(&self, scaled: &Scaled, radius: f64) -> DVector<f64> {
        let Scaled { gradient, stiffness } = scaled;
        // Bodies only: modes of high frequency are stiffer than any support.
        let largest = stiffness.diagonal().rows(0, self.model.bodies_end()).amax();
        let floor = if largest > 0.0 { largest } else { gradient.amax() / radius };
        let hints = self.hints(stiffness);
        let mut shift = 0.0;
        loop {
            let mut shifted = stiffness + &hints;
            for i in 0..self.free.len() {
                shifted[(i, i)] += if self.free[i] { shift } else { floor };
            }
            if let Some(factor) = shifted.cholesky() {
                let step = -factor.solve(gradient);
                let length = step.norm();
                if length.is_finite() {
                    return if length > radius { step * (radius / length) } else { step };
                }
            }
            shift = if shift == 0.0 { 1e-4 * floor } else { 4.0 * shift };
        }
    }

    /// Artificial stiffness of bodies in bores.
    fn hints(&self, stiffness: &DMatrix<f64>) -> DMatrix<f64> {
        let mut hints = DMatrix::zeros(stiffness.nrows(), stiffness.ncols());
        for (index, first, _) in self.model.loaded() {
            if self.model.seat_of(index).is_some() {
                let own = first..first + 5;
                let largest = own.clone().map(|i| stiffness[(i, i)]).fold(0.0, f64::max);
                own.for_each(|i| hints[(i, i)] = HINT * largest);
            }
        }
        hints
    }
}
