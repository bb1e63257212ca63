//! Set of maps received from the topic.

use engine::space;
use messages::{MapSet, topic};
use transport::Sample;

use crate::preparation::{Job, Key};
use crate::subject::{Refused, Subject};

pub(super) struct Set {
    sample: Sample<topic::Maps>,
    pub(super) keys: Vec<Key>,
}

impl Set {
    pub(super) fn read(sample: Sample<topic::Maps>) -> Result<Self, Refused> {
        let set = MapSet::read(sample.header(), sample.items());
        let set = set.map_err(|error| Subject::Set(sample.header().set_id).refused(error))?;
        let maps = set.maps.iter();
        let keys =
            maps.map(|(map, _)| Key::in_set(map).map_err(|error| Subject::map(map).refused(error)));
        let keys = keys.collect::<Result<_, _>>()?;
        Ok(Set { sample, keys })
    }

    pub(super) fn jobs(&self) -> Result<Vec<Job>, Refused> {
        let header = self.sample.header();
        let set = MapSet::split(header, self.sample.items());
        let set = set.map_err(|error| Subject::Set(header.set_id).refused(error))?;
        let reach_m = space::reach_m(set.maps.iter().map(|(map, _)| map));
        let maps = set.maps.iter();
        let jobs = maps.map(|(map, cells)| {
            Job::in_set(map, cells, reach_m).map_err(|error| Subject::map(map).refused(error))
        });
        jobs.collect()
    }
}
