//! Report of a comparison: text and JSON.

use crate::output::compare::{ChannelResult, Comparison, Divergence, DivergenceKind};
use crate::output::visible::visible_line;
use serde_json::{Value, json};
use std::fmt::Write;

/// Number of channels listed in the text; the JSON form has all.
const LISTED: usize = 20;
/// Characters of a line that lists names, unless one name is longer.
const WIDTH: usize = 100;

pub fn report(comparison: &Comparison) -> String {
    let mut text = String::new();
    match &comparison.first_divergence {
        None => equal(&mut text, comparison),
        Some(first) => different(&mut text, comparison, first),
    }
    list(&mut text, "not compared", &comparison.ignored);
    if !comparison.unclaimed.is_empty() {
        line(&mut text, format!("not claimed: {}", comparison.unclaimed.join(", ")));
    }
    list(&mut text, "only in the candidate", &comparison.only_in_candidate);
    text
}

fn equal(text: &mut String, comparison: &Comparison) {
    let channels = comparison.channels.len();
    line(text, format!("equal: {} values in {channels} channels", comparison.checked));
    if let Some(channel) = by_ratio(comparison).first()
        && let Some(worst) = &channel.worst
        && worst.ratio > 0.0
    {
        line(
            text,
            format!(
                "largest difference relative to tolerance: {}, {} at {}, {:.2} of the tolerance ({})",
                channel.file,
                name(&channel.channel, &channel.unit),
                worst.place,
                worst.ratio,
                channel.class
            ),
        );
    }
}

fn different(text: &mut String, comparison: &Comparison, first: &Divergence) {
    line(
        text,
        format!(
            "different: {} differences, {} values compared",
            comparison.differing, comparison.checked
        ),
    );
    let mut place = first.file.clone();
    for part in [name(&first.channel, &first.unit), first.place.clone()] {
        if !part.is_empty() {
            place = format!("{place}, {part}");
        }
    }
    line(text, format!("first divergence: {place}"));
    line(text, format!("  {}", kind_text(&first.kind)));
    let differing: Vec<&ChannelResult> =
        by_ratio(comparison).into_iter().filter(|channel| channel.differing > 0).collect();
    if !differing.is_empty() {
        line(text, "channels that differ, worst first:".to_string());
    }
    for channel in differing.iter().take(LISTED) {
        let mut row = format!(
            "  {}, {} ({}): {} differences",
            channel.file,
            name(&channel.channel, &channel.unit),
            channel.class,
            channel.differing,
        );
        if let Some(worst) = channel.worst.as_ref().filter(|worst| worst.ratio > 0.0) {
            let _ = write!(
                row,
                ", largest {:e}, allowed {:e}, at {}",
                worst.difference, worst.allowed, worst.place
            );
        }
        line(text, row);
    }
    if differing.len() > LISTED {
        line(text, format!("  and {} more", differing.len() - LISTED));
    }
}

fn kind_text(kind: &DivergenceKind) -> String {
    match kind {
        DivergenceKind::Value { reference, candidate, difference, allowed } => format!(
            "reference {reference:?}, candidate {candidate:?}, difference {difference:e}, allowed {allowed:e}"
        ),
        DivergenceKind::Exact { reference, candidate } => {
            format!("reference {reference}, candidate {candidate}, must be equal")
        }
        DivergenceKind::Unit { reference, candidate } => {
            format!("reference in {reference:?}, candidate in {candidate:?}")
        }
        DivergenceKind::Length { reference, candidate } => {
            format!("reference has {reference} rows, candidate {candidate}")
        }
        DivergenceKind::MissingFile => "the candidate has no such file".to_string(),
        DivergenceKind::MissingChannel => "missing in the candidate".to_string(),
        DivergenceKind::OnlyInCandidate => "the reference has no such element".to_string(),
    }
}

