//! Reads the descriptor and checks the executables that it names; changes nothing.

use std::{fs::File, io::Read, os::unix::fs::PermissionsExt, path::Path};

use crate::{Dataflow, DataflowError, MAX_FILE_BYTES, Node, Problem};

pub(crate) fn read(path: &Path) -> Result<String, DataflowError> {
    let unreadable = |source| DataflowError::Unreadable {
        file: path.to_owned(),
        source,
    };
    let mut text = String::new();
    // One byte more than allowed shows a file that is too large, even a pipe.
    File::open(path)
        .and_then(|file| file.take(MAX_FILE_BYTES + 1).read_to_string(&mut text))
        .map_err(unreadable)?;
    if text.len() as u64 > MAX_FILE_BYTES {
        let file = path.to_owned();
        return Err(DataflowError::TooLarge { file });
    }
    Ok(text)
}

/// Returns a problem for each node whose executable neither exists in `folder` nor is built.
#[must_use]
pub fn check_executables(dataflow: &Dataflow, folder: &Path) -> Vec<Problem> {
    let unbuilt = dataflow.nodes.iter().filter(|n| n.build.is_empty());
    unbuilt.filter_map(|n| missing(n, folder)).collect()
}

fn missing(node: &Node, folder: &Path) -> Option<Problem> {
    let state = match folder.join(&node.path).metadata() {
        Err(_) => "does not exist",
        Ok(file) if !file.is_file() => "is not a file",
        Ok(file) if file.permissions().mode() & 0o111 == 0 => "is not executable",
        Ok(_) => return None,
    };
    Some(Problem {
        place: node.path_place,
        fault: format!("`{}` {state}, and nothing builds it", node.path),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load;

    fn file(text: &str) -> tempfile::NamedTempFile {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    #[test]
    fn errors_name_the_file_and_every_place() {
        let file = file("nodes:\n  - id: a\n  - path: x\n");
        let name = file.path().display();
        let error = load(file.path()).unwrap_err();
        let expected = format!("{name}:2:5: `path` is missing\n{name}:3:5: `id` is missing");
        assert_eq!(error.to_string(), expected);
    }

    #[test]
    fn a_file_that_cannot_be_a_descriptor_is_refused() {
        let at = |path: &Path| load(path).unwrap_err();
        let missing = at(Path::new("/nowhere/dataflow.yaml"));
        assert!(matches!(missing, DataflowError::Unreadable { .. }));
        let size = usize::try_from(MAX_FILE_BYTES).unwrap();
        let large = at(file(&" ".repeat(size + 1)).path());
        assert!(matches!(large, DataflowError::TooLarge { .. }));
    }

    #[test]
    fn executables_exist_or_are_built() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("plain"), "").unwrap();
        let text = "nodes:
  - {id: a, path: /bin/sh}
  - {id: b, path: nowhere, build: make}
  - {id: c, path: nowhere}
  - {id: d, path: plain}
  - {id: e, path: ./.}
";
        let dataflow = crate::parse(text).unwrap();
        let problems = check_executables(&dataflow, folder.path());
        let said: Vec<_> = problems.iter().map(ToString::to_string).collect();
        let expected = [
            "4:19: `nowhere` does not exist",
            "5:19: `plain` is not executable",
            "6:19: `./.` is not a file",
        ];
        assert_eq!(
            said,
            expected.map(|start| format!("{start}, and nothing builds it"))
        );
    }
}
