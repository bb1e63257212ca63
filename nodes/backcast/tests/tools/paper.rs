//! `backcast bench paper --quick` writes what `docs/paper.md` links.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use tempfile::TempDir;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn bench(options: &[&str], out: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_backcast"))
        .args(["bench", "paper"])
        .args(options)
        .arg("--out")
        .arg(out)
        .current_dir(root())
        .output()
        .unwrap()
}

#[test]
fn every_file_that_the_page_links_is_made_and_is_in_the_repository() {
    let folder = TempDir::new().unwrap();
    let output = bench(&["--quick"], folder.path());
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    let page = fs::read_to_string(root().join("docs/paper.md")).unwrap();
    let links = page.split("](paper/").skip(1);
    let names: Vec<&str> = links.filter_map(|rest| rest.split(')').next()).collect();
    assert!(names.len() > 10, "{names:?}");
    for name in names {
        let made = fs::read(folder.path().join(name)).unwrap();
        let kept = fs::read(root().join("docs/paper").join(name)).unwrap();
        if name.ends_with(".csv") {
            let header = |table: &[u8]| table.split(|&byte| byte == b'\n').next().unwrap().to_vec();
            assert_eq!(header(&made), header(&kept), "{name}");
        }
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_reported_before_anything_is_measured() {
    let folder = TempDir::new().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "no folder").unwrap();
    let output = bench(&["--quick"], &file.join("out"));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("cannot write into the folder"), "{said}");
}

#[test]
fn options_of_other_tables_are_refused() {
    let run = |options: &str| {
        let output = Command::new(env!("CARGO_BIN_EXE_backcast"))
            .args(options.split(' '))
            .output()
            .unwrap();
        (
            output.status.code(),
            String::from_utf8_lossy(&output.stderr).into_owned(),
        )
    };
    for (options, says) in [
        ("bench paper --size 100", "`bench paper` takes"),
        ("bench paper --json", "`bench paper` takes"),
        ("bench table1 --quick --out here", "are for `bench paper`"),
        ("bench paper --part figure9", "invalid value"),
    ] {
        let (code, said) = run(options);
        assert_eq!(code, Some(2), "{options}: {said}");
        assert!(said.contains(says), "{options}: {said}");
    }
}
