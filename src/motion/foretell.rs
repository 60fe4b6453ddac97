//! What a run will take, from a short trial of it: which method does it with less work, and how many
//! steps.
//!
//! A trial takes the run's own steps from its start. Where loads and motions change over time it leaves
//! off after a share of its steps and begins again later in the run, in equilibrium there. Between its
//! looks steps go on at the rate they had at the end of the last one; without damping what rings goes
//! on ringing, so that the rate does not fall.

use crate::assembly::lists::Assembly;
use crate::ch2_housing::bearing::contact::ContactDamping;
use crate::motion::clocked;
use crate::motion::clocked::RunRequest;
use crate::motion::simulation::{
    Integrator, RunOptions, Simulation, SimulationError, Start, Stepping,
};
use crate::numeric::clock::Clock;

/// A foretold number of steps is likely to be within this factor of the one taken, up or down.
pub const WITHIN: f64 = 2.0;
/// So many times the foretold number the runs took that were farthest off among those whose balls have cages or are pressed: a stepped
/// rotor whose looks ring more than it does, and a run-up of three caged bearings whose looks begin in equilibrium.
pub const FARTHEST_OFF: [f64; 2] = [0.3, 7.0];

/// Attempts of a trial that counts steps or that chooses a method where anything changes over time: some
/// hundred at each look, since a start anew takes that long to settle. And where nothing changes.
const TO_COUNT: u64 = 4000;
const TO_CHOOSE: u64 = 900;
/// Of the other method, at each look.
const OTHER: u64 = 80;
/// Parts that a run is looked at in, where anything changes over time.
const PARTS: usize = 6;
/// Corners that a trial looks at; more are no events but a table.
const CORNERS: usize = 8;
/// Jacobians that a trial of steps from the stability limit may ask.
const JACOBIANS: u64 = 7;
/// Work of an attempt of `rosenbrock` (four evaluations, one with slopes, and a matrix) over that of
/// one of `dormand-prince` (six evaluations): 17 to 22 µs over 12 to 15 µs with 3 to 40 balls.
const WORK_OF_ROSENBROCK: f64 = 1.45;
/// Work of an attempt of `dormand-prince` with a bearing, in multiplications: 13 µs at four a nanosecond.
const WORK_OF_BEARING: f64 = 5e4;

/// Work of an attempt of `rosenbrock` over that of one of `dormand-prince`: with shapes of solids the matrix has an
/// equation for each, and each node of a seat that touches couples them all.
fn work_of_rosenbrock(assembly: &Assembly) -> f64 {
    if assembly.solids.is_empty() {
        return WORK_OF_ROSENBROCK;
    }
    let shapes: usize = assembly.solids.iter().map(|solid| solid.count()).sum();
    let (mut moved, mut coupled) = (0.0, 0.0);
    for seat in &assembly.seats {
        let solid = &assembly.solids[seat.solid];
        let (nodes, count) =
            (solid.surfaces[seat.surface].nodes.len() as f64, solid.count() as f64);
        moved += 1.5 * nodes * count;
        coupled += 0.5 * nodes * count * count;
    }
    let equations = shapes as f64;
    let matrix = equations * equations * equations / 3.0 + coupled;
    (WORK_OF_ROSENBROCK * WORK_OF_BEARING + 8.0 * moved + matrix) / (WORK_OF_BEARING + 6.0 * moved)
}

/// What a trial says of a run.
#[derive(Clone, Debug)]
pub struct Foretold {
    /// Accepted steps of the whole run.
    pub steps: f64,
    /// Steps that the trial took, and over how much of the run, s.
    pub taken: u64,
    pub covered: f64,
    pub looks: usize,
    /// Whether the trial was the whole run.
    pub whole: bool,
    /// What ended the trial on its way from the start, as it will the run, and when, s.
    pub failure: Option<(f64, SimulationError)>,
    /// The same of a look that began anew in equilibrium, as the run does not.
    pub doubt: Option<(f64, SimulationError)>,
}

/// What the trial says of the two methods with error control.
#[derive(Clone, Debug, PartialEq)]
pub struct Choice {
    pub integrator: Integrator,
    /// Mean step of `rosenbrock` and of `dormand-prince`, s (0 of one that came to nothing); none where no trial could start or
    /// got anywhere, or none was made.
    pub mean_steps: Option<[f64; 2]>,
    /// Work of an attempt of `rosenbrock` over that of one of `dormand-prince`.
    pub work_of_rosenbrock: f64,
    /// Whether a race sits in a reduced solid.
    pub seated: bool,
}

