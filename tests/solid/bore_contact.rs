//! Laws of the contact between a rigid cylinder and a solid.
// Rows and columns of small matrices read best by their indices.
#![allow(clippy::needless_range_loop)]

use bearing_dynamics::ch2_housing::bore_contact::{
    ContactNode, Cylinder, Frame, Penalty, contact, contact_nodes, split_by_distance, touch,
};
use bearing_dynamics::kinematics::Pose;
use bearing_dynamics::kinematics::euler::quaternion;
use bearing_dynamics::kinematics::vec3::{Vec3, add, cross, dot, norm, sub};
use bearing_dynamics::mesh::Order;
use bearing_dynamics::mesh::generate::{Ring, RingMesh, ring};
use nalgebra::{Matrix3, UnitQuaternion, Vector3};
use proptest::prelude::*;

const CYLINDER: Cylinder = Cylinder { radius: 35.5e-3, width: 18e-3 };
const STIFFNESS: Penalty = Penalty::PerNode(2.5e8);

pub fn pose(position: Vec3, turn: Vec3) -> Pose {
    Pose {
        position: Vector3::from(position),
        orientation: UnitQuaternion::from_scaled_axis(Vector3::from(turn)),
    }
}

/// Nodes about a bore: places in the cylinder's own frame, a little within and without its surface.
fn bore(seed: u64, pose: &Pose) -> Vec<ContactNode> {
    let mut state = seed;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    (0..40)
        .map(|node| {
            let (angle, r) = (std::f64::consts::TAU * random(), 35.5e-3 + 40e-6 * (random() - 0.5));
            let own = Vector3::new(24e-3 * (random() - 0.5), r * angle.cos(), r * angle.sin());
            let place = pose.point_to_parent(&own).into();
            ContactNode { node, place, area: 1e-6 * (0.5 + random()) }
        })
        .collect()
}

fn still(_: u32) -> Vec3 {
    [0.0; 3]
}

#[test]
fn no_overlap_no_force() {
    let frame = Frame::new(&pose([1e-3, 2e-3, -1e-3], [0.0; 3]));
    // Exactly on the surface, beyond it, and beyond the width.
    for (axial, radial) in [(0.0, 35.5e-3), (0.0, 36e-3), (9.1e-3, 30e-3), (-9.1e-3, 30e-3)] {
        let node = ContactNode { node: 0, place: [1e-3 + axial, 2e-3 + radial, -1e-3], area: 1e-6 };
        // 35.5 mm on 2 mm is off by rounding of 37.5 mm.
        let cylinder = Cylinder { radius: node.place[1].min(37.5e-3) - 2e-3, ..CYLINDER };
        let cylinder = if axial == 0.0 { cylinder } else { CYLINDER };
        let sum = contact(&cylinder, &frame, STIFFNESS, &[node], still, |_, _, _, _| {
            panic!("touches");
        });
        assert_eq!((sum.force, sum.moment, sum.energy, sum.touching), ([0.0; 3], [0.0; 3], 0.0, 0));
    }
    // Just within the width and the surface it touches, with K times the overlap along the radius.
    let node = ContactNode { node: 0, place: [1e-3 + 8.9e-3, 2e-3, -1e-3 - 35.499e-3], area: 1e-6 };
    let sum = contact(&CYLINDER, &frame, STIFFNESS, &[node], still, |_, _, _, force| {
        // 1 µm of overlap is known to rounding of 36 mm.
        assert!((force[2] + 250.0).abs() <= 250.0 * 1e-10, "{force:?}");
        assert!(force[0].abs() + force[1].abs() <= 1e-12);
    });
    assert!((sum.force[2] - 250.0).abs() <= 250.0 * 1e-10);
    assert!((sum.peak_pressure / 250e6 - 1.0).abs() <= 1e-10);
}

