//! Access control: rejects requests that a browser makes for another site.
//!
//! A foreign page cannot read our responses, but it could open a WebSocket, or resolve its own name
//! to our address (DNS rebinding) and so count as our origin. The first shows in `Origin`, the
//! second in `Host`, which then holds a name that is not ours.

use std::net::{IpAddr, Ipv6Addr};
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::header::{
    AUTHORIZATION, CONTENT_SECURITY_POLICY, HOST, HeaderName, HeaderValue, ORIGIN, REFERRER_POLICY,
    X_CONTENT_TYPE_OPTIONS,
};
use axum::http::uri::Authority;
use axum::http::{HeaderMap, StatusCode};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

use super::{Refusal, Site};

/// The page may load and connect to its own origin only.
const POLICY: &str = "default-src 'none'; script-src 'self'; style-src 'self'; \
                      img-src 'self' blob:; connect-src 'self'; base-uri 'none'; \
                      form-action 'none'; frame-ancestors 'none'";

/// Checks a request, and adds the security headers to every response.
pub(super) async fn guard(State(site): State<Arc<Site>>, request: Request, next: Next) -> Response {
    let mut response = match admit(request.headers(), &site.hosts) {
        Ok(()) => next.run(request).await,
        Err(refusal) => refusal.into_response(),
    };
    let headers = response.headers_mut();
    let cross = HeaderName::from_static;
    for (name, value) in [
        (CONTENT_SECURITY_POLICY, POLICY),
        (X_CONTENT_TYPE_OPTIONS, "nosniff"),
        (REFERRER_POLICY, "no-referrer"),
        (cross("cross-origin-resource-policy"), "same-origin"),
        (cross("cross-origin-opener-policy"), "same-origin"),
    ] {
        headers.insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Accepts requests from our page or from programs other than browsers.
fn admit(headers: &HeaderMap, hosts: &[String]) -> Result<(), Refusal> {
    let text = |name: &HeaderName| headers.get(name).map(HeaderValue::to_str);
    let Some(Ok(host)) = text(&HOST) else {
        return Err(Refusal::new(StatusCode::BAD_REQUEST, "there is no host"));
    };
    if headers.get_all(HOST).iter().count() > 1 || !is_ours(host, hosts) {
        let problem = format!(
            "host {host:?} is not known here: allowed are addresses, localhost and what --host names"
        );
        return Err(Refusal::new(StatusCode::MISDIRECTED_REQUEST, problem));
    }
    if let Some(origin) = text(&ORIGIN) {
        let origin = origin.unwrap_or("null");
        let authority = origin
            .strip_prefix("http://")
            .or_else(|| origin.strip_prefix("https://"));
        if authority.is_none_or(|authority| !authority.eq_ignore_ascii_case(host)) {
            let problem = format!("requests from pages of {origin} are not allowed");
            return Err(Refusal::new(StatusCode::FORBIDDEN, problem));
        }
    }
    let foreign = matches!(
        text(&HeaderName::from_static("sec-fetch-site")),
        Some(Ok("cross-site" | "same-site"))
    );
    let visit = matches!(
        text(&HeaderName::from_static("sec-fetch-mode")),
        Some(Ok("navigate"))
    );
    if foreign && !visit {
        let problem = "requests from pages of other sites are not allowed";
        return Err(Refusal::new(StatusCode::FORBIDDEN, problem));
    }
    Ok(())
}

/// True for addresses, which cannot be rebound, and for our own names.
fn is_ours(host: &str, names: &[String]) -> bool {
    let Ok(authority) = host.parse::<Authority>() else {
        return false;
    };
    let name = authority.host().to_ascii_lowercase();
    let v6 = name.strip_prefix('[').and_then(|n| n.strip_suffix(']'));
    !host.contains('@')
        && (name == "localhost"
            || name.parse::<IpAddr>().is_ok()
            || v6.is_some_and(|n| n.parse::<Ipv6Addr>().is_ok())
            || names.contains(&name))
}

pub(super) fn authorize(site: &Site, headers: &HeaderMap) -> Result<(), Refusal> {
    let given = headers.get(AUTHORIZATION).and_then(|v| v.to_str().ok());
    let token = given.and_then(|given| given.strip_prefix("Bearer "));
    match token {
        Some(token) if site.token.is(token) => Ok(()),
        Some(_) => Err(Refusal::new(StatusCode::FORBIDDEN, "wrong token")),
        None => Err(Refusal::new(
            StatusCode::UNAUTHORIZED,
            "this needs the token that the monitor's log shows: Authorization: Bearer TOKEN",
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(headers: &[(&'static str, &str)], expected: Option<u16>) {
        let map: HeaderMap = headers
            .iter()
            .map(|(name, value)| {
                let name = HeaderName::from_static(name);
                (name, HeaderValue::from_str(value).unwrap())
            })
            .collect();
        let outcome = admit(&map, &["robot.local".to_owned()]);
        let status = outcome.err().map(|refusal| refusal.status.as_u16());
        assert_eq!(status, expected, "{headers:?}");
    }

    #[test]
    fn addresses_and_known_names_are_served_and_rebound_names_are_not() {
        let ours =
            "127.0.0.1:7440 localhost:7441 [::1]:7440 192.168.0.7 robot.local:7440 Robot.Local";
        for host in ours.split(' ') {
            check(&[("host", host)], None);
        }
        let others = "evil.example 127.0.0.1.evil.example localhost.evil.example:7440 \
                      user@127.0.0.1 [::1";
        for host in others.split(' ') {
            check(&[("host", host)], Some(421));
        }
        check(&[], Some(400));
    }

    #[test]
    fn pages_of_other_sites_are_refused() {
        let host = ("host", "127.0.0.1:7440");
        check(&[host, ("origin", "http://127.0.0.1:7440")], None);
        check(&[host, ("origin", "https://127.0.0.1:7440")], None);
        let others = "http://evil.example null http://127.0.0.1:7441 \
                      http://127.0.0.1:7440.evil.example file://127.0.0.1:7440";
        for origin in others.split(' ') {
            check(&[host, ("origin", origin)], Some(403));
        }
    }

    #[test]
    fn a_link_may_lead_here_but_an_image_may_not_be_taken() {
        let host = ("host", "127.0.0.1:7440");
        let site = ("sec-fetch-site", "cross-site");
        check(&[host, site, ("sec-fetch-mode", "navigate")], None);
        check(&[host, site, ("sec-fetch-mode", "no-cors")], Some(403));
        check(&[host, site], Some(403));
        check(&[host, ("sec-fetch-site", "same-origin")], None);
    }
}
