//! A rigid cylinder pressed on a large block in plane strain, at rest and by explicit steps, against
//! Hertz.

use bearing_dynamics::ch2_housing::bore_contact;
use bearing_dynamics::ch2_housing::bore_contact::Penalty;
use bearing_dynamics::mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::output::plots::{Axis, Curve, Style, XyPlot, xy};
use bearing_dynamics::solids::contact::{Pressed, closed_limit, moved, press};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium_in_contact};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::golden::GoldenTolerance;
use crate::pressed_block::{
    BlockShape, DepthFaces, LineContact, PressedBlock, crest, line_contact, pressed_block,
};
use crate::solids::{STEEL, Vec3, largest, name_of, size_of};

pub mod oracle;

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
    Way { key: "", order: Order::Linear, cells: 10.0, size: 32.0, hardness: 10.0, explicit: false };

/// Of explicit runs: smooth descent, and all of the run, s; damping, 1/s, about critical for the
/// block's slowest motions.
const DESCENT: f64 = 2e-6;
const DURATION: f64 = 6e-6;
const DAMPING: f64 = 3e6;

/// Of the indentation for the half width aimed at: so many that the edge of contact comes to lie
/// in different places of its cell.
const PARTS: [f64; 6] = [0.85, 0.9, 0.95, 1.0, 1.05, 1.1];
/// Half widths between which the crest of von Mises stress is looked for.
const CREST: [f64; 2] = [0.35, 1.1];

struct Answer {
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

    /// At rest under `part` of the indentation, sought from `near`.
    fn rest(
        &self,
        block: &PressedBlock,
        radius: f64,
        part: f64,
        near: Option<&Answer>,
    ) -> Result<Answer, CaseError> {
        let down = |sign: f64| Profile::Constant(sign * part * self.indentation());
        let contact = block.cylinder(radius, self.penalty(), down);
        let options = EquilibriumOptions::default();
        let near = near.map(|near| near.displacement.as_slice());
        let found = equilibrium_in_contact(&block.model, 0.0, &contact, near, &options)?;
        let solid = found.solid;
        Ok(Answer {
            line: line_contact(block, &found.nodes),
            displacement: solid.displacement,
            deepest: found.sum.deepest,
            effort: format!(
                "{} iterations, {} factorisations",
                solid.iterations, solid.factorisations
            ),
        })
    }

    fn settle(&self, block: &PressedBlock, radius: f64) -> Result<Answer, CaseError> {
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
        let limit = closed_limit(&solid.model, &contact.nodes, contact.penalty, &solid.limit);
        solid.step_size = 0.95 * limit.step;
        let (penalty, nodes) = (contact.penalty, &contact.nodes[..]);
        while solid.time < DURATION {
            solid.step(|t, displacement, forces| {
                let (cylinder, frame) = &contact.at(t);
                press(&Pressed { cylinder, frame, penalty, nodes, displacement }, forces);
            })?;
        }
        let effort = format!("{} steps", solid.steps);
        let (cylinder, frame) = contact.at(solid.time);
        let (at, mut nodal) = (|node| moved(&solid.displacement, node), Vec::new());
        let sum =
            bore_contact::contact(&cylinder, &frame, penalty, nodes, at, |node, _, _, force| {
                nodal.push((*node, force));
            });
        let displacement = solid.displacement.iter().map(|u| [u[0], u[1], u[2]]).collect();
        Ok(Answer { line: line_contact(block, &nodal), displacement, deepest: sum.deepest, effort })
    }
}

fn hertz(answer: &Answer, radius: f64) -> oracle::Line {
    oracle::line(answer.line.load, radius, STEEL.young, STEEL.poisson)
}

