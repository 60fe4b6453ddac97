//! Run-up through the first critical speed, by this program and by ROSS with Newmark's method.

use bearing_dynamics::members::connection::{Connection, Law, SpringDashpot};
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Start, Stepping};
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::output::session::RunRequest;
use serde::Deserialize;

use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::motion::{changed_scene, column, done, request};
use crate::solids::largest;

/// Output of ROSS: displacements (m) along both lateral axes at both places, one row each `interval` (s).
#[derive(Debug, Deserialize)]
pub struct RunUp {
    pub rows: Vec<[f64; 4]>,
    top: f64,
    step: f64,
    /// Largest distance of each place from the axis, m.
    peaks: [f64; 2],
    /// The same at the first place for a drive torque along X, m.
    peak_driven_along_x: f64,
}

impl RunUp {
    /// Equal to the digits kept.
    pub fn is_like(&self, other: &RunUp) -> bool {
        let all =
            |of: &RunUp| of.rows.iter().flatten().chain(&of.peaks).copied().collect::<Vec<_>>();
        let (own, others) = (all(self), all(other));
        let size = largest(others.iter().map(|far| far.abs()));
        own.len() == others.len()
            && own.iter().zip(&others).all(|(a, b)| (a - b).abs() <= 1e-6 * size)
    }
}

/// Stiffness (N/m) and damping (N·s/m) along X, Y and Z of both bearings. ROSS has none along X, where nothing moves.
const BEARINGS: [([f64; 3], [f64; 3]); 2] =
    [([1e6, 4e7, 7e7], [0.0, 500.0, 800.0]), ([1e6, 6e7, 9e7], [0.0, 700.0, 700.0])];
const COLUMNS: [&str; 4] = ["rotor_disc_y", "rotor_disc_z", "rotor_end_y", "rotor_end_z"];

/// Distances from the axis at the disc and at the end, row by row, m.
fn ours() -> Result<[Vec<f64>; 2], CaseError> {
    let scene = changed_scene(include_str!("scene.toml"), &[])?;
    let mut assembly = scene.assembly()?;
    for (bearing, (stiffness, damping)) in
        std::mem::take(&mut assembly.bearings).into_iter().zip(BEARINGS)
    {
        let [inner, outer] = bearing.mounts;
        let six = |[x, y, z]: [f64; 3]| [x, y, z, 0.0, 0.0, 0.0];
        let (stiffness, damping) = (six(stiffness), six(damping));
        let law = SpringDashpot { stiffness, damping, ..SpringDashpot::default() };
        let (name, ends, law) = ("a bearing".into(), [outer, inner], Law::SpringDashpot(law));
        assembly.connections.push(Connection { name, label: None, ends, law });
    }
    // Error control needs contacts, and there are none: classical Runge–Kutta method.
    let options = RunOptions {
        integrator: Integrator::RungeKutta,
        stepping: Stepping::FractionOfLimit(0.5),
        start: Start::Nominal,
        ..RunOptions::default()
    };
    let asked = RunRequest { options, ..request(&scene)? };
    let series = done(assembly, &asked)?.series()?;
    let [y, z, end_y, end_z] = COLUMNS.map(|name| column(&series, name));
    Ok([far(&y?, &z?), far(&end_y?, &end_z?)])
}

fn far(y: &[f64], z: &[f64]) -> Vec<f64> {
    y.iter().zip(z).map(|(y, z)| y.hypot(*z)).collect()
}

pub fn compare(context: &mut CaseContext, ross: &RunUp) -> Result<(), CaseError> {
    let of = |i: usize| ross.rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    let theirs = [far(&of(0), &of(1)), far(&of(2), &of(3))];
    let origin =
        format!("ROSS 2.3.0, elements of 10 mm, Newmark's method with steps of {} s", ross.step);
    let mut curves = Vec::new();
    for (((ours, theirs), expected), (id, what)) in ours()?
        .iter()
        .zip(&theirs)
        .zip(ross.peaks)
        .zip([("disc", "disc at 250 mm"), ("end", "overhung disc at 500 mm")])
    {
        let every = ours.len().saturating_sub(1) / theirs.len().saturating_sub(1).max(1);
        let kept: Vec<f64> = ours.iter().step_by(every.max(1)).copied().collect();
        if kept.len() != theirs.len() {
            return Err(CaseError::message(format!("{} rows for {}", ours.len(), theirs.len())));
        }
        let peak = largest(ours.iter().copied());
        context.check(
            Check::new(&format!("run_up_peak_{id}"), &format!("run-up: largest distance of the {what} from the axis"), "µm", 1e6 * peak)
                .independent(1e6 * expected, &origin)
                .relative(1e-3, "critical speeds differ by 0.01 %; error of the Newmark steps, 0.06 % from 2e-5 to 1e-5 s"),
        );
        let apart = largest(kept.iter().zip(theirs).map(|(a, b)| (a - b).abs()));
        context.check(
            Check::new(
                &format!("run_up_{id}"),
                &format!("run-up: largest difference of the distance of the {what}, over its peak"),
                "1",
                apart / expected,
            )
            .independent(0.0, &origin)
            .absolute(5e-3, "phase difference of the beats after the peak"),
        );
        for (of, name) in [(ours, format!("{id}, ours")), (theirs, format!("{id}, ROSS"))] {
            let speed = |row: usize| ross.top * row as f64 / (of.len() - 1) as f64;
            let points = of.iter().enumerate().map(|(row, far)| [speed(row), 1e6 * far]);
            curves.push(Curve::new(name, points.collect()));
        }
    }
    context.finding(
        "drive",
        format!(
            "The drive torque acts along each section's own axis here. With the torque along X, ROSS gives {:.2} µm at the disc: tilted discs \
             then feel a moment of 0.07 kg m² at 5200 rad/s², 364 N m. It is proportional to the angular acceleration.",
            1e6 * ross.peak_driven_along_x
        ),
    );
    let svg = xy(&XyPlot {
        title: "Run-up of a rotor, compared with ROSS".into(),
        x: Axis::linear("speed", "rad/s"),
        y: Axis::linear("distance from the axis", "um"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("run_up", svg, "From rest to 2600 rad/s within 0.5 s under 1e-5 kg m.");
    Ok(())
}
