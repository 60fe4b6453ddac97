//! Thin rings against Hoppe.

use verification::oracles::ring::{Plane, Ring};

#[test]
fn a_thin_ring_is_hoppes() {
    let ring = Ring {
        inner: 0.0995,
        outer: 0.1005,
        width: 1e-3,
        young: 2e11,
        poisson: 0.3,
        density: 8000.0,
    };
    for waves in [2, 3] {
        let ratio = ring.frequency(waves, Plane::In) / ring.thin_ring(waves);
        // (n t/R)²/6 or so.
        assert!((ratio - 1.0).abs() <= 3e-4, "{waves} {ratio}");
    }
}
