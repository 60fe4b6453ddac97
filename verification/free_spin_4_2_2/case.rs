//! A free solid that spins: strain of rigid rotation, centrifugal growth, momentum, and what damping takes of it.

use bearing_dynamics::elements::tet4::{Tet4, relative};
use bearing_dynamics::elements::tet10::{POINTS, Tet10};
use bearing_dynamics::kinematics::strain::green_lagrange;
use bearing_dynamics::mesh::generate::shaft;
use bearing_dynamics::mesh::{Elements, Order};
use bearing_dynamics::scene::build::solid::setup;
use bearing_dynamics::scene::build::solid_mesh::build;
use bearing_dynamics::scene::{Document, Format, Subject, resolve_subject};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{DampedMotion, SolidModel, SolidProblem, corners};
use nalgebra::{Rotation3, Vector3};
use std::f64::consts::TAU;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::motion::SPINNING_DISC;
use crate::solids::{STEEL, Vec3, free_body, largest, mesh_of, name_of};

pub const CASE: Case = Case {
    id: "free_spin_4_2_2",
    title: "A free solid at 10 000 rpm: strain, growth, momentum",
    section: "2.2.2, (2.2)–(2.7), 4.2.2",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// m.
const RADIUS: f64 = 0.1;
/// rad/s.
const SPIN: f64 = 10_000.0 * TAU / 60.0;
/// Turns after which the disc is looked at; e^(−αt/2) of its swing is 1e-13 by then.
const TURNS: f64 = 2.0;

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    rigid(context)?;
    let mut errors = Vec::new();
    let mut rows = Vec::new();
    for times in [1, 2] {
        let spun = Spun::new(times)?;
        let exact = growth(spun.spin_at_end);
        let error = spun.growth / exact - 1.0;
        rows.push(vec![
            spun.solid.model.mass.len().to_string(),
            format!("{:.4}", 1e6 * spun.growth),
            format!("{:.4}", 1e6 * exact),
            format!("{:+.3}", 100.0 * error),
        ]);
        errors.push(error);
        if times == 2 {
            checks(context, &spun, exact);
        }
    }
    let columns = ["nodes", "growth, µm", "closed form, µm", "off, %"];
    context.table("rim", "Mean growth of the rim after two turns", &columns, rows);
    let order = (errors[0] / errors[1]).log2();
    context.check(
        Check::new("order", "order of the growth's error, cells of 1 and 1/2", "1", order)
            .closed_form(2.0, "four-node elements, chords instead of arcs")
            .absolute(0.4, "two coarse meshes"),
    );
    absolute(context)
}

/// Mean displacement of the rim of a disc in plane stress at `spin` (rad/s), m. The exact solution of a disc of finite thickness has the
/// same mean over the thickness (Timoshenko and Goodier, art. 134).
fn growth(spin: f64) -> f64 {
    (1.0 - STEEL.poisson) * STEEL.density * spin * spin * RADIUS.powi(3) / (4.0 * STEEL.young)
}

/// Largest component of Green's strain, over all elements and points.
fn strain(problem: &SolidProblem, displacement: &[Vec3]) -> Result<Vec<[f64; 6]>, CaseError> {
    let mut all = Vec::new();
    match &problem.elements {
        Elements::Linear(list) => {
            for element in list {
                let tet = Tet4::new(&corners(&problem.nodes, element))?;
                let moved = relative(&corners(displacement, element));
                all.push(green_lagrange(&tet.displacement_gradient(&moved)));
            }
        }
        Elements::Quadratic(list) => {
            for element in list {
                let tet = Tet10::new(&corners(&problem.nodes, element))?;
                let moved = corners(displacement, element);
                for point in 0..POINTS {
                    all.push(green_lagrange(&tet.displacement_gradient(point, &moved)));
                }
            }
        }
    }
    Ok(all)
}

