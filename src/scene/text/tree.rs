//! TOML and JSON as one tree of values with byte offsets.

use crate::scene::error::{Problem, SceneError};
use crate::scene::text::source::{Format, Source};
use std::collections::HashSet;
use toml::de::{DeTable, DeValue};

#[derive(Clone, Debug)]
pub struct Node {
    pub value: Value,
    pub offset: usize,
}

#[derive(Clone, Debug)]
pub enum Value {
    /// Entries in the order of the file.
    Table(Vec<Entry>),
    List(Vec<Node>),
    Text(String),
    /// A number as written, without TOML's underscores.
    Number(String),
    Boolean(bool),
    /// A date, or JSON's null: no key accepts one.
    Other(&'static str),
}

#[derive(Clone, Debug)]
pub struct Entry {
    pub name: String,
    pub offset: usize,
    pub node: Node,
}

impl Value {
    /// Kind of the value, for messages.
    pub fn description(&self) -> &'static str {
        match self {
            Value::Table(_) => "a table",
            Value::List(_) => "a list",
            Value::Text(_) => "a text",
            Value::Number(_) => "a number",
            Value::Boolean(_) => "true or false",
            Value::Other(name) => name,
        }
    }
}

/// Parses a checked source into the entries of its top table.
pub fn parse(source: &Source, format: Format) -> Result<Vec<Entry>, SceneError> {
    match format {
        Format::Toml => parse_toml(source),
        Format::Json => parse_json(source),
    }
}

fn parse_toml(source: &Source) -> Result<Vec<Entry>, SceneError> {
    let table = DeTable::parse(&source.text).map_err(|error| {
        let offset = error.span().map_or(0, |span| span.start);
        let message = error.message().replace('\n', ", ");
        if message == "duplicate key" {
            return source.error(offset, key_at(&source.text, offset), Problem::DuplicateKey);
        }
        let advice = toml_advice(source.text.get(..offset).unwrap_or_default());
        source.error(offset, "", Problem::Syntax { format: "TOML", message, advice })
    })?;
    Ok(toml_entries(table.into_inner()))
}

/// A list or profile written as one TOML value; `None` for other text.
pub fn composite_value(text: &str) -> Option<Value> {
    let line = format!("value = {text}");
    let table = text.starts_with(['[', '{']).then(|| DeTable::parse(&line).ok())??;
    toml_entries(table.into_inner()).pop().map(|entry| entry.node.value)
}

/// The bare or quoted key that begins at `offset`.
fn key_at(text: &str, offset: usize) -> &str {
    let rest = text.get(offset..).unwrap_or_default();
    let is_key = |c: char| c.is_alphanumeric() || "_-.\"".contains(c);
    let end = rest.find(|c| !is_key(c)).unwrap_or(rest.len());
    &rest[..end]
}

fn toml_advice(before: &str) -> &'static str {
    let line = before.rsplit('\n').next().unwrap_or_default();
    if line.contains('=') {
        "put texts and quantities in quotes, as in radius = \"5.953 mm\", and close every quote and bracket"
    } else {
        "write key = value on one line, and [table] on a line of its own"
    }
}

fn toml_entries(table: DeTable) -> Vec<Entry> {
    let mut entries: Vec<Entry> = table
        .into_iter()
        .map(|(name, value)| {
            let offset = name.span().start;
            let node = Node { offset: value.span().start, value: toml_value(value.into_inner()) };
            Entry { name: name.into_inner().into_owned(), offset, node }
        })
        .collect();
    entries.sort_by_key(|entry| entry.offset);
    entries
}

fn toml_value(value: DeValue) -> Value {
    match value {
        DeValue::String(text) => Value::Text(text.into_owned()),
        DeValue::Integer(number) if number.radix() == 10 => {
            Value::Number(number.as_str().to_string())
        }
        DeValue::Integer(number) => {
            let decimal = i64::from_str_radix(number.as_str(), number.radix());
            Value::Number(decimal.map_or_else(|_| number.to_string(), |value| value.to_string()))
        }
        DeValue::Float(number) => Value::Number(number.as_str().to_string()),
        DeValue::Boolean(value) => Value::Boolean(value),
        DeValue::Datetime(_) => Value::Other("a date or time"),
        DeValue::Array(list) => Value::List(
            list.into_iter()
                .map(|item| Node {
                    offset: item.span().start,
                    value: toml_value(item.into_inner()),
                })
                .collect(),
        ),
        DeValue::Table(table) => Value::Table(toml_entries(table)),
    }
}

