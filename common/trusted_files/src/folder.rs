//! Checks the folders on the path of a file before it is written.

use std::fs::{canonicalize, symlink_metadata};
use std::os::unix::fs::MetadataExt;
use std::path::{Path, absolute};

use crate::file::failed;
use crate::{TrustError, check_owner, current_user};

/// Permission of all users to create files in a folder, and the bit that prevents replacing files
/// of others there.
const EVERYBODY: u32 = 0o002;
const STICKY: u32 = 0o1000;

/// Checks that no other user can redirect a write to `path`: each folder and link on the path
/// belongs to this user or to root, and in folders writable by all, such as `/tmp`, users cannot
/// replace files of others. The file at `path` must be a regular file of this user or root, or not
/// exist.
pub fn check_place(path: &Path) -> Result<(), TrustError> {
    check_place_as(current_user(), path)
}

fn check_place_as(user: u32, path: &Path) -> Result<(), TrustError> {
    let no_name = || TrustError::NoName(path.to_owned());
    let absolute = absolute(path).map_err(|_| no_name())?;
    let (Some(folder), Some(_)) = (absolute.parent(), path.file_name()) else {
        return Err(no_name());
    };
    let real = canonicalize(folder).map_err(failed("find folder", folder))?;
    // Checks the links on the path and the real folders.
    for way in [folder, &real] {
        way.ancestors()
            .try_for_each(|step| check_step(user, step))?;
    }
    match symlink_metadata(path) {
        Ok(found) if found.is_file() => check_owner(path, &found, user),
        Ok(_) => Err(TrustError::NotAFile(path.to_owned())),
        Err(_) => Ok(()),
    }
}

fn check_step(user: u32, step: &Path) -> Result<(), TrustError> {
    let found = symlink_metadata(step).map_err(failed("look at", step))?;
    check_owner(step, &found, user)?;
    let (owner, mode) = (found.uid(), found.mode() & 0o7777);
    if found.is_dir() && mode & EVERYBODY != 0 && mode & STICKY == 0 {
        let path = step.to_owned();
        return Err(TrustError::Writable { path, owner, mode });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::fs::{Permissions, create_dir, set_permissions, write};
    use std::os::unix::fs::{PermissionsExt, lchown, symlink};

    use super::*;

    #[test]
    fn a_place_that_others_could_exchange_is_refused() {
        let parent = tempfile::tempdir().unwrap();
        let folder = parent.path().join("folder");
        create_dir(&folder).unwrap();
        let file = folder.join("pose");
        check_place(&file).unwrap();
        write(&file, "").unwrap();
        check_place(&file).unwrap();
        for (mode, is_sound) in [(0o777, false), (0o1777, true), (0o775, true)] {
            set_permissions(&folder, Permissions::from_mode(mode)).unwrap();
            let found = check_place(&file);
            assert_eq!(found.is_ok(), is_sound, "{mode:o}");
            let is_named =
                |error| matches!(error, TrustError::Writable { path, .. } if path == folder);
            assert!(found.map_or_else(is_named, |()| true));
        }
    }

    #[test]
    fn what_is_no_file_in_a_folder_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        symlink(at("other"), at("link")).unwrap();
        create_dir(at("folder")).unwrap();
        for name in ["link", "folder"] {
            let refused = check_place(&at(name)).unwrap_err();
            assert!(matches!(refused, TrustError::NotAFile(path) if path == at(name)));
        }
        for path in ["", "/", ".."] {
            let refused = check_place(Path::new(path)).unwrap_err();
            assert!(matches!(refused, TrustError::NoName(_)), "{refused}");
        }
        let nowhere = check_place(&at("none").join("pose")).unwrap_err();
        assert!(matches!(nowhere, TrustError::File { .. }));
    }

    #[test]
    fn a_link_that_another_user_has_planted_is_refused_on_the_way() {
        let parent = tempfile::tempdir().unwrap();
        let (folder, link) = (parent.path().join("folder"), parent.path().join("link"));
        create_dir(&folder).unwrap();
        symlink(&folder, &link).unwrap();
        let me = current_user();
        check_place(&link.join("pose")).unwrap();
        if me == 0 {
            lchown(&link, Some(65534), None).unwrap();
            let refused = check_place(&link.join("pose")).unwrap_err();
            assert!(matches!(refused, TrustError::Foreign { path, .. } if path == link));
        } else {
            let refused = check_place_as(me + 1, &link.join("pose")).unwrap_err();
            assert!(matches!(refused, TrustError::Foreign { owner, .. } if owner == me));
        }
    }
}
