//! Furniture, boxes and rubble: random pieces until the boundary has the requested size.

use std::f64::consts::FRAC_PI_2;

use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;

use super::canvas::{Canvas, Rect};

/// Adds pieces, turned at random or along the axes, until `p_over_n` is reached.
pub(super) fn add(canvas: &mut Canvas, turned: bool, p_over_n: f64, rng: &mut Xoshiro256PlusPlus) {
    // Smaller pieces have more boundary per area.
    let (least, most) = (
        (0.3 / p_over_n).max(1.0),
        (1.2 / p_over_n).clamp(1.0, canvas.width.min(canvas.height) as f64 / 4.0),
    );
    // Overlapping pieces may keep the ratio from rising.
    for _ in 0..4 * canvas.width * canvas.height {
        let missing = canvas.missing(p_over_n);
        if missing < 1.0 {
            return;
        }
        // A piece of side s has 4s boundary cells, so the last ones must be small.
        let largest = most.min((missing / 8.0).max(1.0));
        let mut side = || {
            rng.random_range(least.min(largest)..=largest)
                .round()
                .max(1.0)
        };
        let (width, height) = (side(), side());
        put(canvas, (width, height), turned, rng);
    }
}

fn put(
    canvas: &mut Canvas,
    (width, height): (f64, f64),
    turned: bool,
    rng: &mut Xoshiro256PlusPlus,
) {
    let x = rng.random_range(1..canvas.width - 1);
    let y = rng.random_range(1..canvas.height - 1);
    if turned && width.max(height) > 2.0 {
        let angle = rng.random_range(0.0..FRAC_PI_2);
        put_turned(canvas, (x as f64, y as f64), (width, height), angle);
    } else {
        canvas.fill(Rect::new(x, y, width as usize, height as usize));
    }
}

/// Fills the cells with centres in a rotated rectangle.
fn put_turned(canvas: &mut Canvas, centre: (f64, f64), (width, height): (f64, f64), angle: f64) {
    let (sin, cos) = angle.sin_cos();
    let reach = width.hypot(height) / 2.0;
    let span = |at: f64, limit: usize| {
        (at - reach).max(0.0) as usize..((at + reach).ceil() as usize + 1).min(limit)
    };
    for y in span(centre.1, canvas.height) {
        for x in span(centre.0, canvas.width) {
            let (dx, dy) = (x as f64 - centre.0, y as f64 - centre.1);
            let (along, across) = (dx * cos + dy * sin, dy * cos - dx * sin);
            if 2.0 * along.abs() <= width && 2.0 * across.abs() <= height {
                canvas.occupy(y * canvas.width + x);
            }
        }
    }
}
