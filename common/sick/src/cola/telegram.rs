//! Dispatch of a telegram by its letters and name.

use super::{Answer, Command, Encoding, LmdScanData, lmd_scan_data};
use crate::SickError;
use crate::cursor::Cursor;

/// Parsed content of a telegram, of either direction.
#[derive(Debug, Clone, PartialEq)]
pub enum Telegram<'a> {
    /// A scan, pushed (`sSN`) or polled (`sRA`).
    ScanData(LmdScanData<'a>),
    Command(Command<'a>),
    Answer(Answer<'a>),
    /// Whole content of any other telegram; its parameters are not parsed.
    Other(&'a [u8]),
}

impl<'a> Telegram<'a> {
    /// Parses the content of a telegram.
    ///
    /// Unsupported commands are accepted as they are.
    pub fn read(encoding: Encoding, content: &'a [u8]) -> Result<Self, SickError> {
        let Some((letters, rest)) = content.split_first_chunk::<3>() else {
            return Ok(Telegram::Other(content));
        };
        if letters == b"sFA" {
            return Answer::read_fault(encoding, rest).map(Telegram::Answer);
        }
        let Some((b' ', rest)) = rest.split_first() else {
            return Ok(Telegram::Other(content));
        };
        let length = rest.iter().position(|&byte| byte == b' ');
        let (name, fields) = rest.split_at(length.unwrap_or(rest.len()));
        let fields = fields.get(1..).unwrap_or_default();
        if matches!(letters, b"sSN" | b"sRA") && name == lmd_scan_data::NAME {
            return LmdScanData::read(encoding, content).map(Telegram::ScanData);
        }
        let mut cursor = Cursor::new(encoding, fields, content.len() - fields.len());
        if let Some(command) = Command::read(letters, name, &mut cursor)? {
            return Ok(Telegram::Command(command));
        }
        let answer = Answer::read(letters, name, &mut cursor)?;
        Ok(answer.map_or(Telegram::Other(content), Telegram::Answer))
    }

    pub fn write(&self, encoding: Encoding, out: &mut Vec<u8>) {
        match self {
            Telegram::ScanData(data) => data.write(encoding, out),
            Telegram::Command(command) => command.write(encoding, out),
            Telegram::Answer(answer) => answer.write(encoding, out),
            Telegram::Other(content) => out.extend_from_slice(content),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cola::{
        AUTHORIZED_CLIENT, Fault, Method, OutputRange, PASSWORD_AUTHORIZED_CLIENT, ScanConfig,
        ScanDataConfig, Value, Variable,
    };

    const SCAN: ScanConfig = ScanConfig {
        frequency_raw_1e2_hz: 5000,
        range: RANGE,
    };

    const DATA: ScanDataConfig = ScanDataConfig {
        time: true,
        ..ScanDataConfig::DISTANCES
    };

    const RANGE: OutputRange = OutputRange {
        resolution_raw_1e4_deg: 5000,
        start_angle_raw_1e4_deg: -450_000,
        stop_angle_raw_1e4_deg: 2_250_000,
    };

    const IDENT: Value<'_> = Value::DeviceIdent {
        name: b"LMS10x_FieldEval",
        version: b"V1.36-21.10.2010",
    };

    fn framed(encoding: Encoding, telegram: &Telegram<'_>) -> Vec<u8> {
        let mut out = Vec::new();
        encoding.frame(telegram, &mut out);
        out
    }

    /// Returns each kind of telegram with its text in CoLa A.
    fn all() -> Vec<(Telegram<'static>, &'static str)> {
        let login = Method::SetAccessMode {
            level: AUTHORIZED_CLIENT,
            password: PASSWORD_AUTHORIZED_CLIENT,
        };
        let commands = [
            (Command::Read(Variable::DeviceIdent), "sRN DeviceIdent"),
            (Command::Call(login), "sMN SetAccessMode 3 F4724744"),
            (
                Command::Call(Method::SetScanConfig(SCAN)),
                "sMN mLMPsetscancfg 1388 1 1388 FFF92230 225510",
            ),
            (Command::Call(Method::Run), "sMN Run"),
            (
                Command::Write(Value::ScanDataConfig(DATA)),
                "sWN LMDscandatacfg 1 0 0 1 0 0 0 0 0 0 1 1",
            ),
            (
                Command::Write(Value::OutputRange(RANGE)),
                "sWN LMPoutputRange 1 1388 FFF92230 225510",
            ),
            (Command::Write(Value::HostEncoding(true)), "sWN EIHstCola 1"),
            (Command::SubscribeScans(true), "sEN LMDscandata 1"),
        ];
        let set = Answer::ScanConfigSet {
            status: 0,
            config: SCAN,
        };
        let answers = [
            (
                Answer::Value(IDENT),
                "sRA DeviceIdent 10 LMS10x_FieldEval 10 V1.36-21.10.2010",
            ),
            (Answer::Value(Value::DeviceState(1)), "sRA SCdevicestate 1"),
            (
                Answer::Value(Value::ScanConfig(SCAN)),
                "sRA LMPscancfg 1388 1 1388 FFF92230 225510",
            ),
            (
                Answer::Written(Variable::ScanDataConfig),
                "sWA LMDscandatacfg",
            ),
            (Answer::AccessMode(true), "sAN SetAccessMode 1"),
            (set, "sAN mLMPsetscancfg 0 1388 1 1388 FFF92230 225510"),
            (Answer::Running(true), "sAN Run 1"),
            (Answer::ScansSubscribed(true), "sEA LMDscandata 1"),
            (Answer::Fault(Fault::UNKNOWN_VARIABLE), "sFA 3"),
        ];
        let commands = commands.map(|(command, text)| (Telegram::Command(command), text));
        let answers = answers.map(|(answer, text)| (Telegram::Answer(answer), text));
        commands.into_iter().chain(answers).collect()
    }

    #[test]
    fn every_telegram_in_both_encodings_and_back() {
        for (telegram, text) in all() {
            let written = framed(Encoding::Text, &telegram);
            let expected = [&[2], text.as_bytes(), &[3]].concat();
            assert_eq!(written, expected, "{text}");
            assert_eq!(
                Telegram::read(Encoding::Text, text.as_bytes()).unwrap(),
                telegram
            );
            let mut content = Vec::new();
            telegram.write(Encoding::Binary, &mut content);
            let read = Telegram::read(Encoding::Binary, &content);
            assert_eq!(read.unwrap(), telegram, "{text}");
        }
    }

    #[test]
    fn the_binary_request_is_byte_for_byte_that_of_the_listing() {
        let request = [
            2, 2, 2, 2, 0, 0, 0, 0x11, 0x73, 0x45, 0x4e, 0x20, 0x4c, 0x4d, 0x44, 0x73, 0x63, 0x61,
            0x6e, 0x64, 0x61, 0x74, 0x61, 0x20, 0x01, 0x33,
        ];
        // The listing prints 0x33 for both request and answer, but the XOR of the request is 0x33
        // and that of the answer is 0x3c.
        let subscribe = Telegram::Command(Command::SubscribeScans(true));
        assert_eq!(framed(Encoding::Binary, &subscribe), request);
        let subscribed = Telegram::Answer(Answer::ScansSubscribed(true));
        assert_eq!(framed(Encoding::Binary, &subscribed).last(), Some(&0x3c));
    }

    #[test]
    fn what_is_not_understood_passes_and_what_is_wrong_does_not() {
        let kind = |content: &[u8]| match Telegram::read(Encoding::Binary, content) {
            Ok(Telegram::Other(_)) => "other".into(),
            Ok(known) => format!("{known:?}"),
            Err(error) => error.to_string(),
        };
        assert!(kind(b"sEA LMDscandata \x02").contains("`start or stop` is 2"));
        assert!(kind(b"sEA LMDscandata \x01\x01").contains("1 bytes follow"));
        assert!(kind(b"sRN DeviceIdent \x01").contains("1 bytes follow"));
        assert!(kind(b"sRA LMPoutputRange \0\x02").contains("`sectors` is 2, allowed is 1"));
        assert_eq!(kind(b"sEA LIDoutputstate \x01"), "other");
        assert_eq!(kind(b"sFA\x00\x0d"), "Answer(Fault(Fault(13)))");
        assert_eq!(kind(b"sFA \x00\x0d"), "Answer(Fault(Fault(13)))");
        assert!(kind(b"sFA").contains("`error code` takes 2 bytes, 0 are left"));
        assert_eq!(kind(b"sRA STlms"), "other");
        assert_eq!(
            kind(b"sWA LMDscandatacfg "),
            "Answer(Written(ScanDataConfig))"
        );
        assert!(kind(b"sSN LMDscandata ").contains("`version` takes 2 bytes"));
        assert_eq!(kind(b"s"), "other");
    }
}
