#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[cfg_attr(feature = "clap", derive(clap::ValueEnum))]
pub enum Encoding {
    /// CoLa A: text between 02 and 03, no checksum.
    #[cfg_attr(feature = "clap", value(name = "cola-a"))]
    Text,
    /// CoLa B: big-endian numbers, a length and a checksum.
    #[default]
    #[cfg_attr(feature = "clap", value(name = "cola-b"))]
    Binary,
}
