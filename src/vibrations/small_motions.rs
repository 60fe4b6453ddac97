//! Small motions of an assembly about its equilibrium, with rotating bodies. The stiffness is that of the equilibrium
//! search, without finite differences.
//!
//! Balls are massless springs; a housing contributes the displacement that follows its race, and its modes with the
//! race fixed ([`crate::reduction::fixed_interface_modes`]). Axes do not rotate with the bodies, which are axisymmetric:
//! M, C, G and K are constant. At spin Ω about X a body of axial inertia J has moments J Ω against the rates of its
//! tilts; its modes have those of [`crate::members::flexible_shaft`]. Dashpots and Maxwell elements whose first end is
//! on a rotating body rotate with it, and feed whirl above the critical speed as internal damping does.

use crate::assembly::lists::Assembly;
use crate::equilibrium::connection::{
    add_circulation, add_circulatory, add_damping, levers, spin_of,
};
use crate::equilibrium::lists::{Place, StaticAssembly};
use crate::equilibrium::model::{Evaluation, Model};
use crate::equilibrium::quasi_static_limit::{
    HousingMass, Mode, MovingBody, add_housings, modes, with_housings,
};
use crate::equilibrium::shaft::{Moved, onto_unknowns, rows_onto_unknowns, sections};
use crate::equilibrium::statics::AssemblySolution;
use crate::members::beam::STATION;
use crate::members::body::{Body, Rotation};
use crate::members::connection::{Connection, MaxwellElement};
use crate::members::flexible_shaft::ElasticShaft;
use crate::vibrations::critical_speeds::Critical;
use crate::vibrations::relaxing::{Relaxing, settled};
use crate::vibrations::rotor::{LinearSystem, RotorError, RotorModel};
use nalgebra::{DMatrix, DVector};
use std::convert::Infallible;

/// Number of modes kept, without static corrections for damping: with two bearings on a shaft all that whirl below some
/// kHz.
const MODES: usize = 36;

/// The linear system, and the names of its stations.
pub struct SmallMotionModel {
    pub model: RotorModel,
    /// Bodies, then sections of flexible bodies, in the order of the model's stations.
    pub places: Vec<String>,
    /// Largest prescribed speed of a body (rad/s); the other bodies rotate at a fixed ratio to it.
    pub top_speed: f64,
    /// Name of its body; `None` if all rotate at that speed.
    pub fastest: Option<String>,
}

/// Prescribed speed after all changes, rad/s.
fn final_speed(assembly: &Assembly, body: &Body) -> f64 {
    let last = assembly.corners().last().copied().unwrap_or(0.0);
    match body.driven().map(|race| &race.rotation) {
        Some(Rotation::Speed(profile)) => {
            profile.value(profile.corners().last().copied().unwrap_or(last).max(last))
        }
        Some(Rotation::Torque(_)) | None => 0.0,
    }
}

