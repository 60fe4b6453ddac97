//! Steps of rubber that go on from a checkpoint, what they do by their plan, and the stresses that they leave.

use bearing_dynamics::ch2_housing::elastomer::{Elastomer, named};
use bearing_dynamics::mesh::Elements;
use bearing_dynamics::mesh::generate::bar;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::plan::counts::{Counts, StageCounts};
use bearing_dynamics::plan::{Item, counted};
use bearing_dynamics::solids::model::Load;
use bearing_dynamics::solids::rubber::checkpoint::RubberCheckpoint;
use bearing_dynamics::solids::rubber::measures::{point_stresses, stresses};
use bearing_dynamics::solids::rubber::model::{RubberModel, RubberProblem, supports};
use bearing_dynamics::solids::rubber::plan::{Method, items};
use bearing_dynamics::solids::rubber::relaxed::relaxed;
use bearing_dynamics::solids::rubber::steps::{RubberSolid, StepOptions, Stepping};
use bearing_dynamics::solids::rubber::vibration::vibrations;

const HELD: Option<Profile> = Some(Profile::ZERO);

/// A bar that is pulled along X and free to grow thinner, or held at both ends altogether.
fn pulled(by: Profile, bonded: bool, material: Elastomer) -> RubberModel {
    let mesh = bar([0.02, 0.01, 0.01], [2, 1, 1]).unwrap().quadratic().unwrap().mesh;
    let across = if bonded { [HELD, HELD] } else { [None, None] };
    let [y, z] = across;
    let sets = [
        ("x_low", [HELD, y.clone(), z.clone()]),
        ("x_high", [Some(by), y, z]),
        ("y_low", [None, HELD, None]),
        ("z_low", [None, None, HELD]),
    ];
    let prescribed = supports(&mesh, &sets);
    let Elements::Quadratic(elements) = mesh.elements else { panic!("ten nodes") };
    let problem =
        RubberProblem { nodes: mesh.nodes, elements, material, prescribed, loads: Vec::new() };
    RubberModel::new(problem).unwrap()
}

fn ramp() -> Profile {
    Profile::Ramp { from: 0.0, to: 4e-3, start: 0.01, duration: 0.1 }
}

fn stepped(model: &RubberModel, stepping: Stepping) -> RubberSolid<'_> {
    RubberSolid::new(model, StepOptions { stepping, ..StepOptions::default() }).unwrap()
}

fn solid(model: &RubberModel) -> RubberSolid<'_> {
    stepped(model, Stepping::Accuracy(1e-3))
}

/// Its checkpoint as the text of a file.
fn text(solid: &RubberSolid) -> String {
    serde_json::to_string(&solid.checkpoint()).unwrap()
}

#[test]
fn steps_from_a_checkpoint_have_the_same_bits() {
    let model = pulled(ramp(), true, named::table_3_1());
    // At rest, in the ramp, at its end and behind it; steps whose factors change, and steps that share them.
    let cases = [0.005, 0.03, 0.11, 0.15].map(|first| {
        [Stepping::Accuracy(1e-3), Stepping::Fixed(2e-3)].map(|stepping| (first, stepping))
    });
    for (first, stepping) in cases.into_iter().flatten() {
        let mut whole = stepped(&model, stepping);
        whole.advance(first, |_| {}).unwrap();
        let through: RubberCheckpoint = serde_json::from_str(&text(&whole)).unwrap();
        assert_eq!(through, whole.checkpoint());
        whole.advance(0.3, |_| {}).unwrap();
        let mut other = stepped(&model, stepping);
        other.restore(&through).unwrap();
        other.advance(0.3, |_| {}).unwrap();
        assert!(text(&whole) == text(&other), "from {first} s");
        assert_eq!(whole.work(), other.work());
        assert_eq!(whole.counts, other.counts);
    }
}

fn check(what: &str, plan: &[Item], ran: Counts) {
    let ran = StageCounts { solids: vec![ran], ..StageCounts::default() };
    for of in counted(plan, &ran) {
        assert_eq!(of.ran > 0, of.does, "{what}: {of:?}");
    }
}

