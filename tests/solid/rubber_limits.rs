//! Rubber at its limits: great strain, straight chains, hardly any change of volume, steps far from the
//! relaxation times, sudden loads, constants that are none.

use super::rubber_bodies::{
    HELD, bonded, cube, fixed, network, pulled_cube, quadratic, rubber_of, with_bulk,
};
use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::ch2_housing::elastomer::{Elastomer, ElastomerError, named};
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bushing};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::error::{SolidError, StepFailure};
use bearing_dynamics::solids::model::Load;
use bearing_dynamics::solids::rubber::bar::Bar;
use bearing_dynamics::solids::rubber::checkpoint::RubberCheckpoint;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};

const SIDE: f64 = 0.012;

fn end_of(model: &RubberModel) -> Vec<u32> {
    let nodes = 0..model.problem.nodes.len() as u32;
    nodes.filter(|n| model.problem.nodes[*n as usize][0] > SIDE - 1e-9).collect()
}

fn chains(bulk: f64) -> EightChain {
    EightChain::new(1e6, 8.0, bulk * 1e6, ChainPull::FiveTerms).unwrap()
}

/// A cube of shaken elements, pulled or pressed to `stretch` in `steps` of `dt` s and then held as long, and one
/// point in the same steps. Returns the cube's stress at the end of either, Pa.
fn cube_beside_bar(
    rubber: &Elastomer,
    cells: usize,
    stretch: f64,
    dt: f64,
    steps: usize,
) -> [f64; 2] {
    let at = |n: usize| (stretch - 1.0) * n.min(steps) as f64 / steps as f64;
    let points = (0..=2 * steps).map(|n| [dt * n as f64, SIDE * at(n)]).collect();
    let model = pulled_cube(rubber.clone(), Profile::Table { points }, cells);
    let end = end_of(&model);
    let mut solid = RubberSolid::new(&model, fixed(dt)).unwrap();
    let mut bar = Bar::new(rubber).unwrap();
    let mut found = [0.0; 2];
    for n in 1..=2 * steps {
        solid.advance(dt * n as f64, |_| {}).unwrap();
        bar.step(dt, at(n).ln_1p()).unwrap();
        let side = SIDE * (1.0 + bar.lateral);
        let stress = solid.support_force(&end)[0] / (side * side);
        // Equilibrium is good to 1e-9 of the largest force on a node, of which the end's is a sum of some
        // tens; a stress of 1 MPa is the least scale.
        let gap = (stress - bar.stress).abs();
        assert!(gap <= 1e-7 * bar.stress.abs().max(1e6), "{n}: {stress} {}", bar.stress);
        found[n / (2 * steps)] = if n >= steps { stress } else { 0.0 };
    }
    assert_eq!(solid.counts.undone, 0);
    found
}

/// 80 % of compression and 300 % of stretch with free sides. In motion the Maxwell elements keep the sides of the
/// pressed cube flat; see [`super::rubber_great_strain`] for the network alone.
#[test]
fn cubes_under_great_strain() {
    for (bulk, cells) in [(1e2, 2), (1e5, 1)] {
        let rubber = rubber_of(chains(bulk), &[Maxwell { gamma: 1.0, tau: 1.0 }; 2]);
        for stretch in [0.2, 4.0] {
            let [moved, held] = cube_beside_bar(&rubber, cells, stretch, 3.0 / 80.0, 80);
            assert!(moved.abs() > held.abs() && held.abs() > 1e6, "{moved} {held}");
        }
    }
}

#[test]
fn cubes_of_no_one_and_doubled_maxwell_elements() {
    let [none, whole, halves] =
        [vec![], vec![Maxwell { gamma: 2.0, tau: 0.3 }], vec![Maxwell { gamma: 1.0, tau: 0.3 }; 2]]
            .map(|elements| cube_beside_bar(&rubber_of(chains(1e2), &elements), 2, 0.7, 0.1, 6));
    // Nothing relaxes without elements; both searches end at 1e-9.
    assert!((none[0] / none[1] - 1.0).abs() <= 1e-7, "{none:?}");
    for (whole, halves) in whole.iter().zip(halves) {
        assert!((whole / halves - 1.0).abs() <= 1e-7, "{whole} {halves}");
    }
    assert!(whole[0] < 1.1 * none[0] && none[0] < 0.0, "pressed: {whole:?} {none:?}");
}