/// What one answer differs by from Hertz under its own load.
#[derive(Clone, Copy)]
struct Errors {
    /// Relative.
    peak: f64,
    half_width: f64,
    /// Over p₀: nodal forces over what Hertz puts on their shares, the largest farther than a cell from
    /// the edge, and the root mean square of all over the half width.
    shares: f64,
    mean_square: f64,
    /// Over p₀: nodal pressures against Hertz' at the nodes, farther than a cell from the edge and anywhere.
    inside: f64,
    at_edge: f64,
    /// Largest von Mises stress, relative, and its depth, in half widths.
    von_mises: f64,
    depth: f64,
}

fn errors(way: &Way, block: &PressedBlock, answer: &Answer) -> Errors {
    let (line, exact) = (&answer.line, hertz(answer, RADIUS));
    let cell = HALF_WIDTH / way.cells;
    let (b, top) = (exact.half_width, exact.peak);
    let (mut shares, mut squares, mut inside, mut at_edge) = (0.0, 0.0, 0.0, 0.0);
    for ([y, p], [from, to]) in line.profile.iter().zip(&line.shares) {
        let share = to - from;
        let by_share = (p - exact.force_between(*from, *to) / share).abs() / top;
        let by_node = (p - exact.pressure(*y)).abs() / top;
        squares += share * by_share * by_share;
        at_edge = largest([at_edge, by_node]);
        if *to <= b - cell || *from >= b + cell {
            shares = largest([shares, by_share]);
            inside = largest([inside, by_node]);
        }
    }
    // The exact stresses at the same depths, read the same way.
    let below = block.von_mises_below(&answer.displacement, 1e-9, 2.0 * b);
    let over: Vec<[f64; 2]> = below.iter().map(|[z, s]| [z / b, s / top]).collect();
    let known: Vec<[f64; 2]> =
        over.iter().map(|[z, _]| [*z, oracle::von_mises(*z, STEEL.poisson)]).collect();
    let ([depth, stress], [known_depth, _]) = (crest(&over, CREST), crest(&known, CREST));
    let [should, _] = oracle::von_mises_peak(STEEL.poisson);
    Errors {
        peak: line.peak / top - 1.0,
        half_width: line.half_width / b - 1.0,
        shares,
        mean_square: (squares / b).sqrt(),
        inside,
        at_edge,
        von_mises: stress / should - 1.0,
        depth: depth - known_depth,
    }
}

/// The one farthest from zero, with its sign; NaN if any is.
fn farthest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(
        0.0,
        |far: f64, x| {
            if far.is_nan() || x.abs() <= far.abs() { far } else { x }
        },
    )
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let (mut rows, mut curves, mut edges) = (Vec::new(), Vec::new(), Vec::new());
    let mut at_rest: Option<Answer> = None;
    for way in &WAYS {
        let block = way.block()?;
        let answers = if way.explicit {
            vec![(1.0, way.settle(&block, RADIUS)?)]
        } else {
            let mut all: Vec<(f64, Answer)> = Vec::new();
            for part in PARTS {
                let near = all.last().map(|(_, answer)| answer);
                let answer = way.rest(&block, RADIUS, part, near)?;
                all.push((part, answer));
            }
            all
        };
        let found: Vec<Errors> = answers.iter().map(|(_, a)| errors(way, &block, a)).collect();
        checks(context, way.key, &found);
        edges.extend(found.iter().map(|e| (way.key, *e)));
        for ((part, answer), e) in answers.iter().zip(&found) {
            let percent = |x: f64| format!("{:+.2}", 100.0 * x);
            let unsigned = |x: f64| format!("{:.2}", 100.0 * x);
            rows.push(vec![
                way.key.to_string(),
                format!("{}, {}", name_of(way.order), size_of(&block.mesh)),
                format!("{} b", way.size),
                format!("{part}"),
                answer.effort.clone(),
                format!("{:.2}", 1e-3 * answer.line.load),
                percent(e.peak),
                percent(e.half_width),
                unsigned(e.shares),
                unsigned(e.mean_square),
                unsigned(e.inside),
                unsigned(e.at_edge),
                percent(e.von_mises),
                format!("{:+.3}", e.depth),
                format!("{:.1}", 1e9 * answer.deepest),
            ]);
        }
        let middle = answers.into_iter().find(|(part, _)| *part == 1.0);
        let Some((_, answer)) = middle else { continue };
        let exact = hertz(&answer, RADIUS);
        let seen = answer.line.profile.iter().filter(|p| p[0] <= 1.4 * exact.half_width);
        let points = seen.map(|p| [p[0] / exact.half_width, p[1] / exact.peak]).collect();
        let path = if way.explicit { "explicit" } else { "static" };
        let name = format!("{path}, {}", name_of(way.order));
        curves.push(Curve::separate(name, points));
        if way.key == "static_tet4" {
            other_radius(context, way, &block, &answer)?;
            harder(context, way, &block, &answer)?;
            at_rest = Some(answer);
        } else if let (true, Some(rest)) = (way.explicit, &at_rest) {
            settled(context, &answer, rest);
        }
    }
    context.table(
        "ways",
        "Differences from Hertz under the load found, in percent (of p₀ for pressures): force on the nodes' shares more than one cell from the edge, all of them by root mean square, pressure at the nodes more than one cell from the edge, and anywhere; \
         depth of the von Mises crest in half widths; penetration in nm",
        &[
            "way", "mesh", "size", "indentation", "effort", "load, N/mm", "p₀", "half width", "shares",
            "shares, rms", "nodes inside", "nodes, edge too", "von Mises", "its depth", "penetration",
        ],
        rows,
    );
    edge(context, &edges);
    figure(context, curves)
}

