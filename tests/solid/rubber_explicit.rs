//! Rubber in explicit steps: four-node elements with the mean stress of their own volume or averaged around nodes.

use bearing_dynamics::ch2_housing::elastomer::Elastomer;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::five_terms::{FiveTerms, inverse_cube_root};
use bearing_dynamics::ch2_housing::elastomer::maxwell::{
    Maxwell, StepFactors, alternating_factor, commit,
};
use bearing_dynamics::elements::tet4::{Tet4, relative};
use bearing_dynamics::elements::tet4_nodal::{nodal_forces, volume_change_at_nodes};
use bearing_dynamics::kinematics::strain::{Sym3, green_lagrange, volume_change};
use bearing_dynamics::kinematics::vec3::{Vec3, cross};
use bearing_dynamics::mesh::Elements;
use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::explicit::{ExplicitSolid, SolidStepping, padded};
use bearing_dynamics::solids::model::Prescribed;
use bearing_dynamics::solids::rubber::explicit::RubberBody;
use bearing_dynamics::solids::rubber::tangent::{StepLaw, add_forces};
use bearing_dynamics::solids::rubber::tet_forces::{History, MeanStress};

const BOTH: [MeanStress; 2] = [MeanStress::OfElement, MeanStress::AroundNodes];
const SIDE: f64 = 0.012;

/// Numbers without pattern in (−1, 1).
fn scatter(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
    (*seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

fn network(pull: ChainPull) -> EightChain {
    EightChain::new(0.647e6, 8.0, 64.7e6, pull).unwrap()
}

/// A free cube of 12 mm with its corners inside shaken.
fn cube(cells: usize, maxwell: &[[f64; 2]], mean_stress: MeanStress) -> RubberBody {
    let mesh = bar([SIDE; 3], [cells; 3]).unwrap().mesh;
    let mut nodes = mesh.nodes;
    let mut seed = 9;
    for place in &mut nodes {
        let inside = place[0] > 1e-9
            && place[0] < SIDE - 1e-9
            && place[1..].iter().all(|x| x.abs() < 0.5 * SIDE - 1e-9);
        for x in place.iter_mut() {
            let by = 0.2 * SIDE / cells as f64 * scatter(&mut seed);
            *x += if inside { by } else { 0.0 };
        }
    }
    let Elements::Linear(elements) = mesh.elements else { panic!("of four nodes") };
    let maxwell = maxwell.iter().map(|[gamma, tau]| Maxwell { gamma: *gamma, tau: *tau }).collect();
    RubberBody {
        nodes,
        elements,
        material: Elastomer { network: network(ChainPull::FiveTerms), maxwell },
        density: 1100.0,
        mean_stress,
        mass_scale: 1.0,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    }
}

fn shaken(body: &RubberBody, by: f64) -> Vec<Vec3> {
    let mut seed = 2;
    body.nodes.iter().map(|_| [0.0; 3].map(|_: f64| by * scatter(&mut seed))).collect()
}

/// Forces of the network on the nodes.
fn relaxed_forces(body: &RubberBody, moved: &[Vec3]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 4]; moved.len()];
    let moved = padded(moved.to_vec());
    body.forces().unwrap().add_forces(&moved, &mut forces, History::Scaled(1.0));
    forces.iter().map(|f| [f[0], f[1], f[2]]).collect()
}

fn largest(forces: &[Vec3]) -> f64 {
    forces.as_flattened().iter().fold(0.0, |m: f64, f| m.max(f.abs()))
}

