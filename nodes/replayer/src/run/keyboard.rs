//! Pausing and single steps by typed lines, which are read on a thread of their own.

use std::io::BufRead;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

pub(super) struct Keyboard {
    lines: Receiver<String>,
    pub(super) is_paused: bool,
    /// Number of scans that may be sent while paused.
    pub(super) steps: u32,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum KeyPress {
    Nothing,
    Resumed,
    Quit,
}

impl Keyboard {
    /// Reads `input` to its end on a thread that ends with the process; playing is paused at first.
    pub(super) fn read(input: impl BufRead + Send + 'static) -> std::io::Result<Self> {
        let (send, lines) = channel();
        let body = move || {
            let mut lines = input.lines().map_while(Result::ok);
            lines.all(|line| send.send(line).is_ok())
        };
        std::thread::Builder::new()
            .name("keyboard".into())
            .spawn(body)?;
        Ok(Keyboard {
            lines,
            is_paused: true,
            steps: 0,
        })
    }

    /// Applies the typed lines. If the input has ended, a pause is lifted, since it could never end
    /// otherwise.
    pub(super) fn take(&mut self) -> KeyPress {
        let was_paused = self.is_paused;
        loop {
            match self.lines.try_recv().as_deref().map(str::trim) {
                Ok("p") => (self.is_paused, self.steps) = (!self.is_paused, 0),
                Ok("q") => return KeyPress::Quit,
                Ok(_) => (self.is_paused, self.steps) = (true, self.steps.saturating_add(1)),
                Err(TryRecvError::Empty) => break,
                Err(TryRecvError::Disconnected) => {
                    self.is_paused &= self.steps > 0;
                    break;
                }
            }
        }
        match was_paused && !self.is_paused {
            true => KeyPress::Resumed,
            false => KeyPress::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// Types lines until the result satisfies `until`; returns the last effect and the state.
    fn typed(
        lines: &'static str,
        until: impl Fn(KeyPress, &Keyboard) -> bool,
    ) -> (KeyPress, Keyboard) {
        let mut keyboard = Keyboard::read(Cursor::new(lines)).unwrap();
        loop {
            let pressed = keyboard.take();
            if until(pressed, &keyboard) {
                return (pressed, keyboard);
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn lines_step_play_and_quit() {
        let (_, keyboard) = typed("\nn\n", |_, keyboard| keyboard.steps == 2);
        assert!(keyboard.is_paused);
        let (pressed, keyboard) = typed("p\n", |pressed, _| pressed != KeyPress::Nothing);
        assert_eq!((pressed, keyboard.is_paused), (KeyPress::Resumed, false));
        let (pressed, _) = typed("q\n", |pressed, _| pressed != KeyPress::Nothing);
        // The end of the input may be seen at the same time or later.
        assert_eq!(pressed, KeyPress::Quit);
    }

    #[test]
    fn where_nobody_types_nothing_is_held_up() {
        let (pressed, keyboard) = typed("", |pressed, _| pressed != KeyPress::Nothing);
        assert_eq!((pressed, keyboard.is_paused), (KeyPress::Resumed, false));
    }
}
