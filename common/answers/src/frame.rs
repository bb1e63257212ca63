//! Frame whose pose is printed. Pure.

/// The base, or the laser where its mount is not known.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Frame {
    Base,
    #[default]
    Laser,
}

impl Frame {
    pub fn of(mount_is_known: bool) -> Self {
        match mount_is_known {
            true => Frame::Base,
            false => Frame::Laser,
        }
    }

    pub(super) fn columns(self) -> [&'static str; 2] {
        match self {
            Frame::Base => ["base x m", "base y m"],
            Frame::Laser => ["laser x m", "laser y m"],
        }
    }
}
