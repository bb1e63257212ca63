//! Formats a recording's contents for people.

use std::fmt::Write as _;

use super::contents::Contents;

/// Paragraphs: the file, its channels, metadata, attachments, damage.
pub(crate) fn of(contents: &Contents) -> String {
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write(contents, &mut text);
    text
}

fn write(contents: &Contents, text: &mut String) -> std::fmt::Result {
    let Contents {
        recording,
        messages,
        chunks,
        ..
    } = contents;
    let megabytes = contents.bytes as f64 * 1e-6;
    writeln!(
        text,
        "{recording}: {megabytes:.2} MB, {messages} messages in {chunks} chunks"
    )?;
    if let Some((first, last)) = contents.first_ns.zip(contents.last_ns) {
        let (from, to) = (first as f64 * 1e-9, last as f64 * 1e-9);
        writeln!(text, "from {from:.3} to {to:.3} s, {:.1} s long", to - from)?;
    }
    channels(contents, text)?;
    let taken = contents.taken.iter();
    let taken: Vec<String> = taken
        .map(|(what, topic)| format!("{what} {topic}"))
        .collect();
    if !taken.is_empty() {
        writeln!(text, "\n  taken: {}", taken.join(", "))?;
    }
    for unclear in &contents.unclear {
        writeln!(text, "\n  unclear: {unclear}")?;
    }
    for metadata in &contents.metadata {
        writeln!(text, "\nmetadata {}", metadata.name)?;
        for (key, value) in &metadata.entries {
            writeln!(text, "  {key:<14} {value}")?;
        }
    }
    for file in &contents.attachments {
        writeln!(
            text,
            "\nattachment {}: {} bytes, {}",
            file.name, file.bytes, file.media_type
        )?;
    }
    if let Some(damage) = &contents.damage {
        writeln!(
            text,
            "\ndamaged: {damage}; what is listed here lies before that"
        )?;
    }
    Ok(())
}

/// Largest width of the column of topics; longer topics break the alignment.
const MAX_WIDTH: usize = 80;

fn channels(contents: &Contents, text: &mut String) -> std::fmt::Result {
    let topics = contents.channels.iter().map(|channel| channel.topic.len());
    let width = topics.max().unwrap_or(0).clamp("channel".len(), MAX_WIDTH);
    writeln!(
        text,
        "\n  {:<width$} {:>9} {:>8}  schema",
        "channel", "messages", "hz"
    )?;
    for channel in &contents.channels {
        let hz = channel.hz.map_or(String::new(), |hz| format!("{hz:.2}"));
        let encoding = match channel.encoding.as_str() {
            "cdr" => String::new(),
            other => format!(" ({other})"),
        };
        writeln!(
            text,
            "  {:<width$} {:>9} {hz:>8}  {}{encoding}",
            channel.topic, channel.messages, channel.schema
        )?;
    }
    Ok(())
}