/// A bore that the cylinder fills pushes it back to the middle; a block under it pushes it up.
/// (2.16) and (2.17) for a race that is turned about all three axes, and far: the printed matrix, by its
/// three turns one after the other, takes a node's place from the race's centre to what the contact sees.
#[test]
fn a_turned_race_sees_a_node_as_the_printed_matrix_has_it() {
    let turn_of = |axis: usize, angle: f64| {
        let (sin, cos) = angle.sin_cos();
        let mut turn = Matrix3::identity();
        let (i, j) = ((axis + 1) % 3, (axis + 2) % 3);
        (turn[(i, i)], turn[(i, j)], turn[(j, i)], turn[(j, j)]) = (cos, sin, -sin, cos);
        turn
    };
    let centre = Vector3::new(0.02, -0.3, 0.11);
    let cylinder = Cylinder { radius: 2.0, width: 4.0 };
    for [eta, xi, lambda] in [
        [0.0; 3],
        [0.4, 0.0, 0.0],
        [0.0, -0.8, 0.0],
        [0.0, 0.0, 1.3],
        [0.7, -1.1, 2.5],
        [-2.9, 1.4, 0.3],
    ] {
        let by_turns = turn_of(2, lambda) * turn_of(1, xi) * turn_of(0, eta);
        let pose = Pose { position: centre, orientation: quaternion(eta, xi, lambda) };
        let frame = Frame::new(&pose);
        for place in [[0.1, 0.2, -0.05], [-0.2, -0.5, 0.3], [0.02, -0.3, 0.3]] {
            let seen = by_turns * (Vector3::from(place) - centre);
            let found = Vector3::from(frame.seen(place));
            assert!((found - seen).norm() <= 1e-15, "{found} {seen}");
            let touched = touch(&cylinder, &frame, place).unwrap();
            assert!((touched.distance - seen.y.hypot(seen.z)).abs() <= 1e-15);
            let outwards = by_turns.transpose() * Vector3::new(0.0, seen.y, seen.z).normalize();
            assert!((Vector3::from(touched.normal) - outwards).norm() <= 1e-14);
        }
    }
}

#[test]
fn within_a_bore_and_on_a_block() {
    let frame = Frame::new(&pose([0.0; 3], [0.0; 3]));
    let wall = ContactNode { node: 0, place: [0.0, 35.49e-3, 0.0], area: 1e-6 };
    let sum = contact(&CYLINDER, &frame, STIFFNESS, &[wall], still, |_, _, _, force| {
        assert!(force[1] > 0.0, "the wall is pushed outwards");
    });
    assert!(sum.force[1] < 0.0);
    let top = ContactNode { node: 0, place: [0.0, 0.0, -35.49e-3], area: 1e-6 };
    let sum = contact(&CYLINDER, &frame, STIFFNESS, &[top], still, |_, _, _, force| {
        assert!(force[2] < 0.0, "the block is pushed down");
    });
    assert!(sum.force[2] > 0.0);
}

#[test]
fn shares_of_the_surface_add_up() {
    let shape = Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.01 };
    let cells = RingMesh { around: 24, radial: 2, axial: 3, radial_growth: 1.0 };
    let solid = ring(&shape, &cells).unwrap();
    for mesh in [solid.mesh.clone(), solid.quadratic().unwrap().mesh] {
        let faces = mesh.surface_set("inner").unwrap();
        let nodes = contact_nodes(&mesh, faces);
        let total: f64 = nodes.iter().map(|node| node.area).sum();
        let area = bearing_dynamics::mesh::measure::total_area(&mesh, faces);
        assert!((total / area - 1.0).abs() <= 1e-13);
        assert!(nodes.windows(2).all(|pair| pair[0].node < pair[1].node));
    }
}

/// Shares of a face's three mid-side nodes by midpoints of `n`² triangles a face: λᵢ + λⱼ − λₖ, which keeps
/// all that is linear, and the shape function alone. On the surface that six nodes span.
fn by_small_triangles(places: &[Vector3<f64>; 6], n: usize) -> [[f64; 2]; 3] {
    let shape = |[u, v, w]: [f64; 3]| {
        let corner = |l: f64| l * (2.0 * l - 1.0);
        [corner(u), corner(v), corner(w), 4.0 * u * v, 4.0 * v * w, 4.0 * w * u]
    };
    let at = |l: [f64; 3]| -> Vector3<f64> {
        shape(l).iter().zip(places).map(|(shape, place)| *place * *shape).sum()
    };
    let mut sums = [[0.0; 2]; 3];
    for i in 0..n {
        for j in 0..n - i {
            let corner = |i: usize, j: usize| {
                let (u, v) = (i as f64 / n as f64, j as f64 / n as f64);
                [u, v, 1.0 - u - v]
            };
            let (a, b, c, d) =
                (corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1));
            let both = [Some([a, b, c]), (i + j + 1 < n).then_some([b, d, c])];
            for corners in both.into_iter().flatten() {
                let middle: [f64; 3] =
                    std::array::from_fn(|k| corners.iter().map(|l| l[k]).sum::<f64>() / 3.0);
                let [p, q, r] = corners.map(at);
                let area = 0.5 * (q - p).cross(&(r - p)).norm();
                let shapes = shape(middle);
                for (k, sum) in sums.iter_mut().enumerate() {
                    sum[0] += area * (1.0 - 2.0 * middle[(k + 2) % 3]);
                    sum[1] += area * shapes[3 + k];
                }
            }
        }
    }
    sums
}

