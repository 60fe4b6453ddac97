//! Plane outlines: points along lines and arcs.

use crate::mesh::generate::grading::uniform;

pub type Point = [f64; 2];

/// A path of points, extended at its end.
pub struct Path(pub Vec<Point>);

impl Path {
    pub fn from(start: Point) -> Path {
        Path(vec![start])
    }

    pub fn last(&self) -> Point {
        self.0[self.0.len() - 1]
    }

    pub fn line_to(&mut self, end: Point, steps: usize) {
        let start = self.last();
        for part in &uniform(0.0, 1.0, steps)[1..] {
            self.0.push(between(start, end, *part));
        }
    }

    /// Adds an arc between two angles; the path must end at the first.
    pub fn arc(&mut self, centre: Point, radius: f64, from: f64, to: f64, steps: usize) {
        for angle in &uniform(from, to, steps)[1..] {
            self.0.push(on_circle(centre, radius, *angle));
        }
    }

    /// The path followed by its mirror image, as a closed loop; the coordinate `flip` changes sign. The
    /// path must begin and end where that coordinate is zero.
    pub fn closed_by_mirror(self, flip: usize) -> Vec<Point> {
        let mut points = self.0;
        for index in (0..points.len() - 1).rev() {
            let mut image = points[index];
            image[flip] = -image[flip];
            points.push(image);
        }
        points
    }
}

pub fn on_circle(centre: Point, radius: f64, angle: f64) -> Point {
    [centre[0] + radius * libm::cos(angle), centre[1] + radius * libm::sin(angle)]
}

/// Linear interpolation between `a` and `b` at the fraction `part`, exact at both ends.
pub fn between(a: Point, b: Point, part: f64) -> Point {
    [0, 1].map(|i| if part == 1.0 { b[i] } else { a[i] + (b[i] - a[i]) * part })
}
