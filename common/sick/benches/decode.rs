//! Benchmarks of the parsers: bytes in, every reading out. The buffers are reused, so nothing is
//! allocated after the first round.

use std::hint::black_box;

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use sick::cola::{Encoding, Framer, Telegram};
use sick::lms2xx::{Answer, Reply, ReplyFramer, Scan, Status, Unit};

/// Sixteen scans of a TiM781.
const CAPTURE: &[u8] = include_bytes!("../tests/data/tim781_colab_telegrams.bin");
/// Typical size of one read from a socket, bytes.
const PIECE: usize = 1 << 14;

/// Parses a stream of scans and returns the sum of all readings.
fn read_cola(framer: &mut Framer, stream: &[u8]) -> u64 {
    let mut sum = 0;
    for piece in stream.chunks(PIECE) {
        framer.push(piece);
        while let Some(Ok(frame)) = framer.next_frame() {
            if let Telegram::ScanData(scan) = frame.telegram {
                let channels = scan.channels_16_bit;
                sum += channels
                    .flat_map(|channel| channel.values)
                    .map(u64::from)
                    .sum::<u64>();
            }
        }
    }
    sum
}

fn read_lms2xx(framer: &mut ReplyFramer, stream: &[u8]) -> u64 {
    let mut sum = 0;
    for piece in stream.chunks(PIECE) {
        framer.push(piece);
        while let Some(Ok(frame)) = framer.next_frame() {
            if let Reply::Answer(Answer::Scan(scan), _) = frame.telegram {
                sum += scan.readings.map(u64::from).sum::<u64>();
            }
        }
    }
    sum
}

/// Returns the captured scans re-encoded as CoLa A.
fn as_text() -> Vec<u8> {
    let mut text = Vec::new();
    let mut framer = Framer::new(Encoding::Binary);
    framer.push(CAPTURE);
    while let Some(Ok(frame)) = framer.next_frame() {
        Encoding::Text.frame(&frame.telegram, &mut text);
    }
    text
}

/// Sixteen scans of 361 readings.
fn lms2xx_stream() -> Vec<u8> {
    let readings: Vec<u16> = (0..361).map(|beam| 100 + 13 * beam).collect();
    let scan = Scan::new(Unit::Centimetre, &readings);
    let mut stream = Vec::new();
    for _ in 0..16 {
        Reply::Answer(Answer::Scan(scan), Status(0x10)).frame(&mut stream);
    }
    stream
}

fn decode(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("decode");
    for (name, encoding, stream) in [
        ("cola_b", Encoding::Binary, CAPTURE.to_vec()),
        ("cola_a", Encoding::Text, as_text()),
    ] {
        group.throughput(Throughput::Bytes(stream.len() as u64));
        let mut framer = Framer::new(encoding);
        group.bench_function(name, |bencher| {
            bencher.iter(|| black_box(read_cola(&mut framer, black_box(&stream))));
        });
    }
    let stream = lms2xx_stream();
    group.throughput(Throughput::Bytes(stream.len() as u64));
    let mut framer = ReplyFramer::default();
    group.bench_function("lms2xx", |bencher| {
        bencher.iter(|| black_box(read_lms2xx(&mut framer, black_box(&stream))));
    });
    group.finish();
}

criterion_group!(benches, decode);
criterion_main!(benches);
