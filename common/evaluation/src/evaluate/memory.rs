//! Peak memory of this process, as Linux counts it in /proc.

use std::{fs, io};

use nix::sys::resource::{UsageWho, getrusage};

/// Value that resets the peak, see proc_pid_clear_refs(5).
const FORGET_PEAK: &str = "5";

/// Resets the peak to the memory in use now.
/// Fails if the system does not allow it; the peak then covers the whole process.
pub(super) fn forget_peak() -> io::Result<()> {
    fs::write("/proc/self/clear_refs", FORGET_PEAK)
}

/// Peak of the resident memory since the last reset, in megabytes of 10⁶ bytes.
pub(super) fn peak_mb() -> io::Result<f64> {
    let status = fs::read_to_string("/proc/self/status")?;
    let kib = match peak_in(&status) {
        Some(kib) => kib,
        // Kernels without this line report the process's peak here, also in KiB.
        None => getrusage(UsageWho::RUSAGE_SELF)?.max_rss() as f64,
    };
    Ok(kib * 1024.0 / 1e6)
}

/// Parses the line `VmHWM:     1968 kB`; its unit is KiB.
fn peak_in(status: &str) -> Option<f64> {
    let rest = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    rest.trim().strip_suffix("kB")?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_grows_with_what_is_held_and_can_be_forgotten() {
        let held = vec![1u8; 256 << 20];
        let sum: u64 = held.iter().map(|&byte| u64::from(byte)).sum();
        assert_eq!(sum, 256 << 20);
        let peak = peak_mb().unwrap();
        assert!(peak > 256.0, "{peak}");
        drop(held);
        forget_peak().unwrap();
        // The allocator returns a block of this size at once, and no other test of this process
        // holds nearly as much.
        let after = peak_mb().unwrap();
        assert!(after < peak - 128.0, "{after} of {peak}");
    }
}