/// Nodes turned by large angles about axes of no mesh and carried far: no strain, no force.
fn rigid(context: &mut CaseContext) -> Result<(), CaseError> {
    for order in [Order::Linear, Order::Quadratic] {
        let solid = shaft(0.015, &[-0.2, 0.2], 0.02, 16, 2)?;
        let mesh = mesh_of(&solid, order)?;
        let problem = free_body(&mesh, STEEL);
        let (mut strains, mut forces) = (0.0f64, 0.0f64);
        let model = SolidModel::new(problem.clone())?;
        for (axis, angle) in [
            ([1.0, 0.0, 0.0], 0.5),
            ([1.0, 0.0, 0.0], std::f64::consts::PI),
            ([0.3, -0.8, 0.6], 2.2),
            ([0.1, 0.2, -0.9], 1000.0),
        ] {
            let turn = Rotation3::from_scaled_axis(Vector3::from(axis).normalize() * angle);
            let shift = Vector3::new(0.4, -1.0, 2.0);
            let displacement: Vec<Vec3> = problem
                .nodes
                .iter()
                .map(|x| (turn * Vector3::from(*x) + shift - Vector3::from(*x)).into())
                .collect();
            let of = strain(&problem, &displacement)?;
            strains = largest([strains, largest(of.iter().flatten().map(|e| e.abs()))]);
            let padded: Vec<_> = displacement.iter().map(|u| [u[0], u[1], u[2], 0.0]).collect();
            let mut on = vec![[0.0; 4]; padded.len()];
            model.add_internal_forces(&padded, &mut on);
            forces = largest([forces, largest(on.iter().flatten().map(|f| f.abs()))]);
        }
        let name = name_of(order);
        let what = format!("{name}: largest strain of rigid rotations by up to 1000 rad");
        context.check(
            Check::new(&format!("rigid_{name}"), &what, "1", strains)
                .closed_form(0.0, "a rigid motion strains nothing")
                .absolute(1e-9, "asked for; rounding of displacements of metres over cells of millimetres is 1e-13"),
        );
        context.finding(
            &format!("rigid_forces_{name}"),
            format!("{name}: the largest strain is {strains:.1e}, the largest nodal force {forces:.1e} N; E h² of these cells is {:.1e} N.", STEEL.young * 4e-6),
        );
    }
    Ok(())
}

/// A disc after [`TURNS`].
struct Spun {
    solid: ExplicitSolid,
    /// Angular momentum about X at first and at last, kg·m²/s.
    momentum: [f64; 2],
    /// Largest change of linear momentum and of that about Y and Z, over the spin's.
    others: f64,
    spin_at_end: f64,
    /// Mean over the rim, m.
    growth: f64,
    /// Largest change of a strain over the last turn, and the largest strain.
    change: f64,
    strain: f64,
}

impl Spun {
    /// The scene with `times` its cells.
    fn new(times: usize) -> Result<Spun, CaseError> {
        let coarse = "cells = { along = 1, around = 24, radial = 3 }";
        let finer =
            format!("cells = {{ along = 1, around = {}, radial = {} }}", 24 * times, 3 * times);
        let text = SPINNING_DISC.replace(coarse, &finer);
        if times > 1 && text == SPINNING_DISC {
            return Err(CaseError::message("the scene has other cells"));
        }
        let document = Document::read_str(&text, Format::Toml, "spinning_disc.toml")?;
        let Subject::Solid(scene) = resolve_subject(&document)? else {
            return Err(CaseError::message("no solid in the scene"));
        };
        let built = build(&scene.mesh)?;
        let rim = built.mesh.node_set("outer")?.to_vec();
        let setup = setup(&scene, &built)?;
        let still = vec![[0.0; 3]; setup.problem.nodes.len()];
        let model = SolidModel::new(setup.problem)?;
        let (method, stepping) =
            (ExplicitMethod::CentralDifferences, SolidStepping::FractionOfLimit(0.8));
        let mut solid = ExplicitSolid::new(model, method, stepping, still, setup.velocity)?;
        solid.step(|_, _, _| {})?;
        let first = momenta(&solid);
        let end = TURNS * TAU / SPIN;
        let spin_until = |solid: &mut ExplicitSolid, t: f64| -> Result<(), CaseError> {
            while solid.time < t {
                solid.step(|_, _, _| {})?;
            }
            Ok(())
        };
        spin_until(&mut solid, end - TAU / SPIN)?;
        let before = strain(&solid.model.problem, &places(&solid))?;
        spin_until(&mut solid, end)?;
        let after = strain(&solid.model.problem, &places(&solid))?;
        let changes =
            before.iter().flatten().zip(after.iter().flatten()).map(|(a, b)| (a - b).abs());
        let change = largest(changes);
        let last = momenta(&solid);
        let axial = first[1].x;
        let changes = [(last[0] - first[0]) * RADIUS, last[1] - first[1]];
        let others = largest(changes.iter().flat_map(|of| of.iter()).map(|x| (x / axial).abs()));
        let model = &solid.model;
        let (mut grown, mut inertia) = (0.0, 0.0);
        let nodes = model.problem.nodes.iter().zip(&solid.displacement).zip(&model.mass);
        for ((x, u), mass) in nodes {
            inertia += mass * ((x[1] + u[1]).powi(2) + (x[2] + u[2]).powi(2));
        }
        for node in &rim {
            let (x, u) = (model.problem.nodes[*node as usize], solid.displacement[*node as usize]);
            grown += (x[1] + u[1]).hypot(x[2] + u[2]) - x[1].hypot(x[2]);
        }
        let spin_at_end = last[1].x / inertia;
        let growth = grown / rim.len() as f64;
        let strain = largest(after.iter().flatten().map(|e| e.abs()));
        Ok(Spun {
            momentum: [first[1].x, last[1].x],
            others,
            spin_at_end,
            growth,
            change,
            strain,
            solid,
        })
    }
}

