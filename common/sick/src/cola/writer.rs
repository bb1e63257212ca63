//! Appends fields to a content, in either encoding; the counterpart of `Cursor`.

use super::Encoding;

#[derive(Debug)]
pub(crate) struct Writer<'a> {
    out: &'a mut Vec<u8>,
    encoding: Encoding,
}

impl<'a> Writer<'a> {
    /// Starts a content with fields: the command's letters and its name.
    pub(crate) fn command(
        encoding: Encoding,
        letters: &[u8; 3],
        name: &[u8],
        out: &'a mut Vec<u8>,
    ) -> Self {
        Writer::bare(letters, name, out);
        if encoding == Encoding::Binary {
            out.push(b' ');
        }
        Writer { out, encoding }
    }

    /// Appends a content without fields.
    pub(crate) fn bare(letters: &[u8; 3], name: &[u8], out: &mut Vec<u8>) {
        out.extend_from_slice(letters);
        out.push(b' ');
        out.extend_from_slice(name);
    }

    /// Appends the answer that rejects a command.
    pub(crate) fn fault(encoding: Encoding, code: u16, out: &'a mut Vec<u8>) {
        out.extend_from_slice(b"sFA");
        Writer { out, encoding }.u16(code);
    }

    fn word(&mut self, value: u32) {
        self.out.extend_from_slice(format!(" {value:X}").as_bytes());
    }

    pub(crate) fn u8(&mut self, value: u8) {
        match self.encoding {
            Encoding::Binary => self.out.push(value),
            Encoding::Text => self.word(value.into()),
        }
    }

    pub(crate) fn u16(&mut self, value: u16) {
        match self.encoding {
            Encoding::Binary => self.out.extend_from_slice(&value.to_be_bytes()),
            Encoding::Text => self.word(value.into()),
        }
    }

    pub(crate) fn u32(&mut self, value: u32) {
        match self.encoding {
            Encoding::Binary => self.out.extend_from_slice(&value.to_be_bytes()),
            Encoding::Text => self.word(value),
        }
    }

    pub(crate) fn i32(&mut self, value: i32) {
        self.u32(value.cast_unsigned());
    }

    pub(crate) fn f32(&mut self, value: f32) {
        self.u32(value.to_bits());
    }

    pub(crate) fn bool(&mut self, value: bool) {
        self.u8(value.into());
    }

    pub(crate) fn flag(&mut self, value: bool) {
        self.u16(value.into());
    }

    pub(crate) fn pair(&mut self, values: [u8; 2]) {
        values.into_iter().for_each(|value| self.u8(value));
    }

    /// Appends characters; the reader knows their number.
    pub(crate) fn characters(&mut self, characters: &[u8]) {
        if self.encoding == Encoding::Text {
            self.out.push(b' ');
        }
        self.out.extend_from_slice(characters);
    }
}
