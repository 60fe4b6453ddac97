//! Shafts of tetrahedra over stations.

use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::ch4_rotor::beam::ShearCoefficient;
use bearing_dynamics::members::beam::{Beam, BeamError, BeamMatrices, BeamSegment, STATION};
use bearing_dynamics::members::condensed_shaft::{SolidShaftError, matrices, section};
use bearing_dynamics::members::meshed_shaft::ShaftMesh;
use bearing_dynamics::members::shaft_modes::{BendingPlane, Kept, ShaftShapes, free_shaft};
use bearing_dynamics::mesh::generate::{ShaftStep, shaft, stepped_shaft, uniform};
use bearing_dynamics::mesh::measure::total_area;
use bearing_dynamics::mesh::{Order, TetMesh};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::model::{DampedMotion, Load, Prescribed, SolidModel, SolidProblem};
use nalgebra::{DMatrix, DVector};

fn steel(length: f64, outer_diameter: f64, inner_diameter: f64) -> BeamSegment {
    let (density, youngs_modulus, poisson_ratio) = (7850.0, 210e9, 0.3);
    BeamSegment { length, outer_diameter, inner_diameter, density, youngs_modulus, poisson_ratio }
}

const TEN_NODES: ShaftMesh =
    ShaftMesh { order: Order::Quadratic, longest_layer: f64::INFINITY, around: 16, radial: 1 };

/// A plain stub of steel, its mesh and its problem; five stations.
fn stub() -> (TetMesh, SolidProblem, Vec<f64>) {
    let mesh = shaft(0.01, &uniform(0.0, 0.1, 4), 0.02, 8, 1).unwrap().quadratic().unwrap().mesh;
    let problem = problem(&mesh);
    (mesh, problem, uniform(0.0, 0.1, 4))
}

fn problem(mesh: &TetMesh) -> SolidProblem {
    SolidProblem {
        nodes: mesh.nodes.clone(),
        elements: mesh.elements.clone(),
        material: LinearElastic::new(210e9, 0.3).unwrap(),
        density: 7850.0,
        damping: 0.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: Vec::new(),
        loads: Vec::new(),
        gravity: [0.0; 3],
    }
}

/// Steps and bores: mass, centre, both inertias (the one about the axis out of the gyroscopic matrix) of the closed form.
#[test]
fn a_stepped_hollow_shaft_weighs_what_it_should() {
    let segments = vec![steel(0.1, 0.05, 0.02), steel(0.12, 0.03, 0.02), steel(0.06, 0.04, 0.0)];
    let beam = Beam::new(segments);
    let plane = BendingPlane::from(&beam.matrices(&[]).unwrap());
    let solid = Beam { mesh: Some(TEN_NODES), ..beam };
    let matrices = solid.matrices(&[]).unwrap();
    let (exact, found) = (plane.rigid_part(), BendingPlane::from(&matrices).rigid_part());
    assert!((found.centre - exact.centre).abs() <= 1e-5, "{found:?} {exact:?}");
    // Edges of 22.5 degrees of degree two leave 1e-4 of the circle.
    for (ours, theirs) in [
        (found.mass, exact.mass),
        (found.axial, exact.axial),
        (found.transverse, exact.transverse),
        (matrices.axial_mass.sum(), exact.mass),
    ] {
        assert!((ours / theirs - 1.0).abs() <= 3e-4, "{found:?} {exact:?}");
    }
    // Rigid motions strain nothing, and the gyroscopic matrix is skew.
    for motion in matrices.rigid_motions(0.05) {
        let left = (&matrices.stiffness * &motion).amax() / matrices.stiffness.amax();
        assert!(left <= 1e-9, "{left}");
    }
    assert!((&matrices.gyroscopic + matrices.gyroscopic.transpose()).amax() <= 1e-18);
    // Corners of steps carry little: the true shaft is a few percent softer than the beam there.
    let first = |beam: &Beam| free_shaft(beam, Kept::ALL, &[], &[]).unwrap().1.hertz()[0];
    let (ours, theirs) = (first(&solid), first(&Beam { mesh: None, ..solid.clone() }));
    assert!(ours < theirs && ours > 0.9 * theirs, "{ours} {theirs}");
}

