//! Creates and judges one variant of a drive.

use engine::tracking::TrackingConfig;
use offline::{Accepted, Options, Progress, Session, World};
use recording::Recording;

use super::super::drive::Moment;
use super::super::follow::{self, Followed};
use super::super::run::{Run, Said};
use super::super::starts::{self, Starts};
use super::material::Material;
use super::material::{Change, Means};
use super::variants::{Variant, Way};

pub(super) struct Recorded<'a> {
    pub(super) recording: &'a Recording,
    pub(super) options: &'a Options,
    pub(super) material: &'a Material,
    pub(super) moments: &'a [Moment],
    pub(super) progress: &'a Progress,
}

pub(super) struct Trial {
    pub(super) starts: Starts,
    pub(super) followed: Followed,
    pub(super) first_wrong: Option<Wrong>,
    pub(super) map: ::map::OccupancyGrid,
}

/// The first moment that was Unique and wrong.
pub(super) struct Wrong {
    /// Scan of the start; `None` if the drive was followed from the truth.
    pub(super) start: Option<usize>,
    pub(super) scan: usize,
    /// Error in metres and degrees; infinite if no pose is right.
    pub(super) off: (f64, f64),
    /// Moments and results up to this one.
    pub(super) moments: Vec<Moment>,
    pub(super) said: Vec<Said>,
}

impl Recorded<'_> {
    /// Creates and judges a variant, or returns the reason why it does not apply.
    pub(super) fn judge(
        &self,
        session: &mut Session<'_>,
        variant: &Variant,
        mut means: Means<'_>,
        (count, config): (u32, TrackingConfig),
    ) -> anyhow::Result<Change<Trial>> {
        let mut material = self.material.clone();
        let mut moments = self.moments.to_vec();
        let changed = match variant.way {
            Way::Undisturbed => Ok(()),
            Way::Drive(change) => change(&mut material, &mut means),
            Way::Odometry(change) => {
                change(&mut material.odometry);
                moments = material.with_odometry(session, &moments)?;
                Ok(())
            }
            Way::Moments(change) => change(&mut moments),
        };
        if let Err(reason) = changed {
            return Ok(Err(reason));
        }
        let judge = |session: &Session<'_>, moments: &[Moment]| {
            let drive = (&material, moments);
            judge(session.world()?, variant, drive, (count, config)).map(Ok)
        };
        if !matches!(variant.way, Way::Drive(_)) {
            return judge(session, &moments);
        }
        let mut accepted = Accepted::default();
        let how = (self.progress, &mut accepted);
        if material.map == self.material.map {
            let moments = material.search(session, how)?;
            return judge(session, &moments);
        }
        let mut session = Session::open(self.recording, self.options, Some(&material.map))?;
        let moments = material.search(&mut session, how)?;
        judge(&session, &moments)
    }
}

fn judge(
    world: &World,
    variant: &Variant,
    (material, moments): (&Material, &[Moment]),
    (count, config): (u32, TrackingConfig),
) -> anyhow::Result<Trial> {
    let within = moments.partition_point(|moment| moment.gone_m <= material.starts_until_m);
    let chosen = starts::choose(&moments[..within], count);
    let starts = starts::evaluate(world, moments, &chosen, config)?;
    let followed = match material.is_nowhere {
        // Without a truth there is no pose to start from.
        true => Followed::default(),
        false => follow::evaluate(world, moments, config, variant.puts_back())?,
    };
    let mut first_wrong = None;
    if let Some(&(start, scan, _)) = starts.wrong.first() {
        let mut run = Run::new(world, moments, config);
        let mut said = Vec::new();
        for (i, moment) in moments.iter().enumerate().take(scan + 1).skip(start) {
            said.push(run.take(i, moment.moved.filter(|_| i > start))?);
        }
        first_wrong = Some(Wrong {
            start: Some(start),
            scan,
            off: said.last().and_then(|said| said.off).unwrap_or_default(),
            moments: moments[start..=scan].to_vec(),
            said,
        });
    } else if let Some(at) = followed.said.iter().position(|(_, said)| said.is_wrong()) {
        let until = &followed.said[..=at];
        let (first, (scan, said)) = (until[0].0, until[at]);
        first_wrong = Some(Wrong {
            start: None,
            scan,
            off: said.off.unwrap_or_default(),
            moments: moments[first..=scan].to_vec(),
            said: until.iter().map(|&(_, said)| said).collect(),
        });
    }
    Ok(Trial {
        starts,
        followed,
        first_wrong,
        map: material.map.clone(),
    })
}
