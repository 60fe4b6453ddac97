//! Who calls whom, read off the sources: enough to see that a benchmark reaches a function, not to see
//! that it notices what the function returns.
//!
//! Calls are followed by name. A path (`hertz::contact`, `Tet4::new`) leads to functions of that module
//! or type, a bare name to the same file or to what the file imports, a method to the methods of that
//! name of all types that the caller's file, what it calls, or fields of such types name. What a name
//! cannot tell apart is taken as called, so that
//! a call may be seen where there is none, and none is missed but those through macros.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

/// One function and its calls.
#[derive(Debug)]
struct Function {
    file: usize,
    /// The type whose method it is.
    of_type: Option<String>,
    /// The innermost module that it stands in.
    module: String,
    name: String,
    /// Arguments and what it returns.
    signature: Vec<String>,
    /// The signature too.
    body: Vec<String>,
}

/// A file's module and what it imports.
#[derive(Debug)]
struct File {
    path: String,
    /// The last segment of its module's path.
    module: String,
    /// Every word of its `use` declarations.
    imports: BTreeSet<String>,
    /// New names for old ones.
    aliases: BTreeMap<String, String>,
}

/// All functions of some sources.
#[derive(Debug, Default)]
pub struct CallGraph {
    files: Vec<File>,
    functions: Vec<Function>,
    by_name: BTreeMap<String, Vec<usize>>,
    /// What the declarations of a type's name speak of.
    fields: BTreeMap<String, Vec<String>>,
    /// What each function calls, once it was asked for.
    calls: Vec<Option<BTreeSet<usize>>>,
}

/// What can be reached from somewhere.
#[derive(Debug, Default)]
pub struct Reached {
    /// Functions as `module::name`, methods as `Type::name`.
    pub functions: BTreeSet<String>,
    /// Every word in a body that is reached: types and constants among them.
    pub words: BTreeSet<String>,
}

impl Reached {
    /// Whether `module::name` is called, or named if it is a type or a constant.
    pub fn has(&self, module: &str, name: &str) -> bool {
        let is_function = name.starts_with(|c: char| c.is_ascii_lowercase());
        match is_function {
            true => self.functions.contains(&format!("{module}::{name}")),
            false => self.words.contains(name),
        }
    }
}

impl CallGraph {
    /// Adds a file; its path from the root.
    pub fn add(&mut self, path: &str, source: &str) {
        let words = words(source);
        let mut parts = path.trim_end_matches(".rs").rsplit('/');
        let module = match parts.next() {
            Some("mod" | "lib" | "main") => parts.next().unwrap_or_default(),
            last => last.unwrap_or_default(),
        };
        let mut file = File {
            path: path.into(),
            module: module.into(),
            imports: BTreeSet::new(),
            aliases: BTreeMap::new(),
        };
        let at = self.files.len();
        let mut of_type: Vec<(usize, String)> = Vec::new();
        let mut modules: Vec<(usize, String)> = vec![(0, module.into())];
        let (mut depth, mut i) = (0usize, 0usize);
        while i < words.len() {
            match words[i].as_str() {
                "use" => {
                    while i < words.len() && words[i] != ";" {
                        if words[i] == "as" {
                            file.aliases.insert(words[i + 1].clone(), words[i - 1].clone());
                        }
                        file.imports.insert(words[i].clone());
                        i += 1;
                    }
                }
                "impl" | "trait" => {
                    let end = i + words[i..].iter().position(|w| w == "{").unwrap_or(0);
                    of_type.push((depth + 1, subject(&words[i + 1..end])));
                    (i, depth) = (end, depth + 1);
                }
                "mod" if words.get(i + 2).is_some_and(|word| word == "{") => {
                    modules.push((depth + 1, words[i + 1].clone()));
                    (i, depth) = (i + 2, depth + 1);
                }
                "struct" | "enum" | "type" if i + 1 < words.len() && is_name(&words[i + 1]) => {
                    let open = brace_or_end(&words, i);
                    let end = if words[open] == "{" { closing(&words, open) } else { open };
                    let speaks_of = words[i + 2..end].iter().filter(|word| is_name(word)).cloned();
                    self.fields.entry(words[i + 1].clone()).or_default().extend(speaks_of);
                    i = end;
                }
                "fn" if i + 1 < words.len() && is_name(&words[i + 1]) => {
                    let open = brace_or_end(&words, i);
                    if words[open] == "{" {
                        let end = closing(&words, open);
                        let name = words[i + 1].clone();
                        let of_type = of_type.last().map(|(_, name)| name.clone());
                        let (signature, body) =
                            (words[i + 2..open].to_vec(), words[i + 2..end].to_vec());
                        self.by_name.entry(name.clone()).or_default().push(self.functions.len());
                        let module = modules.last().map_or(module, |(_, name)| name).to_string();
                        self.functions.push(Function {
                            file: at,
                            of_type,
                            module,
                            name,
                            signature,
                            body,
                        });
                        i = end;
                    } else {
                        i = open;
                    }
                }
                "{" => depth += 1,
                "}" => {
                    depth = depth.saturating_sub(1);
                    of_type.retain(|(inside, _)| *inside <= depth);
                    modules.retain(|(inside, _)| *inside <= depth);
                }
                _ => {}
            }
            i += 1;
        }
        self.files.push(file);
    }

