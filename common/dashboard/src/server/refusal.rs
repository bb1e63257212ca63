//! Error responses, as JSON with the reason.

use axum::Json;
use axum::http::{StatusCode, Uri};
use axum::response::{IntoResponse, Response};
use serde_json::json;

#[derive(Debug)]
pub(super) struct Refusal {
    pub(super) status: StatusCode,
    problem: String,
}

impl Refusal {
    pub(super) fn new(status: StatusCode, problem: impl Into<String>) -> Self {
        Refusal {
            status,
            problem: problem.into(),
        }
    }

    pub(super) fn unknown_robot(name: &str, names: &[String]) -> Self {
        let problem = match names {
            [] => format!("there is no robot {name:?}, and no other"),
            _ => format!("there is no robot {name:?}; there is {}", names.join(", ")),
        };
        Refusal::new(StatusCode::NOT_FOUND, problem)
    }
}

impl IntoResponse for Refusal {
    fn into_response(self) -> Response {
        (
            self.status,
            Json(json!({ "schema": command_line::json::SCHEMA, "error": self.problem })),
        )
            .into_response()
    }
}

pub(super) async fn nothing_here(uri: Uri) -> Refusal {
    Refusal::new(
        StatusCode::NOT_FOUND,
        format!("there is nothing at {}", uri.path()),
    )
}
