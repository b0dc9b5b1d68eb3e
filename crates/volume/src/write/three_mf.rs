//! 3MF, the 3D Manufacturing Format (core specification 1.3, materials extension 1.2): XML in a ZIP archive.
//!
//! A scene unit is written as a millimetre, which is what programs that print take; they scale.

use super::zip::archive;
use super::{Painted, TooLarge, plain};
use std::collections::HashMap;
use std::fmt::Write;

const TYPES: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Types xmlns="http://schemas.openxmlformats.org/package/2006/content-types"><Default Extension="rels" ContentType="application/vnd.openxmlformats-package.relationships+xml"/><Default Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"/></Types>
"#;

const RELATIONS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<Relationships xmlns="http://schemas.openxmlformats.org/package/2006/relationships"><Relationship Target="/3D/3dmodel.model" Id="rel0" Type="http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"/></Relationships>
"#;

const HEAD: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<model unit="millimeter" xml:lang="en-US" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02" xmlns:m="http://schemas.microsoft.com/3dmanufacturing/material/2015/02">
<metadata name="Application">Zeroset</metadata>
<resources>
"#;

pub(super) fn write(mesh: &Painted<'_>) -> Result<Vec<u8>, TooLarge> {
    let mut out = String::from(HEAD);
    // writing to a string never fails
    let colours = colours(mesh, &mut out);
    let _ = writeln!(
        out,
        r#"<object id="2" name="{}" type="model"><mesh><vertices>"#,
        plain(mesh.name)
    );
    for [x, y, z] in mesh.points {
        let _ = writeln!(out, r#"<vertex x="{x}" y="{y}" z="{z}"/>"#);
    }
    out.push_str("</vertices><triangles>\n");
    for face in mesh.faces {
        let [a, b, c] = face;
        let [p, q, r] = face.map(|v| colours.get(v as usize).copied().unwrap_or_default());
        let _ = match colours.is_empty() {
            true => writeln!(out, r#"<triangle v1="{a}" v2="{b}" v3="{c}"/>"#),
            false => writeln!(
                out,
                r#"<triangle v1="{a}" v2="{b}" v3="{c}" pid="1" p1="{p}" p2="{q}" p3="{r}"/>"#
            ),
        };
    }
    out.push_str("</triangles></mesh></object>\n</resources>\n<build><item objectid=\"2\"/></build>\n</model>\n");
    archive(&[
        ("[Content_Types].xml", TYPES.into()),
        ("_rels/.rels", RELATIONS.into()),
        ("3D/3dmodel.model", out.into_bytes()),
    ])
}

/// Writes the group of all colours, and gives each vertex the number of its own.
fn colours(mesh: &Painted<'_>, out: &mut String) -> Vec<usize> {
    if mesh.colours.is_empty() {
        return Vec::new();
    }
    out.push_str("<m:colorgroup id=\"1\">\n");
    let mut known: HashMap<[u8; 3], usize> = HashMap::new();
    let numbers = (0..mesh.points.len()).map(|i| {
        let colour = mesh.shown(i).unwrap_or_default();
        let next = known.len();
        *known.entry(colour).or_insert_with(|| {
            let [r, g, b] = colour;
            let _ = writeln!(out, r##"<m:color color="#{r:02X}{g:02X}{b:02X}FF"/>"##);
            next
        })
    });
    let numbers = numbers.collect();
    out.push_str("</m:colorgroup>\n");
    numbers
}
