//! Selects the channel to use for a kind of message: by type, and by conventional name only if
//! several channels have the type.

use std::path::Path;
use std::sync::Arc;

use crate::{Channel, Kind, RecordingError};

/// Selects the channel with messages of a kind by the new names from `name_of`, which returns `None`
/// to exclude a channel; returns its own name, or `None` if there is none.
pub(crate) fn choose<'a>(
    channels: impl Iterator<Item = &'a Channel>,
    name_of: impl Fn(&str) -> Option<String>,
    kind: Kind,
    path: &Path,
) -> Result<Option<Arc<str>>, RecordingError> {
    let has_messages = |channel: &&Channel| channel.kind == Some(kind) && channel.messages > 0;
    let renamed = |channel: &Channel| Some((name_of(&channel.topic)?, channel.topic.clone()));
    let mut of_kind: Vec<(String, Arc<str>)> =
        channels.filter(has_messages).filter_map(renamed).collect();
    // A merged recording may define a topic twice.
    of_kind.sort_by(|a, b| a.0.cmp(&b.0));
    of_kind.dedup_by(|a, b| a.0 == b.0);
    let name = kind.topic();
    let named = of_kind.iter().find(|(topic, _)| topic == name);
    match (&of_kind[..], named) {
        (_, Some((_, own))) => Ok(Some(own.clone())),
        (_, None) if kind == Kind::PoseStamped => Ok(None),
        ([], _) => Ok(None),
        ([(_, own)], _) => Ok(Some(own.clone())),
        (several, None) => {
            let found: Vec<&str> = several.iter().map(|(topic, _)| &**topic).collect();
            let (path, found, option) = (path.display(), found.join(", "), kind.option());
            Err(RecordingError::Unfit(format!(
                "{path} has several channels of {kind}, {found}, and none is called {name}: name \
                 one with {option}"
            )))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::GROUND_TRUTH;

    fn channel(topic: &str, kind: Kind, messages: u64) -> Channel {
        Channel {
            topic: topic.into(),
            schema: kind.schema().to_owned(),
            encoding: "cdr".to_owned(),
            kind: Some(kind),
            messages,
        }
    }

    fn chosen(kind: Kind, topics: &[(&str, u64)]) -> Result<Option<String>, String> {
        let channels: Vec<Channel> = topics
            .iter()
            .map(|&(topic, messages)| channel(topic, kind, messages))
            .collect();
        let own = |topic: &str| Some(topic.to_owned());
        choose(channels.iter(), own, kind, Path::new("r.mcap"))
            .map(|topic| topic.map(|topic| topic.to_string()))
            .map_err(|error| error.to_string())
    }

    #[test]
    fn the_type_decides_and_the_name_among_several() {
        assert_eq!(chosen(Kind::Scan, &[]), Ok(None));
        let only = chosen(Kind::Scan, &[("/lidar/front", 3)]);
        assert_eq!(only, Ok(Some("/lidar/front".to_owned())));
        let named = chosen(Kind::Scan, &[("/a", 1), ("/scan", 1), ("/b", 1)]);
        assert_eq!(named, Ok(Some("/scan".to_owned())));
        let empty = chosen(Kind::Scan, &[("/scan", 0), ("/b", 1)]);
        assert_eq!(empty, Ok(Some("/b".to_owned())));
        let twice = chosen(Kind::Scan, &[("/b", 1), ("/b", 1)]);
        assert_eq!(twice, Ok(Some("/b".to_owned())));
        assert_eq!(
            chosen(Kind::Scan, &[("/a", 1), ("/b", 1)]).unwrap_err(),
            "r.mcap has several channels of sensor_msgs/msg/LaserScan, /a, /b, \
             and none is called /scan: name one with --scan-topic"
        );
    }

    #[test]
    fn a_goal_is_not_taken_for_the_truth() {
        assert_eq!(chosen(Kind::PoseStamped, &[("/goal_pose", 1)]), Ok(None));
        let truth = chosen(Kind::PoseStamped, &[("/goal_pose", 1), (GROUND_TRUTH, 1)]);
        assert_eq!(truth, Ok(Some(GROUND_TRUTH.to_owned())));
    }
}
