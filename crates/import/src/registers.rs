//! Register lists of MPR (Keeter 2020) and Fidget. The scene asks for the file.

use crate::measure::{self, number};
use crate::{ImportError, Imported, Request, one_line, quoted};
use zeroset_language::files::InMemory;
use zeroset_language::registers::Registers;

pub(crate) fn scene(text: &str, request: &Request<'_>) -> Result<Imported, ImportError> {
    let registers = Registers::parse(text)?;
    let list = format!("load_vm({})", quoted(request.name));
    let files = || InMemory::new([(request.name, text)]);
    let mut out = format!(
        "# {}: {} operations.\n\n",
        one_line(request.title),
        registers.operations()
    );
    if !registers.is_solid() {
        // Fidget shows the part from -1 to 1, which is what such lists are made for
        out += &format!(
            "show(field2d({list}, size = 2).extrude(0.1), material(color = \"#e8e2d0\", roughness = 0.7), name = \"list\")\n"
        );
        if measure::loaded(&out, Some(files())).is_err() {
            let slope = measure::steepness(
                &format!("show(field2d({list}, size = 2, slope = 1))"),
                Some(files()),
            )?;
            out = out.replace(
                "size = 2)",
                &format!("size = 2, slope = {})", number(slope)),
            );
            measure::loaded(&out, Some(files()))?;
        }
        out += "camera(eye = (0.6, 0.5, 3.4), target = (0, 0, 0), fov = 40)\n";
        out += measure::LIGHT;
        return Ok(Imported {
            text: out,
            notes: Vec::new(),
        });
    }
    let shown = |place: &str, cut: Option<&str>| {
        let shape = match cut {
            None => list.clone(),
            Some(depth) => format!("lambda p: max({list}(p), -{depth})"),
        };
        format!(
            "show(field({shape}, {place}), material(color = \"#c8553d\", roughness = 0.5), name = \"list\")\n"
        )
    };
    let made = measure::framed(&shown, Some(&files))?;
    out += &made.comment;
    out += &shown(&made.place, made.cut.as_deref());
    out += &made.camera;
    Ok(Imported {
        text: out,
        notes: made.notes,
    })
}
