//! A scene with its bases, changes and constant defaults written out, as JSON that can be read back.

use crate::numeric::profile::Profile;
use crate::scene::resolve::resolved::DefaultUsed;
use crate::scene::resolve::unused::unused;
use crate::scene::tables::keys;
use crate::scene::tables::keys::{Key, Kind, Leads, Range};
use crate::scene::text::base::{BASE, WITHOUT};
use crate::scene::text::document::{Document, Named};
use crate::scene::text::sweep::SweepValues;
use crate::scene::text::table::{Content, Item, Table, joined};
use crate::scene::text::units::{Dimension, parse_quantity, plain};
use crate::scene::text::value::{Checked, check_bare};
use serde_json::{Map, Value, json};

impl Document {
    /// The scene as JSON, with those of the defaults in use that are constants of the key table. Others follow again from
    /// the scene.
    pub fn written_out(&self, defaults: &[DefaultUsed]) -> Value {
        let mut full = self.clone();
        defaults.iter().for_each(|used| full.add_default(used));
        let mut all = full.json_of_table(&full.tree, "");
        for Named { table, name, tree, .. } in &full.named {
            if let Some(own) = tree.own(table).and_then(Item::table) {
                all[table][name] = full.json_of_table(own, table);
            }
        }
        all
    }

    fn add_default(&mut self, used: &DefaultUsed) {
        let Some(Leads { key, name, .. }) = keys::find_named(&used.key) else { return };
        let is_constant =
            |set| key.need.default_in(set).is_some_and(|(value, _)| value == used.value);
        if key.in_list() || !keys::DEFAULT_SETS.iter().any(|set| is_constant(set)) {
            return;
        }
        let Ok(value) = check_bare(key, &used.value) else { return };
        let scoped = name.map_or_else(|| self.common(), |name| self.scoped(name));
        if unused(key, |choice| scoped.value(choice)).is_some() {
            return;
        }
        let tree = match name {
            Some(name) => self.tree_of(key, name),
            None => &mut self.tree,
        };
        let taken = key.rivals().map(|rival| rival.path).chain([key.path]);
        if taken.into_iter().all(|path| tree.get(path).is_none()) {
            let content = Content::Value(value);
            tree.exchange(key, Item { content, offset: None, named: name.is_some() });
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
                Content::Value(value) => match keys::find(&full) {
                    Some((_, key)) => json_of(key, key.kind, value),
                    None => free(value),
                },
            };
            all.insert(name.clone(), value);
        }
        Value::Object(all)
    }
}

/// An assumption, or a varied key.
fn free(value: &Checked) -> Value {
    match value {
        Checked::Text(text) => json!(text),
        Checked::Axis(axis) => match &axis.values {
            SweepValues::List(list) => json!(list),
            SweepValues::Range { low, high, unit, count } => {
                json!(format!("{} {unit} .. {} {unit} / {count}", plain(*low), plain(*high)))
            }
        },
        _ => Value::Null,
    }
}

fn json_of(key: &Key, kind: Kind, value: &Checked) -> Value {
    match (value, kind) {
        (Checked::Text(text), _) => json!(text),
        (Checked::Boolean(value), _) => json!(value),
        (Checked::Integer(value), _) => json!(value),
        (Checked::Choice(word), _) => json!(word),
        (Checked::Choices(words), _) => json!(words),
        (Checked::Either(index, value), Kind::Either(kinds)) => {
            json_of(key, kinds[*index], &Checked::Number(*value))
        }
        (
            _,
            Kind::Quantity(dimension, range)
            | Kind::Vector(dimension, range)
            | Kind::Profile(dimension, range)
            | Kind::TrueOrProfile(dimension, range)
            | Kind::Quantities(dimension, range)
            | Kind::QuantityList(dimension, range),
        ) => {
            let quantity = |value: f64| json!(quantity(key, value, dimension, range));
            match value {
                Checked::Vector(values) => json!(values.map(quantity)),
                Checked::Quantities(values) => {
                    values.iter().map(|value| quantity(*value)).collect()
                }
                Checked::Profile(of) => profile(of, &quantity),
                other => other.number().map_or(Value::Null, quantity),
            }
        }
        (other, _) => json!(other.number()),
    }
}

/// A quantity in the key's usual unit, or in SI if that gives other bits.
fn quantity(key: &Key, value: f64, dimension: Dimension, range: Range) -> String {
    let unit = key.usual_unit(dimension, range);
    let scale = dimension.find(unit).map_or(1.0, |unit| unit.scale.factor());
    let number = format!("{:.14e}", value / scale).parse().unwrap_or(value);
    let text = format!("{} {unit}", plain(number));
    if parse_quantity(&text, dimension).is_ok_and(|same| same.si == value) {
        return text;
    }
    format!("{} {}", plain(value), dimension.si_unit())
}

fn profile(profile: &Profile, own: &dyn Fn(f64) -> Value) -> Value {
    let time = |value: f64| format!("{} s", plain(value));
    match profile {
        Profile::Constant(value) => own(*value),
        Profile::Ramp { from, to, start, duration } => json!({
            "ramp": [own(*from), own(*to)], "start": time(*start), "duration": time(*duration),
        }),
        Profile::SmoothRamp { from, to, start, duration } => json!({
            "smooth_ramp": [own(*from), own(*to)], "start": time(*start), "duration": time(*duration),
        }),
        Profile::Table { points } => {
            let pair = |[at, value]: &[f64; 2]| json!([time(*at), own(*value)]);
            json!({ "table": points.iter().map(pair).collect::<Vec<_>>() })
        }
        Profile::Harmonic { mean, amplitude, frequency, phase } => json!({
            "amplitude": own(*amplitude),
            "mean": own(*mean),
            "frequency": format!("{} Hz", plain(*frequency)),
            "phase": format!("{} rad", plain(*phase)),
        }),
        Profile::HalfSine { base, peak, start, duration } => json!({
            "half_sine": own(*peak), "base": own(*base), "start": time(*start), "duration": time(*duration),
        }),
    }
}
