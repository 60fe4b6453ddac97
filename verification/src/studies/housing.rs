//! What a digit costs of a bearing in housing C: one turn of the load of 2.4.2, and the stiffness
//! against it in three directions, by equilibria of the condensed housing and by explicit steps.
//!
//! Times are those from a mesh to the number; meshing is not counted.

use std::f64::consts::TAU;

use bearing_dynamics::assembly::lists::OUTER;
use bearing_dynamics::assembly::loads::{Drive, DynamicProblem};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::motion::coupling::{Exchange, SolidPart};
use bearing_dynamics::numeric::profile::Profile;

use crate::case::CaseError;
use crate::housing_turn::{
    LOAD, POINTS, Turning, equilibria, explicit, options, outer_place, seat,
};
use crate::housings::{self, mean, radii};
use crate::motion::RPM;
use crate::pareto::{ParetoContext, Point, Stopwatch, Study, cheapest_ways};
use crate::solids::{largest, name_of};

pub const ORBIT: Study = Study {
    id: "housing_orbit",
    title: "Housing C: one turn of the load (2.4.2)",
    error_label: "largest error of the orbit's radius over its mean",
    more_errors: &["error of the mean radius"],
    run: orbit,
};

pub const STIFFNESS: Study = Study {
    id: "housing_stiffness",
    title: "Housing C: stiffness under 250 N",
    error_label: "largest error of three stiffnesses",
    more_errors: &["downwards", "sideways", "upwards"],
    run: stiffness,
};

type Mesh = (Order, [usize; 3]);

/// Cells around, radial and axial.
const MESHES: [Mesh; 8] = [
    (Order::Linear, [24, 2, 2]),
    (Order::Linear, [32, 2, 2]),
    (Order::Linear, [48, 3, 3]),
    (Order::Linear, [64, 4, 4]),
    (Order::Quadratic, [16, 1, 1]),
    (Order::Quadratic, [24, 1, 1]),
    (Order::Quadratic, [24, 2, 2]),
    (Order::Quadratic, [32, 3, 2]),
];
/// What they are measured with.
const FINEST: Mesh = (Order::Quadratic, [48, 3, 3]);
/// Meshes that explicit steps can afford.
const COARSE: [Mesh; 3] = [MESHES[0], MESHES[1], MESHES[4]];
/// s a turn of the explicit runs, of 1.2 s: inertia makes about a hundredth of the radius.
const FAST_TURN: f64 = 20e-3;

/// A variant is repeated until it has taken so many seconds, or so many times.
const PATIENCE: f64 = 0.4;
const MOST_REPEATS: usize = 3;

fn mesh_of((order, cells): Mesh) -> Result<TetMesh, CaseError> {
    housings::mesh('C', order, cells)
}

fn cells((_, [around, radial, axial]): Mesh) -> String {
    format!("{around} × {radial} × {axial}")
}

struct Timed<T> {
    value: T,
    seconds: f64,
    repeats: usize,
}

fn timed<T>(mut compute: impl FnMut() -> Result<T, CaseError>) -> Result<Timed<T>, CaseError> {
    let (mut seconds, mut spent, mut repeats) = (f64::INFINITY, 0.0, 0);
    loop {
        let watch = Stopwatch::start();
        let value = std::hint::black_box(compute()?);
        let taken = watch.seconds();
        (seconds, spent, repeats) = (seconds.min(taken), spent + taken, repeats + 1);
        if repeats == MOST_REPEATS || spent > PATIENCE {
            return Ok(Timed { value, seconds, repeats });
        }
    }
}

fn record<T>(
    context: &mut ParetoContext,
    mesh: Mesh,
    path: &str,
    found: &Timed<T>,
    evaluations: Option<u64>,
    errors: &[f64],
) {
    let series = format!("{}, {path}", name_of(mesh.0));
    context.push(Point {
        repeats: found.repeats,
        evaluations,
        more_errors: errors[1..].to_vec(),
        ..Point::new(&series, &cells(mesh), found.seconds, errors[0])
    });
}

