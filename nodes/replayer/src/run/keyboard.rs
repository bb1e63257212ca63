//! Keyboard input, read on a thread of its own.

use std::io::BufRead;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use crate::pause::{Command, Pause};

pub(super) struct Keyboard {
    commands: Receiver<Command>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KeyPress {
    Nothing,
    Resumed,
    Quit,
}

impl Keyboard {
    /// Reads `input` to its end on a thread that ends with the process.
    pub(super) fn read(input: impl BufRead + Send + 'static) -> std::io::Result<Self> {
        let (send, commands) = channel();
        let body = move || {
            for line in input.lines() {
                let Ok(line) = line else { return };
                if send.send(Command::of(&line)).is_err() {
                    return;
                }
            }
        };
        std::thread::Builder::new()
            .name("keyboard".into())
            .spawn(body)?;
        Ok(Keyboard { commands })
    }

    /// Applies the typed lines. If the input has ended, a pause is lifted, since it could never end
    /// otherwise.
    pub(super) fn take(&self, pause: &mut Pause) -> KeyPress {
        let before = *pause;
        loop {
            match self.commands.try_recv() {
                Ok(Command::Step) => pause.step(),
                Ok(Command::Toggle) => pause.toggle(),
                Ok(Command::Quit) => return KeyPress::Quit,
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    if pause.is_paused() && !pause.may_step() {
                        *pause = Pause::new(false);
                    }
                    break;
                }
            }
        }
        match before.is_paused() && !pause.is_paused() {
            true => KeyPress::Resumed,
            false => KeyPress::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Types lines until the result satisfies `until`; returns the last effect and the pause.
    fn typed(lines: &'static str, until: impl Fn(KeyPress, Pause) -> bool) -> (KeyPress, Pause) {
        let keyboard = Keyboard::read(Cursor::new(lines)).unwrap();
        let mut pause = Pause::new(true);
        loop {
            let pressed = keyboard.take(&mut pause);
            if until(pressed, pause) {
                return (pressed, pause);
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn lines_step_play_and_quit() {
        let (_, pause) = typed("\nn\n", |_, pause| pause.may_step());
        assert!(pause.is_paused());
        let (pressed, pause) = typed("p\n", |pressed, _| pressed != KeyPress::Nothing);
        assert_eq!((pressed, pause.is_paused()), (KeyPress::Resumed, false));
        let (pressed, _) = typed("q\n", |pressed, _| pressed != KeyPress::Nothing);
        // The end of the input may be seen at the same time or later.
        assert_eq!(pressed, KeyPress::Quit);
    }

    #[test]
    fn where_nobody_types_nothing_is_held_up() {
        let (pressed, pause) = typed("", |pressed, _| pressed != KeyPress::Nothing);
        assert_eq!((pressed, pause.is_paused()), (KeyPress::Resumed, false));
    }
}
