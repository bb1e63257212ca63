//! A sample between loan and send, filled where its subscribers will read it. If shared memory is
//! full, it is in private memory, and is lost and counted.

use iceoryx2::prelude::ipc;
use iceoryx2::sample_mut::SampleMut;
use messages::Topic;

use crate::header::Header;
use crate::{Publisher, TransportError, service, space};

/// Upper bound on the bytes of iceoryx2's header and padding.
const OVERHEAD: usize = 256;

type SharedSample<T> = SampleMut<ipc::Service, [<T as Topic>::Item], Header<<T as Topic>::Header>>;

/// A sample being filled; dropping it returns the memory without sending.
#[derive(Debug)]
pub struct Loan<'p, T: Topic> {
    place: Place<T>,
    publisher: &'p Publisher<T>,
}

#[derive(Debug)]
enum Place<T: Topic> {
    Shared(SharedSample<T>),
    /// Private memory, because shared memory is full; `full` is the error.
    Private {
        header: T::Header,
        items: Vec<T::Item>,
        full: TransportError,
    },
}

impl<'p, T: Topic> Loan<'p, T> {
    pub(crate) fn of(publisher: &'p Publisher<T>, items: usize) -> Result<Self, TransportError> {
        let place = match space::ensure_free(T::NAME, sample_bytes::<T>(items)?) {
            Ok(()) => Place::Shared(shared(publisher, items)?),
            // The loss of a latched sample must not go unnoticed, so its publisher gets the error.
            Err(full @ TransportError::SharedMemoryFull { .. }) if !T::LATCHED => {
                // A size beyond private memory is an error, as in shared memory.
                let mut private = Vec::new();
                if private.try_reserve_exact(items).is_err() {
                    return Err(full);
                }
                private.resize(items, bytemuck::Zeroable::zeroed());
                Place::Private {
                    header: bytemuck::Zeroable::zeroed(),
                    items: private,
                    full,
                }
            }
            Err(error) => return Err(error),
        };
        Ok(Loan { place, publisher })
    }

    /// Header, initially zero.
    pub fn header_mut(&mut self) -> &mut T::Header {
        match &mut self.place {
            Place::Shared(sample) => &mut sample.user_header_mut().0,
            Place::Private { header, .. } => header,
        }
    }

    /// Items, initially zero.
    pub fn items_mut(&mut self) -> &mut [T::Item] {
        match &mut self.place {
            Place::Shared(sample) => sample.payload_mut(),
            Place::Private { items, .. } => items,
        }
    }

    /// Sends the sample to every subscriber; if shared memory is full, it is lost and counted.
    pub fn send(self) -> Result<(), TransportError> {
        let address = self.address();
        match self.place {
            Place::Shared(sample) => {
                let sent = sample.send();
                sent.map_err(|error| service::failed::<T>("send on", &error))?;
                self.publisher.sent(address)
            }
            Place::Private { full, .. } => {
                self.publisher.lost(&full);
                Ok(())
            }
        }
    }

    pub(crate) fn address(&self) -> usize {
        match &self.place {
            Place::Shared(sample) => std::ptr::from_ref(sample.user_header()).addr(),
            Place::Private { header, .. } => std::ptr::from_ref(header).addr(),
        }
    }
}

fn shared<T: Topic>(
    publisher: &Publisher<T>,
    items: usize,
) -> Result<SharedSample<T>, TransportError> {
    let loan = publisher.port().loan_slice_uninit(items);
    let sample = loan.map_err(|error| TransportError::Loan {
        topic: T::NAME,
        items,
        reason: format!("{error:?}"),
    })?;
    Ok(sample.write_from_fn(|_| bytemuck::Zeroable::zeroed()))
}

/// Returns an upper bound on the bytes of a sample, which iceoryx2 rounds up to a power of two.
fn sample_bytes<T: Topic>(items: usize) -> Result<u64, TransportError> {
    size_of::<T::Item>()
        .checked_mul(items)
        .and_then(|bytes| bytes.checked_add(size_of::<T::Header>() + OVERHEAD))
        .filter(|bytes| bytes.checked_next_power_of_two().is_some())
        .and_then(|bytes| u64::try_from(bytes).ok())
        .ok_or(TransportError::TooLarge {
            topic: T::NAME,
            items,
            item_bytes: size_of::<T::Item>(),
        })
}

#[cfg(test)]
mod tests {
    use super::*;
    use messages::topic;

    #[test]
    fn sizes_are_counted_or_refused_but_never_wrap() {
        let scan = |items| sample_bytes::<topic::Scan>(items);
        assert_eq!(scan(0).unwrap(), 392 + 256);
        assert_eq!(scan(361).unwrap(), 361 * 4 + 392 + 256);
        for items in [usize::MAX, usize::MAX / 4, usize::MAX / 8] {
            let error = scan(items).unwrap_err();
            assert!(matches!(error, TransportError::TooLarge { items: i, .. } if i == items));
        }
    }
}
