//! A bearing whose races move as the inputs say: balls and cage move by themselves.

use crate::variables::{INPUTS, OF_RACE, OUTPUTS, inputs};
use bearing_dynamics::assembly::lists::{Assembly, INNER, OUTER};
use bearing_dynamics::assembly::places::Places;
use bearing_dynamics::members::body::{
    Body, Drive, DrivenBody, Mobility, Rotation, prescribed_speed,
};
use bearing_dynamics::motion::checkpoint::Checkpoint;
use bearing_dynamics::motion::integrator_choice::choose;
use bearing_dynamics::motion::simulation::{RunOptions, Simulation, SimulationError};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::scene::build::motion::DynamicsError;
use bearing_dynamics::scene::{SceneError, Subject, read_subject};
use serde::{Deserialize, Serialize};
use std::path::Path;
use thiserror::Error;

#[derive(Debug, Error)]
pub enum ModelError {
    #[error(transparent)]
    Scene(#[from] SceneError),
    #[error(transparent)]
    Dynamics(#[from] DynamicsError),
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    #[error(
        "an FMU has one bearing between two rigid races; bodies, housings, sensors and flexible cages are not taken"
    )]
    OtherParts,
    #[error("numerics: missing; an FMU needs its step control, as a run does")]
    NoRun,
    #[error(
        "the communication step from {from} s is {step} s long; it must be positive and finite"
    )]
    Step { from: f64, step: f64 },
    #[error("the bearing is at {at} s; a step from {from} s needs the state of that time")]
    OtherTime { at: f64, from: f64 },
    #[error("before initialization there is nothing to compute")]
    NotStarted,
    #[error("{0} is not a value reference of this FMU that can be used here")]
    Reference(u32),
    #[error("input {name} is {value}; it must be finite")]
    Input { name: String, value: f64 },
    #[error("this is not a state of this FMU")]
    OtherState,
}

pub struct Model {
    /// The bearing with both races driven.
    assembly: Assembly,
    options: RunOptions,
    /// Values of the scene at t = 0.
    start_values: [f64; INPUTS],
    pub inputs: [f64; INPUTS],
    /// End of the scene's run and its output interval, s.
    pub experiment: [f64; 2],
    /// s, of the importer.
    start_time: f64,
    is_initializing: bool,
    motion: Option<Motion>,
}

struct Motion {
    simulation: Simulation,
    drive: Given,
    /// Forces at the present state; `None` after a change.
    outputs: Option<[f64; OUTPUTS]>,
}

/// Inputs, and the time since which the races follow them.
#[derive(Clone, Copy, Serialize, Deserialize)]
struct Given {
    inputs: [f64; INPUTS],
    since: f64,
}

impl Given {
    /// Inputs at a later time: positions have changed at their rates.
    fn at(&self, time: f64) -> [f64; INPUTS] {
        let mut inputs = self.inputs;
        for race in inputs.chunks_mut(OF_RACE) {
            for i in 0..5 {
                race[i] += race[5 + i] * (time - self.since);
            }
        }
        inputs
    }
}

/// State of the FMU.
#[derive(Clone, Serialize, Deserialize)]
pub struct State {
    inputs: [f64; INPUTS],
    start_time: f64,
    is_initializing: bool,
    motion: Option<(Checkpoint, Given)>,
}

impl State {
    pub fn to_bytes(&self) -> Vec<u8> {
        serde_json::to_vec(self).expect("a state is plain numbers")
    }

    pub fn from_bytes(bytes: &[u8]) -> Option<State> {
        serde_json::from_slice(bytes).ok()
    }
}

