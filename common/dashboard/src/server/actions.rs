//! Write actions; all need the token.

use std::f64::consts::TAU;
use std::future::{Ready, ready};
use std::sync::Arc;

use axum::Json;
use axum::extract::rejection::JsonRejection;
use axum::extract::{FromRequestParts, Path};
use axum::http::StatusCode;
use axum::http::request::Parts;
use engine::limits::Region;
use messages::Pose2;
use serde::Deserialize;

use super::gate::authorize;
use super::{Refusal, Site};
use crate::robot::Request;
use crate::view::Recording;

/// Largest coordinate of a hint, metres: no map reaches further from its origin.
const MAX_M: f64 = 1e6;

/// Body of a request that sets the search region.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Wanted {
    /// In metres in the map: two opposite corners of a rectangle, or all corners of a polygon.
    corners: Vec<[f64; 2]>,
}

type Outcome = Result<StatusCode, Refusal>;

/// The site, for a request that carries the token.
pub(super) struct Allowed(Arc<Site>);

impl FromRequestParts<Arc<Site>> for Allowed {
    type Rejection = Refusal;

    async fn from_request_parts(parts: &mut Parts, site: &Arc<Site>) -> Result<Self, Refusal> {
        authorize(site, &parts.headers)?;
        Ok(Allowed(Arc::clone(site)))
    }
}

impl From<JsonRejection> for Refusal {
    fn from(rejection: JsonRejection) -> Self {
        Refusal::new(rejection.status(), rejection.body_text())
    }
}

pub(super) fn plain(wanted: Request) -> impl Fn(Allowed, Path<String>) -> Ready<Outcome> + Clone {
    move |Allowed(site), Path(name)| ready(request(&site, &name, wanted.clone()))
}

pub(super) async fn search_in(
    Allowed(site): Allowed,
    Path(name): Path<String>,
    wanted: Result<Json<Wanted>, JsonRejection>,
) -> Outcome {
    let Json(Wanted { corners }) = wanted?;
    Region::new(&corners)
        .map_err(|problem| Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, problem))?;
    request(&site, &name, Request::Region(corners))
}

/// Body of a request that says where the robot's base is.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Here {
    /// In metres in the map.
    x: f64,
    y: f64,
    /// Radians counter-clockwise from the map's x axis.
    yaw: f64,
}

pub(super) async fn hint(
    Allowed(site): Allowed,
    Path(name): Path<String>,
    here: Result<Json<Here>, JsonRejection>,
) -> Outcome {
    let Json(Here { x, y, yaw }) = here?;
    if [x, y].iter().any(|metres| metres.abs() > MAX_M) || yaw.abs() > TAU {
        let problem = format!("x and y are within ±{MAX_M} m, yaw within ±2π radians");
        return Err(Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, problem));
    }
    request(&site, &name, Request::Hint(Pose2 { x, y, yaw }))
}

pub(super) async fn restart(
    Allowed(site): Allowed,
    Path((name, node)): Path<(String, String)>,
) -> Outcome {
    if !site.robot(&name)?.has_node(&node) {
        let problem = format!("no node {node:?} has reported");
        return Err(Refusal::new(StatusCode::NOT_FOUND, problem));
    }
    request(&site, &name, Request::Restart(node))
}

fn request(site: &Site, name: &str, request: Request) -> Outcome {
    let robot = site.robot(name)?;
    let can = robot.abilities();
    let recording = robot.recording();
    let (able, who) = match request {
        Request::Region(_) => (can.region, "no accumulator accepts a region"),
        Request::Save => (
            can.save,
            "no recorder keeps the last minutes: backcast run --record FILE --keep 10m",
        ),
        Request::Hint(_) => (can.hint, "no tracker accepts a hint"),
        Request::Restart(_) => (can.restart, "no launcher is there: backcast restart NODE"),
        Request::Record(on) => match &recording {
            None => (false, "no launcher is there: backcast run --record FILE"),
            Some(now) if !on => (now.file.is_some(), "nothing is being recorded"),
            Some(Recording { file: Some(_), .. }) => (false, "a recording runs already"),
            Some(now) => (now.refused.is_none(), now.refused.as_deref().unwrap_or("")),
        },
    };
    if !able {
        return Err(Refusal::new(StatusCode::CONFLICT, who));
    }
    if !robot.request(request) {
        let problem = "the graph is still busy with an earlier request";
        return Err(Refusal::new(StatusCode::SERVICE_UNAVAILABLE, problem));
    }
    Ok(StatusCode::ACCEPTED)
}