#[test]
fn cubes_in_steps_far_from_the_relaxation_time() {
    let alone = cube_beside_bar(&rubber_of(chains(1e2), &[]), 2, 1.3, 1.0, 5)[0];
    for (tau, factor) in [(1e6, 3.0), (1e-6, 1.0)] {
        let rubber = rubber_of(chains(1e2), &[Maxwell { gamma: 2.0, tau }]);
        let [moved, held] = cube_beside_bar(&rubber, 2, 1.3, 1.0, 5);
        // As if it never relaxed, or had no element; B is not three times as large, whence the 1 %.
        assert!((moved / (factor * alone) - 1.0).abs() <= 0.02, "{tau}: {moved} {alone}");
        assert!((held / moved - 1.0).abs() <= 2e-5, "{tau}: {moved} {held}");
    }
}

/// Where the volume may not grow either there is no state beyond the locking stretch: an error names element,
/// stretch and limit, and the state that stood stays.
#[test]
fn a_cube_whose_chains_are_straight() {
    let network = EightChain::new(1e6, 8.0, 1e8, ChainPull::Exact).unwrap();
    // √8 · √3 at a constant volume: 4.857.
    for (stretch, reached) in [(4.8, true), (5.5, false)] {
        let along = |t: f64| 1.0 + (stretch - 1.0) * t;
        let table = |of: &dyn Fn(f64) -> f64| {
            let points = (0..=400).map(|n| f64::from(n) / 400.0);
            Some(Profile::Table { points: points.map(|t| [t, SIDE * (of(t) - 1.0)]).collect() })
        };
        let across = table(&|t| 1.0 / along(t).sqrt());
        let mut mesh = cube(1);
        for (axis, name) in [(1, "y_end"), (2, "z_end")] {
            let nodes = 0..mesh.nodes.len() as u32;
            let end = nodes.filter(|n| mesh.nodes[*n as usize][axis] > SIDE - 1e-9).collect();
            mesh.node_sets.insert(name.into(), end);
        }
        let prescribed = supports(
            &mesh,
            &[
                ("x_low", [HELD, None, None]),
                ("y_low", [None, HELD, None]),
                ("z_low", [None, None, HELD]),
                ("x_high", [table(&along), None, None]),
                ("y_end", [None, across.clone(), None]),
                ("z_end", [None, None, across]),
            ],
        );
        let (elements, nodes) = (quadratic(&mesh), mesh.nodes);
        let (material, loads) = (rubber_of(network, &[]), Vec::new());
        let problem = RubberProblem { nodes, elements, material, prescribed, loads };
        let model = RubberModel::new(problem).unwrap();
        let mut solid = RubberSolid::new(&model, fixed(0.02)).unwrap();
        match solid.advance(1.0, |_| {}) {
            Ok(()) => assert!(reached, "at {stretch}"),
            Err(SolidError::NoEquilibrium {
                time,
                failure:
                    StepFailure::Material { source: ElastomerError::Locked { stretch, limit }, .. },
                ..
            }) => {
                assert!(!reached && stretch >= limit && (limit - 8f64.sqrt()).abs() <= 1e-12);
                assert!((along(time) - 4.857).abs() <= 0.01 && time == solid.time(), "{time}");
            }
            Err(other) => panic!("{other:?}"),
        }
    }
}

