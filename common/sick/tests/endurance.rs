//! A million telegrams of each format with faults between them: accepted scans are correct, no
//! memory accumulates, a fault costs no more than its own telegram, and valid streams allocate
//! nothing.
#![allow(clippy::unwrap_used, reason = "the lint spares test functions alone")]

use allocation_counter::measure;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use sick::cola::{Channel, Channels, Encoding, Framer, LmdScanData, Telegram};
use sick::lms2xx::{Answer, Reply, ReplyFramer, Scan, Status, Unit};

/// Number of readings per scan.
const READINGS: u16 = 41;
/// Number of distinct telegrams, played `ROUNDS` times.
const TELEGRAMS: u16 = 1000;
const ROUNDS: usize = 1000;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    ColaA,
    ColaB,
    Lms2xx,
}

impl Format {
    const ALL: [Format; 3] = [Format::ColaA, Format::ColaB, Format::Lms2xx];

    /// Returns scan `number`, which every reading encodes.
    fn telegram(self, number: u16) -> Vec<u8> {
        let readings: Vec<u16> = (0..READINGS).map(|beam| reading(number, beam)).collect();
        let mut out = Vec::new();
        match self {
            Format::ColaA => Encoding::Text.frame(&cola(number, &channel(&readings)), &mut out),
            Format::ColaB => Encoding::Binary.frame(&cola(number, &channel(&readings)), &mut out),
            Format::Lms2xx => {
                let scan = Scan::new(Unit::Centimetre, &readings);
                Reply::Answer(Answer::Scan(scan), Status(0x10)).frame(&mut out);
            }
        }
        out
    }
}

/// Returns a reading of thirteen bits, as on an LMS2xx.
fn reading(number: u16, beam: u16) -> u16 {
    (number.wrapping_mul(31).wrapping_add(beam * 17)) & 0x1fff
}

fn channel(readings: &[u16]) -> [Channel<'_>; 1] {
    [Channel {
        name: *b"DIST1",
        scale_factor: 1.0,
        scale_offset: 0.0,
        start_angle_raw_1e4_deg: 0,
        step_raw_1e4_deg: 5000,
        values: readings.into(),
    }]
}