fn places(solid: &ExplicitSolid) -> Vec<Vec3> {
    solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect()
}

/// Linear momentum and that about the origin. Rates are those of half a step before: a node has moved along its own since, so that
/// place × rate is that of either end.
fn momenta(solid: &ExplicitSolid) -> [Vector3<f64>; 2] {
    let mut sums = [Vector3::zeros(); 2];
    let nodes = solid.model.problem.nodes.iter().zip(&solid.displacement);
    for (((x, u), rate), mass) in nodes.zip(solid.rates()).zip(&solid.model.mass) {
        let place = Vector3::new(x[0] + u[0], x[1] + u[1], x[2] + u[2]);
        let momentum = Vector3::new(rate[0], rate[1], rate[2]) * *mass;
        sums[0] += momentum;
        sums[1] += place.cross(&momentum);
    }
    sums
}

fn checks(context: &mut CaseContext, spun: &Spun, exact: f64) {
    context.check(
        Check::new("growth", "mean growth of the rim after two turns", "m", spun.growth)
            .closed_form(exact, "rotating disc in plane stress")
            .relative(5e-3, "asked for; four-node elements of a twelfth of the radius")
            .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new(
            "strain_keeps",
            "largest change of a strain over the last turn",
            "1",
            spun.change,
        )
        .closed_form(0.0, "a rigid rotation of a strained body strains it no further")
        .absolute(1e-9, "asked for of rigid rotation; lumped masses of tetrahedra are not quite in balance and the disc wobbles, once a turn as it sees it"),
    );
    context.check(
        Check::new(
            "strain_size",
            "largest strain, which is that of centrifugal forces",
            "1",
            spun.strain,
        )
        .closed_form(
            (3.0 + STEEL.poisson)
                * (1.0 - STEEL.poisson)
                * STEEL.density
                * (spun.spin_at_end * RADIUS).powi(2)
                / (8.0 * STEEL.young),
            "in the middle of the disc",
        )
        .relative(0.05, "one strain per element, some way off the middle"),
    );
    let [first, last] = spun.momentum;
    context.check(
        Check::new(
            "momentum",
            "change of the angular momentum in two turns, damped relative to rigid motion",
            "1",
            last / first - 1.0,
        )
        .closed_form(0.0, "no moment acts")
        .absolute(1e-9, "asked for; rounding of ten thousand steps"),
    );
    context.check(
        Check::new(
            "other_momenta",
            "largest change of linear and angular momenta in two turns, over the angular momentum about X",
            "1",
            spun.others,
        )
        .closed_form(0.0, "no force acts")
        .absolute(1e-9, "asked for; rounding of ten thousand steps"),
    );
    context.work("steps", spun.solid.steps);
}

/// (2.7) in absolute axes brakes the rotation itself: e^(−αt).
fn absolute(context: &mut CaseContext) -> Result<(), CaseError> {
    const DAMPING: f64 = 100.0;
    let solid = shaft(RADIUS, &[-0.005, 0.005], 0.01, 24, 3)?;
    for (motion, id, exact) in [
        (DampedMotion::Absolute, "absolute", 1.0),
        (DampedMotion::RelativeToRigid, "relative", 0.0),
    ] {
        let mut problem = free_body(&solid.mesh, STEEL);
        problem.damping = DAMPING;
        problem.damped_motion = motion;
        let velocity = problem.nodes.iter().map(|x| [0.0, -SPIN * x[2], SPIN * x[1]]).collect();
        let still = vec![[0.0; 3]; problem.nodes.len()];
        let (method, stepping) =
            (ExplicitMethod::CentralDifferences, SolidStepping::FractionOfLimit(0.8));
        let model = SolidModel::new(problem)?;
        let mut solid = ExplicitSolid::new(model, method, stepping, still, velocity)?;
        solid.step(|_, _, _| {})?;
        let (first, start) = (momenta(&solid)[1].x, solid.time);
        while solid.time < 3e-3 {
            solid.step(|_, _, _| {})?;
        }
        let lost = (first / momenta(&solid)[1].x).ln() / (DAMPING * (solid.time - start));
        context.check(
            Check::new(
                &format!("brake_{id}"),
                &format!("damping, {id}: ln(L₀/L) over αt of the spin"),
                "1",
                lost,
            )
            .closed_form(exact, "a spinning body under a brake of αm times velocity")
            .absolute(1e-8, "central differences are off by (αh)²/12"),
        );
    }
    Ok(())
}
