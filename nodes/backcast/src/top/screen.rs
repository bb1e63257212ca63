//! Terminal output: drawn when there is new data, restored at the end.

use std::sync::mpsc::Receiver;
use std::time::{Duration, Instant};

use anyhow::Context;
use ratatui::DefaultTerminal;
use ratatui::crossterm::event::{self, Event, KeyCode, KeyModifiers};
use ratatui::widgets::Paragraph;

use super::known::Known;
use super::lines;
use super::source::Update;

/// Longest wait for a key between two checks for updates.
const FRAME: Duration = Duration::from_millis(50);

const UNUSABLE: &str = "cannot use the terminal";

/// Redraw interval for ages without new data.
const AGES: Duration = Duration::from_millis(500);

pub(super) fn show(mut known: Known, updates: &Receiver<Update>) -> anyhow::Result<()> {
    let mut terminal = ratatui::try_init().context(UNUSABLE)?;
    let shown = follow(&mut terminal, &mut known, updates);
    ratatui::try_restore().context(UNUSABLE)?;
    shown
}

fn follow(
    terminal: &mut DefaultTerminal,
    known: &mut Known,
    updates: &Receiver<Update>,
) -> anyhow::Result<()> {
    let mut is_new = true;
    let mut drawn = Instant::now();
    loop {
        for message in updates.try_iter() {
            is_new = true;
            match message {
                Ok(message) => known.receive(message, Instant::now()),
                Err(problem) => known.lost = Some(problem),
            }
        }
        let now = Instant::now();
        if std::mem::take(&mut is_new) || now - drawn >= AGES {
            drawn = now;
            let draw = |frame: &mut ratatui::Frame<'_>| {
                frame.render_widget(Paragraph::new(lines::text(known, now)), frame.area());
            };
            terminal.draw(draw).context(UNUSABLE)?;
        }
        if event::poll(FRAME).context(UNUSABLE)? {
            match event::read().context(UNUSABLE)? {
                Event::Key(key) if ends(key.code, key.modifiers) => return Ok(()),
                // The window may have a new size.
                _ => is_new = true,
            }
        }
    }
}

fn ends(code: KeyCode, modifiers: KeyModifiers) -> bool {
    matches!(code, KeyCode::Char('q') | KeyCode::Esc)
        || code == KeyCode::Char('c') && modifiers.contains(KeyModifiers::CONTROL)
}
