//! The list of known robots.

use std::collections::BTreeMap;
use std::sync::{Arc, PoisonError, RwLock, RwLockReadGuard};

use crate::Robot;
use crate::webhook::Webhook;

/// Robots by name. Clones share one list: the source adds robots, the server reads.
#[derive(Debug, Clone, Default)]
pub struct Robots(Arc<RwLock<Shared>>);

#[derive(Debug, Default)]
struct Shared {
    all: BTreeMap<String, Arc<Robot>>,
    /// Receives the states of all robots.
    webhook: Option<Webhook>,
}

impl Robots {
    pub const MAX: usize = 256;

    /// Adds a robot; false if one of this name exists or there are [`Robots::MAX`].
    pub fn add(&self, robot: Arc<Robot>) -> bool {
        let mut shared = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let Shared { all, webhook } = &mut *shared;
        if all.len() == Self::MAX || all.contains_key(robot.name()) {
            return false;
        }
        if let Some(webhook) = webhook {
            robot.post_states_to(webhook);
        }
        all.insert(robot.name().to_owned(), robot);
        true
    }

    /// Posts the state changes of all robots, including those added later.
    pub(crate) fn post_states_to(&self, webhook: Webhook) {
        let mut shared = self.0.write().unwrap_or_else(PoisonError::into_inner);
        let robots = shared.all.values();
        robots.for_each(|robot| robot.post_states_to(&webhook));
        shared.webhook = Some(webhook);
    }

    pub fn get(&self, name: &str) -> Option<Arc<Robot>> {
        self.read().all.get(name).cloned()
    }

    pub fn names(&self) -> Vec<String> {
        self.read().all.keys().cloned().collect()
    }

    fn read(&self) -> RwLockReadGuard<'_, Shared> {
        self.0.read().unwrap_or_else(PoisonError::into_inner)
    }
}
