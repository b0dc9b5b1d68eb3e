//! What a picture took, and on what.

use crate::adapter::AdapterInfo;
use zeroset_shader::entry::ENTRIES;

/// The entry points of a shader, in the order of [`ENTRIES`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub(crate) enum Stage {
    ConesWide,
    ConesNarrow,
    Trace,
    Gather,
    Develop,
}

/// What the last picture took. Wall seconds hold everything from the call to the planes in memory; GPU seconds hold the
/// GPU's own work only.
#[derive(Clone, Debug, PartialEq)]
pub struct Timings {
    /// The adapter.
    pub adapter: AdapterInfo,
    /// Width and height.
    pub size: [u32; 2],
    /// Rays a pixel.
    pub samples: u32,
    /// Wall seconds of the picture, the compilation of its shader included.
    pub wall: f64,
    /// Wall seconds of compiling the shader, its first dispatches included: some drivers compile then. 0 where it was
    /// compiled before.
    pub compile: f64,
    /// Seconds of each stage on the GPU.
    pub stages: StageSeconds,
    /// Whether the GPU measured these; else they are wall seconds from submission to completion.
    pub by_timestamps: bool,
    /// Parts that the picture was rendered in, one after the other.
    pub bands: u32,
    /// Bytes of parameters, tables, images and grids that the GPU did not have yet.
    pub uploaded: u64,
    /// Dispatches.
    pub dispatches: u32,
    /// Submissions.
    pub submissions: u32,
    /// The longest dispatch, seconds, those of [`Timings::compile`] left out.
    pub longest: f64,
    /// How often the picture was begun anew: after the loss of the device, or with less memory.
    pub retries: u32,
}

/// Seconds on the GPU, by stage.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StageSeconds(pub(crate) [f64; ENTRIES.len()]);

impl StageSeconds {
    /// Names and seconds.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, f64)> {
        ENTRIES.iter().map(|e| e.name).zip(self.0)
    }

    /// All stages together.
    pub fn total(&self) -> f64 {
        self.0.iter().sum()
    }
}

impl Timings {
    pub(crate) fn new(adapter: AdapterInfo, size: [u32; 2], samples: u32) -> Timings {
        Timings {
            adapter,
            size,
            samples,
            wall: 0.0,
            compile: 0.0,
            stages: StageSeconds::default(),
            by_timestamps: false,
            bands: 0,
            uploaded: 0,
            dispatches: 0,
            submissions: 0,
            longest: 0.0,
            retries: 0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_have_the_places_of_their_entry_points() {
        let stages = [
            (Stage::ConesWide, "cones_wide"),
            (Stage::ConesNarrow, "cones_narrow"),
            (Stage::Trace, "trace"),
            (Stage::Gather, "gather"),
            (Stage::Develop, "develop"),
        ];
        for (stage, name) in stages {
            assert_eq!(ENTRIES[stage as usize].name, name);
        }
    }
}
