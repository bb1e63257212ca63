//! The service that says what types are made of. Each node of ROS has it; who finds it and gets
//! an answer looks elsewhere at once, and who finds none waits.

use ros::type_description_interfaces::{GetTypeDescription, GetTypeDescriptionResponse};
use transport::{Graph, TransportError};
use zenoh_session::Report;

use crate::GatewayError;
use crate::rmw::{Member, Service};

/// Answers that nothing is known of a type but its hash.
pub(super) struct TypeDescriptions(Service<GetTypeDescription>);

impl TypeDescriptions {
    /// Of the node with this whole name.
    pub(super) fn open(graph: &Graph, member: &Member, node: &str) -> Result<Self, GatewayError> {
        let name = format!("{node}/get_type_description");
        Ok(TypeDescriptions(Service::open(graph, member, &name)?))
    }

    /// Answers who asks.
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
