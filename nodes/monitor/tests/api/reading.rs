//! Reading the state and following changes.

use std::io::Read;

use bytemuck::Zeroable;
use messages::{Beam, BeamsHeader, FieldHeader, topic};
use serde_json::json;
use tests::drawn_map::DrawnMap;
use transport::testing::wait_to_see;
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
    let sent = world.beams.send(BeamsHeader::zeroed(), &[Beam::zeroed()]);
    sent.unwrap();
    assert_eq!(next_of(&mut socket, "beams")["fate"], "h");
    // A later viewer gets the same state at once.
    let known = world.site.get("/api/v1/robots/r");
    assert_eq!(known["answer"]["counter"], 7);
    let nodes = known["nodes"].as_array().unwrap();
    assert_eq!((nodes.len(), &nodes[0]["name"]), (1, &json!("monitor")));
}

#[test]
fn the_map_is_a_byte_a_cell() {
    let world = World::new("map");
    world.wait_for_state(|known| !known["map"].is_null());
    let path = "/api/v1/robots/r/map";
    let site = &world.site;
    let get = |more: &str| {
        let host = format!("Host: {}\r\n{more}Connection: close", site.0);
        site.raw(format!("GET {path} HTTP/1.1\r\n{host}\r\n\r\n").as_bytes())
    };
    let (status, _, cells) = get("");
    assert_eq!((status, cells), (200, DrawnMap::small().cells));
    let (status, _, cells) = get(&format!("If-None-Match: \"{}\"\r\n", map_name()));
    assert_eq!((status, cells.len()), (304, 0), "the reader has it");
    let (_, head, packed) = get("Accept-Encoding: gzip\r\n");
    assert!(head.contains("content-encoding: gzip"), "{head}");
    let mut cells = Vec::new();
    let mut unpacked = flate2::read::GzDecoder::new(&packed[..]);
    unpacked.read_to_end(&mut cells).unwrap();
    assert_eq!(cells, DrawnMap::small().cells);
}

#[test]
fn the_field_flows_while_somebody_looks() {
    let world = World::new("field");
    let fields = world.graph.publisher::<topic::Field>().unwrap();
    assert!(!fields.has_subscribers());
    let mut socket = world.stream();
    let wish = Message::text("{\"type\": \"field\", \"on\": true}");
    socket.send(wish).unwrap();
    let wait = |wanted: bool| {
        wait_to_see(&world.graph, || {
            (fields.has_subscribers() == wanted).then_some(())
        });
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