impl Model {
    /// # Errors
    ///
    /// An invalid scene, or one with parts other than one bearing between rigid races.
    pub fn read(scene: &Path) -> Result<Model, ModelError> {
        let Subject::Assembly(scene) = read_subject(scene)? else {
            return Err(ModelError::OtherParts);
        };
        let one = scene.only().ok_or(ModelError::OtherParts)?;
        if one.dynamics.flexible_cage.is_some() || !scene.sensors.is_empty() {
            return Err(ModelError::OtherParts);
        }
        let run = scene.run().ok_or(ModelError::NoRun)?;
        let mut assembly = scene.assembly()?;
        let mut options = run.options;
        if run.by_plan {
            options.integrator = choose(&assembly).integrator;
        }
        let mut start_values = [0.0; INPUTS];
        // Inertia of a race does no more than enter the energy ledger.
        let inner = assembly.bodies[INNER].driven().ok_or(ModelError::OtherParts)?.clone();
        for (race, values) in [INNER, OUTER].into_iter().zip(start_values.chunks_mut(OF_RACE)) {
            let body = &mut assembly.bodies[race];
            values.copy_from_slice(&start_of(body));
            let own = body.driven().unwrap_or(&inner).clone();
            let none = [0.0; 5];
            let free = DrivenBody { foundation_stiffness: none, foundation_damping: none, ..own };
            body.mobility = Mobility::Driven(Box::new(free));
            (body.rotating_load, body.unbalance) = (None, 0.0);
        }
        Ok(Model {
            assembly,
            options,
            start_values,
            inputs: start_values,
            experiment: [run.end, run.output_interval],
            start_time: 0.0,
            is_initializing: false,
            motion: None,
        })
    }

    /// Enters initialization at a time.
    pub fn begin(&mut self, time: f64) {
        (self.start_time, self.is_initializing, self.motion) = (time, true, None);
    }

    /// Balls in equilibrium between the races as the inputs say, or at nominal positions if the scene says so.
    ///
    /// # Errors
    ///
    /// No equilibrium, no step.
    pub fn end_initialization(&mut self) -> Result<(), ModelError> {
        self.motion()?;
        self.is_initializing = false;
        Ok(())
    }

    /// The motion; while initializing it begins with what is asked first, and anew after each input.
    fn motion(&mut self) -> Result<&mut Motion, ModelError> {
        if self.is_initializing && self.motion.is_none() {
            let drive = Given { inputs: self.inputs, since: 0.0 };
            let simulation = Simulation::new(self.driven(&drive), self.options)?;
            self.motion = Some(Motion { simulation, drive, outputs: None });
        }
        self.motion.as_mut().ok_or(ModelError::NotStarted)
    }

    /// s.
    pub fn time(&self) -> f64 {
        self.start_time + self.motion.as_ref().map_or(0.0, |motion| motion.simulation.time)
    }

    /// # Errors
    ///
    /// A value that is not finite.
    pub fn set_input(&mut self, index: usize, value: f64) -> Result<(), ModelError> {
        if !value.is_finite() {
            return Err(ModelError::Input { name: inputs()[index].name.clone(), value });
        }
        self.inputs[index] = value;
        if self.is_initializing {
            self.motion = None;
        }
        Ok(())
    }

    /// Back to the state after instantiation.
    pub fn reset(&mut self) {
        (self.inputs, self.start_time) = (self.start_values, 0.0);
        (self.is_initializing, self.motion) = (false, None);
    }

    /// Takes a communication step: races start at their positions and move at their rates. Afterwards the inputs are the
    /// positions reached.
    ///
    /// # Errors
    ///
    /// A state from which no motion follows; see [`Simulation::step`].
    pub fn step(&mut self, from: f64, step: f64) -> Result<(), ModelError> {
        if !(step > 0.0 && step.is_finite()) {
            return Err(ModelError::Step { from, step });
        }
        let (inputs, start) = (self.inputs, self.start_time);
        let motion = self.motion()?;
        let at = motion.simulation.time + start;
        // Importers add up their steps.
        if (at - from).abs() > 1e-6 * step {
            return Err(ModelError::OtherTime { at, from });
        }
        motion.follow(inputs);
        let end = from + step - start;
        let simulation = &mut motion.simulation;
        while simulation.time < end - 1e-9 * step {
            let left = end - simulation.time;
            // Whole steps of one size, and none that is a rounding error.
            let count = (left / simulation.step_size - 1e-9).ceil().max(1.0);
            simulation.step_by(left / count)?;
        }
        simulation.time = end;
        motion.outputs = None;
        self.inputs = motion.drive.at(end);
        Ok(())
    }

