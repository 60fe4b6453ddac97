//! The rotor of chapter 4: what its critical speed, the moment of Table 4.2 and the peak of a run-up cost, by what stands for the
//! shaft, its mesh, its shapes, and integrators.

use bearing_dynamics::equilibrium::initial::{at_start, static_assembly};
use bearing_dynamics::equilibrium::statics::{StaticOptions, solve_assembly};
use bearing_dynamics::motion::simulation::{Integrator, Stepping};
use bearing_dynamics::vibrations::quasi_static_limit::MovingBody;
use bearing_dynamics::vibrations::small_motions::whirling;

use crate::case::CaseError;
use crate::motion::{ROTOR_IN_ELEMENTS, ROTOR_OF_TETRAHEDRA, RPM, changed_scene, ran};
use crate::oracles::run_up::Peak;
use crate::oracles::whirling_shaft::{End, Length, Part, left, root};
use crate::pareto::{ParetoContext, Point, Stopwatch, Study, cheapest_ways};
use crate::rotor_run_up::{
    QuasiStaticSequence, Way, balls, followed, on_pins, oracle, rotor, run_up, straight,
};

pub const CRITICAL_SPEED: Study = Study {
    id: "rotor_critical_speed",
    title: "4.3.4: first critical speed of the rotor on pins, 20 kg in its middle",
    error_label: "error of the critical speed",
    more_errors: &[],
    run: critical_speeds,
};

pub const MOMENT: Study = Study {
    id: "rotor_table_4_2_moment",
    title: "Table 4.2: moment of a bearing without clearance, 3000 N at mid-span",
    error_label: "error of the moment",
    more_errors: &[],
    run: moments,
};

pub const RUN_UP: Study = Study {
    id: "rotor_run_up_peak",
    title: "4.3.4: peak of a run-up within 0.2 s, 1e-3 kg m",
    error_label: "error of the peak's height",
    more_errors: &["error of its speed"],
    run: run_ups,
};

/// What stands for the shaft: beam theory, or cells around, on the radius outside the core, and their length along, mm, in
/// elements of this order.
#[derive(Clone, Copy)]
enum Body {
    Beam,
    Cells { order: u8, around: usize, radial: usize, along: f64 },
}
use Body::{Beam, Cells};

const MESHES: [Body; 6] = [
    Cells { order: 2, around: 8, radial: 1, along: 12.5 },
    Cells { order: 2, around: 16, radial: 1, along: 12.5 },
    Cells { order: 1, around: 16, radial: 1, along: 12.5 },
    Cells { order: 1, around: 16, radial: 1, along: 3.34 },
    Cells { order: 1, around: 32, radial: 2, along: 3.34 },
    Cells { order: 1, around: 48, radial: 4, along: 3.34 },
];
/// Layers half as long as scenes have them, and finer around and on the radius.
const FINEST: Body = Cells { order: 2, around: 24, radial: 2, along: 6.25 };

impl Body {
    fn series(self) -> &'static str {
        match self {
            Beam => "beam",
            Cells { order: 1, .. } => "tet4",
            Cells { .. } => "tet10",
        }
    }

    fn name(self) -> String {
        match self {
            Beam => "stations".into(),
            Cells { around, radial, along, .. } => format!("{around} x {radial}, {along} mm along"),
        }
    }

    /// Keys of `[body.shaft.beam]`.
    fn keys(self) -> String {
        match self {
            Beam => String::new(),
            Cells { order, around, radial, along } => format!(
                "mesh = {{ order = {order}, around = {around}, radial = {radial}, longest_layer = \"{along} mm\" }}\n"
            ),
        }
    }

    /// The same, with its shapes up to a frequency, Hz, before the damping of the run-up's scene.
    fn shapes_to(self, below: f64) -> String {
        format!("{}below = \"{below} Hz\"\ndamping = \"100 1/s\"", self.keys())
    }
}

const DAMPING: &str = "damping = \"100 1/s\"";
/// Far above any shape of the beam's stations: all are taken.
const ALL: f64 = 1e7;

/// rpm, on pins that give nothing.
fn critical_speed(body: Body, below: f64) -> Result<f64, CaseError> {
    const STIFF: f64 = 1e12;
    let keys = body.shapes_to(below);
    let way = Way { changes: &[(DAMPING, keys.as_str())], ..NEAR };
    let mut assembly = rotor(&straight(RAMP), UNBALANCE, &way)?;
    on_pins(&mut assembly, STIFF);
    let shaft = assembly.shafts[0].body;
    let inertia = assembly.bodies[shaft].inertia();
    let inertia = *inertia.ok_or_else(|| CaseError::message("a shaft without inertia"))?;
    let moving = MovingBody { body: shaft, inertia, free: [true; 5] };
    let still = static_assembly(&assembly, 0.0, &[]);
    let found = whirling(&assembly, &still, &at_start(&assembly)?, &[moving], &[])?;
    let all = found.model.critical_speeds()?;
    let first = all.iter().find(|of| of.whirl.across > 0.5 && of.whirl.is_forward());
    Ok(first.ok_or_else(|| CaseError::message("no forward critical speed"))?.speed / RPM)
}

