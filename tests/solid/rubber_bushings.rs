//! Bushings of rubber: how they stiffen at large displacements, and their four motions.

use super::rubber_bodies::{BUSHING, HELD, bonded, quadratic, static_stiffness, with_bulk};
use bearing_dynamics::ch2_housing::elastomer::eight_chain::{ChainPull, EightChain};
use bearing_dynamics::ch2_housing::elastomer::named;
use bearing_dynamics::kinematics::vec3::{Vec3, add, add_scaled, dot, scale};
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::mesh::generate::{Bushing, BushingMesh, Part, bushing};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::model::Prescribed;
use bearing_dynamics::solids::rubber::harmonic::complex_stiffness;
use bearing_dynamics::solids::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::relaxed::relaxed;
use bearing_dynamics::solids::rubber::sleeve::{SleeveMotion, sleeve_stiffness};
use std::f64::consts::TAU;

/// Ten-node elements of a whole bushing.
fn whole(body: &Bushing, [around, radial, axial]: [usize; 3]) -> TetMesh {
    let mesh = BushingMesh { around, radial, axial, grading: 1.0, part: Part::Whole };
    bushing(body, &mesh).unwrap().quadratic().unwrap().mesh
}

/// Displacement of a place (m) by so much of a motion, m or rad.
fn displacement_by(motion: SleeveMotion, amount: f64, place: Vec3) -> Vec3 {
    let once = motion.displacement(place);
    match motion {
        SleeveMotion::Radial | SleeveMotion::Axial => scale(once, amount),
        // R r − r about an axis n: sin a (n × r) + (1 − cos a) n × (n × r).
        SleeveMotion::Torsional | SleeveMotion::Conical => {
            let half = (0.5 * amount).sin();
            add_scaled(scale(motion.displacement(once), 2.0 * half * half), amount.sin(), once)
        }
    }
}

/// Relaxed force or moment over the motion of the inner sleeve, N/m or N·m/rad.
fn secant(mesh: &TetMesh, motion: SleeveMotion, amount: f64) -> f64 {
    let inner = &mesh.node_sets["inner"];
    let mut prescribed = supports(mesh, &[("outer", [HELD; 3])]);
    for &node in inner {
        let by = displacement_by(motion, amount, mesh.nodes[node as usize]);
        let of = |axis: usize| Prescribed { node, axis, profile: Profile::Constant(by[axis]) };
        prescribed.extend([0, 1, 2].map(of));
    }
    let (nodes, elements) = (mesh.nodes.clone(), quadratic(mesh));
    let material = with_bulk(100.0);
    let problem = RubberProblem { nodes, elements, material, prescribed, loads: vec![] };
    let found = relaxed(&RubberModel::new(problem).unwrap(), 0.0).unwrap();
    let pushes = inner.iter().map(|&node| {
        let node = node as usize;
        let place = add(mesh.nodes[node], found.state.displacement[node]);
        dot(found.reactions[node], motion.displacement(place))
    });
    pushes.sum::<f64>() / amount
}

/// What a unit of the motion moves the sleeve by where it goes farthest.
fn lever(motion: SleeveMotion, body: &Bushing) -> f64 {
    match motion {
        SleeveMotion::Radial | SleeveMotion::Axial => 1.0,
        SleeveMotion::Torsional => 0.5 * body.inner_diameter,
        SleeveMotion::Conical => 0.5 * body.inner_diameter.hypot(body.length),
    }
}

/// By how much the stiffness at this share of the wall is above that of small amplitudes.
fn stiffer(body: &Bushing, mesh: &TetMesh, motion: SleeveMotion, share: f64) -> f64 {
    let amount = |share: f64| share * body.thickness / lever(motion, body);
    secant(mesh, motion, amount(share)) / secant(mesh, motion, amount(1e-3)) - 1.0
}

