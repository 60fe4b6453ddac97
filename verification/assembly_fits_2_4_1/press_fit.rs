//! The pressure of an interference of 5 µm without load: what the contact's own stiffness K and the
//! mesh make of it.

use bearing_dynamics::ch2_housing::bore_contact::{Penalty, REFERENCE_AREA, STEEL_NODE_STIFFNESS};
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::reduction::load_patterns::race_under_load;
use bearing_dynamics::solids::bore_equilibrium::{BoreSearch, RaceLoad};
use bearing_dynamics::solids::condensation::CondensedBore;
use bearing_dynamics::solids::model::{Prescribed, SolidModel};

use super::oracle::{Ring, in_series};
use crate::case::CaseError;
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::housings::{BORE_RADIUS, WIDTH, condensed, fit, mesh, solid};
use crate::solids::{STEEL, largest, name_of};

const INTERFERENCE: f64 = 5e-6;
/// N/m³.
const STIFFNESS: f64 = STEEL_NODE_STIFFNESS / REFERENCE_AREA;
/// Of the bushing, over its bore's (`PillowBlock::proportioned`).
const OUTER: f64 = 1.4;
const CELLS: [usize; 3] = [32, 2, 2];
const HALVED: [usize; 3] = [64, 4, 4];

/// Pa.
#[derive(Clone, Copy)]
struct Pressure {
    mean: f64,
    peak: f64,
}

fn pressed(bore: &CondensedBore, stiffness: f64) -> Result<Pressure, CaseError> {
    let penalty = Penalty::PerArea(stiffness);
    let state = race_under_load(
        &mut BoreSearch::new(bore, penalty),
        &fit(INTERFERENCE),
        &RaceLoad::default(),
    )?;
    let area: f64 = bore.nodes.iter().map(|node| node.area).sum();
    let mean = state.loads.iter().sum::<f64>() / area;
    Ok(Pressure { mean, peak: largest(state.pressure(bore)) })
}

/// The bushing with its ends held too: Lamé's ring in plane strain.
fn ring() -> Result<CondensedBore, CaseError> {
    let mesh = mesh('D', Order::Quadratic, CELLS)?;
    let mut problem = solid(&mesh)?.problem;
    let ends = |mesh: &TetMesh, node: u32| mesh.nodes[node as usize][0].abs() > 0.4999 * WIDTH;
    let held: Vec<u32> = problem.prescribed.iter().map(|held| held.node).collect();
    for node in 0..mesh.nodes.len() as u32 {
        if ends(&mesh, node) && !held.contains(&node) {
            problem.prescribed.push(Prescribed { node, axis: 0, profile: Profile::ZERO });
        }
    }
    condensed(&mesh, &SolidModel::new(problem)?)
}

/// Change of mean and peak by halving all cells.
struct Change {
    housing: char,
    order: Order,
    mean: f64,
    peak: f64,
}

pub fn press_fit(context: &mut CaseContext) -> Result<(), CaseError> {
    lame(context)?;
    let (mut rows, mut changes) = (Vec::new(), Vec::new());
    for housing in ['C', 'D'] {
        for order in [Order::Linear, Order::Quadratic] {
            let mut both = Vec::new();
            for cells in [CELLS, HALVED] {
                let mesh = mesh(housing, order, cells)?;
                let bore = condensed(&mesh, &solid(&mesh)?)?;
                let found = pressed(&bore, STIFFNESS)?;
                let mut row = vec![
                    housing.to_string(),
                    name_of(order).to_string(),
                    cells.map(|n| n.to_string()).join(" × "),
                    bore.nodes.len().to_string(),
                    format!("{:.2}", 1e-6 * found.mean),
                    format!("{:.2}", 1e-6 * found.peak),
                ];
                both.push(found);
                if both.len() > 1 {
                    let change = Change {
                        housing,
                        order,
                        mean: found.mean / both[0].mean - 1.0,
                        peak: found.peak / both[0].peak - 1.0,
                    };
                    row.push(format!("{:+.2}", 100.0 * change.mean));
                    row.push(format!("{:+.2}", 100.0 * change.peak));
                    changes.push(change);
                } else {
                    row.extend([String::new(), String::new()]);
                    if order == Order::Quadratic {
                        doubled(context, housing, found, pressed(&bore, 2.0 * STIFFNESS)?);
                    }
                }
                rows.push(row);
            }
        }
    }
    context.table(
        "press_fit_mesh",
        "5 µm interference, no load: pressure on the bore, K by area, on a mesh and on one with all cells halved",
        &[
            "housing",
            "element",
            "cells",
            "nodes on the bore",
            "mean pressure, MPa",
            "peak pressure, MPa",
            "change of the mean, %",
            "of the peak, %",
        ],
        rows,
    );
    halved(context, &changes);
    Ok(())
}

