//! Steps take no memory from the heap: room is made once, before the first.

mod common;
#[path = "common/dynamics.rs"]
mod dynamics;

use bearing_dynamics::assembly::bearing_alone::DynamicProblem;
use bearing_dynamics::assembly::lists::Assembly;
use bearing_dynamics::ch2_housing::bearing::cage::{Guidance, Pocket};
use bearing_dynamics::ch2_housing::bearing::contact::ContactDamping;
use bearing_dynamics::ch2_housing::elastomer::eight_chain::ChainPull;
use bearing_dynamics::ch2_housing::elastomer::named::table_3_1;
use bearing_dynamics::ch2_housing::linear_elastic::LinearElastic;
use bearing_dynamics::members::beam::{Beam, BeamSegment};
use bearing_dynamics::members::body::{Drive, RotatingLoad};
use bearing_dynamics::members::contacts::Kernel;
use bearing_dynamics::members::flexible_shaft::{ElasticShaft, ShaftLoad, Unbalance};
use bearing_dynamics::members::shaft_modes::{Kept, free_shaft};
use bearing_dynamics::mesh::TetMesh;
use bearing_dynamics::mesh::quadratic::elevate;
use bearing_dynamics::mesh::tet_mesh::Elements;
use bearing_dynamics::motion::simulation::{Integrator, RunOptions, Simulation, Start, Stepping};
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{DampedMotion, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::rubber::explicit::RubberBody;
use bearing_dynamics::solids::rubber::tet_forces::MeanStress;
use common::table_4_1;
use dynamics::*;
use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// The system's allocator, with a count for each thread of what it is asked for.
struct Counting;

thread_local! {
    static COUNT: Cell<u64> = const { Cell::new(0) };
}

fn count() {
    // Threads that are ending have no count any more.
    let _ = COUNT.try_with(|count| count.set(count.get() + 1));
}

unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        count();
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        unsafe { System.realloc(pointer, layout, size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// How often `work` asks for memory.
fn allocations(work: impl FnOnce()) -> u64 {
    let before = COUNT.get();
    work();
    COUNT.get() - before
}

#[test]
fn the_count_sees_what_is_allocated() {
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![1.0]))), 1);
    assert_eq!(allocations(|| drop(std::hint::black_box(vec![0u8; 100]))), 1);
    let mut growing = vec![1.0];
    assert_eq!(allocations(|| growing.reserve(100)), 1);
}

/// Everything that a bearing can have: traction, cage, a moving outer race, damping with a memory,
/// loads of every kind.
fn full() -> DynamicProblem {
    let geometry = table_4_1(-5e-6);
    let mut problem = bearing(geometry, [50.0, 0.0, -1500.0, 0.0, 0.0], 1000.0 * RPM);
    problem.inner.drives[1] =
        Drive::Load(Profile::Table { points: vec![[0.0, 0.0], [1e-4, 20.0], [1.0, 50.0]] });
    problem.inner.drives[4] = Drive::Motion(Profile::Harmonic {
        mean: 0.0,
        amplitude: 1e-5,
        frequency: 50.0,
        phase: 0.0,
    });
    let mut outer = free_race();
    outer.foundation_stiffness = [1e8, 1e8, 1e8, 1e5, 1e5];
    outer.foundation_damping = [1e3, 1e3, 1e3, 1.0, 1.0];
    let turning = Profile::Constant(50.0 * RPM);
    DynamicProblem {
        outer: Some(outer),
        cage: Some(cage(&geometry, Pocket::Cylindrical, Guidance::OuterRace)),
        traction: traction_laws().swap_remove(2),
        damping: ContactDamping::HuntCrossley { alpha: 0.3 },
        gravity: GRAVITY,
        rotating_load: Some(RotatingLoad {
            force: Profile::Constant(100.0),
            speed: turning,
            phase: 0.3,
        }),
        unbalance: 1e-4,
        ..problem
    }
}

/// The same with an inner race that bends as a shaft does.
fn bending() -> Assembly {
    let segment = BeamSegment {
        length: 0.4,
        outer_diameter: 30e-3,
        inner_diameter: 0.0,
        density: 7850.0,
        youngs_modulus: 210e9,
        poisson_ratio: 0.3,
    };
    let kept = Kept { most: 3, ..Kept::ALL };
    let beam = Beam::new(vec![segment]);
    let (_, shapes) = free_shaft(&beam, kept, &[(0.2, true)], &[]).unwrap();
    let section = shapes.section(0.1);
    let mut assembly = full().assembly();
    assembly.shafts.push(ElasticShaft {
        damping: 10.0,
        internal_damping: 1.0,
        loads: vec![ShaftLoad {
            section: section.clone(),
            force: [0.0, 1.0, -2.0].map(Profile::Constant),
        }],
        unbalances: vec![Unbalance { section, size: 1e-4, angle: 0.3 }],
        shapes,
        ..ElasticShaft::default()
    });
    assembly
}

