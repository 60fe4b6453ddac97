//! Pictures of a body: its surface, shaded and coloured by a value, as SVG.
//!
//! Triangles that face away are left out, the others painted from far to near. Ten-node faces are
//! drawn as four triangles. Values are nodal; a triangle takes the mean of its corners.

use bearing_dynamics::mesh::topology::surface;
use bearing_dynamics::mesh::{Face, TetMesh};
use std::collections::BTreeMap;
use std::fmt::Write;

use crate::solids::Vec3;

/// What is drawn.
pub struct SurfacePicture<'a> {
    pub mesh: &'a TetMesh,
    /// Displacement of each node as drawn, already magnified, m; empty for none. The undeformed
    /// body's edges then show behind.
    pub displacement: &'a [Vec3],
    /// One for each node.
    pub values: &'a [f64],
    /// Such as "von Mises stress, MPa".
    pub label: &'a str,
    /// Direction to the viewer, degrees: about Z from +X, and up from the horizon.
    pub azimuth: f64,
    pub elevation: f64,
}

const WIDTH: f64 = 760.0;
const BAR: f64 = 120.0;
const MARGIN: f64 = 24.0;
const TALLEST: f64 = 520.0;
/// Faces that meet at more than this are an edge of the body; its cosine.
const SHARP: f64 = 0.75;

/// The drawing as a complete SVG document; values that are not finite are drawn in grey.
pub fn surface_picture(picture: &SurfacePicture) -> String {
    let SurfacePicture { mesh, displacement, values, label, .. } = picture;
    let camera = Camera::new(picture.azimuth, picture.elevation);
    let at = |node: u32| {
        let place = mesh.nodes[node as usize];
        let by = displacement.get(node as usize).copied().unwrap_or([0.0; 3]);
        camera.record([0, 1, 2].map(|i: usize| place[i] + by[i]))
    };
    let faces = surface(mesh);
    let edges: Vec<[Vec3; 2]> = if displacement.is_empty() {
        Vec::new()
    } else {
        let plain = |node: u32| camera.record(mesh.nodes[node as usize]);
        sharp_edges(mesh, &faces).into_iter().map(|edge| edge.map(plain)).collect()
    };
    let mut triangles = Vec::new();
    for face in &faces {
        for corners in triangles_of(&mesh.face_nodes(*face).collect::<Vec<u32>>()) {
            let value = corners.iter().map(|n| values[*n as usize] / 3.0).sum::<f64>();
            triangles.push((corners.map(at), value));
        }
    }
    let range = |of: &mut dyn Iterator<Item = f64>| {
        of.filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)))
    };
    let (low, high) = range(&mut values.iter().copied());
    let mut corners: Vec<Vec3> = triangles.iter().flat_map(|t| t.0).collect();
    corners.extend(edges.iter().flatten());
    let (left, right) = range(&mut corners.iter().map(|p| p[0]));
    let (bottom, top) = range(&mut corners.iter().map(|p| p[1]));
    let scale = ((WIDTH - BAR - 2.0 * MARGIN) / (right - left))
        .min((TALLEST - 2.0 * MARGIN) / (top - bottom));
    let height = (scale * (top - bottom) + 2.0 * MARGIN).max(260.0);
    let page = |p: Vec3| {
        let up = 0.5 * (height - scale * (top - bottom));
        [MARGIN + scale * (p[0] - left), height - up - scale * (p[1] - bottom)]
    };

    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{height:.0}\" \
         viewBox=\"0 0 {WIDTH} {height:.0}\" font-family=\"sans-serif\" font-size=\"14\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n"
    );
    svg.push_str("<path fill=\"none\" stroke=\"#9aa4af\" stroke-width=\"0.8\" d=\"");
    for edge in &edges {
        let [a, b] = edge.map(page);
        let _ = write!(svg, "M{:.1},{:.1}L{:.1},{:.1}", a[0], a[1], b[0], b[1]);
    }
    svg.push_str("\"/>\n");
    paint(&mut svg, triangles, page, low, high);
    colour_bar(&mut svg, low, high, label, height);
    svg.push_str("</svg>\n");
    svg
}

/// Right, up and towards the viewer.
struct Camera([Vec3; 3]);

impl Camera {
    fn new(azimuth: f64, elevation: f64) -> Camera {
        let (sa, ca) = azimuth.to_radians().sin_cos();
        let (se, ce) = elevation.to_radians().sin_cos();
        Camera([[-sa, ca, 0.0], [-se * ca, -se * sa, ce], [ce * ca, ce * sa, se]])
    }

    fn record(&self, p: Vec3) -> Vec3 {
        self.0.map(|axis| axis[0] * p[0] + axis[1] * p[1] + axis[2] * p[2])
    }
}

fn triangles_of(nodes: &[u32]) -> Vec<[u32; 3]> {
    match *nodes {
        [a, b, c, ab, bc, ca] => vec![[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]],
        [a, b, c] => vec![[a, b, c]],
        _ => Vec::new(),
    }
}

fn unit_normal([a, b, c]: [Vec3; 3]) -> Vec3 {
    let u = [b[0] - a[0], b[1] - a[1], b[2] - a[2]];
    let v = [c[0] - a[0], c[1] - a[1], c[2] - a[2]];
    let n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    let length = (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]).sqrt();
    n.map(|x| x / length)
}