/// Cheapest ways of all, and of the explicit runs.
fn conclude(context: &mut ParetoContext, whole: &str, finest: f64) {
    let ways = cheapest_ways(context.points(), 0, whole);
    context.sentence(format!("The {ways}"));
    let explicit: Vec<&Point> =
        context.points().iter().filter(|point| point.series.contains("explicit")).collect();
    let ways = cheapest_ways(explicit, 0, whole);
    context.sentence(format!("Of explicit steps the {ways}"));
    context.sentence(format!(
        "Reference: tet10, {} cells, condensed, by equilibria ({finest:.1} s).",
        cells(FINEST)
    ));
}

/// Radii of one turn by equilibria, m.
fn by_equilibria(mesh: &TetMesh) -> Result<Vec<f64>, CaseError> {
    let model = housings::solid(mesh)?;
    let bore = housings::condensed(mesh, &model)?;
    let mut search = housings::search(&bore);
    let turning = Turning::steady(50.0 * RPM);
    let moments = equilibria(&mut search, &turning, &turning.times, |_, _| {})?;
    let places: Vec<[f64; 2]> = moments.iter().map(|moment| outer_place(&moment.state)).collect();
    Ok(radii(&places))
}

/// The largest error of a radius and that of their mean, over the mean; radii at some of the places.
fn orbit_errors(radii: &[f64], places: &[usize], finest: &[f64]) -> [f64; 2] {
    let theirs: Vec<f64> = places.iter().map(|place| finest[*place]).collect();
    let whole = mean(finest);
    let gaps = radii.iter().zip(&theirs).map(|(r, s)| (r - s).abs() / whole);
    [largest(gaps), (mean(radii) - mean(&theirs)).abs() / whole]
}

fn orbit(context: &mut ParetoContext) -> Result<(), CaseError> {
    let mesh = mesh_of(FINEST)?;
    let finest = timed(|| by_equilibria(&mesh))?;
    let all: Vec<usize> = (0..POINTS).collect();
    for variant in MESHES {
        let mesh = mesh_of(variant)?;
        let found = timed(|| by_equilibria(&mesh))?;
        let errors = orbit_errors(&found.value, &all, &finest.value);
        record(context, variant, "equilibria", &found, None, &errors);
    }
    let turning = Turning::new(TAU / FAST_TURN);
    let mut a_turn = Vec::new();
    for variant in COARSE {
        let mesh = mesh_of(variant)?;
        let model = housings::solid(&mesh)?;
        let bore = housings::condensed(&mesh, &model)?;
        let mut search = housings::search(&bore);
        let first = equilibria(&mut search, &turning, &[0.0], |_, _| {})?;
        let start = &first[0].state;
        let displacement = bore.displacement(&start.bore.loads);
        let found =
            timed(|| explicit(&mesh, model.clone(), start, displacement.clone(), &turning))?;
        let run = &found.value;
        let errors = orbit_errors(&radii(&run.outer), &turning.places, &finest.value);
        let windows = Some(run.windows);
        record(context, variant, "explicit, 20 ms a turn", &found, windows, &errors);
        let real = run.seconds / run.windows as f64 * 1.2 / run.window;
        a_turn.push(format!("{}, {}: {:.0} s", name_of(variant.0), cells(variant), real));
    }
    conclude(context, "the mean radius", finest.seconds);
    context.sentence(format!(
        "Explicit runs: undamped, from equilibrium under the first direction, a turn in {:.0} ms instead of 1.2 s, the \
         first {} of {POINTS} directions left out while the load comes to its speed; evaluations are windows of the exchange. \
         The real turn, from their time per window: {}.",
        1e3 * FAST_TURN,
        POINTS - turning.places.len(),
        a_turn.join("; ")
    ));
    Ok(())
}

/// Downwards, sideways, upwards.
const DIRECTIONS: [[f64; 2]; 3] = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0]];
/// s: the load rises, all has died out.
const RISE: f64 = 0.3e-3;
const SETTLED: f64 = 3e-3;
/// 1/s and s/m: high, so that little time is enough.
const DAMPING: f64 = 8000.0;
const CONTACT_DAMPING: f64 = 3.0;

