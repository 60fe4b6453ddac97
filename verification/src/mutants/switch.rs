//! All faults in one build: each stands beside the right body of its function, behind a switch that
//! an environment variable sets when a program starts.

use std::collections::BTreeMap;
use std::ops::Range;

use serde_json::Value;
use syn::visit::{self, Visit};

use super::list::Mutant;
use super::workshop::Sources;

/// Number of the fault that a program is to have; none where it is not set.
pub const VARIABLE: &str = "SEEDED_FAULT";

/// Ends the roots of library and command.
const SWITCH: &str = r#"
/// Number of the fault to run with; 0 for none.
#[doc(hidden)]
#[allow(dead_code)]
pub fn seeded_fault() -> usize {
    static NUMBER: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    let set = || std::env::var("SEEDED_FAULT").ok().and_then(|number| number.parse().ok());
    *NUMBER.get_or_init(|| set().unwrap_or(0))
}
"#;

/// Sources with switches in them.
pub struct Switched {
    pub sources: Sources,
    /// By id: what sets a fault off.
    pub numbers: BTreeMap<String, usize>,
    places: Vec<Place>,
}

/// A function's body with all its faults.
struct Place {
    file: String,
    bytes: Range<usize>,
    ids: Vec<String>,
}

impl Switched {
    /// Puts a switch for every fault that stands in the body of a function and is not `barred`. Other
    /// faults have no number.
    ///
    /// # Errors
    /// When a fault does not apply.
    pub fn new(
        sources: &Sources,
        mutants: &[Mutant],
        barred: &[String],
    ) -> Result<Switched, String> {
        let mut sources = Sources(sources.0.clone());
        let (mut numbers, mut places) = (BTreeMap::new(), Vec::new());
        let mut files: BTreeMap<&str, Vec<(usize, &Mutant)>> = BTreeMap::new();
        for (index, mutant) in mutants.iter().enumerate().filter(|(_, m)| !barred.contains(&m.id)) {
            files.entry(&mutant.file).or_default().push((index + 1, mutant));
        }
        for (file, faults) in files {
            let Some(right) = sources.0.get(file).and_then(|bytes| std::str::from_utf8(bytes).ok())
            else {
                continue;
            };
            let mut text = String::new();
            let mut copied = 0;
            for body in bodies(right) {
                let mut arms = String::new();
                let mut ids = Vec::new();
                for (number, mutant) in &faults {
                    if let Some(wrong) = wrong_body(right, &body, mutant)? {
                        arms += &format!("{number} => {{{wrong}}}\n");
                        numbers.insert(mutant.id.clone(), *number);
                        ids.push(mutant.id.clone());
                    }
                }
                if ids.is_empty() {
                    continue;
                }
                text += &right[copied..body.start];
                let start = text.len();
                text += &format!(" match crate::seeded_fault() {{\n{arms}_ => {{");
                text += &right[body.clone()];
                text += "}} ";
                places.push(Place { file: file.into(), bytes: start..text.len(), ids });
                copied = body.end;
            }
            text += &right[copied..];
            sources.0.insert(file.into(), text.into_bytes());
        }
        for root in ["src/lib.rs", "src/main.rs"] {
            if let Some(text) = sources.0.get_mut(root) {
                text.extend_from_slice(SWITCH.as_bytes());
            }
        }
        Ok(Switched { sources, numbers, places })
    }

    /// Faults of the functions that a compiler's messages (JSON, one a line) find errors in.
    pub fn blamed(&self, messages: &str) -> Vec<String> {
        let mut ids = Vec::new();
        for message in errors(messages) {
            for span in message["spans"].as_array().into_iter().flatten() {
                let at = span["byte_start"].as_u64().unwrap_or(0) as usize;
                let here = |place: &&Place| {
                    span["file_name"] == place.file.as_str() && place.bytes.contains(&at)
                };
                ids.extend(self.places.iter().filter(here).flat_map(|place| place.ids.clone()));
            }
        }
        ids
    }
}

/// The compiler's messages of errors, as it would say them.
pub fn rendered(messages: &str) -> String {
    errors(messages).filter_map(|message| Some(message["rendered"].as_str()?.to_owned())).collect()
}

fn errors(messages: &str) -> impl Iterator<Item = Value> + '_ {
    let read = |line: &str| serde_json::from_str::<Value>(line).ok();
    let of = messages.lines().filter_map(read).map(|mut message| message["message"].take());
    of.filter(|message| message["level"] == "error")
}

/// A function's body with a fault that stands in it.
fn wrong_body(right: &str, body: &Range<usize>, mutant: &Mutant) -> Result<Option<String>, String> {
    mutant.seeded(right)?;
    // What a fault changes may be less than the text that shows its place.
    let (find, replace) = (mutant.find.as_str(), mutant.replace.as_str());
    let same = |(a, b): &(char, char)| a == b;
    let alike = |(a, _): (char, char)| a.len_utf8();
    let before: usize = find.chars().zip(replace.chars()).take_while(same).map(alike).sum();
    let (find, replace) = (&find[before..], &replace[before..]);
    let pairs = find.chars().rev().zip(replace.chars().rev());
    let after: usize = pairs.take_while(same).map(alike).sum();
    let start = right.find(&mutant.find).unwrap_or(0) + before;
    let end = start + find.len() - after;
    let replace = &replace[..replace.len() - after];
    if start < body.start || end > body.end {
        return Ok(None);
    }
    let wrong = format!("{}{}{}", &right[body.start..start], replace, &right[end..body.end]);
    // What ends this function and begins another is no body.
    Ok(syn::parse_str::<syn::Block>(&format!("{{{wrong}}}")).is_ok().then_some(wrong))
}

/// What stands between the braces of each outermost function that can look at the switch and whose
/// value has a type that can be named.
fn bodies(source: &str) -> Vec<Range<usize>> {
    let mut found = Bodies(Vec::new());
    if let Ok(file) = syn::parse_file(source) {
        found.visit_file(&file);
    }
    found.0.sort_by_key(|body| body.start);
    found.0
}

struct Bodies(Vec<Range<usize>>);

impl Bodies {
    /// Whether the function may have a switch, so that one within it needs none.
    fn take(&mut self, signature: &syn::Signature, block: &syn::Block) -> bool {
        let mut unnamed = Unnamed(false);
        unnamed.visit_return_type(&signature.output);
        let fit = signature.constness.is_none() && !unnamed.0;
        if fit {
            let braces = block.brace_token.span;
            self.0.push(braces.open().byte_range().end..braces.close().byte_range().start);
        }
        fit
    }
}

impl<'ast> Visit<'ast> for Bodies {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        if !self.take(&item.sig, &item.block) {
            visit::visit_item_fn(self, item);
        }
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        if !self.take(&item.sig, &item.block) {
            visit::visit_impl_item_fn(self, item);
        }
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if !item.default.as_ref().is_some_and(|block| self.take(&item.sig, block)) {
            visit::visit_trait_item_fn(self, item);
        }
    }
}

/// Whether a type is `impl …`: two bodies would be of two types.
struct Unnamed(bool);

impl<'ast> Visit<'ast> for Unnamed {
    fn visit_type_impl_trait(&mut self, _: &'ast syn::TypeImplTrait) {
        self.0 = true;
    }
}