/// Why nodes next to the edge are not held against the profile point by point.
fn edge(context: &mut CaseContext, all: &[(&str, Errors)]) {
    let [cells, coarse] = [WAYS[0].cells, COARSE.cells];
    let of = |key: &str| -> Vec<String> {
        let those = all.iter().filter(|(way, _)| *way == key);
        those.map(|(_, e)| format!("{:.1}", 100.0 * e.at_edge)).collect()
    };
    context.finding(
        "edge_of_contact",
        format!(
            "Point by point, the node nearest to the edge is off by {} % of p₀ (ten-node elements, the six indentations in turn) and {} % \
             (four-node). Hertz' pressure there is p₀·√(2s/b) at a distance s from the edge, of infinite slope: an edge misplaced by \
             0.0002 b is 2 % of p₀ at the edge itself, and nodes place it within a cell h only, which leaves up to \
             p₀·√(2h/b) = {:.2} p₀ with cells of b/{cells}, {:.2} with b/{coarse}. Smaller cells lower that by the root of their size; at one indentation it is as \
             small as one likes, by where the edge happens to lie. So nothing is asked of that one value; what is asked is the force \
             on each share more than one cell from the edge, and the mean square over the whole width.",
            of("static").join(", "),
            of("static_tet4").join(", "),
            (2.0 / cells).sqrt(),
            (2.0 / coarse).sqrt(),
        ),
    );
}

/// Motion that has settled is in equilibrium, node by node.
fn settled(context: &mut CaseContext, answer: &Answer, rest: &Answer) {
    context.check(
        Check::new("settled", "load after settling, explicit steps", "N/m", answer.line.load)
            .consistency(
                rest.line.load,
                "explicit steps, settled, against our own equilibrium of the same mesh",
            )
            .relative(
                1e-5,
                "rest of the slowest mode; equilibrium and motion share the law but not the method",
            ),
    );
    let pairs = answer.line.profile.iter().zip(&rest.line.profile);
    let gap = largest(pairs.map(|(one, other)| (one[1] - other[1]).abs())) / rest.line.peak;
    context.check(
        Check::new(
            "settled_nodes",
            "largest distance of a nodal pressure after settling from that at rest, over p₀",
            "1",
            gap,
        )
        .consistency(0.0, "explicit steps, settled, against our own equilibrium of the same mesh")
        .absolute(
            3e-5,
            "as for the load, 3e-6 at single nodes: the six indentations at rest then speak for explicit steps too",
        ),
    );
}

