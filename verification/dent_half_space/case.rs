//! Loads over three dents at places on neither axis of the contact, against a half-space of boundary elements.

use bearing_dynamics::ch2_housing::bearing::geometry::{BearingGeometry, Material};
use bearing_dynamics::ch2_housing::bearing::hertz::{HertzModel, RaceSide, contact};
use bearing_dynamics::ch3_bushing::dent::{DentShape, dented_load};
use bearing_dynamics::members::dent_table::{DentedContact, usual_table};

use crate::case::{Case, CaseError, Tier};
use crate::check::Check;
use crate::context::CaseContext;
use crate::oracles::half_space::HalfSpace;
use crate::solids::largest;

pub const CASE: Case = Case {
    id: "dent_half_space",
    title: "Load over a dent, on neither axis of the contact",
    section: "3.4.4, (3.20)",
    tier: Tier::Full,
    published: include_str!("published.toml"),
    run,
};

/// Of Table 3.5 with the ball's radius in the middle of its range, m.
const BALL: f64 = 5.9555e-3;
const OUTER: f64 = 31.953e-3;
const GROOVE: f64 = 6.310e-3;
/// Diameter, depth, height and width of the shoulder, m.
const DENTS: [(&str, &str, [f64; 4]); 3] = [
    ("wide", "1.5 mm, 15 um deep", [1.5e-3, 15e-6, 0.0, 0.0]),
    ("steep", "0.5 mm, 25 um deep", [0.5e-3, 25e-6, 0.0, 0.0]),
    ("raised", "0.5 mm, 10 um deep, shoulder 1 um high", [0.5e-3, 10e-6, 1e-6, 125e-6]),
];
/// Approaches, m: undented pressure 1.3 and 1.8 GPa.
const APPROACHES: [f64; 2] = [5e-6, 10e-6];
/// Places over the lengths at which the dent leaves the overlap of the ball; degrees.
const DISTANCES: [f64; 4] = [0.15, 0.3, 0.45, 0.6];
const ANGLES: [f64; 5] = [8.0, 113.0, 220.0, 308.0, 68.0];
/// Rectangles of the half-space in each direction.
const CELLS: usize = 64;

/// The dented contact of the oracle.
struct Dented {
    radii: [f64; 2],
    sizes: [f64; 4],
}

impl Dented {
    /// Half a wave deep, a whole one high.
    fn depth(&self, r: f64) -> f64 {
        let [diameter, depth, height, width] = self.sizes;
        let beyond = r - 0.5 * diameter;
        if beyond < 0.0 {
            return depth * (0.5 * std::f64::consts::PI * r / (0.5 * diameter)).cos().powi(2);
        }
        if beyond < width {
            -height * (std::f64::consts::PI * beyond / width).sin().powi(2)
        } else {
            0.0
        }
    }

    /// Half-lengths of the overlap of the ball at an approach, m.
    fn overlap(&self, approach: f64) -> [f64; 2] {
        self.radii.map(|radius| (2.0 * radius * (approach + self.sizes[2])).sqrt())
    }

    /// Load with the dent at each of `places` over that without it.
    fn shares(&self, cells: usize, approach: f64, places: &[[f64; 2]]) -> Vec<f64> {
        let space = HalfSpace::new(cells, self.overlap(approach));
        let [rx, ry] = self.radii;
        let ball = |[x, y]: [f64; 2]| 0.5 * (x * x / rx + y * y / ry);
        let flat = space.press(ball, approach).load;
        let over = |[s, y]: &[f64; 2]| {
            let gap = |at: [f64; 2]| ball(at) + self.depth((at[0] - s).hypot(at[1] - y));
            space.press(gap, approach).load / flat
        };
        places.iter().map(over).collect()
    }
}

fn run(context: &mut CaseContext) -> Result<(), CaseError> {
    let radii = [1.0 / (1.0 / BALL - 1.0 / OUTER), 1.0 / (1.0 / BALL - 1.0 / GROOVE)];
    let steel = Material::STEEL;
    let geometry = BearingGeometry::deep_groove(8, 20.047e-3, 6.013e-3, OUTER, GROOVE, BALL);
    let hertz = contact(HertzModel::Exact, RaceSide::Outer, &geometry, &steel, &steel)?;
    let mut rows = Vec::new();
    for (id, text, sizes) in DENTS {
        let [diameter, depth, shoulder_height, shoulder_width] = sizes;
        let shape = DentShape { diameter, depth, shoulder_height, shoulder_width };
        let table = usual_table(&DentedContact::new(shape, &hertz))?;
        let dented = Dented { radii, sizes };
        for approach in APPROACHES {
            let lengths = dented.overlap(approach).map(|half| half + shape.reach());
            let place = |(distance, angle): (f64, f64)| {
                let (sin, cos) = angle.to_radians().sin_cos();
                [distance * lengths[0] * cos, distance * lengths[1] * sin]
            };
            let all = DISTANCES.iter().flat_map(|distance| ANGLES.map(|angle| (*distance, angle)));
            let places: Vec<[f64; 2]> = all.map(place).collect();
            let expected = dented.shares(CELLS, approach, &places);
            let own = |place: &[f64; 2]| {
                dented_load(1.0, approach, table.exponent(approach, *place)) / approach.powf(1.5)
            };
            let found: Vec<f64> = places.iter().map(own).collect();
            let off = |(found, expected): (&f64, &f64)| (found / expected - 1.0).abs();
            let um = 1e6 * approach;
            context.check(
                Check::new(
                    &format!("{id}_{um:.0}um"),
                    &format!(
                        "dent of {text}: worst error of a load at 20 places, approach {um:.0} um"
                    ),
                    "%",
                    100.0 * largest(found.iter().zip(&expected).map(off)),
                )
                .independent(0.0, "half-space of boundary elements, 64 × 64")
                .absolute(2.0, "cells of a fortieth of the overlap, seven directions of the table"),
            );
            for ((place, found), expected) in places.iter().zip(&found).zip(&expected) {
                rows.push(vec![
                    text.into(),
                    format!("{um:.0}"),
                    format!("{:.3}, {:.3}", 1e3 * place[0], 1e3 * place[1]),
                    format!("{found:.4}"),
                    format!("{expected:.4}"),
                ]);
            }
        }
    }
    let dented = Dented { radii, sizes: DENTS[0].2 };
    let place = [[0.45e-3, 0.55e-3]];
    let [coarse, fine] = [32, 128].map(|cells| dented.shares(cells, APPROACHES[0], &place)[0]);
    context.check(
        Check::new(
            "cells",
            "share of the load, dent 0.45 mm ahead and 0.55 mm aside, 32 × 32",
            "1",
            coarse,
        )
        .converged(fine, "128 × 128")
        .relative(2e-3, "cells at the edge of the contact"),
    );
    context.table(
        "places",
        "Load over that of the undented contact at the same approach",
        &[
            "dent",
            "approach, um",
            "rolling direction, across the groove, mm",
            "table",
            "half-space",
        ],
        rows,
    );
    Ok(())
}
