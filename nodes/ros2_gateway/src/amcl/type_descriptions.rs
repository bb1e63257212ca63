//! Service that describes message types. Each node of ROS has it: a client that gets an answer
//! looks elsewhere at once, and one that finds no service waits.

use ros::type_description_interfaces::{GetTypeDescription, GetTypeDescriptionResponse};
use transport::{Graph, TransportError};
use zenoh_session::Report;

use crate::GatewayError;
use crate::rmw::{Member, Service};

/// Service that answers each request with a failure.
pub(super) struct TypeDescriptions(Service<GetTypeDescription>);

impl TypeDescriptions {
    /// Opens the service of the node with this full name.
    pub(super) fn open(graph: &Graph, member: &Member, node: &str) -> Result<Self, GatewayError> {
        let name = format!("{node}/get_type_description");
        Ok(TypeDescriptions(Service::open(graph, member, &name)?))
    }

    /// Answers queued requests.
    pub(super) fn serve(&self, report: &mut Report) -> Result<(), TransportError> {
        self.0.serve(report, |request| GetTypeDescriptionResponse {
            failure_reason: format!(
                "this node describes no types: the package of {:?} has its definition",
                request.type_name
            ),
            ..GetTypeDescriptionResponse::default()
        })?;
        Ok(())
    }
}