/// N·m, on outer race 1.
fn moment(body: Body) -> Result<f64, CaseError> {
    let scene = changed_scene(ROTOR_OF_TETRAHEDRA, &[("mesh = { order = 2 }\n", &body.keys())])?;
    let found = solve_assembly(&scene.statics()?, None, &StaticOptions::default())?;
    Ok(found.bearings[0].moments[1].y)
}

/// Runs it, no more than five times and no longer than half a second in all, and records the quickest.
fn timed(
    context: &mut ParetoContext,
    (series, name): (&str, &str),
    reference: f64,
    mut find: impl FnMut() -> Result<f64, CaseError>,
) -> Result<f64, CaseError> {
    let (mut least, mut spent, mut repeats, mut found) = (f64::INFINITY, 0.0, 0, 0.0);
    while repeats == 0 || repeats < 5 && spent < 0.5 {
        let watch = Stopwatch::start();
        found = find()?;
        let seconds = watch.seconds();
        (least, spent, repeats) = (least.min(seconds), spent + seconds, repeats + 1);
    }
    let error = (found / reference - 1.0).abs();
    eprintln!("  {series}: {name}, {least:.3} s × {repeats}, error {error:.1e}");
    context.push(Point { repeats, ..Point::new(series, name, least, error) });
    Ok(found)
}

fn critical_speeds(context: &mut ParetoContext) -> Result<(), CaseError> {
    let reference = critical_speed(FINEST, 20e3)?;
    for below in [10.0, 1e3, 5e3, 20e3, ALL] {
        let name = match below {
            ALL => "all shapes".to_string(),
            _ => format!("shapes to {below} Hz"),
        };
        timed(context, ("beam", &name), reference, || critical_speed(Beam, below))?;
    }
    for body in MESHES {
        let name = format!("{}, shapes to 5000 Hz", body.name());
        timed(context, (body.series(), &name), reference, || critical_speed(body, 5e3))?;
    }
    let half = Part::Length(Length::steel(0.2, 0.03));
    let disc = Part::Disc { mass: 20.0, axial: 0.0, transverse: 0.0 };
    let theory = |speed: f64| left(&[half, disc, half], [End::Pinned; 2], speed, speed);
    let theory = root(theory, reference * RPM) / RPM;
    context.sentence(format!(
        "Reference: ten-node elements, {}, shapes to 20 kHz: {reference:.2} rpm; Timoshenko's beam by transfer matrices (Cowper's shear coefficient): {theory:.2} rpm, {:+.1e} off.",
        FINEST.name(),
        theory / reference - 1.0
    ));
    name_cheapest(context, 0, "the critical speed");
    Ok(())
}

fn moments(context: &mut ParetoContext) -> Result<(), CaseError> {
    let reference = moment(FINEST)?;
    timed(context, ("beam", "static answers"), reference, || moment(Beam))?;
    for body in MESHES {
        timed(context, (body.series(), &body.name()), reference, || moment(body))?;
    }
    context.sentence(format!(
        "Reference: ten-node elements, {}: {reference:.4} N·m. Loads on sections are answered by static shapes, whatever natural ones there are beside them.",
        FINEST.name()
    ));
    name_cheapest(context, 0, "the moment");
    Ok(())
}

fn name_cheapest(context: &mut ParetoContext, measure: usize, whole: &str) {
    let ways = cheapest_ways(context.points(), measure, whole);
    context.sentence(format!("The {ways}"));
}

const RAMP: f64 = 0.2;
const UNBALANCE: &str = "1e-3";
/// s: past the peak and its flanks.
const END: f64 = 0.135;
const SHAPES: [(&str, f64); 4] =
    [("no natural shapes", 10.0), ("shapes to 2 kHz", 2e3), ("to 5 kHz", 5e3), ("to 20 kHz", 20e3)];
/// With a cage and damping, without which balls that carry nothing rattle, and no accuracy tells where to.
const NEAR: Way = Way {
    integrator: Integrator::DormandPrince,
    stepping: Stepping::Accuracy(1e-3),
    calm: true,
    changes: &[],
};

/// Peak, steps, and seconds from scene to peak.
fn peak(body: Body, below: f64, way: &Way) -> Result<(Peak, u64, f64), CaseError> {
    let watch = Stopwatch::start();
    let keys = body.shapes_to(below);
    let way = Way { changes: &[(DAMPING, keys.as_str())], ..*way };
    let done = run_up(rotor(&straight(RAMP), UNBALANCE, &way)?, &way, END)?;
    Ok((done.top()?, done.steps, watch.seconds()))
}