fn cola<'a>(number: u16, channels: &'a [Channel<'a>]) -> Telegram<'a> {
    Telegram::ScanData(LmdScanData {
        version: 1,
        device_number: 1,
        serial_number: 1,
        telegram_counter: number,
        scan_counter: number,
        scan_frequency_raw_1e2_hz: 5000,
        channels_16_bit: Channels::from(channels),
        ..LmdScanData::default()
    })
}

/// Framer of either kind; reports the number of each scan, or `None` if it is wrong.
enum Reader {
    Cola(Framer),
    Lms2xx(ReplyFramer),
}

impl Reader {
    fn new(format: Format) -> Self {
        match format {
            Format::ColaA => Reader::Cola(Framer::new(Encoding::Text)),
            Format::ColaB => Reader::Cola(Framer::new(Encoding::Binary)),
            Format::Lms2xx => Reader::Lms2xx(ReplyFramer::default()),
        }
    }

    fn push(&mut self, piece: &[u8], mut see: impl FnMut(Option<u16>)) {
        match self {
            Reader::Cola(framer) => {
                framer.push(piece);
                while let Some(next) = framer.next_frame() {
                    if let Ok(frame) = next
                        && let Telegram::ScanData(scan) = frame.telegram
                    {
                        let values = scan.channels_16_bit.flat_map(|channel| channel.values);
                        see(number(values));
                    }
                }
            }
            Reader::Lms2xx(framer) => {
                framer.push(piece);
                while let Some(next) = framer.next_frame() {
                    if let Ok(frame) = next
                        && let Reply::Answer(Answer::Scan(scan), _) = frame.telegram
                    {
                        see(number(scan.readings));
                    }
                }
            }
        }
    }
}

/// Returns the number of the scan with these readings, if all of them fit.
fn number(readings: impl Iterator<Item = u16>) -> Option<u16> {
    let (mut count, mut first, mut is_sound) = (0, 0, true);
    for found in readings {
        if count == 0 {
            first = found;
        }
        is_sound &= found == first.wrapping_add(count * 17) & 0x1fff;
        count += 1;
    }
    // 31 · 7135 is one more than a multiple of 2¹³.
    (is_sound && count == READINGS).then(|| first.wrapping_mul(7135) & 0x1fff)
}

/// Returns the telegrams with random faults, and which of them are intact.
fn faulty(format: Format, random: &mut Xoshiro256PlusPlus) -> (Vec<Vec<u8>>, Vec<bool>) {
    let numbers = 0..TELEGRAMS;
    let pairs = numbers.map(|number| {
        let mut bytes = format.telegram(number);
        let mut is_whole = true;
        match random.random_range(0..100) {
            // CoLa A has no checksum: a wrong digit cannot be told from a right one.
            0 if format != Format::ColaA => {
                let at = random.random_range(0..bytes.len());
                bytes[at] ^= 1 << random.random_range(0..8);
                is_whole = false;
            }
            1 => {
                bytes.clear();
                is_whole = false;
            }
            2 => {
                let end = random.random_range(1..bytes.len());
                bytes.truncate(end);
                is_whole = false;
            }
            3 => {
                let count = random.random_range(1..64);
                let garbage = (0..count).map(|_| random.random_range(4..=255u8));
                bytes.splice(0..0, garbage);
            }
            _ => {}
        }
        (bytes, is_whole)
    });
    pairs.unzip()
}

#[test]
fn a_million_telegrams_with_faults_leave_nothing_behind() {
    for format in Format::ALL {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(5);
        let (telegrams, whole) = faulty(format, &mut random);
        let sound: Vec<bool> = whole.clone();
        let stream = telegrams.concat();
        let mut reader = Reader::new(format);
        let mut found = 0;
        let mut play = |reader: &mut Reader| {
            let mut rest = &stream[..];
            while !rest.is_empty() {
                let (piece, more) = rest.split_at(random.random_range(1..=rest.len().min(2000)));
                reader.push(piece, |number| {
                    let number = number.unwrap_or_else(|| panic!("{format:?}: a wrong scan"));
                    assert!(
                        sound[usize::from(number)],
                        "{format:?}: {number} was damaged"
                    );
                    found += 1;
                });
                rest = more;
            }
        };
        play(&mut reader);
        play(&mut reader);
        let used = measure(|| {
            for _ in 2..ROUNDS {
                play(&mut reader);
            }
        });
        // The buffer may grow by the longest pieces that occur, a few thousand bytes; a leak of one
        // byte per telegram would be a million.
        let kept = used.bytes_current;
        assert!(kept < 20_000, "{format:?} keeps {kept} bytes");
        let most = used.bytes_max;
        assert!(most < 40_000, "{format:?} takes {most} bytes");
        let expected = whole.iter().filter(|whole| **whole).count() * ROUNDS;
        assert!(found <= expected, "{format:?}: {found} of {expected}");
        // A truncated telegram may claim bytes of the next one, which is still found.
        assert!(
            found + ROUNDS >= expected,
            "{format:?}: {found} of {expected}"
        );
    }
}

#[test]
fn sound_streams_allocate_nothing() {
    for format in Format::ALL {
        let telegrams: Vec<Vec<u8>> = (0..TELEGRAMS).map(|n| format.telegram(n)).collect();
        let stream = telegrams.concat();
        let mut reader = Reader::new(format);
        let mut play = |found: &mut usize| {
            for piece in stream.chunks(1460) {
                reader.push(piece, |number| *found += usize::from(number.is_some()));
            }
        };
        play(&mut 0);
        let mut found = 0;
        let used = measure(|| (0..20).for_each(|_| play(&mut found)));
        assert_eq!(found, 20 * usize::from(TELEGRAMS), "{format:?}");
        assert_eq!(used.count_total, 0, "{format:?}");
    }
}

/// Damages one telegram at every place: after the last byte of the next intact one, that one and
/// all others must have been returned.
#[test]
fn after_a_fault_the_next_scan_is_there_with_its_last_byte() {
    for format in Format::ALL {
        let before = format.telegram(1);
        let hit = format.telegram(2);
        let after = format.telegram(3);
        let mut cases = Vec::new();
        for at in 0..hit.len() {
            cases.push((format!("cut after {at} bytes"), hit[..at].to_vec()));
            if format != Format::ColaA {
                for bit in 0..8 {
                    let mut bytes = hit.clone();
                    bytes[at] ^= 1 << bit;
                    cases.push((format!("bit {bit} of byte {at} flipped"), bytes));
                }
            }
        }
        for (case, bytes) in cases {
            let mut reader = Reader::new(format);
            let mut seen = Vec::new();
            for piece in [&before[..], &bytes, &after].concat().chunks(100) {
                reader.push(piece, |number| seen.push(number));
            }
            assert_eq!(seen, [Some(1), Some(3)], "{format:?}, {case}");
        }
    }
}
