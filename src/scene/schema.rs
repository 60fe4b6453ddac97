//! The key table as JSON Schema (for editors) and as the reference `docs/scene.md`.

use crate::scene::keys::{self, KEYS, Key, Kind, Need, Range, TABLES};
use crate::scene::profile::{FORMS, Member};
use crate::scene::units::{Dimension, plain};
use serde_json::{Map, Value, json};
use std::fmt::Write;

const NUMBER_PATTERN: &str = r"[+\-\u2212]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+\-]?[0-9]+)?";

/// JSON Schema (draft 2020-12) of a scene. Relations between keys that need arithmetic, such as a
/// ball that fits its pocket, are left to `bearing check`.
pub fn json_schema() -> Value {
    let mut schema = table_schema("");
    schema.insert("$schema".into(), json!("https://json-schema.org/draft/2020-12/schema"));
    schema.insert("title".into(), json!("Scene of bearing-dynamics"));
    let definitions: Map<String, Value> = Dimension::ALL
        .into_iter()
        .map(|dimension| (definition_name(dimension), quantity_schema(dimension)))
        .collect();
    let profiles = Dimension::ALL
        .into_iter()
        .filter(|dimension| profile_dimensions().any(|used| used == *dimension))
        .map(|dimension| (profile_name(dimension), profile_schema(dimension)));
    let definitions: Map<String, Value> = definitions.into_iter().chain(profiles).collect();
    schema.insert("$defs".into(), Value::Object(definitions));
    Value::Object(schema)
}

fn definition_name(dimension: Dimension) -> String {
    noun(dimension).replace(' ', "_")
}

/// "length", "rotation speed".
fn noun(dimension: Dimension) -> &'static str {
    dimension.name().split_once(' ').map_or(dimension.name(), |(_, noun)| noun)
}

/// A string of number and unit.
fn quantity_schema(dimension: Dimension) -> Value {
    let spellings: Vec<String> = dimension
        .units()
        .iter()
        .flat_map(|unit| unit.spellings)
        .map(|spelling| spelling.replace('*', r"\*").replace('^', r"\^"))
        .collect();
    json!({
        "type": "string",
        "description": format!("{} with its unit: {}", dimension.name(), dimension.unit_list()),
        "pattern": format!(r"^\s*{NUMBER_PATTERN}\s*({})\s*$", spellings.join("|")),
    })
}

fn table_schema(path: &str) -> Map<String, Value> {
    let mut properties = Map::new();
    let mut required = Vec::new();
    let mut exclusive = Vec::new();
    for name in keys::children(path) {
        let full = if path.is_empty() { name.to_string() } else { format!("{path}.{name}") };
        let property = match keys::find(&full) {
            Some((_, key)) => {
                if key.need == Need::Required {
                    required.push(json!(name));
                }
                let later_rivals = key
                    .rivals()
                    .filter(|rival| rival.table() == key.table() && row(rival.path) > row(key.path))
                    .map(Key::name);
                exclusive.extend(
                    later_rivals.map(|rival| json!({ "not": { "required": [name, rival] } })),
                );
                match keys::find_table(&full) {
                    Some(_) => key_or_table_schema(key, &full),
                    None => key_schema(key),
                }
            }
            None => match full.as_str() {
                "assumptions" => free_table(&full, json!({ "type": "string" })),
                "sweep" => free_table(&full, sweep_schema()),
                _ => Value::Object(table_schema(&full)),
            },
        };
        if ["bearing", "bearing.inner_race", "bearing.outer_race"].contains(&full.as_str()) {
            required.push(json!(name));
        }
        properties.insert(name.to_string(), property);
    }
    let mut schema = Map::new();
    schema.insert("type".into(), json!("object"));
    if let Some(table) = keys::find_table(path) {
        schema.insert("description".into(), json!(table.doc));
    }
    schema.insert("properties".into(), Value::Object(properties));
    schema.insert("additionalProperties".into(), json!(false));
    if !required.is_empty() {
        schema.insert("required".into(), Value::Array(required));
    }
    if path == "bearing" {
        exclusive.push(kinds_schema());
    }
    if ["bearing.inner_race", "bearing.outer_race"].contains(&path) {
        let one_of = ["groove_radius", "conformity", "osculation"];
        exclusive.push(json!({ "anyOf": one_of.map(|key| json!({ "required": [key] })) }));
    }
    if !exclusive.is_empty() {
        schema.insert("allOf".into(), Value::Array(exclusive));
    }
    schema
}

