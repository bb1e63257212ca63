//! Receives maps and publishes their boundaries.

use std::time::Duration;

use messages::{NodeState, topic};
use transport::{Flow, Graph, Health, Publisher, Sample, TransportError, with_causes};

use crate::BoundaryError;
use crate::extraction::{Extraction, extract};

/// Longest time that a late joiner waits for the boundary.
const TICK: Duration = Duration::from_millis(100);

pub fn run(graph: &Graph) -> Result<(), BoundaryError> {
    let maps = graph.subscriber::<topic::Map>()?;
    let boundaries = graph.publisher::<topic::Boundary>()?;
    let mut health = graph.health()?;
    graph.run(&[&maps], TICK, |_| {
        if let Some(map) = maps.newest()? {
            health.count_received(1);
            health.state(NodeState::Busy)?;
            let (header, cells) = (map.header(), map.items());
            let checked = header.check_id(cells).map_err(BoundaryError::from);
            match checked.and_then(|()| extract(header, cells)) {
                Ok(extraction) => serve(&extraction, &boundaries, &mut health)?,
                Err(error) => refuse(&map, &error, &mut health)?,
            }
        }
        health.tick()?;
        Ok(Flow::Continue)
    })
}

fn serve(
    Extraction { header, cells }: &Extraction,
    boundaries: &Publisher<topic::Boundary>,
    health: &mut Health,
) -> Result<(), TransportError> {
    boundaries.send(*header, cells)?;
    health.count_sent(1);
    tracing::info!(
        map = format_args!("{:016x}", header.map_id),
        free = header.free_cells,
        boundary = header.boundary_cells,
        "boundary served"
    );
    health.state(NodeState::Ready)
}

/// Reports a rejected map; the previous boundary stays published.
fn refuse(
    map: &Sample<topic::Map>,
    error: &BoundaryError,
    health: &mut Health,
) -> Result<(), TransportError> {
    let (map_id, error) = (map.header().map_id, with_causes(error));
    let problem = format!("map {map_id:016x} rejected: {error}");
    tracing::warn!("{problem}");
    health.count_refused(1);
    health.error(&problem)?;
    health.state(NodeState::Degraded)
}
