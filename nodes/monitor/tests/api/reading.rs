//! Reading the state and following changes.

use std::io::Read;

use bytemuck::Zeroable;
use messages::{Beam, BeamsHeader, FieldHeader, topic};
use serde_json::{Value, json};
use tests::drawn_map::DrawnMap;
use transport::{Flow, TransportError};
use tungstenite::Message;

use crate::world::{World, map_name, next, next_of};

#[test]
fn what_flows_in_the_graph_is_reported() {
    let world = World::new("flow");
    let robots = world.site.get("/api/v1/robots");
    assert_eq!(robots["robots"], json!(["r"]));
    let known = world.wait_for_state(|known| !known["map"].is_null());
    assert_eq!(known["map"]["map_id"], map_name());
    let mut socket = world.stream();
    assert_eq!(next(&mut socket)["type"], "snapshot");
    world.answer(7, 1.5);
    let answer = next_of(&mut socket, "answer");
    assert_eq!(answer["verdict"], "Unique");
    assert_eq!(answer["hypotheses"][0]["laser"]["x"], 1.5);
    world
        .beams
        .send(BeamsHeader::zeroed(), &[Beam::zeroed()])
        .unwrap();
    assert_eq!(next_of(&mut socket, "beams")["fate"], "h");
    // A later viewer gets the same state at once.
    let known = world.site.get("/api/v1/robots/r");
    assert_eq!(known["answer"]["counter"], 7);
    let names: Vec<&Value> = known["nodes"]
        .as_array()
        .unwrap()
        .iter()
        .map(|n| &n["name"])
        .collect();
    assert_eq!(names, ["monitor"]);
}

#[test]
fn the_map_is_a_byte_a_cell() {
    let world = World::new("map");
    world.wait_for_state(|known| !known["map"].is_null());
    let path = "/api/v1/robots/r/map";
    let request = |more: &str| {
        format!(
            "GET {path} HTTP/1.1\r\nHost: {}\r\n{more}Connection: close\r\n\r\n",
            world.site.0
        )
    };
    let (status, _, cells) = world.site.raw(request("").as_bytes());
    assert_eq!((status, cells), (200, DrawnMap::small().cells));
    let (status, _, cells) = world
        .site
        .raw(request(&format!("If-None-Match: \"{}\"\r\n", map_name())).as_bytes());
    assert_eq!((status, cells.len()), (304, 0), "the reader has it");
    let (_, head, packed) = world
        .site
        .raw(request("Accept-Encoding: gzip\r\n").as_bytes());
    assert!(head.contains("content-encoding: gzip"), "{head}");
    let mut cells = Vec::new();
    flate2::read::GzDecoder::new(&packed[..])
        .read_to_end(&mut cells)
        .unwrap();
    assert_eq!(cells, DrawnMap::small().cells);
}

#[test]
fn the_field_flows_while_somebody_looks() {
    let world = World::new("field");
    let fields = world.graph.publisher::<topic::Field>().unwrap();
    assert!(!fields.has_subscribers());
    let mut socket = world.stream();
    socket
        .send(Message::text(
            json!({"type": "field", "on": true}).to_string(),
        ))
        .unwrap();
    let tick = std::time::Duration::from_millis(20);
    let wait = |wanted: bool| {
        world
            .graph
            .run(&[], tick, |_| {
                let reached = fields.has_subscribers() == wanted;
                Ok::<_, TransportError>(if reached { Flow::Stop } else { Flow::Continue })
            })
            .unwrap();
    };
    wait(true);
    let header = FieldHeader {
        width: 2,
        height: 1,
        best: 10,
        ..FieldHeader::zeroed()
    };
    fields.send(header, &[10, 0]).unwrap();
    let image = loop {
        if let Message::Binary(image) = socket.read().unwrap() {
            break image;
        }
    };
    assert_eq!(image[image.len() - 2..], [255, 0]);
    drop(socket);
    wait(false);
}
