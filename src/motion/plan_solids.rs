//! Plan items of shafts and cages in elements.

use crate::assembly::lists::Assembly;
use crate::members::ball_set::guiding_side;
use crate::members::bearing::Bearing;
use crate::motion::coupling::SolidPart;
use crate::plan::{Item, Stage, Subject};
use crate::solids::plan::{Method, items};

/// Items of a shaft in elements, the `index`-th solid, in explicit steps.
pub fn stepped_shaft(
    assembly: &Assembly,
    index: usize,
    (name, part): (&str, &SolidPart),
    mesh: &str,
) -> Vec<Item> {
    let (subject, of) = (Subject::Solid(index), Some(name));
    let mut items = items(&part.model.problem, index, of, mesh, &Method::Explicit);
    for item in items.iter_mut().filter(|item| item.stage == Stage::Explicit) {
        item.why = "elements and bodies in their own steps, which exchange impulses".into();
    }
    let Some(shaft) = &part.shaft else { return items };
    let (count, unbalances) = (shaft.joints.len(), shaft.unbalances.len());
    let why = format!(
        "{count} races and discs on springs to their sections, in every step of the elements"
    );
    items.push(Item::new(Stage::Joints, subject, count > 0, why).named(of));
    let why = format!("{unbalances} at sections");
    items.push(Item::new(Stage::Unbalance, subject, unbalances > 0, why).named(of));
    items.extend(shaft.joints.iter().map(|joint| {
        let why =
            format!("on {}, the mean of each coupling step", assembly.bodies[joint.body].name);
        Item::does(Stage::Impulses, Subject::Body(joint.body), why).named(of)
    }));
    items
}

/// Items of a cage in elements, the `index`-th solid, in explicit steps.
pub fn stepped_cage(
    assembly: &Assembly,
    bearing: &Bearing,
    index: usize,
    part: &SolidPart,
) -> Vec<Item> {
    let subject = Subject::Solid(index);
    let of = part.name.as_deref();
    let mesh = format!("{} elements", part.model.problem.elements.len());
    let mut items = items(&part.model.problem, index, of, &mesh, &Method::Explicit);
    for item in items.iter_mut().filter(|item| item.stage == Stage::Explicit) {
        item.why = "elements and balls in their own steps, which exchange impulses".into();
    }
    let balls = bearing.geometry.ball_count;
    let why = format!("{balls} pockets by their nodes, in every step of the elements");
    items.push(Item::does(Stage::Pockets, subject, why));
    let side = bearing.cage.as_ref().and_then(|of| guiding_side(of.contacts.guidance));
    let guided = side.is_some();
    let why = if guided {
        "nodes of the rails, in every step of the elements"
    } else {
        "the balls guide it"
    };
    items.push(Item::new(Stage::Guide, subject, guided, why));
    if let Some(race) = side.map(|side| bearing.mounts[side].body)
        && assembly.bodies[race].driven().is_some()
    {
        let why = "on the guiding race, the mean of each coupling step";
        items.push(Item::does(Stage::Impulses, Subject::Body(race), why).named(of));
    }
    items
}
