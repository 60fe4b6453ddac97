//! Rating life against the sums and tables of ISO 281.

use bearing_dynamics::ch2_housing::bearing::geometry::BearingGeometry;
use bearing_dynamics::ch2_housing::bearing::rating::{dynamic_rating, reference_life};
use std::f64::consts::TAU;

/// A ball diameter of `diameter` (m), grooves of the given shares of it.
fn bearing(balls: usize, diameter: f64, gamma: f64, [inner, outer]: [f64; 2]) -> BearingGeometry {
    let (ball, pitch) = (0.5 * diameter, 0.5 * diameter / gamma);
    let grooves = [inner * diameter, outer * diameter];
    BearingGeometry::deep_groove(balls, pitch - ball, grooves[0], pitch + ball, grooves[1], ball)
}

/// ISO 281, Table 2: f_c over D cos α/D_pw, four digits of 1.3 f_c Z^(2/3) D^1.8.
#[test]
fn ratings_are_those_of_the_table() {
    for (gamma, factor) in [
        (0.05, 46.7),
        (0.06, 49.1),
        (0.08, 52.8),
        (0.10, 55.5),
        (0.12, 57.5),
        (0.16, 59.6),
        (0.20, 59.9),
        (0.22, 59.6),
        (0.26, 58.2),
    ] {
        for (diameter, size) in [(11.5f64, 11.5f64.powf(1.8)), (30.0, 3.647 * 30f64.powf(1.4))] {
            let expected = 1.3 * factor * 27f64.powf(2.0 / 3.0) * size;
            for conformities in [[0.52, 0.52], [0.52, 0.53], [0.51, 0.515]] {
                let own = dynamic_rating(&bearing(27, 1e-3 * diameter, gamma, conformities));
                assert!((own / expected - 1.0).abs() <= 1.2e-3, "{gamma} {own} {expected}");
            }
        }
    }
    // A wider groove carries less, a contact angle cos^0.7.
    let of = |conformities| dynamic_rating(&bearing(8, 0.0115, 0.2, conformities));
    assert!(of([0.54, 0.53]) < 0.9 * of([0.52, 0.53]) && of([0.52, 0.55]) < of([0.52, 0.53]));
    let angle = 0.5f64;
    let [ball, groove] = [0.5, 0.52].map(|share| share * 0.0115);
    let pitch = ball * angle.cos() / 0.2;
    let angular = BearingGeometry::angular_contact(8, pitch, groove, groove, ball, angle);
    let straight = bearing(8, 0.0115, 0.2, [0.52, 0.52]);
    let ratio = dynamic_rating(&angular) / dynamic_rating(&straight);
    assert!((ratio / angle.cos().powf(0.7) - 1.0).abs() <= 1e-12, "{ratio}");
}

/// The rating is the radial load under which half the balls are loaded and a million revolutions survive.
#[test]
fn the_rating_is_the_load_of_a_million_revolutions() {
    let geometry = bearing(200, 0.0115, 0.26, [0.52, 0.53]);
    let rating = 23.4e3;
    let share = |ball: usize| (TAU * ball as f64 / 200.0).cos().max(0.0);
    let sum: f64 = (0..200).map(|ball| share(ball).powf(2.5)).sum();
    let loads: Vec<[f64; 2]> =
        (0..200).map(|ball| [rating / sum * share(ball).powf(1.5); 2]).collect();
    let life = reference_life(&geometry, rating, &loads, [true, false]).unwrap();
    assert!((life - 1.0).abs() <= 2e-3, "{life}");
    // Cube law; another race rotates: 3 and 10/3 change places.
    let half: Vec<[f64; 2]> = loads.iter().map(|load| load.map(|q| 0.5 * q)).collect();
    let longer = reference_life(&geometry, rating, &half, [true, false]).unwrap();
    assert!((longer / life - 8.0).abs() <= 1e-9, "{longer}");
    let turned = reference_life(&geometry, rating, &loads, [false, true]).unwrap();
    assert!(turned < 0.95 * life, "{turned}");
    // Under equal loads it makes no difference.
    let even = [[700.0, 700.0]; 200];
    let [one, other] =
        [[true, false], [false, true]].map(|turns| reference_life(&geometry, rating, &even, turns));
    assert!((one.unwrap() / other.unwrap() - 1.0).abs() <= 1e-12);
    assert_eq!(reference_life(&geometry, rating, &[[0.0; 2]; 200], [true, false]), None);
}
