//! Sums of weighted bits, side by side for 512 of them.
//!
//! Numbers are kept as planes: plane `j` holds bit `j` of all sums. Bits are
//! added three at a time with carry-save adders, so that adding a row costs two
//! or three logic operations a plane on average.

/// 512 bits, one for each heading of a chunk.
pub(crate) type Row = [u64; 8];

/// A row without bits.
pub(crate) const EMPTY: Row = [0; 8];

/// Planes of a sum: sums fit 16 bits.
pub(crate) const PLANES: usize = 16;

/// Sums of 512 numbers, by plane.
pub(crate) type Planes = [Row; PLANES];

/// Applies an operation word by word.
#[inline(always)]
fn zip(a: Row, b: Row, op: impl Fn(u64, u64) -> u64) -> Row {
    std::array::from_fn(|i| op(a[i], b[i]))
}

/// Sum and carry of three bits.
#[inline(always)]
fn full_adder(a: Row, b: Row, c: Row) -> (Row, Row) {
    let sum = std::array::from_fn(|i| a[i] ^ b[i] ^ c[i]);
    let carry = std::array::from_fn(|i| (a[i] & b[i]) | (c[i] & (a[i] | b[i])));
    (sum, carry)
}

#[inline(always)]
pub(crate) fn or(a: Row, b: Row) -> Row {
    zip(a, b, |a, b| a | b)
}

/// A sum under way: each plane holds up to two rows that are not yet joined.
#[derive(Debug, Clone)]
pub(crate) struct BitSum {
    counts: [u8; PLANES],
    rows: [[Row; 3]; PLANES],
}

impl BitSum {
    pub(crate) fn new() -> Self {
        BitSum {
            counts: [0; PLANES],
            rows: [[EMPTY; 3]; PLANES],
        }
    }

    /// Adds `weight` where a bit is set. The sums must fit 16 bits.
    #[inline(always)]
    pub(crate) fn add(&mut self, weight: u16, row: Row) {
        let mut weight = weight;
        while weight != 0 {
            let plane = weight.trailing_zeros() as usize;
            self.push(plane, row);
            weight &= weight - 1;
        }
    }

    #[inline(always)]
    fn push(&mut self, plane: usize, row: Row) {
        let (mut plane, mut row) = (plane, row);
        while plane < PLANES {
            let count = self.counts[plane] as usize;
            if count < 2 {
                self.rows[plane][count] = row;
                self.counts[plane] += 1;
                return;
            }
            let (sum, carry) = full_adder(self.rows[plane][0], self.rows[plane][1], row);
            self.rows[plane][0] = sum;
            self.counts[plane] = 1;
            (plane, row) = (plane + 1, carry);
        }
    }

    /// The sums; starts anew.
    #[inline(always)]
    pub(crate) fn take(&mut self) -> Planes {
        let mut carry = EMPTY;
        let planes = std::array::from_fn(|plane| {
            let [a, b, _] = self.rows[plane];
            let (a, b) = match self.counts[plane] {
                0 => (EMPTY, EMPTY),
                1 => (a, EMPTY),
                _ => (a, b),
            };
            let (sum, next) = full_adder(a, b, carry);
            carry = next;
            sum
        });
        self.counts = [0; PLANES];
        planes
    }
}

/// Adds sums to sums.
#[inline(always)]
pub(crate) fn add(sums: &mut Planes, others: &Planes) {
    let mut carry = EMPTY;
    for (sum, &other) in sums.iter_mut().zip(others) {
        (*sum, carry) = full_adder(*sum, other, carry);
    }
}

/// Moves every number `by` places down, 0 to 63.
#[inline(always)]
pub(crate) fn shift_down(sums: &mut Planes, by: u32) {
    if by == 0 {
        return;
    }
    for row in sums {
        for i in 0..8 {
            let next = if i < 7 { row[i + 1] << (64 - by) } else { 0 };
            row[i] = row[i] >> by | next;
        }
    }
}

/// The greatest of the numbers that `among` selects.
#[inline(always)]
pub(crate) fn greatest(sums: &Planes, among: Row) -> u16 {
    let mut candidates = among;
    let mut value = 0;
    for plane in (0..PLANES).rev() {
        let higher = zip(candidates, sums[plane], |a, b| a & b);
        if higher != EMPTY {
            candidates = higher;
            value |= 1 << plane;
        }
    }
    value
}

/// Where the numbers that `among` selects are at least `least`.
#[inline(always)]
pub(crate) fn at_least(sums: &Planes, least: u16, among: Row) -> Row {
    // Equal so far from the highest plane down, or greater already.
    let (mut equal, mut greater) = (among, EMPTY);
    for plane in (0..PLANES).rev() {
        let bits = sums[plane];
        if least >> plane & 1 == 1 {
            equal = zip(equal, bits, |equal, bits| equal & bits);
        } else {
            greater = or(greater, zip(equal, bits, |equal, bits| equal & bits));
            equal = zip(equal, bits, |equal, bits| equal & !bits);
        }
    }
    or(greater, equal)
}

/// Number `i` of the sums.
pub(crate) fn number(sums: &Planes, i: usize) -> u16 {
    let bit = |row: &Row| (row[i / 64] >> (i % 64) & 1) as u16;
    sums.iter()
        .enumerate()
        .map(|(plane, row)| bit(row) << plane)
        .sum()
}

/// The places of the set bits, ascending.
pub(crate) fn ones(row: Row) -> impl Iterator<Item = usize> {
    row.into_iter().enumerate().flat_map(|(i, word)| {
        let mut word = word;
        std::iter::from_fn(move || {
            let bit = word.trailing_zeros() as usize;
            (word != 0).then(|| {
                word &= word - 1;
                64 * i + bit
            })
        })
    })
}

#[cfg(test)]
mod tests {
    use proptest::collection::vec;
    use proptest::prelude::*;

    use super::*;

    fn numbers(sums: &Planes) -> Vec<u16> {
        (0..512).map(|i| number(sums, i)).collect()
    }

    proptest! {
        #[test]
        fn sums_are_those_of_plain_numbers(
            rows in vec((0u16..300, any::<[u64; 8]>()), 0..60),
            others in vec((0u16..300, any::<[u64; 8]>()), 0..60),
            by in 0u32..8, least in 0u16..20_000, among in any::<[u64; 8]>(),
        ) {
            let mut plain = vec![0u16; 512];
            let mut both = Vec::new();
            for rows in [&rows, &others] {
                let mut sum = BitSum::new();
                for &(weight, row) in rows {
                    sum.add(weight, row);
                    ones(row).for_each(|i| plain[i] += weight);
                }
                both.push(sum.take());
                prop_assert_eq!(numbers(&sum.take()), vec![0; 512], "starts anew");
            }
            let mut sums = both[0];
            add(&mut sums, &both[1]);
            prop_assert_eq!(&numbers(&sums), &plain);

            let selected: Vec<usize> = ones(among).collect();
            prop_assert_eq!(greatest(&sums, among), selected.iter().map(|&i| plain[i]).max().unwrap_or(0));
            let above: Vec<usize> = selected.into_iter().filter(|&i| plain[i] >= least).collect();
            prop_assert_eq!(ones(at_least(&sums, least, among)).collect::<Vec<_>>(), above);

            shift_down(&mut sums, by);
            plain.rotate_left(by as usize);
            plain[512 - by as usize..].fill(0);
            prop_assert_eq!(numbers(&sums), plain);
        }
    }
}