/// Of curved six-node faces corners carry less than nothing at some places and more at others: area and centre are those of the
/// volume, whose cells are alike around every eighth of a turn.
#[test]
fn sections_of_curved_faces_have_their_area_and_stand_on_the_axis() {
    let (mesh, problem, stations) = stub();
    let model = SolidModel::new(problem).unwrap();
    let area = model.mass.iter().sum::<f64>() / (7850.0 * 0.1);
    for at in stations {
        let section = section(&mesh, at).unwrap();
        // Rounding of some tens of nodes.
        assert!((section.area / area - 1.0).abs() <= 1e-12, "{} {area}", section.area);
        let [_, y, z] = section.centre;
        assert!(y.hypot(z) <= 1e-14, "{y} {z}");
    }
}

/// Loads on stations that balance, on the condensed shaft and on the whole solid by the solver of equilibria: condensation is
/// exact there.
#[test]
fn static_loads_bend_the_condensed_shaft_as_the_whole_solid() {
    let (mesh, problem, stations) = stub();
    let condensed = matrices(&mesh, &problem, stations.clone()).unwrap();
    // Small enough to stay linear: turns of 1e-6.
    let force = 0.5;
    let sections: Vec<_> = stations.iter().map(|at| section(&mesh, *at).unwrap()).collect();
    let mut bent = problem.clone();
    let ends = [0, 4].map(|at: usize| sections[at].forces([0.0, 0.5 * force, 0.0], [0.0; 3]));
    let mid = sections[2].forces([0.0, -force, 0.0], [0.0; 3]);
    let forces = ends.into_iter().flatten().chain(mid).collect();
    bent.loads.push(Load { forces, profile: Profile::Constant(1.0) });
    // A statically determinate hold that the loads do not push at.
    let at = |x: f64, y: f64, z: f64| {
        let near = |p: &[f64; 3]| (p[0] - x).abs() + (p[1] - y).abs() + (p[2] - z).abs() < 1e-6;
        mesh.nodes.iter().position(near).expect("a node there") as u32
    };
    let (a, b, c) = (at(0.0, 0.0, 0.0), at(0.1, 0.0, 0.0), at(0.0, 0.01, 0.0));
    bent.prescribed = [(a, 0), (a, 1), (a, 2), (b, 1), (b, 2), (c, 2)]
        .map(|(node, axis)| Prescribed { node, axis, profile: Profile::Constant(0.0) })
        .into();
    let model = SolidModel::new(bent).unwrap();
    let whole = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap();
    let felt: Vec<[f64; 2]> = sections
        .iter()
        .map(|section| {
            let [mean, turn] = section.motion(|node| whole.displacement[node as usize]);
            [mean[1], turn[2]]
        })
        .collect();
    // The same motions need the same loads.
    let count = condensed.stations.len();
    let moved = DVector::from_fn(STATION * count, |i, _| match i % STATION {
        0 => felt[i / STATION][0],
        3 => felt[i / STATION][1],
        _ => 0.0,
    });
    let loads = &condensed.stiffness * moved;
    for station in 0..count {
        let expected = [0.5 * force, 0.0, -force, 0.0, 0.5 * force][station];
        let [ours, moment] = [0, 3].map(|i| loads[STATION * station + i]);
        // Both planes are averaged: eight cells around differ by 1e-4 between them.
        assert!((ours - expected).abs() <= 1e-3 * force, "{station}: {ours} {expected}");
        assert!(moment.abs() <= 1e-3 * force * 0.025, "{station}: {moment}");
    }
}

