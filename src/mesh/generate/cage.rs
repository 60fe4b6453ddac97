//! Cage of a ball bearing: a ring with radial cylindrical pockets.
//!
//! Each pocket is in a sector of the ring. At radius r let s = r sin φ be the distance from
//! the pocket's middle plane; then the pocket is the circle s² + x² = r_p² on every layer, and the
//! sector a rectangle. The cells of a layer are between rays from circle to rectangle.

use crate::mesh::error::MeshError;
use crate::mesh::generate::grading::uniform;
use crate::mesh::generate::hexahedra::Hexahedra;
use crate::mesh::generate::{ON_SURFACE, Solid, between, divisions};
use crate::mesh::select::faces_on;
use crate::mesh::surface::Surface;
use crate::mesh::tet_mesh::Face;
use crate::mesh::topology::surface;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// A cage about the X axis, centred on the origin; the first pocket is at +Y. Lengths in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cage {
    pub pocket_count: usize,
    pub pocket_radius: f64,
    pub inner_radius: f64,
    pub outer_radius: f64,
    /// Axial width. The source gives a mass instead.
    pub width: f64,
    /// Relieved rails; not in the source.
    pub relief: Option<RailRelief>,
}

/// Relief of the rails: the outer surface is a cylinder over `belt_width` in the middle and tapers conically by
/// `depth` to both edges.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RailRelief {
    pub depth: f64,
    pub belt_width: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CageMesh {
    /// Along a quarter of a pocket's edge.
    pub quarter: usize,
    /// From a pocket's edge to the middle of the bar and the edge of the rail.
    pub bar: usize,
    /// Through the wall.
    pub wall: usize,
}

impl Cage {
    /// Outer radius at the axial position `x`, m.
    pub fn outer_radius_at(&self, x: f64) -> f64 {
        match self.relief {
            None => self.outer_radius,
            Some(relief) => {
                let (belt, edge) = (0.5 * relief.belt_width, 0.5 * self.width);
                self.outer_radius - relief.depth * ((x.abs() - belt) / (edge - belt)).max(0.0)
            }
        }
    }

    fn check(&self) -> Result<(), MeshError> {
        divisions("pockets", self.pocket_count, 2)?;
        between("inner radius", self.inner_radius, 0.0, self.outer_radius)?;
        between("outer radius", self.outer_radius, 0.0, f64::INFINITY)?;
        between("width", self.width, 0.0, f64::INFINITY)?;
        let room = self.inner_radius * libm::sin(PI / self.pocket_count as f64);
        between("pocket radius", self.pocket_radius, 0.0, room.min(0.5 * self.width))?;
        if let Some(relief) = self.relief {
            let wall = self.outer_radius - self.inner_radius;
            between("relief of the rails", relief.depth, 0.0, wall)?;
            between("width of the belt", relief.belt_width, 0.0, self.width)?;
        }
        Ok(())
    }

    /// The cone of the relief on the side `sign` of the middle.
    fn cone(&self, relief: RailRelief, sign: f64) -> Surface {
        let (belt, edge) = (0.5 * relief.belt_width, 0.5 * self.width);
        Surface::Cone {
            point: [sign * belt, 0.0, 0.0],
            axis: [sign, 0.0, 0.0],
            radius: self.outer_radius,
            slope: -relief.depth / (edge - belt),
        }
    }