/// A load that is suddenly there meets the network with (1 + Σγ) C_R; in the end it rests on C_R alone.
#[test]
fn a_sudden_load() {
    let (c, bulk) = (1e6, 1e8);
    let of = |modulus: f64, terms: &[Maxwell]| {
        let network = EightChain::new(modulus, 8.0, bulk, ChainPull::FiveTerms).unwrap();
        let mut model = pulled_cube(rubber_of(network, terms), Profile::ZERO, 2);
        let end = end_of(&model);
        let RubberProblem { nodes, elements, material, mut prescribed, .. } = model.problem;
        prescribed.retain(|p| !(p.axis == 0 && end.contains(&p.node)));
        // 1 MPa: of a face with six nodes the three between corners take a third each.
        let mut forces = Vec::new();
        for element in &elements {
            let [corners, between] = [&element[..4], &element[4..]]
                .map(|list| list.iter().filter(|n| end.contains(n)).collect::<Vec<_>>());
            if let [a, b, c] = corners[..] {
                let [a, b, c] = [a, b, c].map(|n| nodes[*n as usize]);
                let [u, v] = [b, c].map(|x| [x[1] - a[1], x[2] - a[2]]);
                let area = 0.5 * (u[0] * v[1] - u[1] * v[0]).abs();
                forces.extend(between.iter().map(|n| (**n, [-1e6 * area / 3.0, 0.0, 0.0])));
            }
        }
        let profile = Profile::Ramp { from: 0.0, to: 1.0, start: 0.5, duration: 0.0 };
        let loads = vec![Load { profile, forces }];
        let problem = RubberProblem { nodes, elements, material, prescribed, loads };
        model = RubberModel::new(problem).unwrap();
        let mut solid = RubberSolid::new(&model, StepOptions::default()).unwrap();
        let mut first = None;
        solid
            .advance(50.0, |solid| {
                // Before the jump and, at the same time, after it.
                if solid.time() <= 0.5 {
                    first = Some((solid.time(), solid.displacement().to_vec()));
                }
            })
            .unwrap();
        (first.unwrap(), solid.displacement().to_vec())
    };
    let elements = [Maxwell { gamma: 2.0, tau: 0.5 }, Maxwell { gamma: 1.0, tau: 0.01 }];
    let ((when, first), last) = of(c, &elements);
    assert!((when - 0.5).abs() <= 1e-15);
    let gap = |a: &[[f64; 3]], b: &[[f64; 3]]| {
        let pairs = a.as_flattened().iter().zip(b.as_flattened());
        pairs.fold(0.0, |m: f64, (a, b)| m.max((a - b).abs()))
    };
    let sudden = of(4.0 * c, &[]).1;
    let rest = of(c, &[]).1;
    let pressed = -rest[end_of(&pulled_cube(with_bulk(1e2), Profile::ZERO, 2))[0] as usize][0];
    assert!(pressed > 0.15 * SIDE, "{pressed}");
    // Equilibrium to 1e-9 of the forces; what the estimate of steps' errors allows, 1e-4.
    assert!(gap(&first, &sudden) <= 1e-8 * SIDE, "{:e}", gap(&first, &sudden));
    assert!(gap(&last, &rest) <= 1e-4 * pressed, "{:e}", gap(&last, &rest));
}

/// Constants are public: whoever writes them past the constructors is told before anything is computed.
#[test]
fn constants_that_are_none_are_refused() {
    let sound = named::table_3_1();
    let with = |change: &dyn Fn(&mut Elastomer)| {
        let mut rubber = sound.clone();
        change(&mut rubber);
        rubber
    };
    let mut bad = Vec::new();
    for x in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        bad.push(with(&|r| r.network.modulus = x));
        bad.push(with(&|r| r.network.locking = x));
        bad.push(with(&|r| r.network.bulk = x));
        bad.push(with(&|r| r.maxwell[3].gamma = x));
        bad.push(with(&|r| r.maxwell[13].tau = x));
    }
    let straight =
        |r: &mut Elastomer| (r.network.pull, r.network.locking) = (ChainPull::Exact, 1.0);
    bad.push(with(&straight));
    for rubber in &bad {
        assert!(rubber.check().is_err(), "{rubber:?}");
        assert!(matches!(Bar::new(rubber), Err(SolidError::Constants(_))), "{rubber:?}");
        let problem = RubberProblem {
            nodes: Vec::new(),
            elements: Vec::new(),
            material: rubber.clone(),
            prescribed: Vec::new(),
            loads: Vec::new(),
        };
        let refused = RubberModel::new(problem).map(|_| ());
        assert!(matches!(refused, Err(SolidError::Constants(_))), "{refused:?}");
    }
    assert_eq!(sound.check(), Ok(()));
    let mut bar = Bar::new(&sound).unwrap();
    for dt in [-1e-3, f64::NAN] {
        let refused = bar.step(dt, 0.1);
        assert!(matches!(refused, Err(SolidError::Constants(ElastomerError::Step(_)))));
    }
    assert_eq!((bar.time, bar.stress), (0.0, 0.0));
}

#[test]
fn small_vibrations_that_cannot_be_told() {
    let rubber = named::table_3_1();
    let (model, _) = bonded(rubber.clone(), [4, 2, 1], Profile::Constant(1.0));
    for bad in [-1.0, f64::NAN] {
        let refused = complex_stiffness(&model, 0.0, &[0.0, bad], 1e-6);
        assert!(matches!(refused, Err(SolidError::Pulsation(_))), "{refused:?}");
    }
    // Nothing is as near as that; at B = 10 C_R there is always a further vector.
    let soft = Elastomer { network: with_bulk(10.0).network, ..rubber.clone() };
    let (soft, _) = bonded(soft, [8, 4, 2], Profile::Constant(1.0));
    for tolerance in [-1.0, f64::NAN] {
        let refused = complex_stiffness(&soft, 0.0, &[0.6, 1e12], tolerance);
        let Err(SolidError::NotSettled { vectors, change, .. }) = refused else {
            panic!("{refused:?}");
        };
        assert!(vectors == 40 && change <= 1e-6, "{change:e}");
    }
    let ends = complex_stiffness(&model, 0.0, &[1e15, f64::INFINITY], 1e-10).unwrap();
    let gap = (ends[0].storage / ends[1].storage - 1.0).abs();
    assert!(gap <= 1e-9 && ends[1].loss == 0.0, "{ends:?}");
    // Nothing moves: no stiffness, and no division by it.
    let (still, _) = bonded(rubber, [4, 2, 1], Profile::ZERO);
    let none = complex_stiffness(&still, 0.0, &[1.0], 1e-6).unwrap()[0];
    assert_eq!((none.storage, none.loss, none.change), (0.0, 0.0, 0.0));
}

