//! What renders: the CPU or the GPU, and what is said where there is none.

use crate::run::{BALL, Ended, Folder};

/// Runs with no Vulkan driver to be found.
fn without_drivers(folder: &Folder, arguments: &str) -> Ended {
    let output = folder
        .command(arguments)
        .env("VK_DRIVER_FILES", "/nowhere")
        .env("VK_ICD_FILENAMES", "/nowhere")
        .output()
        .unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ended {
        code: output.status.code(),
        out: text(output.stdout),
        err: text(output.stderr),
    }
}

/// Whether the GPU's tests run: there is an adapter, and the feature.
fn has_adapter(folder: &Folder, test: &str) -> bool {
    if !cfg!(feature = "gpu") {
        return false;
    }
    let adapters = folder.good("gpu --json").json();
    let works = |a: &serde_json::Value| a["lacks"].is_null();
    let works = adapters.as_array().unwrap().iter().any(works);
    let required = std::env::var("ZEROSET_REQUIRE_GPU").is_ok_and(|v| v == "1");
    assert!(works || !required, "{test} needs a GPU: {adapters}");
    if !works {
        println!("{test} did not run: there is no adapter");
    }
    works
}

#[test]
fn the_cpu_is_named_in_the_statistics() {
    let folder = Folder::with(BALL);
    let arguments = "render scene.star --size 32x32 --backend cpu --threads 1 --json -o a.png";
    let said = folder.good(arguments).json();
    assert_eq!(
        (&said["backend"], &said["threads"]),
        (&"cpu".into(), &1.into())
    );
    assert!(said["adapter"].is_null());
    let said = folder.good("render scene.star --size 32x32 --backend cpu --threads 1 -o a.png");
    assert!(said.err.contains("1 thread"), "{}", said.err);
}

#[test]
fn the_gpu_renders_the_same_picture() {
    let folder = Folder::with(BALL);
    if !has_adapter(&folder, "the_gpu_renders_the_same_picture") {
        return;
    }
    let said = folder.good("render scene.star --size 64x64 --backend gpu --json -o gpu.png");
    let said = said.json();
    assert_eq!(said["backend"], "gpu");
    assert!(said["adapter"].as_str().unwrap().len() > 3, "{said}");
    assert_eq!(said["rays"], 4 * 64 * 64);
    folder.good("render scene.star --size 64x64 --backend cpu -o cpu.png");
    let difference = folder.good("compare cpu.png gpu.png --json").json();
    assert!(
        difference["psnr"].as_f64().unwrap_or(99.0) > 40.0,
        "{difference}"
    );
}

#[cfg(feature = "gpu")]
#[test]
fn a_gpu_that_is_not_there_is_an_error() {
    let folder = Folder::with(BALL);
    folder.bad(
        "render scene.star --adapter no-such-card -o a.png",
        1,
        &["no adapter is named `no-such-card`"],
    );
    folder.bad(
        "render scene.star --backend cpu --adapter x",
        2,
        &["the CPU has no adapter", "--backend gpu"],
    );
    assert_eq!(folder.names(), ["scene.star"]);
}

#[cfg(all(feature = "gpu", target_os = "linux"))]
#[test]
fn without_drivers_the_cpu_renders_and_the_gpu_says_what_to_install() {
    let folder = Folder::with(BALL);
    let ended = without_drivers(&folder, "render scene.star --size 32x32 --json -o a.png");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert_eq!(ended.json()["backend"], "cpu");
    let ended = without_drivers(&folder, "render scene.star --backend gpu -o b.png");
    assert_eq!(ended.code, Some(1), "{}", ended.err);
    assert!(ended.err.contains("install"), "{}", ended.err);
    assert_eq!(folder.names(), ["a.png", "scene.star"]);
    let ended = without_drivers(&folder, "gpu");
    assert_eq!(ended.code, Some(0), "{}", ended.err);
    assert!(ended.out.contains("renders on the CPU"), "{}", ended.out);
}

#[cfg(not(feature = "gpu"))]
#[test]
fn a_build_without_the_gpu_says_so() {
    let folder = Folder::with(BALL);
    let ended = without_drivers(&folder, "render scene.star --backend gpu");
    assert_eq!(ended.code, Some(1));
    assert!(ended.err.contains("without the GPU"), "{}", ended.err);
}
