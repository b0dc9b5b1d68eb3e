"""Mitsuba beside Zeroset: one scene, the same two cores, in one run, at equal noise.

    pip install mitsuba numpy          (its LLVM variants want libLLVM)
    cargo build --release
    python docs/mitsuba/compare.py target/release/zeroset

The scene is scene.star: a white ball and a white ring in a white sky, paths of depth 5, 256x256. Mitsuba has it as an `sdfgrid` of 128^3 samples
(Vicini et al. 2022), Zeroset as the field itself. Each is held to its own converged picture, so that what is compared is noise, not
how a grid rounds an edge. A picture of n rays a pixel takes a time t and is off by e (root mean square): work that leaves the noise e is
t e^2, since four times the rays halve it. What is printed is the ratio of the two. Zeroset's time is that of its whole process, from the
scene file to the EXR; Mitsuba's is that of mi.render, compiled before.
"""

import json
import os
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
ZEROSET = sys.argv[1]
VARIANTS = ["llvm_ad_rgb", "scalar_rgb"]


def distance(p):
    ball = np.linalg.norm(p - np.array([-0.35, 0, 0]), axis=-1) - 0.4
    # the ring lies in the plane y = 0, is turned by 70 degrees about x and then moved
    q = p - np.array([0.35, 0, 0])
    c, s = np.cos(np.radians(70)), np.sin(np.radians(70))
    y, z = c * q[..., 1] + s * q[..., 2], -s * q[..., 1] + c * q[..., 2]
    ring = np.hypot(np.hypot(q[..., 0], z) - 0.45, y) - 0.15
    return np.minimum(ball, ring)


def mitsuba_scene(spp):
    n, half = 128, 1.1
    at = (np.arange(n) / (n - 1) * 2 - 1) * half
    z, y, x = np.meshgrid(at, at, at, indexing="ij")
    # distances are those of the unit cube that the grid lies in
    grid = (distance(np.stack([x, y, z], -1)) / (2 * half)).astype(np.float32)[..., None]
    T = mi.ScalarTransform4f
    return mi.load_dict({
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 5},
        "sensor": {
            "type": "perspective", "fov": 45, "fov_axis": "y",
            "to_world": T().look_at([0, 0.6, 3], [0, 0, 0], [0, 1, 0]),
            "film": {"type": "hdrfilm", "width": 256, "height": 256, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            "sampler": {"type": "independent", "sample_count": spp},
        },
        "sky": {"type": "constant", "radiance": 1.0},
        "shape": {
            "type": "sdfgrid", "grid": mi.TensorXf(grid), "normals": "smooth",
            "to_world": T().translate([-half] * 3).scale([2 * half] * 3),
            "bsdf": {"type": "twosided", "inner": {"type": "diffuse", "reflectance": {"type": "rgb", "value": ALBEDO}}},
        },
    })


def srgb(x):
    return x / 12.92 if x <= 0.04045 else ((x + 0.055) / 1.055) ** 2.4


ALBEDO = [srgb(0.78)] * 3


def with_mitsuba(variant):
    mi.set_variant(variant)
    scene = mitsuba_scene(16)

    def picture(spp, seed):
        image = mi.render(scene, spp=spp, seed=seed)
        return np.array(image)

    return picture


def with_zeroset(spp, _seed):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "p.exr")
        subprocess.run(
            [ZEROSET, "render", os.path.join(HERE, "scene.star"), "-o", out, "--spp", str(spp), "--quiet"],
            check=True,
        )
        mi.set_variant("scalar_rgb")
        colour = dict(mi.Bitmap(out).split())["<root>"]
        return np.array(colour)[..., :3]


def measured(picture, truth, spp=16, runs=5):
    picture(spp, 1)  # compiles, and warms caches
    if truth is None:
        truth = picture(2048, 100)
    times, errors = [], []
    for k in range(runs):
        start = time.perf_counter()
        image = picture(spp, 1 + k)
        times.append(time.perf_counter() - start)
        errors.append(np.mean((image - truth) ** 2))
    return np.median(times), np.sqrt(np.mean(errors)), truth


report, truths = {}, {}
for variant in [v for v in VARIANTS if v in mi.variants()]:
    try:
        seconds, error, truths[variant] = measured(with_mitsuba(variant), truths.get("llvm_ad_rgb"))
    except Exception as reason:  # a variant whose compiler is not there
        print(f"{variant}: {reason}", file=sys.stderr)
        continue
    report[f"mitsuba {variant}"] = {"seconds": float(seconds), "rmse": float(error), "work": float(seconds * error**2)}
seconds, error, truth = measured(with_zeroset, None)
report["zeroset"] = {"seconds": float(seconds), "rmse": float(error), "work": float(seconds * error**2)}
for name, values in report.items():
    values["times the work of zeroset"] = values["work"] / report["zeroset"]["work"]
for name, other in truths.items():
    report[f"mitsuba {name}"]["mean difference from zeroset"] = float(np.mean(np.abs(other - truth)))
print(json.dumps(report, indent=2))
