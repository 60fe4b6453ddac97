//! The rotor from rest through its first critical speed, by the program and by ROSS' Newmark steps.

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

/// What ROSS did: displacements (m) along both lateral axes at both places, a row each `interval`, s.
#[derive(Debug, Deserialize)]
pub struct RunUp {
    pub rows: Vec<[f64; 4]>,
    interval: f64,
    top: f64,
    end: f64,
    step: f64,
    /// At the first place with the moment that a drive along X leaves on tilted discs, m.
    peak_driven_along_x: f64,
}

impl RunUp {
    /// To the digits that are kept.
    pub fn is_like(&self, other: &RunUp) -> bool {
        let all = |of: &RunUp| of.rows.iter().flatten().copied().collect::<Vec<_>>();
        let (own, others) = (all(self), all(other));
        let size = largest(others.iter().map(|far| far.abs()));
        own.len() == others.len()
            && own.iter().zip(&others).all(|(a, b)| (a - b).abs() <= 1e-6 * size)
    }
}

/// Along X, Y and Z, N/m and N·s/m: ROSS has nothing along the axis, where nothing moves.
const HOLDS: [([f64; 3], [f64; 3]); 2] =
    [([1e6, 4e7, 7e7], [0.0, 500.0, 800.0]), ([1e6, 6e7, 9e7], [0.0, 700.0, 700.0])];
const COLUMNS: [&str; 4] = ["rotor_disc_y", "rotor_disc_z", "rotor_end_y", "rotor_end_z"];

/// Distances from the axis at the disc and at the end, row by row, m.
fn ours() -> Result<[Vec<f64>; 2], CaseError> {
    let scene = changed_scene(include_str!("scene.toml"), &[])?;
    let mut assembly = scene.assembly()?;
    for (bearing, (stiffness, damping)) in
        std::mem::take(&mut assembly.bearings).into_iter().zip(HOLDS)
    {
        let [inner, outer] = bearing.mounts;
        let six = |[x, y, z]: [f64; 3]| [x, y, z, 0.0, 0.0, 0.0];
        let (stiffness, damping) = (six(stiffness), six(damping));
        let law = SpringDashpot { stiffness, damping, ..SpringDashpot::default() };
        let (name, ends, law) = ("a bearing".into(), [outer, inner], Law::SpringDashpot(law));
        assembly.connections.push(Connection { name, label: None, ends, law });
    }
    // An accuracy is one of contacts, which are not there: classical Runge-Kutta.
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
    for ((ours, theirs), (id, what)) in ours()?
        .iter()
        .zip(&theirs)
        .zip([("disc", "disc at 250 mm"), ("end", "overhung disc at 500 mm")])
    {
        if ours.len() != theirs.len() {
            return Err(CaseError::message(format!("{} rows for {}", ours.len(), theirs.len())));
        }
        let [peak, expected] = [ours, theirs].map(|of| largest(of.iter().copied()));
        context.check(
            Check::new(&format!("run_up_peak_{id}"), &format!("run-up: largest distance of the {what} from the axis"), "µm", 1e6 * peak)
                .independent(1e6 * expected, &origin)
                .relative(1e-3, "resonances 0.01 % apart, and what Newmark's steps leave: 0.06 % from 2e-5 to 1e-5 s"),
        );
        let apart = largest(ours.iter().zip(theirs).map(|(a, b)| (a - b).abs()));
        context.check(
            Check::new(&format!("run_up_{id}"), &format!("run-up: largest difference of that distance in any row, over its largest, {what}"), "1", apart / expected)
                .independent(0.0, &origin)
                .absolute(5e-3, "beats after the peak whose phases run apart"),
        );
        for (of, name) in [(ours, format!("{id}, ours")), (theirs, format!("{id}, ROSS"))] {
            let speed = |row: usize| ross.top / ross.end * ross.interval * row as f64;
            let points = of.iter().enumerate().map(|(row, far)| [speed(row), 1e6 * far]);
            curves.push(Curve::new(name, points.collect()));
        }
    }
    context.finding(
        "drive",
        format!(
            "What drives the spin acts along each section's own axis here. With the moment that a torque along X leaves on tilted discs as they are sped up ROSS has {:.2} µm at the \
             disc: 0.07 kg m² at 5200 rad/s² are 364 N m. It goes with the rate of the speed.",
            1e6 * ross.peak_driven_along_x
        ),
    );
    let svg = xy(&XyPlot {
        title: "A rotor run up, beside ROSS".into(),
        x: Axis::linear("speed", "rad/s"),
        y: Axis::linear("distance from the axis", "um"),
        style: Style::Lines,
        curves,
    })?;
    context.figure("run_up", svg, "From rest to 2600 rad/s within 0.5 s under 1e-5 kg m.");
    Ok(())
}
