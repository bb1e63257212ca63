//! The page, which is part of the executable.

use axum::extract::Path;
use axum::http::Uri;
use axum::http::header::{CACHE_CONTROL, CONTENT_TYPE};
use axum::response::{IntoResponse, Response};

use super::refusal::nothing_here;

const HTML: &str = "text/html; charset=utf-8";
const CSS: &str = "text/css; charset=utf-8";
const JS: &str = "text/javascript; charset=utf-8";
const SVG: &str = "image/svg+xml";

macro_rules! files {
    ($($name:literal: $kind:expr),+ $(,)?) => {
        /// Name, content type and content of each file.
        const FILES: &[(&str, &str, &str)] = &[
            $(($name, $kind, include_str!(concat!("../../page/", $name)))),+
        ];
    };
}

files! {
    "index.html": HTML,
    "style.css": CSS,
    "panel.css": CSS,
    "icon.svg": SVG,
    "actions.js": JS,
    "app.js": JS,
    "camera.js": JS,
    "colors.js": JS,
    "connection.js": JS,
    "dom.js": JS,
    "gestures.js": JS,
    "inspect.js": JS,
    "keys.js": JS,
    "map_images.js": JS,
    "map_view.js": JS,
    "marks.js": JS,
    "notify.js": JS,
    "panel.js": JS,
    "situation.js": JS,
    "state_card.js": JS,
    "store.js": JS,
    "timeline.js": JS,
    "what_to_check.js": JS,
    "words.js": JS,
}

pub(super) async fn index(uri: Uri) -> Response {
    file(Path("index.html".to_owned()), uri).await
}

pub(super) async fn file(Path(name): Path<String>, uri: Uri) -> Response {
    let Some((_, kind, content)) = FILES.iter().find(|(known, ..)| *known == name) else {
        return nothing_here(uri).await.into_response();
    };
    // A restart may bring another version.
    (
        [(CONTENT_TYPE, *kind), (CACHE_CONTROL, "no-cache")],
        *content,
    )
        .into_response()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A strict content security policy would block these, or they would allow injection.
    #[test]
    fn the_page_needs_nothing_that_its_policy_forbids() {
        for (name, _, content) in FILES {
            for forbidden in [
                "https://",
                "style=\"",
                "onclick=",
                "eval(",
                "innerHTML",
                "<style",
            ] {
                assert!(!content.contains(forbidden), "{name} has {forbidden}");
            }
            // Only the name of a format may look like a URL.
            let addresses = content.matches("http://").count();
            let formats = content.matches("http://www.w3.org/").count();
            assert_eq!(addresses, formats, "{name}");
        }
    }

    #[test]
    fn every_file_that_is_named_is_there() {
        let has = |name: &str| FILES.iter().any(|(known, ..)| *known == name);
        for (file, _, content) in FILES {
            let imports = content.split("from \"./").skip(1);
            let linked = content.split("=\"/").skip(1);
            for rest in imports.chain(linked) {
                let name = rest.split('"').next().unwrap();
                assert!(has(name), "{file} names {name}");
            }
        }
    }
}
