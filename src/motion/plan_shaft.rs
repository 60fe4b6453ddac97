//! Plan items of a flexible body.

use crate::assembly::lists::Assembly;
use crate::members::flexible_shaft::ElasticShaft;
use crate::motion::plan::stands_on_ground;
use crate::numeric::clock::to_digits;
use crate::plan::{Item, Stage, Subject};
use std::f64::consts::TAU;

/// A flexible body.
pub(crate) fn bending(shaft: &ElasticShaft, assembly: &Assembly) -> [Item; 3] {
    let (body, subject) = (&assembly.bodies[shaft.body], Subject::Body(shaft.body));
    let (count, natural) = (shaft.count(), shaft.shapes.natural);
    let cut = &shaft.shapes.cut;
    let beyond = match cut.above.is_finite() {
        true => format!(
            "; the omitted modes, from {:.0} Hz on, have up to {} % of the static compliance at an attachment, which the correction modes contain",
            cut.above / TAU,
            to_digits(100.0 * cut.share, 2)
        ),
        false => String::new(),
    };
    let why = format!(
        "{} bends in {count} modes in each plane: {natural} natural modes, {} static correction modes of its attachments{beyond}",
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
            "of bending, mass-proportional; internal damping too, which feeds whirl above a critical speed: see `bearing modes`"
        }
        false if body.driven().is_some_and(stands_on_ground) => {
            "mass-proportional, of bending; if of all motion, the rigid body's part is among the dashpots to the ground"
        }
        false => "of bending alone, mass-proportional",
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

/// "2 forces", "1 force"; `None` for zero.
fn counted(count: usize, what: &str) -> Option<String> {
    (count > 0).then(|| format!("{count} {what}{}", if count == 1 { "" } else { "s" }))
}
