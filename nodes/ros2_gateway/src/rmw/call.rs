//! A call of a service, from the bytes of the request to those of the response.

use ros::RosService;

use crate::GatewayError;

/// Largest size of a request, bytes: names and values of some hundred parameters.
pub(super) const MAX_BYTES: usize = 64 << 10;

/// Returns the response to a request, both in CDR with its header.
pub(super) fn answer<S: RosService>(
    topic: &str,
    request: &[u8],
    respond: impl FnOnce(S::Request) -> S::Response,
) -> Result<Vec<u8>, GatewayError> {
    let (found, most) = (request.len(), MAX_BYTES);
    if found > most {
        let topic = topic.to_owned();
        return Err(GatewayError::TooLong { topic, found, most });
    }
    let request = ros::cdr::decode(request).map_err(GatewayError::decoding(topic))?;
    ros::cdr::encode(&respond(request)).map_err(GatewayError::encoding(topic))
}
