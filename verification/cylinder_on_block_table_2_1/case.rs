//! The cylinder on a block of 2.3.2 at six indentations: four readings of Table 2.1.

use bearing_dynamics::ch2_housing::bore_contact::{
    ContactNode, Penalty, STEEL_NODE_STIFFNESS, contact_nodes,
};
use bearing_dynamics::kinematics::strain::von_mises;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_in_contact};
use bearing_dynamics::solids::stress::nodal_stresses;

use crate::case::{Case, CaseError, Tier};
use crate::check::{Check, Explanation};
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::pressed_block::{BlockShape, DepthFaces, PressedBlock, line_contact, pressed_block};
use crate::solids::{Material, Vec3, largest, size_of};
use crate::surface_picture::{SurfacePicture, surface_picture};

pub mod oracle;

pub const CASE: Case = Case {
    id: "cylinder_on_block_table_2_1",
    title: "Cylinder on a block",
    section: "2.3.2, Table 2.1",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

/// 2.3.2.
const RADIUS: f64 = 35.5e-3;
const STEEL: Material = Material { young: 210e9, poisson: 0.3, density: 7850.0 };
/// µm, with the name in the published data.
const INDENTATIONS: [(&str, f64); 6] =
    [("0p5", 0.5), ("1", 1.0), ("2", 2.0), ("3", 3.0), ("4", 4.0), ("5", 5.0)];
/// The largest half contact width, which sizes the block; not stated. m.
const HALF_WIDTH: f64 = 0.377e-3;
/// Peak contact pressures of a separate solver for the slab with free depth faces, small strains, MPa.
/// Kept as these numbers alone: the solver is not part of this case, as `oracle.rs` is.
const SEPARATE_SOLVER: [f64; 6] = [309.9, 462.0, 693.0, 882.9, 1051.9, 1208.1];
const SEPARATE: &str =
    "a separate solver, same block, converged mesh, small strains; kept as numbers alone";

/// Where von Mises stress and pressure are shown to lie, by the second solver in the plane, MPa.
struct InPlane {
    strain: Vec<oracle::Pressed>,
    stress: Vec<oracle::Pressed>,
}

/// How the numbers of the reading that is taken come to be met.
const CHOSEN: &str = "the reading was chosen among four because it meets this table, and this number took part in \
                      the choice; no number was adjusted";

/// One reading at the six indentations.
struct Answers {
    mesh: String,
    displacement: Vec<Vec<Vec3>>,
    /// Over areas as strained, and as undeformed.
    pressure: Vec<f64>,
    undeformed: Vec<f64>,
    von_mises: Vec<f64>,
    half_width: Vec<f64>,
    load: Vec<f64>,
}

/// How the block is meshed and pressed.
#[derive(Clone, Copy)]
struct Setting {
    faces: DepthFaces,
    /// In a half width along Y and Z.
    cells: f64,
    /// Over half of the depth.
    depth_cells: usize,
    /// Contact stiffness by area over the printed one at nodes of (b/10)².
    hardness: f64,
    /// Of the strains: indentation times this, radius over this, so that the contact keeps its width.
    scale: f64,
}

const FINE: Setting =
    Setting { faces: DepthFaces::Free, cells: 12.0, depth_cells: 4, hardness: 30.0, scale: 1.0 };
const COARSE: Setting = Setting { cells: 8.0, ..FINE };
/// With a tenth of the strains.
const GENTLE: Setting = Setting { scale: 0.1, ..COARSE };

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    assumptions(context);
    let all: Vec<usize> = (0..INDENTATIONS.len()).collect();
    let slab = solve(Some(context), FINE, &all, None)?;
    let plane = solve(None, Setting { faces: DepthFaces::Held, ..FINE }, &all, None)?;
    let in_plane = in_plane();
    offset(context, &slab)?;
    held_against_plane(context, &slab, &plane, &in_plane);
    readings(context, &slab, &plane);
    not_von_mises(context, &slab, &plane);
    tables(context, &slab, &plane);
    figure(context, &slab, &plane)
}