#[test]
fn rubber_does_what_is_planned_and_nothing_else() {
    let without = |maxwell: bool, loads: bool| {
        let mut material = named::table_3_1();
        if !maxwell {
            material.maxwell.clear();
        }
        let mut model = pulled(ramp(), true, material);
        if loads {
            let forces = vec![(40, [0.0, 0.0, 1e-3])];
            model.problem.loads.push(Load { forces, profile: Profile::Constant(1.0) });
        }
        model
    };
    for (maxwell, loads) in [(true, true), (true, false), (false, true), (false, false)] {
        let model = without(maxwell, loads);
        let what = format!("Maxwell elements {maxwell}, loads {loads}");
        let planned = |method: &Method| items(&model.problem, 0, "a bar", method);
        let mut moving = solid(&model);
        moving.advance(0.05, |_| {}).unwrap();
        check(&what, &planned(&Method::Steps("so".into())), *moving.ran());
        let found = relaxed(&model, 0.2).unwrap();
        check(&what, &planned(&Method::Statics { frequencies: 0 }), found.ran);
        let mut ran = found.ran;
        vibrations(&model, &[1.0, 2.0], &mut ran).unwrap();
        if maxwell {
            check(&what, &planned(&Method::Statics { frequencies: 2 }), ran);
        }
    }
}

/// Under a load that is growing it rests as under a constant one as large as that is then.
#[test]
fn relaxed_is_under_what_acts_at_its_time() {
    let under = |profile: Profile| {
        let mut model = pulled(Profile::ZERO, true, named::table_3_1());
        // In the middle of its length, at an edge: no support holds it.
        let nodes = &model.problem.nodes;
        let ends = nodes.iter().fold([f64::MAX, f64::MIN], |[a, b], x| [a.min(x[0]), b.max(x[0])]);
        let middle =
            |node: &u32| (nodes[*node as usize][0] - 0.5 * (ends[0] + ends[1])).abs() < 1e-9;
        let out = |node: &u32| nodes[*node as usize][1] + nodes[*node as usize][2];
        let node = (0..nodes.len() as u32)
            .filter(middle)
            .max_by(|a, b| out(a).total_cmp(&out(b)))
            .unwrap();
        model.problem.loads.push(Load { forces: vec![(node, [0.0, 0.0, 1.0])], profile });
        relaxed(&model, 0.25).unwrap().state.displacement
    };
    let growing = under(Profile::Ramp { from: 0.0, to: 0.8, start: 0.0, duration: 1.0 });
    let constant = under(Profile::Constant(0.2));
    let largest = constant.iter().flatten().fold(0.0f64, |most, u| most.max(u.abs()));
    assert!(largest > 1e-9, "{largest:e}");
    for (growing, constant) in growing.iter().flatten().zip(constant.iter().flatten()) {
        // Two searches of the same steps: rounding.
        assert!((growing - constant).abs() <= 1e-12 * largest, "{growing:e} {constant:e}");
    }
}

/// A bar under tension has one stress, the force over the deformed section, and nothing across.
#[test]
fn stresses_hold_the_forces() {
    let model = pulled(ramp(), false, named::table_3_1());
    let mut moving = solid(&model);
    // In the ramp, where much of the stress is in Maxwell elements.
    moving.advance(0.06, |_| {}).unwrap();
    let state = moving.state();
    let sum = |n: &usize| model.problem.nodes[*n].iter().sum::<f64>();
    let all = 0..model.problem.nodes.len();
    let corner = all.max_by(|a, b| sum(a).total_cmp(&sum(b))).unwrap();
    let end = model.problem.nodes[corner][0];
    let nodes = (0u32..).zip(&model.problem.nodes);
    let at_end: Vec<u32> = nodes.filter(|(_, at)| at[0] == end).map(|(node, _)| node).collect();
    let force = moving.support_force(&at_end)[0];
    let [_, v, w] = state.displacement[corner];
    let exact = force / ((0.01 + v) * (0.01 + w));
    assert!(exact > 1e6, "{exact}");
    for stress in point_stresses(&model, state).unwrap().as_flattened() {
        // Iterations end at 1e-9 of the largest force at a node, where four or so of them make the whole.
        assert!((stress[0] / exact - 1.0).abs() <= 1e-6, "{stress:?} {exact}");
        assert!(stress[1..].iter().all(|s| s.abs() <= 1e-6 * exact), "{stress:?}");
    }
    let found = stresses(&model, state).unwrap();
    let all = found.cells.iter().chain(&found.nodes);
    assert!(all.into_iter().all(|stress| (stress[0] / exact - 1.0).abs() <= 1e-6));
}
