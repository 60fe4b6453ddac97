//! Items of a body that bends in shapes.

use crate::assembly::lists::Assembly;
use crate::assembly::plan::motion::stands_on_ground;
use crate::assembly::plan::{Item, Stage, Subject};
use crate::members::flexible_shaft::ElasticShaft;
use crate::numeric::clock::to_digits;
use std::f64::consts::TAU;

/// A body that bends.
pub(crate) fn bending(shaft: &ElasticShaft, assembly: &Assembly) -> [Item; 3] {
    let (body, subject) = (&assembly.bodies[shaft.body], Subject::Body(shaft.body));
    let (count, natural) = (shaft.count(), shaft.shapes.natural);
    let cut = &shaft.shapes.cut;
    let beyond = match cut.above.is_finite() {
        true => format!(
            "; left out are natural ones from {:.0} Hz on, whose part of the static compliance at a hold, up to {} %, those answers have",
            cut.above / TAU,
            to_digits(100.0 * cut.share, 2)
        ),
        false => String::new(),
    };
    let why = format!(
        "{} bends in {count} shapes either way: {natural} natural ones, {} static answers to what holds it{beyond}",
        body.name,
        count - natural
    );
    let (loads, unbalances) = (shaft.loads.len(), shaft.unbalances.len());
    let acting = loads + unbalances;
    let acts = [counted(loads, "force"), counted(unbalances, "unbalance")];
    let acts: Vec<String> = acts.into_iter().flatten().collect();
    let along = format!("{} at places along {}", acts.join(" and "), body.name);
    let damped = shaft.damping != 0.0 || shaft.internal_damping != 0.0;
    let damping = match shaft.internal_damping != 0.0 {
        true => {
            "of bending, in proportion to mass; inside the shaft too, where it feeds whirl above a critical speed: `bearing modes` tells"
        }
        false if body.driven().is_some_and(stands_on_ground) => {
            "in proportion to mass, of bending; where it brakes all motion, that of the rigid body is among the dashpots to the ground"
        }
        false => "of bending alone, in proportion to mass",
    };
    let either = |stage, does, why: String| {
        Item::new(stage, subject, does, if does { why } else { "none is given".into() })
    };
    let own = [
        Item::does(Stage::Reduced, subject, why).costing(1),
        either(Stage::Loads, acting > 0, along).costing(acting as u64),
        either(Stage::Damping, damped, damping.into()).costing(1),
    ];
    own.map(|item| item.named(body.label.clone()))
}

/// "2 forces", "1 force"; nothing where there is none.
fn counted(count: usize, what: &str) -> Option<String> {
    (count > 0).then(|| format!("{count} {what}{}", if count == 1 { "" } else { "s" }))
}
