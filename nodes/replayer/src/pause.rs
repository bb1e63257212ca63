//! Pausing and single steps, controlled by typed lines. Pure.

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Command {
    Step,
    Toggle,
    Quit,
}

impl Command {
    pub(crate) fn of(line: &str) -> Self {
        match line.trim() {
            "p" => Command::Toggle,
            "q" => Command::Quit,
            _ => Command::Step,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pause {
    paused: bool,
    steps: u32,
}

impl Pause {
    pub(crate) fn new(paused: bool) -> Self {
        Pause { paused, steps: 0 }
    }

    pub(crate) fn is_paused(self) -> bool {
        self.paused
    }

    /// Returns true if something may be sent while paused.
    pub(crate) fn may_step(self) -> bool {
        self.steps > 0
    }

    pub(crate) fn stepped(&mut self) {
        self.steps = self.steps.saturating_sub(1);
    }

    /// Pauses after one more scan.
    pub(crate) fn step(&mut self) {
        self.paused = true;
        self.steps = self.steps.saturating_add(1);
    }

    pub(crate) fn toggle(&mut self) {
        *self = Pause::new(!self.paused);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_let_one_scan_pass_each() {
        let mut pause = Pause::new(true);
        assert!(pause.is_paused() && !pause.may_step());
        pause.step();
        pause.step();
        pause.stepped();
        assert!(pause.may_step());
        pause.stepped();
        assert!(!pause.may_step());
        pause.toggle();
        assert!(!pause.is_paused());
        pause.step();
        assert!(pause.is_paused() && pause.may_step());
    }
}
