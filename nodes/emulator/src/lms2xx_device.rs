//! Emulated LMS2xx: answers, refusals and scan telegrams.
//!
//! Pure: commands in, replies out. It sends scans of the configured field and resolution if the
//! recording has all their beams.

use sick::lms2xx::{
    Answer, Baud, Command, Configuration, DEFAULT_PASSWORD, DeviceStatus, Mode, RangeMode, Reply,
    Scan, Status, Unit,
};

use crate::EmulatorError;
use crate::sweep::{AHEAD_RAW, Sweep};

/// Supported widths in degrees and resolutions in 1/100°.
const VARIANTS: [(u16, u16); 5] = [(180, 50), (180, 100), (100, 25), (100, 50), (100, 100)];
const TYPE: &[u8] = b"LMS291;S05 emulated";
/// Status "ok" of a real device.
const STATUS: Status = Status(0x10);

#[derive(Debug)]
pub(crate) struct Lms2xxDevice {
    power_on_baud: Baud,
    power_on_variant: (u16, u16),
    /// Variants for which the recording has all beams.
    variants: Vec<(u16, u16)>,
    pub(crate) baud: Baud,
    mode: Mode,
    variant: (u16, u16),
    configuration: Configuration,
    /// True if a scan was requested and not yet sent.
    is_asked: bool,
    /// Buffer of readings, reused.
    readings: Vec<u16>,
}

impl Lms2xxDevice {
    /// Creates the device as it is after power-on.
    pub(crate) fn new(baud: Baud, sweep: &Sweep) -> Result<Self, EmulatorError> {
        let has = |&(width, resolution): &(u16, u16)| {
            let half = i32::from(width) * 5000;
            let step = i32::from(resolution) * 100;
            sweep.start_raw <= AHEAD_RAW - half
                && sweep.stop_raw() >= AHEAD_RAW + half
                && (AHEAD_RAW - half - sweep.start_raw) % sweep.step_raw == 0
                && step % sweep.step_raw == 0
        };
        let variants: Vec<_> = VARIANTS.into_iter().filter(has).collect();
        let Some(&variant) = variants.first() else {
            let step_deg = f64::from(sweep.step_raw) * 1e-4;
            let allowed = "180° at 0.5° or 1°, or 100° at 0.25°, 0.5° or 1°";
            let field = "the angle from beam to beam";
            return Err(EmulatorError::scan(0, field, step_deg, allowed));
        };
        Ok(Lms2xxDevice {
            power_on_baud: baud,
            power_on_variant: variant,
            variants,
            baud,
            mode: Mode::OnRequest,
            variant,
            configuration: Configuration::new(RangeMode::Range8Fields, Unit::Centimetre),
            is_asked: false,
            readings: Vec::new(),
        })
    }