#[test]
fn the_law_without_branches_is_the_law() {
    let mut seed = 5;
    for x in [1e-3, 0.02, 0.5, 0.999, 1.0, 1.001, 7.0, 1e5] {
        let y = inverse_cube_root(x);
        // Newton's last step leaves rounding alone.
        assert!((y * y * y * x - 1.0).abs() <= 2e-15, "{x}: {y}");
    }
    let network = network(ChainPull::FiveTerms);
    let terms = FiveTerms::of(&network).unwrap();
    assert_eq!(FiveTerms::of(&self::network(ChainPull::Exact)), None);
    for size in [1e-12, 1e-6, 1e-2, 0.1, 0.3] {
        for _ in 0..20 {
            let h = [0; 3].map(|_| [0; 3].map(|_| size * scatter(&mut seed)));
            if volume_change(&h) < -0.9 {
                continue;
            }
            let e = green_lagrange(&h);
            let (ours, exact) = (terms.isochoric_stress(&e), network.isochoric_stress(&e).unwrap());
            let scale = exact.iter().fold(0.0, |m: f64, s| m.max(s.abs()));
            for i in 0..6 {
                // Some thirty roundings; determinants of far deformed cubes lose a digit.
                assert!((ours[i] - exact[i]).abs() <= 4e-14 * scale, "{size}: {ours:?} {exact:?}");
            }
        }
    }
}

#[test]
fn forces_are_the_derivative_of_the_energy() {
    for mean_stress in BOTH {
        let body = cube(2, &[], mean_stress);
        let moved = shaken(&body, 3e-4);
        let of = relaxed_forces(&body, &moved);
        let scale = largest(&of);
        let rubber = body.forces().unwrap();
        let step = 1e-8;
        for component in (0..3 * moved.len()).step_by(5) {
            let at = |by: f64| {
                let mut moved = moved.clone();
                moved.as_flattened_mut()[component] += by;
                rubber.network_energy(&padded(moved))
            };
            let slope = -(at(step) - at(-step)) / (2.0 * step);
            let gap = (slope - of.as_flattened()[component]).abs();
            // Third derivatives times step² (1e-6 of a cell's)², and rounding of energies over 1e-6.
            assert!(gap <= 1e-6 * scale, "{mean_stress:?} {component}: {gap:e} of {scale:e}");
        }
    }
}

#[test]
fn a_body_neither_pushes_nor_turns_itself_and_rests_where_it_is_not_strained() {
    for mean_stress in BOTH {
        let body = cube(2, &[], mean_stress);
        let moved = shaken(&body, 3e-4);
        let of = relaxed_forces(&body, &moved);
        let (mut sum, mut moment) = ([0.0; 3], [0.0; 3]);
        for ((x, u), force) in body.nodes.iter().zip(&moved).zip(&of) {
            let turn = cross([x[0] + u[0], x[1] + u[1], x[2] + u[2]], *force);
            for i in 0..3 {
                sum[i] += force[i];
                moment[i] += turn[i];
            }
        }
        let scale = largest(&of);
        for i in 0..3 {
            // Rounding of some hundred forces, at places up to 12 mm.
            assert!(sum[i].abs() <= 1e-12 * scale && moment[i].abs() <= 1e-14 * scale);
        }
        assert_eq!(largest(&relaxed_forces(&body, &shaken(&body, 0.0))), 0.0);
        let turn = nalgebra::Rotation3::from_euler_angles(0.7, -1.1, 2.3);
        let turned = |u: &[Vec3]| -> Vec<Vec3> {
            let places = body.nodes.iter().zip(u);
            places
                .map(|(x, u)| {
                    let place = nalgebra::Vector3::from([0, 1, 2].map(|i: usize| x[i] + u[i]));
                    let turned = turn * place;
                    [0, 1, 2].map(|i: usize| turned[i] - x[i] + 0.003)
                })
                .collect()
        };
        let left = largest(&relaxed_forces(&body, &turned(&shaken(&body, 0.0))));
        // Rounding of gradients of up to 2, over faces of 6 mm.
        assert!(left <= 1e-12 * 64.7e6 * 0.006 * 0.006, "{left:e}");
        // Objectivity: the forces of a turned deformation are the turned forces.
        for (ours, before) in relaxed_forces(&body, &turned(&moved)).iter().zip(&of) {
            let exact = turn * nalgebra::Vector3::from(*before);
            for i in 0..3 {
                assert!((ours[i] - exact[i]).abs() <= 1e-11 * scale, "{ours:?} {exact:?}");
            }
        }
    }
}

