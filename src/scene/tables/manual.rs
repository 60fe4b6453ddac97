//! The key table as the reference `docs/scene.md`.

use crate::scene::resolve::profile::{FORMS, Member};
use crate::scene::resolve::solid_mesh::generators;
use crate::scene::tables::keys::{KEYS, Key, Kind, Need, TABLES, Table};
use crate::scene::tables::schema::{noun, range_text};
use crate::scene::text::units::{Dimension, plain};
use std::fmt::Write;

/// The text of `docs/scene.md`.
pub fn reference_markdown() -> String {
    let mut text = String::from(INTRODUCTION);
    table_markdown(&mut text, "", "Top of the file", "");
    // What moves a bearing lies after what it is, outputs and sweeps last.
    let order = [
        "assumptions",
        "bearing",
        "inner_race",
        "outer_race",
        "body",
        "spring",
        "sensor",
        "ball_forces",
        "traction",
        "contact_damping",
        "ball_contact",
        "housing",
        "solid",
        "modes",
        "numerics",
    ];
    let mut tables: Vec<&Table> = TABLES.iter().collect();
    tables.sort_by_key(|table| {
        let top = table.path.split('.').next().unwrap_or_default();
        order.iter().position(|name| *name == top).unwrap_or(order.len())
    });
    for table in tables {
        let heading = if table.list {
            format!("`[[{}]]`", table.path)
        } else {
            format!("`[{}]`", table.path)
        };
        table_markdown(&mut text, table.path, &heading, table.doc);
        let _ = writeln!(text, "```toml\n{}\n```\n", table.example.replace(" or {", "   # or {"));
    }
    generators_markdown(&mut text);
    profiles_markdown(&mut text);
    text.push_str(DIMENSIONS_INTRODUCTION);
    text.push_str("| quantity | units | SI value of one unit |\n|---|---|---|\n");
    for dimension in Dimension::ALL {
        let spellings: Vec<String> = dimension
            .units()
            .iter()
            .map(|unit| {
                let all: Vec<String> = unit.spellings.iter().map(|s| format!("`{s}`")).collect();
                all.join(" = ")
            })
            .collect();
        let values: Vec<String> =
            dimension.units().iter().map(|unit| plain(unit.scale.factor())).collect();
        let _ = writeln!(
            text,
            "| {} | {} | {} {} |",
            noun(dimension),
            spellings.join(", "),
            values.join(", "),
            dimension.si_unit()
        );
    }
    text.push_str(RELATIONS);
    text
}

fn generators_markdown(text: &mut String) {
    text.push_str(GENERATORS_INTRODUCTION);
    text.push_str(
        "| `generate` | keys of `[solid.mesh]`; those in brackets may be left out |\n|---|---|\n",
    );
    for (name, keys) in generators() {
        let _ = writeln!(text, "| `{name}` | {keys} |");
    }
    text.push('\n');
}

fn profiles_markdown(text: &mut String) {
    text.push_str(PROFILES_INTRODUCTION);
    text.push_str("| profile | entries | meaning |\n|---|---|---|\n");
    for form in FORMS {
        let entries: Vec<String> = form
            .members
            .iter()
            .enumerate()
            .map(|(index, member)| match member {
                Member::Other(key) => match key.need {
                    Need::Default { value, .. } => format!("`{}` (default `{value}`)", key.path),
                    _ => format!("`{}`", key.path),
                },
                Member::Own(name) if index > 0 => format!("`{name}` (default 0)"),
                member => format!("`{}`", member.name()),
            })
            .collect();
        let _ = writeln!(text, "| `{}` | {} | {} |", form.example, entries.join(", "), form.doc);
    }
    text.push('\n');
}

fn table_markdown(text: &mut String, path: &str, heading: &str, doc: &str) {
    let _ = writeln!(text, "## {heading}");
    if !doc.is_empty() {
        let _ = writeln!(text, "{doc}");
    }
    text.push('\n');
    let rows: Vec<&Key> = KEYS.iter().filter(|key| key.table() == path).collect();
    if rows.is_empty() {
        return;
    }
    text.push_str("| key | value | allowed | default | meaning |\n|---|---|---|---|---|\n");
    for key in rows {
        let default = match key.need {
            Need::Required => "**required**".to_string(),
            Need::Optional => "none".to_string(),
            Need::Depends(how) => how.to_string(),
            Need::Default { value, reason } => format!("`{value}` ({reason})"),
        };
        let (kind, allowed) = kind_and_range(key);
        let _ =
            writeln!(text, "| `{}` | {kind} | {allowed} | {default} | {} |", key.name(), key.doc);
    }
    text.push('\n');
}