    /// Meshes the cage. Sets: `inner`, `outer`, `x_low`, `x_high`, `pocket_1`, `pocket_2`, ….
    ///
    /// # Errors
    /// [`MeshError::Dimension`] where pockets, bars or rails would not fit.
    pub fn solid(&self, mesh: &CageMesh) -> Result<Solid, MeshError> {
        self.check()?;
        divisions("cells along a quarter of a pocket", mesh.quarter, 2)?;
        divisions("cells across half a bar", mesh.bar, 1)?;
        divisions("cells through the wall", mesh.wall, 1)?;
        let mut cells = Hexahedra::default();
        for pocket in 0..self.pocket_count {
            self.add_sector(&mut cells, mesh, self.pocket_angle(pocket));
        }
        let mut mesh = cells.into_mesh()?;

        let mut rest = surface(&mesh);
        let tolerance = ON_SURFACE * mesh.size();
        let edge = 0.5 * self.width;
        let inner = Surface::about_x(self.inner_radius);
        let mut curved = vec![inner, Surface::about_x(self.outer_radius)];
        if let Some(relief) = self.relief {
            curved.extend([self.cone(relief, 1.0), self.cone(relief, -1.0)]);
        }
        let mut sets = vec![
            ("inner".to_string(), faces_on(&mesh, &rest, &inner, tolerance)),
            ("x_low".to_string(), faces_on(&mesh, &rest, &Surface::plane(0, -edge), tolerance)),
            ("x_high".to_string(), faces_on(&mesh, &rest, &Surface::plane(0, edge), tolerance)),
        ];
        for pocket in 0..self.pocket_count {
            let angle = self.pocket_angle(pocket);
            let axis = [0.0, libm::cos(angle), libm::sin(angle)];
            let hole = Surface::Cylinder { point: [0.0; 3], axis, radius: self.pocket_radius };
            // The same cylinder also cuts the opposite side of the ring, perhaps through another pocket.
            let here = |face: &Face| {
                let [_, y, z] = mesh.nodes[mesh.face_corners(*face)[0] as usize];
                y * axis[1] + z * axis[2] > 0.0
            };
            let mut faces = faces_on(&mesh, &rest, &hole, tolerance);
            faces.retain(here);
            sets.push((format!("pocket_{}", pocket + 1), faces));
            curved.push(hole);
        }
        // The remaining faces are the outer surface, including faces across the belt's edge.
        let mut taken: Vec<Face> = sets.iter().flat_map(|(_, faces)| faces.clone()).collect();
        taken.sort_unstable();
        rest.retain(|face| taken.binary_search(face).is_err());
        sets.push(("outer".to_string(), rest));
        for (name, faces) in sets {
            mesh.node_sets.insert(name.clone(), mesh.nodes_of_faces(&faces));
            mesh.surface_sets.insert(name, faces);
        }
        Ok(Solid { mesh, curved })
    }

    fn pocket_angle(&self, pocket: usize) -> f64 {
        TAU * pocket as f64 / self.pocket_count as f64
    }

    fn add_sector(&self, cells: &mut Hexahedra, mesh: &CageMesh, middle: f64) {
        let loop_points = square_loop(mesh.quarter);
        let half_sector = libm::sin(PI / self.pocket_count as f64);
        let across = uniform(0.0, 1.0, mesh.bar);
        let wall = uniform(0.0, 1.0, mesh.wall);
        cells.add_block([loop_points.len() - 1, mesh.bar, mesh.wall], |[i, j, k]| {
            let ([u, v], angle) = loop_points[i];
            let (part, depth) = (across[j], wall[k]);
            let on_circle = self.pocket_radius * libm::sin(angle);
            let x = on_circle + (0.5 * self.width * v - on_circle) * part;
            let outer = self.outer_radius_at(x);
            let r = self.inner_radius + (outer - self.inner_radius) * depth;
            let on_circle = self.pocket_radius * libm::cos(angle);
            let s = on_circle + (r * half_sector * u - on_circle) * part;
            let azimuth = middle + libm::asin(s / r);
            [x, r * libm::cos(azimuth), r * libm::sin(azimuth)]
        });
    }
}

/// Points around the square [-1, 1]², each with its angle on the inscribed circle: `quarter`
/// steps per side, the first point repeated at the end.
fn square_loop(quarter: usize) -> Vec<([f64; 2], f64)> {
    let mut points = Vec::new();
    for side in 0..4 {
        for step in 0..quarter {
            let along = -1.0 + 2.0 * step as f64 / quarter as f64;
            let corner = match side {
                0 => [1.0, along],
                1 => [-along, 1.0],
                2 => [-1.0, -along],
                _ => [along, -1.0],
            };
            points.push((corner, FRAC_PI_4 * (2.0 * side as f64 + along)));
        }
    }
    points.push(points[0]);
    points
}
