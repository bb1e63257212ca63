//! What somebody types, read on a thread of its own.

use std::io::BufRead;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use crate::pause::{Pause, Wish};

/// The typed lines.
pub(super) struct Keyboard {
    wishes: Receiver<Wish>,
}

/// What came of the lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Heard {
    Nothing,
    /// Playing goes on after a pause.
    Resumed,
    Quit,
}

impl Keyboard {
    /// Reads `input` to its end. The thread stays with it; it ends with the
    /// process.
    pub(super) fn read(input: impl BufRead + Send + 'static) -> std::io::Result<Self> {
        let (send, wishes) = channel();
        let body = move || {
            for line in input.lines() {
                let Ok(line) = line else { return };
                if send.send(Wish::of(&line)).is_err() {
                    return;
                }
            }
        };
        std::thread::Builder::new()
            .name("keyboard".into())
            .spawn(body)?;
        Ok(Keyboard { wishes })
    }

    /// Takes what was typed. Where nobody can type any more, nothing is held up.
    pub(super) fn take(&self, pause: &mut Pause) -> Heard {
        let before = *pause;
        loop {
            match self.wishes.try_recv() {
                Ok(Wish::Step) => pause.step(),
                Ok(Wish::Toggle) => pause.toggle(),
                Ok(Wish::Quit) => return Heard::Quit,
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
            true => Heard::Resumed,
            false => Heard::Nothing,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    /// What was heard, and the pause in the end, once `until` holds.
    fn typed(lines: &'static str, until: impl Fn(Heard, Pause) -> bool) -> (Heard, Pause) {
        let keyboard = Keyboard::read(Cursor::new(lines)).unwrap();
        let mut pause = Pause::new(true);
        loop {
            let heard = keyboard.take(&mut pause);
            if until(heard, pause) {
                return (heard, pause);
            }
            std::thread::yield_now();
        }
    }

    #[test]
    fn lines_step_play_and_quit() {
        let (_, pause) = typed("\nn\n", |_, pause| pause.may_step());
        assert!(pause.is_paused());
        let (heard, pause) = typed("p\n", |heard, _| heard != Heard::Nothing);
        assert_eq!((heard, pause.is_paused()), (Heard::Resumed, false));
        let (heard, _) = typed("q\n", |heard, _| heard != Heard::Nothing);
        // The end of what is typed may be seen with it, or not.
        assert_eq!(heard, Heard::Quit);
    }

    #[test]
    fn where_nobody_types_nothing_is_held_up() {
        let (heard, pause) = typed("", |heard, _| heard != Heard::Nothing);
        assert_eq!((heard, pause.is_paused()), (Heard::Resumed, false));
    }
}
