//! Emulated CoLa device: answers, refusals and scan telegrams.
//!
//! Pure: commands in, answers out. It rejects what a real device rejects: changes without a login,
//! unsupported values, unknown names.

use sick::cola::{
    AUTHORIZED_CLIENT, AngleConvention, Answer, Channel, Channels, Command, DeviceTime, Encoding,
    FIRST_DISTANCE, Fault, KnownDevice, LmdScanData, Method, OutputRange,
    PASSWORD_AUTHORIZED_CLIENT, ScanConfig, ScanDataConfig, Telegram, Value, Variable, sweep_us,
};

use crate::sweep::{AHEAD_RAW, Sweep};

/// Longest distance of 16 bits in millimetres.
const FARTHEST_M: f32 = 65.535;

/// State of one client.
#[derive(Debug, Default)]
pub(crate) struct Session {
    /// True if the client may change settings.
    logged_in: bool,
    /// True if every scan is sent to the client.
    pub(crate) subscribed: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Model {
    name: &'static str,
    convention: AngleConvention,
}

impl Model {
    /// Returns a device of the table, by default an LMS111.
    pub(crate) fn of(row: Option<&KnownDevice>) -> Self {
        let usual = AngleConvention::USUAL;
        Model {
            name: row.map_or("LMS111 emulated", |row| row.name),
            convention: row.and_then(|row| row.convention).unwrap_or(usual),
        }
    }

    /// Converts an angle of the recording, which counts counter-clockwise with 90° ahead, to the
    /// device's angle.
    fn turn(&self, angle_raw: i32) -> i32 {
        match self.convention.clockwise {
            true => self.ahead_raw() + AHEAD_RAW - angle_raw,
            false => self.ahead_raw() - AHEAD_RAW + angle_raw,
        }
    }

    /// Converts a device angle to the angle of the recording.
    fn turn_back(&self, device_raw: i32) -> i32 {
        match self.convention.clockwise {
            true => self.turn(device_raw),
            false => device_raw - self.ahead_raw() + AHEAD_RAW,
        }
    }

    fn ahead_raw(&self) -> i32 {
        (self.convention.ahead_deg * 1e4).round() as i32
    }
}

/// State of the device, shared by all clients.
#[derive(Debug)]
pub(crate) struct ColaDevice {
    model: Model,
    encoding: Encoding,
    full: ScanConfig,
    scan: ScanConfig,
    range: OutputRange,
    data: ScanDataConfig,
    /// Millimetres per unit of distance: 2 if the recording has longer ranges than 16 bits hold.
    scale: f32,
    /// True if the recording contains the scan time.
    says_frequency: bool,
    /// Buffer of distances, reused.
    distances: Vec<u16>,
}

impl ColaDevice {
    pub(crate) fn new(model: Model, encoding: Encoding, sweep: &Sweep) -> Self {
        let ends = [sweep.start_raw, sweep.stop_raw()].map(|raw| model.turn(raw));
        let full = ScanConfig {
            frequency_raw_1e2_hz: (100.0 / sweep.scan_time_s).round() as u32,
            range: OutputRange {
                resolution_raw_1e4_deg: sweep.step_raw.unsigned_abs(),
                start_angle_raw_1e4_deg: ends[0].min(ends[1]),
                stop_angle_raw_1e4_deg: ends[0].max(ends[1]),
            },
        };
        let ranges = sweep.scans.iter().flatten();
        let is_far = ranges
            .filter(|range| range.is_finite())
            .any(|&range| range > FARTHEST_M);
        ColaDevice {
            says_frequency: sweep.says_time,
            model,
            encoding,
            full,
            scan: full,
            range: full.range,
            data: ScanDataConfig {
                time: true,
                ..ScanDataConfig::DISTANCES
            },
            scale: if is_far { 2.0 } else { 1.0 },
            distances: Vec::new(),
        }
    }