/// The bushing of 3.3: at 1 mm across relaxed rubber pushes back by 1.57 % more than in proportion, by implicit steps on a
/// fine mesh (4345 against 4278 N 14 s after a ramp). The difference grows with the square of the amplitude.
#[test]
fn a_pushed_bushing_stiffens_as_steps_say() {
    let body = Bushing { inner_diameter: 0.0197, thickness: 0.00835, length: 0.06 };
    let mesh = whole(&body, [12, 2, 4]);
    let at = |amount: f64| stiffer(&body, &mesh, SleeveMotion::Radial, amount / body.thickness);
    let [half, full] = [at(0.5e-3), at(1e-3)];
    // Two cells through the wall leave a fifth.
    assert!((full / 0.0157 - 1.0).abs() <= 0.2, "{full}");
    assert!((full / half - 4.0).abs() <= 0.25, "{half} {full}");
}

/// The limit of the warning "bushing beyond its fit": up to a tenth of the wall relaxed rubber is within 2 % of the springs, thin walls
/// and thick ones, short and long, in all motions.
#[test]
fn springs_hold_up_to_a_tenth_of_the_wall() {
    for (thickness, length) in [(0.005, 0.02), (0.01, 0.06), (0.03, 0.02)] {
        let body = Bushing { inner_diameter: 0.071, thickness, length };
        let mesh = whole(&body, [12, 2, 4]);
        for motion in SleeveMotion::ALL {
            let more = stiffer(&body, &mesh, motion, 0.1);
            assert!(more.abs() <= 0.02, "{thickness} {length} {motion:?}: {more}");
        }
    }
}

/// Angle (rad) at which the torque over the angle of a long sleeve, turned in its wall, is off that of rest by `part`: rings that
/// slide on each other by γ, 2π r² τ(γ) being the same at all radii and γ/r adding up to the angle. The eight chains have
/// I₁ = 3 + γ² and, by five terms, the shear stress 2γ dW/dI₁.
fn turn_of_rings(body: &Bushing, part: f64) -> f64 {
    const CHAIN: f64 = 8.0;
    let shear = |slide: f64| {
        let first = (3.0 + slide * slide) / CHAIN;
        let terms = [0.5, 1.0 / 20.0, 11.0 / 1050.0, 19.0 / 7000.0, 519.0 / 673_750.0];
        let powers = terms.iter().enumerate();
        let rate: f64 = powers.map(|(i, term)| term * (i + 1) as f64 * first.powi(i as i32)).sum();
        2.0 * rate * slide
    };
    let middle = |from: f64, to: f64| 0.5 * (from + to);
    let [inner, outer] = [0.5 * body.inner_diameter, 0.5 * body.inner_diameter + body.thickness];
    let turn = |torque: f64| {
        const RINGS: usize = 400;
        let width = (outer - inner) / RINGS as f64;
        let of_ring = |ring: usize| {
            let radius = inner + (ring as f64 + 0.5) * width;
            let (mut low, mut high) = (0.0, 10.0);
            for _ in 0..60 {
                let slide = middle(low, high);
                let is_less = shear(slide) < torque / (radius * radius);
                *(if is_less { &mut low } else { &mut high }) = slide;
            }
            middle(low, high) / radius * width
        };
        (0..RINGS).map(of_ring).sum::<f64>()
    };
    let rest = 1e-9 / turn(1e-9);
    let (mut low, mut high) = (1e-9, inner * inner);
    for _ in 0..60 {
        let torque = middle(low, high);
        let is_less = torque / turn(torque) / rest < 1.0 + part;
        *(if is_less { &mut low } else { &mut high }) = torque;
    }
    turn(middle(low, high))
}

/// Turned about its axis the bushing stiffens by its chains alone.
#[test]
fn a_turned_bushing_stiffens_as_rings_say() {
    const PART: f64 = 2e-3;
    let body = Bushing { inner_diameter: 0.0197, thickness: 0.00835, length: 0.06 };
    let mesh = whole(&body, [24, 4, 2]);
    let share = turn_of_rings(&body, PART) * 0.5 * body.inner_diameter / body.thickness;
    let more = stiffer(&body, &mesh, SleeveMotion::Torsional, share);
    // The amplitude is known to 1 %, the difference goes with its square; two cells through the wall leave a quarter.
    assert!((more / PART - 1.0).abs() <= 2e-2, "{more}");
}

