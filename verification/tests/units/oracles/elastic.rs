//! The elastic body of the oracles.

use verification::oracles::elastic::{ElasticBody, slopes};

/// A cube of six tetrahedra between two plates: pulled evenly, its face moves by F/(E A) times the
/// length, if Poisson's ratio is zero so that the held face does not hinder.
#[test]
fn a_bar_without_contraction_follows_hooke() {
    let at = |n: usize| [(n & 1) as f64, (n >> 1 & 1) as f64, (n >> 2 & 1) as f64];
    let body = ElasticBody {
        nodes: (0..8).map(at).collect(),
        elements: [
            [0, 1, 3, 7],
            [0, 3, 2, 7],
            [0, 2, 6, 7],
            [0, 6, 4, 7],
            [0, 4, 5, 7],
            [0, 5, 1, 7],
        ]
        .map(|e| e.to_vec())
        .to_vec(),
        held: vec![0, 2, 4, 6],
        young: 200.0,
        poisson: 0.0,
    };
    let faces = [1, 3, 5, 7];
    let compliance = body.compliance(&faces);
    // A third of each triangle's area to its corners: 1, 3, 7 and 1, 7, 5.
    let share = [1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 3.0];
    for row in 0..4 {
        let moved: f64 = (0..4).map(|c| compliance[(3 * row, 3 * c)] * share[c]).sum();
        assert!((moved * 200.0 - 1.0).abs() <= 1e-12, "{moved}");
    }
    assert!((compliance.transpose() - &compliance).amax() <= 1e-12 * compliance.amax());
}

#[test]
fn slopes_are_those_of_the_shape_functions() {
    let l = [0.1, 0.2, 0.3, 0.4];
    for nodes in [4, 10] {
        let slopes = slopes(nodes, l);
        for j in 0..3 {
            let sum: f64 = slopes.iter().map(|s| s[j]).sum();
            assert!(sum.abs() <= 1e-14, "the sum of shape functions is one: {sum}");
        }
    }
}