    /// Restarts the device and returns its start message; the configuration is kept.
    pub(crate) fn restart(&mut self) -> Reply<'static> {
        self.baud = self.power_on_baud;
        self.mode = Mode::OnRequest;
        self.variant = self.power_on_variant;
        self.is_asked = false;
        Reply::Answer(Answer::Started(TYPE), STATUS)
    }

    pub(crate) fn is_wanted(&self) -> bool {
        self.mode == Mode::Continuous || self.is_asked
    }

    /// Appends the acknowledgement and the answer to a command; returns the baud rate after the
    /// answer.
    pub(crate) fn receive(&mut self, command: &Command<'_>, out: &mut Vec<u8>) -> Baud {
        let mut next_baud = self.baud;
        let answer = match command {
            Command::SetMode(mode) => {
                let result = self.set_mode(*mode);
                if let (Mode::Baud(baud), 0) = (*mode, result) {
                    next_baud = baud;
                }
                Answer::ModeSet(result)
            }
            Command::RequestScan if self.mode == Mode::OnRequest => {
                self.is_asked = true;
                Reply::Acknowledged.frame(out);
                return next_baud;
            }
            Command::RequestStatus => Answer::Status(self.status()),
            Command::RequestType => Answer::Type(TYPE),
            Command::SetVariant {
                width_deg,
                resolution_raw_1e2_deg,
            } => self.set_variant((*width_deg, *resolution_raw_1e2_deg)),
            Command::RequestConfiguration => Answer::Configuration(self.configuration),
            Command::SetConfiguration(configuration) => self.set_configuration(*configuration),
            Command::RequestScan | Command::Other(_) => {
                Reply::Refused.frame(out);
                return next_baud;
            }
        };
        Reply::Acknowledged.frame(out);
        Reply::Answer(answer, STATUS).frame(out);
        next_baud
    }

    /// Changes the mode; returns 0 on success, else the error code.
    fn set_mode(&mut self, mode: Mode) -> u8 {
        match mode {
            Mode::Baud(_) => return 0,
            Mode::Installation { password } if password != DEFAULT_PASSWORD => return 1,
            Mode::PartialScans | Mode::Other(_) => return 1,
            Mode::Installation { .. } | Mode::Continuous | Mode::OnRequest => {}
        }
        self.mode = mode;
        self.is_asked = false;
        0
    }

    fn set_variant(&mut self, wanted: (u16, u16)) -> Answer<'static> {
        let done = self.variants.contains(&wanted);
        if done {
            self.variant = wanted;
        }
        let (width_deg, resolution_raw_1e2_deg) = self.variant;
        Answer::VariantSet {
            done,
            width_deg,
            resolution_raw_1e2_deg,
        }
    }

    fn set_configuration(&mut self, wanted: Configuration) -> Answer<'static> {
        let done = matches!(self.mode, Mode::Installation { .. })
            && wanted.range_mode != RangeMode::Amplitude;
        if done {
            self.configuration = wanted;
        }
        Answer::ConfigurationSet {
            done,
            configuration: self.configuration,
        }
    }

    fn status(&self) -> DeviceStatus {
        DeviceStatus {
            version: *b"V02.30 ",
            mode: self.mode.code(),
            has_error: false,
            turns: 4500,
            range_mode: self.configuration.range_mode,
            width_deg: self.variant.0,
            resolution_raw_1e2_deg: self.variant.1,
            unit: self.configuration.unit,
        }
    }

    /// Appends the telegram of a scan, if the client wants one.
    pub(crate) fn write_scan(&mut self, sweep: &Sweep, scan: usize, out: &mut Vec<u8>) {
        if !self.is_wanted() {
            return;
        }
        self.is_asked = false;
        self.fill_readings(sweep, scan);
        let scan = Scan::new(self.configuration.unit, &self.readings);
        Reply::Answer(Answer::Scan(scan), STATUS).frame(out);
    }

    fn fill_readings(&mut self, sweep: &Sweep, scan: usize) {
        let (width, resolution) = self.variant;
        let half = i32::from(width) * 5000;
        let angles = AHEAD_RAW - half..=AHEAD_RAW + half;
        let mode = self.configuration.range_mode;
        let metres = self.configuration.unit.metres();
        self.readings.clear();
        let beams = angles.step_by(usize::from(resolution) * 100);
        self.readings.extend(beams.map(|angle| {
            let range = sweep.range(scan, angle).map(f64::from);
            // The cast saturates at the largest value, which is a code.
            mode.reading(range.map(|range| (range / metres).round() as u16))
        }));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns 361 beams over 180° whose ranges are their own index in centimetres.
    fn sweep() -> Sweep {
        let ranges = (0..361).map(|beam| beam as f32 * 0.01).collect();
        crate::sweep::beams(-90.0, 0.5, 0.1, ranges).unwrap()
    }

    fn device() -> Lms2xxDevice {
        Lms2xxDevice::new(Baud::B38400, &sweep()).unwrap()
    }

    fn ask(device: &mut Lms2xxDevice, command: Command<'_>) -> Vec<Reply<'static>> {
        let mut bytes = Vec::new();
        device.receive(&command, &mut bytes);
        // Leaking is fine in a short test, and a reply borrows its bytes.
        let (acknowledgement, rest) = bytes.leak().split_at(1);
        let mut replies = vec![Reply::read(acknowledgement).unwrap()];
        // Start, address, length and CRC surround the payload.
        if let Some(end) = rest.len().checked_sub(2) {
            replies.push(Reply::read(&rest[4..end]).unwrap());
        }
        replies
    }

    fn answer(device: &mut Lms2xxDevice, command: Command<'_>) -> Answer<'static> {
        match ask(device, command)[..] {
            [Reply::Acknowledged, Reply::Answer(answer, STATUS)] => answer,
            ref other => panic!("{other:?}"),
        }
    }

    #[test]
    fn settings_change_only_in_the_installation_mode() {
        let mut device = device();
        let wanted = Configuration::new(RangeMode::Range32Field, Unit::Millimetre);
        let set = Command::SetConfiguration(wanted);
        let is_done = |answer| matches!(answer, Answer::ConfigurationSet { done: true, .. });
        assert!(!is_done(answer(&mut device, set)));
        let install = |password| Command::SetMode(Mode::Installation { password });
        assert_eq!(
            answer(&mut device, install(*b"password")),
            Answer::ModeSet(1)
        );
        assert_eq!(
            answer(&mut device, install(DEFAULT_PASSWORD)),
            Answer::ModeSet(0)
        );
        assert!(is_done(answer(&mut device, set)));
        let read = answer(&mut device, Command::RequestConfiguration);
        assert_eq!(read, Answer::Configuration(wanted));
    }

    #[test]
    fn variants_that_the_recording_lacks_are_refused() {
        let mut device = device();
        let mut set = |width_deg, resolution_raw_1e2_deg| {
            let command = Command::SetVariant {
                width_deg,
                resolution_raw_1e2_deg,
            };
            match answer(&mut device, command) {
                Answer::VariantSet {
                    done,
                    width_deg,
                    resolution_raw_1e2_deg,
                } => (done, width_deg, resolution_raw_1e2_deg),
                other => panic!("{other:?}"),
            }
        };
        assert_eq!(set(100, 25), (false, 180, 50));
        assert_eq!(set(90, 50), (false, 180, 50));
        assert_eq!(set(100, 100), (true, 100, 100));
        let error = Lms2xxDevice::new(Baud::B9600, &crate::sweep::five_beams(1.0)).unwrap_err();
        assert!(error.to_string().contains("180° at 0.5° or 1°"), "{error}");
    }

    #[test]
    fn scans_in_the_unit_and_the_field_that_are_set() {
        let (mut device, sweep) = (device(), sweep());
        let mut out = Vec::new();
        device.write_scan(&sweep, 0, &mut out);
        assert!(out.is_empty(), "nobody asked");
        answer(
            &mut device,
            Command::SetVariant {
                width_deg: 100,
                resolution_raw_1e2_deg: 100,
            },
        );
        assert_eq!(
            ask(&mut device, Command::RequestScan),
            [Reply::Acknowledged]
        );
        device.write_scan(&sweep, 0, &mut out);
        let Ok(Reply::Answer(Answer::Scan(scan), _)) = Reply::read(&out[4..out.len() - 2]) else {
            panic!("no scan");
        };
        // Beam 80 is 40° from the right, where a field of 100° begins.
        let expected: Vec<u16> = (80..=280).step_by(2).collect();
        assert_eq!(scan.readings.collect::<Vec<_>>(), expected);
        assert!(!device.is_wanted(), "one was asked for");
    }

    #[test]
    fn the_baud_rate_changes_after_the_answer_and_is_lost_with_power() {
        let mut device = device();
        let mut out = Vec::new();
        let command = Command::SetMode(Mode::Baud(Baud::B500000));
        assert_eq!(device.receive(&command, &mut out), Baud::B500000);
        assert_eq!(
            device.baud,
            Baud::B38400,
            "the answer is sent at the old rate"
        );
        device.baud = Baud::B500000;
        assert!(matches!(
            device.restart(),
            Reply::Answer(Answer::Started(_), _)
        ));
        assert_eq!(device.baud, Baud::B38400);
        assert_eq!(ask(&mut device, Command::Other(&[0x10])), [Reply::Refused]);
    }
}
