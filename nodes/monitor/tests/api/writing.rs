//! Requests that change the graph.

use messages::{Corner, InitialPoseKind, Pose2, topic};
use serde_json::json;
use transport::testing::wait_for;

use crate::world::{TOKEN, World};

#[test]
fn writing_needs_the_token_and_somebody_who_listens() {
    let world = World::new("token");
    let path = "/api/v1/robots/r/region";
    let body = r#"{"corners":[[0,0],[2,3]]}"#;
    let json = "Content-Type: application/json";
    let token = format!("Authorization: Bearer {TOKEN}");
    let put = |headers: &[&str], body: &str| world.site.ask("PUT", path, headers, body).0;
    let save = || {
        world
            .site
            .ask("POST", "/api/v1/robots/r/save", &[&token], "")
    };
    assert_eq!(put(&[json], body), 401);
    let wrong = "Authorization: Bearer 0123456789abcdeX";
    assert_eq!(put(&[json, wrong], body), 403);
    let basic = "Authorization: Basic 0123456789abcdef";
    assert_eq!(put(&[json, basic], body), 401);
    assert_eq!(put(&[json, &token], body), 409, "no node takes a region");
    assert_eq!(save().0, 409);

    let regions = world.graph.subscriber::<topic::Region>().unwrap();
    let saves = world.graph.subscriber::<topic::Save>().unwrap();
    world.wait_for_state(|known| {
        known["abilities"] == json!({"region": true, "save": true, "hint": false, "restart": false})
    });
    assert_eq!(put(&[json, &token], body), 202);
    let corners = wait_for(&world.graph, &regions, |_, corners| {
        (!corners.is_empty()).then(|| corners.to_vec())
    });
    let expected = [Corner { x: 0.0, y: 0.0 }, Corner { x: 2.0, y: 3.0 }];
    assert_eq!(corners, expected);
    let known = world.wait_for_state(|known| known["region"] != json!([]));
    assert_eq!(known["region"], json!([[0.0, 0.0], [2.0, 3.0]]));
    assert_eq!(world.site.ask("DELETE", path, &[&token], "").0, 202);
    wait_for(&world.graph, &regions, |_, corners| {
        corners.is_empty().then_some(())
    });
    assert_eq!(save().0, 202);
    wait_for(&world.graph, &saves, |_, _| Some(()));
}

#[test]
fn nonsense_is_refused_with_a_reason() {
    let world = World::new("nonsense");
    let regions = world.graph.subscriber::<topic::Region>().unwrap();
    world.wait_for_state(|known| known["abilities"]["region"] == true);
    let token = format!("Authorization: Bearer {TOKEN}");
    let headers = [token.as_str(), "Content-Type: application/json"];
    let path = "/api/v1/robots/r/region";
    let put = |body: &str| world.site.ask("PUT", path, &headers, body).0;
    assert_eq!(put("{"), 400);
    assert_eq!(put(r#"{"corners":[[0,0],[1,1]],"more":1}"#), 422);
    assert_eq!(put(r#"{"corners":[[0,0]]}"#), 422);
    assert_eq!(put(r#"{"corners":[[0,0],[1e300,1]]}"#), 422);
    assert_eq!(put(r#"{"corners":[[0,0],[null,1]]}"#), 422);
    let many = |n| format!(r#"{{"corners":[{}[0,0]]}}"#, "[0,0],".repeat(n));
    assert_eq!(put(&many(1000)), 422);
    assert_eq!(put(&many(100_000)), 413);
    let sent = regions.newest().unwrap();
    assert!(sent.is_none_or(|sent| sent.items().is_empty()), "no region");
    let (status, body) = world.site.ask("GET", "/api/v1/robots/other", &[], "");
    assert_eq!(status, 404);
    assert!(body.contains("there is no robot"), "{body}");
    assert_eq!(world.site.ask("GET", "/../etc/passwd", &[], "").0, 404);
    assert_eq!(world.site.ask("POST", "/", &[], "").0, 405);
}

#[test]
fn a_pose_that_somebody_points_at_is_a_hint_for_the_tracker() {
    let world = World::new("hint");
    let token = format!("Authorization: Bearer {TOKEN}");
    let json = "Content-Type: application/json";
    let post = |headers: &[&str], body: &str| {
        let path = "/api/v1/robots/r/hint";
        world.site.ask("POST", path, headers, body).0
    };
    let body = r#"{"x":1.5,"y":-2,"yaw":0.5}"#;
    assert_eq!(post(&[json], body), 401);
    assert_eq!(post(&[json, &token], body), 409, "no tracker");
    let hints = world.graph.subscriber::<topic::InitialPoseTopic>().unwrap();
    world.wait_for_state(|known| known["abilities"]["hint"] == true);
    for wrong in [
        r#"{"x":1.5,"y":-2}"#,
        r#"{"x":1e300,"y":0,"yaw":0}"#,
        r#"{"x":0,"y":0,"yaw":90}"#,
    ] {
        assert_eq!(post(&[json, &token], wrong), 422, "{wrong}");
    }
    assert_eq!(post(&[json, &token], body), 202);
    let hint = wait_for(&world.graph, &hints, |hint, _| Some(*hint));
    let (x, y, yaw) = (1.5, -2.0, 0.5);
    assert_eq!(hint.map_from_base, Pose2 { x, y, yaw });
    assert_eq!(hint.kind, InitialPoseKind::Hint as u64);
}
