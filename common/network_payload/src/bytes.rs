//! Items in postcard format: a count, then one after the other.
//!
//! Bytes are copied as a block, with the same result as one by one, so that a map of millions of
//! cells takes little time.

use std::any::TypeId;

use bytemuck::{Pod, cast_slice};
use serde::Serialize;
use serde::de::DeserializeOwned;

pub(crate) fn append<I: Pod + Serialize>(
    items: &[I],
    to: Vec<u8>,
) -> Result<Vec<u8>, postcard::Error> {
    if TypeId::of::<I>() != TypeId::of::<u8>() {
        return postcard::to_extend(items, to);
    }
    let mut to = postcard::to_extend(&items.len(), to)?;
    to.extend_from_slice(cast_slice(items));
    Ok(to)
}

/// Splits `bytes` into the items at its start and the rest.
pub(crate) fn take<I: Pod + DeserializeOwned>(
    bytes: &[u8],
) -> Result<(Vec<I>, &[u8]), postcard::Error> {
    if TypeId::of::<I>() != TypeId::of::<u8>() {
        return postcard::take_from_bytes(bytes);
    }
    let (block, rest) = postcard::take_from_bytes::<&[u8]>(bytes)?;
    Ok((cast_slice(block).to_vec(), rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_block_of_bytes_is_a_sequence_of_bytes() {
        let items: Vec<u8> = (0..=255).collect();
        let bytes = append(&items, vec![7]).unwrap();
        assert_eq!(bytes[1..], postcard::to_stdvec(&items).unwrap());
        let (back, rest) = take::<u8>(&bytes[1..]).unwrap();
        assert_eq!((back, rest), (items, &[][..]));
    }

    #[test]
    fn a_count_that_the_bytes_do_not_bring_along_is_refused() {
        let claim = postcard::to_stdvec(&(u64::MAX >> 1)).unwrap();
        assert!(take::<u8>(&claim).is_err());
        assert!(take::<u16>(&claim).is_err());
        assert!(take::<messages::Hypothesis>(&claim).is_err());
    }
}
