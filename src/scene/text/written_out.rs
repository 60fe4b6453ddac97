//! A scene written out in SI as JSON that can be read back: bases and changes merged, inherited keys and defaults filled
//! in.

use crate::numeric::profile::Profile;
use crate::scene::resolve::resolved::DefaultUsed;
use crate::scene::resolve::unused::unused;
use crate::scene::tables::keys;
use crate::scene::tables::keys::{DEFAULT_SETS, KEYS, Key, Kind, Leads, NAMED, Need, SI, UNITS};
use crate::scene::text::base::{BASE, WITHOUT};
use crate::scene::text::document::{Document, Named};
use crate::scene::text::sweep::SweepValues;
use crate::scene::text::table::{Content, Item, Table, joined};
use crate::scene::text::units::plain;
use crate::scene::text::value;
use crate::scene::text::value::Checked;
use serde_json::{Map, Value, json};

impl Document {
    /// The scene as JSON in SI, with the defaults in use. With `[sweep]` only constants are filled in: others may follow
    /// from a varied key.
    pub fn written_out(&self, defaults: &[DefaultUsed]) -> Value {
        let varied = !self.sweep().is_empty();
        let mut full = if varied { self.clone() } else { self.without_inheritance() };
        for (path, value) in defaults.iter().flat_map(|used| &used.fills) {
            if !varied || is_constant(path, value) {
                full.fill(path, value);
            }
        }
        full.complete_tables();
        let mut all = full.json_of_table(&full.tree, "");
        for Named { table, name, tree, .. } in &full.named {
            if let Some(own) = tree.own(table).and_then(Item::table) {
                all[table][name] = full.json_of_table(own, table);
            }
        }
        all[UNITS] = json!(SI);
        all
    }

    /// The same scene with all keys of a name in its own tables.
    fn without_inheritance(&self) -> Document {
        let mut full = self.common();
        for table in NAMED {
            let names: Vec<&str> = self.names(keys::kind_of_names(table)).collect();
            // A bearing may have the name of a key of its race.
            let is_key = |name: &&str| keys::children(table).contains(name);
            if names.is_empty() || names.iter().any(is_key) {
                continue;
            }
            full.tree.remove(table);
            for name in names {
                let tree = self.merged(name);
                // Bearings without a housing may not have the common solid.
                let idle = table == "solid" && tree.own("housing").is_none();
                if let Some(item) = tree.own(table).filter(|_| !idle) {
                    let tree = Table(vec![(table.to_string(), item.clone())]);
                    let offset = item.offset.unwrap_or_default();
                    full.named.push(Named { table, name: name.to_string(), offset, tree });
                }
            }
        }
        full
    }

    /// An entry of a name's table, else of the common one.
    fn entry(&self, name: Option<&str>, path: &str) -> Option<&Item> {
        let of_name = |named: &&Named| Some(named.name.as_str()) == name;
        let own = self.named.iter().filter(of_name).find_map(|named| named.tree.get(path));
        own.or_else(|| self.tree.get(path))
    }

    /// Adds a key, unless it or a rival is given or it has no effect.
    fn fill(&mut self, path: &str, value: &Checked) {
        let Some(leads) = keys::find_named(path) else { return };
        let Leads { key, name, item: number, .. } = leads;
        let top = key.path.split('.').next().unwrap_or_default();
        if name.is_some_and(|name| keys::children(top).contains(&name)) {
            return;
        }
        let content = Content::Value(value.clone());
        let item = Item { content, offset: None, named: name.is_some() };
        if let Some(number) = number {
            let list = self.entry(name, key.table()).map_or(&[][..], Item::list);
            let of = list.get(number - 1).and_then(Item::table);
            let is_given = |key: &Key| of.is_some_and(|table| table.own(key.name()).is_some());
            if !is_given(key) && !key.rivals().any(is_given) {
                self.put_item(&leads, item);
            }
            return;
        }
        let is_given = |path: &str| self.entry(name, path).is_some();
        let choice = |path: &'static str| self.entry(name, path).and_then(Item::value);
        if is_given(key.path)
            || key.rivals().any(|rival| is_given(rival.path))
            || unused(key, choice).is_some()
        {
            return;
        }
        let tree = match name {
            Some(name) => self.tree_of(key, name),
            None => &mut self.tree,
        };
        tree.exchange(key, item);
    }

