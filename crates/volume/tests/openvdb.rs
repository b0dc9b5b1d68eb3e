//! What is written is what the library of OpenVDB reads, voxel for voxel, and what it writes is read here. Needs Debian's
//! `python3-openvdb`; without it the test says so, and fails where `ZEROSET_REQUIRE_OPENVDB` is set.

use std::process::Command;
use zeroset_volume::file::{VolumeFormat, read, write};
use zeroset_volume::volume::Volume;

const SCRIPT: &str = r#"
import array, sys
import pyopenvdb as vdb
folder, nx, ny, nz = sys.argv[1], *map(int, sys.argv[2:5])
grid = vdb.readAll(folder + "/ours.vdb")[0][0]
wanted = array.array("f", open(folder + "/values", "rb").read())
access = grid.getConstAccessor()
for k in range(nz):
    for j in range(ny):
        for i in range(nx):
            want = wanted[i + nx * (j + ny * k)]
            got, active = access.probeValue((i, j, k))
            assert got == want, (i, j, k, got, want)
            assert active == (abs(want) < grid.background or grid.background >= 100), (i, j, k)
place = grid.transform.indexToWorld((2, 3, 4))
print(grid.name, grid.gridClass, *("%.9g" % x for x in place))
grid.saveFloatAsHalf = False
vdb.write(folder + "/theirs.vdb", grids=[grid])
grid.saveFloatAsHalf = True
vdb.write(folder + "/half.vdb", grids=[grid])
"#;

fn python() -> Option<&'static str> {
    let found = ["/usr/bin/python3", "python3"].into_iter().find(|python| {
        let import = Command::new(python)
            .args(["-c", "import pyopenvdb"])
            .output();
        import.is_ok_and(|o| o.status.success())
    });
    assert!(
        found.is_some() || std::env::var_os("ZEROSET_REQUIRE_OPENVDB").is_none(),
        "python3-openvdb is needed here"
    );
    found
}

#[test]
fn the_real_library_reads_and_writes_the_same() {
    let Some(python) = python() else {
        eprintln!("not run: there is no python3-openvdb");
        return;
    };
    // two balls, more than a node of leaves wide
    let nodes = [150_u32, 40, 33];
    let (origin, step) = ([-1.5, 0.25, 7.0], [0.1; 3]);
    let mut values = Vec::new();
    for k in 0..nodes[2] {
        for j in 0..nodes[1] {
            for i in 0..nodes[0] {
                let off = |c: [f64; 3]| {
                    let d = [
                        f64::from(i) - c[0],
                        f64::from(j) - c[1],
                        f64::from(k) - c[2],
                    ];
                    (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt() - 14.0
                };
                let d = off([16.0, 18.0, 16.0]).min(off([130.0, 20.0, 15.0]));
                values.push((0.1 * d) as f32);
            }
        }
    }
    let dense = Volume::new(nodes, origin, step, values.clone())
        .unwrap()
        .with_background(Some(100.0));
    let band = 0.3_f32;
    let banded = values.iter().map(|v| v.clamp(-band, band)).collect();
    let sparse = Volume::new(nodes, origin, step, banded)
        .unwrap()
        .with_background(Some(band));
    for (name, volume) in [("dense", dense), ("two balls", sparse)] {
        let volume = volume.with_name(name);
        let folder = tempfile::tempdir().unwrap();
        let at = |file: &str| folder.path().join(file);
        std::fs::write(at("ours.vdb"), write(&volume, VolumeFormat::Vdb)).unwrap();
        let bytes: Vec<u8> = volume
            .values()
            .iter()
            .flat_map(|x| x.to_le_bytes())
            .collect();
        std::fs::write(at("values"), bytes).unwrap();
        let mut run = Command::new(python);
        run.args(["-c", SCRIPT]).arg(folder.path());
        let run = run.args(nodes.map(|n| n.to_string())).output().unwrap();
        let said = String::from_utf8_lossy(&run.stdout).into_owned();
        assert!(
            run.status.success(),
            "{}",
            String::from_utf8_lossy(&run.stderr)
        );
        assert_eq!(said.trim(), format!("{name} level set -1.3 0.55 7.4"));
        let ours = read(
            &write(&volume, VolumeFormat::Vdb),
            VolumeFormat::Vdb,
            1 << 20,
        )
        .unwrap();
        let theirs = std::fs::read(at("theirs.vdb")).unwrap();
        assert_eq!(read(&theirs, VolumeFormat::Vdb, 1 << 20).unwrap(), ours);
        let half = std::fs::read(at("half.vdb")).unwrap();
        let half = read(&half, VolumeFormat::Vdb, 1 << 20).unwrap();
        for (h, o) in half.values().iter().zip(ours.values()) {
            assert!((h - o).abs() <= 5e-4 * o.abs() + 1e-6, "{h} for {o}");
        }
    }
}
