//! Services by which other nodes read and set the parameters.

use ros::Time;
use ros::rcl_interfaces::{
    DescribeParameters, DescribeParametersResponse, GetParameterTypes, GetParameterTypesResponse,
    GetParameters, GetParametersResponse, ListParameters, ListParametersResponse, Parameter,
    ParameterEvent, SetParameters, SetParametersAtomically, SetParametersAtomicallyResponse,
    SetParametersResponse,
};
use transport::{Graph, TransportError, wall_ns};
use zenoh_session::Report;

use super::parameters::Parameters;
use crate::GatewayError;
use crate::rmw::{Member, Publisher, Service};

/// Number of events kept for slow subscribers; the same as in ROS.
const EVENTS: usize = 1000;

/// Parameter services of a node of ROS.
pub(super) struct ParameterServices {
    describe: Service<DescribeParameters>,
    get: Service<GetParameters>,
    types: Service<GetParameterTypes>,
    list: Service<ListParameters>,
    set: Service<SetParameters>,
    set_all: Service<SetParametersAtomically>,
    events: Publisher<ParameterEvent>,
    /// Full name of the node.
    node: String,
}

impl ParameterServices {
    /// Opens the services of the node with this full name.
    pub(super) fn open(
        graph: &Graph,
        member: &Member,
        node: &str,
        events: &str,
    ) -> Result<Self, GatewayError> {
        let name = |service: &str| format!("{node}/{service}");
        Ok(ParameterServices {
            describe: Service::open(graph, member, &name("describe_parameters"))?,
            get: Service::open(graph, member, &name("get_parameters"))?,
            types: Service::open(graph, member, &name("get_parameter_types"))?,
            list: Service::open(graph, member, &name("list_parameters"))?,
            set: Service::open(graph, member, &name("set_parameters"))?,
            set_all: Service::open(graph, member, &name("set_parameters_atomically"))?,
            events: Publisher::open_blocking(member, events, EVENTS)?,
            node: node.to_owned(),
        })
    }

    /// Answers queued requests.
    pub(super) fn serve(
        &mut self,
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
        // All parameters that one call has set are one event.
        let mut changes: Vec<Vec<Parameter>> = Vec::new();
        self.set.serve(report, |request| {
            let mut changed = Vec::new();
            let mut set = |parameter: Parameter| {
                let result = parameters.set(&parameter.name, &parameter.value);
                if result.successful {
                    changed.push(parameters.named(parameter.name));
                }
                result
            };
            let results = request.parameters.into_iter().map(&mut set).collect();
            changes.push(changed);
            SetParametersResponse { results }
        })?;
        self.set_all.serve(report, |request| {
            let values = request.parameters.iter();
            let values = values.map(|parameter| (&*parameter.name, &parameter.value));
            let result = parameters.set_all(values);
            if result.successful {
                let names = request
                    .parameters
                    .into_iter()
                    .map(|parameter| parameter.name);
                changes.push(names.map(|name| parameters.named(name)).collect());
            }
            SetParametersAtomicallyResponse { result }
        })?;
        for changed in changes.into_iter().filter(|changed| !changed.is_empty()) {
            self.tell(changed, report)?;
        }
        Ok(())
    }

    /// Publishes the parameters that were set, even to the value they had, like ROS.
    fn tell(
        &mut self,
        changed_parameters: Vec<Parameter>,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        let sent = self.events.send(&ParameterEvent {
            stamp: Time::from_ns(wall_ns()).unwrap_or_default(),
            node: self.node.clone(),
            changed_parameters,
            ..ParameterEvent::default()
        });
        report.outcome(sent)
    }
}
