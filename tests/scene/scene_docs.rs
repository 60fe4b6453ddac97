//! The scene reference and the JSON Schema follow the key table.

use bearing_dynamics::scene::tables::{keys, manual, schema};
use serde_json::Value;

/// `SCENE_DOCS=write cargo test --release --test scene scene_docs` rewrites the reference.
#[test]
fn reference_is_current() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/scene.md");
    let made = manual::reference_markdown();
    if std::env::var_os("SCENE_DOCS").is_some_and(|mode| mode == "write") {
        std::fs::write(path, &made).expect("docs/scene.md can be written");
    }
    let committed = std::fs::read_to_string(path).expect("docs/scene.md exists");
    assert!(
        committed == made,
        "docs/scene.md is out of date: run SCENE_DOCS=write cargo test --release --test scene scene_docs"
    );
}

#[test]
fn every_key_is_in_the_schema_and_described() {
    let schema = schema::json_schema();
    for key in keys::KEYS {
        let mut at = &schema;
        for name in key.path.split('.') {
            let of_list = at.get("items").is_some();
            at = if of_list { &at["items"]["properties"][name] } else { &at["properties"][name] };
        }
        let description = at["description"].as_str();
        assert!(description.is_some_and(|text| text.starts_with(key.doc)), "{}", key.path);
    }
}

/// What stands for a table may be a text too, a housing is a bearing and a solid, and what one spring needs may stand beside all names.
#[test]
fn the_schema_refuses_no_scene_that_is_read() {
    let schema = schema::json_schema();
    fn refusals(value: &Value, seen: &mut usize) {
        if let Some(refused) = value.get("not").filter(|refused| refused.get("required").is_some())
        {
            assert_eq!(refused["type"], "object", "{refused}");
            *seen += 1;
        }
        match value {
            Value::Object(all) => all.values().for_each(|inner| refusals(inner, seen)),
            Value::Array(all) => all.iter().for_each(|inner| refusals(inner, seen)),
            _ => {}
        }
    }
    let mut seen = 0;
    refusals(&schema, &mut seen);
    assert!(seen > 10, "{seen}");
    let top = &schema["allOf"][0];
    assert!(top.get("anyOf").is_some() && top.get("oneOf").is_none(), "{top}");
    let named = &schema["properties"]["spring"]["additionalProperties"];
    assert!(named["properties"]["from"].is_object() && named.get("required").is_none());
}

#[test]
fn no_object_of_the_schema_lets_unknown_keys_through() {
    let schema = schema::json_schema();
    let mut closed = 0;
    fn visit(value: &Value, closed: &mut usize) {
        if let Some(properties) = value.get("properties").filter(|_| value.get("type").is_some()) {
            // Of tables with names anything else is a name of such a table.
            match &value["additionalProperties"] {
                // Of `[sweep]` anything else is a varied key.
                Value::Object(named) if named.contains_key("anyOf") => {}
                Value::Object(named) => {
                    assert_eq!(named["additionalProperties"], Value::Bool(false))
                }
                other => assert_eq!(*other, Value::Bool(false), "{value}"),
            }
            *closed += 1;
            properties.as_object().unwrap().values().for_each(|inner| visit(inner, closed));
        } else if let Some(items) = value.get("items") {
            visit(items, closed);
        }
    }
    visit(&schema, &mut closed);
    // The top and every table except the assumptions, which have free names.
    assert_eq!(closed, 1 + keys::TABLES.len() - 1);
}

#[test]
fn every_key_lies_in_a_described_table_and_has_a_doc() {
    for key in keys::KEYS {
        assert!(key.table().is_empty() || keys::find_table(key.table()).is_some(), "{}", key.path);
        assert!(key.doc.ends_with('.'), "{}", key.path);
        assert_eq!(keys::KEYS.iter().filter(|other| other.path == key.path).count(), 1);
    }
}
