//! From named tables to bearings on bodies: carriers and connections.

use crate::ch2_housing::bearing::inertia::Inertia;
use crate::members::body::DrivenBody;
use crate::scene::build::assembly::{
    AssemblyScene, Carrier, NO_INERTIA, PlacedBearing, PlacedHousing, SceneBody, Spring, SpringAt,
    SpringEnd,
};
use crate::scene::error::{Problem, SceneError};
use crate::scene::resolve::bearing::{Reader, resolve_bearing, text};
use crate::scene::resolve::dynamics::{
    check_inertia, check_unbalance, foundation, rotating_load, rotation,
};
use crate::scene::resolve::housing::in_housing;
use crate::scene::resolve::housing_scene::HousingMethod;
use crate::scene::resolve::places::{
    refuse_races_apart, refuse_rubber_in_races, refuse_shared_places, refuse_thick_shafts,
};
use crate::scene::resolve::resolved::{DefaultUsed, Scene};
use crate::scene::resolve::shaft::{beam, refuse_places_off_shafts, refuse_springs_on_elements};
use crate::scene::resolve::solid::{refuse_fields, refuse_solid};
use crate::scene::resolve::spring::spring;
use crate::scene::tables::assembly::OWN_RACES;
use crate::scene::tables::keys;
use crate::scene::text::document::Document;
use crate::scene::text::scopes::no_such;
use crate::scene::text::value::Checked;

/// Returns whether a scene is more than a bearing alone, a solid alone, or one bearing in its housing.
pub(crate) fn is_assembly(document: &Document) -> bool {
    const OF_SEVERAL: [&str; 2] = ["body", "spring"];
    const PLACES: [&str; 5] = ["inner_on", "inner_at", "outer_on", "outer_at", "reversed"];
    let is_given = |key: &&str| document.value(&format!("bearing.{key}")).is_some();
    document.names("bearing").next().is_some()
        || PLACES.iter().any(is_given)
        || OF_SEVERAL.iter().any(|table| document.first_below(table).is_some())
        || OF_SEVERAL.iter().any(|table| document.names(table).next().is_some())
}

/// Resolves a scene of several bearings, or of one on bodies of the scene.
///
/// # Errors
/// The first thing missing or contradictory, in the order of the scene.
pub(crate) fn assembly(document: &Document) -> Result<AssemblyScene, SceneError> {
    refuse_invalid_names(document)?;
    let bodies: Vec<&str> = document.names("body").collect();
    let plain = without_bearing(document)?;
    let names: Vec<Option<&str>> = match document.names("bearing").map(Some).collect::<Vec<_>>() {
        none if none.is_empty() && plain.is_none() => vec![None],
        some => some,
    };
    let mut defaults_used = Vec::new();
    // Defaults that all bearings share.
    let mut shared = Vec::new();
    let mut bearings = Vec::with_capacity(names.len());
    for name in names {
        bearings.push(bearing(document, name, &bodies, &mut shared)?);
    }
    refuse_shared_places(document, &bearings)?;
    refuse_mixed_methods(document, &bearings)?;
    let ball = bearings.iter().map(|b| b.scene.geometry.ball_radius).reduce(f64::max);
    let ball = ball.unwrap_or(FARTHEST);
    let common = plain.as_deref().unwrap_or_else(|| &bearings[0].scene);
    let needs_mass = common.dynamics.run.is_some() || common.gravity != [0.0; 3];
    let resolved = bodies
        .iter()
        .map(|name| body(document, name, ball, needs_mass, &mut defaults_used))
        .collect::<Result<Vec<_>, _>>()?;
    let springs = document
        .names("spring")
        .map(|name| spring(document, name, (&bodies, &bearings), &mut defaults_used))
        .collect::<Result<Vec<_>, _>>()?;
    refuse_places_off_shafts(document, (&bearings, &springs), &resolved)?;
    refuse_races_apart(document, &bearings, &resolved)?;
    refuse_thick_shafts(document, &bearings, &resolved)?;
    refuse_rubber_in_races(document, &bearings, &springs)?;
    name_supports(&mut bearings, &springs);
    let sensors = Vec::new();
    let scene =
        AssemblyScene { bearings, plain, bodies: resolved, springs, sensors, defaults_used };
    refuse_shared_columns(document, &scene)?;
    refuse_free_bodies(document, &scene)?;
    refuse_springs_on_elements(document, &scene)?;
    if scene.housing_method().is_none()
        && !scene.has_shafts_in_elements()
        && !scene.has_cages_in_elements()
    {
        refuse_fields(document)?;
    }
    if scene.housing_method() == Some(HousingMethod::QuasiStatic) {
        refuse_inertia(document, &scene)?;
    }
    Ok(scene)
}