    /// From the functions that `starts` picks by file and name.
    pub fn reached(&mut self, starts: impl Fn(&str, &str) -> bool) -> Reached {
        let mut found = Reached::default();
        let is_start = |f: &usize| {
            let function = &self.functions[*f];
            starts(&self.files[function.file].path, &function.name)
        };
        let mut queue: VecDeque<usize> = (0..self.functions.len()).filter(is_start).collect();
        let mut seen: BTreeSet<usize> = queue.iter().copied().collect();
        while let Some(function) = queue.pop_front() {
            let Function { of_type, module, name, body, .. } = &self.functions[function];
            let module = of_type.as_ref().unwrap_or(module);
            found.functions.insert(format!("{module}::{name}"));
            found.words.extend(body.iter().filter(|word| is_name(word)).cloned());
            found.words.extend(of_type.clone());
            if self.calls.len() != self.functions.len() {
                self.calls = vec![None; self.functions.len()];
            }
            if self.calls[function].is_none() {
                self.calls[function] = Some(self.called(function));
            }
            for &other in self.calls[function].iter().flatten() {
                if seen.insert(other) {
                    queue.push_back(other);
                }
            }
        }
        found
    }

    /// What a function can call.
    fn called(&self, function: usize) -> BTreeSet<usize> {
        let Function { file, of_type, body, .. } = &self.functions[function];
        let (mut called, mut methods) = (BTreeSet::new(), BTreeSet::new());
        for (i, word) in body.iter().enumerate() {
            let Some(candidates) = self.by_name.get(word) else { continue };
            let before = |back: usize| i.checked_sub(back).map_or("", |j| body[j].as_str());
            let of = |other: &usize| &self.functions[*other];
            let all = candidates.iter().copied();
            match before(1) {
                "::" => {
                    called.extend(all.filter(|o| self.is_qualified(function, before(2), of(o))))
                }
                "." => methods.extend(all.filter(|o| of(o).of_type.is_some())),
                "fn" => {}
                _ => called.extend(all.filter(|o| self.is_in_scope(*file, word, of(o)))),
            }
        }
        // A method's type is named here, or in what is called from here, or in the fields of such.
        let mut types: BTreeSet<&str> = BTreeSet::new();
        let mut new: Vec<&str> = of_type.iter().map(String::as_str).collect();
        let here = body.iter().chain(&self.files[*file].imports);
        new.extend(here.map(String::as_str).filter(|word| is_type(word)));
        let speaks = |other: usize| {
            let signature = self.functions[other].signature.iter().map(String::as_str);
            signature.filter(|word| is_type(word)).collect::<Vec<_>>()
        };
        new.extend(called.iter().flat_map(|other| speaks(*other)));
        loop {
            while let Some(name) = new.pop() {
                if types.insert(name) {
                    let fields = self.fields.get(name).into_iter().flatten();
                    new.extend(fields.map(String::as_str).filter(|word| is_type(word)));
                }
            }
            let is_named = |other: &usize| {
                let of_type = self.functions[*other].of_type.as_deref();
                of_type.is_some_and(|name| types.contains(name))
            };
            let ready: Vec<usize> = methods.iter().copied().filter(is_named).collect();
            for other in &ready {
                methods.remove(other);
                new.extend(speaks(*other));
            }
            if ready.is_empty() {
                return called;
            }
            called.extend(ready);
        }
    }