/// The source's plain shaft against beam theory with the shear coefficient of three-dimensional vibrations: frequencies, the tilt's
/// own inertia and that of shapes about the axis.
#[test]
fn a_plain_shaft_vibrates_as_the_beam() {
    let shear_coefficient = ShearCoefficient::Hutchinson;
    let beam = Beam { shear_coefficient, ..Beam::new(vec![steel(0.4, 0.03, 0.0)]) };
    let of = |beam: &Beam| free_shaft(beam, Kept::ALL, &[], &[]).unwrap();
    let (rigid, exact) = of(&beam);
    let (mass, found) = of(&Beam { mesh: Some(TEN_NODES), ..beam });
    let near = |ours: f64, theirs: f64, tolerance: f64| {
        assert!((ours / theirs - 1.0).abs() <= tolerance, "{ours} {theirs}");
    };
    near(mass.axial, rigid.axial, 3e-4);
    // Condensation onto 32 intervals and cells of a layer to each leave 1e-4, 3e-4 and 9e-4.
    for mode in 0..3 {
        near(found.hertz()[mode], exact.hertz()[mode], 1e-3);
        let row = |shapes: &ShaftShapes| shapes.gyroscopic[mode * (shapes.count() + 1)];
        near(row(&found), row(&exact), 2e-3);
    }
    near(found.stretch_frequencies[0], exact.stretch_frequencies[0], 1e-3);
}

/// Frequencies of the free stub, turned about its axis: the same body.
#[test]
fn a_turned_mesh_is_the_same_shaft() {
    let (mut mesh, _, stations) = stub();
    let first = |mesh: &TetMesh| {
        let of = matrices(mesh, &problem(mesh), stations.clone()).unwrap();
        let plane = BendingPlane::from(&of);
        let shapes = plane.shapes(f64::INFINITY, 2, &[]).unwrap();
        (shapes.hertz()[0], shapes.gyroscopic[0], plane.rigid_part().axial)
    };
    let straight = first(&mesh);
    let (sin, cos) = 0.4f64.sin_cos();
    for [_, y, z] in &mut mesh.nodes {
        (*y, *z) = (cos * *y - sin * *z, sin * *y + cos * *z);
    }
    let turned = first(&mesh);
    // What differs between the planes of a coarse mesh.
    for (a, b) in [(straight.0, turned.0), (straight.1, turned.1), (straight.2, turned.2)] {
        assert!((a / b - 1.0).abs() <= 1e-4, "{straight:?} {turned:?}");
    }
}

#[test]
fn bodies_that_are_not_of_revolution_are_refused() {
    let (mesh, whole, stations) = stub();
    let changed = |change: &dyn Fn(&mut [f64; 3])| {
        let mut mesh = mesh.clone();
        mesh.nodes.iter_mut().for_each(change);
        matrices(&mesh, &problem(&mesh), stations.clone()).unwrap_err()
    };
    let flat = changed(&|place| place[2] *= 1.02);
    assert!(matches!(flat, SolidShaftError::NotRound { what: "its inertia", .. }), "{flat}");
    // Along the diagonal.
    let oblique = changed(&|[_, y, z]| (*y, *z) = (*y + 0.02 * *z, *z + 0.02 * *y));
    assert!(matches!(oblique, SolidShaftError::NotRound { .. }), "{oblique}");
    let beside = changed(&|place| place[1] += 1e-3);
    assert!(matches!(beside, SolidShaftError::OffAxis { .. }), "{beside}");
    let between = matrices(&mesh, &whole, uniform(0.01, 0.09, 4)).unwrap_err();
    assert_eq!(between, SolidShaftError::NoLayer { at: 0.01 });
    // Soft matter along Y: round in mass, not in stiffness, is seen by its frequencies only in shafts of two materials; here
    // two materials are refused as such.
    let soft = BeamSegment { youngs_modulus: 70e9, ..steel(0.1, 0.03, 0.0) };
    let two = Beam { mesh: Some(TEN_NODES), ..Beam::new(vec![steel(0.1, 0.03, 0.0), soft]) };
    let refused = two.matrices(&[]).unwrap_err();
    assert_eq!(refused, BeamError::Solid(SolidShaftError::Materials));
}