/// Largest prescribed displacement of a body in a scene without balls, m.
const FARTHEST: f64 = 0.1;

/// Title, run, outputs and gravity of bodies and springs without a bearing; `None` for a scene with one.
fn without_bearing(document: &Document) -> Result<Option<Box<Scene>>, SceneError> {
    const OF_BEARINGS: [&str; 5] =
        ["inner_race", "outer_race", "traction", "contact_damping", "ball_contact"];
    // The reader needs a bearing; nothing of it is in the scene.
    const STAND_IN: [(&str, &str); 6] = [
        ("bearing.kind", "deep-groove"),
        ("bearing.balls", "8"),
        ("bearing.pitch_radius", "30 mm"),
        ("bearing.ball.radius", "5 mm"),
        ("bearing.inner_race.conformity", "0.52"),
        ("bearing.outer_race.conformity", "0.52"),
    ];
    let has_bearing =
        document.first_below("bearing").is_some() || document.names("bearing").next().is_some();
    if has_bearing || document.names("spring").next().is_none() {
        return Ok(None);
    }
    let keys = [keys::DEFAULTS, "ball_forces.centrifugal", "numerics.accuracy"];
    let given = keys.into_iter().find(|key| document.is_given(key));
    if let Some(key) = OF_BEARINGS.iter().find_map(|of| document.first_below(of)).or(given) {
        let reason = "the scene has no bearing. Hint: leave it out, or add [bearing]";
        return Err(document.refused(key, reason));
    }
    let mut stand_in = document.clone();
    for (key, value) in STAND_IN {
        stand_in.set(key, value)?;
    }
    let mut reader = Reader::new(document);
    let by_rk4 = reader.choice_if_given("numerics.integrator").is_none_or(|of| of == "rk4");
    let steps =
        ["numerics.step", "numerics.step_fraction"].iter().any(|key| document.is_given(key));
    if document.is_given("numerics.end") && by_rk4 && !steps {
        let reason = "at 0.5 rk4 adds 3 % of critical damping to the fastest mode";
        reader.number_or("numerics.step_fraction", 0.1, "0.1", reason);
        stand_in.set("numerics.step_fraction", "0.1")?;
    }
    let mut scene = resolve_bearing(&stand_in)?;
    let of_all = |used: &DefaultUsed| {
        ["numerics", "output", "sweep"].iter().any(|table| used.key.starts_with(table))
    };
    scene.defaults_used.retain(of_all);
    scene.dynamics.defaults_used.retain(of_all);
    scene.dynamics.defaults_used.extend(reader.into_defaults_used());
    Ok(Some(Box::new(scene)))
}

/// Names the springs that support a race without a foundation in its default.
fn name_supports(bearings: &mut [PlacedBearing], springs: &[Spring]) {
    for (index, placed) in bearings.iter_mut().enumerate() {
        let of_race = |end: &SpringEnd| end.at == SpringAt::Race { bearing: index, side: 1 };
        let holding = springs.iter().filter(|spring| spring.ends.iter().any(of_race));
        let names: Vec<&str> = holding.map(|spring| spring.name.as_str()).collect();
        if names.is_empty() {
            continue;
        }
        let defaults = placed.scene.dynamics.defaults_used.iter_mut();
        for used in defaults.filter(|used| used.key == "outer_race.foundation") {
            used.reason = format!("the moving outer race is held by spring {}", names.join(", "));
        }
    }
}

/// Refuses loads that need inertia in a quasi-static sequence.
fn refuse_inertia(document: &Document, scene: &AssemblyScene) -> Result<(), SceneError> {
    const UNBALANCE: &str = "an unbalance needs inertia";
    const WHAT: [(&str, &str); 2] = [
        ("body.torque", "without inertia no speed follows from a torque"),
        ("body.unbalance", UNBALANCE),
    ];
    let refused = |reason: &str| {
        let hint = "leave it out, or write method = \"explicit\" in [housing]";
        Problem::refused(format!("{reason}. Hint: {hint}"))
    };
    for body in &scene.bodies {
        let scoped = document.scoped(&body.name);
        if let Some((key, reason)) = WHAT.iter().find(|(key, _)| scoped.value(key).is_some()) {
            return Err(scoped.error(key, refused(reason)));
        }
        if let Some(of_section) = scoped.items("body.beam.unbalance").next() {
            return Err(of_section.error("size", refused(UNBALANCE)));
        }
    }
    Ok(())
}