/// Lamé's ring and the interface's own compliance p/K in a row.
fn lame(context: &mut CaseContext) -> Result<(), CaseError> {
    let bore = ring()?;
    let ring = Ring {
        young: STEEL.young,
        poisson: STEEL.poisson,
        inner: BORE_RADIUS,
        outer: OUTER * BORE_RADIUS,
    };
    let once = pressed(&bore, STIFFNESS)?;
    let twice = pressed(&bore, 2.0 * STIFFNESS)?;
    let known = |stiffness: f64| in_series(INTERFERENCE, ring.compliance(), 1.0 / stiffness);
    let origin = "Lamé's ring in plane strain and the interface's compliance 1/K in a row";
    for (id, what, ours, stiffness) in [
        ("press_fit_lame", "K as everywhere", once, STIFFNESS),
        ("press_fit_lame_doubled", "K doubled", twice, 2.0 * STIFFNESS),
    ] {
        context.check(
            Check::new(
                id,
                &format!("bushing with held ends, 5 µm interference, {what}: mean pressure"),
                "MPa",
                1e-6 * ours.mean,
            )
            .closed_form(1e-6 * known(stiffness), origin)
            .relative(
                2e-4,
                "error of 32 ten-node elements around 5e-5; the compliance of the interface is 8 %",
            )
            .golden(GoldenTolerance { relative: 1e-6, absolute: 0.0 }),
        );
    }
    let ratio = twice.mean / once.mean;
    context.check(
        Check::new(
            "press_fit_sensitivity",
            "the same: mean pressure with K doubled over that before",
            "1",
            ratio,
        )
        .closed_form(known(2.0 * STIFFNESS) / known(STIFFNESS), origin)
        .relative(2e-5, "the mesh's error is in both, and all but cancels: 2e-6 is left"),
    );
    Ok(())
}

/// What doubling K does in a housing.
fn doubled(context: &mut CaseContext, housing: char, once: Pressure, twice: Pressure) {
    // The housing's own mean compliance is what the springs of K leave of the interference.
    let own = INTERFERENCE / once.mean - 1.0 / STIFFNESS;
    let ratio = twice.mean / once.mean;
    let small = housing.to_ascii_lowercase();
    context.check(
        Check::new(
            &format!("press_fit_housing_{small}"),
            &format!("housing {housing}, 5 µm interference: mean pressure with K doubled over that before"),
            "1",
            ratio,
        )
        .consistency(
            in_series(INTERFERENCE, own, 0.5 / STIFFNESS) / once.mean,
            "two of our own solutions: housing and interface in a row, the housing's compliance from the first pressure",
        )
        .relative(3e-4, "the pressure is not even, so that mean compliances do not quite add: 1e-4"),
    );
    context.finding(
        &format!("doubled_stiffness_{small}"),
        format!(
            "Twice the contact stiffness (from {STIFFNESS:.1e} N/m³) moves the pressure of 5 µm interference in housing {housing} by {:+.1} % in the mean and \
             {:+.1} % at the peak: the interface gives way by p/K, in the mean {:.1} % of the interference. The stiffer the housing, the more of the \
             interference is in the penalty.",
            100.0 * (ratio - 1.0),
            100.0 * (twice.peak / once.peak - 1.0),
            100.0 * once.mean / STIFFNESS / INTERFERENCE,
        ),
    );
}

fn halved(context: &mut CaseContext, changes: &[Change]) {
    let mut parts = Vec::new();
    for change in changes {
        let Change { housing, order, mean, peak } = change;
        let name = name_of(*order);
        parts.push(format!(
            "housing {housing}, {name}: {:+.2} % in the mean, {:+.2} % at the peak",
            100.0 * mean,
            100.0 * peak
        ));
        // What does not hold is in the finding.
        let checked: &[(&str, f64)] = match (housing, order) {
            (_, Order::Linear) => &[],
            ('C', _) => &[("mean", *mean)],
            _ => &[("mean", *mean), ("peak", *peak)],
        };
        for (what, ours) in checked {
            context.check(
                Check::new(
                    &format!("press_fit_mesh_{}_{what}", housing.to_ascii_lowercase()),
                    &format!("housing {housing}, 5 µm interference, {name}: {what} pressure with all cells halved, less one"),
                    "1",
                    *ours,
                )
                .consistency(0.0, "the mesh with all cells halved")
                .absolute(0.02, "a pressure by area is not to depend on the mesh by more than 2 %"),
            );
        }
    }
    context.finding(
        "press_fit_halved",
        format!(
            "All cells halved, the pressure of 5 µm interference changes: {}. Two per cent hold with ten-node elements for the mean in both housings and for \
             the peak in the bushing. They do not hold for the peak in housing C, 1.4 times the mean, \
             nor for four-node elements of this size, which are too stiff.",
            parts.join("; ")
        ),
    );
}
