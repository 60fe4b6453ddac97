//! Text from files on its way to a person.

use std::borrow::Cow;

/// The text with characters that a terminal obeys instead of showing written as `\u001b`: control
/// characters, and those that turn the direction of writing. Line breaks and tabs stay. Inside a JSON
/// string this is the same string.
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, |c| commands_terminal(c) && !matches!(c, '\n' | '\t'))
}

/// The same in one line: line breaks and tabs are written out as well.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_that_a_terminal_obeys_is_left() {
        let title = "\u{1b}[2J\u{9b}31m\r\u{7f}\u{202e}\nµm\t²";
        assert_eq!(visible(title), "\\u001b[2J\\u009b31m\\u000d\\u007f\\u202e\nµm\t²");
        assert_eq!(visible_line("a\nb\tc"), "a\\u000ab\\u0009c");
        assert!(matches!(visible("plain\n"), Cow::Borrowed(_)));
        let json = serde_json::Value::from(title).to_string();
        let read: String = serde_json::from_str(&visible(&json)).unwrap();
        assert_eq!(read, title);
    }
}