/// Refuses names without a table, names used twice, and tables without a name.
fn refuse_invalid_names(document: &Document) -> Result<(), SceneError> {
    for table in ["body", "spring"] {
        if document.names(table).next().is_none() && document.first_below(table).is_some() {
            let reason = format!("a {table} has a name. Hint: write [{table}.NAME]");
            return Err(document.refused(table, reason));
        }
    }
    for table in ["inner_race", "outer_race", "housing", "solid"] {
        let strange =
            document.names(table).find(|name| !document.names("bearing").any(|b| b == *name));
        if let Some(name) = strange {
            return Err(unknown(document, table, name, "bearing", document.names("bearing")));
        }
    }
    let kinds = ["bearing", "body", "spring", "sensor"];
    for (index, table) in kinds.iter().enumerate() {
        for other in &kinds[..index] {
            if let Some(twice) =
                document.names(table).find(|n| document.names(other).any(|o| o == *n))
            {
                let reason = format!(
                    "a {other} has this name as well. Hint: names are prefixes of columns: give each thing its own"
                );
                return Err(document.error_of_name(table, twice, Problem::refused(reason)));
            }
        }
    }
    Ok(())
}

fn unknown<'n>(
    document: &Document,
    table: &str,
    name: &str,
    kind: &str,
    known: impl Iterator<Item = &'n str>,
) -> SceneError {
    document.error_of_name(table, name, no_such(name, kind, known))
}

fn bearing(
    document: &Document,
    name: Option<&str>,
    bodies: &[&str],
    shared: &mut Vec<DefaultUsed>,
) -> Result<PlacedBearing, SceneError> {
    let mut scoped = match name {
        Some(name) => document.scoped(name),
        None => document.common(),
    };
    let (carriers, reversed, places) = {
        let mut reader = Reader::new(&scoped);
        let inner = carrier(&reader, 0, "bearing.inner_on", bodies)?;
        let outer = carrier(&reader, 1, "bearing.outer_on", bodies)?;
        let at = reader.given_number("bearing.inner_at").unwrap_or(0.0);
        let outer_at = reader.given_number("bearing.outer_at").unwrap_or(at);
        let reversed = matches!(scoped.value("bearing.reversed"), Some(Checked::Boolean(true)));
        for (side, (name, body, at)) in
            [("inner", inner, at), ("outer", outer, outer_at)].into_iter().enumerate()
        {
            let on = body.map_or(OWN_RACES[side], |body| bodies[body]);
            reader.follow(&format!("bearing.{name}_on"), on.to_string());
            reader.follow(&format!("bearing.{name}_at"), at);
        }
        reader.follow("bearing.reversed", reversed);
        let placed = |body: Option<usize>, at| match body {
            Some(index) => Carrier::Body { index, at },
            None => Carrier::Own { at },
        };
        let carriers = ([placed(inner, at), placed(outer, outer_at)], [inner, outer]);
        (carriers, reversed, reader.into_defaults_used())
    };
    let (carriers, on) = carriers;
    if on[0].is_some() && on[0] == on[1] {
        let reason = "both races would be on this body. Hint: write outer_on = \"outer_race\", or another body";
        return Err(scoped.refused("bearing.outer_on", reason));
    }
    for (race, body) in OWN_RACES.iter().zip(on) {
        let Some(body) = body else { continue };
        let of_race =
            |path: &str| path.strip_prefix(race).is_some_and(|rest| rest.starts_with('.'));
        if let Some(key) = scoped.given_keys().map(|key| key.path).find(|path| of_race(path)) {
            let reason = format!(
                "this race is on body.{}. Hint: write loads and motions in [body.{}]",
                bodies[body], bodies[body]
            );
            return Err(scoped.refused(key, reason));
        }
        if *race == OWN_RACES[0] {
            let of_body = document.scoped(bodies[body]);
            scoped.take_over(&of_body, "body.speed", "inner_race.speed");
            require_speed(&scoped, &of_body)?;
        }
    }
    let (mut scene, mut housing) = match scoped.first_below("housing") {
        Some(_) => in_housing(&scoped)?,
        None => {
            refuse_no_housing(document, &scoped, name)?;
            (resolve_bearing(&scoped)?, None)
        }
    };
    if let (Some(body), Some(_)) = (on[1], &housing) {
        let reason = format!(
            "the outer race is on body.{}, not in a bore. Hint: leave out outer_on, or the housing",
            bodies[body]
        );
        return Err(scoped.refused("bearing.outer_on", reason));
    }
    if let Some(PlacedHousing { settings, solid }) = housing.as_mut().filter(|_| name.is_some()) {
        for used in settings.defaults_used.iter_mut().chain(&mut solid.defaults_used) {
            used.name(&scoped);
        }
    }
    if let Some(body) = on[1] {
        let speed = Reader::new(&document.scoped(bodies[body])).profile("body.speed");
        scene.outer_speed = speed.map(|speed| speed.value(0.0));
    }
    for (race, _) in OWN_RACES.iter().zip(on).filter(|(_, body)| body.is_some()) {
        forget_race(&mut scene, race);
    }
    scene.defaults_used.extend(places);
    name_defaults(&mut scene, &scoped, name, shared);
    Ok(PlacedBearing { name: name.map(str::to_string), carriers, reversed, scene, housing })
}

