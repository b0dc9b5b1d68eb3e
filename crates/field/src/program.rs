//! Programs: what a field tree compiles to.

/// Why a tree cannot be compiled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CompileError {
    /// More instructions than the limit.
    #[error("the field compiles to more than {limit} instructions")]
    TooLarge {
        /// The limit.
        limit: usize,
    },
}
