//! The page's address as a QR code of characters, for phones.

use std::net::{IpAddr, SocketAddr, UdpSocket};

use qrcode::render::unicode::Dense1x2;
use qrcode::types::QrError;
use qrcode::{EcLevel, QrCode};

/// An address of the documentation network (RFC 5737): it follows the default route.
const ELSEWHERE: (&str, u16) = ("192.0.2.1", 9);

/// URL of the page for other machines: `host` if given, else the address listened on or, if that is
/// unspecified, this machine's address on the default route. The `token` follows after `#`, which
/// browsers do not send. `None` if no route leads to other machines.
pub(super) fn place(
    listening: SocketAddr,
    host: Option<&str>,
    token: Option<&str>,
) -> Option<String> {
    let port = listening.port();
    let server = match (host, listening.ip()) {
        (Some(name), _) => format!("{name}:{port}"),
        (None, ip) if ip.is_unspecified() => SocketAddr::new(on_default_route()?, port).to_string(),
        (None, _) => listening.to_string(),
    };
    let token = token.map(|token| format!("#token={token}"));
    Some(format!("http://{server}/{}", token.unwrap_or_default()))
}

/// This machine's address on the default route. Connecting a UDP socket sends nothing.
fn on_default_route() -> Option<IpAddr> {
    let socket = UdpSocket::bind("0.0.0.0:0").ok()?;
    socket.connect(ELSEWHERE).ok()?;
    Some(socket.local_addr().ok()?.ip())
}

/// QR code of light characters on a dark terminal, two rows of modules per line.
pub(super) fn code(text: &str) -> Result<String, QrError> {
    // A screen needs no redundancy against dirt.
    let code = QrCode::with_error_correction_level(text, EcLevel::L)?;
    let mut picture = code.render::<Dense1x2>();
    picture
        .dark_color(Dense1x2::Light)
        .light_color(Dense1x2::Dark);
    Ok(picture.build())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phones_are_sent_where_they_can_reach_it() {
        let place = |listening: &str, host, token| {
            super::place(listening.parse().unwrap(), host, token).unwrap()
        };
        let expected = "http://192.0.2.7:7440/#token=0123";
        assert_eq!(place("192.0.2.7:7440", None, Some("0123")), expected);
        let found = place("0.0.0.0:7441", Some("r7.local"), None);
        assert_eq!(found, "http://r7.local:7441/");
        let found = place("[2001:db8::7]:80", None, None);
        assert_eq!(found, "http://[2001:db8::7]:80/");
        // If there is a route, its address is not one that only this machine can reach.
        let any = super::place("0.0.0.0:7440".parse().unwrap(), None, None);
        assert!(any.is_none_or(|place| !place.contains("//0.0.0.0") && !place.contains("//127.")));
    }

    #[test]
    fn the_code_has_a_bright_margin_and_fits_a_terminal() {
        let text = format!("http://192.168.100.100:7440/#token={}", "0f".repeat(16));
        let shown = code(&text).unwrap();
        let code = QrCode::with_error_correction_level(&text, EcLevel::L).unwrap();
        // It fits a terminal of 80 columns, next to the prefix of a log line.
        let width = code.width() + 8;
        assert!(width <= 58);
        assert!(shown.lines().all(|line| line.chars().count() == width));
        // The background is light, with a margin of four modules around the dark corner.
        let bright = "█".repeat(width);
        let lines: Vec<&str> = shown.lines().collect();
        assert_eq!(lines[..2], [&bright, &bright]);
        assert!(lines[2].starts_with("████ "), "{shown}");
        assert!(super::code(&"x".repeat(4000)).is_err());
    }
}
