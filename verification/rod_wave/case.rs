//! A push travels along a rod: speed and size of the wave by explicit steps.

use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{Load, SolidModel};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::solids::{STEEL, Vec3, free_body, mesh_of, name_of, size_of, surface_force};

mod oracle;

pub const CASE: Case = Case {
    id: "rod_wave",
    title: "Wave along a rod",
    section: "2.2.2, (2.2)–(2.7)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Rod, m, with free sides.
const LENGTH: f64 = 0.2;
const SIDE: f64 = 2e-3;
/// Pressure on its end, Pa, rising and falling within this time, s.
const PRESSURE: f64 = 1e6;
const DURATION: f64 = 20e-6;
/// Stations, m from the pushed end; the wave is wholly past the second before its reflection comes.
const STATIONS: [f64; 2] = [0.06, 0.12];

struct Passage {
    mesh: String,
    /// Half-way times at the stations, s.
    times: [f64; 2],
    /// Displacement behind the wave at the first station, m.
    behind: f64,
    steps: u64,
    curves: [Vec<[f64; 2]>; 2],
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let speed = oracle::bar_speed(STEEL.young, STEEL.density);
    let gyration = SIDE / 6f64.sqrt();
    let slowing =
        oracle::love_slowing(STEEL.poisson, std::f64::consts::TAU / (speed * DURATION), gyration);
    let impulse = PRESSURE * SIDE * SIDE * 0.5 * DURATION;
    let behind = oracle::displacement_behind(impulse, STEEL.density, SIDE * SIDE, speed);
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    for (order, cells, method, key) in [
        (Order::Linear, [200, 2, 2], ExplicitMethod::CentralDifferences, "tet4_central"),
        (Order::Linear, [100, 1, 1], ExplicitMethod::RungeKutta, "tet4_rk4"),
        (Order::Quadratic, [50, 1, 1], ExplicitMethod::CentralDifferences, "tet10_central"),
        (Order::Quadratic, [50, 1, 1], ExplicitMethod::RungeKutta, "tet10_rk4"),
    ] {
        let passage = passage(order, cells, method)?;
        let found = (STATIONS[1] - STATIONS[0]) / (passage.times[1] - passage.times[0]);
        context.check(
            Check::new(&format!("speed_{key}"), &format!("{key}: speed of the wave"), "m/s", found)
                .closed_form(speed, "√(E/ρ) of a thin rod")
                .relative(
                    1e-3,
                    "waves of a tenth of a metre in linear cells of 2 mm: (2π·2/103)²/24 = 6e-4; \
                     lateral inertia slows by 1e-4 (Love)",
                )
                .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(
                &format!("behind_{key}"),
                &format!("{key}: displacement behind the wave, 0.06 m from the end"),
                "m",
                passage.behind,
            )
            .closed_form(behind, "impulse over ρ A c")
            .relative(2e-4, "the impulse is conserved; oscillations behind the front leave 3e-5")
            .golden(GoldenTolerance::MIXED),
        );
        rows.push(vec![
            key.to_string(),
            name_of(order).to_string(),
            passage.mesh,
            passage.steps.to_string(),
            format!("{found:.1}"),
            format!("{:+.3}", 100.0 * (found / speed - 1.0)),
        ]);
        if method == ExplicitMethod::CentralDifferences {
            let [first, second] = passage.curves;
            curves.push(Curve::new(format!("{} 60 mm", name_of(order)), first));
            curves.push(Curve::new(format!("{} 120 mm", name_of(order)), second));
        }
    }
    context.table(
        "passages",
        "Speed between two stations",
        &["run", "element", "mesh", "steps", "speed, m/s", "off √(E/ρ), %"],
        rows,
    );
    let plot = XyPlot {
        title: "Displacement at two sections of the rod".into(),
        x: Axis::linear("time", "µs"),
        y: Axis::linear("displacement", "µm"),
        curves,
        style: Style::Lines,
    };
    context.figure(
        "passage",
        xy(&plot)?,
        "Mean axial displacement of two sections while a push of 20 µs passes, linear elements of 1 mm and \
         quadratic ones of 4 mm: the curves lie on one another.",
    );
    context.finding(
        "lateral_inertia",
        format!(
            "At the push's basic wave length lateral inertia slows the phases by {:.1e} of the speed (Love), \
             which the tolerance contains.",
            slowing
        ),
    );
    Ok(())
}

fn passage(order: Order, cells: [usize; 3], method: ExplicitMethod) -> Result<Passage, CaseError> {
    let mesh = mesh_of(&bar([LENGTH, SIDE, SIDE], cells)?, order)?;
    let mut problem = free_body(&mesh, STEEL);
    let forces = surface_force(&mesh, mesh.surface_set("x_low")?, |_, n| n.map(|n| -PRESSURE * n));
    // Up within half of the time and down within the other: two smooth ramps.
    for (to, start) in [(1.0, 0.0), (-1.0, 0.5 * DURATION)] {
        let profile = Profile::SmoothRamp { from: 0.0, to, start, duration: 0.5 * DURATION };
        problem.loads.push(Load { forces: forces.clone(), profile });
    }
    let sections: [Vec<usize>; 2] = STATIONS.map(|at| {
        let near = |x: &Vec3| (x[0] - at).abs() <= 1e-9;
        (0..mesh.nodes.len()).filter(|n| near(&mesh.nodes[*n])).collect()
    });
    let still = vec![[0.0; 3]; mesh.nodes.len()];
    let model = SolidModel::new(problem)?;
    let stepping = SolidStepping::FractionOfLimit(0.8);
    let mut solid = ExplicitSolid::new(model, method, stepping, still.clone(), still)?;
    let mut curves: [Vec<[f64; 2]>; 2] = Default::default();
    let end = 52e-6;
    while solid.time < end {
        solid.step(|_, _, _| {})?;
        for (curve, section) in curves.iter_mut().zip(&sections) {
            let sum: f64 = section.iter().map(|n| solid.displacement[*n][0]).sum();
            curve.push([1e6 * solid.time, 1e6 * sum / section.len() as f64]);
        }
    }
    // Behind the first station, until the reflection from the far end returns.
    let speed = (STEEL.young / STEEL.density).sqrt();
    let quiet = [STATIONS[0] / speed + 1.3 * DURATION, (2.0 * LENGTH - STATIONS[0]) / speed]
        .map(|t| 1e6 * t);
    let past: Vec<f64> =
        curves[0].iter().filter(|p| p[0] > quiet[0] && p[0] < quiet[1]).map(|p| p[1]).collect();
    let behind = 1e-6 * past.iter().sum::<f64>() / past.len() as f64;
    let times = [0, 1].map(|i: usize| crossing(&curves[i], 0.5 * 1e6 * behind) * 1e-6);
    let curves = curves.map(|c| c.into_iter().step_by(8).collect());
    Ok(Passage { mesh: size_of(&mesh), times, behind, steps: solid.steps, curves })
}

/// Where a rising curve first passes a level, linear between its points; NaN if never.
fn crossing(curve: &[[f64; 2]], level: f64) -> f64 {
    let passed = curve.windows(2).find(|pair| pair[0][1] < level && pair[1][1] >= level);
    passed.map_or(f64::NAN, |pair| {
        let [a, b] = [pair[0], pair[1]];
        a[0] + (b[0] - a[0]) * (level - a[1]) / (b[1] - a[1])
    })
}