impl Choice {
    /// Of a run that goes on as it began, with the mean steps of the trial there.
    pub fn kept(
        assembly: &Assembly,
        integrator: Integrator,
        mean_steps: Option<[f64; 2]>,
    ) -> Choice {
        let work_of_rosenbrock = work_of_rosenbrock(assembly);
        Choice { integrator, mean_steps, work_of_rosenbrock, seated: !assembly.seats.is_empty() }
    }

    /// Why, as a sentence.
    pub fn reason(&self) -> String {
        let Some([implicit, explicit]) = self.mean_steps else {
            return "goes with any bearing; no trial could start, or get anywhere".into();
        };
        if explicit == 0.0 {
            return format!(
                "steps of {implicit:.1e} s in a short trial, where dormand-prince came to nothing"
            );
        }
        if self.seated {
            return format!(
                "a race in a seat: steps of {implicit:.1e} s, and quiet in force; dormand-prince, at its stability \
                 limit with {explicit:.1e} s, lets it swing in its stiff seat as far as the accuracy allows"
            );
        }
        format!(
            "the least work in a short trial: steps of {implicit:.1e} s by rosenbrock, of {explicit:.1e} s \
             by dormand-prince, which takes {:.2} of the work a step",
            1.0 / self.work_of_rosenbrock
        )
    }
}

/// One stretch of the run as the trial saw it.
struct Stretch {
    duration: f64,
    /// Accepted steps that were counted in it and over which time, s.
    counted: f64,
    covered: f64,
    /// Accepted steps a second at the end of the look, and attempts.
    rate: f64,
    attempts: f64,
    /// Attempts a second of the other method from there.
    other: Option<f64>,
    /// Whether it began anew in equilibrium, without what rang before.
    anew: bool,
}

impl Stretch {
    fn steps(&self) -> f64 {
        let seen = self.counted + self.rate * (self.duration - self.covered);
        if self.anew { seen.max(self.rate * self.duration) } else { seen }
    }
}

/// Times at which looks begin, the end last. What starts in nominal positions is looked at where it has settled, too: until
/// balls are pressed nothing is stiff.
fn looks(assembly: &Assembly, request: &RunRequest) -> Vec<f64> {
    let end = request.end;
    if !assembly.changes() {
        return match request.options.start {
            Start::Equilibrium => vec![0.0, end],
            Start::Nominal => vec![0.0, 0.5 * end, end],
        };
    }
    let mut times: Vec<f64> = assembly.corners().into_iter().filter(|t| *t < end).collect();
    if times.len() > CORNERS {
        times.clear();
    }
    times.insert(0, 0.0);
    times.push(end);
    let longest = end / PARTS as f64;
    // An odd number: halfway a reversal stands still, which is no place to judge it from.
    let parts = |pair: &[f64]| ((pair[1] - pair[0]) / longest).ceil().max(1.0) as usize | 1;
    let begin = |pair: &[f64]| {
        let (count, [from, to]) = (parts(pair), [pair[0], pair[1]]);
        (0..count).map(move |i| from + (to - from) * i as f64 / count as f64).collect::<Vec<_>>()
    };
    let mut all: Vec<f64> = times.windows(2).flat_map(begin).collect();
    all.push(end);
    all
}

/// A run under way whose rows nobody keeps.
struct Trial {
    simulation: Simulation,
    clock: Clock,
    is_complete: bool,
}

impl Trial {
    /// A step as the run takes it; what is looked at on the way is what a run looks at.
    fn advance(&mut self) -> Result<(), SimulationError> {
        let arrival = clocked::step(&mut self.simulation, &self.clock)?;
        if arrival.row {
            self.row()?;
        }
        self.is_complete = arrival.completes;
        clocked::watch(&mut self.simulation, &mut self.clock, self.is_complete)
    }

    fn row(&mut self) -> Result<(), SimulationError> {
        self.simulation.snapshot();
        self.clock.count_row(self.simulation.time);
        Ok(())
    }

    /// Attempts so far.
    fn tried(&self) -> u64 {
        self.simulation.steps + self.simulation.system.work.rejected_steps
    }
}

