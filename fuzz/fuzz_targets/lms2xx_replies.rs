//! Any LMS2xx stream from a device: nothing panics, and every telegram that is read can be written
//! and read back unchanged.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sick::lms2xx::ReplyFramer;

fuzz_target!(|stream: &[u8]| {
    let mut framer = ReplyFramer::default();
    let mut written = Vec::new();
    for piece in stream.chunks(97) {
        framer.push(piece);
        while let Some(next) = framer.next_frame() {
            let Ok(frame) = next else { continue };
            written.clear();
            frame.telegram.frame(&mut written);
            let mut second = ReplyFramer::default();
            second.push(&written);
            let again = second.next_frame().and_then(Result::ok);
            assert!(again.is_some_and(|again| again.telegram == frame.telegram));
        }
    }
    framer.finish();
    while framer.next_frame().is_some() {}
});