fn assumptions(context: &mut CaseContext) {
    context.assumption(
        "slab",
        "Table 2.1 does not say which stress is largest, nor what holds block and depth faces. Taken: peak \
         contact pressure of a slab whose depth faces are free, base fixed, sides free. Chosen among four readings because \
         it is the one that meets the table; nothing in it is adjusted.",
        "peak contact pressure, free depth faces",
    );
    context.finding(
        "plane_strain_rejected",
        "The other reading of how the block is held, both depth faces kept in their planes, is rejected as a whole: eight of its twelve \
         pressures are too high by 4 to 8 %, the more the wider the contact, and von Mises stress is too low throughout. Four single \
         pressures up to 2 µm come within 4 % nevertheless: no evidence for plane strain, so that they claim nothing and no check \
         holds them against the table.",
    );
    context.assumption(
        "half_width",
        "The block's size is given in the largest half contact width, which is not stated: the one that \
         the block itself reaches at 5 µm.",
        "b = 0.377 mm; block 8 b × 5 b × b",
    );
    context.assumption(
        "penalty",
        "By area, so hard that it no longer matters: thirty times what makes the printed 2.5e8 N/m at nodes of a \
         tenth of b squared.",
        "5.3e18 N/m³",
    );
}

/// The block pressed by the indentations of `rows`, each from the one before it, or from the solution
/// of the same mesh in `near`, which has all of them.
fn solve(
    mut picture: Option<&mut CaseContext>,
    setting: Setting,
    rows: &[usize],
    near: Option<&Answers>,
) -> Result<Answers, CaseError> {
    let (depth, depth_cells) = match setting.faces {
        DepthFaces::Free => (0.5 * HALF_WIDTH, setting.depth_cells),
        DepthFaces::Held => (HALF_WIDTH / setting.cells, 1),
    };
    let shape = BlockShape {
        order: Order::Quadratic,
        halved: true,
        half_width: 4.0 * HALF_WIDTH,
        height: 5.0 * HALF_WIDTH,
        depth,
        depth_cells,
        faces: setting.faces,
        fine_reach: 1.25 * HALF_WIDTH,
        cell: HALF_WIDTH / setting.cells,
        growth: 1.4,
    };
    let block = pressed_block(&shape, STEEL, 0.0)?;
    let hardness = setting.hardness * STEEL_NODE_STIFFNESS / (0.1 * HALF_WIDTH).powi(2);
    let mut answers = Answers {
        mesh: size_of(&block.mesh),
        displacement: Vec::new(),
        pressure: Vec::new(),
        undeformed: Vec::new(),
        von_mises: Vec::new(),
        half_width: Vec::new(),
        load: Vec::new(),
    };
    let mega = 1e-6 / setting.scale;
    for &row in rows {
        let indentation = INDENTATIONS[row].1;
        let like = near.map(|near| -> Vec<Vec3> {
            near.displacement[row].iter().map(|u| u.map(|x| setting.scale * x)).collect()
        });
        let start = like.as_ref().or(answers.displacement.last());
        let down = |sign: f64| Profile::Constant(sign * 1e-6 * indentation * setting.scale);
        let contact = block.cylinder(RADIUS / setting.scale, Penalty::PerArea(hardness), down);
        let options = EquilibriumOptions::default();
        let start = start.map(Vec::as_slice);
        let found = equilibrium_in_contact(&block.model, 0.0, &contact, start, &options)?;
        let displacement = found.solid.displacement;
        let stresses: Vec<f64> = nodal_stresses(&block.model, &displacement)
            .iter()
            .map(|s| mega * von_mises(s))
            .collect();
        let line = line_contact(&block, &found.nodes);
        answers.pressure.push(mega * present_pressure(&block, &found.nodes, &displacement)?);
        answers.undeformed.push(mega * found.sum.peak_pressure);
        answers.von_mises.push(largest(stresses.iter().copied()));
        answers.half_width.push(1e6 * line.half_width);
        answers.load.push(1e-3 * line.load / setting.scale);
        if let Some(context) = picture.as_deref_mut()
            && indentation == 5.0
        {
            let enlarged: Vec<Vec3> = displacement.iter().map(|u| u.map(|x| 100.0 * x)).collect();
            context.figure(
                "von_mises",
                surface_picture(&SurfacePicture {
                    mesh: &block.mesh,
                    displacement: &enlarged,
                    values: &stresses,
                    label: "von Mises stress, MPa",
                    azimuth: 20.0,
                    elevation: 18.0,
                }),
                "As Fig. 2.8: von Mises stress in a quarter of the slab at 5 µm, deformation 100 times; the free \
                 depth face in front, the plane of symmetry under the cylinder at the left; lines: undeformed.",
            );
        }
        answers.displacement.push(displacement);
    }
    Ok(answers)
}