/// The share of a node on curved six-node faces is an integral over them and not a third of their
/// areas, which is wrong by per cents where faces are wide for their radius and unlike each other.
#[test]
fn shares_of_curved_faces_are_integrals_over_them() {
    let shape = Ring { inner_radius: 0.02, outer_radius: 0.03, width: 0.01 };
    let cells = RingMesh { around: 12, radial: 2, axial: 3, radial_growth: 1.0 };
    let mut mesh = ring(&shape, &cells).unwrap().quadratic().unwrap().mesh;
    // Mid-side nodes on the cylinder, though not in the middle of their arcs.
    for [_, y, z] in &mut mesh.nodes {
        let (radius, angle) = (y.hypot(*z), libm::atan2(*z, *y));
        let (sin, cos) = libm::sincos(angle + 0.15 * libm::sin(2.0 * angle));
        (*y, *z) = (radius * cos, radius * sin);
    }
    let faces = mesh.surface_set("inner").unwrap();
    let (mut converged, mut coarser) = (vec![0.0; mesh.nodes.len()], vec![0.0; mesh.nodes.len()]);
    let (mut thirds, mut shapes) = (converged.clone(), converged.clone());
    for &face in faces {
        let nodes: Vec<u32> = mesh.face_nodes(face).collect();
        let places: [Vector3<f64>; 6] = std::array::from_fn(|i| mesh.point(nodes[i]));
        let (fine, half) = (by_small_triangles(&places, 64), by_small_triangles(&places, 32));
        let area = bearing_dynamics::mesh::measure::face_area(&mesh, face);
        for k in 0..3 {
            let node = nodes[3 + k] as usize;
            // Midpoints err by the square of their spacing.
            converged[node] += (4.0 * fine[k][0] - half[k][0]) / 3.0;
            coarser[node] += fine[k][0];
            shapes[node] += (4.0 * fine[k][1] - half[k][1]) / 3.0;
            thirds[node] += area / 3.0;
        }
    }
    let nodes = contact_nodes(&mesh, faces);
    assert_eq!(nodes.len(), converged.iter().filter(|share| **share > 0.0).count());
    let worst = |of: &[f64]| {
        let off = |node: &ContactNode| (of[node.node as usize] / node.area - 1.0).abs();
        nodes.iter().map(off).fold(0.0, f64::max)
    };
    let (off, off_coarser, off_thirds, off_shapes) =
        (worst(&converged), worst(&coarser), worst(&thirds), worst(&shapes));
    println!("{off:.1e} {off_coarser:.1e} {off_thirds:.1e} {off_shapes:.1e}");
    // Seven points are exact to degree five, and the square root in an area is no polynomial.
    assert!(off <= 1e-5 && off <= off_coarser, "{off:e} {off_coarser:e}");
    assert!(off_thirds >= 0.01, "{off_thirds:e}");
}

