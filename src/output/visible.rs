//! Escaping of text from files before it is printed.

use std::borrow::Cow;

/// Text with characters that control a terminal written as `\u001b`: control
/// characters, and those that change the direction of writing. Line breaks and tabs are kept. Inside a JSON
/// string the result is the same string.
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, |c| commands_terminal(c) && !matches!(c, '\n' | '\t'))
}

/// Like [`visible`], with line breaks and tabs escaped as well.
pub fn visible_line(text: &str) -> Cow<'_, str> {
    escaped(text, commands_terminal)
}

fn commands_terminal(c: char) -> bool {
    let turns =
        matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

fn escaped(text: &str, hidden: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&hidden) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match hidden(c) {
            true => shown += &format!("\\u{:04x}", u32::from(c)),
            false => shown.push(c),
        }
    }
    Cow::Owned(shown)
}
