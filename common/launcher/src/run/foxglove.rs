//! `--foxglove`: adds a server for viewers to a graph, from an executable next to the others.

use dataflow::Dataflow;

use super::added;

const SERVER: &str = "foxglove_server";

pub(crate) fn add(dataflow: &mut Dataflow) -> anyhow::Result<()> {
    added::check_new(dataflow, "--foxglove", SERVER)?;
    // It may be restarted, as viewers reconnect by themselves.
    let build = added::build_alone(dataflow, SERVER);
    dataflow.nodes.push(added::node(dataflow, SERVER, build));
    Ok(())
}

#[cfg(test)]
mod tests {
    use dataflow::Node;

    use super::*;
    use crate::run::testing::parsed;

    fn added_to(nodes: &str) -> anyhow::Result<Node> {
        let mut dataflow = parsed(&format!("nodes: [{nodes}]"));
        add(&mut dataflow)?;
        Ok(dataflow.nodes.pop().unwrap())
    }

    #[test]
    fn the_server_is_built_by_itself_where_cargo_builds_the_others() {
        for build in [
            "cargo build --release",
            "cargo build --package a -p b --release",
        ] {
            let node = added_to(&format!("{{id: a, path: bin/a, build: {build}}}")).unwrap();
            assert_eq!((&*node.id, &*node.path), (SERVER, "bin/foxglove_server"));
            let built = node.build[0].to_string();
            assert_eq!(built, "cargo build --release --package foxglove_server");
        }
        let node = added_to("{id: a, path: bin/a, build: make}").unwrap();
        assert!(node.build.is_empty());
    }
}