fn row(path: &str) -> Option<usize> {
    keys::find(path).map(|(row, _)| row)
}

/// What the two kinds of bearing need and refuse.
fn kinds_schema() -> Value {
    let no_radius = json!({ "properties": { "radius": false } });
    json!({
        "if": {
            "required": ["kind"],
            "properties": { "kind": { "const": "angular-contact" } },
        },
        "then": {
            "required": ["pitch_radius", "contact_angle", "ball"],
            "properties": { "inner_race": no_radius, "outer_race": no_radius },
        },
        "else": { "properties": { "contact_angle": false } },
    })
}

fn free_table(path: &str, values: Value) -> Value {
    let doc = keys::find_table(path).map_or("", |table| table.doc);
    json!({ "type": "object", "description": doc, "additionalProperties": values })
}

fn sweep_schema() -> Value {
    let single = json!({ "type": ["string", "number", "boolean"] });
    json!({
        "description": "a list of values, or a range such as \"0 deg .. 45 deg / 91\"; a table stands for a dotted key",
        "anyOf": [
            { "type": "array", "minItems": 1, "items": single },
            { "type": "string" },
            { "type": "object" },
        ],
    })
}

/// A quantity as text, or a table of keys.
fn key_or_table_schema(key: &'static Key, path: &str) -> Value {
    let mut schema = table_schema(path);
    let quantity = key_schema(key);
    schema.insert("type".into(), json!(["string", "object"]));
    schema.insert("description".into(), quantity["description"].clone());
    schema.insert("if".into(), json!({ "type": "string" }));
    schema.insert("then".into(), json!({ "$ref": quantity["$ref"] }));
    Value::Object(schema)
}

fn profile_dimensions() -> impl Iterator<Item = Dimension> {
    KEYS.iter().filter_map(|key| match key.kind {
        Kind::Profile(dimension, _) => Some(dimension),
        _ => None,
    })
}

fn profile_name(dimension: Dimension) -> String {
    format!("{}_profile", definition_name(dimension))
}

/// A quantity, or one of the tables of [`FORMS`].
fn profile_schema(dimension: Dimension) -> Value {
    let own = reference(dimension);
    let forms = FORMS.iter().map(|form| {
        let mut properties = Map::new();
        let mut required = Vec::new();
        for (index, member) in form.members.iter().enumerate() {
            let (value, needed) = match member {
                Member::Own(_) => (own.clone(), false),
                Member::Pair(_) => (list(&own, 2, Some(2)), false),
                Member::Points(_) => {
                    let pair = json!({ "type": "array", "minItems": 2, "maxItems": 2,
                        "prefixItems": [reference(Dimension::Time), own] });
                    (list(&pair, 2, None), false)
                }
                Member::Other(key) => (key_schema(key), key.need == Need::Required),
            };
            properties.insert(member.name().into(), value);
            if index == 0 || needed {
                required.push(member.name());
            }
        }
        json!({
            "type": "object",
            "description": form.doc,
            "properties": properties,
            "required": required,
            "additionalProperties": false,
        })
    });
    let any: Vec<Value> = std::iter::once(own.clone()).chain(forms).collect();
    json!({ "anyOf": any })
}

fn list(items: &Value, least: usize, most: Option<usize>) -> Value {
    let mut schema = json!({ "type": "array", "items": items, "minItems": least });
    if let Some(most) = most {
        schema["maxItems"] = json!(most);
    }
    schema
}

fn number_schema(range: Range) -> Value {
    let low = if range.low_included { "minimum" } else { "exclusiveMinimum" };
    let high = if range.high_included { "maximum" } else { "exclusiveMaximum" };
    json!({ "type": "number", low: range.low, high: range.high })
}