/// Small motions about `found`, the equilibrium of `still`; bodies in the order of its unknowns.
///
/// # Errors
///
/// Nothing that moves; a body without mass; an unstable equilibrium; rotating springs that differ along Y and Z.
pub fn whirling(
    assembly: &Assembly,
    still: &StaticAssembly,
    found: &AssemblySolution,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> Result<SmallMotionModel, RotorError> {
    let speeds: Vec<f64> = assembly.bodies.iter().map(|body| final_speed(assembly, body)).collect();
    let fastest = (1..speeds.len())
        .fold(0, |top, body| if speeds[body].abs() > speeds[top].abs() { body } else { top });
    let top_speed = speeds.get(fastest).copied().unwrap_or(0.0);
    let ratio = |body: usize| if top_speed == 0.0 { 0.0 } else { speeds[body] / top_speed };
    let one_speed = speeds.iter().all(|speed| *speed == 0.0 || *speed == top_speed);
    let named = (!one_speed).then(|| assembly.bodies[fastest].name.clone());
    let model = Model::new(still);
    let known = model.scale.len();
    let here = placed(&model, found);
    let moved = sections(&model, &here.at);
    let [stiffness, mass] = with_housings(&found.with_shapes, bodies, housings);
    let size = mass.nrows();
    let mut all = LinearSystem {
        stiffness,
        damping: DMatrix::zeros(size, size),
        gyroscopic: DMatrix::zeros(size, size),
        circulating: DMatrix::zeros(size, size),
        pairs: Vec::new(),
        relaxing: Vec::new(),
        free: (0..size).filter(|&i| i >= 5 * bodies.len() || bodies[i / 5].free[i % 5]).collect(),
        mass,
    };
    for (index, of) in bodies.iter().enumerate() {
        let first = 5 * index;
        all.pairs.extend([[first + 1, first + 2], [first + 3, first + 4]]);
        let body = &assembly.bodies[of.body];
        let spin = ratio(of.body) * of.inertia.axial;
        all.gyroscopic[(first + 3, first + 4)] += spin;
        all.gyroscopic[(first + 4, first + 3)] -= spin;
        if let Some(race) = body.driven() {
            for (i, damping) in race.foundation_damping.iter().enumerate() {
                all.damping[(first + i, first + i)] += damping;
            }
        }
    }
    for ((_, first), shaft) in model.shafts().zip(&assembly.shafts) {
        let body = bodies.iter().position(|of| of.body == shaft.body);
        bending(&mut all, shaft, (body.map(|body| 5 * body), first), ratio(shaft.body));
    }
    // The model's connections are between sections of flexible bodies; the assembly's name the body that rotates.
    // Equilibria are without circulatory forces.
    let whole: Vec<Connection> = assembly
        .connections
        .iter()
        .zip(&model.assembly.connections)
        .map(|(own, placed)| Connection { law: own.law.clone(), ..placed.clone() })
        .collect();
    let spins = assembly.connections.iter().map(|of| ratio(of.ends[0].body));
    let spins: Vec<(&Connection, f64)> = whole.iter().zip(spins).collect();
    if let Some((uneven, _)) = spins.iter().find(|(of, spin)| *spin != 0.0 && of.is_uneven()) {
        return Err(RotorError::Uneven { name: uneven.name.clone() });
    }
    let of_springs = over_unknowns(&model, &here, &moved, |here| {
        spins.iter().for_each(|(of, _)| add_damping(&model, of, here));
    });
    let mut known_part = all.damping.view_mut((0, 0), (known, known));
    known_part += of_springs;
    add_housings(&mut all.damping, known, housings, |of| of.damping);
    let of_springs = over_unknowns(&model, &here, &moved, |here| {
        spins.iter().for_each(|(of, _)| add_circulatory(&model, of, here));
    });
    let mut known_part = all.stiffness.view_mut((0, 0), (known, known));
    known_part += of_springs;
    let of_springs = over_unknowns(&model, &here, &moved, |here| {
        spins.iter().for_each(|&(of, spin)| add_circulation(&model, of, spin, here));
    });
    let mut known_part = all.circulating.view_mut((0, 0), (known, known));
    known_part += of_springs;
    all.relaxing = relaxing(&model, &here, &moved, &spins);
    for of in &mut all.relaxing {
        of.levers = of.levers.clone().resize_horizontally(size, 0.0);
    }
    let (places, rows) = station_rows(&model, still, &moved);
    let rows = rows.resize_horizontally(size, 0.0);
    let stations: Vec<f64> = (0..places.len()).map(|place| place as f64).collect();
    let model = RotorModel::of(&all, MODES, stations, Some(&rows))?;
    Ok(SmallMotionModel { model, places, top_speed, fastest: named })
}

impl SmallMotionModel {
    /// See [`RotorModel::critical_speeds_up_to`], rad/s.
    ///
    /// # Errors
    ///
    /// The same.
    pub fn critical_speeds(&self, limit: f64) -> Result<Vec<Critical>, RotorError> {
        match self.model.relaxing.is_empty() {
            true => self.model.critical_speeds(),
            false => self.model.critical_speeds_up_to(limit),
        }
    }
}

/// Undamped natural modes at rest, lowest first. Each has the storage stiffness of the Maxwell elements at its own
/// frequency, found from above, starting with unrelaxed springs.
pub fn natural_modes(
    still: &StaticAssembly,
    found: &AssemblySolution,
    bodies: &[MovingBody],
    housings: &[HousingMass],
) -> Vec<Mode> {
    let model = Model::new(still);
    let here = placed(&model, found);
    let moved = sections(&model, &here.at);
    let standing: Vec<(&Connection, f64)> =
        model.assembly.connections.iter().map(|of| (of, 0.0)).collect();
    let elements = relaxing(&model, &here, &moved, &standing);
    let with = |frequency: f64| {
        let mut stiffness = found.with_shapes.clone();
        elements.iter().for_each(|of| stiffness += of.storage(frequency));
        modes(&stiffness, bodies, housings)
    };
    let mut all = with(f64::INFINITY);
    if elements.is_empty() {
        return all;
    }
    let mut last: Vec<Mode> = Vec::new();
    let rigid = RIGID * all.last().map_or(0.0, |fastest| fastest.square);
    let moving = all.iter_mut().enumerate().filter(|(_, mode)| mode.square > rigid);
    for (number, mode) in moving {
        // One of a pair of equal frequency (along Y and Z, say) is found with the other.
        let slower = last.get(number.wrapping_sub(1)).zip(last.get(number));
        if let Some((one, other)) = slower
            && other.square - one.square <= PAIR * one.square
        {
            *mode = other.clone();
            continue;
        }
        let value = |square: f64| -> Result<f64, Infallible> {
            last = with(square.sqrt());
            Ok(last[number].square)
        };
        let Ok(square) = settled(mode.square.max(0.0), value);
        *mode = last[number].clone();
        if square.is_none() {
            // Relaxed, the mode has no stiffness.
            mode.square = 0.0;
            last.clear();
        }
    }
    all.sort_by(|a, b| a.square.total_cmp(&b.square));
    all
}

/// Squared frequencies below this fraction of the largest are zero but for rounding.
const RIGID: f64 = 1e-14;
/// Squared frequencies closer than this fraction are a pair.
const PAIR: f64 = 1e-8;

/// Maxwell elements over the unknowns.
fn relaxing(
    model: &Model,
    here: &Evaluation,
    moved: &[Moved],
    spins: &[(&Connection, f64)],
) -> Vec<Relaxing> {
    let of = |&(of, spin): &(&Connection, f64)| {
        let elements = of.maxwell();
        let levers = (!elements.is_empty())
            .then(|| rows_onto_unknowns(model, moved, levers(model, of, here)));
        let spin = if spin == 0.0 { 0.0 } else { spin_of(model, of, spin, here) };
        let element = |element: &MaxwellElement| Relaxing {
            levers: levers.clone().unwrap_or_default(),
            stiffness: element.stiffness,
            relaxation_time: element.relaxation_time,
            spin,
        };
        elements.iter().map(element).collect::<Vec<_>>()
    };
    spins.iter().flat_map(of).collect()
}

/// All positions of an equilibrium.
fn placed(model: &Model, found: &AssemblySolution) -> Evaluation {
    let mut at = DVector::zeros(model.scale.len());
    for (body, first, _) in model.loaded() {
        at.fixed_rows_mut::<5>(first).copy_from(&found.coordinates[body]);
    }
    for ((_, first), amplitudes) in model.shafts().zip(&found.amplitudes) {
        at.rows_mut(first, amplitudes.len()).copy_from_slice(amplitudes);
    }
    model.follow(&mut at);
    let count = model.coordinates;
    Evaluation {
        at,
        gradient: DVector::zeros(count),
        stiffness: DMatrix::zeros(count, count),
        ..Evaluation::default()
    }
}

/// Adds gyroscopic moments and damping of a shaft's modes.
fn bending(
    all: &mut LinearSystem,
    shaft: &ElasticShaft,
    (body, first): (Option<usize>, usize),
    ratio: f64,
) {
    let count = shaft.count();
    for k in 0..count {
        let (a, b) = (first + k, first + count + k);
        all.pairs.push([a, b]);
        for l in 0..count {
            let turns = ratio * shaft.shapes.gyroscopic[k * count + l];
            all.gyroscopic[(a, first + count + l)] += turns;
            all.gyroscopic[(b, first + l)] -= turns;
        }
        if let Some(body) = body {
            let tilts = ratio * shaft.shapes.tilt_coupling[k];
            for (shape, tilt) in [(a, body + 3), (b, body + 4)] {
                all.gyroscopic[(shape, tilt)] -= tilts;
                all.gyroscopic[(tilt, shape)] += tilts;
            }
        }
        // −c (q̇ − Ω × q).
        all.circulating[(a, b)] += ratio * shaft.internal_damping;
        all.circulating[(b, a)] -= ratio * shaft.internal_damping;
    }
    for i in first..first + shaft.amplitudes() {
        all.damping[(i, i)] += shaft.damping + shaft.internal_damping;
    }
}

/// Projects a sum over bodies and sections onto the unknowns.
fn over_unknowns(
    model: &Model,
    here: &Evaluation,
    moved: &[Moved],
    add: impl Fn(&mut Evaluation),
) -> DMatrix<f64> {
    let mut here = here.clone();
    add(&mut here);
    onto_unknowns(model, moved, &mut here);
    here.stiffness
}

/// Names of loaded bodies and of sections, and their y, z and tilts per unit of every unknown.
fn station_rows(
    model: &Model,
    still: &StaticAssembly,
    moved: &[Moved],
) -> (Vec<String>, DMatrix<f64>) {
    let size = model.scale.len();
    let mut places = Vec::new();
    let mut rows: Vec<DMatrix<f64>> = Vec::new();
    for (body, first, _) in model.loaded() {
        places.push(still.bodies[body].name.clone());
        rows.push(DMatrix::from_fn(STATION, size, |i, j| f64::from(j == first + 1 + i)));
    }
    let sections = still.bodies.iter().filter(|body| matches!(body.place, Place::Section(_)));
    for (body, moved) in sections.zip(moved) {
        places.push(body.name.clone());
        let mut row = DMatrix::zeros(STATION, size);
        for &(column, to) in &moved.columns {
            for i in 0..STATION {
                row[(i, to)] = moved.motion[(1 + i, column)];
            }
        }
        rows.push(row);
    }
    let whole =
        DMatrix::from_fn(STATION * rows.len(), size, |i, j| rows[i / STATION][(i % STATION, j)]);
    (places, whole)
}
