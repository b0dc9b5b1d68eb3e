//! Fields from files: meshes, volumes and pictures.

use super::fields;
use super::mistake::{Run, mistake};
use super::native::{Call, Native, slot};
use super::value::{Thing, Value};
use crate::files;
use crate::registers::Registers;
use crate::sampled::{self, SIGNS};
use std::sync::Arc;
use zeroset_catalogue::{LARGE, SMALL};
use zeroset_field::field::Field;
use zeroset_field::sampled::Source;
use zeroset_volume::bake::Bake;

const GROUP: &str = "Files as shapes";

/// The functions.
pub(crate) const ALL: &[Native] = &[
    Native {
        name: "mesh",
        doc: "A mesh as a solid, by its distance at the nodes of a grid.",
        group: GROUP,
        params: &[
            slot(
                "file",
                "",
                "An .obj, .ply, .stl, .gltf or .glb file in the scene's folder, in its own units.",
            ),
            slot(
                "voxels",
                "64",
                "Cells along its longest side, 8 to 2047: what is thinner than a cell may be lost.",
            ),
            slot(
                "sign",
                "\"auto\"",
                "What is inside: \"parity\" (of rays), \"winding\" (number above 1/2), or \"auto\".",
            ),
        ],
        rest: false,
        run: mesh,
    },
    Native {
        name: "grid",
        doc: "A volume of signed distances as a solid.",
        group: GROUP,
        params: &[slot(
            "file",
            "",
            "A .vdb (OpenVDB) or .nrrd file in the scene's folder, in its own units.",
        )],
        rest: false,
        run: grid,
    },
    Native {
        name: "image_shape",
        doc: "What is dark in an image as a plane shape.",
        group: GROUP,
        params: &[
            slot("file", "", "A PNG or JPEG file in the scene's folder."),
            slot("width", "1", "How wide the image is, scene units."),
            slot(
                "level",
                "0.5",
                "The brightness that parts what is inside from what is not, above 0 and below 1.",
            ),
        ],
        rest: false,
        run: image_shape,
    },
    Native {
        name: "load_vm",
        doc: "A formula from a list of operations, for field(...) and field2d(...).",
        group: GROUP,
        params: &[slot(
            "file",
            "",
            "A .vm file in the scene's folder, as MPR and Fidget have them.",
        )],
        rest: false,
        run: load_vm,
    },
];

fn mesh(c: &mut Call<'_, '_>) -> Run<Value> {
    let voxels = c.count_or("voxels", 64, Bake::LEAST, Bake::MOST)?;
    let names = SIGNS.map(|(name, _)| (name, name));
    let sign = c.word_or("sign", "auto", &names)?.to_owned();
    of_file(c, |file| Source::Mesh { file, voxels, sign })
}

fn grid(c: &mut Call<'_, '_>) -> Run<Value> {
    of_file(c, |file| Source::Grid { file })
}

fn image_shape(c: &mut Call<'_, '_>) -> Run<Value> {
    let width = c.number_or("width", 1.0, SMALL, LARGE)?;
    let level = c.number_or("level", 0.5, 0.001, 0.999)?;
    of_file(c, |file| Source::Image { file, width, level })
}

fn load_vm(c: &mut Call<'_, '_>) -> Run<Value> {
    let given = c.need("file")?;
    let file = c.text("file", given)?.to_string();
    let most = c.machine.limits.file_bytes;
    let told = |reason: String| mistake(reason).at(given.place);
    let bytes = (c.machine.draft.files)
        .read(&file, most, "file_bytes")
        .map_err(|e| told(e.to_string()))?;
    c.machine.charge(bytes.len() as u64 / 16)?;
    let text = files::text(bytes.to_vec(), &file).map_err(|e| told(e.to_string()))?;
    let list = Registers::parse(&text).map_err(|e| told(format!("\"{file}\": {e}")))?;
    c.machine.grow(list.operations() * size_of::<[f64; 3]>())?;
    Ok(c.machine.charged_thing(Thing::Registers(Arc::new(list))))
}

fn of_file(c: &mut Call<'_, '_>, source: impl FnOnce(String) -> Source) -> Run<Value> {
    let given = c.need("file")?;
    let file = c.text("file", given)?;
    let limits = c.machine.limits;
    let made = sampled::load(
        &mut c.machine.draft.files,
        &source(file.to_string()),
        &limits,
    );
    let (samples, taken) = made.map_err(|m| mistake(m).at(given.place))?;
    c.machine.pause(taken);
    fields::value(c.machine, Ok(Field::sampled(samples)))
}
