//! Files of meshes and of samples: whatever their bytes are, they are read or refused; what is read can be sampled and written.

use zeroset_volume::bake::{Alone, Bake};
use zeroset_volume::check::mend;
use zeroset_volume::file::{self, VolumeFormat};
use zeroset_volume::mesh::MeshLimits;
use zeroset_volume::read::{MeshFormat, nothing_beside, read};

/// Reads a mesh, whose format the first byte says, and samples it coarsely.
///
/// # Panics
/// Something broke that must not.
pub fn mesh(bytes: &[u8]) {
    let Some((first, bytes)) = bytes.split_first() else {
        return;
    };
    let (format, _) = MeshFormat::ALL[usize::from(*first) % MeshFormat::ALL.len()];
    let limits = MeshLimits {
        vertices: 20_000,
        faces: 20_000,
    };
    let Ok(mut mesh) = read(bytes, format, &limits, &mut nothing_beside) else {
        return;
    };
    let check = mend(&mut mesh);
    assert!(check.area.is_finite() && check.volume.is_finite());
    let bake = Bake {
        voxels: 8,
        margin: 1,
        ..Bake::default()
    };
    // so few faces that the seconds of an input suffice
    if mesh.faces().len() < 500
        && let Ok(volume) = bake.bake(&mesh, &check, &Alone)
    {
        let sampled = volume.into_sampled().expect("a field");
        assert!(sampled.slope() <= 2.0, "{}", sampled.slope());
    }
}

/// Reads samples, whose format the first byte says, and writes them again.
///
/// # Panics
/// Something broke that must not.
pub fn volume(bytes: &[u8]) {
    let Some((first, bytes)) = bytes.split_first() else {
        return;
    };
    let (format, _) = VolumeFormat::ALL[usize::from(*first) % VolumeFormat::ALL.len()];
    let Ok(volume) = file::read(bytes, format, 100_000) else {
        return;
    };
    // all samples, whatever they are
    let again = file::write(&volume, VolumeFormat::Nrrd);
    let again = file::read(&again, VolumeFormat::Nrrd, 100_000).expect("what was written");
    assert_eq!(again.values(), volume.values());
    let _ = file::write(&volume, VolumeFormat::Vdb);
    let _ = volume.into_sampled();
}
