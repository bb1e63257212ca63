//! Cases of a table: the full lists, the quick ones, and those of the options.

use crate::worlds::Kind;
use clap::ValueEnum;
use command_line::number;
use engine::taper::TaperShape;

const MAX_SIDE: u32 = 5000;

/// The tables that can be printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Table {
    Table1,
    Table2,
    Search,
}

/// Name of a value on the command line, which reports use as well.
pub(super) fn name_of(value: &impl ValueEnum) -> String {
    let name = value.to_possible_value();
    name.map_or_else(String::new, |name| name.get_name().to_owned())
}

/// Puts other cases in place of a table's own. Lists are separated by commas.
#[derive(Debug, Clone, Default, PartialEq, clap::Args)]
pub(super) struct Filter {
    /// Kinds of worlds
    #[arg(long, value_enum, value_delimiter = ',', value_name = "KIND")]
    pub(super) kind: Vec<Kind>,
    /// Sides of the square worlds in cells of 0.05 m, 32..=5000
    #[arg(long, value_delimiter = ',', value_name = "CELLS", value_parser = clap::value_parser!(u32).range(32..=i64::from(MAX_SIDE)))]
    pub(super) size: Vec<u32>,
    /// Boundary cells over free cells, per cent, 1..=300
    #[arg(long, value_delimiter = ',', value_name = "PERCENT", value_parser = number(1.0..=300.0, "per cent"))]
    pub(super) p_over_n: Vec<f64>,
    /// Standard deviation of a reading, per cent of its range, 0..=25
    #[arg(long, value_delimiter = ',', value_name = "PERCENT", value_parser = number(0.0..=25.0, "per cent"))]
    pub(super) noise: Vec<f64>,
    /// Beams over the whole turn; they must divide the headings
    #[arg(long, value_delimiter = ',', value_name = "COUNT", value_parser = clap::value_parser!(u32).range(1..=3600))]
    pub(super) beams: Vec<u32>,
    /// Headings a turn, a multiple of 8 from 8 to 3600
    #[arg(long, value_delimiter = ',', value_name = "COUNT", value_parser = parse_headings)]
    pub(super) headings: Vec<u32>,
    /// Tapers of the votes
    #[arg(long, value_enum, value_delimiter = ',', value_name = "TAPER")]
    pub(super) taper: Vec<TaperShape>,
}

fn parse_headings(text: &str) -> Result<u32, String> {
    let value: u32 = text
        .parse()
        .map_err(|_| format!("{text:?} is not a whole number"))?;
    if value.is_multiple_of(8) && (8..=3600).contains(&value) {
        return Ok(value);
    }
    Err(format!("{value} is not a multiple of 8 from 8 to 3600"))
}

/// A world, and the headings that are distinguished in it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Place {
    pub(super) kind: Kind,
    pub(super) size: u32,
    /// Per cent.
    pub(super) p_over_n: f64,
    pub(super) headings: u32,
}

/// What is seen there, and how it votes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sight {
    pub(super) beams: u32,
    pub(super) noise_percent: f64,
    pub(super) taper: TaperShape,
}

/// The places of a table, each with all that is seen there.
pub(super) type Cases = Vec<(Place, Vec<Sight>)>;

pub(super) fn cases(table: Table, quick: bool, filter: &Filter) -> Cases {
    let lists = filter.over(own(table, quick));
    let mut cases = Cases::new();
    for (&kind, &size) in pairs(&lists.kind, &lists.size) {
        for (&p_over_n, &headings) in pairs(&lists.p_over_n, &lists.headings) {
            let place = Place {
                kind,
                size,
                p_over_n,
                headings,
            };
            let sights = sights(&lists, headings, filter);
            if !sights.is_empty() {
                cases.push((place, sights));
            }
        }
    }
    cases
}

/// Beams and headings vary one at a time, unless both are asked for.
fn sights(lists: &Filter, headings: u32, asked: &Filter) -> Vec<Sight> {
    let vary_together = !asked.beams.is_empty() || !asked.headings.is_empty();
    let mut sights = Vec::new();
    for (i, &beams) in lists.beams.iter().enumerate() {
        if i > 0 && lists.headings.first() != Some(&headings) && !vary_together {
            continue;
        }
        for (&noise_percent, &taper) in pairs(&lists.noise, &lists.taper) {
            sights.push(Sight {
                beams,
                noise_percent,
                taper,
            });
        }
    }
    sights
}

