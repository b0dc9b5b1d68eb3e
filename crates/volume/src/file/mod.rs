//! Files of samples: OpenVDB and NRRD.
//!
//! What is said of [mesh files](crate::read) holds here: whatever the bytes are, there is a volume or an error, and what is
//! allocated was allowed before.

mod blosc;
mod nrrd;
mod vdb_read;
mod vdb_write;

use crate::volume::{Volume, VolumeError};

/// The format of a file of samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VolumeFormat {
    /// OpenVDB (Museth 2013), `.vdb`: one grid of single precision, sparse. Blender and Houdini open it.
    Vdb,
    /// NRRD (Kindlmann), `.nrrd`: a text of a few lines, and all samples.
    Nrrd,
}

impl VolumeFormat {
    /// All, with the ends of their names.
    pub const ALL: [(VolumeFormat, &'static str); 2] =
        [(VolumeFormat::Vdb, "vdb"), (VolumeFormat::Nrrd, "nrrd")];

    /// The format of a file's name, by what stands behind its last dot, in capitals or not.
    ///
    /// # Errors
    /// Another end, or none.
    pub fn of_name(name: &str) -> Result<VolumeFormat, FileError> {
        let end = name.rsplit_once('.').map_or("", |(_, end)| end);
        (VolumeFormat::ALL.iter())
            .find(|(_, e)| end.eq_ignore_ascii_case(e))
            .map(|(format, _)| *format)
            .ok_or(FileError::Format)
    }
}

/// Why a file gives no volume.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FileError {
    /// The file has no bytes.
    #[error("it is empty")]
    Empty,
    /// The name ends in no format that is known.
    #[error("its name ends neither in .vdb nor in .nrrd, the formats of samples")]
    Format,
    /// The file ends before all that it announced.
    #[error("it ends within {0}: the file is not whole")]
    Cut(&'static str),
    /// Bytes that are not what they must be.
    #[error("byte {at}: {reason}")]
    Byte {
        /// Counted from 0.
        at: usize,
        /// What is wrong.
        reason: String,
    },
    /// A line of a header that says what cannot be.
    #[error("line {line}: {reason}")]
    Line {
        /// Counted from 1.
        line: usize,
        /// What is wrong.
        reason: String,
    },
    /// Something the format allows and this reader does not.
    #[error("{0}")]
    Unsupported(String),
    /// Nothing in it.
    #[error("its grid \"{name}\" has no active samples")]
    Bare {
        /// The grid.
        name: String,
    },
    /// Too many samples.
    #[error("it spans {}x{}x{} samples, at most {most} in all are allowed", .nodes[0], .nodes[1], .nodes[2])]
    Many {
        /// Along each axis.
        nodes: [u64; 3],
        /// Allowed.
        most: u64,
    },
    /// What was read is no volume.
    #[error(transparent)]
    Volume(#[from] VolumeError),
}

/// The volume of a file, of `most` samples at most. Of an OpenVDB file it is the first grid of single precision; what is active is within
/// its box. A fog becomes the field `(1/2 - density) d`, d the distance between samples: its surface is where it is half dense.
///
/// # Errors
/// What is wrong with the file and where, or what is too much.
pub fn read(bytes: &[u8], format: VolumeFormat, most: u64) -> Result<Volume, FileError> {
    if bytes.is_empty() {
        return Err(FileError::Empty);
    }
    match format {
        VolumeFormat::Vdb => vdb_read::read(bytes, most),
        VolumeFormat::Nrrd => nrrd::read(bytes, most),
    }
}

/// The bytes of a file.
pub fn write(volume: &Volume, format: VolumeFormat) -> Vec<u8> {
    match format {
        VolumeFormat::Vdb => vdb_write::write(volume),
        VolumeFormat::Nrrd => nrrd::write(volume),
    }
}

/// Whether so many samples are allowed; how many they are.
fn check_count(nodes: [u64; 3], most: u64) -> Result<usize, FileError> {
    let count = (nodes.iter()).try_fold(1_u64, |n, side| n.checked_mul(*side));
    match count {
        Some(count) if count <= most && usize::try_from(count).is_ok() => Ok(count as usize),
        _ => Err(FileError::Many { nodes, most }),
    }
}

/// Bits of a node of OpenVDB, the smallest first.
mod mask {
    pub(super) fn get(mask: &[u8], i: usize) -> bool {
        mask[i >> 3] >> (i & 7) & 1 == 1
    }
    pub(super) fn set(mask: &mut [u8], i: usize) {
        mask[i >> 3] |= 1 << (i & 7);
    }
    pub(super) fn count(mask: &[u8]) -> usize {
        mask.iter().map(|b| b.count_ones() as usize).sum()
    }
}

/// What both sides of OpenVDB know.
mod vdb {
    /// "VDB " and four zeros.
    pub(super) const MAGIC: [u8; 8] = [0x20, 0x42, 0x44, 0x56, 0, 0, 0, 0];
    /// The version that is written: that of OpenVDB 3 to 12.
    pub(super) const VERSION: u32 = 224;
    /// The oldest that is read: since then inactive values are left out by masks.
    pub(super) const OLDEST: u32 = 222;
    pub(super) const ZIP: u32 = 1;
    pub(super) const ACTIVE_MASK: u32 = 2;
    pub(super) const BLOSC: u32 = 4;
    /// Slots along an axis of the nodes below the root, as powers of two, and samples that each slot spans.
    pub(super) const UPPER: (usize, usize) = (5, 7);
    pub(super) const LOWER: (usize, usize) = (4, 3);
    pub(super) const LEAF: usize = 3;
    /// What is written of inactive values: none but the background (1: none but its negative), one value, which of both each is.
    pub(super) const ALL_BACKGROUND: i8 = 0;
    pub(super) const ONE: i8 = 2;
    pub(super) const EITHER: i8 = 3;
    pub(super) const EITHER_OF_ONE: i8 = 4;
    pub(super) const EITHER_OF_TWO: i8 = 5;
    pub(super) const EVERY: i8 = 6;
}