    /// Whether `qualifier::name` in a function can be `other`.
    fn is_qualified(&self, function: usize, qualifier: &str, other: &Function) -> bool {
        let from = &self.functions[function];
        let file = &self.files[from.file];
        let qualifier = file.aliases.get(qualifier).map_or(qualifier, String::as_str);
        match &other.of_type {
            Some(name) if qualifier == "Self" => from.of_type.as_ref() == Some(name),
            Some(name) => qualifier == name,
            None if ["self", "super", "crate"].contains(&qualifier) => {
                let folder = |path: &str| path.rsplit_once('/').map(|p| p.0.to_string());
                let there = &self.files[other.file].path;
                folder(there) == folder(&file.path) || there.ends_with("/mod.rs")
            }
            None => other.module == qualifier,
        }
    }

    /// Whether the bare `word` in a file can be `other`.
    fn is_in_scope(&self, file: usize, word: &str, other: &Function) -> bool {
        if other.of_type.is_some() {
            return false;
        }
        let (here, there) = (&self.files[file], &self.files[other.file]);
        other.file == file
            || (here.imports.contains(word) || here.imports.contains("*"))
                && (here.imports.contains(&other.module)
                    || here.imports.contains(&there.module)
                    || here.imports.contains("super"))
    }
}

/// The type that an `impl` or `trait` is of, from the words between it and its brace.
fn subject(head: &[String]) -> String {
    let head = match head.iter().rposition(|word| word == "for") {
        // `for<'a>` and bounds after `where` are none.
        Some(at) if head.get(at + 1).is_some_and(|word| word != "<") => &head[at + 1..],
        _ => head,
    };
    let (mut angle, mut last) = (0i32, String::new());
    for word in head {
        match word.as_str() {
            "<" => angle += 1,
            ">" => angle -= 1,
            "where" | ":" if angle == 0 => break,
            word if angle == 0 && is_name(word) => last = word.into(),
            _ => {}
        }
    }
    last
}

/// The brace that opens a declaration, or the semicolon that ends it; not one of an array's type.
fn brace_or_end(words: &[String], from: usize) -> usize {
    let mut depth = 0usize;
    for (i, word) in words.iter().enumerate().skip(from) {
        match word.as_str() {
            "[" | "(" => depth += 1,
            "]" | ")" => depth = depth.saturating_sub(1),
            "{" | ";" if depth == 0 => return i,
            _ => {}
        }
    }
    words.len() - 1
}

fn closing(words: &[String], open: usize) -> usize {
    let mut depth = 0usize;
    for (i, word) in words.iter().enumerate().skip(open) {
        match word.as_str() {
            "{" => depth += 1,
            "}" if depth == 1 => return i,
            "}" => depth -= 1,
            _ => {}
        }
    }
    words.len()
}

fn is_type(word: &str) -> bool {
    word.starts_with(|c: char| c.is_ascii_uppercase())
}

fn is_name(word: &str) -> bool {
    word.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names and signs of a source, without comments, text and modules of tests.
fn words(source: &str) -> Vec<String> {
    let source = source.split("#[cfg(test)]").next().unwrap_or_default();
    let chars: Vec<char> = source.chars().collect();
    let mut words = Vec::new();
    let mut i = 0;
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    while i < chars.len() {
        let c = chars[i];
        if c == '/' && at(i + 1) == '/' {
            while i < chars.len() && chars[i] != '\n' {
                i += 1;
            }
        } else if c == '"' {
            // A raw text ends at its own number of signs, others at a quote that is not escaped.
            let signs = words.iter().rev().take_while(|word: &&String| *word == "#").count();
            let is_raw = words.len() > signs && words[words.len() - signs - 1] == "r";
            i += 1;
            loop {
                let ends = if is_raw {
                    at(i) == '"' && (0..signs).all(|k| at(i + 1 + k) == '#')
                } else {
                    at(i) == '"'
                };
                if ends || i >= chars.len() {
                    break;
                }
                i += if !is_raw && at(i) == '\\' { 2 } else { 1 };
            }
            i += 1 + if is_raw { signs } else { 0 };
        } else if c == '\'' {
            // A character, or a lifetime.
            if at(i + 1) == '\\' {
                i += 3;
                while i < chars.len() && chars[i] != '\'' {
                    i += 1;
                }
                i += 1;
            } else if at(i + 2) == '\'' {
                i += 3;
            } else {
                i += 1;
            }
        } else if c.is_alphanumeric() || c == '_' {
            let start = i;
            while at(i).is_alphanumeric() || at(i) == '_' {
                i += 1;
            }
            words.push(chars[start..i].iter().collect());
        } else if c == ':' && at(i + 1) == ':' {
            words.push("::".into());
            i += 2;
        } else if c == '-' && at(i + 1) == '>' {
            i += 2;
        } else {
            if !c.is_whitespace() {
                words.push(c.to_string());
            }
            i += 1;
        }
    }
    words
}
