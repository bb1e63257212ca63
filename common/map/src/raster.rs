//! A decoded image, before conversion to occupancy.
//!
//! Pixels have 16 bits regardless of the file, like in the image library of `map_server`, so that
//! every threshold separates the same values.

/// Full brightness or opacity of a channel.
pub(crate) const FULL: u16 = u16::MAX;

pub(crate) struct Raster {
    pub(crate) width: u32,
    pub(crate) height: u32,
    /// Number of channels: 1 for grey, 3 for red, green and blue, and one more for alpha.
    pub(crate) channels: usize,
    pub(crate) samples: Samples,
}

pub(crate) enum Samples {
    /// Maximum 255.
    Eight(Vec<u8>),
    /// Maximum 65535.
    Sixteen(Vec<u16>),
}

/// A pixel in 16-bit steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Pixel {
    /// Red, green and blue; equal for grey.
    pub(crate) colour: [u16; 3],
    /// Opacity, if the image has an alpha channel.
    pub(crate) alpha: Option<u16>,
}

impl Raster {
    /// Returns the pixels of a row from the left; `y` counts from the top.
    pub(crate) fn row(&self, y: u32) -> impl Iterator<Item = Pixel> {
        let start = y as usize * self.width as usize;
        (start..start + self.width as usize).map(|index| self.pixel(index))
    }

    fn pixel(&self, index: usize) -> Pixel {
        let first = index * self.channels;
        let sample = |channel: usize| self.samples.get(first + channel);
        Pixel {
            colour: match self.channels {
                1 | 2 => [sample(0); 3],
                _ => [sample(0), sample(1), sample(2)],
            },
            alpha: matches!(self.channels, 2 | 4).then(|| sample(self.channels - 1)),
        }
    }
}

impl Samples {
    /// Decoders return as many samples as the size requires, so the index is valid.
    fn get(&self, index: usize) -> u16 {
        match self {
            Samples::Eight(samples) => u16::from(samples[index]) * 257,
            Samples::Sixteen(samples) => samples[index],
        }
    }
}