/// The second solver, in plane strain and in plane stress.
fn in_plane() -> InPlane {
    let pressed = |plane: oracle::Plane| -> Vec<oracle::Pressed> {
        let block = oracle::Block {
            half_width: 4.0 * HALF_WIDTH,
            height: 5.0 * HALF_WIDTH,
            fine: 1.25 * HALF_WIDTH,
            cell: HALF_WIDTH / 40.0,
            young: STEEL.young,
            poisson: STEEL.poisson,
            plane,
        };
        let block = block.factor();
        INDENTATIONS.iter().map(|(_, d)| block.pressed(RADIUS, 1e-6 * d)).collect()
    };
    InPlane { strain: pressed(oracle::Plane::Strain), stress: pressed(oracle::Plane::Stress) }
}

/// What lies between our pressures and those of the separate solver, part by part.
fn offset(context: &mut CaseContext, fine: &Answers) -> Result<(), CaseError> {
    let all: Vec<usize> = (0..INDENTATIONS.len()).collect();
    let coarse = solve(None, COARSE, &all, None)?;
    let gentle = solve(None, GENTLE, &all, Some(&coarse))?;
    let ends = [0, INDENTATIONS.len() - 1];
    let soft =
        solve(None, Setting { hardness: 0.25 * COARSE.hardness, ..COARSE }, &ends, Some(&coarse))?;
    let thick = solve(None, Setting { depth_cells: 2, ..COARSE }, &ends, None)?;
    let percent = |x: f64| format!("{:+.3}", 100.0 * x);
    let (mut rows, mut ends_of) = (Vec::new(), Vec::new());
    for (i, (name, indentation)) in INDENTATIONS.into_iter().enumerate() {
        let should = SEPARATE_SOLVER[i];
        // Errors of second order, cells of 1/8 and 1/12.
        let ratio = (FINE.cells / COARSE.cells).powi(2);
        let mesh = (fine.pressure[i] - coarse.pressure[i]) / (ratio - 1.0);
        let converged = fine.pressure[i] + mesh;
        // Proportional to the strains, a tenth of it is left at a tenth of them.
        let linear =
            (gentle.pressure[i] - GENTLE.scale * coarse.pressure[i]) / (1.0 - GENTLE.scale);
        let strains = coarse.pressure[i] / linear - 1.0;
        context.check(
            Check::new(
                &format!("slab_{name}"),
                &format!(
                    "free depth faces, {indentation} µm: peak contact pressure, mesh-converged"
                ),
                "MPa",
                converged,
            )
            .independent(should, SEPARATE)
            .relative(
                0.01,
                "the cells continued to zero size; as computed, b/12, it is up to 1.03 % low (table offset). Finite strains, which the \
                 separate solver leaves out, lower it by up to 0.9 % of that",
            )
            .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(
                &format!("slab_small_strains_{name}"),
                &format!("the same without the part of finite strains, {indentation} µm"),
                "MPa",
                converged / (1.0 + strains),
            )
            .independent(should, SEPARATE)
            .relative(
                0.003,
                "two meshes; where the contact's edge lies in a cell differs, and continuing to zero size \
                 enlarges it",
            )
            .golden(GoldenTolerance::MIXED),
        );
        ends_of.push([fine.pressure[i] / should - 1.0, converged / should - 1.0]);
        let end = ends.iter().position(|end| *end == i);
        let at_end = |other: &Answers, part: f64| {
            end.map_or(String::new(), |k| {
                percent(part * (1.0 - other.pressure[k] / coarse.pressure[i]))
            })
        };
        rows.push(vec![
            format!("{indentation}"),
            percent(fine.pressure[i] / should - 1.0),
            percent(-mesh / should),
            percent(strains),
            percent(fine.undeformed[i] / fine.pressure[i] - 1.0),
            // Softness is one over stiffness: of four times the softness, three are the difference.
            at_end(&soft, -1.0 / 3.0),
            at_end(&thick, -1.0 / 3.0),
            percent(converged / should - 1.0),
            percent(converged / (1.0 + strains) / should - 1.0),
        ]);
    }
    let worst = |k: usize| largest(ends_of.iter().map(|both| both[k].abs()));
    let last = ends_of[ends_of.len() - 1];
    context.finding(
        "within_one_percent",
        format!(
            "Against the separate solver the peak pressure is within {:.2} % in all rows as computed on cells of b/12, within {:.2} % continued to cells \
             of zero size; at 5 µm {} % and {} %. One per cent therefore holds of the continued values only, and narrowly at 5 µm: what is left \
             there is finite strains, without which the two solvers agree (last column of table offset).",
            100.0 * worst(0),
            100.0 * worst(1),
            percent(last[0]),
            percent(last[1]),
        ),
    );
    context.table(
        "offset",
        "Peak pressure with free depth faces against the separate solver, and what each setting contributes, \
         percent",
        &[
            "indentation, µm",
            "as computed, b/12",
            "of it: mesh (b/8 and b/12, second order)",
            "of it: finite strains (against strains ten times smaller)",
            "undeformed instead of strained areas would add",
            "of it: contact stiffness (a quarter of it)",
            "of it: depth cells (2 and 4, second order)",
            "mesh-converged",
            "and at small strains",
        ],
        rows,
    );
    Ok(())
}

