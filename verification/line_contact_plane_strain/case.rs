//! A rigid cylinder pressed on a large block in plane strain, at rest and by explicit steps, against
//! Hertz.

use bearing_dynamics::ch2_housing::bore_contact::{ContactNode, Penalty};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solver::profile::Profile;
use bearing_dynamics::solver::solid::contact::ContactRun;
use bearing_dynamics::solver::solid::equilibrium::{EquilibriumOptions, equilibrium_in_contact};
use bearing_dynamics::solver::solid::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::pressed_block::{
    BlockShape, DepthFaces, LineContact, PressedBlock, line_contact, pressed_block,
};
use crate::solids::{STEEL, Vec3, largest, name_of, size_of};

mod oracle;

pub const CASE: Case = Case {
    id: "line_contact_plane_strain",
    title: "Line contact in plane strain",
    section: "2.3.2, (2.16)–(2.19)",
    tier: Tier::Smoke,
    published: include_str!("published.toml"),
    run,
};

/// Of the cylinder (2.3.2), m.
const RADIUS: f64 = 35.5e-3;
/// Half width that is aimed at, m: a 355th of the radius, so that strains stay near those of Hertz'
/// linear theory. Sizes of blocks are multiples of it.
const HALF_WIDTH: f64 = 0.1e-3;

/// One way to solve it.
struct Way {
    key: &'static str,
    order: Order,
    /// Cells in a half width, half widths from the contact to sides and base.
    cells: f64,
    size: f64,
    /// Contact stiffness by area over Young's modulus by cell.
    hardness: f64,
    explicit: bool,
}

const WAYS: [Way; 3] = [
    Way {
        key: "static",
        order: Order::Quadratic,
        cells: 8.0,
        size: 64.0,
        hardness: 30.0,
        explicit: false,
    },
    Way { key: "static_tet4", explicit: false, ..COARSE },
    Way { key: "explicit", explicit: true, ..COARSE },
];

/// Solved both ways: settled motion has to end in equilibrium.
const COARSE: Way =
    Way { key: "", order: Order::Linear, cells: 8.0, size: 32.0, hardness: 10.0, explicit: false };

/// Of explicit runs: smooth descent, and all of the run, s; damping, 1/s, about critical for the
/// block's slowest motions.
const DESCENT: f64 = 2e-6;
const DURATION: f64 = 6e-6;
const DAMPING: f64 = 3e6;

struct Answer {
    block: PressedBlock,
    line: LineContact,
    displacement: Vec<Vec3>,
    deepest: f64,
    effort: String,
}

impl Way {
    fn block(&self) -> Result<PressedBlock, CaseError> {
        let cell = HALF_WIDTH / self.cells;
        let shape = BlockShape {
            order: self.order,
            // On a plane of symmetry four-node tetrahedra, cut all one way, read 5 % too much.
            halved: self.order == Order::Quadratic,
            half_width: self.size * HALF_WIDTH,
            height: self.size * HALF_WIDTH,
            depth: cell,
            depth_cells: 1,
            faces: DepthFaces::Held,
            fine_reach: 1.5 * HALF_WIDTH,
            cell,
            growth: 1.25,
        };
        Ok(pressed_block(&shape, STEEL, if self.explicit { DAMPING } else { 0.0 })?)
    }

    fn penalty(&self) -> Penalty {
        Penalty::PerArea(self.hardness * STEEL.young * self.cells / HALF_WIDTH)
    }

    /// How far a cylinder has to go for the half width aimed at; which one it reaches is measured.
    fn indentation(&self) -> f64 {
        HALF_WIDTH * HALF_WIDTH / (4.0 * RADIUS) * (2.0 * (2.0 * self.size).ln() - 0.43)
    }

    fn solve(&self, radius: f64) -> Result<Answer, CaseError> {
        let block = self.block()?;
        if self.explicit { self.settle(block, radius) } else { self.rest(block, radius) }
    }

    fn rest(&self, block: PressedBlock, radius: f64) -> Result<Answer, CaseError> {
        let down = |sign: f64| Profile::Constant(sign * self.indentation());
        let contact = block.cylinder(radius, self.penalty(), down);
        let options = EquilibriumOptions::default();
        let found = equilibrium_in_contact(&block.model, 0.0, &contact, None, &options)?;
        let solid = found.solid;
        let effort =
            format!("{} iterations, {} factorisations", solid.iterations, solid.factorisations);
        Ok(answer(block, &found.nodes, solid.displacement, found.sum.deepest, effort))
    }

