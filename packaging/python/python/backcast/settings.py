"""The engine's settings, which are keywords of Localizer and Tracker.

They are the options of `backcast locate` and of the tracker, with underscores: the same
names, defaults and limits. A value out of range is a ValueError that says what is allowed.
"""

from collections.abc import Iterable
from typing import Literal, TypedDict

__all__ = ["Settings", "TrackerSettings"]


class Settings(TypedDict, total=False):
    """How scans are located. Each can be left out."""

    # Occupancy from which a cell is occupied, per cent, 1..=100; the default is that of map
    # savers. Default: 65.
    occupied_from: int

    # Occupancy up to which a cell is free, per cent, 0..=99; what lies between counts as
    # unknown. Default: 25.
    free_to: int

    # Unknown cells block rays and cannot hold the robot. Real maps are half known, so by
    # default they do not block, and those near free cells can. Default: False.
    unknown_blocks: bool

    # Headings a turn, a multiple of 8 from 8 to 3600. Default: 360.
    headings: int

    # Threads of a search, 1..=64; the answer is the same with any number. Default: 1.
    threads: int

    # Most beams that vote, 1..=65535; longer scans are thinned by arc. Default: 180.
    max_beams: int

    # Arc at the reading from which a beam counts fully, metres, 0..=2; nearer ones count by the
    # arc that they cover. 0 weighs all the same. Default: 0.2.
    beam_arc_m: float

    # How votes fall off in front of a reading and behind it. "gaussian": exp(-d²/2), Eq. 1 of
    # the paper; "linear": Falls evenly to zero at 2σ; "trapezoid": Flat to σ, then evenly to
    # zero at 2.5σ; "box": Flat to 2σ, then nothing. Default: "trapezoid".
    taper: Literal["gaussian", "linear", "trapezoid", "box"]

    # Standard deviation of a reading at no distance, metres, 0..=2; the taper is never narrower
    # than one cell. Default: 0.1.
    sigma_m: float

    # What is added to the standard deviation for each metre of range, 0..=0.25. Default: 0.01.
    sigma_per_m: float

    # Poses with at least this share of the best pose's votes are collected, 0..=1; lower shares
    # show more alternatives and take longer. On a map with fewer blocks of 8 x 8 cells than
    # candidates, at most 0.85. Default: 1.0.
    floor_share: float

    # Most poses that are collected, 1..=1000000; the floor rises until they fit. Default:
    # 65536.
    max_votes: int

    # Distinct poses that are wanted, 0..=1000: where fewer stand above the floor, the most
    # promising ones below are added. Where half of them have half the best one's votes, up to
    # four times as many that have are added. Default: 64.
    candidates: int

    # A search of unknown headings ends with the best that it found, and says what it may have
    # missed, once it has taken so much work, millions of steps, 0 to 10⁹; 0 is without end. A
    # step takes about a nanosecond of one processor of 2 GHz, but steps are counted and not
    # timed: on one thread the same scan always ends alike. Default: None.
    work_limit: int | None

    # Of the unknown cells that do not block, only those can hold the laser whose middle lies at
    # most so far from that of a free cell, metres, 0..=1000: a map ends where the robot that
    # made it could not see, and not far behind that nothing can be found. Default: 1.
    unknown_reach: float

    # Only cells at least so far from the middle of every occupied cell can hold the laser,
    # metres, 0..=5: the distance from the laser to the robot's nearest side. Default: 0.
    robot_radius: float

    # Only poses in this polygon are sought: two corners of an upright rectangle, or all of any
    # other, each (x, y) in metres in the map. Default: None.
    region: Iterable[Iterable[float]] | None

    # Only headings from the first counter-clockwise to the second are sought: (from, to),
    # radians in the map, each within a turn. Default: None.
    headings_within: Iterable[float] | None

    # Finer maps are searched in cells of at most this side, and what is found is refined on the
    # map as it is, metres, 0..=1; 0 searches each map as it is. Default: 0.05.
    search_cell: float

    # A map is refused whose preparation for searches of unknown headings would take more memory
    # than this, about, megabytes of 10⁶ bytes, 1..=1000000; by default none is.
    memory_limit: int | None

    # Folder that keeps prepared maps, so that the same map with the same settings is read the next
    # time: one that only this user can use; "user" for ~/.cache/backcast. Default: "off".
    index_cache: str

    # Size of that folder, megabytes of 10⁶ bytes, 1..=1000000; what was used least lately goes.
    # Default: 2000.
    index_cache_limit: int

    # Poses within this distance and same_place_deg are one place, metres, 0..=2. Default: 0.5.
    same_place_m: float

    # Poses within this angle and same_place_m are one place, degrees, 0..=180. Default: 10.
    same_place_deg: float

    # Most places that are reported, 1..=1000. Default: 64.
    max_hypotheses: int

    # Candidates that are refined, 1..=1000: the first of the votes, and up to four times as
    # many as long as they have half the best one's votes. Default: 64.
    max_candidates: int

    # Votes within this distance and candidate_deg are refined together, metres, 0..=2. Default:
    # 0.3.
    candidate_m: float

    # Votes within this angle and candidate_m are refined together, degrees, 0..=180. Default:
    # 6.5.
    candidate_deg: float

    # Standard deviation of an end point around the obstacle that it belongs to, map errors
    # included, metres, 0..=2; at least fit_sigma_cells. Default: 0.1.
    fit_sigma_m: float

    # The same in cells of the map, 0.1..=10: coarse maps are less exact. Default: 2.
    fit_sigma_cells: float

    # What a beam that passes through an obstacle loses of its full score, 0..=1. It passes
    # through where it reads three standard deviations more than the way to the first obstacle.
    # Default: 0.15.
    through_penalty: float

    # The score of a beam that ends behind unknown space, 0..=1; half of it if it passes through
    # an obstacle there. Default: 0.3.
    unknown_score: float

    # A map that is drawn leaves out what its author did not know: so much the true place may
    # score worse there than another, 0..=1. A map counts as drawn by how straight its walls
    # are. Default: 0.15.
    drawn_doubt: float

    # Score from which nothing but the lead over other places decides, 0..=1; a best place with a
    # lower score needs a larger lead: where the scan fits badly, the true place may not be on the
    # map. This is for a scan that sees six pieces, see piece_doubt. Default: 0.73.
    sure_score: float

    # Fall of the sure score with the natural logarithm of the number of pieces of the world that
    # a scan sees, 0..=1, since many pieces rarely fit together by chance. A new piece begins
    # where neighbouring readings jump. Default: 0.14.
    piece_doubt: float

    # Doubt because of beams that pass through obstacles or end behind unknown space at the best
    # place: the score that is compared with the sure score is lowered by this times their share,
    # 0..=1. It does not change which place is best, see through_penalty. Default: 0.7.
    through_doubt: float

    # Number of beams whose scores decide as they are, 1..=1000: with fewer, scores vary more by
    # chance, and a lead counts for less by the square root of what is missing. Default: 100.
    sure_beams: int

    # Increase of the lead, less what the score lacks of the sure score, that makes it less likely
    # by a factor of e that the best place is wrong, 0.001..=1. The lead is measured relative to
    # what is missing of a perfect score: (best - other) / √(1.1 - best). Default: 0.09.
    doubt_scale: float

    # Lead that makes another place less likely than the best by a factor of e, 0.001..=1.
    # Default: 0.025.
    lead_scale: float

    # Probability from which the best place is unique, 0..=1. Default: 0.85.
    unique_from: float

    # Minimum score of the best place; below it the verdict is PoorFit: the scan may not be of
    # this map, 0..=1. Default: 0.6.
    least_score: float


