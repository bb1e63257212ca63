//! The Debian package, installed without sources and cargo: in a copy of this machine's root that
//! is removed with the test.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use serde_json::Value;
use tests::needs::Need;
use tests::text_of;

/// Commands of a new user once the package is installed; `$1` is the folder that held the sources,
/// `$2` the package. The first line that fails ends it.
const SCRIPT: &str = r#"
set -e
cd /home
dpkg --install "$2" >&2
if command -v cargo >&2 || [ -n "$(ls -A "$1")" ]; then
    echo 'this root is not clean' >&2
    exit 9
fi
# The demonstration, played as fast as it is answered.
backcast --rate max --no-monitor --json | tail -1
# Three commands of a stranger with a map and a recording.
map=/usr/share/backcast/recordings/malaga_corridor/map.yaml
drive=/usr/share/backcast/recordings/malaga_corridor/recording.mcap
backcast locate --map $map $drive --json | tail -1
backcast init --replay $drive --map $map --out graph.yaml >&2
backcast check graph.yaml >&2
backcast run graph.yaml --rate max --no-monitor --json | tail -1
# A laser that is not there is written without asking it.
backcast init --laser 192.168.0.1 --no-probe --map $map --mount 0.2,0,0 --out laser.yaml >&2
backcast check laser.yaml >&2
# Those that are ready to be copied name a map that this machine lacks, and nothing else.
for ready in laser_network laser_serial ros2; do
    sed "s#/etc/backcast/map.yaml#$map#" /usr/share/backcast/graphs/$ready.yaml > ready.yaml
    backcast check ready.yaml >&2
done
man=/usr/share/man/man1/backcast-init.1.gz
gzip --decompress --stdout $man | grep --quiet 'serial'
bash -n /usr/share/bash-completion/completions/backcast
# Options that no node takes are named, and what is removed is gone.
sed -i 's/--protocol/--protokoll/' laser.yaml
if backcast check laser.yaml >&2; then exit 8; fi
dpkg --remove backcast >&2
if [ -e /usr/bin/backcast ] || [ -e /usr/lib/backcast ]; then exit 7; fi
"#;

/// Root with this machine's file system, in which nothing that is written stays and everything
/// outside the system is hidden.
const CLEAN_ROOT: &str = r#"
set -e
script=$1 package=$2 hidden=$3
mount --make-rprivate /
mount -t tmpfs tmpfs /mnt
mkdir /mnt/upper /mnt/work /mnt/root /mnt/package
cp "$package" /mnt/package
mount -t overlay -o lowerdir=/,upperdir=/mnt/upper,workdir=/mnt/work overlay /mnt/root
mkdir -p /mnt/root/package
for folder in /root /tmp "$hidden"; do
    mkdir -p "/mnt/root$folder"
    mount -t tmpfs tmpfs "/mnt/root$folder"
done
mount --bind /mnt/package /mnt/root/package
mount --rbind /dev /mnt/root/dev
mount -t proc proc /mnt/root/proc
cd /
exec env --ignore-environment PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/home \
    chroot /mnt/root sh -c "$script" sh "$hidden" "/package/$(basename "$package")"
"#;

/// Builds the Debian package of the executables of this test run.
fn package(folder: &Path) -> PathBuf {
    let built = tests::executables::path("backcast").with_file_name("");
    let build = tests::root().join("packaging/build");
    let mut build = Command::new(build);
    let _ = text_of(
        build
            .arg("--no-compile")
            .arg(built)
            .env("CARGO_TARGET_DIR", folder),
    );
    let files = std::fs::read_dir(folder.join("package")).unwrap();
    let mut files = files.map(|file| file.unwrap().path());
    files
        .find(|file| file.extension().is_some_and(|ending| ending == "deb"))
        .unwrap()
}

#[test]
fn the_package_does_its_work_where_nothing_else_is() {
    let test = "the_package_does_its_work_where_nothing_else_is";
    if !nix::unistd::geteuid().is_root() {
        return Need::Root.is_missing(test, "only root installs packages");
    }
    let overlay = "mount -t tmpfs tmpfs /mnt && mkdir /mnt/u /mnt/w /mnt/r \
                   && mount -t overlay -o lowerdir=/,upperdir=/mnt/u,workdir=/mnt/w overlay /mnt/r";
    let probe = Command::new("unshare")
        .args(["--mount", "sh", "-c", overlay])
        .stderr(Stdio::null())
        .status();
    if !probe.is_ok_and(|status| status.success()) {
        return Need::Overlay.is_missing(test, "this kernel lets nobody mount an overlay here");
    }
    let folder = tempfile::tempdir().unwrap();
    let package = package(folder.path());
    let sources = tests::root().canonicalize().unwrap();
    let mut unshare = Command::new("unshare");
    unshare.args(["--mount", "sh", "-c", CLEAN_ROOT, "sh", SCRIPT]);
    let said = text_of(unshare.arg(package).arg(sources.parent().unwrap()));
    let lines: Vec<Value> = said
        .lines()
        .map(|line| serde_json::from_str(line).unwrap_or_else(|_| panic!("{said}")))
        .collect();
    assert_eq!(lines.len(), 3, "{said}");
    assert_eq!(lines[1]["verdict"], "Unique", "{said}");
    for summary in [&lines[0]["summary"], &lines[2]["summary"]] {
        assert_eq!(summary["answered"], 37, "{said}");
        assert_eq!(summary["pose"]["success_50cm_10deg"], 1.0, "{said}");
        assert_eq!(summary["pose"]["unique_wrong"], 0, "{said}");
    }
}

/// Prints the descriptor that the launch file writes, for a robot in a namespace.
const GRAPH: &str = "import sys; sys.path.insert(0, sys.argv[1]); sys.dont_write_bytecode = True
from backcast_ros2.graph import descriptor
print(descriptor('r2', '/etc/robot/a file.yaml', True, 'debug'))
source = open(sys.argv[1] + '/launch/localization_launch.py').read()
compile(source, 'localization_launch.py', 'exec')";

#[test]
fn the_graph_of_the_launch_file_is_sound() {
    let package = tests::root().join("packaging/ros2/backcast_ros2");
    let mut python = Command::new("python3");
    let Ok(output) = python.args(["-c", GRAPH]).arg(&package).output() else {
        let test = "the_graph_of_the_launch_file_is_sound";
        return Need::Python.is_missing(test, "no python3");
    };
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{said}");
    let text = String::from_utf8(output.stdout).unwrap();
    for expected in [
        "__ns:=/r2",
        "'/etc/robot/a file.yaml'",
        "use_sim_time:=true",
    ] {
        assert!(text.contains(expected), "{text}");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("localization.yaml");
    let built = tests::executables::path("backcast").with_file_name("");
    let built = format!("path: {}/", built.display());
    std::fs::write(&file, text.replace("path: ", &built)).unwrap();
    let check = || {
        let mut command = tests::executables::backcast();
        command.arg("check").arg(&file);
        command
    };
    let _ = text_of(&mut check());
    // Arguments that are invalid in ROS are rejected by the gateway itself.
    let wrong = text
        .replace("__ns:=", "__namespace:=")
        .replace("path: ", &built);
    std::fs::write(&file, wrong).unwrap();
    assert!(!check().output().unwrap().status.success());
}
