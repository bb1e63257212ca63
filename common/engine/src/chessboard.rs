//! Chessboard distances: the larger of the distances along x and y.

/// Lowers each inner cell to the minimum, over all cells, of that cell's value plus its chessboard
/// distance, saturated at 255. The outermost rows and columns take part but are not changed; all of
/// them must have the same value.
///
/// Two passes are exact, each from the four neighbours already visited, since each step may go in
/// any of eight directions. With different values on the border the shortest path might run along
/// the border, which the passes do not follow.
pub fn spread(cells: &mut [u8], columns: usize) {
    if columns == 0 {
        return;
    }
    let inner = |row: usize| row * columns + 1..(row + 1) * columns - 1;
    let rows = 1..(cells.len() / columns).saturating_sub(1);
    for i in rows.clone().flat_map(inner) {
        let before = [i - 1, i - columns - 1, i - columns, i - columns + 1];
        lower(cells, i, before);
    }
    for i in rows.rev().flat_map(|row| inner(row).rev()) {
        let behind = [i + 1, i + columns + 1, i + columns, i + columns - 1];
        lower(cells, i, behind);
    }
}

fn lower(cells: &mut [u8], i: usize, near: [usize; 4]) {
    for near in near {
        cells[i] = cells[i].min(cells[near].saturating_add(1));
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn each_cell_has_its_distance_from_the_nearest_lower_one(
            columns in 0usize..9, rows in 0usize..9, values in prop::collection::vec(
                prop_oneof![4 => Just(255u8), 1 => 0u8..4, 1 => 250u8..=255], 81,
            ), margin in prop_oneof![Just(255u8), 0u8..9],
        ) {
            let is_outermost = |i: usize| {
                let (x, y) = (i % columns, i / columns);
                x == 0 || y == 0 || x == columns - 1 || y == rows - 1
            };
            let value = |i: usize| if is_outermost(i) { margin } else { values[i] };
            let before: Vec<u8> = (0..columns * rows).map(value).collect();
            let mut after = before.clone();
            spread(&mut after, columns);
            for (i, &found) in after.iter().enumerate() {
                let (x, y) = (i % columns, i / columns);
                let away = |j: usize| (j % columns).abs_diff(x).max((j / columns).abs_diff(y));
                let through = |j: usize| usize::from(before[j]) + away(j);
                let nearest = (0..before.len()).map(through).min();
                let expected = if is_outermost(i) { before[i] } else { nearest.unwrap().min(255) as u8 };
                prop_assert_eq!(found, expected);
            }
        }
    }
}
