//! What studies of motions and of solids make of their numbers.

use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::{RingMesh, ring};
use bearing_dynamics::motion::simulation::Integrator;
use bearing_dynamics::solids::model::SolidModel;
use bearing_dynamics::solids::modes::{ModeOptions, modes};
use bearing_dynamics::solids::tangent::MassMatrix;
use verification::pareto::Point;
use verification::solid_bodies::thin_ring;
use verification::solids::{STEEL, free_body, mesh_of};
use verification::studies::motion::{
    History, Method, Window, best_errors, beyond_limit, errors, from_first_to_last,
};
use verification::studies::solids::ring::oval_shape;
use verification::studies::solids::{Limit, Timed, falls_short, frequency_by_steps};

#[test]
fn errors_are_parts_of_the_displacement_the_swing_and_the_turn() {
    let history = |race: Vec<[f64; 3]>, cage_turn| History {
        race,
        cage_turn,
        ball_turn: -0.25,
        ..History::default()
    };
    let reference = history(vec![[0.0, 1.0, -10.0], [0.0, 2.0, -14.0]], 0.5);
    let found = history(vec![[0.0, 1.0, -10.0], [0.01, 2.02, -14.0]], 0.51);
    let found = History { ball_turn: -0.26, ..found };
    let [displacement, swing, cage, balls] = errors(&found, &reference);
    let expected = [(displacement, 0.02 / 14.0), (swing, 0.02 / 4.0), (cage, 0.02), (balls, 0.04)];
    for (found, expected) in expected {
        assert!((found / expected - 1.0).abs() <= 1e-12, "{found} {expected}");
    }
    // A run that ended early, and one that lost a number, are infinitely far off or no number.
    let early = history(vec![[0.0, 1.0, -10.0]], 0.5);
    assert_eq!(errors(&early, &reference)[0], f64::INFINITY);
    let lost = history(vec![[0.0, f64::NAN, -10.0], [0.0, 2.0, -14.0]], 0.5);
    assert!(errors(&lost, &reference)[0].is_nan());
}

#[test]
fn a_step_beyond_the_limit_is_unstable_and_one_with_error_control_is_not() {
    assert!(beyond_limit(Method::rk4(1.01e-6), Some(1e-6)));
    assert!(!beyond_limit(Method::rk4(0.99e-6), Some(1e-6)));
    assert!(!beyond_limit(Method::rk4(1.0), None));
    let controlled = Method::accurate(Integrator::DormandPrince, 1e-3);
    assert!(!beyond_limit(controlled, Some(1e-9)));
}

#[test]
fn models_are_summed_up_from_their_points() {
    let point = |variant: &str, seconds, error, further| Point {
        more_errors: vec![further],
        ..Point::new("fit", variant, seconds, error)
    };
    let points = [point("5", 1.0, 0.5, 0.02), point("45", 3.0, 0.25, 0.04)];
    assert_eq!(
        best_errors(&points, &[1, 0], "fit"),
        "2.5e-1 of the race's swing, 2.0e-2 of the race's displacement"
    );
    assert_eq!(
        from_first_to_last(&points),
        "From 5 to 45 the time grows by a factor of 3.0 and the error goes from 5.0e-1 to 2.5e-1."
    );
}

#[test]
fn steps_fit_into_rows() {
    let window = Window { end: 1e-3, rows: 10 };
    assert!((window.fitting(3e-5) - 2.5e-5).abs() <= 1e-18);
    assert!((window.fitting(2.5e-5) - 2.5e-5).abs() <= 1e-18);
}

fn on_mesh(series: &str, value: f64) -> Timed {
    let series = series.to_string();
    Timed { series, nodes: 1, value, evaluations: None, seconds: 1.0, repeats: 1 }
}

#[test]
fn a_limit_is_what_numbers_of_its_series_tend_to() {
    let mut all = vec![on_mesh("other", 7.0)];
    // 3 + h² over h = 1, ½, ¼, and a mesh between them that is not used.
    all.extend([4.0, 3.6, 3.25, 3.0625].map(|value| on_mesh("own", value)));
    let limit = Limit::new(&all, "own", [0, 2, 3]);
    assert!((limit.value - 3.0).abs() <= 1e-14 && (limit.order - 2.0).abs() <= 1e-14);
    assert!((limit.left - 0.0625 / 3.0).abs() <= 1e-14);
}

#[test]
fn what_falls_short_is_continued_at_its_rate() {
    let point = |nodes: usize, error| Point::new("slow", &format!("{nodes} nodes"), 1.0, error);
    let (a, b) = (point(100, 0.08), point(1000, 0.04));
    let said = falls_short(&[&a, &b]);
    // A tenth of the error for half a decade of nodes each: 4 % to 1 % takes a hundredfold.
    assert!(said.contains("4.00 % on 1000 nodes") && said.contains("power 0.30"), "{said}");
    assert!(said.contains("1e5 nodes for 1 % and 2e8 nodes for 0.1 %"), "{said}");
    let stuck = falls_short(&[&a, &point(1000, 0.08)]);
    assert!(stuck.contains("hardly falls"), "{stuck}");
}

/// The start is no mode of the mesh, yet half a period tells the frequency.
#[test]
fn explicit_steps_have_the_frequency_of_their_masses() {
    let cells = RingMesh { around: 48, radial: 1, axial: 1, radial_growth: 1.0 };
    let solid = ring(&thin_ring::BODY, &cells).unwrap();
    let mesh = mesh_of(&solid, Order::Quadratic).unwrap();
    let problem = free_body(&mesh, STEEL);
    let options = ModeOptions { mass: MassMatrix::Lumped, ..ModeOptions::new(8) };
    let found = modes(&SolidModel::new(problem.clone()).unwrap(), &options).unwrap();
    let expected = 0.5 * (found.modes[6].frequency + found.modes[7].frequency);
    let shape = oval_shape(&mesh, 0.05);
    let (by_steps, evaluations) = frequency_by_steps(&problem, &shape, expected).unwrap();
    println!("{:e} off", by_steps / expected - 1.0);
    // Other modes have a share of some percent in the start, and count by its square.
    assert!((by_steps / expected - 1.0).abs() <= 5e-4, "{by_steps} {expected}");
    assert!(evaluations.is_some_and(|count| count > 1000));
}
