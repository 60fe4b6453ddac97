//! Free vibration of a ring against a Ritz solution without a mesh, and against the thin ring.

use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::{RingMesh, ring};
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::modes::{Mode, ModeOptions, modes};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::oracles::ring::Plane;
use crate::solid_bodies::thin_ring::{self, BODY};
use crate::solids::{STEEL, Vec3, free_body, largest, mesh_of, name_of};
use crate::surface_picture::{SurfacePicture, surface_picture};

pub const CASE: Case = Case {
    id: "free_ring_modes",
    title: "Natural frequencies of a free ring",
    section: "2.2.2 and 5.3.3, (2.2)–(2.6)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let exact = thin_ring::exact();
    let families =
        [(2, Plane::In), (3, Plane::In), (2, Plane::OutOf), (3, Plane::OutOf)].map(|(n, plane)| {
            let way = if plane == Plane::In { "in" } else { "out" };
            (n, plane, format!("{way}_{n}"), exact.frequency(n, plane))
        });
    let thickness = (BODY.outer_radius - BODY.inner_radius) / 0.05;
    let mut rows = Vec::new();
    for (order, around, radial, axial) in [
        (Order::Quadratic, 32, 1, 1),
        (Order::Quadratic, 64, 1, 2),
        (Order::Quadratic, 96, 2, 3),
        (Order::Linear, 64, 1, 2),
        (Order::Linear, 192, 4, 6),
    ] {
        let cells = RingMesh { around, radial, axial, radial_growth: 1.0 };
        let mesh = mesh_of(&ring(&BODY, &cells)?, order)?;
        let model = SolidModel::new(free_body(&mesh, STEEL))?;
        let found = modes(&model, &ModeOptions::new(14))?;
        let elastic = &found.modes[6..];
        let mut row = vec![name_of(order).to_string(), mesh.nodes.len().to_string()];
        for (waves, plane, key, reference) in &families {
            let pair = pair(&mesh.nodes, elastic, *waves, *plane);
            let mean = pair.iter().map(|m| m.frequency).sum::<f64>() / pair.len() as f64;
            row.push(format!("{mean:.1} ({:+.2} %)", 100.0 * (mean / reference - 1.0)));
            if (order, around) != (Order::Quadratic, 96) {
                continue;
            }
            let (way, tolerance, reason) = match plane {
                Plane::In => ("in the plane", 2e-3, "bending of a section of two by three cells"),
                Plane::OutOf => (
                    "out of the plane",
                    5e-3,
                    "the section also twists, which two by three cells follow less closely: 1.9 % \
                     on the mesh before, 0.4 % here",
                ),
            };
            let text = format!("tet10: pair with {waves} waves {way}");
            context.check(
                Check::new(key, &format!("{text}, mean"), "Hz", mean)
                    .independent(*reference, "Ritz' method in cylindrical coordinates, no mesh")
                    .relative(tolerance, reason)
                    .golden(GoldenTolerance::MIXED),
            );
            let spread = largest(pair.iter().map(|m| (m.frequency / mean - 1.0).abs()));
            context.check(
                Check::new(
                    &format!("{key}_pair"),
                    &format!("{text}, split of its two frequencies"),
                    "1",
                    spread,
                )
                .closed_form(0.0, "a round body has them in equal pairs")
                .absolute(1e-4, "cut cells are not quite round: 1e-5"),
            );
            context.check(
                Check::new(
                    &format!("{key}_count"),
                    &format!("{text}, how many"),
                    "1",
                    pair.len() as f64,
                )
                .closed_form(2.0, "pairs")
                .absolute(0.0, "a count"),
            );
            if *plane == Plane::In {
                let n = f64::from(*waves);
                context.check(
                    Check::new(&format!("{key}_thin"), &format!("{text}, mean"), "Hz", mean)
                        .closed_form(exact.thin_ring(*waves), "Hoppe's thin ring")
                        .relative(
                            0.4 * (n * thickness).powi(2),
                            "shear and rotary inertia of a ring lower it by less than (n t/R)²/2.5",
                        ),
                );
            }
            if *waves == 2 {
                let shape = &pair[0].shape;
                context.figure(
                    &format!("shape_{key}"),
                    draw(&mesh, shape),
                    &format!(
                        "Mode with two waves {way}, {:.0} Hz; lines: at rest.",
                        pair[0].frequency
                    ),
                );
            }
        }
        rows.push(row);
        let rigid = largest(found.modes[..6].iter().map(|m| m.frequency));
        context.check(
            Check::new(
                &format!("rigid_{}_{around}", name_of(order)),
                &format!(
                    "{}, {around} cells around: highest frequency of the six rigid motions",
                    name_of(order)
                ),
                "Hz",
                rigid,
            )
            .closed_form(0.0, "a free body")
            .absolute(
                0.1,
                "rounding of K x: 1e-16 of the highest ω², some 1e13 (rad/s)², is 0.01 Hz",
            ),
        );
    }
    let mut columns = vec!["element".to_string(), "nodes".to_string()];
    columns.extend(families.iter().map(|(n, plane, _, f)| {
        format!(
            "{n} waves {} ({f:.1} Hz)",
            if *plane == Plane::In { "in plane" } else { "out of plane" }
        )
    }));
    let columns: Vec<&str> = columns.iter().map(String::as_str).collect();
    context.table(
        "study",
        "Frequencies in Hz and differences from Ritz (in the head)",
        &columns,
        rows,
    );
    Ok(())
}

/// The modes among `elastic` that bend this way with this many waves: most of the motion lies in
/// radial, or axial, displacement whose Fourier component of this order is the largest.
fn pair<'a>(nodes: &[Vec3], elastic: &'a [Mode], waves: u32, plane: Plane) -> Vec<&'a Mode> {
    elastic.iter().filter(|mode| kind(nodes, mode) == (waves, plane)).take(2).collect()
}

fn kind(nodes: &[Vec3], mode: &Mode) -> (u32, Plane) {
    let mut best = (0, Plane::In, 0.0);
    for waves in 0..6 {
        for plane in [Plane::In, Plane::OutOf] {
            let (mut cos, mut sin) = (0.0, 0.0);
            for (place, u) in nodes.iter().zip(&mode.shape) {
                let angle = place[2].atan2(place[1]);
                let moved = match plane {
                    Plane::In => u[1] * angle.cos() + u[2] * angle.sin(),
                    Plane::OutOf => u[0],
                };
                cos += moved * (f64::from(waves) * angle).cos();
                sin += moved * (f64::from(waves) * angle).sin();
            }
            let size = f64::hypot(cos, sin);
            if size > best.2 {
                best = (waves, plane, size);
            }
        }
    }
    (best.0, best.1)
}

fn draw(mesh: &bearing_dynamics::mesh::TetMesh, shape: &[Vec3]) -> String {
    let size: Vec<f64> =
        shape.iter().map(|u| u.iter().map(|x| x * x).sum::<f64>().sqrt()).collect();
    let largest = size.iter().fold(0.0f64, |m, x| m.max(*x));
    let values: Vec<f64> = size.iter().map(|x| x / largest).collect();
    let displacement: Vec<Vec3> = shape.iter().map(|u| u.map(|x| 0.01 * x / largest)).collect();
    surface_picture(&SurfacePicture {
        mesh,
        displacement: &displacement,
        values: &values,
        label: "size of displacement, largest = 1",
        azimuth: 35.0,
        elevation: 25.0,
    })
}