#[test]
fn a_deformation_alike_everywhere_leaves_inner_nodes_without_force() {
    let h = [[0.2, 0.3, -0.1], [0.05, -0.15, 0.2], [0.1, -0.2, 0.1]];
    for mean_stress in BOTH {
        let body = cube(3, &[], mean_stress);
        let moved: Vec<Vec3> = body
            .nodes
            .iter()
            .map(|x| h.map(|row: Vec3| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]))
            .collect();
        let of = relaxed_forces(&body, &moved);
        let scale = largest(&of);
        let mut inner = 0;
        for (x, force) in body.nodes.iter().zip(&of) {
            let inside = x[0] > 1e-9
                && x[0] < SIDE - 1e-9
                && x[1..].iter().all(|x| x.abs() < 0.5 * SIDE - 1e-9);
            inner += usize::from(inside);
            // Rounding of some twenty elements.
            assert!(!inside || force.iter().all(|f| f.abs() <= 1e-12 * scale), "{force:?}");
        }
        assert_eq!(inner, 8);
    }
}

/// The implicit elements are those of ten nodes with six that do nothing: another code for the same.
#[test]
fn explicit_and_implicit_elements_have_the_same_forces() {
    for mean_stress in BOTH {
        let body = cube(3, &[], mean_stress);
        let moved = shaken(&body, 2e-4);
        let ours = relaxed_forces(&body, &moved);
        let model = body.implicit().unwrap();
        let mut forces = vec![[0.0; 3]; moved.len()];
        let mut deviatoric = vec![[0.0; 6]; 4 * model.tets.len()];
        let mut means = vec![0.0; model.patches.len()];
        add_forces(&model, &StepLaw::RELAXED, &moved, &mut forces, &mut deviatoric, &mut means)
            .unwrap();
        let scale = largest(&ours);
        for (ours, theirs) in ours.as_flattened().iter().zip(forces.as_flattened()) {
            assert!((ours - theirs).abs() <= 1e-12 * scale, "{ours} {theirs}");
        }
    }
}

