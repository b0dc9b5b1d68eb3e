//! Shaders of Zeroset: WGSL and GLSL for any scene, without a GPU.
