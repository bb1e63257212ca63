//! Any payload from the network, for each topic of the bridge: nothing panics, and an accepted
//! payload can be encoded again.
#![no_main]

use libfuzzer_sys::fuzz_target;
use messages::topic;
use network_payload::{Visit, Wire, decode, encode, encoding};

struct Check<'a>(&'a [u8]);

impl Visit for Check<'_> {
    type Output = ();

    fn visit<T: Wire>(self) {
        if let Ok(received) = decode::<T>(&encoding::<T>(), self.0) {
            encode::<T>(&received.preamble, &received.header, &received.items).unwrap();
        }
    }
}

fuzz_target!(|bytes: &[u8]| {
    if let Some((&which, payload)) = bytes.split_first() {
        let names = topic::NAMES;
        network_payload::by_name(names[usize::from(which) % names.len()], Check(payload));
    }
});