/// One element driven along a path in step with the scalar recursion; what is looked at in between leaves no trace.
#[test]
fn history_is_committed_once_a_step() {
    let terms = [[2.0, 3e-5], [0.5, 1e-3], [3.0, 2e-6], [1.0, 3e-5]];
    for (mean_stress, pull) in BOTH.into_iter().zip([ChainPull::FiveTerms, ChainPull::Exact]) {
        let mut body = cube(1, &terms, mean_stress);
        body.material.network = network(pull);
        body.nodes = vec![[0.0; 3], [0.01, 0.0, 0.0], [0.0, 0.01, 0.0], [0.002, 0.001, 0.01]];
        body.elements = vec![[0, 1, 2, 3]];
        let end = [[0.0; 3], [1e-3, 2e-3, 0.0], [-2e-3, 5e-4, 1e-3], [0.0, -1e-3, 2e-3]];
        let course = |node: usize, axis: usize| Profile::Ramp {
            from: 0.0,
            to: end[node][axis],
            start: 0.0,
            duration: 4e-5,
        };
        body.prescribed = (0..12)
            .map(|k| Prescribed { node: k as u32 / 3, axis: k % 3, profile: course(k / 3, k % 3) })
            .collect();
        let still = vec![[0.0; 3]; 4];
        let step = 4e-7;
        let new = || {
            let stepping = SolidStepping::Fixed(step);
            ExplicitSolid::of_rubber(&body, stepping, still.clone(), still.clone()).unwrap().0
        };
        let (mut looked_at, mut left_alone) = (new(), new());
        let tet = Tet4::new(&[0, 1, 2, 3].map(|n: usize| body.nodes[n])).unwrap();
        let factors = StepFactors::of(&body.material.maxwell, step).unwrap();
        let mut history = vec![[0.0; 6]; terms.len()];
        let mut before: Sym3 = [0.0; 6];
        for count in 0..150 {
            // The state whose forces the next step evaluates and commits.
            let u = looked_at.displacement.clone();
            let h = tet.displacement_gradient(&relative(
                &[0, 1, 2, 3].map(|n: usize| [u[n][0], u[n][1], u[n][2]]),
            ));
            let own = body.material.network.isochoric_stress(&green_lagrange(&h)).unwrap();
            commit(&mut history, &std::array::from_fn(|i| own[i] - before[i]), &factors);
            before = own;
            let total = std::array::from_fn(|i| own[i] + history.iter().map(|h| h[i]).sum::<f64>());
            // Of one element all averages are its own.
            let mean = body.material.network.mean_stress(volume_change(&h));
            let exact = nodal_forces(&tet, &h, &total, mean);
            let share = volume_change_at_nodes(&tet, &h);
            assert!((share - 0.25 * tet.volume * volume_change(&h)).abs() <= 1e-15 * tet.volume);
            looked_at.ledger();
            looked_at.velocity();
            for solid in [&mut looked_at, &mut left_alone] {
                solid.step(|_, _, _| {}).unwrap();
            }
            let scale = largest(&exact).max(1e-9);
            for (ours, exact) in looked_at.forces().iter().zip(exact) {
                for (ours, exact) in ours.iter().zip(exact) {
                    let gap = (ours - exact).abs();
                    // Rounding, of stresses up to some hundred times those at small strain.
                    assert!(gap <= 1e-12 * scale, "step {count}: {gap:e} of {scale:e}");
                }
            }
            assert_eq!(looked_at.forces(), left_alone.forces());
        }
    }
}

/// A cube that starts to move with a given field.
fn thrown(body: &RubberBody, speed: f64, stepping: SolidStepping) -> ExplicitSolid {
    let still = vec![[0.0; 3]; body.nodes.len()];
    let along = |x: &Vec3| {
        [speed * (300.0 * x[1]).sin(), speed * (200.0 * x[0]).cos(), -speed * (250.0 * x[0]).sin()]
    };
    let rates = body.nodes.iter().map(along).collect();
    ExplicitSolid::of_rubber(body, stepping, still, rates).unwrap().0
}

#[test]
fn without_maxwell_elements_energy_is_kept_to_second_order() {
    for mean_stress in BOTH {
        let body = cube(3, &[], mean_stress);
        let drift = |fraction: f64, steps: usize| {
            let mut solid = thrown(&body, 3.0, SolidStepping::FractionOfLimit(fraction));
            let start = solid.ledger().balance();
            let mut worst = 0.0f64;
            let mut strain = 0.0f64;
            for _ in 0..steps {
                solid.step(|_, _, _| {}).unwrap();
                let ledger = solid.ledger();
                worst = worst.max((ledger.balance() - start).abs() / start);
                strain = strain.max(ledger.energy.strain / start);
            }
            // It does deform: otherwise there is nothing to see.
            assert!(strain > 0.1, "{strain}");
            worst
        };
        let (coarse, fine) = (drift(0.4, 200), drift(0.2, 400));
        // Order two: a quarter. The method keeps a neighbouring energy; there is no drift on top.
        assert!(coarse <= 3e-3 && fine <= 0.35 * coarse, "{mean_stress:?}: {coarse:e} {fine:e}");
    }
}

