//! Instruction sets for which hot loops are compiled, chosen at run time.
//!
//! A released binary is built for the baseline CPU of its architecture but uses the instructions
//! that it finds. Every instruction set gives the same numbers.

use std::fmt;

/// An instruction set, in ascending order.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum InstructionSet {
    /// Baseline of the architecture; on aarch64 with NEON, as far as the compiler uses it by
    /// itself.
    #[default]
    Portable,
    /// AVX2, BMI 1 and 2, LZCNT and POPCNT: x86-64 since Haswell and Zen.
    Avx2,
}

impl InstructionSet {
    /// Returns the best instruction set of this processor.
    #[must_use]
    pub fn best() -> Self {
        if Self::Avx2.is_available() {
            Self::Avx2
        } else {
            Self::Portable
        }
    }

    /// Instruction sets of this processor, from the baseline on.
    pub fn available() -> impl Iterator<Item = Self> {
        let all = [Self::Portable, Self::Avx2];
        all.into_iter().filter(|set| set.is_available())
    }

    /// True if this processor has it.
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

    /// Returns the set itself after a check.
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
