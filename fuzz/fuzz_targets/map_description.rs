//! Any file as the description of a map, beside a sound image: nothing panics, and a map
//! that is read is within the limits.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;

static YAML: LazyLock<PathBuf> = LazyLock::new(|| {
    // Kept until the end of the process, which is that of the run.
    let folder = tempfile::tempdir().unwrap().keep();
    std::fs::write(folder.join("a.pgm"), b"P5 2 1 255\n\x00\xfe").unwrap();
    folder.join("a.yaml")
});

fuzz_target!(|bytes: &[u8]| {
    std::fs::write(&*YAML, bytes).unwrap();
    if let Ok(grid) = map::load(&*YAML) {
        assert!((map::MIN_RESOLUTION_M..=map::MAX_RESOLUTION_M).contains(&grid.resolution_m));
    }
});
