//! The GPU renderer of Zeroset, on wgpu.
