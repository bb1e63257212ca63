//! Services that each node of ROS has: those by which others read and set the parameters, and the
//! one that describes message types, which answers each request with a failure.

use ros::Time;
use ros::rcl_interfaces::{
    DescribeParameters, DescribeParametersResponse, GetParameterTypes, GetParameterTypesResponse,
    GetParameters, GetParametersResponse, ListParameters, ListParametersResponse, Parameter,
    ParameterEvent, SetParameters, SetParametersAtomically, SetParametersAtomicallyResponse,
    SetParametersResponse,
};
use ros::type_description_interfaces::{GetTypeDescription, GetTypeDescriptionResponse};
use transport::{TransportError, wall_ns};
use zenoh_session::Report;

use super::parameters::Parameters;
use crate::GatewayError;
use crate::rmw::{Member, Publisher, Service};

/// Number of events kept for slow subscribers; the same as in ROS.
const EVENTS: usize = 1000;

pub(super) struct ParameterServices {
    describe: Service<DescribeParameters>,
    get: Service<GetParameters>,
    types: Service<GetParameterTypes>,
    list: Service<ListParameters>,
    set: Service<SetParameters>,
    set_all: Service<SetParametersAtomically>,
    /// A client that gets an answer looks elsewhere at once, and one that finds no service waits.
    descriptions: Service<GetTypeDescription>,
    events: Publisher<ParameterEvent>,
    /// Full name of the node.
    node: String,
}

impl ParameterServices {
    pub(super) fn open(member: &Member, node: &str, events: &str) -> Result<Self, GatewayError> {
        let name = |service: &str| format!("{node}/{service}");
        Ok(ParameterServices {
            describe: Service::open(member, &name("describe_parameters"))?,
            get: Service::open(member, &name("get_parameters"))?,
            types: Service::open(member, &name("get_parameter_types"))?,
            list: Service::open(member, &name("list_parameters"))?,
            set: Service::open(member, &name("set_parameters"))?,
            set_all: Service::open(member, &name("set_parameters_atomically"))?,
            descriptions: Service::open(member, &name("get_type_description"))?,
            events: Publisher::open_blocking(member, events, EVENTS)?,
            node: node.to_owned(),
        })
    }

    pub(super) fn serve(
        &mut self,
        parameters: &mut Parameters,
        report: &mut Report,
    ) -> Result<(), TransportError> {
        self.describe.serve(report, |request| {
            let descriptors = each(&request.names, |name| parameters.describe(name));
            DescribeParametersResponse { descriptors }
        })?;
        self.get.serve(report, |request| {
            let values = each(&request.names, |name| parameters.get(name));
            GetParametersResponse { values }
        })?;
        self.types.serve(report, |request| {
            let types = each(&request.names, |name| parameters.get(name).r#type);
            GetParameterTypesResponse { types }
        })?;
        self.descriptions
            .serve(report, |request| GetTypeDescriptionResponse {
                failure_reason: format!(
                    "this node describes no types: the package of {:?} has its definition",
                    request.type_name
                ),
                ..GetTypeDescriptionResponse::default()
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
                let set = request.parameters.into_iter();
                changes.push(set.map(|set| parameters.named(set.name)).collect());
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

fn each<T>(names: &[String], of: impl Fn(&str) -> T) -> Vec<T> {
    names.iter().map(|name| of(name)).collect()
}