    fn settle(&self, block: PressedBlock, radius: f64) -> Result<Answer, CaseError> {
        let down = |sign: f64| Profile::SmoothRamp {
            from: 0.0,
            to: sign * self.indentation(),
            start: 0.0,
            duration: DESCENT,
        };
        let contact = block.cylinder(radius, self.penalty(), down);
        let still = vec![[0.0; 3]; block.mesh.nodes.len()];
        let mut solid = ExplicitSolid::new(
            block.model.clone(),
            ExplicitMethod::CentralDifferences,
            SolidStepping::FractionOfLimit(1.0),
            still.clone(),
            still,
        )?;
        solid.step_size = 0.95 * contact.step_limit(&solid.model, &solid.limit).step;
        // Nodes further than the whole way down are never tested.
        let mut run = ContactRun::new(contact, &solid, 4.0 * self.indentation())?;
        while solid.time < DURATION {
            run.step(&mut solid)?;
        }
        let (near, far) = run.counts();
        let effort = format!("{} steps; {near} nodes tested, {far} out of reach", solid.steps);
        let nodes = run.nodal_forces(solid.time, &solid.displacement);
        let displacement = solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
        Ok(answer(block, &nodes, displacement, run.sum.deepest, effort))
    }
}

fn answer(
    block: PressedBlock,
    nodes: &[(ContactNode, Vec3)],
    displacement: Vec<Vec3>,
    deepest: f64,
    effort: String,
) -> Answer {
    let line = line_contact(&block, nodes);
    Answer { block, line, displacement, deepest, effort }
}

fn hertz(answer: &Answer, radius: f64) -> oracle::Line {
    oracle::line(answer.line.load, radius, STEEL.young, STEEL.poisson)
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let mut rows = Vec::new();
    let mut curves = Vec::new();
    let mut at_rest = f64::NAN;
    for way in &WAYS {
        let answer = way.solve(RADIUS)?;
        let exact = hertz(&answer, RADIUS);
        let [stress, depth] =
            answer.block.von_mises_below(&answer.displacement, 1e-9, 2.0 * exact.half_width);
        checks(context, way.key, &answer, exact, [stress, depth]);
        rows.push(vec![
            way.key.to_string(),
            name_of(way.order).to_string(),
            size_of(&answer.block.mesh),
            format!("{} b", way.size),
            answer.effort.clone(),
            format!("{:.2}", 1e-3 * answer.line.load),
            format!("{:+.2}", 100.0 * (answer.line.peak / exact.peak - 1.0)),
            format!("{:+.2}", 100.0 * (answer.line.half_width / exact.half_width - 1.0)),
            format!("{:.4} at {:.3} b", stress / exact.peak, depth / exact.half_width),
            format!("{:.1}", 1e9 * answer.deepest),
        ]);
        let seen = answer.line.profile.iter().filter(|p| p[0] <= 1.4 * exact.half_width);
        let points = seen.map(|p| [p[0] / exact.half_width, p[1] / exact.peak]).collect();
        let name = format!("{}, {}", way.key, name_of(way.order));
        curves.push(Curve::separate(name, points));
        match way.key {
            "static_tet4" => {
                other_radius(context, way, &answer)?;
                harder(context, way, &answer)?;
                at_rest = answer.line.load;
            }
            "explicit" => context.check(
                Check::new("settled", "load after settling, explicit steps", "N/m", answer.line.load)
                    .converged(at_rest, "equilibrium of the same mesh by Newton's method")
                    .relative(
                        1e-4,
                        "what is left of the slowest motion; equilibrium and motion share the law but not the way",
                    ),
            ),
            _ => {}
        }
    }
    context.table(
        "ways",
        "Differences from Hertz under the load found, in percent; von Mises stress over p₀; penetration in nm",
        &[
            "way", "element", "mesh", "size", "effort", "load, N/mm", "p₀", "half width",
            "von Mises", "penetration",
        ],
        rows,
    );
    let ellipse: Vec<[f64; 2]> = (0..=200)
        .map(|i| {
            let y = f64::from(i) / 200.0;
            [y, (1.0 - y * y).sqrt()]
        })
        .collect();
    curves.insert(0, Curve::new("Hertz", ellipse));
    let plot = XyPlot {
        title: "Contact pressure under the cylinder".into(),
        x: Axis::linear("distance from the middle over half width", "1"),
        y: Axis::linear("pressure over peak pressure", "1"),
        curves,
        style: Style::Lines,
    };
    context.figure(
        "pressure",
        xy(&plot)?,
        "As Fig. 2.10: nodal force over nodal area, by Hertz' peak pressure and half width under the load \
         found. Nothing is fitted.",
    );
    Ok(())
}