#[test]
fn momentum_stays_and_maxwell_elements_take_energy() {
    for mean_stress in BOTH {
        let body = cube(3, &[[5.0, 1e-4], [3.0, 1e-5]], mean_stress);
        let mut solid = thrown(&body, 1.0, SolidStepping::FractionOfLimit(0.8));
        let momentum = |solid: &mut ExplicitSolid| {
            let rates = solid.velocity();
            let mut sum = [0.0; 6];
            for (n, v) in rates.iter().enumerate() {
                let (x, u) = (body.nodes[n], solid.displacement[n]);
                let turn = cross([x[0] + u[0], x[1] + u[1], x[2] + u[2]], *v);
                for i in 0..3 {
                    sum[i] += solid.model.mass[n] * v[i];
                    sum[3 + i] += solid.model.mass[n] * turn[i];
                }
            }
            sum
        };
        let (start, energy) = (momentum(&mut solid), solid.ledger().balance());
        for _ in 0..800 {
            solid.step(|_, _, _| {}).unwrap();
        }
        let (end, left) = (momentum(&mut solid), solid.ledger().balance());
        let mass: f64 = solid.model.mass.iter().sum();
        for i in 0..3 {
            assert!((end[i] - start[i]).abs() <= 1e-12 * mass, "{start:?} {end:?}");
            // Angular momentum at half steps is kept; that of `velocity` strays by the step's second order.
            assert!((end[3 + i] - start[3 + i]).abs() <= 1e-3 * mass * SIDE, "{start:?} {end:?}");
        }
        assert!(left < 0.9 * energy, "{left} of {energy}");
    }
}

/// The limit is where the motion begins to grow, with relaxation times around the step too.
#[test]
fn beyond_the_step_limit_the_motion_grows() {
    for mean_stress in BOTH {
        for terms in [vec![], vec![[8.0, 1e-7], [4.0, 1e-6], [2.0, 1e-5], [1.0, 1e-3]]] {
            let body = cube(2, &terms, mean_stress);
            let still = vec![[0.0; 3]; body.nodes.len()];
            let stepping = SolidStepping::FractionOfLimit(1.0);
            let (_, found) =
                ExplicitSolid::of_rubber(&body, stepping, still.clone(), still.clone()).unwrap();
            assert!(!found.limit.is_bound);
            let maxwell = &body.material.maxwell;
            let settled = alternating_factor(maxwell, found.limit.step);
            assert!(found.stiffening >= settled && found.stiffening <= 1.011 * settled);
            let refused = ExplicitSolid::of_rubber(
                &body,
                SolidStepping::Fixed(1.001 * found.limit.step),
                still.clone(),
                still,
            );
            let Err(SolidError::Step { .. }) = refused else { panic!("a step beyond the limit") };
            let grown = |fraction: f64| {
                let mut solid = thrown(&body, 1e-9, stepping);
                solid.step_size = fraction * found.limit.step;
                for _ in 0..1500 {
                    if solid.step(|_, _, _| {}).is_err() {
                        return f64::INFINITY;
                    }
                }
                let u = solid.displacement.iter().flatten();
                u.fold(0.0, |m: f64, u| m.max(u.abs())) / solid.time
            };
            let (below, above) = (grown(0.99), grown(1.02));
            // A drift at the speed it starts with, against growth by 20 % a step.
            assert!(
                below <= 1e-8 && above >= 1e-3,
                "{mean_stress:?} {terms:?}: {below:e} {above:e}"
            );
        }
    }
}

#[test]
fn mass_scaling_lengthens_the_step_and_keeps_the_weight() {
    let mut body = cube(2, &[], MeanStress::AroundNodes);
    body.gravity = [0.0, 0.0, -9.81];
    let still = vec![[0.0; 3]; body.nodes.len()];
    let limit = |body: &RubberBody| {
        let stepping = SolidStepping::FractionOfLimit(0.5);
        ExplicitSolid::of_rubber(body, stepping, still.clone(), still.clone()).unwrap()
    };
    let (_, own) = limit(&body);
    body.mass_scale = 400.0;
    let (mut solid, scaled) = limit(&body);
    assert_eq!(scaled.mass_scale, 400.0);
    let ratio = scaled.limit.step / own.limit.step;
    // The iterations' 1e-5 each.
    assert!((ratio - 20.0).abs() <= 1e-3, "{ratio}");
    solid.step(|_, _, _| {}).unwrap();
    let weight: f64 = solid.forces().iter().map(|f| f[2]).sum();
    let exact = -9.81 * 1100.0 * SIDE * SIDE * SIDE;
    assert!((weight - exact).abs() <= 1e-12 * exact.abs(), "{weight} {exact}");
    body.mass_scale = 0.0;
    assert!(matches!(body.model(), Err(SolidError::Option { what: "mass scale", .. })));
}

