//! `backcast bench paper --quick` writes what `docs/paper.md` links.

use std::fs;

use tempfile::TempDir;

use crate::drawn::{assert_refused, run};

#[test]
fn every_file_that_the_page_links_is_made_and_is_in_the_repository() {
    let folder = TempDir::new().unwrap();
    let command = format!("bench paper --quick --out {}", folder.path().display());
    let (code, _, said) = run(&tests::root(), &command);
    assert_eq!(code, 0, "{said}");
    let page = fs::read_to_string(tests::root().join("docs/paper.md")).unwrap();
    let links = page.split("](paper/").skip(1);
    let names: Vec<&str> = links.filter_map(|rest| rest.split(')').next()).collect();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        let made = fs::read(folder.path().join(name)).unwrap();
        let kept = fs::read(tests::root().join("docs/paper").join(name)).unwrap();
        if name.ends_with(".csv") {
            let header = |table: &[u8]| table.split(|&byte| byte == b'\n').next().unwrap().to_vec();
            assert_eq!(header(&made), header(&kept), "{name}");
        }
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_reported_before_anything_is_measured() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("file"), "no folder").unwrap();
    let command = "bench paper --quick --out file/out";
    assert_refused(folder.path(), command, 1, "cannot write into the folder");
}