/// Load over the outer race's displacement along it, N/m.
fn along(place: [f64; 2], direction: [f64; 2]) -> f64 {
    LOAD / (place[0] * direction[0] + place[1] * direction[1])
}

fn loads(direction: [f64; 2]) -> [f64; 5] {
    [0.0, LOAD * direction[0], LOAD * direction[1], 0.0, 0.0]
}

fn still(mesh: &TetMesh) -> Result<[f64; 3], CaseError> {
    let model = housings::solid(mesh)?;
    let bore = housings::condensed(mesh, &model)?;
    let mut search = housings::search(&bore);
    let mut found = [0.0; 3];
    for (stiffness, direction) in found.iter_mut().zip(DIRECTIONS) {
        let held = DynamicProblem { outer: None, ..housings::mounted(loads(direction))? };
        let problem = held.statics(0.0);
        let state = search.solve(&problem, &housings::fit(0.0), [0.0; 3])?;
        *stiffness = along(outer_place(&state), direction);
    }
    Ok(found)
}

/// The same where explicit steps from the unloaded state come to rest, and windows taken.
fn settled(mesh: &TetMesh) -> Result<([f64; 3], u64), CaseError> {
    let (mut found, mut windows) = ([0.0; 3], 0);
    for (stiffness, direction) in found.iter_mut().zip(DIRECTIONS) {
        let mut model = housings::solid(mesh)?;
        model.problem.damping = DAMPING;
        let mut problem = housings::mounted([0.0; 5])?;
        problem.damping = ContactDamping::HuntCrossley { alpha: CONTACT_DAMPING };
        for axis in [1, 2] {
            let to = loads(direction)[axis];
            let rise = Profile::SmoothRamp { from: 0.0, to, start: 0.0, duration: RISE };
            problem.inner.drives[axis] = Drive::Load(rise);
        }
        let unloaded = vec![[0.0; 3]; mesh.nodes.len()];
        let mut housed = Exchange::new(
            problem,
            vec![SolidPart::displaced(None, model, unloaded)],
            vec![seat(mesh)?],
            &options(),
        )?;
        while housed.time() < SETTLED {
            housed.advance()?;
        }
        let [_, y, z] = housed.simulation.body(OUTER).position;
        *stiffness = along([y, z], direction);
        windows += housed.exchanges;
    }
    Ok((found, windows))
}

fn stiffness(context: &mut ParetoContext) -> Result<(), CaseError> {
    let mesh = mesh_of(FINEST)?;
    let finest = timed(|| still(&mesh))?;
    let errors = |found: &[f64; 3]| {
        let [down, beside, up] = [0, 1, 2].map(|i| (found[i] / finest.value[i] - 1.0).abs());
        [largest([down, beside, up]), down, beside, up]
    };
    for variant in MESHES {
        let mesh = mesh_of(variant)?;
        let found = timed(|| still(&mesh))?;
        record(context, variant, "equilibrium", &found, None, &errors(&found.value));
    }
    let mut apart = Vec::new();
    for variant in COARSE {
        let mesh = mesh_of(variant)?;
        let same = still(&mesh)?;
        let found = timed(|| settled(&mesh))?;
        let (stiffnesses, windows) = found.value;
        record(context, variant, "explicit, settled", &found, Some(windows), &errors(&stiffnesses));
        apart.push(largest(same.iter().zip(&stiffnesses).map(|(a, b)| (b / a - 1.0).abs())));
    }
    conclude(context, "the stiffness", finest.seconds);
    let [down, beside, up] = finest.value.map(|k| 1e-6 * k);
    context.sentence(format!(
        "Stiffness: 250 N over the outer race's displacement along them; {down:.0} N/µm downwards, {beside:.0} sideways, \
         {up:.0} upwards by the reference."
    ));
    context.sentence(format!(
        "Explicit runs: three directions, each {:.0} ms from the unloaded state, damped ({DAMPING:.0} 1/s in the housing, \
         Hunt–Crossley {CONTACT_DAMPING} s/m in the bearing); at their end they are within {:.0e} of equilibrium on the same \
         mesh.",
        1e3 * SETTLED,
        largest(apart)
    ));
    Ok(())
}
