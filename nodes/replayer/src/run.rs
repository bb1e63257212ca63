//! Schedules the messages, waits and sends.

mod in_step;
mod keyboard;
mod outlet;

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use command_line::finished;
use in_step::InStep;
use keyboard::{KeyPress, Keyboard};
use messages::{NodeState, topic};
use outlet::{Outlet, Tally};
use recording::{Kind, Recording};
use ros_graph::replay::{
    Action, Channels, InOrder, PlaybackError, Rate, Schedule, Selection, Source, Timed,
    wait_for_nodes,
};
use transport::{Flow, Graph, Input, Subscriber, monotonic_ns, with_causes};

use crate::{Config, ReplayerError};

/// Longest time between checks of answers, signals and health.
const TICK: Duration = Duration::from_millis(50);

/// Plays the recording until it ends or the stop flag is set.
///
/// A damaged recording is played up to the damage.
pub fn run(graph: &Graph, config: &Config) -> Result<ExitCode, ReplayerError> {
    let mut outlet = Outlet::open(graph)?;
    let answers = graph.subscriber::<topic::Hypotheses>()?;
    // Reading a long recording takes a while.
    outlet.health.state(NodeState::Busy)?;
    let recording = open(config)?;
    let selection = select(config, &recording)?;
    let channels = Channels::of_lasers(&recording, &selection, &config.scan_topic)?;
    outlet.health.state(NodeState::Waiting)?;
    wait_for_nodes(graph, &config.wait_for, &mut outlet.health)?;
    let stop = graph.stop_flag();
    if stop.load(Ordering::Relaxed) {
        return Ok(ExitCode::SUCCESS);
    }
    outlet.first_laser = channels.first_laser();
    let gap_ns = announce(&recording, &channels, config);
    outlet.health.state(NodeState::Ready)?;
    let mut player = Player {
        recording: &recording,
        items: InOrder::new(Source::new(&recording, channels.clone(), selection.clone())),
        channels,
        selection,
        keyboard: listen(config.pause)?,
        config,
        gap_ns,
        scans_before: 0,
        pending: None,
        failure: None,
        schedule: Schedule::new(config.rate, config.patience),
        in_step: InStep::new(graph, &config.in_step)?,
        outlet,
        is_finished: false,
        stop,
    };
    player.advance()?;
    let reports = player.in_step.reports();
    let reports = reports.as_deref().map(|reports| -> &dyn Input { reports });
    let inputs: Vec<&dyn Input> = [&answers as &dyn Input]
        .into_iter()
        .chain(reports)
        .collect();
    graph.run(&inputs, TICK, |_| player.step(&answers))?;
    player.conclude()
}

/// Opens the recording and sets the topics from the options.
fn open(config: &Config) -> Result<Recording, ReplayerError> {
    let mut recording = Recording::open_all(&config.recording)?;
    recording.take_cloud(&config.cloud)?;
    // In reverse order, so that the first topic is preferred if only one is allowed.
    for topic in config.scan_topic.iter().rev() {
        recording.prefer(Kind::Scan, topic)?;
    }
    if let Some(topic) = &config.odom_topic {
        recording.prefer(Kind::Odometry, topic)?;
    }
    Ok(recording)
}

fn select(config: &Config, recording: &Recording) -> Result<Selection, ReplayerError> {
    let selection =
        Selection::of(&config.topics, &config.remap).within(recording, config.start, config.end);
    let unknown = selection.unknown(recording);
    if unknown.is_empty() {
        return Ok(selection);
    }
    Err(ReplayerError::UnknownTopics {
        path: recording.path().to_owned(),
        unknown,
        found: recording
            .channels()
            .map(|channel| channel.topic.to_string())
            .collect(),
    })
}

fn listen(pause: bool) -> Result<Option<Keyboard>, ReplayerError> {
    if !pause {
        return Ok(None);
    }
    tracing::info!("paused: Enter plays to the next scan, p plays and pauses, q ends");
    let input = std::io::BufReader::new(std::io::stdin());
    Keyboard::read(input)
        .map(Some)
        .map_err(ReplayerError::Keyboard)
}

/// Logs what will be played; returns the mean time between two scans.
fn announce(recording: &Recording, channels: &Channels, config: &Config) -> i64 {
    let scans = channels.scans(recording);
    if let Some(damage) = recording.damage_error() {
        tracing::warn!("{damage}; these are played");
    }
    let (first_ns, last_ns) = recording.time_range_ns().unwrap_or((0, 0));
    let duration_ns = last_ns.saturating_sub(first_ns);
    tracing::info!(
        recording = %recording.path().display(),
        scans,
        duration = format!("{:.1} s", duration_ns as f64 * 1e-9),
        rate = %config.rate,
        "playing"
    );
    duration_ns / i64::try_from(scans).unwrap_or(i64::MAX).max(1)
}

