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
    // Keys of runs after those of geometry; outputs and sweeps last.
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
    text.push_str("| `generate` | keys of `[solid.mesh]` |\n|---|---|\n");
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
            Need::BySet { dissertation, engineering } => {
                let of = |(value, reason): (&str, &str)| format!("`{value}` ({reason})");
                format!("engineering: {}; dissertation: {}", of(engineering), of(dissertation))
            }
        };
        let (kind, allowed) = kind_and_range(key);
        let _ =
            writeln!(text, "| `{}` | {kind} | {allowed} | {default} | {} |", key.name(), key.doc);
    }
    text.push('\n');
}

fn several(dimension: Dimension) -> String {
    let noun = noun(dimension);
    noun.strip_suffix('y').map_or(format!("{noun}s"), |stem| format!("{stem}ies"))
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
            (format!("list of increasing {}", several(dimension)), format!("each {range}"))
        }
        Kind::QuantityList(dimension, _) => {
            (format!("list of {}", several(dimension)), format!("each {range}"))
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

<!-- Made from the key tables in src/scene/tables. After changing one: SCENE_DOCS=write cargo test --release --test scene scene_docs -->

A scene is a TOML file, or a JSON file of the same structure. Every dimensional value is a text with a number and a
unit, `\"20.047 mm\"`; a number without a unit is refused. Unknown keys are refused. `bearing check SCENE` reports
the first error with file, line and column, the allowed range and a hint; `bearing schema` prints a JSON Schema for editors.

Axes: X axial, Y lateral, Z up. Ball azimuths run from +Y towards +Z.

## Inheriting a scene
With `base = \"rotor.toml\"` at the top, a scene inherits another file and overrides selected keys. A study of six fits then needs one full scene and six short ones.

- Keys are overridden one by one. A key also replaces inherited keys that it excludes: a diametral clearance replaces a radial one.
- Lists of tables are replaced as a whole; an empty list, `load = []`, removes that of the base.
- Named tables are added to those of the base, or merged with the table of the same name. Assumptions are merged by name. A `[sweep]` replaces that of the base.
- `without = \"solid.mesh, sensor.top\"` removes a table and a sensor of the base before the scene's own keys apply. Removing a table such as `body` also removes its named tables.
- A key without a name does not override keys that the base gives under a name. A key that has no effect for this reason is refused.
- The path of a base is relative to the scene's folder, the path of a mesh to the file that names it. A base may have a base, up to eight in all, and may be incomplete. Errors name the
  file that is wrong. Packs contain the bases in or below the scene's folder.

## Several bearings, bodies, springs
`[bearing.left]`, `[body.shaft]`, `[spring.coupling]` are tables with names of your choice, any number of each; `inner_race`, `outer_race`,
`housing` and `solid` use the names of bearings. A named table has the keys of the table without a name and inherits its values
key by key, including tables inside it: `[bearing]` has what all bearings have in common, and
`[solid.left.mesh]` overrides keys of `[solid.mesh]`. Lists are inherited as a whole: `[[solid.left.fixed]]` replaces all `[[solid.fixed]]`
for that housing; likewise `set`, `load` and `probe`. Keys of `--vary` and `[sweep]` may contain names, `bearing.left.clearance.radial`, also
of a table that the scene does not have, `housing.left.fit.radial`. Tables of a list are numbered from 1: `body.shaft.beam.disc.1.mass`
is the mass of the first disc.

A name starts with a letter and consists of up to 32 letters, digits and underscores. `inner_race`, `outer_race`, `ground`, `inner` and `outer` are
reserved. A name very similar to a key or table of the same level (`[bearing.cagee]`) is refused as a typing error. A bearing, a
body and a spring must have different names.

Races are mounted on bodies (`inner_on`, `outer_on`) at axial positions (`inner_at`, `outer_at`). A race that is mounted on none is a body of its own, described by
`[inner_race]` or `[outer_race]`. Columns, tables and plots of a bearing start with its name, `left_inner_z`, those of a body with the body's name, `shaft_z`.
X of races, balls and cage is measured from the bearing's position (`inner_at`) in all results; X of a body from the origin. Results of a
`reversed` bearing are in the scene's axes too: azimuths, tilts, speeds and slip. Only contact angles, `ball_phase` and the profiles of races are in the bearing's own axes.

`quasi-static` housings may have several bearings; the result is a sequence of equilibria. An outer race with `axial = \"free\"` has an equilibrium only without an axial
force on it; in a `reduced` run that starts from nominal positions it slides.

";

const GENERATORS_INTRODUCTION: &str = "\
## Generated meshes
Bars start at the origin and extend along X, shafts from their first station. Rings, cages and housings are centred on the
origin with their axis along X. Sets: `x_low` and `x_high`, and `y_low` to `z_high` of bars and blocks; `inner`, `outer` of rings and
cages; `outer` and `station_N` of shafts; `pocket_N` of cages; `bore` and `fixed` (the surface that the source fixes) of housings.
A bushing is centred on the origin with its axis along X; for a quarter, the origin is the centre of the whole bushing. Its sets are `inner` and `outer`, bonded to the
sleeves, `x_low` and `x_high`, and `ends`, the free faces. For a quarter, `x_low` and `y_low` are the planes of symmetry, and `x_high` and `ends` the one free face.

";

const PROFILES_INTRODUCTION: &str = "\
## Profiles
A value described as \"or profile\" may change over time. A plain quantity is constant. Times are measured from the start
of the run, up to 10000 s. Durations are positive, and times of a table increase. Statics uses the value at t = 0; for rubber, the value at the end of the run.

";

const DIMENSIONS_INTRODUCTION: &str = "\
## Units
The space between number and unit is optional. Numbers have a decimal point and an optional exponent (`1.5e3 N`). For units
that are powers of ten of the SI unit, the value is the double nearest to the decimal number. With `units = \"SI\"` at the top
of a file, a number without a unit is in SI: the unit of the table with the value 1.

";

const RELATIONS: &str = "
## Derived sizes
**Deep-groove.** With `C` the radial clearance, `C = R_outer - R_inner - 2 r_ball`, positive for a gap; the diametral
clearance is `2 C`. Race radii are groove-bottom radii, measured from the axis. Give any three of the two race radii, the ball and
the clearance. If all four are given, the size of the part named by `clearance.through` is computed, and its given
size is the nominal one: for the ball, the one that `conformity` and `osculation` refer to.

**Angular-contact.** Give pitch radius, contact angle, ball and grooves. The parts then just touch at that angle, with the
inner race's groove centres on the `+X` side and the outer race's on the `-X` side. A displacement of the inner race along `+X` loads the balls. A clearance
(default 0) is the radial displacement of the inner race from there to contact, applied to the ball or a race.

**Checks over several keys.** The groove radius is between 1 and 10 times the ball radius; balls fit side by side on
the pitch circle; a ball is not larger than the cage pocket; the clearance is at most 5 % of the ball radius, and
a nominal size differs from the computed one by at most the clearance and 1 % of the ball radius; the bore is inside and the outer radius outside the grooves; the cage's inner radius is less than its outer radius;
displacements are at most a ball radius.

## Input of runs
`statics` and a run use the same scene; a run needs `numerics.end`. Results list every default that was used.

**Masses.** A race without `inertia` is a ring with its groove, of the race's density: bore (or outer) radius 0.3 ball diameters
behind the groove bottom, shoulders 0.2 ball diameters high, 1.68 ball diameters long, unless the scene gives these sizes.
Wall and length are those of Table 2.2. The axial offset of an angular-contact bearing's grooves is neglected in the mass.

**Cage.** A run includes the cage if the scene gives `pocket_radius`, `inner_radius`, `outer_radius`, `mass` and `guidance`, and
`race_clearance` for a race-guided cage. Otherwise the cage is omitted and the reason is printed. Its length follows from its mass if not given.

**Outer race.** `fixed` has no degrees of freedom. `5-dof` rotates about X at the prescribed `speed`, zero unless given; `6-dof` rotates freely under moments. Loads, displacements, inertia and foundation of a
fixed race are refused. The foundation is unstressed in the race's initial position.

**Start.** `equilibrium` is the equilibrium of both races under the loads at t = 0. A moving outer race rests on its springs; one
without a support is refused. Rotating forces act in their direction at t = 0: the rotating load at its phase, the
unbalance along the inner race's own Y, with the speed at t = 0. (Their mean over a revolution is zero, and a run that started from it would start
with an impact.) If the inner race's speed is prescribed and not zero at t = 0, all parts start with the velocity at which their
equilibrium moves: balls roll without slip on the pitch circle, and traction, if any, keeps them in their orbit.
This velocity is the orbital speed times the derivative of the equilibrium with respect to the ball phase, plus the change of loads. It follows from equilibria f0, f1 and f2 at
0, dt and 2 dt as (4 (f1 - f0) - (f2 - f0)) / (2 dt); balls pass 1 % of their pitch in dt, which is at most 0.1 ms. It is zero if these positions are not on one smooth curve.
The start includes the weight of the races. `statics` of a single bearing with a fixed outer race leaves that weight out; all other equilibria include it.

