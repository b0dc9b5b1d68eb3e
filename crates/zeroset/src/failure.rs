//! What ends a command early, and the exit code it ends with.

use crate::scene::{Unreadable, readable};
use miette::{Diagnostic, MietteDiagnostic};
use std::path::PathBuf;
use zeroset_output::atomic::{WriteError, WriteFailure};
use zeroset_output::format::read::ReadError;
use zeroset_scene::render::RenderError;
use zeroset_scene::valid::SceneError;

/// Exit codes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Exit {
    /// Everything was done.
    Done = 0,
    /// The job itself failed.
    Job = 1,
    /// The command line is wrong.
    Usage = 2,
    /// The scene is wrong.
    Scene = 3,
    /// A file could not be read or written.
    File = 4,
    /// The time limit ended a picture.
    Unfinished = 5,
    /// Ctrl-C, or asked to end by the system.
    Interrupted = 130,
}

/// What `--help` says about exit codes.
pub(crate) const EXIT_CODES: &str = "\
Exit codes:
    0  everything was done
    1  the job failed (it could not be rendered, the pictures cannot be compared)
    2  the command line is wrong
    3  the scene is wrong: the message names file, line and column
    4  a file could not be read or written; a file that existed is whole
    5  --time-limit ended a picture: it was written as far as it got
  130  interrupted: a file that existed is whole

Results go to files or to standard output; progress, notes and errors go to standard error.";

/// Why a command ends early.
#[derive(Debug)]
pub(crate) struct Failure {
    /// How the process exits.
    pub exit: Exit,
    /// What is said about it, if anything.
    pub report: Option<Box<dyn Diagnostic + Send + Sync>>,
}

impl Failure {
    /// A failure with a message.
    pub(crate) fn new(exit: Exit, message: impl Into<String>) -> Failure {
        Failure {
            exit,
            report: Some(Box::new(MietteDiagnostic::new(message))),
        }
    }

    /// A failure with a message and what to do about it.
    pub(crate) fn with_help(
        exit: Exit,
        message: impl Into<String>,
        help: impl Into<String>,
    ) -> Failure {
        Failure {
            exit,
            report: Some(Box::new(MietteDiagnostic::new(message).with_help(help))),
        }
    }

    /// An end that needs no words.
    pub(crate) fn silent(exit: Exit) -> Failure {
        Failure { exit, report: None }
    }
}

impl From<WriteError> for Failure {
    fn from(error: WriteError) -> Self {
        if matches!(error.failure, WriteFailure::Cancelled) {
            return Failure::silent(Exit::Interrupted);
        }
        Failure::with_help(Exit::File, error.to_string(), error.advice())
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Failure::new(Exit::Scene, error.to_string())
    }
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Self {
        Failure::new(Exit::File, error.to_string())
    }
}

impl From<zeroset_language::load::Failed> for Failure {
    fn from(failed: zeroset_language::load::Failed) -> Self {
        // A file that is there and cannot be read says nothing about the scene, nor does the scene's own that is not there;
        // that another one is not there does.
        let is_unreadable = |(number, path): (usize, &PathBuf)| match readable(path) {
            Ok(()) => false,
            Err(Unreadable::System(_)) => true,
            Err(_) => number == 0,
        };
        let exit = if failed.files.iter().enumerate().any(is_unreadable) {
            Exit::File
        } else {
            Exit::Scene
        };
        Failure {
            exit,
            report: Some(failed.report),
        }
    }
}

impl From<RenderError> for Failure {
    fn from(error: RenderError) -> Self {
        match error {
            RenderError::Cancelled => Failure::silent(Exit::Interrupted),
            RenderError::Scene(_) | RenderError::Field(_) | RenderError::Compile(_) => {
                Failure::new(Exit::Scene, error.to_string())
            }
            RenderError::Threads { .. } => Failure::with_help(
                Exit::Job,
                error.to_string(),
                "ask for fewer threads with --threads",
            ),
            RenderError::Device { advice: None, .. } => Failure::new(Exit::Job, error.to_string()),
            RenderError::Device {
                advice: Some(advice),
                ..
            } => Failure::with_help(Exit::Job, error.to_string(), advice),
        }
    }
}