#[test]
fn bars_under_great_strain() {
    // 80 % of compression and 300 % of stretch, also nearly without change of volume.
    for bulk in [1e2, 1e5] {
        let network = EightChain::new(1e6, 8.0, bulk * 1e6, ChainPull::FiveTerms).unwrap();
        let rubber = rubber_of(network, &[Maxwell { gamma: 1.0, tau: 1.0 }; 2]);
        for to in [0.2f64, 4.0] {
            let mut bar = Bar::new(&rubber).unwrap();
            for n in 1..=40 {
                bar.step(0.1, to.ln() * f64::from(n) / 40.0).unwrap();
            }
            let relaxed = rubber_of(network, &[]);
            let mut alone = Bar::new(&relaxed).unwrap();
            for n in 1..=40 {
                alone.step(0.1, to.ln() * f64::from(n) / 40.0).unwrap();
            }
            assert!(bar.stress.abs() > alone.stress.abs(), "{bulk} {to}");
            for _ in 0..40 {
                bar.step(1.0, to.ln()).unwrap();
            }
            // e⁻⁴⁰, and the search for the side.
            assert!((bar.stress / alone.stress - 1.0).abs() <= 1e-9, "{bulk} {to}");
        }
    }
    // Beyond the locking stretch there is a clear end, and the bar stays as it was.
    let exact = EightChain::new(1e6, 8.0, 1e8, ChainPull::Exact).unwrap();
    let rubber = rubber_of(exact, &[]);
    let mut bar = Bar::new(&rubber).unwrap();
    for n in 1..=60 {
        bar.step(0.1, 4.84f64.ln() * f64::from(n) / 60.0).unwrap();
    }
    let before = (bar.stress, bar.lateral);
    // At eight times the length even the volume would have to grow much.
    let refused = bar.step(0.1, 8.0f64.ln());
    assert!(
        matches!(refused, Err(SolidError::Constants(ElastomerError::Locked { .. }))),
        "{refused:?}"
    );
    assert_eq!((bar.stress, bar.lateral), before);
}

#[test]
fn steps_far_shorter_and_longer_than_relaxation() {
    for tau in [1e6, 1.0, 1e-6] {
        let rubber = rubber_of(network(64.7e6), &[Maxwell { gamma: 2.0, tau }]);
        let mut bar = Bar::new(&rubber).unwrap();
        for n in 1..=10 {
            bar.step(1.0, 1e-6 * f64::from(n)).unwrap();
        }
        // μ is a third of E but for the bulk modulus; H over the network's stress, at a constant rate.
        let ratio = 2.0 * tau / 10.0 * -(-10.0 / tau).exp_m1();
        let mu = rubber.network.shear_modulus() * (1.0 + ratio);
        let young = 9.0 * 64.7e6 * mu / (3.0 * 64.7e6 + mu);
        // The side's own rate follows the modulus as that relaxes: some 1 % of 1 − 2ν's 1 %.
        assert!((bar.stress / (1e-5 * young) - 1.0).abs() <= 1e-3, "{tau}: {}", bar.stress / 1e-5);
    }
}

/// A jump is answered with the instantaneous stiffness, and what follows is exact relaxation.
#[test]
fn a_sudden_motion_meets_the_instantaneous_stiffness() {
    let rubber = rubber_of(network(64.7e6), &[Maxwell { gamma: 2.0, tau: 0.5 }]);
    let jump = Profile::Ramp { from: 0.0, to: 1e-6, start: 0.2, duration: 0.0 };
    let (model, inner) = bonded(rubber.clone(), [4, 2, 1], jump);
    let mut solid = RubberSolid::new(&model, StepOptions::default()).unwrap();
    let mut forces = Vec::new();
    solid
        .advance(10.0, |solid| forces.push((solid.time(), solid.support_force(&inner)[2])))
        .unwrap();
    let unit = bonded(rubber, [4, 2, 1], Profile::Constant(1.0)).0;
    let stiffness = complex_stiffness(&unit, 0.0, &[0.0, 1e9], 1e-10).unwrap();
    let first = forces.iter().position(|(_, force)| *force > 0.0).unwrap();
    assert!((forces[first].0 - 0.2).abs() <= 1e-15);
    assert!((forces[first].1 / (1e-6 * stiffness[1].storage) - 1.0).abs() <= 1e-4);
    let last = forces.last().unwrap().1;
    assert!((last / (1e-6 * stiffness[0].storage) - 1.0).abs() <= 1e-4);
}

