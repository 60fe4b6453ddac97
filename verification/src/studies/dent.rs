//! A ball over the dent of 3.4.4, outer race in a bushing: what its load and the inner race's motion cost, by
//! integrators, by Maxwell elements of the bushing's springs and by cells of its mesh.

use crate::bushings::DENTED_RACE;
use crate::case::CaseError;
use crate::motion::{changed_scene, ran};
use crate::pareto::{ParetoContext, Point, Stopwatch, Study, cheapest_ways};
use crate::solids::largest;

pub const DENT: Study = Study {
    id: "dent_on_bushing",
    title: "3.4.4: one pass over a dent, outer race in a bushing of 10 mm",
    error_label: "error of the inner race's displacement, of its largest",
    more_errors: &["error of the ball's load, of its dip"],
    run,
};

/// How the bushing is made and the motion stepped.
#[derive(Clone, Copy)]
struct Way {
    integrator: &'static str,
    accuracy: f64,
    /// Around half of the bushing, across the wall, along half of its length.
    cells: [usize; 3],
    /// Up to this frequency springs are fitted, Hz: the lower, the fewer Maxwell elements.
    fastest: f64,
    /// As scenes have it: springs or elements, and of elements the phase of a window.
    method: &'static str,
    phase: f64,
}

const SHIPPED: Way = Way {
    integrator: "rosenbrock",
    accuracy: 1e-4,
    cells: [16, 4, 4],
    fastest: 10e3,
    method: "reduced",
    phase: 0.2,
};
/// A hundred times closer, on a finer bushing; at 1e-5 and on the shipped cells it moves by less than 1e-4 of either error's scale, and
/// another integrator is among the points.
const REFERENCE: Way = Way {
    integrator: "rosenbrock",
    accuracy: 1e-6,
    cells: [24, 6, 5],
    fastest: 40e3,
    method: "reduced",
    phase: 0.2,
};

/// Columns time, load of the ball that rolls over the dent, z of the inner race; and how many Maxwell elements there were.
fn roll(way: &Way, end: f64) -> Result<(Vec<Vec<f64>>, usize), CaseError> {
    let Way { integrator, accuracy, cells: [around, radial, axial], fastest, method, phase } = way;
    let windows = match *method {
        "reduced" => String::new(),
        _ => format!("window_phase = {phase}\n"),
    };
    let numerics = format!(
        "[outer_race]\nmotion = \"5-dof\"\nspeed = \"0 rpm\"\n\n[spring.mount]\nfrom = \"ground\"\nto = \"outer_race\"\n\n[spring.mount.bushing]\n\
         inner_diameter = \"71 mm\"\nouter_diameter = \"91 mm\"\nlength = \"20 mm\"\ntable = \"3.1\"\nfastest = \"{fastest} Hz\"\n\
         method = \"{method}\"\n{windows}cells = {{ around = {around}, radial = {radial}, axial = {axial} }}\n\n[numerics]"
    );
    let (integrator, accuracy) =
        (format!("integrator = \"{integrator}\""), format!("accuracy = {accuracy:e}"));
    let end = format!("end = \"{end} s\"");
    let scene = changed_scene(
        DENTED_RACE,
        &[
            ("[numerics]", &numerics),
            ("integrator = \"rosenbrock\"", &integrator),
            ("accuracy = 1e-4", &accuracy),
            ("end = \"0.1 s\"", &end),
            ("output_interval = \"20 us\"", "output_interval = \"0.1 ms\""),
        ],
    )?;
    let elements = scene.springs.iter().map(|spring| spring.maxwell.len()).sum();
    Ok((ran(&scene, &["time", "ball_7_outer_load", "inner_z"])?, elements))
}

fn run(context: &mut ParetoContext) -> Result<(), CaseError> {
    const PASS: f64 = 0.08;
    let (truth, _) = roll(&REFERENCE, PASS)?;
    let z = largest(truth[2].iter().map(|z| z.abs()));
    let load = &truth[1];
    let dip = largest(load.iter().copied()) - load.iter().copied().fold(f64::INFINITY, f64::min);
    let apart = |a: &[f64], b: &[f64]| largest(a.iter().zip(b).map(|(a, b)| (a - b).abs()));
    let mut try_way = |series: &str, name: String, way: Way| -> Result<(), CaseError> {
        let watch = Stopwatch::start();
        let (found, elements) = roll(&way, PASS)?;
        let seconds = watch.seconds();
        let errors = [apart(&found[2], &truth[2]) / z, apart(&found[1], load) / dip];
        let name = format!("{name} ({elements} Maxwell elements)");
        context.push(Point {
            more_errors: vec![errors[1]],
            ..Point::new(series, &name, seconds, errors[0])
        });
        Ok(())
    };
    // Each variant reads its scene anew: bushings of the same inputs are fitted once, so they come first.
    for [around, radial, axial] in [[6, 2, 2], [8, 4, 2], [12, 4, 3], [16, 4, 4], [20, 6, 5]] {
        let way = Way { cells: [around, radial, axial], ..SHIPPED };
        try_way("cells of the bushing", format!("{around} x {radial} x {axial}"), way)?;
    }
    for fastest in [0.03, 1.0, 30.0, 1e3, 30e3] {
        let way = Way { fastest, ..SHIPPED };
        try_way("springs up to a frequency", format!("{fastest} Hz"), way)?;
    }
    // By 0.1 a run ends with energy lost; friction binds steps of the other integrator to half a microsecond whatever the accuracy.
    for (integrator, accuracy) in [
        ("rosenbrock", 1e-2),
        ("rosenbrock", 1e-3),
        ("rosenbrock", 1e-4),
        ("rosenbrock", 1e-5),
        ("dormand-prince", 1e-3),
    ] {
        let way = Way { integrator, accuracy, ..SHIPPED };
        try_way(&format!("{integrator}, bushing known"), format!("{accuracy:e}"), way)?;
    }
    let few = Way { accuracy: 1e-3, cells: [8, 4, 2], fastest: 1e3, ..SHIPPED };
    try_way("all three coarse", "1e-3, 8 x 4 x 2, 1000 Hz".into(), few)?;
    // Rubber in place of springs, with its mass.
    let elements = Way { accuracy: 1e-3, cells: [8, 2, 2], ..SHIPPED };
    for (method, phase) in
        [("explicit", 0.2), ("explicit", 0.6), ("implicit", 0.6), ("implicit", 1.2)]
    {
        let name = format!("8 x 2 x 2, phase {phase}");
        try_way(&format!("{method} elements"), name, Way { method, phase, ..elements })?;
    }
    let ways = [0, 1].map(|k| {
        let of = ["inner race's displacement", "ball's load"][k];
        cheapest_ways(context.points(), k, of)
    });
    for ways in ways {
        context.sentence(format!("The {ways}"));
    }
    // Five passes of one ball, from the scene to the table.
    let watch = Stopwatch::start();
    roll(&few, 7.4)?;
    context.sentence(format!(
        "Five passes of one ball (7.4 s at 100 rpm) take {:.1} s on springs with all three coarse, reading the scene included.",
        watch.seconds()
    ));
    Ok(())
}
