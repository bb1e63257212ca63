//! Read requests that are answered at once.

use std::sync::Arc;

use axum::Json;
use axum::extract::{Path, State};
use axum::http::header::{
    ACCEPT_ENCODING, CACHE_CONTROL, CONTENT_ENCODING, CONTENT_TYPE, ETAG, IF_NONE_MATCH, VARY,
};
use axum::http::{HeaderMap, StatusCode};
use axum::response::{IntoResponse, Response};
use serde_json::{Value, json};

use super::{Refusal, Site};

pub(super) async fn robots(State(site): State<Arc<Site>>) -> Json<Value> {
    Json(json!({
        "schema": command_line::json::SCHEMA,
        "version": env!("CARGO_PKG_VERSION"),
        "robots": site.robots.names(),
    }))
}

pub(super) async fn robot(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
) -> Result<Response, Refusal> {
    let snapshot = site.robot(&name)?.snapshot(transport::monotonic_ns());
    let headers = [
        (CONTENT_TYPE, "application/json"),
        (CACHE_CONTROL, "no-store"),
    ];
    Ok((headers, snapshot.to_string()).into_response())
}

/// Cells of the robot's map, gzip-compressed if the client accepts it.
pub(super) async fn map(
    State(site): State<Arc<Site>>,
    Path(name): Path<String>,
    headers: HeaderMap,
) -> Result<Response, Refusal> {
    let map = site.robot(&name)?.map();
    let Some(map) = map else {
        return Err(Refusal::new(StatusCode::NOT_FOUND, "there is no map yet"));
    };
    let etag = format!("\"{}\"", map.info.map_id);
    let is_known = headers
        .get(IF_NONE_MATCH)
        .is_some_and(|known| known.as_bytes() == etag.as_bytes());
    let described = [
        (CONTENT_TYPE, "application/octet-stream".to_owned()),
        (CACHE_CONTROL, "no-cache".to_owned()),
        (ETAG, etag),
        (VARY, "accept-encoding".to_owned()),
    ];
    if is_known {
        return Ok((StatusCode::NOT_MODIFIED, described).into_response());
    }
    let accepted = headers.get(ACCEPT_ENCODING).and_then(|v| v.to_str().ok());
    if !accepted.is_some_and(|accepted| accepted.contains("gzip")) {
        return Ok((described, map.cells().to_vec()).into_response());
    }
    // A large map takes a tenth of a second; other requests are served meanwhile.
    let packed = tokio::task::spawn_blocking(move || map.packed().to_vec()).await;
    let packed = packed
        .map_err(|_| Refusal::new(StatusCode::INTERNAL_SERVER_ERROR, "packing the map failed"))?;
    Ok((described, [(CONTENT_ENCODING, "gzip")], packed).into_response())
}