/// Plane strain against the second solver; the slab between plane strain and plane stress.
fn held_against_plane(context: &mut CaseContext, slab: &Answers, plane: &Answers, known: &InPlane) {
    let origin = "bilinear quadrilaterals, small strains, hard contact by compliances; own solver in the plane";
    for (i, (name, indentation)) in INDENTATIONS.into_iter().enumerate() {
        let (strain, stress) = (known.strain[i], known.stress[i]);
        context.check(
            Check::new(
                &format!("plane_{name}"),
                &format!("plane strain, {indentation} µm: peak contact pressure"),
                "MPa",
                plane.pressure[i],
            )
            .independent(1e-6 * strain.pressure, origin)
            .relative(
                0.01,
                "finite strains lower it by up to 0.9 %; at 0.5 µm the mesh by half a percent",
            )
            .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(
                &format!("plane_load_{name}"),
                &format!("plane strain, {indentation} µm: load per depth"),
                "N/mm",
                plane.load[i],
            )
            .independent(1e-3 * strain.load, origin)
            .relative(0.01, "finite strains and meshes, as for the pressure"),
        );
        context.check(
            Check::new(
                &format!("plane_von_mises_{name}"),
                &format!("plane strain, {indentation} µm: largest von Mises stress"),
                "MPa",
                plane.von_mises[i],
            )
            .independent(1e-6 * strain.von_mises, origin)
            .relative(
                if indentation < 1.5 { 0.045 } else { 0.015 },
                "averaged to nodes; below 1.5 µm the maximum lies two to three cells deep",
            )
            .golden(GoldenTolerance::MIXED),
        );
        context.check(
            Check::new(
                &format!("slab_von_mises_above_{name}"),
                &format!("free depth faces, {indentation} µm: largest von Mises stress"),
                "MPa",
                slab.von_mises[i],
            )
            .independent(1e-6 * strain.von_mises, origin)
            .at_least(0.0, "a slab lies between plane strain and plane stress"),
        );
        context.check(
            Check::new(
                &format!("slab_von_mises_below_{name}"),
                &format!("the same, {indentation} µm"),
                "MPa",
                slab.von_mises[i],
            )
            .independent(1e-6 * stress.von_mises, "the same solver in plane stress")
            .at_most(0.0, "a slab lies between plane strain and plane stress"),
        );
    }
}

/// Largest nodal force over nodal area as strained, Pa: the compressed surface is some tenths of a
/// percent smaller than undeformed.
fn present_pressure(
    block: &PressedBlock,
    touching: &[(ContactNode, Vec3)],
    displacement: &[Vec3],
) -> Result<f64, CaseError> {
    let mut strained = block.mesh.clone();
    for (place, by) in strained.nodes.iter_mut().zip(displacement) {
        *place = [0, 1, 2].map(|i: usize| place[i] + by[i]);
    }
    let present = contact_nodes(&strained, block.mesh.surface_set("z_high")?);
    let pressures = touching.iter().map(|(node, force)| {
        let now = present.iter().find(|now| now.node == node.node);
        now.map_or(f64::NAN, |now| -force[2] / now.area)
    });
    Ok(largest(pressures))
}

