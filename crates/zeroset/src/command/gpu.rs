//! `zeroset gpu`.

use crate::args::GpuArgs;
use crate::console::Console;
use crate::failure::Failure;
use crate::json;
use serde::Serialize;
use std::fmt::Write;
use zeroset_gpu::{AdapterInfo, Choice, GpuRenderer, adapters};

/// What `--json` prints of an adapter.
#[derive(Serialize)]
struct Listed<'a> {
    name: &'a str,
    kind: String,
    interface: &'a str,
    driver: &'a str,
    /// Bytes of the largest buffer.
    largest_buffer: u64,
    /// Whether the GPU's own clock times its work.
    timestamps: bool,
    /// What it lacks, if it cannot render.
    lacks: Option<String>,
    /// Whether `--backend auto` takes it.
    auto: bool,
}

/// Lists the adapters of the machine, and which one is taken.
pub(crate) fn run(args: &GpuArgs, console: &Console) -> Result<(), Failure> {
    let (all, automatic) = adapters();
    if args.json {
        let listed: Vec<Listed<'_>> = all
            .iter()
            .enumerate()
            .map(|(k, info)| Listed {
                name: &info.name,
                kind: info.kind.to_string(),
                interface: info.backend,
                driver: &info.driver,
                largest_buffer: info.largest_binding,
                timestamps: info.has_timestamps,
                lacks: info.lack.as_ref().map(ToString::to_string),
                auto: automatic == Some(k),
            })
            .collect();
        return console.emit(&json::pretty(&listed)?);
    }
    let mut out = String::new();
    for (k, info) in all.iter().enumerate() {
        let taken = if automatic == Some(k) {
            "  <- --backend auto"
        } else {
            ""
        };
        let _ = writeln!(
            out,
            "{}, {}{taken}\n    {}",
            info.title(),
            info.kind,
            can(info)
        );
    }
    if automatic.is_none() {
        let _ = writeln!(
            out,
            "--backend auto renders on the CPU: there is no GPU to take."
        );
    }
    if let Err(error) = GpuRenderer::new(&Choice::Any) {
        let _ = writeln!(out, "--backend gpu fails: {error}");
        if let Some(advice) = error.advice() {
            let _ = writeln!(out, "To change that, {advice}.");
        }
    }
    console.print(&out)
}

/// What an adapter can do.
fn can(info: &AdapterInfo) -> String {
    let driver = if info.driver.is_empty() {
        "driver unknown"
    } else {
        &info.driver
    };
    let buffers = format!("buffers up to {} MiB", info.largest_binding >> 20);
    let clock = if info.has_timestamps {
        "times its own work"
    } else {
        "does not time its own work"
    };
    match &info.lack {
        Some(lack) => format!("{driver}; cannot render: {lack}"),
        None => format!("{driver}; {buffers}; {clock}"),
    }
}
