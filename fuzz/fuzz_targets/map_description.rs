//! Any file as a map description, with a valid image: nothing panics, and a map that is read is
//! within the limits.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;

static YAML: LazyLock<PathBuf> = LazyLock::new(|| {
    // Kept until the end of the process, which is the end of the run.
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
