//! Any file as the image of a map: nothing panics, memory stays within the limit, and a map that is
//! read has as many cells as its sides say.
#![no_main]

use std::path::PathBuf;
use std::sync::LazyLock;

use libfuzzer_sys::fuzz_target;
use map::MemoryOptions;

static FILES: LazyLock<[PathBuf; 2]> = LazyLock::new(|| {
    // Kept until the end of the process, which is the end of the run.
    let folder = tempfile::tempdir().unwrap().keep();
    let yaml = "image: a\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n\
                occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    std::fs::write(folder.join("a.yaml"), yaml).unwrap();
    ["a.yaml", "a"].map(|name| folder.join(name))
});

fuzz_target!(|bytes: &[u8]| {
    let [yaml, image] = &*FILES;
    std::fs::write(image, bytes).unwrap();
    let memory_limit = Some(100);
    let limit = MemoryOptions { memory_limit }.limit();
    if let Ok(grid) = map::load_within(limit, yaml, |_| {}) {
        assert_eq!(grid.cells.len() as u64, u64::from(grid.width) * u64::from(grid.height));
    }
});
