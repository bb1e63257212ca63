//! Prepares a map with a cached search index.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::SystemTime;

use engine::EngineError;
use engine::Map;
use engine::localizer::{PreparedMap, Settings};
use engine::search::{IndexKey, SearchIndex};
use engine::vote_search::{Preparation, VoteSearch};

use crate::error::failed;
use crate::{CacheError, file, folder};

/// A folder of cached indexes. Several processes may use it at once, and any of its files may be
/// removed at any time.
#[derive(Debug, Clone)]
pub struct IndexCache {
    folder: PathBuf,
    /// Largest total size of the files, in bytes.
    limit: u64,
}

/// A first stage that is prepared for a map, and the state of its cached index.
#[derive(Debug)]
pub struct Prepared {
    pub vote_search: VoteSearch,
    /// State of the cached index.
    pub kept: Kept,
}

/// State of a cached index.
#[derive(Debug, Default)]
pub struct Kept {
    pub is_read: bool,
    pub problem: Option<CacheError>,
    /// Index to be saved for the next time, when there is time.
    pub unsaved: Option<Unsaved>,
}

#[derive(Debug)]
pub struct Unsaved {
    cache: IndexCache,
    key: IndexKey,
    index: Arc<SearchIndex>,
}

impl Prepared {
    /// Prepares a map with the cached index, or computes the index.
    pub fn new(cache: Option<&IndexCache>, preparation: Preparation) -> Result<Self, EngineError> {
        let mut kept = Kept::default();
        let Some((cache, key)) = cache.zip(preparation.key()) else {
            let vote_search = preparation.finish()?;
            return Ok(Prepared { vote_search, kept });
        };
        match cache.read(key, &preparation) {
            Ok(Some(index)) => {
                let vote_search = preparation.with(index);
                kept.is_read = true;
                return Ok(Prepared { vote_search, kept });
            }
            Ok(None) => {}
            Err(problem) => kept.problem = Some(problem),
        }
        let vote_search = preparation.finish()?;
        let unsaved = |index| Unsaved {
            cache: cache.clone(),
            key,
            index,
        };
        kept.unsaved = vote_search.search_index().map(unsaved);
        Ok(Prepared { vote_search, kept })
    }
}

/// Prepares a map for locating scans, with the cached index or by computing it.
pub fn prepared_map(
    cache: Option<&IndexCache>,
    map: Map<'_>,
    settings: Settings,
) -> Result<(PreparedMap, Kept), EngineError> {
    let preparation = Preparation::of_map(map, settings.vote_search, settings.prior)?;
    let Prepared { vote_search, kept } = Prepared::new(cache, preparation)?;
    Ok((PreparedMap::with(vote_search, map, settings.peaks)?, kept))
}

impl Unsaved {
    /// Writes the file, and removes the least recently used files if all together are too large.
    pub fn save(self) -> Result<(), CacheError> {
        let Unsaved { cache, key, index } = self;
        let bytes = file::size(&index);
        if bytes > cache.limit {
            const MEGABYTE: u64 = 1_000_000;
            return Err(CacheError::TooLarge {
                needed_mb: bytes.div_ceil(MEGABYTE),
                limit_mb: cache.limit / MEGABYTE,
            });
        }
        let path = cache.path(key);
        let failed = failed("write", &path);
        folder::make(&cache.folder)?;
        // A concurrent reader sees the old file or the complete new one. A file that a crash leaves
        // incomplete has a wrong checksum, so there is no need to sync it to disk.
        let mut new = folder::new_file(&cache.folder).map_err(&failed)?;
        file::write(new.as_file_mut(), key, &index).map_err(&failed)?;
        new.persist(&path).map_err(|error| failed(error.error))?;
        folder::trim(&cache.folder, &path, cache.limit)
    }
}

impl IndexCache {
    /// Uses a folder, which is created with the first file, with at most `limit` bytes of files.
    pub fn new(folder: PathBuf, limit: u64) -> Self {
        IndexCache { folder, limit }
    }