**Nominal positions.** With `start = \"nominal\"` the balls are on the pitch circle of the outer race at x = 0, with the orbital speed times the pitch radius along the orbit. Prescribed coordinates have
their values at t = 0. Free coordinates start at their rest position, zero for an inner race alone, without velocity; the loads act at once.

**Accuracy.** `accuracy` limits the estimated error of every moving body and ball: positions, and velocities over the frequency of the body on its contacts, relative to the largest approach so far. Each step may
use 2 % of it. If the race is prescribed in all coordinates, the motion of the balls alone determines the step.

**Traction.** `b` and `c` are plain numbers with `slide-to-roll`, in s/m with `slip-speed`. Both curves are (b x - d) exp(-c x) + d, zero at rest; no curve may exceed 2.

## A flexible solid
A scene with `[solid]` instead of `[bearing]` is input of `check`, `plan`, `statics`, `modes` and `run`; its results are described
in [results.md](results.md).

**Mesh files.** Physical groups of Gmsh and node, element and surface sets of Abaqus keep their names. In a deck with a part and an
instance, a set of the part is `instance.set`; the case of letters does not count in names of a deck. A set that cannot be read is skipped
with a note, and refused with its line if the scene uses it. The unit of length must be given. A mesh with faults (inverted elements,
slivers, coincident nodes, cavities, loose parts) is refused with their number and the worst position.

