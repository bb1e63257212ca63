//! The services by which other nodes read and set the parameters.

use ros::rcl_interfaces::{
    DescribeParameters, DescribeParametersResponse, GetParameterTypes, GetParameterTypesResponse,
    GetParameters, GetParametersResponse, ListParameters, ListParametersResponse, SetParameters,
    SetParametersAtomically, SetParametersAtomicallyResponse, SetParametersResponse,
};
use transport::{Graph, TransportError};
use zenoh_session::Report;

use super::parameters::Parameters;
use crate::GatewayError;
use crate::rmw_zenoh::{Member, Service};

/// As each node of ROS has them.
pub(super) struct ParameterServices {
    describe: Service<DescribeParameters>,
    get: Service<GetParameters>,
    types: Service<GetParameterTypes>,
    list: Service<ListParameters>,
    set: Service<SetParameters>,
    set_all: Service<SetParametersAtomically>,
}

impl ParameterServices {
    /// Of the node with this whole name.
    pub(super) fn open(graph: &Graph, member: &Member, node: &str) -> Result<Self, GatewayError> {
        let name = |service: &str| format!("{node}/{service}");
        Ok(ParameterServices {
            describe: Service::open(graph, member, &name("describe_parameters"))?,
            get: Service::open(graph, member, &name("get_parameters"))?,
            types: Service::open(graph, member, &name("get_parameter_types"))?,
            list: Service::open(graph, member, &name("list_parameters"))?,
            set: Service::open(graph, member, &name("set_parameters"))?,
            set_all: Service::open(graph, member, &name("set_parameters_atomically"))?,
        })
    }

    /// Answers who asks.
    pub(super) fn serve(
        &self,
        parameters: &mut Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        self.describe
            .serve(report, |request| DescribeParametersResponse {
                descriptors: request
                    .names
                    .iter()
                    .map(|name| parameters.describe(name))
                    .collect(),
            })?;
        self.get.serve(report, |request| GetParametersResponse {
            values: request
                .names
                .iter()
                .map(|name| parameters.get(name))
                .collect(),
        })?;
        self.types
            .serve(report, |request| GetParameterTypesResponse {
                types: request
                    .names
                    .iter()
                    .map(|name| parameters.get(name).r#type)
                    .collect(),
            })?;
        self.list.serve(report, |request| ListParametersResponse {
            result: parameters.list(&request.prefixes, request.depth),
        })?;
        self.set.serve(report, |request| SetParametersResponse {
            results: request
                .parameters
                .iter()
                .map(|parameter| parameters.set(&parameter.name, &parameter.value))
                .collect(),
        })?;
        self.set_all.serve(report, |request| {
            let values = request.parameters.iter();
            let values = values.map(|parameter| (&*parameter.name, &parameter.value));
            SetParametersAtomicallyResponse {
                result: parameters.set_all(values),
            }
        })?;
        Ok(())
    }
}