#[test]
fn a_quarter_is_a_quarter_of_the_whole() {
    let mesh = BushingMesh { around: 16, radial: 4, axial: 4, grading: 1.4, part: Part::Whole };
    let mesh = bushing(&BUSHING, &mesh).unwrap().quadratic().unwrap().mesh;
    let held = [HELD; 3];
    let moved = [HELD, HELD, Some(Profile::Constant(1.0))];
    let prescribed = supports(&mesh, &[("outer", held), ("inner", moved)]);
    let (elements, nodes) = (quadratic(&mesh), mesh.nodes);
    let material = with_bulk(100.0);
    let problem = RubberProblem { nodes, elements, material, prescribed, loads: vec![] };
    let model = RubberModel::new(problem).unwrap();
    let whole = complex_stiffness(&model, 0.0, &[0.0], 1e-6).unwrap()[0].storage;
    let quarter = static_stiffness(with_bulk(100.0), [8, 4, 2]);
    // Cells are cut along other diagonals on both sides of a plane: a tenth of what the mesh misses.
    assert!((whole / quarter - 1.0).abs() <= 5e-3, "{whole} {quarter}");
}

#[test]
fn stiffness_is_proportional_to_the_modulus() {
    let of = |c: f64| {
        let mut rubber = named::table_3_1();
        rubber.network = EightChain::new(c, 8.0, 100.0 * c, ChainPull::FiveTerms).unwrap();
        let (model, _) = bonded(rubber, [6, 2, 2], Profile::Constant(1.0));
        complex_stiffness(&model, 0.0, &[TAU], 1e-9).unwrap()[0]
    };
    let [half, one, two] = [0.3235e6, 0.647e6, 1.294e6].map(of);
    for (a, b) in [(half, one), (one, two)] {
        // Rounding of solves.
        assert!((b.storage / a.storage - 2.0).abs() <= 1e-11, "{a:?} {b:?}");
        assert!((b.loss / a.loss - 2.0).abs() <= 1e-11, "{a:?} {b:?}");
    }
}

/// Torsion is 4πμL/(1/a² − 1/b²) at any length; a quarter with mirrored or reversed planes is a quarter of the
/// whole for every motion.
#[test]
fn four_motions_of_a_sleeve() {
    let rubber = with_bulk(100.0);
    let of = |part, cells: [usize; 3], motion| {
        let [around, radial, axial] = cells;
        let mesh = BushingMesh { around, radial, axial, grading: 1.4, part };
        let mesh = bushing(&BUSHING, &mesh).unwrap().quadratic().unwrap().mesh;
        sleeve_stiffness(&mesh, part, rubber.clone(), motion, &[0.0], 1e-6).unwrap()[0].storage
    };
    for motion in SleeveMotion::ALL {
        let quarter = of(Part::Quarter, [8, 4, 2], motion);
        let whole = of(Part::Whole, [16, 4, 4], motion);
        // Cells are cut along other diagonals on both sides of a plane.
        assert!((quarter / whole - 1.0).abs() <= 0.01, "{motion:?}: {quarter} {whole}");
    }
    let (a, b) = (0.02f64, 0.04f64);
    let mu = rubber.network.shear_modulus();
    let exact = 4.0 * std::f64::consts::PI * mu * 0.04 / (1.0 / (a * a) - 1.0 / (b * b));
    let ours = of(Part::Quarter, [16, 4, 2], SleeveMotion::Torsional);
    // Of a shear that falls with r² over four cells.
    assert!((ours / exact - 1.0).abs() <= 0.01, "{ours} {exact}");
}