#[test]
fn steps_of_a_bending_shaft_allocate_nothing() {
    for (integrator, stepping) in [
        (Integrator::RungeKutta, Stepping::Fixed(1e-7)),
        (Integrator::DormandPrince, Stepping::Accuracy(1e-3)),
        (Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
    ] {
        let options = RunOptions {
            integrator,
            stepping,
            start: Start::Nominal,
            energy_limit: f64::INFINITY,
            ..RunOptions::default()
        };
        let mut simulation = Simulation::new(bending(), options).unwrap();
        simulation.step().unwrap();
        let count = allocations(|| {
            for _ in 0..50 {
                simulation.step().unwrap();
            }
        });
        assert_eq!(count, 0, "{integrator:?}");
    }
}

#[test]
fn steps_of_a_bearing_allocate_nothing() {
    let bare = bearing(table_4_1(-5e-6), [0.0, 0.0, -1500.0, 0.0, 0.0], 1000.0 * RPM);
    let integrators = [
        (Integrator::RungeKutta, Stepping::FractionOfLimit(0.5)),
        (Integrator::DormandPrince, Stepping::Fixed(1e-7)),
        (Integrator::DormandPrince, Stepping::Accuracy(1e-3)),
        (Integrator::Rosenbrock, Stepping::Fixed(1e-6)),
        (Integrator::Rosenbrock, Stepping::Accuracy(1e-3)),
    ];
    for (name, problem) in [("full", full()), ("bare", bare)] {
        for (integrator, stepping) in integrators {
            for driver in [Kernel::Scalar, Kernel::Simd] {
                let options = RunOptions {
                    integrator,
                    stepping,
                    driver,
                    energy_limit: f64::INFINITY,
                    ..RunOptions::default()
                };
                let mut simulation = Simulation::new(problem.clone(), options).unwrap();
                simulation.step().unwrap();
                let count = allocations(|| {
                    for _ in 0..50 {
                        simulation.step().unwrap();
                    }
                    // Too long: with error control it is thrown away and tried again.
                    if matches!(stepping, Stepping::Accuracy(_)) {
                        simulation.step_by(1e-4).unwrap();
                    }
                });
                assert_eq!(count, 0, "{name}, {integrator:?}, {stepping:?}, {driver:?}");
                let rejected = simulation.system.work.rejected_steps;
                assert!(rejected > 0 || !matches!(stepping, Stepping::Accuracy(_)));
            }
        }
    }
}

/// A cube of six tetrahedra, held at one face, loaded and damped.
fn cube(quadratic: bool) -> SolidModel {
    let corner = |i: usize| [(i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2 & 1) as f64];
    let nodes = (0..8).map(|i| corner(i).map(|x| 0.01 * x)).collect();
    let tets = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
    let mesh = TetMesh::new(nodes, Elements::Linear(tets.to_vec())).unwrap();
    let mesh = if quadratic { elevate(&mesh, &[]).unwrap().mesh } else { mesh };
    let held = |node| (0..3).map(move |axis| Prescribed { node, axis, profile: Profile::ZERO });
    SolidModel::new(SolidProblem {
        nodes: mesh.nodes,
        elements: mesh.elements,
        material: LinearElastic::new(2.1e11, 0.3).unwrap(),
        density: 7800.0,
        damping: 100.0,
        damped_motion: DampedMotion::Absolute,
        prescribed: (0..4).flat_map(held).collect(),
        loads: Vec::new(),
        gravity: GRAVITY,
    })
    .unwrap()
}

#[test]
fn explicit_steps_of_a_solid_allocate_nothing() {
    for quadratic in [false, true] {
        for method in [ExplicitMethod::CentralDifferences, ExplicitMethod::RungeKutta] {
            let model = cube(quadratic);
            let still = vec![[0.0; 3]; model.problem.nodes.len()];
            let stepping = SolidStepping::FractionOfLimit(0.5);
            let mut solid =
                ExplicitSolid::new(model, method, stepping, still.clone(), still).unwrap();
            solid.step(|_, _, _| {}).unwrap();
            let count = allocations(|| {
                for _ in 0..20 {
                    solid.step(|_, _, forces| forces[7][0] += 10.0).unwrap();
                }
            });
            assert_eq!(count, 0, "{method:?}, quadratic: {quadratic}");
            assert!(solid.displacement[7][0] > 0.0);
        }
    }
}

#[test]
fn explicit_steps_of_rubber_allocate_nothing() {
    let SolidProblem { nodes, elements: Elements::Linear(elements), prescribed, .. } =
        cube(false).problem
    else {
        panic!("of four nodes")
    };
    let still = vec![[0.0; 3]; nodes.len()];
    for mean_stress in [MeanStress::OfElement, MeanStress::AroundNodes] {
        for pull in [ChainPull::FiveTerms, ChainPull::Exact] {
            let mut material = table_3_1();
            material.network.pull = pull;
            let body = RubberBody {
                nodes: nodes.clone(),
                elements: elements.clone(),
                material,
                density: 1100.0,
                mean_stress,
                mass_scale: 10.0,
                prescribed: prescribed.clone(),
                loads: Vec::new(),
                gravity: [0.0, 0.0, -9.81],
            };
            let stepping = SolidStepping::FractionOfLimit(0.5);
            let (mut solid, _) =
                ExplicitSolid::of_rubber(&body, stepping, still.clone(), still.clone()).unwrap();
            solid.step(|_, _, _| {}).unwrap();
            let count = allocations(|| {
                for _ in 0..50 {
                    solid.step(|_, _, forces| forces[7][0] += 1e-3).unwrap();
                }
            });
            assert_eq!(count, 0, "{mean_stress:?} {pull:?}");
            assert!(solid.displacement[7][0] > 0.0);
        }
    }
}
