//! The key table as JSON Schema, for editors.

use crate::scene::resolve::profile::{FORMS, Member};
use crate::scene::tables::keys;
use crate::scene::tables::keys::{KEYS, Key, Kind, Need, Range};
use crate::scene::text::units::Dimension;
use serde_json::{Map, Value, json};
use std::fmt::Write;

const NUMBER_PATTERN: &str = r"[+\-\u2212]?([0-9]+\.?[0-9]*|\.[0-9]+)([eE][+\-]?[0-9]+)?";

/// JSON Schema (draft 2020-12) of a scene. Relations between values of keys, such as a ball that fits
/// its pocket, are checked by `bearing check` only.
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

pub(crate) fn noun(dimension: Dimension) -> &'static str {
    dimension.name().split_once(' ').map_or(dimension.name(), |(_, noun)| noun)
}

fn quantity_schema(dimension: Dimension) -> Value {
    let spellings: Vec<String> = dimension
        .units()
        .iter()
        .flat_map(|unit| unit.spellings)
        .map(|spelling| spelling.replace('*', r"\*").replace('^', r"\^"))
        .collect();
    let (name, si) = (dimension.name(), dimension.si_unit());
    json!({
        "type": ["string", "number"],
        "description": format!(
            "{name} with its unit: {}; with `units = \"SI\"` also a number in {si}",
            dimension.unit_list()
        ),
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
                exclusive.extend(later_rivals.map(
                    |rival| json!({ "not": { "type": "object", "required": [name, rival] } }),
                ));
                match keys::find_table(&full) {
                    Some(_) => key_or_table_schema(key, &full),
                    None => key_schema(key),
                }
            }
            None => match full.as_str() {
                "assumptions" => free_table(&full, json!({ "type": "string" })),
                "sweep" => {
                    let mut schema = table_schema(&full);
                    schema.insert("additionalProperties".into(), sweep_schema());
                    Value::Object(schema)
                }
                _ if keys::find_table(&full).is_some_and(|table| table.list) => {
                    json!({ "type": "array", "items": table_schema(&full) })
                }
                _ if keys::NAMED.contains(&full.as_str()) => named_schema(&full),
                _ => Value::Object(table_schema(&full)),
            },
        };
        if ["bearing.inner_race", "bearing.outer_race"].contains(&full.as_str()) {
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
    if path.is_empty() {
        // A bearing in a housing has both.
        let any_of = ["bearing", "body", "solid"].map(|part| json!({ "required": [part] }));
        exclusive.push(json!({ "anyOf": any_of }));
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

/// Schema of a table that may occur several times, each with a name. All inherit the keys without a name, so
/// required keys are required there only if there is no named table.
fn named_schema(path: &str) -> Value {
    let plain = table_schema(path);
    let known = keys::children(path);
    let mut inherited = plain.clone();
    let relations = ["required", "allOf"];
    for part in relations {
        inherited.remove(part);
    }
    let properties = inherited.get_mut("properties").and_then(Value::as_object_mut);
    for (_, property) in properties.into_iter().flatten() {
        for part in relations {
            property.as_object_mut().and_then(|property| property.remove(part));
        }
    }
    let only_named = keys::OWN_NAMES.contains(&path);
    let mut named = if only_named { plain.clone() } else { inherited.clone() };
    // Required keys may be inherited.
    named.remove("required");
    inherited.insert("additionalProperties".into(), Value::Object(named));
    if !only_named {
        let alone = json!({ "if": { "propertyNames": { "enum": known } }, "then": plain });
        inherited.insert("allOf".into(), json!([alone]));
    }
    Value::Object(inherited)
}

fn row(path: &str) -> Option<usize> {
    keys::find(path).map(|(row, _)| row)
}

/// Keys that each kind of bearing requires and refuses.
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
        "description": "a list of values, or a range such as \"0 deg .. 45 deg / 91\"; a table is read as a dotted key",
        "anyOf": [
            { "type": "array", "minItems": 1, "items": single },
            { "type": "string" },
            { "type": "object" },
        ],
    })
}

/// Schema of a key that may be a quantity or a table of keys.
fn key_or_table_schema(key: &'static Key, path: &str) -> Value {
    let mut schema = table_schema(path);
    let quantity = key_schema(key);
    schema.insert("type".into(), json!(["string", "number", "object"]));
    schema.insert("description".into(), quantity["description"].clone());
    schema.insert("if".into(), json!({ "type": ["string", "number"] }));
    schema.insert("then".into(), json!({ "$ref": quantity["$ref"] }));
    Value::Object(schema)
}

fn profile_dimensions() -> impl Iterator<Item = Dimension> {
    KEYS.iter().filter_map(|key| match key.kind {
        Kind::Profile(dimension, _) | Kind::TrueOrProfile(dimension, _) => Some(dimension),
        _ => None,
    })
}

fn profile_name(dimension: Dimension) -> String {
    format!("{}_profile", definition_name(dimension))
}

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
        Kind::Quantities(dimension, _) | Kind::QuantityList(dimension, _) => {
            list(&reference(dimension), 1, None)
        }
        Kind::TrueOrProfile(dimension, _) => {
            let profile = json!({ "$ref": format!("#/$defs/{}", profile_name(dimension)) });
            json!({ "anyOf": [{ "type": "boolean" }, profile] })
        }
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
        if let Need::BySet { dissertation, engineering } = key.need {
            let [one, other] = [engineering.0, dissertation.0];
            let _ = write!(description, " Default: {one} (engineering), {other} (dissertation).");
        }
        entries.insert("description".into(), json!(description));
    }
    schema
}

fn reference(dimension: Dimension) -> Value {
    json!({ "$ref": format!("#/$defs/{}", definition_name(dimension)) })
}

pub(crate) fn range_text(key: &Key) -> Option<String> {
    match key.kind {
        Kind::Integer { low, high } => Some(format!("from {low} to {high}")),
        Kind::Number(range)
        | Kind::Quantity(_, range)
        | Kind::Vector(_, range)
        | Kind::Quantities(_, range)
        | Kind::QuantityList(_, range)
        | Kind::TrueOrProfile(_, range)
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
        _ => None,
    }
}