fn key_schema(key: &'static Key) -> Value {
    let mut schema = match key.kind {
        Kind::Text => json!({ "type": "string" }),
        Kind::Boolean => json!({ "type": "boolean" }),
        Kind::Integer { low, high } => {
            json!({ "type": "integer", "minimum": low, "maximum": high })
        }
        Kind::Choice(choices) => json!({ "enum": choices }),
        Kind::Choices(choices) => {
            json!({ "type": "array", "uniqueItems": true, "items": { "enum": choices } })
        }
        Kind::Number(range) => number_schema(range),
        Kind::Profile(dimension, _) => {
            json!({ "$ref": format!("#/$defs/{}", profile_name(dimension)) })
        }
        Kind::Either(kinds) => {
            let any: Vec<Value> = kinds
                .iter()
                .filter_map(|kind| match kind {
                    Kind::Number(range) => Some(number_schema(*range)),
                    Kind::Quantity(dimension, _) => Some(reference(*dimension)),
                    _ => None,
                })
                .collect();
            json!({ "anyOf": any })
        }
        Kind::Curve(dimension, _, numbers) => {
            let pair = json!({ "type": "array", "minItems": 2, "maxItems": 2,
                "prefixItems": [reference(dimension), number_schema(numbers)] });
            list(&pair, 1, None)
        }
        Kind::Texts => json!({ "type": "array", "items": { "type": "string" } }),
        Kind::Quantity(dimension, _) => reference(dimension),
        Kind::Vector(dimension, _) => {
            json!({ "type": "array", "minItems": 3, "maxItems": 3, "items": reference(dimension) })
        }
    };
    if let Value::Object(entries) = &mut schema {
        let mut description = key.doc.to_string();
        if let Some(range) = range_text(key) {
            let _ = write!(description, " Allowed: {range}.");
        }
        if let Need::Default { value, .. } = key.need {
            let _ = write!(description, " Default: {value}.");
        }
        entries.insert("description".into(), json!(description));
    }
    schema
}

fn reference(dimension: Dimension) -> Value {
    json!({ "$ref": format!("#/$defs/{}", definition_name(dimension)) })
}

fn range_text(key: &Key) -> Option<String> {
    match key.kind {
        Kind::Integer { low, high } => Some(format!("from {low} to {high}")),
        Kind::Number(range)
        | Kind::Quantity(_, range)
        | Kind::Vector(_, range)
        | Kind::Profile(_, range) => Some(Range::to_string(&range)),
        Kind::Either(kinds) => {
            let ranges: Vec<String> = kinds
                .iter()
                .filter_map(|kind| match kind {
                    Kind::Number(range) | Kind::Quantity(_, range) => Some(range.to_string()),
                    _ => None,
                })
                .collect();
            Some(ranges.join(", or "))
        }
        Kind::Curve(_, range, numbers) => Some(format!("{range}, increasing; {numbers}")),
        _ => None,
    }
}

/// The text of `docs/scene.md`.
pub fn reference_markdown() -> String {
    let mut text = String::from(INTRODUCTION);
    table_markdown(&mut text, "", "Top of the file", "");
    for table in TABLES {
        table_markdown(&mut text, table.path, &format!("`[{}]`", table.path), table.doc);
        let _ = writeln!(text, "```toml\n{}\n```\n", table.example.replace(" or {", "   # or {"));
    }
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
        Kind::Curve(dimension, ..) => {
            (format!("list of pairs: {}, number", noun(dimension)), range)
        }
        Kind::Texts => ("list of texts".to_string(), "any".to_string()),
        Kind::Vector(dimension, _) => {
            (format!("list of three: {}", noun(dimension)), format!("each {range}"))
        }
    }
}

const INTRODUCTION: &str = "\
# Scene reference

<!-- Made from the key table in src/scene/keys.rs. After changing that table: SCENE_DOCS=write cargo test --release --test scene_docs -->

A scene is a TOML file, or a JSON file of the same shape. Every dimensional value is a text of a number and a
unit, `\"20.047 mm\"`: nothing is guessed from a bare number. Unknown keys are refused. `bearing check SCENE` names
the first thing that is wrong, with file, line and column, the allowed range and what to do; `bearing schema` prints
a JSON Schema for editors.

Axes: X axial, Y lateral, Z up. Ball azimuths run from +Y towards +Z.

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

## Sweeps
Values are a list, `[\"5 um\", \"0 um\"]` or `\"5 um, 0 um\"`, or a range `\"low .. high / count\"` with both ends included. Varying a
key takes away the keys that exclude it: varying `bearing.clearance.radial` replaces a diametral clearance.
Texts, lists and `ball_forces.gravity` cannot be varied.
";
