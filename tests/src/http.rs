//! Requests to a page's server, byte for byte.

use std::fs::OpenOptions;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::{SocketAddr, TcpListener, TcpStream};
use std::os::unix::fs::OpenOptionsExt;
use std::path::{Path, PathBuf};

use serde_json::Value;

/// Writes a token where only this user can read it.
pub fn token_file(folder: &Path, token: &str) -> PathBuf {
    let path = folder.join("token");
    let mut options = OpenOptions::new();
    options.write(true).create_new(true).mode(0o600);
    let mut file = options.open(&path).unwrap();
    file.write_all(token.as_bytes()).unwrap();
    path
}

/// Address of a server on this machine.
#[derive(Debug, Clone, Copy)]
pub struct Site(pub SocketAddr);

impl Site {
    /// Returns an address that was free a moment ago. If another process takes it meanwhile, the
    /// node takes another one and the test fails to find it.
    pub fn free() -> Self {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        Site(listener.local_addr().unwrap())
    }

    /// Sends the request unchanged; returns status, head and body.
    pub fn raw(&self, request: &[u8]) -> (u16, String, Vec<u8>) {
        let mut stream = TcpStream::connect(self.0).unwrap();
        // The server may have answered, and closed the connection, before it has read everything.
        let _ = stream.write_all(request);
        let mut reader = BufReader::new(stream);
        let mut head = String::new();
        while !head.ends_with("\r\n\r\n") {
            assert!(reader.read_line(&mut head).unwrap() > 0, "{head}");
        }
        let status = head.split(' ').nth(1).unwrap().parse().unwrap();
        let mut body = Vec::new();
        let _ = reader.read_to_end(&mut body);
        (status, head, body)
    }

    /// Sends a request with these headers; returns status and body.
    pub fn ask(&self, method: &str, path: &str, headers: &[&str], body: &str) -> (u16, String) {
        let host = format!("Host: {}", self.0);
        let length = format!("Content-Length: {}", body.len());
        let given = headers.iter().any(|header| header.starts_with("Host:"));
        let own = [host.as_str()];
        let lines: Vec<&str> = headers
            .iter()
            .chain(if given { &[][..] } else { &own[..] })
            .chain(&[length.as_str(), "Connection: close"])
            .copied()
            .collect();
        let request = format!(
            "{method} {path} HTTP/1.1\r\n{}\r\n\r\n{body}",
            lines.join("\r\n")
        );
        let (status, _, body) = self.raw(request.as_bytes());
        (status, String::from_utf8(body).unwrap())
    }

    pub fn get(&self, path: &str) -> Value {
        let (status, body) = self.ask("GET", path, &[], "");
        assert_eq!(status, 200, "{path}: {body}");
        serde_json::from_str(&body).unwrap()
    }
}
