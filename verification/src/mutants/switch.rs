//! Sources with all faults at once: a function with faults gets one body for each of them, chosen by the
//! environment variable `SEEDED_FAULT`. The compiler takes no such bodies for a `const fn` or a function that returns
//! `impl …`.

use std::collections::BTreeMap;
use std::ops::Range;

use syn::visit::Visit;

use super::list::{Mutant, Sources};

/// Number of the fault to run with, counted from 1 in the order of the list; 0 for none.
pub const VARIABLE: &str = "SEEDED_FAULT";

/// Appended to the roots of library and command.
const SWITCH: &str = r#"
/// Number of the fault to run with; 0 for none.
#[doc(hidden)]
pub fn seeded_fault() -> usize {
    static NUMBER: std::sync::OnceLock<usize> = std::sync::OnceLock::new();
    let set = || std::env::var("SEEDED_FAULT").ok().and_then(|number| number.parse().ok());
    *NUMBER.get_or_init(|| set().unwrap_or(0))
}
"#;

/// The sources with a switch for each fault.
///
/// # Errors
/// When the text of a fault does not occur exactly once, or not within the body of one function.
pub fn switched(sources: &Sources, mutants: &[Mutant]) -> Result<Sources, String> {
    let mut by_file: BTreeMap<&str, Vec<(usize, &Mutant, usize)>> = BTreeMap::new();
    for (index, mutant) in mutants.iter().enumerate() {
        let (file, at) = mutant.place(sources)?;
        by_file.entry(file).or_default().push((index + 1, mutant, at));
    }
    let mut all = sources.clone();
    for (file, faults) in by_file {
        let right = &sources[file];
        let bodies = bodies(right);
        let mut arms: BTreeMap<usize, String> = BTreeMap::new();
        for (number, mutant, at) in faults {
            let end = at + mutant.find.len();
            let holds = |body: &&Range<usize>| body.start <= at && end <= body.end;
            let body = bodies.iter().find(holds).ok_or_else(|| {
                let id = &mutant.id;
                format!("fault `{id}`: its text is not within one function's body in {file}")
            })?;
            let (before, after) = (&right[body.start..at], &right[end..body.end]);
            let arm = format!("{number} => {{{before}{}{after}}}\n", mutant.replace);
            *arms.entry(body.start).or_default() += &arm;
        }
        let (mut text, mut copied) = (String::new(), 0);
        for body in bodies.iter().filter(|body| arms.contains_key(&body.start)) {
            text += &right[copied..body.start];
            text += &format!(" match crate::seeded_fault() {{\n{}_ => {{", arms[&body.start]);
            text += &right[body.clone()];
            text += "}} ";
            copied = body.end;
        }
        text += &right[copied..];
        all.insert(file.into(), text);
    }
    for root in ["src/lib.rs", "src/main.rs"] {
        if let Some(text) = all.get_mut(root) {
            *text = format!("#![allow(unused)]\n{text}{SWITCH}");
        }
    }
    Ok(all)
}

/// The text between the braces of each outermost function.
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
    fn take(&mut self, block: &syn::Block) {
        let braces = block.brace_token.span;
        self.0.push(braces.open().byte_range().end..braces.close().byte_range().start);
    }
}

impl<'ast> Visit<'ast> for Bodies {
    fn visit_item_fn(&mut self, item: &'ast syn::ItemFn) {
        self.take(&item.block);
    }

    fn visit_impl_item_fn(&mut self, item: &'ast syn::ImplItemFn) {
        self.take(&item.block);
    }

    fn visit_trait_item_fn(&mut self, item: &'ast syn::TraitItemFn) {
        if let Some(block) = &item.default {
            self.take(block);
        }
    }
}
