//! Tests with whole recordings that are cut, flipped and overwritten: a reader gets messages as
//! they were written, then the damage, and never panics.

use mcap::MAGIC;

use crate::survey::Survey;
use crate::write::Packing;
use crate::{Damage, Record, Recording, RecordingError, sample};

const CHUNKED: [Packing; 3] = [Packing::Plain, Packing::Zstd, Packing::Lz4];

fn read(bytes: Vec<u8>) -> (Vec<Record>, Option<Damage>) {
    let mut records = Vec::new();
    match Recording::from_bytes("r.mcap", bytes) {
        Err(RecordingError::Damaged { damage, .. }) => return (records, Some(damage)),
        Err(other) => panic!("{other}"),
        Ok(recording) => {
            for item in recording.records() {
                match item {
                    Ok(record) => records.push(record),
                    Err(RecordingError::Damaged { damage, .. }) => {
                        return (records, Some(damage));
                    }
                    // A damaged length that no checksum covers can show in the message before the
                    // damage is reported.
                    Err(RecordingError::Message { .. }) => {}
                    Err(other) => panic!("{other}"),
                }
            }
        }
    }
    (records, None)
}

/// Returns the next number of a fixed sequence (splitmix64).
fn random(state: &mut u64) -> u64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// Asserts that the messages of `part` are messages of `whole`, in the same order.
fn assert_part(part: &[Record], whole: &[Record], case: &str) {
    let mut rest = whole.iter();
    for record in part {
        assert!(rest.any(|other| other == record), "{case}: {record:?}");
    }
}

#[test]
fn a_flipped_bit_anywhere_is_damage_and_changes_no_message() {
    let mut seed = 1;
    for packing in [Packing::Loose, Packing::Plain, Packing::Zstd, Packing::Lz4] {
        let sound = sample::bytes(packing);
        let (whole, none) = read(sound.clone());
        assert_eq!(none, None);
        for _ in 0..1500 {
            let at = random(&mut seed) as usize % sound.len();
            let bit = random(&mut seed) % 8;
            let mut flipped = sound.clone();
            flipped[at] ^= 1 << bit;
            let case = format!("{packing:?}, byte {at}, bit {bit}");
            let (records, damage) = read(flipped);
            assert!(damage.is_some(), "{case}: not seen");
            assert_part(&records, &whole, &case);
        }
    }
}

#[test]
fn a_file_cut_anywhere_gives_what_is_whole_and_says_where_it_ends() {
    for packing in CHUNKED {
        let sound = sample::bytes(packing);
        let (whole, _) = read(sound.clone());
        let mut most = 0;
        for length in MAGIC.len()..sound.len() {
            let (records, damage) = read(sound[..length].to_vec());
            let case = format!("{packing:?}, cut at {length}");
            match damage {
                Some(Damage::Truncated { length: end, at }) => {
                    assert_eq!(end, length as u64, "{case}");
                    assert!(at <= end, "{case}");
                }
                other => panic!("{case}: {other:?}"),
            }
            assert!(records.len() >= most, "{case}: a longer part gives more");
            most = records.len();
            assert_part(&records, &whole, &case);
        }
        assert_eq!(most, whole.len());
    }
}

#[test]
fn the_error_of_a_cut_file_counts_what_is_readable() {
    let sound = sample::bytes(Packing::Zstd);
    let survey = Survey::of(&sound).unwrap();
    let mut starts: Vec<usize> = survey.blocks.iter().map(|b| b.at).collect();
    starts.sort_unstable();
    let length = starts[2] + 20;
    let cut = Recording::from_bytes("r.mcap", sound[..length].to_vec()).unwrap();
    assert_eq!(cut.messages(), 8);
    let error = cut.records().last().unwrap().unwrap_err();
    assert_eq!(
        error.to_string(),
        format!(
            "r.mcap: the file is cut short: it ends at byte {length}, within the record that starts \
             at byte {}; 8 messages before that are readable",
            starts[2]
        )
    );
    assert!(cut.map().unwrap().is_some(), "what is readable can be used");
}

#[test]
fn many_flips_and_random_bytes_never_panic() {
    let mut seed = 2;
    for round in 0..2000 {
        let packing = CHUNKED[round % 3];
        let mut bytes = sample::bytes(packing);
        for _ in 0..1 + random(&mut seed) % 40 {
            let at = random(&mut seed) as usize % bytes.len();
            bytes[at] = random(&mut seed) as u8;
        }
        if let Ok(recording) = Recording::from_bytes("r.mcap", bytes) {
            let items = recording.records().count();
            assert!(items <= sample::records().len() + 1);
            let _ = recording.map();
            let _ = recording.ground_truths();
            let _ = recording.base_from_laser("laser");
        }
    }
}

#[test]
fn damage_outside_of_checked_chunks_takes_no_message_from_them() {
    let sound = sample::bytes(Packing::Zstd);
    let (whole, _) = read(sound.clone());
    // Within the header record: opcode, length, length of the profile, then the profile.
    let mut flipped = sound;
    let profile = MAGIC.len() + 9 + 4;
    assert_eq!(flipped[profile..profile + 4], *b"ros2");
    flipped[profile] ^= 1;
    let (records, damage) = read(flipped);
    assert!(matches!(damage, Some(Damage::DataChecksum { .. })));
    assert_eq!(records, whole);
}
