//! Any stream of CoLa, in either encoding: nothing panics, and every telegram that is read can be
//! written and read back unchanged.
#![no_main]

use libfuzzer_sys::fuzz_target;
use sick::cola::{Encoding, Framer, Telegram};

fuzz_target!(|stream: &[u8]| {
    for encoding in [Encoding::Text, Encoding::Binary] {
        let mut framer = Framer::new(encoding);
        let mut written = Vec::new();
        for piece in stream.chunks(97) {
            framer.push(piece);
            while let Some(next) = framer.next_frame() {
                let Ok(frame) = next else { continue };
                written.clear();
                frame.telegram.write(encoding, &mut written);
                let again = Telegram::read(encoding, &written);
                assert_eq!(again.as_ref(), Ok(&frame.telegram));
            }
        }
        framer.finish();
        while framer.next_frame().is_some() {}
    }
});