fn figure(context: &mut CaseContext, mut curves: Vec<Curve>) -> Result<(), CaseError> {
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
        "As Fig. 2.10, at the indentation for the half width aimed at: nodal force over nodal area, by Hertz' peak pressure and half width \
         under the load found. Nothing is fitted.",
    );
    Ok(())
}

fn checks(context: &mut CaseContext, key: &str, found: &[Errors]) {
    let origin = "Hertz, rigid cylinder on a half space in plane strain, under the load found";
    let mesh =
        "errors of mesh, contact compliance and block size; a wrong area or radius differs by more";
    let many = if found.len() > 1 {
        format!("worst of {} indentations", found.len())
    } else {
        "one indentation".into()
    };
    let mut check = |id: &str, what: &str, value: f64, against: &str, tolerance: f64, why: &str| {
        context.check(
            Check::new(&format!("{key}_{id}"), &format!("{key}, {many}: {what}"), "1", value)
                .closed_form(0.0, against)
                .absolute(tolerance, why)
                .golden(GoldenTolerance::MIXED.floor(1e-4)),
        );
    };
    let worst = |of: fn(&Errors) -> f64| farthest(found.iter().map(of));
    check("peak", "peak pressure over Hertz', less one", worst(|e| e.peak), origin, 0.02, mesh);
    check(
        "half_width",
        "half width over Hertz', less one",
        worst(|e| e.half_width),
        origin,
        0.02,
        mesh,
    );
    check(
        "profile",
        "nodal force against Hertz' pressure over the node's share, more than one cell from the edge, over p₀ times the share",
        worst(|e| e.shares),
        origin,
        0.02,
        "a node knows the force on its share of the surface, not the pressure at a point; nodes place the edge within a cell only, \
         and there the profile is upright (finding edge_of_contact)",
    );
    check(
        "profile_rms",
        "the same over the full width with the edge: root mean square over p₀",
        worst(|e| e.mean_square),
        origin,
        0.02,
        "an edge misplaced within its cell: off by the root of the cell on one cell's width, so that the mean square falls with the cell; the largest value does not",
    );
    check(
        "von_mises",
        "largest von Mises stress below the contact over 0.5575 p₀, less one",
        worst(|e| e.von_mises),
        "stresses on the axis below a line contact, plane strain, ν = 0.3",
        0.03,
        "averaged to nodes, crest of a cubic through them; sides and base at n half widths add some 0.7/n of it",
    );
    check(
        "von_mises_depth",
        "its depth less that of the exact curve, over the half width (the maximum is at 0.704)",
        worst(|e| e.depth),
        "the exact stresses at the same depths, crest read by the same cubic",
        0.03,
        "nodes at corners and at middles of edges average different elements, 1.5 and 0.9 % too high alternately in ten-node elements; the cubic averages this, a parabola through three nodes does not (6 % too deep)",
    );
}

/// A radius 10 % larger, at the same indentation: pressure goes with √(P′/R).
fn other_radius(
    context: &mut CaseContext,
    way: &Way,
    block: &PressedBlock,
    answer: &Answer,
) -> Result<(), CaseError> {
    let larger = way.rest(block, 1.1 * RADIUS, 1.0, Some(answer))?;
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
    Ok(())
}

/// The contact doubled in stiffness.
fn harder(
    context: &mut CaseContext,
    way: &Way,
    block: &PressedBlock,
    answer: &Answer,
) -> Result<(), CaseError> {
    let twice = Way { hardness: 2.0 * way.hardness, ..*way };
    let doubled = twice.rest(block, RADIUS, 1.0, Some(answer))?;
    let moved = doubled.line.peak / answer.line.peak;
    context.check(
        Check::new(
            "doubled_stiffness",
            "contact stiffness doubled: peak pressure over that before",
            "1",
            moved,
        )
        .consistency(1.0, "our own solutions with two penalties")
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