fn parse_json(source: &Source) -> Result<Vec<Entry>, SceneError> {
    use jsonc_parser::{CollectOptions, ParseOptions, parse_to_ast};
    let strict = ParseOptions {
        allow_comments: false,
        allow_loose_object_property_names: false,
        allow_trailing_commas: false,
        allow_missing_commas: false,
        allow_single_quoted_strings: false,
        allow_hexadecimal_numbers: false,
        allow_unary_plus_numbers: false,
        allow_bare_decimal_point_numbers: false,
        allow_non_finite_numbers: false,
        allow_extended_string_escapes: false,
    };
    let parsed =
        parse_to_ast(&source.text, &CollectOptions::default(), &strict).map_err(|error| {
            let message = lower_first(&error.kind().to_string());
            let advice = json_advice(error.kind());
            let problem = Problem::Syntax { format: "JSON", message, advice };
            source.error(error.range().start, "", problem)
        })?;
    // The second parser refuses what the first accepts: leading zeros, unusual white space.
    if let Err(error) = serde_json::from_str::<serde::de::IgnoredAny>(&source.text) {
        let offset = line_offset(&source.text, error.line()) + error.column().saturating_sub(1);
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default().to_string();
        let problem = Problem::Syntax { format: "JSON", message, advice: "" };
        return Err(source.error(offset, "", problem));
    }
    match json_value(source, parsed.value)? {
        Value::Table(entries) => Ok(entries),
        other => Err(source.error(0, "", Problem::NotATable { found: other.description() })),
    }
}

fn json_advice(kind: &jsonc_parser::errors::ParseErrorKind) -> &'static str {
    use jsonc_parser::errors::ParseErrorKind as Kind;
    match kind {
        Kind::TrailingCommasNotAllowed => "remove the comma after the last entry",
        Kind::CommentsNotAllowed => {
            "JSON has no comments; use \"source\" or \"assumptions\", or TOML"
        }
        Kind::SingleQuotedStringsNotAllowed => "use double quotes",
        Kind::ExpectedComma => "put a comma between entries; numbers have no leading zero",
        Kind::NonFiniteNumbersNotAllowed => "write a decimal number",
        Kind::UnexpectedWord => "put texts in double quotes; numbers are decimal and finite",
        Kind::UnterminatedObject | Kind::UnterminatedArray => "close every bracket",
        _ => "put keys and texts in double quotes, commas between entries, and close every bracket",
    }
}

fn lower_first(text: &str) -> String {
    let mut characters = text.chars();
    match characters.next() {
        Some(first) => first.to_lowercase().chain(characters).collect(),
        None => String::new(),
    }
}

fn line_offset(text: &str, line: usize) -> usize {
    let newlines = text.match_indices('\n').map(|(offset, _)| offset + 1);
    std::iter::once(0).chain(newlines).nth(line.saturating_sub(1)).unwrap_or(0)
}

fn json_value(
    source: &Source,
    value: Option<jsonc_parser::ast::Value>,
) -> Result<Value, SceneError> {
    use jsonc_parser::ast::Value as Json;
    use jsonc_parser::common::Ranged;
    let node = |value: Json| -> Result<Node, SceneError> {
        let offset = value.start();
        Ok(Node { offset, value: json_value(source, Some(value))? })
    };
    Ok(match value {
        None | Some(Json::NullKeyword(_)) => Value::Other("null"),
        Some(Json::StringLit(text)) => Value::Text(text.value.into_owned()),
        Some(Json::NumberLit(number)) => Value::Number(number.value.to_string()),
        Some(Json::BooleanLit(boolean)) => Value::Boolean(boolean.value),
        Some(Json::Array(list)) => {
            Value::List(list.elements.into_iter().map(node).collect::<Result<_, _>>()?)
        }
        Some(Json::Object(object)) => {
            let mut seen = HashSet::new();
            let mut entries = Vec::new();
            for property in object.properties {
                let offset = property.name.start();
                let name = property.name.into_string();
                if !seen.insert(name.clone()) {
                    return Err(source.error(offset, &name, Problem::DuplicateKey));
                }
                entries.push(Entry { name, offset, node: node(property.value)? });
            }
            Value::Table(entries)
        }
    })
}
