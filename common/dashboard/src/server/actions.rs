//! Write actions; all need the token.

use std::f64::consts::TAU;
use std::sync::Arc;

use axum::Json;
use axum::extract::rejection::JsonRejection;
use axum::extract::{Path, State};
use axum::http::{HeaderMap, StatusCode};
use engine::limits::Region;
use messages::Pose2;
use serde::Deserialize;

use super::gate::authorize;
use super::{Refusal, Site};
use crate::robot::Request;
use crate::view::{Abilities, Recording};

/// Largest coordinate of a hint, metres: no map reaches further from its origin.
const MAX_M: f64 = 1e6;

/// Body of a request that sets the search region.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Wanted {
    /// In metres in the map: two opposite corners of a rectangle, or all corners of a polygon.
    corners: Vec<[f64; 2]>,
}

/// Limits the search to a region.
pub(super) async fn search_in(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
    wanted: Result<Json<Wanted>, JsonRejection>,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    let Json(Wanted { corners }) =
        wanted.map_err(|error| Refusal::new(error.status(), error.body_text()))?;
    Region::new(&corners)
        .map_err(|problem| Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, problem))?;
    request(&site, &name, Request::Region(corners))
}

/// Searches the whole map again.
pub(super) async fn search_everywhere(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    request(&site, &name, Request::Region(Vec::new()))
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

/// Tells the tracker where the robot probably is.
pub(super) async fn hint(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
    here: Result<Json<Here>, JsonRejection>,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    let Json(Here { x, y, yaw }) =
        here.map_err(|error| Refusal::new(error.status(), error.body_text()))?;
    if [x, y].iter().any(|metres| metres.abs() > MAX_M) || yaw.abs() > TAU {
        let problem = format!("x and y are within ±{MAX_M} m, yaw within ±2π radians");
        return Err(Refusal::new(StatusCode::UNPROCESSABLE_ENTITY, problem));
    }
    request(&site, &name, Request::Hint(Pose2 { x, y, yaw }))
}

/// Has the launcher restart a node.
pub(super) async fn restart(
    State(site): State<Arc<Site>>,
    Path((name, node)): Path<(String, String)>,
    headers: HeaderMap,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    if !site.robot(&name)?.has_node(&node) {
        let problem = format!("no node {node:?} has reported");
        return Err(Refusal::new(StatusCode::NOT_FOUND, problem));
    }
    request(&site, &name, Request::Restart(node))
}

/// Has the launcher start a recording.
pub(super) async fn start_recording(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    request(&site, &name, Request::Record(true))
}

/// Has the launcher stop the recording.
pub(super) async fn stop_recording(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    request(&site, &name, Request::Record(false))
}

/// Makes the recorder save the last minutes.
pub(super) async fn save(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Result<StatusCode, Refusal> {
    authorize(&site, &headers)?;
    request(&site, &name, Request::Save)
}

fn request(site: &Site, name: &str, request: Request) -> Result<StatusCode, Refusal> {
    let robot = site.robot(name)?;
    let Abilities {
        region,
        save,
        hint,
        restart,
    } = robot.abilities();
    let recording = robot.recording();
    let (able, who) = match request {
        Request::Region(_) => (region, "no accumulator accepts a region"),
        Request::Save => (
            save,
            "no recorder keeps the last minutes: backcast run --record FILE --keep 10m",
        ),
        Request::Hint(_) => (hint, "no tracker accepts a hint"),
        Request::Restart(_) => (restart, "no launcher is there: backcast restart NODE"),
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
