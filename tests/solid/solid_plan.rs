//! What the plan of a solid does has run, in steps, in equilibrium and for its modes, and nothing else has.

use crate::solid_common;

use bearing_dynamics::mesh::tet_mesh::Order;
use bearing_dynamics::numeric::profile::Profile;
use bearing_dynamics::plan::counts::{Counts, StageCounts};
use bearing_dynamics::plan::{Item, Stage, Subject, counted};
use bearing_dynamics::solids::equilibrium::{EquilibriumOptions, equilibrium};
use bearing_dynamics::solids::explicit::{ExplicitMethod, ExplicitSolid, SolidStepping};
use bearing_dynamics::solids::model::{Load, Prescribed, SolidModel, SolidProblem};
use bearing_dynamics::solids::modes::{ModeOptions, modes};
use bearing_dynamics::solids::plan::{Method, items};
use solid_common::{cut_cubes, solid};

/// A block that stands on its nodes at x = 0, with a load, weight and damping.
fn everything(order: Order) -> SolidProblem {
    let mut all = solid(cut_cubes([0.02, 0.01, 0.01], [2, 1, 1], 0.0, |_| false), order);
    let held = (0u32..).zip(&all.nodes).filter(|(_, at)| at[0] == 0.0).map(|(node, _)| node);
    let held: Vec<u32> = held.collect();
    for axis in 0..3 {
        let still = |node: &u32| Prescribed { node: *node, axis, profile: Profile::ZERO };
        all.prescribed.extend(held.iter().map(still));
    }
    let last = all.nodes.len() as u32 - 1;
    let profile = Profile::Constant(1.0);
    all.loads.push(Load { forces: vec![(last, [0.0, 0.0, -1.0])], profile });
    all.gravity = [0.0, 0.0, -9.81];
    all.damping = 10.0;
    all
}

fn check(what: &str, plan: &[Item], ran: Counts) {
    let ran = StageCounts { solids: vec![ran], ..StageCounts::default() };
    for of in counted(plan, &ran) {
        assert_eq!(of.ran > 0, of.does, "{what}: {of:?}");
    }
}

type Change = fn(&mut SolidProblem);

const WITHOUT: [(&str, Change); 5] = [
    ("nothing", |_| {}),
    ("loads", |p| p.loads.clear()),
    ("gravity", |p| p.gravity = [0.0; 3]),
    ("damping", |p| p.damping = 0.0),
    ("supports", |p| p.prescribed.clear()),
];

#[test]
fn a_solid_does_what_is_planned_and_nothing_else() {
    for order in [Order::Linear, Order::Quadratic] {
        for (what, take_out) in WITHOUT {
            let mut problem = everything(order);
            take_out(&mut problem);
            let planned = |method: &Method| items(&problem, 0, None, "a block", method);
            let model = SolidModel::new(problem.clone()).unwrap();
            let still = || vec![[0.0; 3]; problem.nodes.len()];
            for method in [ExplicitMethod::CentralDifferences, ExplicitMethod::RungeKutta] {
                let stepping = SolidStepping::FractionOfLimit(0.5);
                let mut moving =
                    ExplicitSolid::new(model.clone(), method, stepping, still(), still()).unwrap();
                (0..3).for_each(|_| moving.step(|_, _, _| {}).unwrap());
                check(what, &planned(&Method::Explicit), moving.ran);
                check(what, &planned(&Method::Steps("so".into())), moving.ran);
            }
            if !problem.prescribed.is_empty() {
                let found = equilibrium(&model, 0.0, &EquilibriumOptions::default()).unwrap();
                check(what, &planned(&Method::Statics), found.ran);
            }
            let found = modes(&model, &ModeOptions::new(2)).unwrap();
            let mut plan = planned(&Method::Modes);
            plan.push(Item::does(Stage::Modes, Subject::Solid(0), "two"));
            check(what, &plan, found.ran);
        }
    }
}
