use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::contact::ContactRun;
use bearing_dynamics::solver::solid::equilibrium::*;
use bearing_dynamics::solver::solid::explicit::*;
use std::f64::consts::PI;
use std::time::Instant;
use verification::pressed_block::*;
use verification::solids::STEEL;
fn show(name: &str, block: &PressedBlock, line: &LineContact, u: &[[f64; 3]], r: f64, secs: f64) {
    let e = STEEL.young / (1.0 - STEEL.poisson * STEEL.poisson);
    let p0 = (line.load * e / (PI * r)).sqrt();
    let b = (4.0 * line.load * r / (PI * e)).sqrt();
    let [vm, at] = block.von_mises_below(u, 1e-9, 2.0 * b);
    let worst = line.profile.iter().map(|p| {
        let h = if p[0] < b { p0 * (1.0 - (p[0] / b).powi(2)).sqrt() } else { 0.0 };
        ((p[1] - h) / p0, p[0] / b)
    }).fold((0.0f64, 0.0), |a, b| if b.0.abs() > a.0.abs() { b } else { a });
    println!("{name}: nodes {} P' {:.1} N/mm b {:.4} mm | peak {:+.3}% b {:+.3}% vm {:.4} ({:+.2}%) at {:.3}b profile {:+.2}% at {:.3} | {secs:.2} s",
        block.mesh.nodes.len(), line.load * 1e-3, b * 1e3, 100.0 * (line.peak / p0 - 1.0), 100.0 * (line.half_width / b - 1.0),
        vm / p0, 100.0 * (vm / p0 / 0.5575 - 1.0), at / b, 100.0 * worst.0, worst.1);
}
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let order = if args[2] == "4" { Order::Linear } else { Order::Quadratic };
    let n: f64 = args[3].parse().unwrap();
    let size: f64 = args[4].parse().unwrap();
    let kappa: f64 = args[5].parse().unwrap();
    let scale: f64 = std::env::var("SCALE").map_or(1.0, |s| s.parse().unwrap());
    let halved = std::env::var("FULL").is_err();
    let b = scale * 0.377e-3;
    let r = 35.5e-3;
    let cell = b / n;
    let shape = BlockShape { order, halved, half_width: size * b, height: size * b, depth: cell, depth_cells: 1, faces: DepthFaces::Held, fine_reach: 1.5 * b, cell, growth: args.get(6).map_or(1.25, |g| g.parse().unwrap()) };
    let down = b * b / (4.0 * r) * (2.0 * (2.0 * size).ln() - 0.43);
    let penalty = Penalty::PerArea(kappa * STEEL.young / cell);
    if args[1] == "static" {
        let start = Instant::now();
        let block = pressed_block(&shape, STEEL, 0.0).unwrap();
        let c = block.cylinder(r, penalty, |s| Profile::Constant(s * down));
        let eq = equilibrium_in_contact(&block.model, 0.0, &c, None, &EquilibriumOptions::default()).unwrap();
        let secs = start.elapsed().as_secs_f64();
        println!("iterations {} factorisations {} residual {:e} deepest {:e} of {:e}", eq.solid.iterations, eq.solid.factorisations, eq.solid.residual, eq.sum.deepest, down);
        let line = line_contact(&block, &eq.nodes);
        show("static", &block, &line, &eq.solid.displacement, r, secs);
        if args.len() > 7 { for p in &line.profile { println!("{:.4} {:.1}", p[0]/b, p[1]*1e-6); } }
    } else {
        let damping: f64 = args[7].parse().unwrap();
        let ramp: f64 = args[8].parse().unwrap();
        let end: f64 = args[9].parse().unwrap();
        let start = Instant::now();
        let block = pressed_block(&shape, STEEL, damping).unwrap();
        let c = block.cylinder(r, penalty, |s| Profile::SmoothRamp { from: 0.0, to: s * down, start: 0.0, duration: ramp });
        let zeros = vec![[0.0; 3]; block.mesh.nodes.len()];
        let mut solid = ExplicitSolid::new(block.model.clone(), ExplicitMethod::CentralDifferences, SolidStepping::FractionOfLimit(1.0), zeros.clone(), zeros).unwrap();
        let limit = c.step_limit(&solid.model, &solid.limit);
        println!("limit {:e} with contact {:e}", solid.limit.step, limit.step);
        solid.step_size = 0.95 * limit.step;
        let mut run = ContactRun::new(c, &solid, 2e-5).unwrap();
        let mut next = 0.0;
        while solid.time < end {
            run.step(&mut solid).unwrap();
            if solid.time > next {
                next += end / 12.0;
                let f = run.nodal_forces(solid.time, &solid.displacement);
                let line = line_contact(&block, &f);
                let u: Vec<[f64;3]> = solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
                if line.load > 0.0 { show(&format!("t {:.2e}", solid.time), &block, &line, &u, r, start.elapsed().as_secs_f64()); }
            }
        }
        println!("steps {} counts {:?} sorts {} tested {}", solid.steps, run.counts(), run.sorts, run.tested);
        let ledger = run.ledger_at(&solid);
        let sl = solid.ledger_with(|t, u, f| run.add_forces(t, u, f));
        println!("{ledger:?} balance {:e}; solid {:?} balance - on_solid {:e}", ledger.balance(), sl, sl.balance() - ledger.on_solid);
    }
}
