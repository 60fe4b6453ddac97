//! A thick ring under inner pressure against Lamé, ends held and free.

use bearing_dynamics::kinematics::strain::{principal, von_mises};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::stress::nodal_stresses;

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::lame::Ends;
use crate::solid_bodies::thick_ring::{self, BODY};
use crate::solids::{Vec3, name_of};
use crate::surface_picture::{SurfacePicture, surface_picture};

pub const CASE: Case = Case {
    id: "thick_ring_lame",
    title: "Thick ring under inner pressure",
    section: "2.2.2, (2.2)–(2.6)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

struct Answer {
    mesh: TetMesh,
    displacement: Vec<Vec3>,
    von_mises: Vec<f64>,
    /// Mean radial displacement of the bore and the outside, m.
    bore: f64,
    outside: f64,
    /// Mean hoop stress at the bore, Pa: the largest principal stress there.
    hoop: f64,
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let exact = thick_ring::exact();
    let mut rows = Vec::new();
    for (ends, key) in [(Ends::Held, "held"), (Ends::Free, "free")] {
        let should = [
            exact.displacement(BODY.inner_radius, ends),
            exact.displacement(BODY.outer_radius, ends),
            exact.stresses(BODY.inner_radius)[1],
        ];
        for (order, around, radial) in [
            (Order::Quadratic, 24, 3),
            (Order::Quadratic, 40, 6),
            (Order::Linear, 24, 3),
            (Order::Linear, 48, 6),
            (Order::Linear, 96, 12),
        ] {
            let answer = solve(order, around, radial, ends)?;
            let found = [answer.bore, answer.outside, answer.hoop];
            let off = [0, 1, 2].map(|i: usize| found[i] / should[i] - 1.0);
            let mut row = vec![
                format!("{}, ends {key}", name_of(order)),
                answer.mesh.nodes.len().to_string(),
            ];
            row.extend(off.iter().map(|x| format!("{:+.4}", 100.0 * x)));
            rows.push(row);
            let finest = matches!((order, around), (Order::Quadratic, 40) | (Order::Linear, 96));
            if finest {
                checks(context, key, order, found, should);
            }
            if finest && order == Order::Quadratic && ends == Ends::Free {
                picture(context, &answer);
            }
        }
    }
    context.table(
        "errors",
        "Difference from Lamé in percent; displacements are means over the surface's nodes",
        &["element", "nodes", "bore moves", "outside moves", "hoop stress at the bore"],
        rows,
    );
    Ok(())
}

fn checks(context: &mut CaseContext, key: &str, order: Order, found: [f64; 3], should: [f64; 3]) {
    let name = name_of(order);
    let (moves, stress) = match order {
        Order::Quadratic => (5e-4, 1e-4),
        Order::Linear => (0.01, 0.05),
    };
    let quantities = [
        ("bore", "radial displacement of the bore", "m", moves),
        ("outside", "radial displacement of the outside", "m", moves),
        ("hoop", "hoop stress at the bore, nodal mean", "Pa", stress),
    ];
    for (i, (part, text, unit, tolerance)) in quantities.into_iter().enumerate() {
        context.check(
            Check::new(
                &format!("{name}_{key}_{part}"),
                &format!("{name}, ends {key}: {text}"),
                unit,
                found[i],
            )
            .closed_form(should[i], "Lamé")
            .relative(
                tolerance,
                match order {
                    Order::Quadratic => "mesh error: 1e-4 of displacements, 1e-5 of the mean stress at the bore, whose nodal errors alternate",
                    Order::Linear => "chords for arcs and one stress per element: second order in 0.07 of the circle, \
                                      first order for the stress at the surface",
                },
            )
            .golden(GoldenTolerance::MIXED),
        );
    }
}

fn solve(order: Order, around: usize, radial: usize, ends: Ends) -> Result<Answer, CaseError> {
    let (mesh, problem) = thick_ring::pressed(order, around, radial, ends)?;
    let model = SolidModel::new(problem)?;
    let found = equilibrium(&model, 0.0, &EquilibriumOptions::default())?;
    let stress = nodal_stresses(&model, &found.displacement);
    let mean = |set: &str, of: &dyn Fn(usize) -> f64| thick_ring::mean(&mesh, set, of);
    let outwards = |n: usize| thick_ring::outwards(mesh.nodes[n], found.displacement[n]);
    Ok(Answer {
        bore: mean("inner", &outwards)?,
        outside: mean("outer", &outwards)?,
        hoop: mean("inner", &|n| principal(&stress[n])[0])?,
        von_mises: stress.iter().map(von_mises).collect(),
        displacement: found.displacement,
        mesh,
    })
}

fn picture(context: &mut CaseContext, answer: &Answer) {
    let stress: Vec<f64> = answer.von_mises.iter().map(|t| 1e-6 * t).collect();
    let enlarged: Vec<Vec3> = answer.displacement.iter().map(|u| u.map(|x| 2.5e4 * x)).collect();
    context.figure(
        "von_mises",
        surface_picture(&SurfacePicture {
            mesh: &answer.mesh,
            displacement: &enlarged,
            values: &stress,
            label: "von Mises stress, MPa",
            azimuth: 25.0,
            elevation: 20.0,
        }),
        "Von Mises stress in the ring with free ends under 0.2 MPa at the bore, displacement 25000 times \
         enlarged; lines: undeformed.",
    );
}