/// Complete report as JSON; numbers that are not finite are strings.
pub fn to_json(comparison: &Comparison) -> Value {
    let channels: Vec<Value> = comparison.channels.iter().map(channel_json).collect();
    json!({
        "equal": comparison.equal,
        "checked": comparison.checked,
        "differing": comparison.differing,
        "first_divergence": comparison.first_divergence.as_ref().map(divergence_json),
        "channels": channels,
        "ignored": comparison.ignored,
        "unclaimed": comparison.unclaimed,
        "only_in_candidate": comparison.only_in_candidate,
    })
}

fn channel_json(channel: &ChannelResult) -> Value {
    json!({
        "file": channel.file,
        "channel": channel.channel,
        "unit": channel.unit,
        "class": channel.class,
        "checked": channel.checked,
        "differing": channel.differing,
        "worst": channel.worst.as_ref().map(|worst| json!({
            "place": worst.place,
            "difference": number(worst.difference),
            "allowed": number(worst.allowed),
            "ratio": number(worst.ratio),
        })),
    })
}

fn divergence_json(divergence: &Divergence) -> Value {
    let detail = match &divergence.kind {
        DivergenceKind::Value { reference, candidate, difference, allowed } => json!({
            "kind": "value",
            "reference": number(*reference),
            "candidate": number(*candidate),
            "difference": number(*difference),
            "allowed": number(*allowed),
        }),
        DivergenceKind::Exact { reference, candidate } => {
            json!({ "kind": "exact", "reference": reference, "candidate": candidate })
        }
        DivergenceKind::Unit { reference, candidate } => {
            json!({ "kind": "unit", "reference": reference, "candidate": candidate })
        }
        DivergenceKind::Length { reference, candidate } => {
            json!({ "kind": "length", "reference": reference, "candidate": candidate })
        }
        DivergenceKind::MissingFile => json!({ "kind": "missing-file" }),
        DivergenceKind::MissingChannel => json!({ "kind": "missing-channel" }),
        DivergenceKind::OnlyInCandidate => json!({ "kind": "only-in-candidate" }),
    };
    json!({
        "file": divergence.file,
        "channel": divergence.channel,
        "unit": divergence.unit,
        "place": divergence.place,
        "detail": detail,
    })
}

fn number(value: f64) -> Value {
    match value.is_finite() {
        true => json!(value),
        false => json!(value.to_string()),
    }
}

fn by_ratio(comparison: &Comparison) -> Vec<&ChannelResult> {
    let ratio = |channel: &ChannelResult| channel.worst.as_ref().map_or(0.0, |worst| worst.ratio);
    let mut channels: Vec<&ChannelResult> = comparison.channels.iter().collect();
    channels.sort_by(|a, b| ratio(b).total_cmp(&ratio(a)));
    channels
}

fn name(channel: &str, unit: &str) -> String {
    match unit {
        "" => channel.to_string(),
        _ => format!("{channel} [{unit}]"),
    }
}

/// Lists `file: channel` items by file in lines of the width of a screen; long lists are cut.
fn list(text: &mut String, title: &str, items: &[String]) {
    if items.is_empty() {
        return;
    }
    line(text, format!("{title}:"));
    let mut file_before = None;
    let mut row = String::new();
    for item in items.iter().take(LISTED) {
        let (file, name) = item.split_once(": ").unwrap_or(("", item));
        let goes_on = file_before == Some(file) && row.len() + name.len() + 2 <= WIDTH;
        if goes_on {
            let _ = write!(row, ", {name}");
            continue;
        }
        if !row.is_empty() {
            line(text, row);
        }
        row = format!("  {file}: {name}");
        file_before = Some(file);
    }
    line(text, row);
    if items.len() > LISTED {
        line(text, format!("  and {} more, see --json", items.len() - LISTED));
    }
}

fn line(text: &mut String, content: String) {
    // A key of a file may contain a line break, which could imitate a line of this report.
    text.push_str(&visible_line(&content));
    text.push('\n');
}