/// Refuses a solid without a housing; a common solid may be those of the other bearings.
fn refuse_no_housing(
    document: &Document,
    scoped: &Document,
    name: Option<&str>,
) -> Result<(), SceneError> {
    if document.names("housing").next().is_none() {
        return refuse_solid(scoped);
    }
    let Some(own) = name.filter(|name| document.names("solid").any(|solid| solid == *name)) else {
        return Ok(());
    };
    let reason = format!(
        "this bearing has no housing whose solid it could be. Hint: add [housing.{own}], or leave it out"
    );
    Err(document.error_of_name("solid", own, Problem::refused(reason)))
}

/// Requires a speed of the body under the inner race for the centrifugal force of the balls.
fn require_speed(bearing: &Document, body: &Document) -> Result<(), SceneError> {
    let counts = bearing.value("ball_forces.centrifugal");
    if !matches!(counts, Some(Checked::Boolean(true))) || bearing.is_given("inner_race.speed") {
        return Ok(());
    }
    let because = " with `ball_forces.centrifugal = true`".to_string();
    let example = format!("`speed = \"1000 rpm\"` to [{}]", body.shown("body", true));
    Err(body.error_here("body.speed", Problem::Missing { because, example }))
}

/// The body of a race; `None` for a race that is a body of its own.
fn carrier(
    reader: &Reader,
    side: usize,
    key: &str,
    bodies: &[&str],
) -> Result<Option<usize>, SceneError> {
    let document = reader.document;
    let Some(name) = text(document, key) else {
        return match (side, bodies.len()) {
            (0, 1) if text(document, "bearing.outer_on").as_deref() != Some(bodies[0]) => {
                Ok(Some(0))
            }
            (0, 0 | 1) | (1, _) => Ok(None),
            _ => {
                let reason = format!(
                    "there are several bodies: {}. Hint: say which one carries the inner race, or \"inner_race\"",
                    bodies.join(", ")
                );
                Err(document.refused(key, reason))
            }
        };
    };
    if name == OWN_RACES[side] {
        return Ok(None);
    }
    match bodies.iter().position(|body| *body == name) {
        Some(index) => Ok(Some(index)),
        None => Err(document.error(key, no_such(&name, "body", bodies.iter().copied()))),
    }
}

/// Drops defaults of a race that is part of another body.
fn forget_race(scene: &mut Scene, race: &str) {
    let of_race = |used: &DefaultUsed| {
        used.key == race || used.key.strip_prefix(race).is_some_and(|rest| rest.starts_with('.'))
    };
    scene.defaults_used.retain(|used| !of_race(used));
    scene.dynamics.defaults_used.retain(|used| !of_race(used));
}

/// Names defaults once if several bearings share them, and with the bearing's name otherwise.
fn name_defaults(
    scene: &mut Scene,
    scoped: &Document,
    name: Option<&str>,
    shared: &mut Vec<DefaultUsed>,
) {
    if name.is_none() {
        return;
    }
    let of_bearing = |key: &str| {
        ["bearing", "inner_race", "outer_race"].contains(&key.split('.').next().unwrap_or_default())
    };
    for list in [&mut scene.defaults_used, &mut scene.dynamics.defaults_used] {
        for used in list.iter_mut().filter(|used| of_bearing(&used.key)) {
            used.name(scoped);
        }
        list.retain(|used| !shared.contains(used));
        shared.extend(list.iter().filter(|used| !of_bearing(&used.key)).cloned());
    }
}