fn kind_and_range(key: &Key) -> (String, String) {
    let words = |choices: &[&str]| {
        choices.iter().map(|word| format!("`\"{word}\"`")).collect::<Vec<_>>().join(", ")
    };
    let range = range_text(key).unwrap_or_default();
    match key.kind {
        Kind::Text => ("text".to_string(), "any".to_string()),
        Kind::Boolean => ("boolean".to_string(), "`true`, `false`".to_string()),
        Kind::Integer { .. } => ("whole number".to_string(), range),
        Kind::Choice(choices) => ("word".to_string(), words(choices)),
        Kind::Choices(choices) => ("list of words".to_string(), words(choices)),
        Kind::Number(_) => ("number".to_string(), range),
        Kind::Quantity(dimension, _) => (noun(dimension).to_string(), range),
        Kind::Profile(dimension, _) => (format!("{} or profile", noun(dimension)), range),
        Kind::Either(kinds) => {
            let nouns: Vec<&str> = kinds
                .iter()
                .map(|kind| match kind {
                    Kind::Quantity(dimension, _) => noun(*dimension),
                    _ => "number",
                })
                .collect();
            (nouns.join(" or "), range)
        }
        Kind::Quantities(dimension, _) => {
            let noun = noun(dimension);
            let many =
                noun.strip_suffix('y').map_or(format!("{noun}s"), |stem| format!("{stem}ies"));
            (format!("list of increasing {many}"), format!("each {range}"))
        }
        Kind::TrueOrProfile(dimension, _) => {
            (format!("`true`, or {} or profile", noun(dimension)), range)
        }
        Kind::Vector(dimension, _) => {
            (format!("list of three: {}", noun(dimension)), format!("each {range}"))
        }
    }
}

const INTRODUCTION: &str = "\
# Scene reference

<!-- Made from the key tables in src/scene/key_table*.rs. After changing one: SCENE_DOCS=write cargo test --release --test scene scene_docs -->

A scene is a TOML file, or a JSON file of the same shape. Every dimensional value is a text of a number and a
unit, `\"20.047 mm\"`: nothing is guessed from a bare number. Unknown keys are refused. `bearing check SCENE` names
the first thing that is wrong, with file, line and column, the allowed range and what to do; `bearing schema` prints
a JSON Schema for editors.

Axes: X axial, Y lateral, Z up. Ball azimuths run from +Y towards +Z.

## A scene on another
`base = \"rotor.toml\"` at the top makes a scene of what that file says with its own keys laid over it: a study of six fits is one scene and six short ones.
Keys go one by one, those that exclude each other in place of each other (a diametral clearance of the scene for a radial one of its base); lists of tables are taken
whole, and an empty one, `load = []`, takes the base's away; tables with names add to those of the same name; assumptions go by their names; a `[sweep]` stands in place of the base's. What else the scene has not it names:
`without = \"solid.mesh, sensor.top\"` leaves a table and a sensor of the base out (a table such as `body` with those that have names) before the scene's own keys are laid over it. The base's name
counts from the scene's folder, a mesh from that of the file that names it. A base may have a base, up to eight in all, and need not be complete. Keys without a name do not reach names of the
base that say their own, as anywhere; where they reach nothing they are refused. Errors name the file that is wrong; packs hold bases below the scene's folder.

## Several bearings, bodies, springs
`[bearing.left]`, `[body.shaft]`, `[spring.coupling]` are tables with names of the user's, any number of each; `inner_race`, `outer_race`,
`housing` and `solid` take the names of bearings. A table with a name has the keys of the one without, and what stands in the one without
holds for all names that do not say otherwise, key by key and in tables inside it too: `[bearing]` is what all bearings have in common,
`[solid.left.mesh]` changes of `[solid.mesh]` what it says. Lists are taken whole: `[[solid.left.fixed]]` stands in place of all `[[solid.fixed]]`
for that housing, and so do `set`, `load` and `probe`. Keys of `--vary` and `[sweep]` take names too, `bearing.left.clearance.radial`, also those
of a table that the scene does not have, `housing.left.fit.radial`; tables of a list go by their numbers, counted from 1: `body.shaft.beam.disc.1.mass`
is the mass of the first disc.

A name begins with a letter and has letters, digits and underscores, up to 32. `inner_race`, `outer_race`, `ground`, `inner` and `outer` have a
meaning of their own and are no names; one that is much like a key or table beside it (`[bearing.cagee]`) is taken for a mistyped one; a bearing, a
body and a spring do not share one.

