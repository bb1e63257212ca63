//! Log lines of a process arrive on topic `log`. This is a single test, as a process has one log.

use std::time::Duration;

use messages::{LogHeader, LogLevel, topic};
use transport::testing::Isolated;
use transport::{Flow, TransportError};

const FLOOD: usize = 100;

#[test]
fn lines_arrive_with_their_level_and_losses_are_reported() {
    let isolated = Isolated::new("log");
    transport::node::start_logging().unwrap();
    let graph = isolated.join("talker");
    let lines = graph.subscriber::<topic::Log>().unwrap();
    tracing::warn!(scan = 7, "no map for {}", "it");
    let other = std::thread::spawn(|| tracing::info!("{}", "ä".repeat(2000)));
    other.join().unwrap();
    transport::log_in_graph(LogLevel::Error, "printed already");

    let mut received: Vec<(LogHeader, String)> = Vec::new();
    let mut flooded = false;
    let outcome = graph.run(&[&lines], Duration::from_millis(10), |_| {
        while let Some(line) = lines.receive()? {
            let text = String::from_utf8(line.items().to_vec()).unwrap();
            received.push((*line.header(), text));
        }
        if received.len() >= 3 && !flooded {
            (0..FLOOD).for_each(|number| tracing::info!("line {number}"));
            flooded = true;
        }
        let reported = received
            .last()
            .is_some_and(|(_, text)| text.contains("lost"));
        Ok::<_, TransportError>(if reported { Flow::Stop } else { Flow::Continue })
    });
    outcome.unwrap();

    let (first, text) = &received[0];
    assert_eq!(text, "no map for it scan=7");
    assert_eq!(LogLevel::from_code(first.level), Some(LogLevel::Warn));
    assert_eq!((first.node.as_str(), first.counter), ("talker", 0));
    assert_eq!(first.pid, std::process::id());
    assert!(first.written_ns > 0 && first.wall_ns > 0);
    // Cut between characters of two bytes.
    assert_eq!(received[1].1, "ä".repeat(LogHeader::TEXT_CAPACITY / 2));
    assert!(received[0].0.written_ns <= received[1].0.written_ns);
    let (printed, text) = &received[2];
    assert_eq!(
        (printed.level, &text[..]),
        (LogLevel::Error as u32, "printed already")
    );
    let (last, text) = received.last().unwrap();
    assert_eq!(last.dropped, 37);
    let arrived = received.iter().filter(|(_, text)| text.starts_with("line"));
    assert_eq!(arrived.count(), 63);
    assert_eq!(
        text,
        "37 log lines were lost: they arrived faster than they could be sent"
    );

    // A late subscriber gets the newest lines within a tick.
    let late = graph.subscriber::<topic::Log>().unwrap();
    let mut history = Vec::new();
    let outcome = graph.run(&[&late], Duration::from_millis(10), |_| {
        while let Some(line) = late.receive()? {
            history.push(*line.header());
        }
        let done = history.last().is_some_and(|header| header == last);
        Ok::<_, TransportError>(if done { Flow::Stop } else { Flow::Continue })
    });
    outcome.unwrap();
    assert_eq!(history.len(), 16);
}
