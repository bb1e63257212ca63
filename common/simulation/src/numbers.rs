//! Lists of numbers in options.

/// Parses N numbers separated by commas.
pub(crate) fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let parsed = text.split(',').map(|word| word.trim().parse().ok());
    parsed.collect::<Option<Vec<f64>>>()?.try_into().ok()
}
