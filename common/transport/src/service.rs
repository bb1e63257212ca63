//! A topic in iceoryx2, with the quality of service of the [`Topic`]: a service for samples and one
//! for wake-ups.

use iceoryx2::node::Node;
use iceoryx2::port::listener::{Listener, ListenerCreateError};
use iceoryx2::port::notifier::{Notifier, NotifierCreateError};
use iceoryx2::prelude::{MessagingPattern, Service as _, ServiceName, ipc};
use iceoryx2::service::builder::publish_subscribe::{
    PublishSubscribeOpenError as OpenError, PublishSubscribeOpenOrCreateError as OpenOrCreateError,
};
use iceoryx2::service::port_factory::{event, publish_subscribe};
use messages::Topic;

use crate::TransportError;
use crate::header::Header;

/// Largest number of samples of one publisher that a subscriber may hold at the same time: the
/// current map, the one before, the newest received and the next.
pub(crate) const MAX_BORROWED: usize = 4;
/// Largest number of samples that one publisher may loan at the same time.
pub(crate) const MAX_LOANED: usize = 2;

pub(crate) type Samples<T> = publish_subscribe::PortFactory<
    ipc::Service,
    [<T as Topic>::Item],
    Header<<T as Topic>::Header>,
>;

pub(crate) fn open_samples<T: Topic>(
    node: &Node<ipc::Service>,
) -> Result<Samples<T>, TransportError> {
    let name = service_name::<T>()?;
    node.service_builder(&name)
        .publish_subscribe::<[T::Item]>()
        .user_header::<Header<T::Header>>()
        .history_size(T::HISTORY)
        .subscriber_max_buffer_size(T::DEPTH)
        .subscriber_max_borrowed_samples(MAX_BORROWED)
        .max_publishers(T::MAX_PUBLISHERS)
        .max_subscribers(T::MAX_SUBSCRIBERS)
        .max_nodes(max_nodes::<T>())
        .enable_safe_overflow(true)
        .open_or_create()
        .map_err(|error| match error {
            OpenOrCreateError::PublishSubscribeOpenError(OpenError::IncompatibleTypes) => {
                type_mismatch::<T>(node, &name)
            }
            other => failed::<T>("open", &other),
        })
}

pub(crate) fn open_wakeups<T: Topic>(
    node: &Node<ipc::Service>,
) -> Result<event::PortFactory<ipc::Service>, TransportError> {
    node.service_builder(&service_name::<T>()?)
        .event()
        .max_notifiers(T::MAX_PUBLISHERS)
        .max_listeners(T::MAX_SUBSCRIBERS)
        .max_nodes(max_nodes::<T>())
        .event_id_max_value(1)
        .open_or_create()
        .map_err(|error| failed::<T>("open", &error))
}

pub(crate) fn notifier<T: Topic>(
    node: &Node<ipc::Service>,
) -> Result<Notifier<ipc::Service>, TransportError> {
    open_wakeups::<T>(node)?
        .notifier_builder()
        .create()
        .map_err(|error| match error {
            NotifierCreateError::ExceedsMaxSupportedNotifiers => {
                too_many::<T>("publishers", T::MAX_PUBLISHERS)
            }
            other => failed::<T>("create the wake-up sender of", &other),
        })
}

pub(crate) fn listener<T: Topic>(
    node: &Node<ipc::Service>,
) -> Result<Listener<ipc::Service>, TransportError> {
    open_wakeups::<T>(node)?
        .listener_builder()
        .create()
        .map_err(|error| match error {
            ListenerCreateError::ExceedsMaxSupportedListeners => {
                too_many::<T>("subscribers", T::MAX_SUBSCRIBERS)
            }
            other => failed::<T>("create the wake-up receiver of", &other),
        })
}

pub(crate) fn too_many<T: Topic>(ports: &'static str, limit: usize) -> TransportError {
    let topic = T::NAME;
    TransportError::TooMany {
        topic,
        ports,
        limit,
    }
}

pub(crate) fn failed<T: Topic>(
    action: &'static str,
    error: &dyn std::fmt::Debug,
) -> TransportError {
    TransportError::Topic {
        topic: T::NAME,
        action,
        reason: format!("{error:?}"),
    }
}

/// Largest number of nodes, including one that is dead and not yet cleaned up.
fn max_nodes<T: Topic>() -> usize {
    T::MAX_PUBLISHERS + T::MAX_SUBSCRIBERS + 1
}

fn service_name<T: Topic>() -> Result<ServiceName, TransportError> {
    ServiceName::new(T::NAME).map_err(|error| failed::<T>("open", &error))
}

fn type_mismatch<T: Topic>(node: &Node<ipc::Service>, name: &ServiceName) -> TransportError {
    // SAFETY: the names are only printed.
    let expected = unsafe {
        use iceoryx2::prelude::ZeroCopySend;
        describe(
            <T::Header as ZeroCopySend>::type_name(),
            size_of::<T::Header>(),
            <T::Item as ZeroCopySend>::type_name(),
            size_of::<T::Item>(),
        )
    };
    let details = ipc::Service::details(name, node.config(), MessagingPattern::PublishSubscribe);
    let found = match details {
        Ok(Some(details)) => {
            let types = details
                .static_details
                .publish_subscribe()
                .message_type_details();
            describe(
                &types.user_header.type_name().to_string(),
                types.user_header.size(),
                &types.payload.type_name().to_string(),
                types.payload.size(),
            )
        }
        _ => "other types".into(),
    };
    TransportError::TypeMismatch {
        topic: T::NAME,
        expected,
        found,
    }
}

fn describe(header: &str, header_bytes: usize, item: &str, item_bytes: usize) -> String {
    format!("{header} ({header_bytes} bytes) with [{item}] ({item_bytes} bytes each)")
}