/// Sections where a shaft steps are those of the thinner side, whichever it is.
#[test]
fn a_section_at_a_step_is_the_smaller_one() {
    let layers = |from: f64| uniform(from, from + 0.02, 2);
    let steps = [
        ShaftStep { layers: layers(0.0), inner_radius: 0.0, outer_radius: 0.02 },
        ShaftStep { layers: layers(0.02), inner_radius: 0.0, outer_radius: 0.015 },
        ShaftStep { layers: layers(0.04), inner_radius: 0.01, outer_radius: 0.02 },
    ];
    let solid = stepped_shaft(&steps, 16, 2).unwrap();
    let mesh = solid.quadratic().unwrap().mesh;
    let area = |outer: f64, inner: f64| std::f64::consts::PI * (outer * outer - inner * inner);
    for (at, expected) in [
        (0.0, area(0.02, 0.0)),
        (0.02, area(0.015, 0.0)),
        (0.03, area(0.015, 0.0)),
        (0.06, area(0.02, 0.01)),
    ] {
        let found = section(&mesh, at).unwrap();
        // Straight edges within the body are chords of 22.5 degrees.
        assert!((found.area / expected - 1.0).abs() <= 0.03, "{at}: {} {expected}", found.area);
    }
    let [low, high] = ["x_low", "x_high"].map(|set| total_area(&mesh, &mesh.surface_sets[set]));
    assert!((low / area(0.02, 0.0) - 1.0).abs() <= 2e-4);
    assert!((high / area(0.02, 0.01) - 1.0).abs() <= 2e-4);
    assert!(!mesh.surface_sets["outer"].is_empty());
    let wrong = ShaftStep { layers: layers(0.0), inner_radius: 0.03, outer_radius: 0.02 };
    assert!(stepped_shaft(&[wrong], 16, 2).is_err());
    assert!(stepped_shaft(&steps, 12, 2).is_err());
}

/// Four-node elements are too stiff in bending, less so the finer they are; ten-node ones are as the beam.
#[test]
fn four_node_elements_bend_too_little() {
    let sag = |of: &BeamMatrices| {
        let [left, mid, right] = [0.0, 0.2, 0.4].map(|at| STATION * of.station(at).unwrap());
        let in_plane = (0..of.stiffness.nrows()).filter(|i| matches!(i % STATION, 0 | 3));
        let free: Vec<usize> = in_plane.filter(|i| *i != left && *i != right).collect();
        let stiffness =
            DMatrix::from_fn(free.len(), free.len(), |i, j| of.stiffness[(free[i], free[j])]);
        let unit = DVector::from_fn(free.len(), |i, _| f64::from(u8::from(free[i] == mid)));
        stiffness.lu().solve(&unit).unwrap().dot(&unit)
    };
    let with = |order, around, radial, longest_layer| {
        let mesh = ShaftMesh { order, longest_layer, around, radial };
        let beam = Beam::new(vec![steel(0.4, 0.03, 0.0)]);
        sag(&Beam { mesh: Some(mesh), ..beam }.matrices(&[0.2]).unwrap())
    };
    let beam = sag(&Beam::new(vec![steel(0.4, 0.03, 0.0)]).matrices(&[0.2]).unwrap());
    let coarse = beam / with(Order::Linear, 16, 1, 0.013) - 1.0;
    let fine = beam / with(Order::Linear, 24, 2, 0.009) - 1.0;
    assert!(coarse > 0.1 && fine < 0.8 * coarse && fine > 0.03, "{coarse} {fine}");
    let quadratic = beam / with(Order::Quadratic, 16, 1, 0.013) - 1.0;
    assert!(quadratic.abs() <= 1e-3, "{quadratic}");
}
