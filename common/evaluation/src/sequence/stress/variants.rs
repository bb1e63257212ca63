//! List of all variants.

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::str::FromStr;

use ::map::OccupancyGrid;
use messages::Odometry;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use super::super::drive::{Moment, connect};
use super::material::{Change, Material, Means};
use super::{drawn, laser, map, motion, odometry, world};

pub(in super::super) struct Variant {
    pub(in super::super) name: &'static str,
    pub(super) way: Way,
}

/// Stage at which a variant changes the drive.
#[derive(Clone, Copy)]
pub(super) enum Way {
    Undisturbed,
    /// Changes the map or the scans; everything is searched again.
    Drive(fn(&mut Material, &mut Means<'_>) -> Change<()>),
    /// Changes only the odometry.
    Odometry(fn(&mut Vec<Odometry>)),
    /// Changes the moments after the search.
    Moments(fn(&mut Vec<Moment>) -> Change<()>),
}

impl Variant {
    /// Random numbers seeded by this variant's name, so that they do not depend on the list.
    pub(super) fn means<'a>(&self, seed: u64, other_map: Option<&'a OccupancyGrid>) -> Means<'a> {
        let mut hasher = DefaultHasher::new();
        (seed, self.name).hash(&mut hasher);
        Means {
            rng: Xoshiro256PlusPlus::seed_from_u64(hasher.finish()),
            other_map,
        }
    }

    /// True if a lost robot is put back to the truth; false if it must recover by itself.
    pub(super) fn puts_back(&self) -> bool {
        self.name != CARRIED_AWAY
    }
}

const CARRIED_AWAY: &str = "carried-away";

const fn drive(
    name: &'static str,
    change: fn(&mut Material, &mut Means<'_>) -> Change<()>,
) -> Variant {
    let way = Way::Drive(change);
    Variant { name, way }
}

const fn odometry(name: &'static str, change: fn(&mut Vec<Odometry>)) -> Variant {
    let way = Way::Odometry(change);
    Variant { name, way }
}

const fn moments(name: &'static str, change: fn(&mut Vec<Moment>) -> Change<()>) -> Variant {
    let way = Way::Moments(change);
    Variant { name, way }
}

const MAP: &[Variant] = &[
    drive("map-drawn", |it, _| drawn::draw(&mut it.map)),
    drive("map-erased-10", |it, means| map::erase(it, means, 0.1)),
    drive("map-erased-30", |it, means| map::erase(it, means, 0.3)),
    drive("map-furniture", map::furnish),
    drive("map-half", |it, _| map::halve(it)),
    drive("map-larger-2", |it, _| map::enlarge(it, 1.02)),
    drive("map-larger-5", |it, _| map::enlarge(it, 1.05)),
    drive("map-mirrored", |it, _| map::mirror(it)),
    drive("map-other", map::exchange),
    drive("map-cells-10cm", |it, _| map::coarsen(it, 0.1)),
    drive("map-cells-20cm", |it, _| map::coarsen(it, 0.2)),
];

const LASER: &[Variant] = &[
    drive("laser-mirrored", |it, _| laser::mirror(it)),
    drive("laser-turned-180", |it, _| laser::turn(it)),
    drive("laser-off", |it, _| laser::shift(it)),
    drive("laser-frozen", |it, _| laser::freeze(it)),
    drive("laser-covered", laser::cover),
    drive("view-60", |it, _| laser::narrow(it, 60.0)),
    drive("view-90", |it, _| laser::narrow(it, 90.0)),
    drive("view-120", |it, _| laser::narrow(it, 120.0)),
    drive("view-180", |it, _| laser::narrow(it, 180.0)),
    drive("range-2.5", |it, _| laser::shorten(it, 2.5)),
    drive("range-4", |it, _| laser::shorten(it, 4.0)),
    drive("range-8", |it, _| laser::shorten(it, 8.0)),
    drive("beams-61", |it, _| laser::thin(it, 61)),
    drive("noise-3cm", |it, means| laser::add_noise(it, means, 0.03)),
    drive("noise-10cm", |it, means| laser::add_noise(it, means, 0.1)),
    drive("people-standing-20", |it, means| {
        world::stand_people(it, means, 0.2)
    }),
    drive("people-standing-45", |it, means| {
        world::stand_people(it, means, 0.45)
    }),
    drive("crowd-walks", world::walk_along),
    drive("glass", |it, means| world::glaze(it, means, false)),
    drive("glass-through", |it, means| world::glaze(it, means, true)),
    drive("short-returns", laser::return_early),
];

const ODOMETRY: &[Variant] = &[
    odometry("odometry-none", Vec::clear),
    odometry("odometry-ends", odometry::end),
    odometry("odometry-frozen", |all| odometry::freeze(all)),
    odometry("odometry-zero", odometry::zero),
    moments("odometry-twice", |moments| {
        connect(moments, (false, 2.0));
        Ok(())
    }),
    odometry("odometry-yaw-10", |all| odometry::turn_more(all)),
    odometry("odometry-backwards", |all| odometry::reverse(all)),
    odometry("odometry-late", odometry::delay),
    odometry("odometry-other-frame", odometry::turn_frame),
];

const MOTION: &[Variant] = &[
    drive("stands-1000", motion::stand),
    drive("starts-off-map", |it, _| motion::start_off_map(it)),
    moments(CARRIED_AWAY, motion::carry_away),
    moments("silent-10s", motion::silence),
];

const GROUPS: [(&str, &[Variant]); 5] = [
    (
        "undisturbed",
        &[Variant {
            name: "undisturbed",
            way: Way::Undisturbed,
        }],
    ),
    ("map", MAP),
    ("laser", LASER),
    ("odometry", ODOMETRY),
    ("motion", MOTION),
];

/// Selection of variants, in the order of the tables above.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Stress {
    Of(Vec<String>),
    /// All variants; the option's value was a file instead of a list.
    AllOf(PathBuf),
}

impl Stress {
    pub(in super::super) fn variants(&self) -> Vec<&'static Variant> {
        let is_meant = |group: &str, name: &str| match self {
            Stress::AllOf(_) => true,
            Stress::Of(names) => names
                .iter()
                .any(|known| known == "all" || known == group || known == name),
        };
        let groups = GROUPS.iter().flat_map(|&(group, variants)| {
            let of_group = variants.iter().map(move |variant| (group, variant));
            of_group.filter(|(group, variant)| is_meant(group, variant.name))
        });
        groups.map(|(_, variant)| variant).collect()
    }
}

impl FromStr for Stress {
    type Err = String;

    /// Parses a comma-separated list of names, or takes the path of an existing file.
    fn from_str(text: &str) -> Result<Self, String> {
        let variants = || GROUPS.iter().flat_map(|(_, variants)| variants.iter());
        let is_known = |name: &&str| {
            *name == "all"
                || GROUPS.iter().any(|(group, _)| group == name)
                || variants().any(|variant| variant.name == *name)
        };
        let names: Vec<&str> = text.split(',').map(str::trim).collect();
        let Some(unknown) = names.iter().find(|name| !is_known(name)) else {
            return Ok(Stress::Of(names.into_iter().map(str::to_owned).collect()));
        };
        let file = PathBuf::from(text);
        if file.exists() {
            return Ok(Stress::AllOf(file));
        }
        let names = variants().map(|variant| variant.name);
        let names = names.collect::<Vec<_>>().join(", ");
        Err(format!(
            "{unknown:?} is no variant; allowed are all, the groups map, laser, odometry and \
             motion, and {names}"
        ))
    }
}
