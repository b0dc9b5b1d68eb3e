//! NRRD: lines of text, an empty one, and the samples as they are.

use super::{FileError, check_count};
use crate::volume::Volume;

/// Longest header that is read.
const HEADER: usize = 1 << 16;

pub(super) fn write(volume: &Volume) -> Vec<u8> {
    let [nx, ny, nz] = volume.nodes();
    let (o, s) = (volume.origin(), volume.step());
    let mut text = format!(
        "NRRD0004\n# signed distances, negative inside\ntype: float\ndimension: 3\nspace dimension: 3\nsizes: {nx} {ny} {nz}\n\
         space directions: ({},0,0) (0,{},0) (0,0,{})\nspace origin: ({},{},{})\nkinds: space space space\nencoding: raw\n\
         endian: little\n",
        s[0], s[1], s[2], o[0], o[1], o[2]
    );
    let name: String = (volume.name().chars())
        .filter(|c| !c.is_control())
        .collect();
    text += &format!("name:={name}\n");
    if let Some(background) = volume.background() {
        text += &format!("background:={background}\n");
    }
    text.push('\n');
    let mut out = text.into_bytes();
    for x in volume.values() {
        out.extend_from_slice(&x.to_le_bytes());
    }
    out
}

/// How a sample is stored.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Kind {
    fn of(name: &str) -> Option<Kind> {
        Some(match name {
            "signed char" | "int8" | "int8_t" => Kind::I8,
            "uchar" | "unsigned char" | "uint8" | "uint8_t" => Kind::U8,
            "short" | "short int" | "signed short" | "int16" | "int16_t" => Kind::I16,
            "ushort" | "unsigned short" | "uint16" | "uint16_t" => Kind::U16,
            "int" | "signed int" | "int32" | "int32_t" => Kind::I32,
            "uint" | "unsigned int" | "uint32" | "uint32_t" => Kind::U32,
            "float" => Kind::F32,
            "double" => Kind::F64,
            _ => return None,
        })
    }

    fn bytes(self) -> usize {
        match self {
            Kind::I8 | Kind::U8 => 1,
            Kind::I16 | Kind::U16 => 2,
            Kind::I32 | Kind::U32 | Kind::F32 => 4,
            Kind::F64 => 8,
        }
    }
}

pub(super) fn read(bytes: &[u8], most: u64) -> Result<Volume, FileError> {
    let (mut kind, mut sizes, mut encoding) = (None, None, String::new());
    let (mut step, mut origin, mut big) = ([1.0; 3], [0.0; 3], false);
    let (mut name, mut background) = ("distance".to_owned(), None);
    let mut at = 0;
    let mut line = 0;
    loop {
        let rest = &bytes[at..bytes.len().min(HEADER)];
        let end = (rest.iter().position(|b| *b == b'\n')).ok_or(FileError::Cut("its header"))?;
        let text = String::from_utf8_lossy(&rest[..end]);
        let text = text.trim_end_matches('\r');
        at += end + 1;
        line += 1;
        let bad = |reason: &str| FileError::Line {
            line,
            reason: reason.to_owned(),
        };
        if line == 1 {
            if !text.starts_with("NRRD000") {
                return Err(bad("an NRRD file begins with `NRRD000`"));
            }
            continue;
        }
        if text.is_empty() {
            break;
        }
        if text.starts_with('#') {
            continue;
        }
        if let Some((key, value)) = text.split_once(":=") {
            match key {
                "name" => value.clone_into(&mut name),
                "background" => background = value.parse().ok(),
                _ => {}
            }
            continue;
        }
        let (key, value) = text
            .split_once(": ")
            .ok_or_else(|| bad("a line of a header is `FIELD: VALUE`"))?;
        let value = value.trim();
        match key {
            "type" => {
                kind =
                    Some(Kind::of(value).ok_or_else(|| bad("samples of this type are not read"))?);
            }
            "dimension" if value != "3" => return Err(bad("only what has 3 dimensions is read")),
            "sizes" => {
                let three: Vec<u64> = value
                    .split_whitespace()
                    .filter_map(|w| w.parse().ok())
                    .collect();
                let three = <[u64; 3]>::try_from(three);
                sizes = Some(three.map_err(|_| bad("three sizes are needed"))?);
            }
            "spacings" => {
                step = numbers(value).ok_or_else(|| bad("three spacings are needed"))?;
            }
            "space directions" => {
                let rows: Option<Vec<[f64; 3]>> = value
                    .split(')')
                    .filter(|v| !v.trim().is_empty())
                    .map(|v| numbers(v.trim().trim_start_matches('(')))
                    .collect();
                let rows = rows.filter(|r| r.len() == 3);
                let rows =
                    rows.ok_or_else(|| bad("three directions such as (1,0,0) are needed"))?;
                let straight = (0..3).all(|i| (0..3).all(|j| i == j || rows[i][j] == 0.0));
                if !straight {
                    return Err(bad("only grids along the axes are read"));
                }
                step = [rows[0][0], rows[1][1], rows[2][2]];
            }
            "space origin" => {
                let inner = value.trim_start_matches('(').trim_end_matches(')');
                origin =
                    numbers(inner).ok_or_else(|| bad("an origin such as (0,0,0) is needed"))?;
            }
            "encoding" => value.clone_into(&mut encoding),
            "endian" => big = value == "big",
            "data file" | "datafile" => {
                return Err(bad("samples in another file are not read"));
            }
            _ => {}
        }
    }
    let lacking = |what: &str| FileError::Unsupported(format!("its header has no `{what}`"));
    let kind = kind.ok_or_else(|| lacking("type"))?;
    let sizes = sizes.ok_or_else(|| lacking("sizes"))?;
    if encoding != "raw" {
        return Err(FileError::Unsupported(
            "samples are read that are encoded `raw` only".into(),
        ));
    }
    let count = check_count(sizes, most)?;
    let size = kind.bytes();
    let data = &bytes[at..];
    if data.len() / size < count {
        return Err(FileError::Cut("the samples"));
    }
    let values = data
        .chunks_exact(size)
        .take(count)
        .map(|sample| {
            let mut b = [0; 8];
            b[..size].copy_from_slice(sample);
            if big {
                b[..size].reverse();
            }
            let four = [b[0], b[1], b[2], b[3]];
            match kind {
                Kind::I8 => i8::from_le_bytes([b[0]]).into(),
                Kind::U8 => b[0].into(),
                Kind::I16 => i16::from_le_bytes([b[0], b[1]]).into(),
                Kind::U16 => u16::from_le_bytes([b[0], b[1]]).into(),
                Kind::I32 => i32::from_le_bytes(four) as f32,
                Kind::U32 => u32::from_le_bytes(four) as f32,
                Kind::F32 => f32::from_le_bytes(four),
                Kind::F64 => f64::from_le_bytes(b) as f32,
            }
        })
        .collect();
    let nodes = sizes.map(|s| u32::try_from(s).unwrap_or(u32::MAX));
    Ok(Volume::new(nodes, origin, step, values)?
        .with_background(background)
        .with_name(name))
}

/// Three numbers with commas or spaces between.
fn numbers(text: &str) -> Option<[f64; 3]> {
    let all: Option<Vec<f64>> = text
        .split(|c: char| c == ',' || c.is_whitespace())
        .filter(|w| !w.is_empty())
        .map(|w| w.parse::<f64>().ok().filter(|x| x.is_finite()))
        .collect();
    all?.try_into().ok()
}
