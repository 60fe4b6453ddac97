//! Mass and moments of inertia of bearing parts, from geometry and density. The dissertation gives only the cage's mass
//! (Table 5.3).

use std::f64::consts::PI;

/// Mass and inertia of a rigid body with X as axis of symmetry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inertia {
    /// kg.
    pub mass: f64,
    /// About the axis of symmetry, kg·m².
    pub axial: f64,
    /// About a transverse axis through the centre of mass, kg·m².
    pub transverse: f64,
}

/// Solid ball of `radius` (m) and `density` (kg/m³): 4/3 π ρ r³ and 2/5 m r².
pub fn ball(radius: f64, density: f64) -> Inertia {
    let mass = 4.0 / 3.0 * PI * density * radius * radius * radius;
    let moment = 0.4 * mass * radius * radius;
    Inertia { mass, axial: moment, transverse: moment }
}

/// Hollow cylinder of radii `inner` < `outer` and axial `length` (m), density in kg/m³.
pub fn hollow_cylinder(inner: f64, outer: f64, length: f64, density: f64) -> Inertia {
    let squares = inner * inner + outer * outer;
    let mass = PI * density * (outer * outer - inner * inner) * length;
    Inertia {
        mass,
        axial: 0.5 * mass * squares,
        transverse: mass * (0.25 * squares + length * length / 12.0),
    }
}

/// Hollow cylinder with a groove of circular cross-section in its inner or outer surface. `land` is the radius of the
/// grooved surface, `groove_radius` the radius of the groove around a circle of radius `centre_radius` in the
/// mid-plane, all in m. Integrated over the axial coordinate.
pub fn grooved_ring(
    plain: f64,
    land: f64,
    centre_radius: f64,
    groove_radius: f64,
    length: f64,
    density: f64,
) -> Inertia {
    // Thin discs integrated by Gauss–Legendre quadrature on both sides of the groove's edge, where the profile has a
    // corner.
    let depth_of = |x: f64| {
        let inside = groove_radius * groove_radius - x * x;
        if inside <= 0.0 {
            return land;
        }
        // The groove is cut from the land towards the plain surface.
        let toward_plain = if land > plain { -1.0 } else { 1.0 };
        let surface = centre_radius + toward_plain * inside.sqrt();
        if (land > plain) == (surface < land) { surface } else { land }
    };
    let to_edge = land - centre_radius;
    let edge = (groove_radius * groove_radius - to_edge * to_edge).max(0.0).sqrt();
    let half = 0.5 * length;
    let edge = edge.min(half);
    let mut total = Inertia { mass: 0.0, axial: 0.0, transverse: 0.0 };
    for (from, to) in [(0.0, edge), (edge, half)] {
        for (node, weight) in GAUSS_8 {
            let x = 0.5 * (from + to) + 0.5 * (to - from) * node;
            let (inner, outer) = {
                let surface = depth_of(x);
                if surface < plain { (surface, plain) } else { (plain, surface) }
            };
            let slab = 0.5 * (to - from) * weight * 2.0 * density * PI;
            let area = outer * outer - inner * inner;
            let fourth = outer.powi(4) - inner.powi(4);
            total.mass += slab * area;
            total.axial += slab * 0.5 * fourth;
            total.transverse += slab * (0.25 * fourth + area * x * x);
        }
    }
    total
}

/// Nodes and weights of eight-point Gauss–Legendre quadrature on [−1, 1].
const GAUSS_8: [(f64, f64); 8] = [
    (-0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
    (-0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (-0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (-0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];
