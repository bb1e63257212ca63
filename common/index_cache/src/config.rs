//! Command-line options.

use std::convert::Infallible;
use std::path::PathBuf;
use std::str::FromStr;

use crate::{CacheError, IndexCache, folder};

/// Options of the index cache.
#[derive(Debug, Clone, clap::Args)]
pub struct IndexCacheConfig {
    /// Folder that caches prepared maps, so that the same map with the same settings is read the
    /// next time instead of prepared: a folder that only this user can use, created if it is
    /// missing; "user" for $XDG_CACHE_HOME/backcast or ~/.cache/backcast; "off" for no cache. Its
    /// files can be removed at any time. [default: user in the accumulator, off in the tools]
    #[arg(long, value_name = "FOLDER")]
    pub index_cache: Option<CachePlace>,
    /// Maximum size of the cache, megabytes of 10⁶ bytes, 1..=1000000: the least recently used maps
    /// are removed.
    #[arg(long, value_name = "MEGABYTES", default_value_t = 2000, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub index_cache_limit: u32,
}

/// Place of the cache.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum CachePlace {
    Off,
    /// The user's cache folder.
    User,
    Folder(PathBuf),
}

impl IndexCacheConfig {
    /// Opens the configured cache, or `default`; `None` without a cache.
    pub fn open(&self, default: CachePlace) -> Result<Option<IndexCache>, CacheError> {
        let place = self.index_cache.clone().unwrap_or(default);
        let folder = match place {
            CachePlace::Off => return Ok(None),
            CachePlace::User => folder::of_user()?,
            CachePlace::Folder(folder) => folder,
        };
        let limit = u64::from(self.index_cache_limit) * 1_000_000;
        Ok(Some(IndexCache::new(folder, limit)))
    }
}

impl FromStr for CachePlace {
    type Err = Infallible;

    fn from_str(text: &str) -> Result<Self, Infallible> {
        Ok(match text {
            "off" => CachePlace::Off,
            "user" => CachePlace::User,
            folder => CachePlace::Folder(folder.into()),
        })
    }
}

#[cfg(test)]
mod tests {
    use clap::Parser;

    use super::*;

    #[derive(Parser)]
    struct Arguments {
        #[command(flatten)]
        config: IndexCacheConfig,
    }

    fn config(arguments: &str) -> IndexCacheConfig {
        Arguments::parse_from(["node"].into_iter().chain(arguments.split_whitespace())).config
    }

    #[test]
    fn a_folder_is_named_or_the_default_or_none() {
        let given = config("");
        assert_eq!((given.index_cache, given.index_cache_limit), (None, 2000));
        let place = |arguments: &str| config(arguments).index_cache.unwrap();
        assert_eq!(place("--index-cache off"), CachePlace::Off);
        assert_eq!(place("--index-cache user"), CachePlace::User);
        assert_eq!(
            place("--index-cache ./off"),
            CachePlace::Folder("./off".into())
        );
        let open = |arguments: &str, default| config(arguments).open(default).unwrap();
        assert!(open("", CachePlace::Off).is_none());
        assert!(open("--index-cache off", CachePlace::Folder("x".into())).is_none());
        assert!(open("--index-cache x", CachePlace::Off).is_some());
    }
}
