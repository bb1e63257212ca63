//! Terminal output for opening the page on a phone.

use transport::node::LOG_FORMAT_VARIABLE;
use transport::testing::{Isolated, NodeProcess, wait_until_ready};

/// Returns the monitor's log in this format, when it listens on this address.
fn log(form: &str, listen: &str) -> String {
    let isolated = Isolated::new("phone");
    let graph = isolated.join("test");
    let form = &*format!("{LOG_FORMAT_VARIABLE}={form}");
    let monitor = env!("CARGO_BIN_EXE_monitor");
    let arguments = [form, monitor, "--host=r7.local", "--listen", listen];
    let node = NodeProcess::start("/usr/bin/env", &graph, arguments);
    wait_until_ready(&graph, "monitor");
    node.stop_with_log()
}

#[test]
fn a_terminal_has_a_code_where_phones_can_reach_the_page() {
    const ANYBODY: &str = "0.0.0.0:0";
    let shown = log("short", ANYBODY);
    assert!(shown.contains("on a phone: http://r7.local:"), "{shown}");
    assert!(shown.contains("/#token="), "{shown}");
    let is_code = |line: &&str| !line.is_empty() && line.chars().all(|c| " █▀▄".contains(c));
    assert!(shown.lines().filter(is_code).count() > 15, "{shown}");
    for (form, listen) in [("text", ANYBODY), ("short", "127.0.0.1:0")] {
        let other = log(form, listen);
        assert!(!other.contains("on a phone"), "{form} {listen}: {other}");
        assert_eq!(other.lines().filter(is_code).count(), 0, "{other}");
    }
}
