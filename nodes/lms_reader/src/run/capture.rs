//! Reads scans from a file of telegrams.

use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;
use std::time::Instant;

use sick::cola::{Answer, Encoding, Framer, Telegram, Value};

use super::failed;
use super::outlet::Outlet;
use crate::pace::Pace;
use crate::{Config, LmsError, Rate};

/// Plays the capture, once or in a loop, until the stop flag is set.
pub(super) fn run(path: &Path, config: &Config, outlet: &mut Outlet) -> Result<(), LmsError> {
    let mut pacer = (config.rate == Rate::Device).then(|| (Instant::now(), Pace::default()));
    loop {
        play(path, config.protocol, &mut pacer, outlet)?;
        if outlet.stopped() {
            break;
        }
        // Looping over a file without usable scans would spin forever.
        if outlet.sent == 0 {
            let reason = outlet.scan_refusal.take();
            return Err(LmsError::Other(format!(
                "{}: no scan could be used, of {} telegrams; {}",
                path.display(),
                outlet.telegrams,
                reason
                    .as_deref()
                    .unwrap_or("expected are CoLa telegrams `sSN LMDscandata`")
            )));
        }
        if !config.looped {
            break;
        }
    }
    let (sent, refused) = (outlet.sent, outlet.refused);
    tracing::info!(sent, refused, "end of the capture");
    outlet.finish()
}

fn play(
    path: &Path,
    encoding: Encoding,
    pacer: &mut Option<(Instant, Pace)>,
    outlet: &mut Outlet,
) -> Result<(), LmsError> {
    let failed = |error| failed(path.display(), "read the capture", error);
    let mut file = File::open(path).map_err(failed)?;
    let mut framer = Framer::new(encoding);
    let mut piece = [0; 1 << 14];
    let mut more = true;
    while more && !outlet.stopped() {
        match file.read(&mut piece) {
            Ok(0) => {
                framer.finish();
                more = false;
            }
            Ok(count) => framer.push(piece.get(..count).unwrap_or_default()),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(failed(error)),
        }
        send_all(&mut framer, pacer, outlet)?;
    }
    Ok(())
}

fn send_all(
    framer: &mut Framer,
    pacer: &mut Option<(Instant, Pace)>,
    outlet: &mut Outlet,
) -> Result<(), LmsError> {
    while let Some(next) = framer.next_frame() {
        let data = match outlet.take(next)? {
            Some(Telegram::ScanData(data)) => data,
            Some(Telegram::Answer(Answer::Value(Value::DeviceIdent { name, .. }))) => {
                outlet.angles.on_name(name);
                continue;
            }
            Some(other) => {
                tracing::debug!(?other, "skipped a telegram");
                continue;
            }
            None => continue,
        };
        if let Some((start, pace)) = pacer {
            outlet.wait_until(*start + pace.due(data.time_of_transmission_us))?;
        }
        if outlet.stopped() {
            break;
        }
        outlet.publish_cola(&data, super::now())?;
        outlet.tick()?;
    }
    Ok(())
}
