//! Tests that files with absurd claimed lengths make the reader allocate next to nothing, and
//! never more than the limit for a chunk.

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use mcap::MAGIC;
use mcap::records::op;
use recording::{MAX_CHUNK_BYTES, Recording};

/// The system's allocator, recording the largest request of each thread: other tests run at the
/// same time.
struct Noting;

thread_local! {
    static LARGEST: Cell<usize> = const { Cell::new(0) };
}

fn note(size: usize) {
    LARGEST.set(LARGEST.get().max(size));
}

// SAFETY: every call is passed on to the system's allocator unchanged.
unsafe impl GlobalAlloc for Noting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        note(layout.size());
        // SAFETY: the caller upholds the contract, which is the same.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(pointer, layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        note(size);
        // SAFETY: as above.
        unsafe { System.realloc(pointer, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Noting = Noting;

fn record(opcode: u8, claimed: u64, body: &[u8]) -> Vec<u8> {
    [&[opcode][..], &claimed.to_le_bytes(), body].concat()
}

fn whole(opcode: u8, body: &[u8]) -> Vec<u8> {
    record(opcode, body.len() as u64, body)
}

fn chunk(claimed: u64, checksum: u32, packing: &str, packed: &[u8]) -> Vec<u8> {
    let body = [
        &[0; 16][..],
        &claimed.to_le_bytes(),
        &checksum.to_le_bytes(),
        &(packing.len() as u32).to_le_bytes(),
        packing.as_bytes(),
        &(packed.len() as u64).to_le_bytes(),
        packed,
    ];
    whole(op::CHUNK, &body.concat())
}

/// Largest request while a file with this record is opened and read; asserts that it is damaged.
fn largest(record: &[u8]) -> usize {
    let header = whole(op::HEADER, &[0; 8]);
    let file = [MAGIC, &header, record].concat();
    LARGEST.set(0);
    let recording = Recording::from_bytes("r.mcap", file).expect("it starts as one");
    let damage = recording.records().last();
    assert!(matches!(damage, Some(Err(_))), "{damage:?}");
    LARGEST.get()
}

#[test]
fn claims_reserve_nothing_that_is_not_there() {
    // Room for the small file itself, the decompressors and the error's text.
    const LITTLE: usize = 1 << 20;
    const HUGE: [u8; 4] = u32::MAX.to_le_bytes();
    let noted = largest(&whole(op::MESSAGE, &vec![0; 2 * LITTLE]));
    assert!(noted >= 2 * LITTLE, "the note works: {noted}");

    for claimed in [4 << 30, MAX_CHUNK_BYTES, u64::MAX] {
        for opcode in [
            op::SCHEMA,
            op::MESSAGE,
            op::CHUNK,
            op::ATTACHMENT,
            op::FOOTER,
            0x80,
        ] {
            let noted = largest(&record(opcode, claimed, b"..."));
            assert!(noted < LITTLE, "{opcode}, {claimed}: {noted}");
        }
    }
    let name = [&[1, 0][..], &HUGE].concat();
    let topic = [&[1, 0, 0, 0][..], &HUGE].concat();
    let metadata = [&[1, 0, 0, 0][..], &[0; 8], &HUGE].concat();
    let packing = [&[0; 28][..], &HUGE, &[0; 8]].concat();
    for (opcode, body) in [
        (op::SCHEMA, name),
        (op::CHANNEL, topic),
        (op::CHANNEL, metadata),
        (op::CHUNK, packing),
    ] {
        let noted = largest(&whole(opcode, &body));
        assert!(noted < LITTLE, "{opcode}, {body:?}: {noted}");
    }
    for packing in ["", "zstd", "lz4"] {
        for checksum in [0, 1] {
            let absurd = largest(&chunk(MAX_CHUNK_BYTES + 1, checksum, packing, b"..."));
            assert!(absurd < LITTLE, "{packing}: {absurd}");
            // A claim within the limit is trusted, but no more than that.
            let claimed = 8 * LITTLE;
            let noted = largest(&chunk(claimed as u64, checksum, packing, b"..."));
            assert!(noted <= claimed, "{packing}: {noted}");
        }
    }
}