class TrackerSettings(Settings, total=False):
    """The same, and how the robot is followed. Each can be left out."""

    # How much odometry errs, against what is usual: a scale of its standard deviations,
    # 0.1..=10. Default: 1.
    odometry_error: float

    # A key scan is taken so far from the one before, metres, 0..=2: places are weighed against
    # each other at key scans only, for the errors of a map repeat from one scan to the next.
    # Default: 0.4.
    key_m: float

    # Or turned so far, degrees, 0..=180. Default: 20.
    key_deg: float

    # When a tracker that knows nothing yet believes a place. "confirm": When several key scans
    # agree: the robot has to drive or turn; "believe": When the verdict on one scan is `Unique`:
    # the robot may stand. Default: "confirm".
    start: Literal["confirm", "believe"]

    # The most that one key scan says for or against a place, natural logarithm of odds, 0..=100:
    # what no model explains happens this often. Default: 1.5.
    scan_cap: float

    # Probability at which a place is the only one, 0..=1. Default: 0.94.
    sure: float

    # By so much the score of a scan may fall below the mean of those before it before the pose
    # is doubted, 0..=1. Default: 0.25.
    doubt_fall: float

    # When the score falls by so much below the mean, the fit is tried again from headings
    # around the prediction, 0..=1: odometry errs by tens of degrees at times. Default: 0.08.
    restart_fall: float

    # Added to the stamps of odometry, seconds, -1..=1: above zero where odometry leads the
    # laser. Default: 0.
    odometry_delay_s: float

    # Of which beam a scan's stamp is. "first": The first, as `sensor_msgs/LaserScan` defines
    # it; "middle": The one in the middle; "last": The last. Default: "first".
    scan_stamp: Literal["first", "middle", "last"]

    # Whether the motion within a scan is taken out, where odometry tells it. Default: True.
    deskew: bool
