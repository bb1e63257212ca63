//! Removes the files that a graph has left after its last process. Killed ones leave all of theirs.
//! A running graph is refused.

use std::ffi::OsStr;
use std::fs::{read_dir, remove_dir, remove_file};
use std::io::ErrorKind;
use std::os::unix::ffi::OsStrExt;
use std::path::{Path, PathBuf};
use std::time::Duration;

use iceoryx2::node::{DeadNodeView, Node, NodeDetails, NodeState, NodeView};
use iceoryx2::prelude::{CallbackProgression, ipc};

use crate::membership::{Membership, SHARED_MEMORY, alive, graph_of_file};
use crate::root::current_user;
use crate::{Claim, GraphName, TransportError, log, with_causes};

/// Longest wait for another process that cleans up the same dead node.
const CLEANUP_WAIT: Duration = Duration::from_secs(1);

/// Removes every file of this user's `graph`, which the caller must not have joined; fails with
/// [`TransportError::StillRunning`] if a process of the graph is alive.
pub fn remove_leftovers(graph: &GraphName) -> Result<(), TransportError> {
    log::route_to_tracing();
    let membership = Membership::of(graph);
    let dead = refuse_living(&membership)?;
    // Detects members that iceoryx2 does not see here: in a container with another /tmp.
    let Some(_nobody_joins) = alive::as_only_one(&membership)? else {
        let lock = alive::path(&membership, alive::MEMBERS);
        return Err(TransportError::StillRunning {
            graph: graph.clone(),
            processes: vec![format!("a process holds {}", lock.display())],
        });
    };
    for node in dead {
        // iceoryx2 knows best which resources belong together. Those that it cannot remove, because
        // a process died while creating them, are found by name below.
        if let Err(error) = node.blocking_remove_stale_resources(CLEANUP_WAIT) {
            tracing::debug!(?error, "a dead node was not cleaned away as a whole");
        }
    }
    remove_files(&membership)
}

/// Removes the files of this user's graphs without a living process; errors are logged.
pub fn remove_dead_graphs() {
    let user = current_user();
    let names = match entries(Path::new(SHARED_MEMORY)) {
        // Members hold locks on these files.
        Ok(paths) => {
            let graph = |path: &PathBuf| graph_of_file(path, user, alive::MEMBERS);
            paths.iter().filter_map(graph).collect::<Vec<_>>()
        }
        Err(error) => {
            tracing::warn!("cannot search for stale files: {}", with_causes(&error));
            return;
        }
    };
    for name in names {
        match remove_leftovers(&name) {
            Ok(()) => {
                // Dropping the claim removes the launcher's file, unless a new launcher has it.
                drop(Claim::take(&name));
                tracing::info!("removed what graph {name} had left");
            }
            Err(TransportError::StillRunning { .. }) => {}
            Err(error) => tracing::warn!("stale files remain: {}", with_causes(&error)),
        }
    }
}

/// Returns every file of this user's `graph`, in shared memory and in the user's folder.
pub fn files_of(graph: &GraphName) -> Vec<PathBuf> {
    let membership = Membership::of(graph);
    let nodes = entries(&membership.root.join("nodes")).unwrap_or_default();
    // Other processes may remove their files and folders meanwhile.
    let folders = shared_folders(&membership).into_iter().chain(nodes);
    let files = folders.flat_map(|folder| entries(&folder).unwrap_or_default());
    files
        .filter(|file| is_of(&membership, file) && !file.is_dir())
        .collect()
}

fn shared_folders(membership: &Membership) -> [PathBuf; 4] {
    [
        PathBuf::from(SHARED_MEMORY),
        membership.root.clone(),
        membership.root.join("services"),
        membership.root.join("nodes"),
    ]
}

fn is_of(membership: &Membership, path: &Path) -> bool {
    let name = path.file_name().map(OsStr::as_bytes);
    name.is_some_and(|name| name.starts_with(membership.prefix.as_bytes()))
}

fn refuse_living(
    membership: &Membership,
) -> Result<Vec<DeadNodeView<ipc::Service>>, TransportError> {
    let mut processes = Vec::new();
    let mut dead = Vec::new();
    Node::<ipc::Service>::list(&membership.config(), |state| {
        match state {
            NodeState::Alive(node) => processes.push(describe(node.details().as_ref())),
            NodeState::Dead(node) => dead.push(node),
            NodeState::Inaccessible(_) | NodeState::Undefined(_) => {}
        }
        CallbackProgression::Continue
    })
    .map_err(|error| TransportError::List {
        graph: membership.graph.clone(),
        root: membership.root.clone(),
        reason: format!("{error:?}"),
    })?;
    if processes.is_empty() {
        return Ok(dead);
    }
    Err(TransportError::StillRunning {
        graph: membership.graph.clone(),
        processes,
    })
}

fn describe(details: Option<&NodeDetails>) -> String {
    match details {
        Some(node) => format!("{} (process {})", node.name(), node.process_id().value()),
        None => "a node without a name".into(),
    }
}

fn remove_files(membership: &Membership) -> Result<(), TransportError> {
    for folder in shared_folders(membership) {
        remove_own(&folder, membership)?;
    }
    // Each node has a folder, named only by its number. Its files show whose it is; an empty one
    // may have just been created for another graph.
    for folder in entries(&membership.root.join("nodes"))? {
        if folder.is_dir() && remove_own(&folder, membership)? {
            gone(&folder, remove_dir(&folder))?;
        }
    }
    Ok(())
}

/// Removes the graph's files in `folder`; returns true if there were any.
fn remove_own(folder: &Path, membership: &Membership) -> Result<bool, TransportError> {
    let mut any = false;
    for path in entries(folder)? {
        // The claim is only removed by the process that holds it.
        let is_claim = path.extension() == Some(OsStr::new(alive::LAUNCHER));
        if is_of(membership, &path) && !is_claim {
            gone(&path, remove_file(&path))?;
            any = true;
        }
    }
    Ok(any)
}

fn entries(folder: &Path) -> Result<Vec<PathBuf>, TransportError> {
    let failed = |source| TransportError::File {
        action: "list",
        path: folder.to_owned(),
        source,
    };
    match read_dir(folder) {
        Ok(entries) => entries
            .map(|entry| entry.map(|e| e.path()).map_err(failed))
            .collect(),
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Vec::new()),
        Err(error) => Err(failed(error)),
    }
}

fn gone(path: &Path, outcome: std::io::Result<()>) -> Result<(), TransportError> {
    match outcome {
        Err(source) if source.kind() != ErrorKind::NotFound => Err(TransportError::File {
            action: "remove",
            path: path.to_owned(),
            source,
        }),
        _ => Ok(()),
    }
}