struct Player<'r> {
    recording: &'r Recording,
    channels: Channels,
    selection: Selection,
    keyboard: Option<Keyboard>,
    config: &'r Config,
    /// Mean time between two scans of the recording.
    gap_ns: i64,
    items: InOrder<Source<'r>, PlaybackError>,
    /// Number of scans sent before this round.
    scans_before: u64,
    pending: Option<Timed>,
    failure: Option<PlaybackError>,
    schedule: Schedule,
    in_step: InStep,
    outlet: Outlet,
    /// True once the recording was played to its end.
    is_finished: bool,
    stop: Arc<AtomicBool>,
}

impl Player<'_> {
    /// Does everything that is due, until the next event is more than a tick away.
    fn step(&mut self, answers: &Subscriber<topic::Hypotheses>) -> Result<Flow, ReplayerError> {
        while !self.stop.load(Ordering::Relaxed) {
            while let Some(answer) = answers.receive()? {
                self.in_step.answer(answer.header().stamp);
                self.outlet.count_answer()?;
            }
            if let Some(stamp) = self.in_step.done()? {
                self.schedule.answered(stamp);
            }
            self.outlet.health.tick()?;
            if let Some(keyboard) = &mut self.keyboard {
                match keyboard.take() {
                    KeyPress::Quit => return Ok(Flow::Stop),
                    KeyPress::Resumed => self.schedule.resume(),
                    KeyPress::Nothing => {}
                }
                if keyboard.is_paused
                    && let Some(pending) = &self.pending
                {
                    if keyboard.steps == 0 {
                        return Ok(Flow::Continue);
                    }
                    if pending.is_scan() {
                        tracing::info!("scan of {:.3} s", pending.stamp_ns() as f64 * 1e-9);
                        keyboard.steps -= 1;
                    }
                    // Sent before its time.
                    self.send()?;
                    continue;
                }
            }
            let pending_ns = self.pending.as_ref().map(|timed| timed.log_time_ns);
            let now_ns = monotonic_ns();
            match self.schedule.next(pending_ns, now_ns) {
                Action::Send => self.send()?,
                Action::SleepUntil(due_ns) => {
                    let left = Duration::from_nanos((due_ns - now_ns).unsigned_abs());
                    if left > TICK {
                        return Ok(Flow::Continue);
                    }
                    std::thread::sleep(left);
                }
                Action::AwaitAnswer => return Ok(Flow::Continue),
                Action::GiveUp(stamp) => self.outlet.give_up(stamp, self.config.patience)?,
                Action::Done => {
                    self.is_finished = true;
                    return Ok(Flow::Stop);
                }
            }
        }
        Ok(Flow::Continue)
    }

    fn send(&mut self) -> Result<(), ReplayerError> {
        if let Some(timed) = self.pending.take()
            && let Some(stamp) = self.outlet.send(timed)?
            // At a speed factor the graph may be missing; at max it must answer.
            && (self.config.rate == Rate::Max || self.outlet.has_subscribers())
        {
            self.schedule.scan_sent(stamp);
        }
        self.advance()
    }

    /// Takes the next message of the recording, if there is one.
    fn advance(&mut self) -> Result<(), ReplayerError> {
        while self.pending.is_none() && self.failure.is_none() {
            match self.items.next() {
                Some(Ok(timed)) => self.pending = Some(timed),
                Some(Err(error)) if error.is_about_one_message() => self.outlet.refuse(&error)?,
                Some(Err(error)) => self.failure = Some(error),
                None if self.starts_over() => {}
                None => break,
            }
        }
        Ok(())
    }

    /// Starts another round, unless the last one had no scan, in which case it would loop without
    /// end.
    fn starts_over(&mut self) -> bool {
        let scans = self.outlet.tally.scans;
        if !self.config.looped || scans == self.scans_before {
            return false;
        }
        self.scans_before = scans;
        let (channels, selection) = (self.channels.clone(), self.selection.clone());
        self.items = InOrder::new(Source::new(self.recording, channels, selection));
        self.schedule.start_over(self.gap_ns);
        true
    }

    fn conclude(mut self) -> Result<ExitCode, ReplayerError> {
        let Tally {
            scans,
            answers,
            unanswered,
            refused,
        } = self.outlet.tally;
        let how = match self.is_finished {
            true => "played",
            false => "stopped",
        };
        tracing::info!(scans, answers, unanswered, refused, "{how}");
        match self.failure {
            _ if !self.is_finished => Ok(ExitCode::SUCCESS),
            Some(error) if error.is_damage() => {
                let lost = with_causes(&error);
                tracing::error!("the rest of the recording was lost: {lost}");
                self.outlet.health.error(&lost)?;
                Ok(finished(true))
            }
            Some(error) => Err(error.into()),
            None => Ok(finished(unanswered + refused > 0)),
        }
    }
}