    /// Forces (N) and moments (N·m, about the centre of the race) on both races from the balls and the cage.
    ///
    /// # Errors
    ///
    /// The initialization has not ended.
    pub fn outputs(&mut self) -> Result<[f64; OUTPUTS], ModelError> {
        let inputs = self.inputs;
        let motion = self.motion()?;
        motion.follow(inputs);
        Ok(motion.outputs())
    }

    pub fn state(&self) -> State {
        let of = |motion: &Motion| (motion.simulation.checkpoint(), motion.drive);
        let motion = self.motion.as_ref().map(of);
        let &Model { inputs, start_time, is_initializing, .. } = self;
        State { inputs, start_time, is_initializing, motion }
    }

    /// # Errors
    ///
    /// A state of another bearing.
    pub fn set_state(&mut self, state: &State) -> Result<(), ModelError> {
        let motion = match &state.motion {
            Some((checkpoint, drive)) => {
                let assembly = self.driven(drive);
                if checkpoint.state.len() != Places::of(&assembly).state_len() {
                    return Err(ModelError::OtherState);
                }
                let simulation = Simulation::from_checkpoint(assembly, self.options, checkpoint)?;
                Some(Motion { simulation, drive: *drive, outputs: None })
            }
            None => None,
        };
        (self.inputs, self.start_time) = (state.inputs, state.start_time);
        (self.is_initializing, self.motion) = (state.is_initializing, motion);
        Ok(())
    }

    fn driven(&self, drive: &Given) -> Assembly {
        let mut driven = self.assembly.clone();
        drive_races(&mut driven.bodies, drive);
        driven
    }
}

impl Motion {
    /// Lets the races follow new inputs from the present time on.
    fn follow(&mut self, inputs: [f64; INPUTS]) {
        let since = self.simulation.time;
        if inputs != self.drive.at(since) {
            let next = Given { inputs, since };
            self.simulation.change_drives(|bodies| drive_races(bodies, &next));
            (self.drive, self.outputs) = (next, None);
        }
    }

    fn outputs(&mut self) -> [f64; OUTPUTS] {
        let Motion { simulation, outputs, .. } = self;
        *outputs.get_or_insert_with(|| {
            simulation.snapshot();
            let [inner, outer] = simulation.system.sets[0].on_races;
            let all = [inner.force, inner.moment, outer.force, outer.moment];
            std::array::from_fn(|i| all[i / 3][i % 3])
        })
    }
}

/// Inputs of a race that stands as in the scene at t = 0.
fn start_of(body: &Body) -> [f64; OF_RACE] {
    let mut values = [0.0; OF_RACE];
    for (i, value) in values[..5].iter_mut().enumerate() {
        *value = match body.driven().map(|race| &race.drives[i]) {
            Some(Drive::Motion(profile)) => profile.value(0.0),
            Some(Drive::Load(_)) | None => body.rest[i],
        };
    }
    values[10] = prescribed_speed(body, 0.0);
    values
}

fn drive_races(bodies: &mut [Body], drive: &Given) {
    for (race, values) in [INNER, OUTER].into_iter().zip(drive.inputs.chunks(OF_RACE)) {
        let Some(driven) = bodies[race].driven_mut() else { continue };
        driven.drives = std::array::from_fn(|i| moving(values[i], values[5 + i], drive.since));
        driven.rotation = Rotation::Speed(Profile::Constant(values[10]));
    }
}

/// A coordinate with a value at a time that changes at a rate.
fn moving(at: f64, rate: f64, time: f64) -> Drive {
    if rate == 0.0 {
        return Drive::Motion(Profile::Constant(at));
    }
    // From before the time, since the start takes rates on both sides of it, until long after the next inputs.
    let point = |after: f64| [time + after, at + rate * after];
    Drive::Motion(Profile::Table { points: vec![point(-1.0), point(1e6)] })
}