Races sit on bodies (`inner_on`, `outer_on`) at places along their axes (`inner_at`, `outer_at`); a race that sits on none is a body of its own, as
`[inner_race]` or `[outer_race]` say. Columns, tables and plots of a bearing begin with its name, `left_inner_z`, those of a body with its own, `shaft_z`.
X of races, balls and cage counts from where the bearing sits (`inner_at`) in all results, of equilibria and runs; that of a body from the origin. A
`reversed` bearing is read in the scene's axes as well: azimuths, tilts, speeds and slip; only contact angles are its own, and what is said of its parts, `ball_phase` and
dents.

Several bearings run in `quasi-static` housings too, one equilibrium after the other; an outer race with `axial = \"free\"` has one only where nothing pushes it
along its axis, though a `reduced` run that starts in nominal positions slides it.

";

const GENERATORS_INTRODUCTION: &str = "\
## Meshes that are made
Bars begin at the origin and lie along X, shafts at their first station; rings, cages and housings are centred on the
origin, their axis X. Sets: `x_low` and `x_high`, and `y_low` to `z_high` of bars and blocks; `inner`, `outer` of rings and
cages; `outer` and `station_N` of shafts; `pocket_N` of cages; `bore` and `fixed` (what the source holds) of housings.
A whole bushing is centred on the origin, its axis X; of a quarter the origin is in the middle of the whole one. Sets of it: `inner` and `outer`, where sleeves are
bonded, `x_low` and `x_high`, and `ends`, the faces that are free; of a quarter `x_low` and `y_low` are the planes of symmetry, `x_high` and `ends` the one free face.

";

const PROFILES_INTRODUCTION: &str = "\
## Profiles
Where the reference says \"or profile\", a value may change over time. A plain quantity is constant. Times count from the start
of the run, up to 10000 s; durations are positive and times of a table increase. Statics takes the value at t = 0, of rubber that at the end of the run.

";

const DIMENSIONS_INTRODUCTION: &str = "\
## Units
A space between number and unit may be left out. Numbers have a decimal point, and may have an exponent (`1.5e3 N`). In units
that are powers of ten of SI the value is the double nearest to the decimal number written.

";

const RELATIONS: &str = "
## Sizes that follow from others
**Deep-groove.** With `C` the radial clearance, `C = R_outer - R_inner - 2 r_ball`, positive for a gap; the diametral
clearance is `2 C`. Race radii are groove-bottom radii from the axis. Give any three of the two race radii, the ball and
the clearance. If all four are given, the part named by `clearance.through` takes the size that follows, and its given
size is only the nominal one: for the ball, the one that `conformity` and `osculation` refer to.

**Angular-contact.** Give pitch radius, contact angle, ball and grooves; the parts then just touch at that angle, with the
inner race's groove centres at `+X` and the outer one's at `-X`. An inner race pushed along `+X` loads the balls. A clearance
(default 0) is the radial travel of the inner race from there to contact, made through the ball or a race.

**Checks over several keys.** Groove radius more than the ball radius and less than ten times it; balls fit side by side on
the pitch radius; ball not larger than the cage pocket; clearance at most 5 % of the ball radius, likewise the distance between
nominal and resulting size; bore inside and outer radius outside the grooves; cage inner radius less than the outer one;
displacements at most a ball radius.

## What a run takes from a scene
A scene serves `statics` and a run alike; a run needs `numerics.end`. Every default that fills a hole is named with the results.

**Masses.** A race without `inertia` is a ring with its groove, of the race's density: bore (or outer) radius 0.3 ball diameters
behind the groove bottom, shoulders 0.2 ball diameters high, 1.68 ball diameters long, unless the scene gives these sizes.
The grooves' axial offset in an angular-contact bearing is left out of the mass. Wall and length are those of Table 2.2.

**Cage.** A cage takes part in a run if the scene gives `pocket_radius`, `inner_radius`, `outer_radius`, `mass` and `guidance`, and
`race_clearance` where a race guides it; otherwise it is left out, with the reason. Its length follows from its mass if not given.

**Outer race.** `fixed` has no equations. `5-dof` turns about X at the given `speed`, zero unless given, `6-dof` as moments turn it. Loads, motions, inertia and foundation of a
fixed race are refused. The foundation is at rest where the race starts.

**Start.** `equilibrium` is that of both races under the loads at t = 0: a moving outer race rests on its springs, and one that
nothing holds is refused. Forces that turn stand still for it in their direction at t = 0, the rotating load at its phase, the
unbalance along the inner race's own Y, with the speed of that time. Their mean over a turn would be zero and would start every run
with a blow. Where the inner race's speed is given and not zero at t = 0, everything also starts with the velocity at which its
equilibrium moves on, balls roll without slip on the pitch circle, and traction, where there is any, holds them in their orbit.

