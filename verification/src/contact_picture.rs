//! Pictures of contact in a bore: the housing's front face seen along its axis, deformed, and arrows
//! for the forces on the bore, as SVG.
//!
//! +Y to the right, +Z up. Forces of nodes behind one another are summed. An arrow ends on the bore;
//! its length and its colour go with the force, the longest of all panels being the same.

use bearing_dynamics::mesh::TetMesh;
use std::collections::BTreeMap;
use std::fmt::Write;

use crate::solids::Vec3;

/// One drawing of the row.
pub struct Panel<'a> {
    pub title: String,
    /// Its surface set `x_high` is the front face.
    pub mesh: &'a TetMesh,
    /// Of each node as drawn, already magnified, m.
    pub displacement: Vec<Vec3>,
    /// Node and force on it, N.
    pub forces: Vec<(u32, Vec3)>,
}

const SIDE: f64 = 360.0;
const MARGIN: f64 = 14.0;
const HEAD: f64 = 46.0;
/// Longest arrow as a part of the bore's radius.
const LONGEST: f64 = 0.75;

/// The panels in rows of `columns` as a complete SVG document.
pub fn contact_picture(panels: &[Panel], columns: usize) -> String {
    let rows = panels.len().div_ceil(columns);
    let (width, height) = (columns as f64 * SIDE, rows as f64 * (SIDE + HEAD) + 30.0);
    let summed: Vec<_> = panels.iter().map(along_the_axis).collect();
    let size = |force: &[f64; 2]| force[0].hypot(force[1]);
    let strongest = summed.iter().flatten().map(|arrow| size(&arrow.force)).fold(0.0, f64::max);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width} {height}\" width=\"{width}\" height=\"{height}\" \
         font-family=\"sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n"
    );
    for (index, (panel, forces)) in panels.iter().zip(&summed).enumerate() {
        let left = (index % columns) as f64 * SIDE;
        let top = (index / columns) as f64 * (SIDE + HEAD) + HEAD;
        draw(&mut svg, panel, forces, strongest, [left, top]);
    }
    let _ = write!(
        svg,
        "<text x=\"{:.0}\" y=\"{:.0}\" font-size=\"14\" text-anchor=\"middle\">longest arrow: {:.1} N</text>\n</svg>\n",
        0.5 * width,
        height - 10.0,
        strongest
    );
    svg
}

/// A force on all nodes at the same Y and Z.
struct BlockArrowMatrix {
    /// Where the front one of them is drawn, its Y and Z, m.
    tip: [f64; 2],
    /// On Y and Z, N.
    force: [f64; 2],
}

/// Forces summed over nodes whose undeformed Y and Z are the same to 10 nm.
fn along_the_axis(panel: &Panel) -> Vec<BlockArrowMatrix> {
    let mut sums: BTreeMap<[i64; 2], (f64, BlockArrowMatrix)> = BTreeMap::new();
    for (node, [_, on_y, on_z]) in &panel.forces {
        let ([x, y, z], u) = (panel.mesh.nodes[*node as usize], panel.displacement[*node as usize]);
        let key = [y, z].map(|x| (x * 1e8).round() as i64);
        let tip = [y + u[1], z + u[2]];
        let (front, sum) =
            sums.entry(key).or_insert((x, BlockArrowMatrix { tip, force: [0.0; 2] }));
        if x > *front {
            (*front, sum.tip) = (x, tip);
        }
        sum.force[0] += on_y;
        sum.force[1] += on_z;
    }
    sums.into_values().map(|(_, arrow)| arrow).collect()
}

/// Edges of the front face that belong to one of its faces only, as runs of nodes.
pub fn outline(mesh: &TetMesh) -> Vec<Vec<u32>> {
    let Ok(front) = mesh.surface_set("x_high") else { return Vec::new() };
    let mut edges: BTreeMap<[u32; 2], (usize, Vec<u32>)> = BTreeMap::new();
    for &face in front {
        let nodes: Vec<u32> = mesh.face_nodes(face).collect();
        for i in 0..3 {
            let (a, b) = (nodes[i], nodes[(i + 1) % 3]);
            let mut run = vec![a, b];
            if let Some(&middle) = nodes.get(3 + i) {
                run.insert(1, middle);
            }
            edges.entry([a.min(b), a.max(b)]).or_insert((0, run)).0 += 1;
        }
    }
    edges.into_values().filter(|(count, _)| *count == 1).map(|(_, run)| run).collect()
}

fn draw(
    svg: &mut String,
    panel: &Panel,
    forces: &[BlockArrowMatrix],
    strongest: f64,
    [left, top]: [f64; 2],
) {
    let (low, high) = panel.mesh.bounding_box();
    let extent = (high[1] - low[1]).max(high[2] - low[2]);
    let scale = (SIDE - 4.0 * MARGIN) / extent;
    let middle = [0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])];
    let at = |y: f64, z: f64| {
        [left + 0.5 * SIDE + scale * (y - middle[0]), top + 0.5 * SIDE - scale * (z - middle[1])]
    };
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"{:.1}\" font-size=\"15\" text-anchor=\"middle\">{}</text>",
        left + 0.5 * SIDE,
        top - 14.0,
        panel.title
    );
    let runs = outline(panel.mesh);
    for (moved, style) in [
        (false, "stroke=\"#bbb\" stroke-width=\"1\""),
        (true, "stroke=\"#222\" stroke-width=\"1.4\""),
    ] {
        let mut path = String::new();
        for run in &runs {
            for (i, node) in run.iter().enumerate() {
                let [_, y, z] = panel.mesh.nodes[*node as usize];
                let u = if moved { panel.displacement[*node as usize] } else { [0.0; 3] };
                let [x, y] = at(y + u[1], z + u[2]);
                let _ = write!(path, "{}{x:.1} {y:.1}", if i == 0 { "M" } else { "L" });
            }
        }
        let _ = writeln!(svg, "<path d=\"{path}\" fill=\"none\" {style}/>");
    }
    for BlockArrowMatrix { tip: [y, z], force: [on_y, on_z] } in forces {
        let size = on_y.hypot(*on_z);
        let part = size / strongest;
        // Next to no force, and one that is not a number, has no arrow.
        if part.is_nan() || part <= 1e-3 {
            continue;
        }
        let length = LONGEST * y.hypot(*z) * part;
        let direction = [on_y / size, on_z / size];
        let [x2, y2] = at(*y, *z);
        let [x1, y1] = at(y - length * direction[0], z - length * direction[1]);
        // Blue for small forces, red for large ones.
        let red = (255.0 * part).round();
        let colour = format!("rgb({red:.0},40,{:.0})", 255.0 - red);
        let _ = write!(
            svg,
            "<path d=\"M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}\" stroke=\"{colour}\" stroke-width=\"1.3\"/>"
        );
        let (dx, dy) = (direction[0], -direction[1]);
        let head = (0.3 * scale * length).clamp(2.0, 7.0);
        let back =
            |side: f64| [x2 - head * (dx + side * 0.4 * dy), y2 - head * (dy - side * 0.4 * dx)];
        let ([ax, ay], [bx, by]) = (back(1.0), back(-1.0));
        let _ = writeln!(
            svg,
            "<path d=\"M{x2:.1} {y2:.1}L{ax:.1} {ay:.1}L{bx:.1} {by:.1}Z\" fill=\"{colour}\"/>"
        );
    }
}
