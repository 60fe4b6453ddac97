//! What a flexible cage costs: representation, modes and accuracy, on the speed of Table 5.4 and the pocket loads.

use std::f64::consts::TAU;

use bearing_dynamics::numeric::profile::Profile;

use crate::cage_bearing::{Motion, kinematics, rolling, simulate_by_accuracy, with_nodes};
use crate::case::CaseError;
use crate::pareto::{ParetoContext, Point, Stopwatch, Study};

pub const FLEXIBLE: Study = Study {
    id: "flexible_cage",
    title: "A flexible cage at 600 rpm: representation, modes and accuracy",
    error_label: "error of the ball set's speed against rolling",
    more_errors: &["difference of the RMS pocket load from the finest variant"],
    run,
};

/// 600 rpm.
const SPEED: f64 = 10.0 * TAU;
const SETTLE: f64 = 0.1;
const INTERVAL: f64 = 4e-5;
const SAMPLES: usize = 10_000;

/// Series, lines of `[bearing.cage]`, accuracies; the last is the reference of the pocket loads.
const VARIANTS: [(&str, &str, &[f64]); 4] = [
    ("rigid, by nodes", "body = \"rigid\"", &[0.1, 0.01, 0.001]),
    ("modes to 5 kHz", "body = \"reduced\"\nmodes_to = \"5 kHz\"", &[0.1, 0.01, 0.001]),
    ("modes to 15 kHz", "body = \"reduced\"\nmodes_to = \"15 kHz\"", &[0.1, 0.01, 0.001]),
    ("modes to 30 kHz", "body = \"reduced\"\nmodes_to = \"30 kHz\"", &[0.01, 0.001]),
];

fn run(context: &mut ParetoContext) -> Result<(), CaseError> {
    let expected = kinematics(&rolling(SPEED)?, SPEED)?.ratio;
    let mut found: Vec<(String, f64, f64, Motion)> = Vec::new();
    for (series, lines, accuracies) in VARIANTS {
        for &accuracy in accuracies {
            let lines = format!("{lines}\nmesh = {{ quarter = 3, bar = 2, wall = 2 }}");
            let assembly = with_nodes(&lines, Profile::Constant(SPEED))?;
            let watch = Stopwatch::start();
            let motion = simulate_by_accuracy(assembly, accuracy, SETTLE, INTERVAL, SAMPLES)?;
            found.push((series.to_string(), accuracy, watch.seconds(), motion));
        }
    }
    let finest = found.last().map_or(f64::NAN, |(.., motion)| motion.pocket_rms);
    for (series, accuracy, seconds, motion) in found {
        let error = (motion.ball_ratio() / expected - 1.0).abs();
        let apart = (motion.pocket_rms / finest - 1.0).abs();
        let evaluations = Some(motion.steps);
        let variant = format!("accuracy {accuracy:.0e}");
        let point = Point::new(&series, &variant, seconds, error);
        context.push(Point { more_errors: vec![apart], evaluations, ..point });
    }
    context.sentence(
        "0.4 s after 0.1 s, sampled every 40 µs; the mesh's modes are not in the times. Pocket loads are those of a \
         rattling cage: runs from slightly different starts differ as much as representations do.",
    );
    context.sentence(
        "The column of evaluations counts steps. A cage in explicit elements takes 2.6 s a millisecond of motion, measured on 5 ms \
         with 528 ten-node elements: 2 hours for the 2.62 s of Table 5.4.",
    );
    Ok(())
}