    pub fn path(&self, key: IndexKey) -> PathBuf {
        self.folder.join(format!("{key}.{}", folder::ENDING))
    }

    fn read(
        &self,
        key: IndexKey,
        preparation: &Preparation,
    ) -> Result<Option<SearchIndex>, CacheError> {
        let path = self.path(key);
        if !folder::is_there(&self.folder)? {
            return Ok(None);
        }
        // The folder may have been accessible to others before, so the file is checked, too.
        let Some(mut file) = trusted_files::open(&path)? else {
            return Ok(None);
        };
        let bytes = file.metadata().map_err(failed("look at", &path))?.len();
        let index = file::read(&mut file, bytes, key, preparation);
        let index = index.map_err(|source| CacheError::Unusable {
            path: path.clone(),
            source,
        })?;
        // Marks it as recently used; an error does not matter.
        let _ = file.set_modified(SystemTime::now());
        Ok(Some(index))
    }
}

#[cfg(test)]
mod tests {
    use std::fs::{Permissions, read, read_dir, remove_dir_all, set_permissions, write};
    use std::os::unix::fs::PermissionsExt;

    use engine::grid::CellRules;
    use engine::search::{SECTIONS, SectionError};
    use engine::vote_search::{Prior, VoteSearchConfig};

    use super::*;
    use crate::testing::{FRAME, map, occupancy, preparation, preparation_with};

    const LIMIT: u64 = 100_000_000;

    fn prepare(cache: &IndexCache, seed: usize) -> Prepared {
        Prepared::new(Some(cache), preparation(seed)).unwrap()
    }

    fn prepare_and_save(cache: &IndexCache, seed: usize) -> bool {
        let unsaved = prepare(cache, seed).kept.unsaved;
        let is_new = unsaved.is_some();
        unsaved
            .into_iter()
            .for_each(|unsaved| unsaved.save().unwrap());
        is_new
    }

    #[test]
    fn a_map_is_prepared_once_whatever_else_is_and_removed() {
        let folder = tempfile::tempdir().unwrap();
        let cache = IndexCache::new(folder.path().join("new"), LIMIT);
        assert!(prepare_and_save(&cache, 1));
        assert!(prepare_and_save(&cache, 2));
        let read = prepare(&cache, 1);
        assert!(read.kept.is_read && read.kept.problem.is_none() && read.kept.unsaved.is_none());
        let made = preparation(1).finish().unwrap().search_index().unwrap();
        assert_eq!(
            read.vote_search.search_index().unwrap().sections(),
            made.sections()
        );
        remove_dir_all(folder.path().join("new")).unwrap();
        assert!(prepare_and_save(&cache, 1), "the folder is made again");
        assert!(!prepare_and_save(&cache, 1));
    }