fn pairs<'a, A, B>(a: &'a [A], b: &'a [B]) -> impl Iterator<Item = (&'a A, &'a B)> {
    a.iter().flat_map(move |a| b.iter().map(move |b| (a, b)))
}

impl Filter {
    /// The own lists, but for those that this one has.
    fn over(&self, own: Filter) -> Filter {
        fn or<T: Clone>(asked: &[T], own: Vec<T>) -> Vec<T> {
            match asked {
                [] => own,
                asked => asked.to_vec(),
            }
        }
        Filter {
            kind: or(&self.kind, own.kind),
            size: or(&self.size, own.size),
            p_over_n: or(&self.p_over_n, own.p_over_n),
            noise: or(&self.noise, own.noise),
            beams: or(&self.beams, own.beams),
            headings: or(&self.headings, own.headings),
            taper: or(&self.taper, own.taper),
        }
    }
}

fn own(table: Table, quick: bool) -> Filter {
    let common = Filter {
        kind: vec![Kind::Rooms],
        size: vec![1200],
        p_over_n: vec![10.0, 25.0, 50.0, 100.0, 120.0],
        noise: vec![10.0],
        beams: vec![180, 8],
        headings: vec![360],
        taper: vec![TaperShape::Trapezoid],
    };
    let kind = vec![Kind::Rooms, Kind::Corridors, Kind::Boxes];
    let noise = vec![2.0, 10.0];
    match (table, quick) {
        (Table::Table1, false) => Filter {
            p_over_n: vec![5.0, 10.0, 25.0, 50.0, 100.0, 120.0],
            noise: vec![5.0, 10.0, 15.0, 20.0, 25.0],
            ..common
        },
        (Table::Table1, true) => Filter {
            p_over_n: vec![5.0, 25.0, 100.0],
            ..common
        },
        (Table::Table2, false) => Filter {
            size: vec![100, 200, 1200],
            ..common
        },
        (Table::Table2, true) => Filter {
            size: vec![100],
            p_over_n: vec![10.0, 50.0, 120.0],
            beams: vec![180],
            ..common
        },
        (Table::Search, false) => Filter {
            kind,
            size: vec![200, 1200, 4000, 5000],
            p_over_n: vec![5.0, 10.0, 25.0, 50.0],
            noise,
            headings: vec![360, 720],
            taper: vec![TaperShape::Trapezoid, TaperShape::Box],
            ..common
        },
        (Table::Search, true) => Filter {
            kind,
            p_over_n: vec![5.0],
            noise,
            beams: vec![180],
            ..common
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn table1_has_the_papers_ratios_and_noise() {
        let cases = cases(Table::Table1, false, &Filter::default());
        assert_eq!(cases.len(), 6);
        assert!(
            cases
                .iter()
                .all(|(place, sights)| place.size == 1200 && sights.len() == 10)
        );
    }

    #[test]
    fn beams_and_headings_vary_one_at_a_time() {
        let cases = cases(Table::Search, false, &Filter::default());
        let seen = |headings, beams| {
            let places = cases.iter().filter(|(place, _)| place.headings == headings);
            places
                .flat_map(|(_, sights)| sights)
                .any(|sight| sight.beams == beams)
        };
        assert!(seen(360, 180) && seen(360, 8) && seen(720, 180) && !seen(720, 8));
    }

    #[test]
    fn what_is_asked_for_takes_the_place_of_the_own() {
        let asked = Filter {
            kind: vec![Kind::Boxes],
            beams: vec![8],
            headings: vec![720],
            ..Filter::default()
        };
        let cases = cases(Table::Search, true, &asked);
        let (place, sights) = &cases[0];
        assert_eq!((place.kind, place.headings), (Kind::Boxes, 720));
        assert!(sights.iter().all(|sight| sight.beams == 8) && !sights.is_empty());
    }
}