#[test]
fn ends_without_equilibrium_are_told() {
    let ramp = |to| Profile::Ramp { from: 0.0, to, start: 0.0, duration: 1.0 };
    // Pressed through itself.
    let model = pulled_cube(with_bulk(100.0), ramp(-0.02), 1);
    let mut solid = RubberSolid::new(&model, fixed(0.05)).unwrap();
    let ended = solid.advance(1.0, |_| {});
    let Err(SolidError::NoEquilibrium { time, failure, .. }) = ended else { panic!("{ended:?}") };
    // 12 mm of 20 mm are gone at 0.6 s.
    assert!(time > 0.3 && time < 0.6 && solid.time() == time, "{time} {failure}");
    assert!(!matches!(failure, StepFailure::Inaccurate));
    // The state that stands is that of the last step: it relaxes no further, rubber without Maxwell elements.
    let count = solid.counts.accepted;
    assert!(count >= 6 && solid.counts.undone > 10, "{:?}", solid.counts);
    // Free to move.
    let mesh = cube(1);
    let (elements, nodes) = (quadratic(&mesh), mesh.nodes);
    let material = with_bulk(100.0);
    let problem = RubberProblem { nodes, elements, material, prescribed: vec![], loads: vec![] };
    let free = RubberModel::new(problem).unwrap();
    let ended = complex_stiffness(&free, 0.0, &[0.0], 1e-6);
    assert!(matches!(ended, Err(SolidError::Free { .. })), "{ended:?}");
    for bad in [0.0, -1.0, f64::NAN] {
        for stepping in [Stepping::Fixed(bad), Stepping::Accuracy(bad)] {
            let refused = RubberSolid::new(&free, StepOptions { stepping, ..Default::default() });
            assert!(matches!(refused.map(|_| ()), Err(SolidError::Option { .. })));
        }
    }
}

/// The bushing of 3.3 pressed by 5 mm of its 8.35 mm in steps that are too long: factors made on the way to nowhere
/// must not spoil the shorter steps.
#[test]
fn a_step_that_failed_spoils_no_other() {
    let body = Bushing { inner_diameter: 0.0197, thickness: 0.00835, length: 0.06 };
    let cells = BushingMesh { around: 8, radial: 4, axial: 3, grading: 1.0, part: Part::Quarter };
    let mesh = bushing(&body, &cells).unwrap().quadratic().unwrap().mesh;
    let ramp = Profile::Ramp { from: 0.0, to: 5e-3, start: 0.0, duration: 5.0 };
    let prescribed = supports(
        &mesh,
        &[
            ("outer", [HELD; 3]),
            ("inner", [HELD, HELD, Some(ramp)]),
            ("x_low", [HELD, None, None]),
            ("y_low", [None, HELD, None]),
        ],
    );
    let (elements, nodes) = (quadratic(&mesh), mesh.nodes);
    let material = with_bulk(100.0);
    let problem = RubberProblem { nodes, elements, material, prescribed, loads: vec![] };
    let model = RubberModel::new(problem).unwrap();
    let mut solid = RubberSolid::new(&model, fixed(0.5)).unwrap();
    let mut kept = vec![solid.checkpoint()];
    solid.advance(4.0, |solid| kept.push(solid.checkpoint())).unwrap();
    assert!(solid.counts.undone > 0 && solid.counts.undone < 20, "{:?}", solid.counts);
    // The shorter step is that of a solid that has never tried the longer one.
    let mut cut = 0;
    for pair in kept.windows(2).filter(|pair| pair[1].counts.undone > pair[0].counts.undone) {
        let fresh =
            RubberCheckpoint { next: pair[1].state.last, factored: None, ..pair[0].clone() };
        let mut other = RubberSolid::new(&model, fixed(0.5)).unwrap();
        other.restore(&fresh).unwrap();
        other.advance(pair[1].state.time, |_| {}).unwrap();
        assert_eq!(*other.state(), pair[1].state, "{}", pair[0].state.time);
        cut += 1;
    }
    assert!(cut > 0);
}