fn started(
    assembly: &Assembly,
    request: &RunRequest,
    at: f64,
    budget: u64,
) -> Result<Trial, SimulationError> {
    // Rows have at least a step: no more room is needed.
    let room = request.output_interval * (budget + 1) as f64;
    let start = if at == 0.0 { request.options.start } else { Start::Equilibrium };
    let options = RunOptions { start, energy_limit: f64::INFINITY, ..request.options };
    let part = RunRequest {
        options,
        end: (request.end - at).min(room),
        output_interval: request.output_interval,
        fields_interval: None,
        channels: Vec::new(),
    };
    let assembly = if at == 0.0 { assembly.clone() } else { assembly.from_time(at) };
    let (simulation, clock) = clocked::start(assembly, &part)?;
    let mut trial = Trial { simulation, clock, is_complete: false };
    trial.row()?;
    Ok(trial)
}

/// Attempts a second that another method takes from where a trial is.
fn of_other(trial: &Trial, integrator: Integrator) -> Option<f64> {
    let simulation = &trial.simulation;
    let options = RunOptions { integrator, ..*simulation.options() };
    let assembly = simulation.system.assembly.clone();
    let state = simulation.state.clone();
    let mut other = Simulation::from_state(assembly, options, state, simulation.time).ok()?;
    if let (Some(of), Some(from)) = (&mut other.control, &simulation.control) {
        of.memory.displacement = from.memory.displacement;
    }
    let tried = |other: &Simulation| other.steps + other.system.work.rejected_steps;
    let mut half = (other.time, 0);
    while tried(&other) < OTHER {
        other.step().ok()?;
        if tried(&other) <= OTHER / 2 {
            half = (other.time, tried(&other));
        }
    }
    let rate = (tried(&other) - half.1) as f64 / (other.time - half.0);
    Some(rate.max(1.0 / trial.clock.row_interval()))
}

/// What a trial saw.
#[derive(Default)]
struct Seen {
    stretches: Vec<Stretch>,
    /// Attempts.
    spent: u64,
    /// How often it began.
    begun: usize,
    /// What ended it on its way from the start, and when, s.
    failure: Option<(f64, SimulationError)>,
    /// The same of a look that began anew.
    doubt: Option<(f64, SimulationError)>,
}

fn look_through(
    assembly: &Assembly,
    request: &RunRequest,
    budget: u64,
    other: Option<Integrator>,
) -> Result<Seen, SimulationError> {
    let times = looks(assembly, request);
    let Seen { mut stretches, mut spent, mut begun, mut failure, mut doubt } = Seen::default();
    let mut scale = 0.0;
    let mut under_way: Option<(Trial, f64)> = None;
    for (index, pair) in times.windows(2).enumerate() {
        let [from, to] = [pair[0], pair[1]];
        // Later ones keep a share: what has begun goes on as long as it can, with all that rings.
        let parts = times.len() as u64 - 1;
        let kept = budget / (2 * parts) * (parts - 1 - index as u64);
        let (mut trial, offset) = match under_way.take() {
            Some(same) => same,
            None => {
                let mut trial = match (started(assembly, request, from, budget), stretches.last()) {
                    (Ok(trial), _) => trial,
                    (Err(error), None) => return Err(error),
                    // Loads without an equilibrium do not end a run under way: steps go on as before.
                    (Err(_), Some(last)) => {
                        let duration = to - from;
                        let unseen = Stretch { duration, counted: 0.0, covered: 0.0, ..*last };
                        stretches.push(unseen);
                        continue;
                    }
                };
                begun += 1;
                if let Some(control) = &mut trial.simulation.control {
                    control.memory.displacement = control.memory.displacement.max(scale);
                }
                (trial, from)
            }
        };
        let [first, before] = [trial.simulation.steps, trial.tried()];
        let begin = trial.simulation.time;
        let left = budget.saturating_sub(spent + kept).max(16);
        let mut half = (begin, first, before);
        let mut through = false;
        while trial.tried() - before < left && trial.simulation.step_watch.judged < JACOBIANS {
            if trial.is_complete || trial.simulation.time + offset >= to {
                through = true;
                break;
            }
            if let Err(error) = trial.advance() {
                let at = trial.simulation.time + offset;
                // What begins anew in equilibrium, later on, need not be what the run comes to.
                let ended = if offset == 0.0 { &mut failure } else { &mut doubt };
                ended.get_or_insert((at, error));
                break;
            }
            if trial.tried() - before <= left / 2 {
                half = (trial.simulation.time, trial.simulation.steps, trial.tried());
            }
        }
        through |= trial.is_complete || trial.simulation.time + offset >= to;
        let now = &trial.simulation;
        // One that stopped before its budget was spent may have seen no second half.
        let early = through || trial.tried() - before < left;
        if early && now.time - half.0 < 0.25 * (now.time - begin) {
            half = (begin, first, before);
        }
        let over = now.time - half.0;
        let per = |count: u64| if over > 0.0 { count as f64 / over } else { 0.0 };
        let (steps, attempts) = (now.steps - half.1, trial.tried() - half.2);
        spent += trial.tried() - before;
        stretches.push(Stretch {
            duration: to - from,
            counted: (now.steps - first) as f64,
            covered: (now.time - begin).min(to - from),
            rate: per(steps),
            attempts: per(attempts),
            other: other.and_then(|integrator| of_other(&trial, integrator)),
            anew: offset > 0.0,
        });
        scale = now.control.as_ref().map_or(0.0, |control| control.memory.displacement);
        if through && !trial.is_complete {
            under_way = Some((trial, offset));
        }
    }
    Ok(Seen { stretches, spent, begun, failure, doubt })
}