#[test]
fn a_run_goes_on_from_a_checkpoint_with_the_same_bits() {
    let body = cube(3, &[[5.0, 1e-4], [3.0, 1e-5]], MeanStress::AroundNodes);
    let mut solid = thrown(&body, 1.0, SolidStepping::FractionOfLimit(0.8));
    let run = |solid: &mut ExplicitSolid| {
        for _ in 0..40 {
            solid.step(|_, _, _| {}).unwrap();
        }
    };
    run(&mut solid);
    let kept = solid.checkpoint();
    run(&mut solid);
    let mut again = thrown(&body, 1.0, SolidStepping::FractionOfLimit(0.8));
    again.restore(&kept);
    run(&mut again);
    assert_eq!(solid.displacement, again.displacement);
    assert_eq!(solid.checkpoint(), again.checkpoint());
}

#[test]
fn what_rubber_cannot_bear_is_named() {
    for mean_stress in BOTH {
        let mut body = cube(2, &[], mean_stress);
        let still = vec![[0.0; 3]; body.nodes.len()];
        let pushed = |body: &RubberBody, by: f64| {
            let mut body = body.clone();
            let ends = body.nodes.iter().enumerate();
            body.prescribed = ends
                .filter(|(_, x)| x[0] < 1e-9 || x[0] > SIDE - 1e-9)
                .map(|(node, x)| {
                    let to = if x[0] < 1e-9 { 0.0 } else { by };
                    let profile = Profile::Ramp { from: 0.0, to, start: 0.0, duration: 1e-5 };
                    Prescribed { node: node as u32, axis: 0, profile }
                })
                .collect();
            let stepping = SolidStepping::FractionOfLimit(0.5);
            let mut solid =
                ExplicitSolid::of_rubber(&body, stepping, still.clone(), still.clone()).unwrap().0;
            (0..20_000).find_map(|_| solid.step(|_, _, _| {}).err())
        };
        let failure = pushed(&body, -1.2 * SIDE);
        let Some(SolidError::Inverted { ratio, .. }) = failure else { panic!("{failure:?}") };
        assert!(ratio <= 0.0);
        body.material.network = EightChain::new(0.647e6, 1.2, 64.7e6, ChainPull::Exact).unwrap();
        let failure = pushed(&body, 2.0 * SIDE);
        let Some(SolidError::Material { .. }) = failure else { panic!("{failure:?}") };
    }
}

/// The recursion itself, under a strain that changes its sign with every step until it only repeats itself.
#[test]
fn the_factor_of_an_alternating_strain_is_that_of_the_recursion() {
    let elements = [(0.4, 1e-3), (0.7, 2e-4)].map(|(gamma, tau)| Maxwell { gamma, tau });
    for dt in [1e-5, 3e-4, 1e-3] {
        let mut factors = StepFactors::default();
        factors.set(&elements, dt).unwrap();
        let mut history = vec![[0.0; 6]; elements.len()];
        let mut sign = 1.0;
        for _ in 0..4000 {
            sign = -sign;
            commit(&mut history, &[2.0 * sign, 0.0, 0.0, 0.0, 0.0, 0.0], &factors);
        }
        let found = 1.0 + history.iter().map(|part| part[0] / sign).sum::<f64>();
        let expected = alternating_factor(&elements, dt);
        assert!((found / expected - 1.0).abs() <= 1e-12, "{dt}: {found} {expected}");
    }
}