fn run_ups(context: &mut ParetoContext) -> Result<(), CaseError> {
    let (reference, ..) = peak(Beam, 20e3, &Way { stepping: Stepping::Accuracy(1e-6), ..NEAR })?;
    let (other, ..) = peak(
        Beam,
        20e3,
        &Way { integrator: Integrator::Rosenbrock, stepping: Stepping::Accuracy(1e-5), ..NEAR },
    )?;
    let off =
        |found: &Peak| [found.height / reference.height - 1.0, found.speed / reference.speed - 1.0];
    let mut try_way = |series: &str, name: &str, body: Body, below: f64, way: &Way| {
        let (found, steps, seconds) = peak(body, below, way)?;
        let [height, speed] = off(&found).map(f64::abs);
        let name = format!("{name} ({steps} steps)");
        eprintln!("  {series}: {name}, {seconds:.3} s, errors {height:.1e} {speed:.1e}");
        context
            .push(Point { more_errors: vec![speed], ..Point::new(series, &name, seconds, height) });
        Ok::<_, CaseError>(())
    };
    for (name, below) in SHAPES {
        try_way("beam, dormand-prince 1e-3", name, Beam, below, &NEAR)?;
    }
    for body in [MESHES[1], MESHES[4]] {
        let name = format!("{}, shapes to 2 kHz", body.name());
        try_way(&format!("{}, dormand-prince 1e-3", body.series()), &name, body, 2e3, &NEAR)?;
    }
    for (integrator, accuracies) in [
        (Integrator::DormandPrince, &[1e-1, 1e-2, 1e-4, 1e-5][..]),
        (Integrator::Rosenbrock, &[1.0, 1e-1, 1e-2, 1e-3, 1e-4][..]),
    ] {
        for &accuracy in accuracies {
            let way = Way { integrator, stepping: Stepping::Accuracy(accuracy), ..NEAR };
            let series = format!("{}, shapes to 2 kHz", integrator.name());
            try_way(&series, &format!("accuracy {accuracy:.0e}"), Beam, 2e3, &way)?;
        }
    }
    for accuracy in [1.0, 1e-1] {
        let stepping = Stepping::Accuracy(accuracy);
        let way = Way { integrator: Integrator::Rosenbrock, stepping, ..NEAR };
        let name = format!("accuracy {accuracy:.0e}");
        try_way("rosenbrock, no natural shapes", &name, Beam, SHAPES[0].1, &way)?;
    }
    for step in [4e-6, 2e-6, 1e-6] {
        let stepping = Stepping::Fixed(step);
        let way = Way { integrator: Integrator::RungeKutta, stepping, ..NEAR };
        let name = format!("{:.0} µs", 1e6 * step);
        try_way("rk4, shapes to 2 kHz", &name, Beam, 2e3, &way)?;
    }
    let course: QuasiStaticSequence = straight(RAMP);
    let massless = followed(&oracle(&course, UNBALANCE, balls(0.0)), END).top()?;
    let [found, massless] = [off(&other), off(&massless)];
    context.sentence(format!(
        "Reference: a beam with its shapes to 20 kHz, dormand-prince at 1e-6: {:.1} rpm, {:.3} µm. Beside it, height and speed: rosenbrock at 1e-5 {:+.1e}, {:+.1e}; \
         the verification's oracle, whose balls have no inertia, {:+.1e}, {:+.1e}. Balls that carry nothing strike as chance has it: errors below some 2e-4 are luck.",
        reference.speed / RPM,
        1e6 * reference.height,
        found[0],
        found[1],
        massless[0],
        massless[1]
    ));
    name_cheapest(context, 0, "the peak's height");
    name_cheapest(context, 1, "its speed");
    explicit_steps(context)
}

/// What the source's way would take for the run-up: seconds between two ends of a run in explicit steps of all elements.
fn explicit_steps(context: &mut ParetoContext) -> Result<(), CaseError> {
    const ENDS: [f64; 2] = [0.2e-3, 1.2e-3];
    let mut seconds = [0.0; 2];
    for (seconds, end) in seconds.iter_mut().zip(ENDS) {
        let end = format!("end = \"{end} s\"");
        let scene = changed_scene(ROTOR_IN_ELEMENTS, &[("end = \"5 ms\"", &end)])?;
        let watch = Stopwatch::start();
        ran(&scene, &["time"])?;
        *seconds = watch.seconds();
    }
    let each = (seconds[1] - seconds[0]) / (ENDS[1] - ENDS[0]);
    let cheapest = context.points().iter().map(|point| point.seconds).fold(f64::INFINITY, f64::min);
    context.sentence(format!(
        "Explicit steps of all elements (`scenes/rotor_in_elements.toml`, four-node, 16 x 1, 5 mm along), measured on a millisecond: {each:.0} s for a simulated second, {:.0} min for the \
         {END} s of this run-up, {:.0e} times the least above; over 5 ms within 1 % of the same elements reduced (case `rotor_in_elements_4_2`).",
        each * END / 60.0,
        each * END / cheapest
    ));
    Ok(())
}