/// Steps of a run whose steps follow from an accuracy or from the stability limit.
///
/// # Errors
/// What keeps the run from starting.
pub fn foretell(assembly: &Assembly, request: &RunRequest) -> Result<Foretold, SimulationError> {
    let Seen { mut stretches, spent: taken, begun: looks, failure, doubt } =
        look_through(assembly, request, TO_COUNT, None)?;
    // Steps from the limit do not grow again. What rang where the first look left off goes on; an explicit
    // method with error control is bound by traction rather, which rolling faster makes gentler.
    let options = &request.options;
    let from_limit = matches!(options.stepping, Stepping::FractionOfLimit(_));
    let undamped = assembly.bearings.iter().any(|b| b.damping == ContactDamping::None);
    let rings = undamped && options.integrator == Integrator::Rosenbrock;
    let mut carried = 0.0;
    for stretch in &mut stretches {
        if stretch.anew && (from_limit || rings) {
            stretch.rate = stretch.rate.max(carried);
        }
        if from_limit || !stretch.anew {
            carried = stretch.rate;
        }
    }
    let steps = stretches.iter().map(Stretch::steps).sum();
    let covered: f64 = stretches.iter().map(|s| s.covered).sum();
    let whole = looks == 1 && covered >= request.end * (1.0 - 1e-6);
    Ok(Foretold { steps, taken, covered, looks, whole, failure, doubt })
}

/// The method with error control that takes less work, by a trial that is short enough to be made
/// before each run; in a seat always the implicit one. What explicit steps at their stability limit let pass of the race's
/// place, its seat makes a force of: with 1e12 N/m and a thousandth of 2 µm some 200 N from row to row under a load of 300 N.
pub fn choose(assembly: &Assembly, request: &RunRequest) -> Choice {
    let options = RunOptions { integrator: Integrator::Rosenbrock, ..request.options };
    let request = RunRequest { options, ..request.clone() };
    let work_of_rosenbrock = work_of_rosenbrock(assembly);
    let nothing = Choice {
        integrator: Integrator::Rosenbrock,
        mean_steps: None,
        work_of_rosenbrock,
        seated: !assembly.seats.is_empty(),
    };
    let settled = request.options.start == Start::Equilibrium && !assembly.changes();
    let budget = if settled { TO_CHOOSE } else { TO_COUNT };
    let Ok(Seen { stretches, .. }) =
        look_through(assembly, &request, budget, Some(Integrator::DormandPrince))
    else {
        return nothing;
    };
    if stretches.iter().all(|stretch| stretch.attempts == 0.0) {
        return nothing;
    }
    let mut attempts = [0.0; 2];
    for stretch in &stretches {
        // Where the other one came to nothing this one is needed.
        let other = stretch.other.unwrap_or(f64::INFINITY);
        attempts[0] += stretch.attempts * stretch.duration;
        attempts[1] += other * stretch.duration;
    }
    let work = [work_of_rosenbrock * attempts[0], attempts[1]];
    let explicit = work[1] < work[0] && !nothing.seated;
    let integrator = if explicit { Integrator::DormandPrince } else { Integrator::Rosenbrock };
    let mean_steps = Some(attempts.map(|count| request.end / count));
    Choice { integrator, mean_steps, ..nothing }
}