    /// Returns the answer to a telegram; `None` if it is not a command.
    pub(crate) fn receive(
        &mut self,
        session: &mut Session,
        telegram: &Telegram<'_>,
    ) -> Option<Answer<'static>> {
        match telegram {
            Telegram::Command(command) => {
                Some(self.obey(session, command).unwrap_or_else(Answer::Fault))
            }
            Telegram::Other(content) => Some(Answer::Fault(match content.get(..3) {
                Some(b"sRN" | b"sWN") => Fault::UNKNOWN_VARIABLE,
                Some(b"sMN") => Fault::UNKNOWN_METHOD,
                Some(b"sEN") => Fault::UNKNOWN_EVENT,
                _ => Fault::UNKNOWN_COMMAND,
            })),
            Telegram::ScanData(_) | Telegram::Answer(_) => None,
        }
    }

    fn obey(
        &mut self,
        session: &mut Session,
        command: &Command<'_>,
    ) -> Result<Answer<'static>, Fault> {
        match command {
            Command::Read(variable) => Ok(Answer::Value(self.value(*variable))),
            Command::Write(_) if !session.logged_in => Err(Fault::WRITE_DENIED),
            Command::Write(value) => self.write(value),
            Command::Call(method) => self.call(session, method),
            Command::SubscribeScans(on) => {
                session.subscribed = *on;
                Ok(Answer::ScansSubscribed(*on))
            }
        }
    }

    fn value(&self, variable: Variable) -> Value<'static> {
        match variable {
            Variable::DeviceIdent => Value::DeviceIdent {
                name: self.model.name.as_bytes(),
                version: env!("CARGO_PKG_VERSION").as_bytes(),
            },
            Variable::DeviceState => Value::DeviceState(1),
            Variable::ScanConfig => Value::ScanConfig(self.scan),
            Variable::ScanDataConfig => Value::ScanDataConfig(self.data),
            Variable::OutputRange => Value::OutputRange(self.range),
            Variable::HostEncoding => Value::HostEncoding(self.encoding == Encoding::Binary),
        }
    }

    fn write(&mut self, value: &Value<'_>) -> Result<Answer<'static>, Fault> {
        match value {
            Value::ScanDataConfig(data) if data.interval >= 1 && !data.remission => {
                self.data = *data;
            }
            Value::OutputRange(range) if self.can_send(range) => self.range = *range,
            // With another encoding it would no longer understand its client.
            Value::HostEncoding(binary) if *binary == (self.encoding == Encoding::Binary) => {}
            Value::DeviceIdent { .. } | Value::DeviceState(_) | Value::ScanConfig(_) => {
                return Err(Fault::WRITE_DENIED);
            }
            _ => return Err(Fault::OUT_OF_RANGE),
        }
        Ok(Answer::Written(value.variable()))
    }

    fn can_send(&self, range: &OutputRange) -> bool {
        let (start, stop) = (range.start_angle_raw_1e4_deg, range.stop_angle_raw_1e4_deg);
        let all = self.full.range;
        let full = all.start_angle_raw_1e4_deg..=all.stop_angle_raw_1e4_deg;
        let step = all.resolution_raw_1e4_deg.cast_signed();
        let is_beam =
            |angle: i32| full.contains(&angle) && (angle - all.start_angle_raw_1e4_deg) % step == 0;
        is_beam(start) && is_beam(stop) && start < stop
    }

    fn call(&mut self, session: &mut Session, method: &Method) -> Result<Answer<'static>, Fault> {
        let needs_login = !matches!(method, Method::SetAccessMode { .. } | Method::Run);
        if needs_login && !session.logged_in {
            return Err(Fault::METHOD_DENIED);
        }
        Ok(match method {
            Method::SetAccessMode { level, password } => {
                session.logged_in =
                    *level == AUTHORIZED_CLIENT && *password == PASSWORD_AUTHORIZED_CLIENT;
                Answer::AccessMode(session.logged_in)
            }
            Method::SetScanConfig(config) => {
                let status = self.set_scan_config(config);
                Answer::ScanConfigSet {
                    status,
                    config: self.scan,
                }
            }
            Method::Run => {
                session.logged_in = false;
                Answer::Running(true)
            }
        })
    }

    /// Applies a scan configuration; returns 0, or the status code of what is wrong.
    fn set_scan_config(&mut self, config: &ScanConfig) -> u8 {
        let resolution = config.range.resolution_raw_1e4_deg;
        let can_resolve = resolution <= u32::from(u16::MAX)
            && resolution.checked_rem(self.full.range.resolution_raw_1e4_deg) == Some(0)
            && resolution > 0;
        let has_field = config.range
            == OutputRange {
                resolution_raw_1e4_deg: resolution,
                ..self.full.range
            };
        match (can_resolve, has_field) {
            _ if config.frequency_raw_1e2_hz != self.full.frequency_raw_1e2_hz => 1,
            (false, true) => 2,
            (false, false) => 3,
            (true, false) => 4,
            (true, true) => {
                self.scan = *config;
                self.range.resolution_raw_1e4_deg = resolution;
                0
            }
        }
    }

    /// Appends the telegram of a scan, unless the configured interval omits it. `counter` is the
    /// number of scans before it, `now_us` the device's clock.
    pub(crate) fn write_scan(
        &mut self,
        sweep: &Sweep,
        scan: usize,
        counter: u64,
        now_us: u64,
        out: &mut Vec<u8>,
    ) {
        if !counter.is_multiple_of(u64::from(self.data.interval)) {
            return;
        }
        self.fill_distances(sweep, scan);
        let channels = [Channel {
            name: *b"DIST1",
            scale_factor: self.scale,
            scale_offset: 0.0,
            start_angle_raw_1e4_deg: self.range.start_angle_raw_1e4_deg,
            step_raw_1e4_deg: self.range.resolution_raw_1e4_deg as u16,
            values: self.distances[..].into(),
        }];
        let data = LmdScanData {
            version: 1,
            device_number: 1,
            serial_number: 1,
            telegram_counter: counter as u16,
            scan_counter: counter as u16,
            time_since_start_up_us: now_us as u32,
            time_of_transmission_us: now_us as u32,
            // 0 means unknown; otherwise the reader would derive the time of each beam from it.
            scan_frequency_raw_1e2_hz: match self.says_frequency {
                true => self.scan.frequency_raw_1e2_hz,
                false => 0,
            },
            channels_16_bit: Channels::from(&channels[..]),
            name: self.data.name.then_some(&b"emulated"[..]),
            time: self.time(sweep, scan, &channels[0]),
            ..LmdScanData::default()
        };
        self.encoding.frame(&Telegram::ScanData(data), out);
    }

    /// Returns the device's clock: the recording's time, which is that of the rightmost beam, so a
    /// clockwise device measures it last.
    fn time(&self, sweep: &Sweep, scan: usize, channel: &Channel<'_>) -> Option<DeviceTime> {
        let stamp_us = sweep.stamps_us.get(scan).filter(|_| self.data.time)?;
        let before_us = match self.model.convention.clockwise {
            true => sweep_us(channel, self.scan.frequency_raw_1e2_hz),
            false => 0,
        };
        DeviceTime::from_unix_us(stamp_us - before_us)
    }

    fn fill_distances(&mut self, sweep: &Sweep, scan: usize) {
        let range = self.range;
        let angles = range.start_angle_raw_1e4_deg..=range.stop_angle_raw_1e4_deg;
        let unit_m = f64::from(self.scale) * 1e-3;
        self.distances.clear();
        let beams = angles.step_by(range.resolution_raw_1e4_deg.max(1) as usize);
        self.distances.extend(beams.map(|angle| {
            let range = sweep.range(scan, self.model.turn_back(angle));
            let range = range.map(f64::from);
            let units = range.map_or(0.0, |metres| (metres / unit_m).round());
            match (f64::from(FIRST_DISTANCE)..=f64::from(u16::MAX)).contains(&units) {
                true => units as u16,
                false => 0,
            }
        }));
    }
}

#[cfg(test)]
mod tests;