**Traction.** `constant`: `coefficient`, `regularisation_speed`. `slide-to-roll`: `b`, `c` (plain numbers), `d`, `entrainment_floor`.
`slip-speed`: `b`, `c` (s/m), `d`. The two curves are (b x - d) exp(-c x) + d, zero at rest; no curve may exceed 2.

## A flexible solid
A scene with `[solid]` in place of `[bearing]` goes to `check`, `plan`, `statics`, `modes` and `run`; its results are described
in [results.md](results.md).

**Mesh files.** Physical groups of Gmsh and node, element and surface sets of Abaqus keep their names. The unit of the numbers
must be given. A mesh with faults (inverted elements, slivers, nodes at one place, cavities, loose parts) is refused with
the number of them and the worst place.

**Supports and loads.** A node of two held sets may be held by both if they move it alike. A force on a surface is spread in
proportion to the area that each node carries, on other sets evenly. Loads keep their directions; pressure acts on the
undeformed area along the undeformed normal and does not follow the body. Statics takes loads and displacements at
t = 0, and needs a body that cannot move as a whole; modes hold what is held and ignore loads.

**Runs.** They start at rest and undeformed but for `velocity` and `spin`, and end at the whole step nearest to `numerics.end`.
A step beyond the stability limit is refused with the element that sets it.

## A bearing in a housing
A scene with a bearing, `[solid]` and `[housing]` goes to `check`, `plan`, `statics` and `run`. The outer race (`motion = \"5-dof\"`) sits
in a surface of the solid about X; contact is (2.16) to (2.19), without friction unless it is asked for, so that something beside the bore holds the race
along its axis unless `axial = \"free\"`. The solid is held, and has no velocity, spin, probes or modes here.

**Friction.** `friction = { law = \"stick-slip\" }` in `[housing]` with `method = \"explicit\"` attaches a spring to each node of the bore (4.2.4.2), which slips at `coefficient` times
the normal load. It then holds the race along its axis (`axial` is `free` unless given), and about it where `motion = \"6-dof\"`. Long springs (`stretch`) under a torque make a race whirl: see
decision 47.

**Methods.** `quasi-static` condenses the linear housing onto its bore and solves one equilibrium of bearing and bore a row, balls
going round as in pure rolling; traction, cage, damping and inertia are left out, and `plan` and `run` say what inertia would
change. It takes constant loads on outer race and solid, and no torque or unbalance. `explicit` moves both in steps of their own that exchange
impulses. `reduced` lets a linear housing move in some shapes, with inertia, in the bearing's own steps: natural shapes up to `housing.modes_to`, with lumped masses
as of explicit steps, and static answers to pressure on the bore, to weight and to loads; `plan` and summaries say what is cut off. It starts in the common
equilibrium of bearing and housing, or with the start `nominal` of `numerics.start` as `explicit` does: the housing undeformed, the outer race in its first place, inner race and
balls in equilibrium with it. `rigid` fixes the outer race: the solid's mesh is not even read. `plan` says what the other way would cost.

**Fit.** `fit` is the interference; with `outer_radius` it is the difference to the cylinder nearest to the bore's nodes under the race. In a run it grows in over
`fit_ramp`; a clearance is there from the start. `statics` has the whole fit, and the loads of t = 0. Weights of both races count with
`ball_forces.gravity`. A bore that is more than 5 % off the race's outer radius or out of centre is refused: was its unit mm or m?

**Shape of the bore.** Fits are micrometres, and ten-node elements touch the race at mid-side nodes. A file's four-node elements raised by
`order = 2` get those of the bore on the cylinder through its corners, and a note says so. A file of ten-node elements whose bore edges are
straight is refused: mid-side nodes must miss less than a quarter of their arcs' height L²/8R. `check` and summaries have `bore_out_of_round`, the
largest distance of a contact node from the fitted cylinder, and `bore_off_centre`. Beyond 0.5 thousandths of the radius, a little more than a bore to IT7 may have, it is refused;
beyond 10 nm and 1 % of an interference a caution says what it changes. Coordinates rounded to 1e-4 mm make 0.05 um, and peak pressures several times too large.

**Runs** end at the row nearest to `numerics.end`. Fields are written at the end, and every `numerics.fields_interval` if that is given.

## Sweeps
Values are a list, `[\"5 um\", \"0 um\"]` or `\"5 um, 0 um\"`, or a range `\"low .. high / count\"` with both ends included. Varying a
key takes away the keys that exclude it: varying `bearing.clearance.radial` replaces a diametral clearance.
Texts, lists and `ball_forces.gravity` cannot be varied. A varied profile becomes a constant.
";