    #[test]
    fn a_damaged_file_is_reported_and_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let cache = IndexCache::new(folder.path().join("new"), LIMIT);
        prepare_and_save(&cache, 1);
        let path = cache.path(preparation(1).key().unwrap());
        let sound = read(&path).unwrap();
        let mut damaged = sound.clone();
        damaged[sound.len() / 2] ^= 4;
        for bytes in [&damaged[..], &sound[..sound.len() - 1], &[]] {
            write(&path, bytes).unwrap();
            let prepared = prepare(&cache, 1);
            assert!(matches!(
                prepared.kept.problem,
                Some(CacheError::Unusable { .. })
            ));
            prepared.kept.unsaved.unwrap().save().unwrap();
            assert_eq!(read(&path).unwrap(), sound);
        }
    }

    #[test]
    fn what_others_can_change_is_not_read_but_replaced() {
        let folder = tempfile::tempdir().unwrap();
        let cache = IndexCache::new(folder.path().join("new"), LIMIT);
        prepare_and_save(&cache, 1);
        let path = cache.path(preparation(1).key().unwrap());
        set_permissions(&path, Permissions::from_mode(0o666)).unwrap();
        let kept = prepare(&cache, 1).kept;
        assert!(!kept.is_read);
        assert!(matches!(kept.problem, Some(CacheError::Untrusted(_))));
        kept.unsaved.unwrap().save().unwrap();
        assert!(prepare(&cache, 1).kept.is_read);
    }

    #[test]
    fn the_key_is_of_all_that_an_index_is_made_of() {
        let other = |change: fn(&mut VoteSearchConfig)| {
            let mut config = VoteSearchConfig::default();
            change(&mut config);
            preparation_with(1, config).key().unwrap()
        };
        let of = |frame, cells: &[u8], rules| {
            let map = map(frame, cells, rules);
            let preparation = Preparation::of_map(map, VoteSearchConfig::default(), Prior::None);
            preparation.unwrap().key().unwrap()
        };
        let (mut frame, mut rules) = (FRAME, CellRules::default());
        (frame.resolution_m, rules.unknown_blocks) = (0.06, true);
        let mut known = occupancy(1);
        let unknown = known.iter().position(|&cell| cell == 255).unwrap();
        known[unknown] = 0;
        let keys = [
            other(|_| ()),
            of(FRAME, &occupancy(2), CellRules::default()),
            other(|config| config.headings = 48),
            other(|config| config.search_cell = 0.1),
            other(|config| config.limits.unknown_reach = 0.2),
            other(|config| config.limits.robot_radius = 0.1),
            other(|config| config.limits.region = Some("0,0 3,3".parse().unwrap())),
            other(|config| config.limits.headings_within = Some("0,90".parse().unwrap())),
            of(frame, &occupancy(1), CellRules::default()),
            of(FRAME, &occupancy(1), rules),
            of(FRAME, &known, CellRules::default()),
        ];
        for (i, key) in keys.iter().enumerate() {
            assert!(!keys[..i].contains(key), "setting {i}");
        }
        // Parameters that only affect a search do not matter.
        assert_eq!(other(|config| config.threads = 3), keys[0]);
        let cells = occupancy(1);
        let map = map(FRAME, &cells, CellRules::default());
        let known = Preparation::of_map(map, VoteSearchConfig::default(), Prior::Heading);
        assert_eq!(known.unwrap().key(), None);
    }

    #[test]
    fn several_may_write_and_read_at_once() {
        let folder = tempfile::tempdir().unwrap();
        let cache = IndexCache::new(folder.path().join("new"), LIMIT);
        prepare_and_save(&cache, 1);
        let saves = || {
            let key = preparation(1).key().unwrap();
            let index = preparation(1).finish().unwrap().search_index().unwrap();
            for _ in 0..20 {
                let (cache, index) = (cache.clone(), Arc::clone(&index));
                Unsaved { cache, key, index }.save().unwrap();
            }
        };
        std::thread::scope(|scope| {
            scope.spawn(saves);
            scope.spawn(saves);
            for _ in 0..20 {
                let kept = prepare(&cache, 1).kept;
                assert!(kept.is_read && kept.problem.is_none());
            }
        });
        assert_eq!(read_dir(folder.path().join("new")).unwrap().count(), 1);
    }

    #[test]
    fn what_takes_more_than_all_may_is_not_kept() {
        let folder = tempfile::tempdir().unwrap();
        let small = IndexCache::new(folder.path().join("new"), 1000);
        let refused = prepare(&small, 1).kept.unsaved.unwrap().save().unwrap_err();
        assert!(matches!(refused, CacheError::TooLarge { limit_mb: 0, .. }));
        assert!(!folder.path().join("new").exists());
    }

    #[test]
    fn a_memory_limit_holds_for_what_is_read() {
        let config = VoteSearchConfig {
            memory_limit: Some(1),
            ..VoteSearchConfig::default()
        };
        let mut lengths = [0; SECTIONS];
        (lengths[0], lengths[5]) = (1, 1_000_000);
        let refused = preparation_with(1, config).unchecked_index(lengths);
        let (bytes, limit) = (1_000_001, 1_000_000);
        assert_eq!(refused.unwrap_err(), SectionError::Memory { bytes, limit });
    }
}