fn checks(
    context: &mut CaseContext,
    key: &str,
    answer: &Answer,
    exact: oracle::Line,
    [stress, depth]: [f64; 2],
) {
    let line = &answer.line;
    let origin = "Hertz, rigid cylinder on a half space in plane strain, under the load found";
    let mesh = "what the mesh, the contact's own softness and a block of this size leave; a wrong area or radius \
                is off by more";
    let two = 0.02;
    context.check(
        Check::new(&format!("{key}_peak"), &format!("{key}: peak pressure"), "Pa", line.peak)
            .closed_form(exact.peak, origin)
            .relative(two, mesh)
            .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new(
            &format!("{key}_half_width"),
            &format!("{key}: half width"),
            "m",
            line.half_width,
        )
        .closed_form(exact.half_width, origin)
        .relative(two, mesh)
        .golden(GoldenTolerance::MIXED),
    );
    let gap = largest(line.profile.iter().map(|p| (p[1] - exact.pressure(p[0])).abs()));
    context.check(
        Check::new(
            &format!("{key}_profile"),
            &format!("{key}: largest distance of a nodal pressure from Hertz' profile, over p₀"),
            "1",
            gap / exact.peak,
        )
        .closed_form(0.0, origin)
        .absolute(two, "the edge, where the profile falls upright, lies anywhere within a cell")
        .golden(GoldenTolerance::MIXED.floor(1e-4)),
    );
    let [should, place] = oracle::von_mises_peak(STEEL.poisson);
    context.check(
        Check::new(
            &format!("{key}_von_mises"),
            &format!("{key}: largest von Mises stress below the contact, over p₀"),
            "1",
            stress / exact.peak,
        )
        .closed_form(should, "stresses on the axis below a line contact, plane strain, ν = 0.3")
        .relative(0.03, "averaged to nodes; sides and base at n half widths add some 0.7/n of it")
        .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new(
            &format!("{key}_von_mises_depth"),
            &format!("{key}: its depth over the half width"),
            "1",
            depth / exact.half_width,
        )
        .closed_form(place, "the same")
        .absolute(
            0.08,
            "the maximum is flat: 0.1 half widths off it is 0.7 % less; one cell is 0.06 to 0.12",
        )
        .golden(GoldenTolerance::MIXED),
    );
}

/// A radius 10 % larger, at the same indentation: pressure goes with √(P′/R).
fn other_radius(context: &mut CaseContext, way: &Way, answer: &Answer) -> Result<(), CaseError> {
    let larger = way.solve(1.1 * RADIUS)?;
    let ratio = larger.line.peak / answer.line.peak;
    context.check(
        Check::new(
            "radius_ratio",
            "radius 10 % larger, same indentation: peak pressure over that before",
            "1",
            ratio,
        )
        .closed_form(
            (larger.line.load / answer.line.load / 1.1).sqrt(),
            "√(P′/R) with the loads found",
        )
        .relative(0.005, "errors of both meshes cancel but for where the edges lie in their cells")
        .golden(GoldenTolerance::MIXED),
    );
    context.check(
        Check::new("radius_matters", "the same ratio", "1", ratio)
            .closed_form(1.0, "what a radius that is not looked at would give")
            .at_most(0.03, "the load hardly grows, so that the ratio is near 1/√1.1 = 0.953"),
    );
    Ok(())
}

/// The contact doubled in stiffness.
fn harder(context: &mut CaseContext, way: &Way, answer: &Answer) -> Result<(), CaseError> {
    let doubled = Way { hardness: 2.0 * way.hardness, ..*way }.solve(RADIUS)?;
    let moved = doubled.line.peak / answer.line.peak;
    context.check(
        Check::new(
            "doubled_stiffness",
            "contact stiffness doubled: peak pressure over that before",
            "1",
            moved,
        )
        .closed_form(1.0, "no dependence on the penalty")
        .relative(
            0.005,
            "penetration, halved by it, is a hundredth of the indentation's part under the contact",
        ),
    );
    context.finding(
        "doubled_stiffness_found",
        format!(
            "Twice the contact stiffness moves the peak pressure by {:+.3} %, the load by {:+.3} %, and takes \
             penetration from {:.2} to {:.2} nm.",
            100.0 * (moved - 1.0),
            100.0 * (doubled.line.load / answer.line.load - 1.0),
            1e9 * answer.deepest,
            1e9 * doubled.deepest
        ),
    );
    Ok(())
}