/// A reading that the table does not list: gaps to the columns EFEM and ABAQUS by solvers other than ours,
/// each with how far it may stray; where `None`, it agrees within the columns' own difference.
type Gaps = [[Option<[f64; 2]>; 6]; 2];

/// The second solver's pressures in plane strain.
const PLANE_PRESSURE: Gaps = [
    [
        None,
        Some([0.046, 0.01]),
        Some([0.073, 0.01]),
        Some([0.085, 0.01]),
        Some([0.078, 0.01]),
        Some([0.087, 0.01]),
    ],
    [None, None, None, Some([0.072, 0.01]), Some([0.079, 0.01]), Some([0.083, 0.01])],
];
/// Its von Mises stresses in plane strain.
// One of them happens to be near −1/π.
#[allow(clippy::approx_constant)]
const PLANE_VON_MISES: Gaps = [
    [
        Some([-0.412, 0.03]),
        Some([-0.376, 0.01]),
        Some([-0.340, 0.01]),
        Some([-0.318, 0.01]),
        Some([-0.310, 0.01]),
        Some([-0.292, 0.01]),
    ],
    [
        Some([-0.436, 0.03]),
        Some([-0.394, 0.01]),
        Some([-0.363, 0.01]),
        Some([-0.326, 0.01]),
        Some([-0.309, 0.01]),
        Some([-0.295, 0.01]),
    ],
];
/// Half-way between its von Mises stresses in plane strain and plane stress, which bound a slab's.
const SLAB_VON_MISES: Gaps = [
    [
        Some([-0.278, 0.134]),
        Some([-0.242, 0.135]),
        Some([-0.214, 0.126]),
        Some([-0.201, 0.117]),
        Some([-0.203, 0.107]),
        Some([-0.194, 0.099]),
    ],
    [
        Some([-0.307, 0.129]),
        Some([-0.263, 0.131]),
        Some([-0.241, 0.122]),
        Some([-0.211, 0.116]),
        Some([-0.202, 0.107]),
        Some([-0.197, 0.098]),
    ],
];
/// The separate solver's pressures with free depth faces.
const SLAB_PRESSURE: Gaps = [[None; 6], [Some([-0.058, 0.012]), None, None, None, None, None]];

fn readings(context: &mut CaseContext, slab: &Answers, plane: &Answers) {
    let all = [
        (
            "slab_pressure",
            "pressure, free depth faces",
            &slab.pressure,
            SLAB_PRESSURE,
            "A separate solver is as far off; half of the contact is a quarter of the largest half width \
             here, and the two published columns differ most in this row.",
            ["slab_", "slab_small_strains_"],
        ),
        (
            "plane_pressure",
            "pressure, plane strain (rejected as a whole)",
            &plane.pressure,
            PLANE_PRESSURE,
            "Held depth faces make the block stiffer than the table's, the more the wider the contact: another \
             solver in plane strain gives the same.",
            ["plane_", "plane_von_mises_"],
        ),
        (
            "slab_von_mises",
            "von Mises stress, free depth faces",
            &slab.von_mises,
            SLAB_VON_MISES,
            "Not what the table lists: the slab's von Mises stress lies between those of plane strain and \
             plane stress, both below the table.",
            ["slab_von_mises_above_", "slab_von_mises_below_"],
        ),
        (
            "plane_von_mises",
            "von Mises stress, plane strain (rejected as a whole)",
            &plane.von_mises,
            PLANE_VON_MISES,
            "Not what the table lists: in plane strain von Mises stress stays at 0.56 to 0.66 of the \
             pressure; another solver gives the same.",
            ["plane_", "plane_von_mises_"],
        ),
    ];
    for (id, text, ours, gaps, because, evidence) in all {
        let taken = id == "slab_pressure";
        for ((key, label), gaps) in [("efem", "EFEM"), ("abaqus", "ABAQUS")].into_iter().zip(gaps) {
            for (i, (name, indentation)) in INDENTATIONS.into_iter().enumerate() {
                // What a rejected reading happens to meet it does not reproduce.
                if gaps[i].is_none() && !taken {
                    continue;
                }
                let published = format!("{key}_{name}");
                let check = Check::new(
                    &format!("{id}_{published}"),
                    &format!("{text}, against {label} at {indentation} µm"),
                    "MPa",
                    ours[i],
                )
                .published(&published)
                .relative(0.04, "the source's own two solvers differ by up to 3.95 %");
                context.check(match gaps[i] {
                    Some([gap, stray]) => {
                        let evidence = evidence.map(|start| format!("{start}{name}"));
                        let evidence = [&evidence[0], &evidence[1], "matrix"];
                        check.explained(Explanation::new(because, gap, stray, &evidence))
                    }
                    None => check.under("slab").fit(CHOSEN),
                });
            }
        }
    }
}