**Supports and loads.** A node may belong to two fixed sets if both prescribe the same displacement. A force on a surface is distributed in
proportion to the area of each node, on other sets evenly. Loads keep their directions; pressure acts on the
undeformed area along the undeformed normal and does not follow the body. Statics uses loads and displacements at
t = 0 and needs supports that prevent rigid-body motion. Modes use the supports and ignore loads.

**Runs.** They start at rest and undeformed except for `velocity` and `spin`, and end at the whole step nearest to `numerics.end`.
A step beyond the stability limit is refused, and the limiting element is named.

## A bearing in a housing
A scene with a bearing, `[solid]` and `[housing]` is input of `check`, `plan`, `statics` and `run`. The outer race (`motion = \"5-dof\"`)
is fitted in a surface of the solid about X. Contact follows (2.16) to (2.19), without friction by default, so that a shoulder or ring supports the race
axially unless `axial = \"free\"`. The solid must have supports; it has no velocity, spin, probes or modes here.

**Friction.** `friction = { law = \"stick-slip\" }` in `[housing]` with `method = \"explicit\"` attaches a tangential spring to each node of the bore (4.2.4.2), which slips at `coefficient` times
the normal load. Friction then supports the race axially (`axial` is `free` unless given), and about its axis with `motion = \"6-dof\"`. A large `stretch` under a torque makes a race whirl: see
decision 47.

**Methods.** `quasi-static` condenses the linear housing onto its bore and solves one equilibrium of bearing and bore per output row, with balls
orbiting as in pure rolling. Traction, cage, damping and inertia are neglected; `plan` and `run` estimate the effect of
inertia. It needs constant loads on outer race and solid, and no torque or unbalance. `explicit` integrates bearing and housing with separate steps, coupled by
impulses. `reduced` represents a linear housing by modes, with inertia, integrated with the bearing: component modes up to `housing.modes_to`, with lumped masses
as in explicit steps, and static correction modes for pressure on the bore, weight and loads; `plan` and summaries report what is cut off. It starts in the common
equilibrium of bearing and housing or, with `numerics.start = \"nominal\"`, like `explicit`: the housing undeformed, the outer race in its initial position, inner race and
balls in equilibrium with it. `rigid` fixes the outer race and does not read the solid's mesh. `plan` prints the cost of the other methods.

**Fit.** `fit` is the interference; with `outer_radius` it is the difference from the cylinder fitted to the contact nodes. In a run an interference grows over
`fit_ramp`; a clearance is present from the start. `statics` uses the whole fit and the loads at t = 0. With
`ball_forces.gravity` both races have weight. A bore radius more than 1 % off the race's outer radius, or a bore off centre, is refused: was its unit mm or m?

**Shape of the bore.** Fits are micrometres, and ten-node elements touch the race at mid-side nodes. For four-node elements of a file with
`order = 2`, the mid-side nodes of the bore are placed on the cylinder through its corners, and a note is printed. A file of ten-node elements whose bore edges are
straight is refused: mid-side nodes must be within a quarter of the arc height L²/8R. `check` and summaries have `bore_out_of_round`, the
largest distance of a contact node from the fitted cylinder, and `bore_off_centre`. A value above 0.05 % of the radius, slightly more than IT7 allows, is refused;
above 10 nm and 1 % of an interference a note states the effect. Coordinates rounded to 1e-4 mm cause 0.05 um and peak pressures that are several times too large.

**Runs** end at the row nearest to `numerics.end`. Fields are written at the end, and every `numerics.fields_interval` if it is given.

## Sweeps
Values are a list, `[\"5 um\", \"0 um\"]` or `\"5 um, 0 um\"`, or a range `\"low .. high / count\"` that includes both ends. Varying a
key replaces keys that it excludes: varying `bearing.clearance.radial` replaces a diametral clearance.
Texts, lists and `ball_forces.gravity` cannot be varied. A varied profile becomes a constant.
With `of = \"runs\"`, or `bearing sweep --of runs`, each point is a run ([ensembles](guide/run.md#ensembles)).
";