/// Refuses housings with different methods.
fn refuse_mixed_methods(document: &Document, bearings: &[PlacedBearing]) -> Result<(), SceneError> {
    let method = |placed: &PlacedBearing| placed.housing.as_ref().map(|h| h.settings.method);
    let first = bearings.iter().find_map(method);
    let other = bearings.iter().find(|placed| method(placed).is_some_and(|m| Some(m) != first));
    let Some(PlacedBearing { name: Some(name), .. }) = other else { return Ok(()) };
    let reason = "this housing and another are solved in different ways. Hint: give all the same method, in [housing]";
    Err(document.scoped(name).error("housing.method", Problem::refused(reason)))
}

/// Refuses bodies with the column names of a race or a cage.
fn refuse_shared_columns(document: &Document, scene: &AssemblyScene) -> Result<(), SceneError> {
    for body in &scene.bodies {
        for placed in &scene.bearings {
            let before = placed.name.as_ref().map_or(String::new(), |name| format!("{name}_"));
            let parts = [("inner", "inner race"), ("outer", "outer race"), ("cage", "cage")];
            let same = parts.into_iter().find(|(part, _)| format!("{before}{part}") == body.name);
            let Some((_, part)) = same else { continue };
            let of =
                placed.name.as_ref().map_or(String::new(), |name| format!(" of bearing {name}"));
            let reason = format!(
                "columns of the {part}{of} begin with this name. Hint: choose another name, such as hub"
            );
            let problem = Problem::refused(reason);
            return Err(document.error_of_name("body", &body.name, problem));
        }
    }
    Ok(())
}

/// Refuses bodies without a bearing or spring.
fn refuse_free_bodies(document: &Document, scene: &AssemblyScene) -> Result<(), SceneError> {
    for (index, body) in scene.bodies.iter().enumerate() {
        let carries = scene
            .bearings
            .iter()
            .flat_map(|bearing| bearing.carriers)
            .any(|carrier| matches!(carrier, Carrier::Body { index: on, .. } if on == index));
        let joined = scene
            .springs
            .iter()
            .any(|spring| spring.ends.iter().any(|end| end.at == SpringAt::Body(index)));
        if !carries && !joined {
            let reason = format!(
                "nothing is joined to this body. Hint: name it in a bearing (inner_on = {0:?}) or a spring (from = {0:?}), or leave it out",
                body.name
            );
            return Err(document.error_of_name("body", &body.name, Problem::refused(reason)));
        }
    }
    Ok(())
}

fn body(
    document: &Document,
    name: &str,
    ball: f64,
    needs_mass: bool,
    defaults: &mut Vec<DefaultUsed>,
) -> Result<SceneBody, SceneError> {
    let scoped = document.scoped(name);
    let mut reader = Reader::new(&scoped);
    let parts = ["mass", "axial", "transverse"].map(|key| format!("body.inertia.{key}"));
    let beam = beam(&mut reader)?;
    let inertia = if beam.is_some() {
        // It follows from the beam.
        NO_INERTIA
    } else if needs_mass || parts.iter().any(|key| reader.is_given(key)) {
        let missing = |path: &String| {
            let (_, key) = keys::find(path).ok_or_else(|| reader.missing(path, ""))?;
            let because = format!(" of body.{name}, for a run and with gravity");
            let example = format!("`inertia.{} = {}` to [body.{name}]", key.name(), key.example());
            Err(scoped.error(key.path, Problem::Missing { because, example }))
        };
        let [mass, axial, transverse] =
            parts.each_ref().map(|k| reader.given_number(k).map_or_else(|| missing(k), Ok));
        let inertia = Inertia { mass: mass?, axial: axial?, transverse: transverse? };
        check_inertia(inertia.axial, inertia.transverse)
            .map_err(|problem| reader.document.error(&parts[1], problem))?;
        inertia
    } else {
        NO_INERTIA
    };
    let race = DrivenBody {
        inertia,
        drives: reader.drives("body", ball)?,
        rotation: rotation(&mut reader, "body"),
        foundation_stiffness: foundation(&reader, "body", "stiffness"),
        foundation_damping: foundation(&reader, "body", "damping"),
    };
    let rotating_load = rotating_load(&mut reader, "body")?;
    let unbalance = reader.given_number("body.unbalance").unwrap_or(0.0);
    if unbalance != 0.0 {
        check_unbalance(&race, unbalance)
            .map_err(|problem| reader.document.error("body.unbalance", problem))?;
    }
    reader.note_named(defaults);
    let beam = beam.map(Box::new);
    Ok(SceneBody { name: name.into(), race, rotating_load, unbalance, beam })
}
