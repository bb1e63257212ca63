//! The instruction sets that hot loops are written for, chosen at run time.
//!
//! A released binary is built for the baseline CPU of its architecture
//! and yet uses what it finds. Every instruction set gives the same numbers.

use std::fmt;

/// A set of instructions, from the baseline on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// What every processor of the architecture has; on aarch64 with NEON, as
    /// far as the compiler uses it by itself.
    #[default]
    Portable,
    /// AVX2, BMI 1 and 2, LZCNT and POPCNT: x86-64 since Haswell and Zen.
    Avx2,
}

impl InstructionSet {
    /// The best one that this processor has.
    #[must_use]
    pub fn best() -> Self {
        if Self::Avx2.is_available() {
            Self::Avx2
        } else {
            Self::Portable
        }
    }

    /// All that this processor has, from the baseline on.
    pub fn available() -> impl Iterator<Item = Self> {
        let all = [Self::Portable, Self::Avx2];
        all.into_iter().filter(|set| set.is_available())
    }

    /// Whether this processor has it.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            Self::Portable => true,
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => {
                is_x86_feature_detected!("avx2")
                    && is_x86_feature_detected!("bmi1")
                    && is_x86_feature_detected!("bmi2")
                    && is_x86_feature_detected!("lzcnt")
                    && is_x86_feature_detected!("popcnt")
            }
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx2 => false,
        }
    }

    /// The set itself.
    ///
    /// # Panics
    /// If this processor does not have it.
    #[must_use]
    pub fn checked(self) -> Self {
        assert!(self.is_available(), "this processor has no {self}");
        self
    }
}

impl fmt::Display for InstructionSet {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Portable => "portable",
            Self::Avx2 => "AVX2",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_is_the_last_that_is_available() {
        let available: Vec<_> = InstructionSet::available().collect();
        assert_eq!(available.first(), Some(&InstructionSet::Portable));
        assert_eq!(available.last(), Some(&InstructionSet::best()));
        assert!(available.is_sorted());
        assert_eq!(InstructionSet::best().checked(), InstructionSet::best());
    }
}
