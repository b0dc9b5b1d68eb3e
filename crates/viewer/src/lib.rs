//! The window of Zeroset.