    /// Adds the missing keys of given tables of which every key has a constant default, such as stiffnesses.
    fn complete_tables(&mut self) {
        let of_table = |table| KEYS.iter().filter(move |key| key.table() == table);
        let is_constant = |need| matches!(need, Need::Default { .. });
        for key in KEYS {
            let table = key.table();
            let in_table = table.split('.').count() > 1 && !key.in_list();
            if !in_table || !of_table(table).all(|key| is_constant(key.need)) {
                continue;
            }
            let Some(value) = value::default_in(key, DEFAULT_SETS[0]) else { continue };
            let (top, rest) = key.path.split_once('.').unwrap_or_default();
            let own = self.named.iter().filter(|named| named.tree.get(table).is_some());
            let own: Vec<String> = own.map(|of| format!("{top}.{}.{rest}", of.name)).collect();
            let common = self.tree.get(table).map(|_| key.path.to_string());
            own.into_iter().chain(common).for_each(|path| self.fill(&path, &value));
        }
    }

    fn json_of_table(&self, table: &Table, path: &str) -> Value {
        let mut all = Map::new();
        for (name, item) in &table.0 {
            let full = joined(path, name);
            if [BASE, WITHOUT].contains(&full.as_str()) {
                continue;
            }
            let value = match &item.content {
                Content::Table(inner) => self.json_of_table(inner, &full),
                Content::List(list) => {
                    let tables = list.iter().filter_map(Item::table);
                    tables.map(|table| self.json_of_table(table, &full)).collect()
                }
                // A mesh is beside the file that names it.
                Content::Value(Checked::Text(file)) if full == "solid.mesh.file" => {
                    json!(self.file_from(item, file).1)
                }
                Content::Value(value) => json_of(keys::find(&full).map(|(_, key)| key.kind), value),
            };
            all.insert(name.clone(), value);
        }
        Value::Object(all)
    }
}

/// True for a default that follows from no other key.
fn is_constant(path: &str, value: &Checked) -> bool {
    let Some(Leads { key, .. }) = keys::find_named(path) else { return false };
    let constant = matches!(key.need, Need::Default { .. });
    constant && value::default_in(key, DEFAULT_SETS[0]).as_ref() == Some(value)
}

/// A value of a key, or of an assumption or a varied key without a kind.
fn json_of(kind: Option<Kind>, value: &Checked) -> Value {
    match (value, kind) {
        (Checked::Text(text), _) => json!(text),
        (Checked::Boolean(value), _) => json!(value),
        (Checked::Integer(value), _) => json!(value),
        (Checked::Choice(word), _) => json!(word),
        (Checked::Choices(words), _) => json!(words),
        (Checked::Number(value), Some(Kind::Integer { .. })) => json!(*value as i64),
        (Checked::Number(value), _) => json!(value),
        (Checked::Vector(values), _) => json!(values),
        (Checked::Quantities(values), _) => json!(values),
        (Checked::Profile(of), _) => profile(of),
        // The unit states which of several quantities it is.
        (Checked::Either(index, value), Some(Kind::Either(kinds))) => match kinds[*index] {
            Kind::Quantity(dimension, _) => {
                json!(format!("{} {}", plain(*value), dimension.si_unit()))
            }
            _ => json!(value),
        },
        (Checked::Either(_, value), _) => json!(value),
        (Checked::Axis(axis), _) => match &axis.values {
            SweepValues::List(list) => json!(list),
            SweepValues::Range { low, high, unit, count } => {
                json!(format!("{} {unit} .. {} {unit} / {count}", plain(*low), plain(*high)))
            }
        },
    }
}

fn profile(profile: &Profile) -> Value {
    match profile {
        Profile::Constant(value) => json!(value),
        Profile::Ramp { from, to, start, duration } => {
            json!({ "ramp": [from, to], "start": start, "duration": duration })
        }
        Profile::SmoothRamp { from, to, start, duration } => {
            json!({ "smooth_ramp": [from, to], "start": start, "duration": duration })
        }
        Profile::Table { points } => json!({ "table": points }),
        Profile::Harmonic { mean, amplitude, frequency, phase } => json!({
            "amplitude": amplitude, "mean": mean, "frequency": frequency, "phase": phase,
        }),
        Profile::HalfSine { base, peak, start, duration } => json!({
            "half_sine": peak, "base": base, "start": start, "duration": duration,
        }),
    }
}