/// A uniform penetration is a uniform pressure, whatever the mesh, by area; per node it is not.
#[test]
fn pressure_by_area_does_not_know_the_mesh() {
    let (radius, depth) = (0.02, 1e-6);
    let cylinder = Cylinder { radius: radius + depth, width: 1.0 };
    let frame = Frame::new(&Pose::identity());
    let pressures = |around: usize, order: Order, penalty: Penalty| {
        let shape = Ring { inner_radius: radius, outer_radius: 0.03, width: 0.01 };
        let cells = RingMesh { around, radial: 1, axial: 2, radial_growth: 1.0 };
        let solid = ring(&shape, &cells).unwrap();
        let mesh = match order {
            Order::Linear => solid.mesh.clone(),
            Order::Quadratic => solid.quadratic().unwrap().mesh,
        };
        let nodes = contact_nodes(&mesh, mesh.surface_set("inner").unwrap());
        let mut range = (f64::INFINITY, 0.0f64);
        contact(&cylinder, &frame, penalty, &nodes, still, |node, touch, stiffness, _| {
            let pressure = stiffness * touch.penetration / node.area;
            range = (range.0.min(pressure), range.1.max(pressure));
        });
        range
    };
    for order in [Order::Linear, Order::Quadratic] {
        for around in [16, 32] {
            let (low, high) = pressures(around, order, Penalty::PerArea(1e14));
            // Nodes lie on the circle to rounding: 1e-17 m of 1 µm.
            assert!((low / 1e8 - 1.0).abs() <= 1e-9 && (high / 1e8 - 1.0).abs() <= 1e-9);
        }
        let coarse = pressures(16, order, Penalty::PerNode(1e8)).1;
        let fine = pressures(32, order, Penalty::PerNode(1e8)).1;
        assert!(fine > 1.9 * coarse, "{coarse} {fine}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    /// What the nodes get, the cylinder gets back: force, and moment about any point.
    #[test]
    fn force_and_moment_balance(
        seed in any::<u64>(),
        at in prop::array::uniform3(-0.1f64..0.1),
        turn in prop::array::uniform3(-3.0f64..3.0),
        about in prop::array::uniform3(-0.2f64..0.2),
    ) {
        let pose = pose(at, turn);
        let nodes = bore(seed, &pose);
        let (mut force, mut moment, mut size, mut energy) = ([0.0; 3], [0.0; 3], 0.0, 0.0);
        let by = [3e-6, -4e-6, 2e-6];
        let sum = contact(&CYLINDER, &Frame::new(&pose), STIFFNESS, &nodes, |_| by, |node, touch, k, f| {
            force = add(force, f);
            let place = sub(add(node.place, by), about);
            moment = add(moment, cross(place, f));
            size += norm(f);
            energy += 0.5 * k * touch.penetration * touch.penetration;
        });
        prop_assert!(sum.touching > 0 && sum.touching < nodes.len());
        let arm = sub(at, about);
        let back = add(sum.moment, cross(arm, sum.force));
        for i in 0..3 {
            prop_assert!((force[i] + sum.force[i]).abs() <= 1e-13 * size);
            // Arms of up to 0.5 m.
            prop_assert!((moment[i] + back[i]).abs() <= 1e-13 * size * 0.5);
        }
        prop_assert!((energy - sum.energy).abs() <= 1e-13 * energy);
        // No friction: nothing turns the cylinder about its axis, nothing pushes along it.
        let axis: Vec3 = (pose.orientation * Vector3::x()).into();
        prop_assert!(dot(axis, sum.moment).abs() <= 1e-13 * size * 35.5e-3);
        prop_assert!(dot(axis, sum.force).abs() <= 1e-13 * size);
    }

    /// Cylinder and nodes turned and moved together: forces turn with them.
    #[test]
    fn forces_turn_with_the_frame(
        seed in any::<u64>(),
        turn in prop::array::uniform3(-3.0f64..3.0),
        by in prop::array::uniform3(-0.1f64..0.1),
    ) {
        let first = pose([0.0; 3], [0.1, 0.02, -0.03]);
        let nodes = bore(seed, &first);
        let moved = pose(by, turn);
        let turned: Vec<ContactNode> = nodes
            .iter()
            .map(|node| {
                let place = moved.point_to_parent(&Vector3::from(node.place)).into();
                ContactNode { place, ..*node }
            })
            .collect();
        let run = |pose: &Pose, nodes: &[ContactNode]| {
            contact(&CYLINDER, &Frame::new(pose), STIFFNESS, nodes, still, |_, _, _, _| {})
        };
        let (a, b) = (run(&first, &nodes), run(&first.seen_from_parent_of(&moved), &turned));
        prop_assert_eq!(a.touching, b.touching);
        let force: Vec3 = (moved.orientation * Vector3::from(a.force)).into();
        let moment: Vec3 = (moved.orientation * Vector3::from(a.moment)).into();
        // A penetration is known to rounding of lengths of 0.2 m, 4e-17 m each, at 40 nodes.
        let rounding = 2.5e8 * 1e-16 * 40.0;
        prop_assert!(norm(sub(force, b.force)) <= rounding);
        prop_assert!(norm(sub(moment, b.moment)) <= rounding * 0.05);
        prop_assert!((a.energy - b.energy).abs() <= rounding * 2e-5);
    }

    /// Every tangent against differences, force against the slope of the energy.
    #[test]
    fn tangents_and_slopes(
        angle in -3.0f64..3.0,
        depth in 1e-6f64..5e-3,
        along in -8e-3f64..8e-3,
        turn in prop::array::uniform3(-1.0f64..1.0),
    ) {
        let start = pose([0.01, -0.02, 0.03], turn);
        let r = CYLINDER.radius - depth;
        let own = Vector3::new(along, r * angle.cos(), r * angle.sin());
        let place: Vec3 = start.point_to_parent(&own).into();
        let k = 2.5e8;
        // [node force, cylinder force, energy] with node and centre moved.
        let at = |node: Vec3, centre: Vec3| {
            let pose = Pose { position: start.position + Vector3::from(centre), ..start };
            let nodes = [ContactNode { node: 0, place: add(place, node), area: 1e-6 }];
            let mut on_node = [0.0; 3];
            let sum = contact(&CYLINDER, &Frame::new(&pose), Penalty::PerNode(k), &nodes, still, |_, _, _, f| {
                on_node = f;
            });
            (on_node, sum.force, sum.energy)
        };
        let touch = touch(&CYLINDER, &Frame::new(&start), place).unwrap();
        let force = touch.force(k);
        let stiffness = touch.stiffness(k);
        let zero = [0.0; 3];
        // Central differences: third derivatives leave (step/R)² ~ 1e-9 of K, rounding 1e-17 m / step.
        let step = 1e-7f64.min(0.5 * depth);
        let tolerance = 1e-6 * k;
        for j in 0..3 {
            let unit = |s: f64| { let mut v = zero; v[j] = s; v };
            let slope = |plus: Vec3, minus: Vec3, i: usize| (plus[i] - minus[i]) / (2.0 * step);
            let (p, m) = (at(unit(step), zero), at(unit(-step), zero));
            let energy = (p.2 - m.2) / (2.0 * step);
            prop_assert!((force[j] + energy).abs() <= 1e-6 * k * depth, "{} {}", force[j], energy);
            for i in 0..3 {
                prop_assert!((slope(p.0, m.0, i) + stiffness[i][j]).abs() <= tolerance);
                prop_assert!((slope(p.1, m.1, i) - stiffness[i][j]).abs() <= tolerance);
            }
            // The cylinder moved one way is the node moved the other way.
            let (p, m) = (at(zero, unit(step)), at(zero, unit(-step)));
            for i in 0..3 {
                prop_assert!((slope(p.0, m.0, i) - stiffness[i][j]).abs() <= tolerance);
                prop_assert!((slope(p.1, m.1, i) + stiffness[i][j]).abs() <= tolerance);
            }
        }
    }

    /// Nodes out of reach cannot touch while nodes and cylinder move less than the reach.
    #[test]
    fn far_nodes_cannot_touch(seed in any::<u64>(), way in prop::array::uniform3(-1.0f64..1.0)) {
        let start = pose([0.0; 3], [0.0, 0.1, 0.0]);
        let nodes = bore(seed, &start);
        let reach = 5e-6;
        let frame = Frame::new(&start);
        let smaller = Cylinder { radius: CYLINDER.radius - 10e-6, ..CYLINDER };
        let (near, far) = split_by_distance(&smaller, &frame, &nodes, still, reach);
        prop_assert_eq!(near.len() + far.len(), nodes.len());
        prop_assert!(!far.is_empty());
        let by = way.map(|x| 0.99 * reach * x / norm(way));
        let all = contact(&smaller, &frame, STIFFNESS, &nodes, |_| by, |_, _, _, _| {});
        let few = contact(&smaller, &frame, STIFFNESS, &near, |_| by, |_, _, _, _| {});
        prop_assert_eq!(all.force.map(f64::to_bits), few.force.map(f64::to_bits));
        prop_assert_eq!((all.touching, all.tested), (few.touching, nodes.len()));
        prop_assert_eq!(few.tested, near.len());
    }
}