/// How far von Mises stress is below the pressure, which is what the table's numbers are near.
fn not_von_mises(context: &mut CaseContext, slab: &Answers, plane: &Answers) {
    let below = |answers: &Answers| {
        let parts: Vec<f64> = answers
            .von_mises
            .iter()
            .zip(&slab.pressure)
            .map(|(s, p)| 100.0 * (1.0 - s / p))
            .collect();
        let low = parts.iter().fold(f64::INFINITY, |low: f64, x| low.min(*x));
        format!("{low:.1} to {:.1} %", largest(parts))
    };
    context.finding(
        "von_mises_misses",
        format!(
            "Largest von Mises stress is below the peak pressure with free depth faces, which agrees with the table, by {} with free depth faces and by \
             {} in plane strain. Against the table itself (the signed errors of the checks) single rows are 13.3 to 27.9 % too low in the slab and \
             29.7 to 41.6 % in plane strain, both columns taken together; by root mean square over the rows, 17 and 19 % (EFEM, ABAQUS) in the \
             slab, 34 and 35 % in plane strain. The study behind the slab's pressures states 17 to 36 %: that agrees as a root mean square per reading \
             and column, not as a range of single rows. Too low it is in every row under every reading.",
            below(slab),
            below(plane),
        ),
    );
}

fn tables(context: &mut CaseContext, slab: &Answers, plane: &Answers) {
    let mut rows = Vec::new();
    for (i, (_, indentation)) in INDENTATIONS.into_iter().enumerate() {
        let mut row = vec![format!("{indentation}")];
        for answers in [slab, plane] {
            row.push(format!("{:.1}", answers.pressure[i]));
            row.push(format!("{:.1}", answers.von_mises[i]));
            row.push(format!("{:.1}", answers.half_width[i]));
            row.push(format!("{:.1}", answers.load[i]));
        }
        rows.push(row);
    }
    context.table(
        "matrix",
        &format!(
            "Four readings of Table 2.1; free depth faces: {} of a quarter; plane strain: {} of a half",
            slab.mesh, plane.mesh
        ),
        &[
            "indentation, µm",
            "free: pressure, MPa",
            "free: von Mises, MPa",
            "half width, µm",
            "load, N/mm",
            "plane strain: pressure, MPa",
            "plane strain: von Mises, MPa",
            "half width, µm",
            "load, N/mm",
        ],
        rows,
    );
}

fn figure(context: &mut CaseContext, slab: &Answers, plane: &Answers) -> Result<(), CaseError> {
    let curve = |name: &str, values: &[f64]| {
        let points = INDENTATIONS.iter().zip(values).map(|((_, x), y)| [*x, *y]).collect();
        Curve::new(name, points)
    };
    let plot = XyPlot {
        title: "Largest stress over indentation".into(),
        x: Axis::linear("indentation", "µm"),
        y: Axis::linear("largest stress", "MPa"),
        style: Style::LinesAndMarkers,
        curves: vec![
            curve("pressure, free depth faces", &slab.pressure),
            curve("pressure, plane strain", &plane.pressure),
            curve("von Mises, free depth faces", &slab.von_mises),
            curve("von Mises, plane strain", &plane.von_mises),
            Curve::separate(
                "pressure, free depth faces, separate solver",
                INDENTATIONS.iter().zip(SEPARATE_SOLVER).map(|((_, x), y)| [*x, y]).collect(),
            ),
        ],
    };
    context.figure(
        "readings",
        xy(&plot)?,
        "The four readings. The published columns lie along the uppermost pair of curves; the checks say how closely.",
    );
    Ok(())
}
