//! Reads the little-endian fields of a payload in order; errors name the field and its place.

use crate::SickError;

#[derive(Debug, Clone, Copy)]
pub(super) struct Fields<'a> {
    rest: &'a [u8],
    at: usize,
}

impl<'a> Fields<'a> {
    pub(super) fn new(payload: &'a [u8]) -> Self {
        Fields {
            rest: payload,
            at: 0,
        }
    }

    pub(super) fn take(
        &mut self,
        field: &'static str,
        count: usize,
    ) -> Result<&'a [u8], SickError> {
        let left = self.rest.len();
        let (head, rest) = self.rest.split_at_checked(count).ok_or(SickError::Short {
            field,
            offset: self.at,
            needed: count,
            left,
        })?;
        self.rest = rest;
        self.at += count;
        Ok(head)
    }

    pub(super) fn array<const N: usize>(
        &mut self,
        field: &'static str,
    ) -> Result<[u8; N], SickError> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(field, N)?);
        Ok(array)
    }

    pub(super) fn u8(&mut self, field: &'static str) -> Result<u8, SickError> {
        self.array(field).map(u8::from_le_bytes)
    }

    pub(super) fn u16(&mut self, field: &'static str) -> Result<u16, SickError> {
        self.array(field).map(u16::from_le_bytes)
    }

    /// Takes a u8 that `known` accepts; `allowed` lists the accepted values.
    pub(super) fn known<T>(
        &mut self,
        field: &'static str,
        known: impl FnOnce(u8) -> Option<T>,
        allowed: &'static str,
    ) -> Result<T, SickError> {
        let offset = self.at;
        let code = self.u8(field)?;
        known(code).ok_or_else(|| SickError::Field {
            field,
            offset,
            found: format!("{code:#04x}"),
            allowed,
        })
    }

    /// Skips to byte `at` of the payload, which must not be before the current one.
    pub(super) fn skip_to(&mut self, at: usize) -> Result<(), SickError> {
        self.take("what is skipped", at.saturating_sub(self.at))
            .map(drop)
    }

    pub(super) fn rest(self) -> &'a [u8] {
        self.rest
    }

    /// Checks that no bytes are left.
    pub(super) fn end(&self) -> Result<(), SickError> {
        if self.rest.is_empty() {
            return Ok(());
        }
        Err(SickError::Trailing {
            offset: self.at,
            left: self.rest.len(),
        })
    }
}
