//! Solids of rubber: elements with a continuous mean stress, equilibrium step by step, small vibrations.

use super::rubber_bodies::{
    BUSHING, HELD, bonded, cube, fixed, network, pulled_cube, quadratic, quarter, rubber_of,
    scatter, static_stiffness, with_bulk,
};
use bearing_dynamics::ch2_housing::elastomer::maxwell::Maxwell;
use bearing_dynamics::ch2_housing::elastomer::{Elastomer, named};
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::elements::tet10::POINTS;
use bearing_dynamics::elements::tet10_nodal::{at_corners, strains};
use bearing_dynamics::kinematics::vec3::{Vec3, cross};
use bearing_dynamics::mesh::generate::bushing;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::error::SolidError;
use bearing_dynamics::solids::model::{DampedMotion, SolidModel, SolidProblem};
use bearing_dynamics::solids::rubber::bar::Bar;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::model::{Moment, RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::steps::RubberSolid;
use bearing_dynamics::solids::rubber::tangent::{StepLaw, Tangent, add_forces};
use bearing_dynamics::solids::tangent::PRESCRIBED;
use std::f64::consts::TAU;

/// A free cube of shaken elements, and displacements without pattern, small against a cell.
fn shaken(cells: usize) -> (RubberModel, Vec<Vec3>) {
    let mesh = cube(cells);
    let (elements, nodes) = (quadratic(&mesh), mesh.nodes);
    let material = rubber_of(network(64.7e6), &[]);
    let mut seed = 2;
    let moved = nodes.iter().map(|_| [0.0; 3].map(|_: f64| 3e-4 * scatter(&mut seed))).collect();
    let problem =
        RubberProblem { nodes, elements, material, prescribed: Vec::new(), loads: Vec::new() };
    (RubberModel::new(problem).unwrap(), moved)
}

fn energy(model: &RubberModel, moved: &[Vec3]) -> f64 {
    let network = &model.problem.material.network;
    let (mut chains, mut volumes) = (0.0, vec![0.0; model.patches.len()]);
    for (index, (tet, nodes)) in model.tets.iter().zip(&model.problem.elements).enumerate() {
        let (strains, changes, inverted) = strains(tet, &nodes.map(|n| moved[n as usize]));
        assert_eq!(inverted, None);
        for (point, strain) in tet.points.iter().zip(&strains) {
            chains += point.volume * network.isochoric_energy(strain).unwrap();
        }
        for (patch, sum) in model.patches_of[index].iter().zip(at_corners(tet, &changes)) {
            volumes[*patch as usize] += sum;
        }
    }
    let pairs = volumes.iter().zip(&model.patches);
    chains + pairs.map(|(v, p)| p.volume * network.volume_energy(v / p.volume)).sum::<f64>()
}

fn forces(model: &RubberModel, moved: &[Vec3]) -> Vec<Vec3> {
    let mut forces = vec![[0.0; 3]; moved.len()];
    let mut deviatoric = vec![[0.0; 6]; POINTS * model.tets.len()];
    let mut means = vec![0.0; model.patches.len()];
    add_forces(model, &StepLaw::RELAXED, moved, &mut forces, &mut deviatoric, &mut means).unwrap();
    forces
}

/// A change of one component.
fn changed(moved: &[Vec3], component: usize, by: f64) -> Vec<Vec3> {
    let mut moved = moved.to_vec();
    moved.as_flattened_mut()[component] += by;
    moved
}

#[test]
fn forces_are_the_derivative_of_the_energy_and_stiffness_that_of_forces() {
    let (model, moved) = shaken(2);
    let of = forces(&model, &moved);
    let scale = of.as_flattened().iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    let mut tangent = Tangent::new(&model);
    // So shaken a cube is not stable, but its stiffness is what it is.
    let refused = tangent.refresh(&model, &StepLaw::RELAXED, &moved, None);
    assert!(matches!(refused, Ok(()) | Err(SolidError::Factor(_))), "{refused:?}");
    let matrix = tangent.stiffness();
    let stiffest = (0..matrix.size())
        .flat_map(|column| matrix.column(column))
        .fold(0.0, |m: f64, (_, k)| m.max(k.abs()));
    let step = 1e-8;
    for component in (0..3 * moved.len()).step_by(7) {
        let at = |by: f64| changed(&moved, component, by);
        let slope = -(energy(&model, &at(step)) - energy(&model, &at(-step))) / (2.0 * step);
        let gap = (slope - of.as_flattened()[component]).abs();
        // Third derivatives times step² (1e-6 of a cell's)², and rounding of energies over 1e-6.
        assert!(gap <= 1e-6 * scale, "{component}: {gap:e} of {scale:e}");
        let [before, after] = [-step, step].map(|by| forces(&model, &at(by)));
        let unknown = |component: usize| model.unknowns.of[component / 3][component % 3];
        let mut exact = vec![0.0; model.unknowns.count];
        for row in 0..3 * moved.len() {
            let change = after.as_flattened()[row] - before.as_flattened()[row];
            exact[unknown(row)] = -change / (2.0 * step);
        }
        let mut unit = vec![0.0; exact.len()];
        unit[unknown(component)] = 1.0;
        let mut ours = unit.clone();
        matrix.multiply(&unit, &mut ours);
        for (row, (ours, exact)) in ours.iter().zip(&exact).enumerate() {
            let gap = (ours - exact).abs();
            assert!(gap <= 1e-7 * stiffest, "{row} {component}: {gap:e} of {stiffest:e}");
        }
    }
}

#[test]
fn a_body_neither_pushes_nor_turns_itself() {
    let (model, moved) = shaken(2);
    let of = forces(&model, &moved);
    let (mut sum, mut moment, mut scale) = ([0.0; 3], [0.0; 3], 0.0f64);
    for (n, force) in of.iter().enumerate() {
        let place = std::array::from_fn(|i| model.problem.nodes[n][i] + moved[n][i]);
        let turn = cross(place, *force);
        for i in 0..3 {
            sum[i] += force[i];
            moment[i] += turn[i];
            scale = scale.max(force[i].abs());
        }
    }
    for i in 0..3 {
        // Rounding of some hundred forces, at places up to 12 mm.
        assert!(
            sum[i].abs() <= 1e-12 * scale && moment[i].abs() <= 1e-14 * scale,
            "{sum:?} {moment:?}"
        );
    }
    // Turned as a whole and shifted, the rest stays without force.
    let turn = nalgebra::Rotation3::from_euler_angles(0.7, -1.1, 2.3);
    let rigid: Vec<Vec3> = model
        .problem
        .nodes
        .iter()
        .map(|x| {
            let turned = turn * nalgebra::Vector3::from(*x);
            std::array::from_fn(|i| turned[i] - x[i] + 0.003)
        })
        .collect();
    let left = forces(&model, &rigid);
    let worst = left.as_flattened().iter().fold(0.0, |m: f64, f| m.max(f.abs()));
    // Rounding of gradients of up to 2, over faces of 6 mm.
    assert!(worst <= 1e-12 * 64.7e6 * 0.006 * 0.006, "{worst:e}");
}

/// Uniform large strain on the outside of a shaken mesh is uniform inside.
#[test]
fn patch_of_large_strain() {
    const GRADIENT: [Vec3; 3] = [[0.2, 0.1, -0.05], [0.15, -0.2, 0.05], [0.0, 0.1, 0.1]];
    let field = |x: Vec3| GRADIENT.map(|row| row[0] * x[0] + row[1] * x[1] + row[2] * x[2]);
    let mut mesh = cube(3);
    let outside = (0..mesh.nodes.len() as u32)
        .filter(|n| mesh.nodes[*n as usize].iter().any(|x| *x < 1e-9 || *x > 0.012 - 1e-9));
    let outside: Vec<u32> = outside.collect();
    let mut prescribed = Vec::new();
    for node in outside {
        mesh.node_sets.insert("one".into(), vec![node]);
        let moved = field(mesh.nodes[node as usize]);
        let ramp = |to| Some(Profile::Ramp { from: 0.0, to, start: 0.0, duration: 1.0 });
        prescribed.extend(supports(&mesh, &[("one", moved.map(ramp))]));
    }
    let elements = quadratic(&mesh);
    let material = rubber_of(network(64.7e6), &[Maxwell { gamma: 1.0, tau: 0.5 }]);
    let nodes = mesh.nodes.clone();
    let model =
        RubberModel::new(RubberProblem { nodes, elements, material, prescribed, loads: vec![] })
            .unwrap();
    let mut solid = RubberSolid::new(&model, fixed(0.25)).unwrap();
    solid.advance(1.0, |_| {}).unwrap();
    for (u, x) in solid.displacement().iter().zip(&mesh.nodes) {
        for (u, exact) in u.iter().zip(field(*x)) {
            // What the tolerance of equilibrium, 1e-9, leaves of 12 mm.
            assert!((u - exact).abs() <= 1e-9 * 0.012, "{u} {exact}");
        }
    }
}

/// Load and unload at a constant true strain rate: the cube does what one point does.
#[test]
fn a_cube_is_a_bar() {
    let material = Elastomer { maxwell: named::table_3_1().maxwell, ..named::table_2_3() };
    let (rate, steps, dt) = (0.01, 10, 3.0);
    let strain = |n: usize| {
        let up = n.min(2 * steps - n.min(2 * steps)) as f64;
        -rate * dt * up
    };
    let points = (0..=2 * steps).map(|n| [dt * n as f64, 0.012 * strain(n).exp_m1()]).collect();
    let model = pulled_cube(material.clone(), Profile::Table { points }, 2);
    let end: Vec<u32> = (0..model.problem.nodes.len() as u32)
        .filter(|n| model.problem.nodes[*n as usize][0] > 0.012 - 1e-9)
        .collect();
    let mut solid = RubberSolid::new(&model, fixed(dt)).unwrap();
    let mut bar = Bar::new(&material).unwrap();
    for n in 1..=2 * steps {
        solid.advance(dt * n as f64, |_| {}).unwrap();
        bar.step(dt, strain(n)).unwrap();
        let side = 0.012 * (1.0 + bar.lateral);
        let stress = solid.support_force(&end)[0] / (side * side);
        // Equilibrium of the cube is good to 1e-9 of its forces.
        assert!((stress - bar.stress).abs() <= 1e-6 * 0.36e6, "{n}: {stress} {}", bar.stress);
    }
    assert!(bar.stress > 1e4 && (bar.time - 60.0).abs() <= 1e-9);
}

/// As volume is held ever harder, the bushing tends to the incompressible one, 4 % stiffer; four-node elements do
/// not.
#[test]
fn a_continuous_mean_stress_does_not_lock() {
    let cells = [12, 4, 3];
    let stiffness: Vec<f64> =
        [10.0, 1e2, 1e3, 1e4, 1e5].map(|bulk| static_stiffness(with_bulk(bulk), cells)).to_vec();
    assert!(stiffness.windows(2).all(|w| w[1] > w[0]), "{stiffness:?}");
    let [hundred, most] = [stiffness[1], stiffness[4]];
    assert!(most / hundred <= 1.06 && most / stiffness[3] <= 1.001, "{stiffness:?}");
    let mut locked = Vec::new();
    for bulk in [1e2, 1e4] {
        let network = with_bulk(bulk).network;
        let (mu, b) = (network.shear_modulus(), network.bulk);
        let steel = LinearElastic { lambda: b - 2.0 / 3.0 * mu, shear_modulus: mu };
        let mesh = bushing(&BUSHING, &quarter(cells)).unwrap().mesh;
        let by = 1e-6;
        let prescribed = supports(
            &mesh,
            &[
                ("outer", [HELD; 3]),
                ("inner", [HELD, HELD, Some(Profile::Constant(by))]),
                ("x_low", [HELD, None, None]),
                ("y_low", [None, HELD, None]),
            ],
        );
        let problem = SolidProblem {
            nodes: mesh.nodes.clone(),
            elements: mesh.elements.clone(),
            material: steel,
            density: 1100.0,
            damping: 0.0,
            damped_motion: DampedMotion::Absolute,
            prescribed,
            loads: Vec::new(),
            gravity: [0.0; 3],
        };
        let model = SolidModel::new(problem).unwrap();
        let found = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap();
        let inner = &mesh.node_sets["inner"];
        let force: f64 = inner.iter().map(|n| found.reactions[*n as usize][2]).sum();
        locked.push(4.0 * force / by);
    }
    // Nearly twice as stiff at the bulk modulus of the source on a mesh this fine, and without a bound.
    assert!(locked[0] > 1.8 * hundred && locked[1] > 20.0 * locked[0], "{locked:?} {hundred}");
}

/// Against the complex system itself, from differences of forces, solved as a dense one.
#[test]
fn one_factorisation_serves_all_frequencies() {
    let rubber = named::table_3_1();
    let (model, _) = bonded(rubber.clone(), [4, 2, 1], Profile::Constant(1.0));
    let count = model.unknowns.count;
    let nodes = model.problem.nodes.len();
    let mut sleeve = vec![[0.0; 3]; nodes];
    model.prescribe(Moment::at(0.0), &mut sleeve);
    // Unknowns first, then one for the sleeve.
    let mut motions = vec![vec![[0.0; 3]; nodes]; count];
    for (node, of) in model.unknowns.of.iter().enumerate() {
        for axis in (0..3).filter(|axis| of[*axis] != PRESCRIBED) {
            motions[of[axis]][node][axis] = 1.0;
        }
    }
    motions.push(sleeve);
    let dense = |gain: f64| {
        let law = StepLaw { gain, carried: &[], inertia: 0.0 };
        let mut deviatoric = vec![[0.0; 6]; POINTS * model.tets.len()];
        let mut means = vec![0.0; model.patches.len()];
        let mut forces = |motion: &[Vec3], by: f64| {
            let moved: Vec<Vec3> = motion.iter().map(|u| u.map(|x| by * x)).collect();
            let mut forces = vec![[0.0; 3]; nodes];
            add_forces(&model, &law, &moved, &mut forces, &mut deviatoric, &mut means).unwrap();
            forces
        };
        let mut whole = nalgebra::DMatrix::<f64>::zeros(count + 1, count + 1);
        for column in 0..=count {
            // Central differences of forces that keep their digits: (1e-9 of 10 mm)².
            let [before, after] = [-1e-9, 1e-9].map(|by| forces(&motions[column], by));
            for row in 0..=count {
                let sum: f64 = motions[row]
                    .as_flattened()
                    .iter()
                    .zip(after.as_flattened().iter().zip(before.as_flattened()))
                    .map(|(u, (a, b))| u * (a - b))
                    .sum();
                whole[(row, column)] = -sum / 2e-9;
            }
        }
        whole
    };
    let (one, two) = (dense(0.0), dense(1.0));
    let pulsations = [0.0, TAU * 0.1, TAU * 10.0, TAU * 1e4, 1e12];
    let answers = complex_stiffness(&model, 0.0, &pulsations, 1e-9).unwrap();
    for (pulsation, answer) in pulsations.iter().zip(answers) {
        let g = rubber.maxwell.iter().fold(nalgebra::Complex::new(1.0, 0.0), |sum, m| {
            let x = nalgebra::Complex::new(0.0, pulsation * m.tau);
            sum + m.gamma * (x / (1.0 + x))
        });
        // V + g D, of 1 · D + V and 2 · D + V.
        let whole = nalgebra::DMatrix::from_fn(count + 1, count + 1, |i, j| {
            let shear = two[(i, j)] - one[(i, j)];
            g * shear + (one[(i, j)] - shear)
        });
        let inner = whole.view((0, 0), (count, count)).into_owned();
        let coupled = whole.view((0, count), (count, 1)).into_owned();
        let along = inner.lu().solve(&coupled).unwrap();
        let relieved: nalgebra::Complex<f64> =
            coupled.iter().zip(along.iter()).map(|(a, b)| a * b).sum();
        let exact = whole[(count, count)] - relieved;
        let gap =
            (exact - nalgebra::Complex::new(answer.storage, answer.loss)).norm() / exact.norm();
        assert!(gap <= 1e-8, "{pulsation}: {gap:e} {exact} {answer:?}");
    }
}