/// Edges of the body between faces at an angle, with their middles where there are any.
fn sharp_edges(mesh: &TetMesh, faces: &[Face]) -> Vec<[u32; 2]> {
    let mut beside: BTreeMap<[u32; 2], (Option<u32>, Vec<Vec3>)> = BTreeMap::new();
    for face in faces {
        let nodes: Vec<u32> = mesh.face_nodes(*face).collect();
        let corners = [nodes[0], nodes[1], nodes[2]];
        let normal = unit_normal(corners.map(|n| mesh.nodes[n as usize]));
        for i in 0..3 {
            let (a, b) = (corners[i], corners[(i + 1) % 3]);
            let edge = beside.entry([a.min(b), a.max(b)]).or_default();
            edge.0 = nodes.get(3 + i).copied();
            edge.1.push(normal);
        }
    }
    let mut sharp = Vec::new();
    for ([a, b], (middle, normals)) in beside {
        let [m, n] = normals[..] else { continue };
        if m[0] * n[0] + m[1] * n[1] + m[2] * n[2] < SHARP {
            match middle {
                Some(middle) => sharp.extend([[a, middle], [middle, b]]),
                None => sharp.push([a, b]),
            }
        }
    }
    sharp
}

fn paint(
    svg: &mut String,
    triangles: Vec<([Vec3; 3], f64)>,
    page: impl Fn(Vec3) -> [f64; 2],
    low: f64,
    high: f64,
) {
    let depth = |t: &[Vec3; 3]| t[0][2] + t[1][2] + t[2][2];
    let mut seen: Vec<_> = triangles
        .into_iter()
        .map(|(corners, value)| (unit_normal(corners), corners, value))
        .filter(|(normal, ..)| normal[2] > 0.0)
        .collect();
    seen.sort_by(|a, b| depth(&a.1).total_cmp(&depth(&b.1)));
    svg.push_str("<g stroke-width=\"0.5\" stroke-linejoin=\"round\">\n");
    for (normal, corners, value) in seen {
        // A lamp over the viewer's left shoulder.
        let light = 0.68 + 0.32 * (0.35 * normal[1] - 0.3 * normal[0] + 0.887 * normal[2]).max(0.0);
        let part = if high > low { (value - low) / (high - low) } else { 0.0 };
        let [r, g, b] = colour(part).map(|c| (c * light).round() as u8);
        let [p, q, s] = corners.map(&page);
        let _ = writeln!(
            svg,
            "<path d=\"M{:.1},{:.1}L{:.1},{:.1} {:.1},{:.1}z\" fill=\"#{r:02x}{g:02x}{b:02x}\" \
             stroke=\"#{r:02x}{g:02x}{b:02x}\"/>",
            p[0], p[1], q[0], q[1], s[0], s[1]
        );
    }
    svg.push_str("</g>\n");
}

/// Dark blue over green to yellow, each lighter than the one before (after Viridis), 0 to 255.
fn colour(part: f64) -> [f64; 3] {
    const STOPS: [[f64; 3]; 6] = [
        [68.0, 1.0, 84.0],
        [65.0, 68.0, 135.0],
        [42.0, 120.0, 142.0],
        [34.0, 168.0, 132.0],
        [122.0, 209.0, 81.0],
        [253.0, 231.0, 37.0],
    ];
    if !part.is_finite() {
        return [160.0; 3];
    }
    let along = part.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let stop = (along as usize).min(STOPS.len() - 2);
    let between = along - stop as f64;
    [0, 1, 2].map(|i: usize| STOPS[stop][i] + between * (STOPS[stop + 1][i] - STOPS[stop][i]))
}

fn colour_bar(svg: &mut String, low: f64, high: f64, label: &str, height: f64) {
    const STEPS: usize = 50;
    let (x, top, tall) = (WIDTH - BAR + 14.0, 44.0, height - 76.0);
    for step in 0..STEPS {
        let part = (step as f64 + 0.5) / STEPS as f64;
        let [r, g, b] = colour(part).map(|c| c.round() as u8);
        let y = top + tall * (1.0 - (step + 1) as f64 / STEPS as f64);
        let _ = writeln!(
            svg,
            "<rect x=\"{x:.1}\" y=\"{y:.1}\" width=\"18\" height=\"{:.1}\" \
             fill=\"#{r:02x}{g:02x}{b:02x}\"/>",
            tall / STEPS as f64 + 0.6
        );
    }
    for tick in 0..=4 {
        let part = f64::from(tick) / 4.0;
        let value = low + part * (high - low);
        let y = top + tall * (1.0 - part) + 5.0;
        let _ = writeln!(
            svg,
            "<text x=\"{:.1}\" y=\"{y:.1}\" fill=\"#1e1e1e\">{}</text>",
            x + 24.0,
            short(value, high - low)
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{:.1}\" y=\"24\" text-anchor=\"end\" fill=\"#1e1e1e\">{}</text>",
        WIDTH - 8.0,
        label.replace('&', "&amp;").replace('<', "&lt;")
    );
}

/// A value with three digits of the range.
fn short(value: f64, range: f64) -> String {
    let places = if range > 0.0 { (2.0 - range.log10().floor()).clamp(0.0, 6.0) } else { 2.0 };
    format!("{value:.*}", places as usize)
}
