//! Stanford PLY: text or binary, of either byte order.

use super::{Soup, number, shortened};
use crate::mesh::MeshError;

/// Elements and properties that a header may name, more than any program writes.
const MOST: usize = 256;

pub(super) fn read(bytes: &[u8], soup: &mut Soup) -> Result<(), MeshError> {
    let (header, body) = Header::read(bytes)?;
    header.check(bytes.len() - body, soup)?;
    match header.order {
        None => text_body(&header, bytes, body, soup),
        Some(order) => {
            let mut from = Binary {
                bytes,
                at: body,
                order,
            };
            binary_body(&header, &mut from, soup)
        }
    }
}

#[derive(Clone, Copy)]
enum Order {
    Little,
    Big,
}

/// A number's type: bytes, and how to read them.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    fn of(word: &str) -> Option<Kind> {
        Some(match word {
            "char" | "int8" => Kind::I8,
            "uchar" | "uint8" => Kind::U8,
            "short" | "int16" => Kind::I16,
            "ushort" | "uint16" => Kind::U16,
            "int" | "int32" => Kind::I32,
            "uint" | "uint32" => Kind::U32,
            "float" | "float32" => Kind::F32,
            "double" | "float64" => Kind::F64,
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

struct Property {
    name: String,
    kind: Kind,
    /// The type of the count, of a list.
    list: Option<Kind>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
    /// The line of a property that cannot be understood: an element of a text can be passed over all the same.
    odd: Option<(usize, String)>,
}

struct Header {
    /// Of a binary file.
    order: Option<Order>,
    elements: Vec<Element>,
    lines: usize,
}

impl Header {
    fn read(bytes: &[u8]) -> Result<(Header, usize), MeshError> {
        let mut header = Header {
            order: None,
            elements: Vec::new(),
            lines: 0,
        };
        let mut formatted = false;
        let mut at = 0;
        loop {
            let rest = &bytes[at..];
            let end = rest.iter().position(|b| *b == b'\n');
            let end = end.ok_or_else(|| MeshError::Cut("its header".into()))?;
            at += end + 1;
            header.lines += 1;
            let line = header.lines;
            let bad = |reason: String| MeshError::Line { line, reason };
            let words = String::from_utf8_lossy(rest[..end].trim_ascii()).into_owned();
            let words: Vec<&str> = words.split_ascii_whitespace().collect();
            if line == 1 {
                if words != ["ply"] {
                    return Err(bad("a PLY file begins with `ply`".into()));
                }
                continue;
            }
            match words[..] {
                ["format", format, _] => {
                    header.order = match format {
                        "ascii" => None,
                        "binary_little_endian" => Some(Order::Little),
                        "binary_big_endian" => Some(Order::Big),
                        _ => {
                            let format = shortened(format);
                            return Err(bad(format!("there is no format \"{format}\"")));
                        }
                    };
                    formatted = true;
                }
                ["element", name, count] => {
                    let count = count.parse().map_err(|_| {
                        bad(format!("\"{}\" is no number of elements", shortened(count)))
                    })?;
                    header.elements.push(Element {
                        name: name.to_owned(),
                        count,
                        properties: Vec::new(),
                        odd: None,
                    });
                }
                ["property", ..] => {
                    let element = header.elements.last_mut();
                    let element =
                        element.ok_or_else(|| bad("a property of no element".to_string()))?;
                    match property(&words) {
                        Ok(property) => element.properties.push(property),
                        Err(reason) => element.odd = Some((line, reason)),
                    }
                }
                ["end_header"] => break,
                [] | ["comment" | "obj_info", ..] => {}
                [word, ..] => {
                    return Err(bad(format!(
                        "\"{}\" is no line of a header",
                        shortened(word)
                    )));
                }
            }
            let properties: usize = header.elements.iter().map(|e| 1 + e.properties.len()).sum();
            if properties > MOST {
                return Err(bad(format!("more than {MOST} elements and properties")));
            }
        }
        if !formatted {
            return Err(MeshError::Line {
                line: header.lines,
                reason: "the header names no format".into(),
            });
        }
        Ok((header, at))
    }

    /// What the header announces must be within the limits, and may be in the file: every element takes a byte at least.
    fn check(&self, length: usize, soup: &Soup) -> Result<(), MeshError> {
        for e in &self.elements {
            match e.name.as_str() {
                "vertex" => soup.check_points(e.count)?,
                "face" => soup.check_faces(e.count)?,
                _ => {}
            }
            let empty = self.order.is_some() && e.properties.is_empty();
            // the last line of a text may lack its end
            if !empty && e.count > length as u64 + 1 {
                return Err(MeshError::Cut(format!(
                    "its {} elements \"{}\", {length} bytes in all",
                    e.count,
                    shortened(&e.name)
                )));
            }
            if let Some((line, reason)) = &e.odd
                && (self.order.is_some() || is_read(&e.name))
            {
                let (line, reason) = (*line, reason.clone());
                return Err(MeshError::Line { line, reason });
            }
            if e.name == "vertex" {
                for axis in ["x", "y", "z"] {
                    if !e
                        .properties
                        .iter()
                        .any(|p| p.name == axis && p.list.is_none())
                    {
                        return Err(MeshError::Unsupported(format!(
                            "its vertices have no property \"{axis}\""
                        )));
                    }
                }
            }
        }
        Ok(())
    }
}

fn is_read(element: &str) -> bool {
    matches!(element, "vertex" | "face" | "tristrips")
}

fn property(words: &[&str]) -> Result<Property, String> {
    let kind = |word: &str| {
        Kind::of(word).ok_or_else(|| format!("\"{}\" is no type of numbers", shortened(word)))
    };
    match *words {
        ["property", "list", count, item, name] => {
            let count = kind(count)?;
            if matches!(count, Kind::F32 | Kind::F64) {
                return Err("the length of a list is a whole number".into());
            }
            Ok(Property {
                name: name.to_owned(),
                kind: kind(item)?,
                list: Some(count),
            })
        }
        ["property", item, name] => Ok(Property {
            name: name.to_owned(),
            kind: kind(item)?,
            list: None,
        }),
        _ => Err("a property is `property TYPE NAME` or `property list TYPE TYPE NAME`".into()),
    }
}

/// What the values of an element become.
struct Sink {
    axes: [usize; 3],
    corners: Option<usize>,
    strips: bool,
    point: [f32; 3],
    list: Vec<i64>,
}

impl Sink {
    fn new(element: &Element) -> Sink {
        let find = |name: &str| element.properties.iter().position(|p| p.name == name);
        let axis = |name: &str| match element.name.as_str() {
            "vertex" => find(name).unwrap_or(usize::MAX),
            _ => usize::MAX,
        };
        let is_face = matches!(element.name.as_str(), "face" | "tristrips");
        let corners = (find("vertex_indices").or_else(|| find("vertex_index")))
            .filter(|i| is_face && element.properties[*i].list.is_some());
        Sink {
            axes: [axis("x"), axis("y"), axis("z")],
            corners,
            strips: element.name == "tristrips",
            point: [0.0; 3],
            list: Vec::new(),
        }
    }

    fn value(&mut self, property: usize, x: f64) {
        if let Some(k) = self.axes.iter().position(|a| *a == property) {
            self.point[k] = x as f32;
        }
    }

    fn done(&mut self, element: &Element, soup: &mut Soup) -> Result<(), MeshError> {
        if element.name == "vertex" {
            return soup.point(self.point);
        }
        if self.corners.is_none() {
            return Ok(());
        }
        let list = std::mem::take(&mut self.list);
        if self.strips {
            // -1 begins another strip; every second triangle is turned around
            for strip in list.split(|c| *c == -1) {
                for (i, three) in strip.windows(3).enumerate() {
                    let [a, b, c] = [three[0], three[1], three[2]];
                    soup.polygon(&if i % 2 == 0 { [a, b, c] } else { [b, a, c] })?;
                }
            }
        } else {
            soup.polygon(&list)?;
        }
        self.list = list;
        self.list.clear();
        Ok(())
    }
}

/// Elements of a text, a line each.
fn text_body(header: &Header, bytes: &[u8], body: usize, soup: &mut Soup) -> Result<(), MeshError> {
    let mut lines = super::lines(&bytes[body..])
        .map(|(i, line)| (header.lines + i, line))
        .filter(|(_, line)| !line.is_empty());
    for element in &header.elements {
        let mut sink = Sink::new(element);
        for done in 0..element.count {
            let (at, line) = lines.next().ok_or_else(|| cut(element, done))?;
            if !is_read(&element.name) {
                continue;
            }
            let mut words = super::text(at, line)?.split_ascii_whitespace();
            for (i, property) in element.properties.iter().enumerate() {
                match property.list {
                    None if sink.axes.contains(&i) => {
                        sink.value(i, number(words.next(), at)?.into());
                    }
                    None => {
                        words.next();
                    }
                    Some(_) => {
                        let count = whole(words.next(), at)?;
                        for _ in 0..count {
                            // a list cannot be longer than its line
                            let item = words.next();
                            if item.is_none() || sink.corners == Some(i) {
                                sink.list.push(whole(item, at)?);
                            }
                        }
                    }
                }
            }
            sink.done(element, soup)?;
        }
    }
    Ok(())
}

fn cut(element: &Element, done: u64) -> MeshError {
    MeshError::Cut(format!(
        "\"{}\" number {} of {}",
        shortened(&element.name),
        done + 1,
        element.count
    ))
}

fn whole(word: Option<&str>, line: usize) -> Result<i64, MeshError> {
    let bad = |reason: String| MeshError::Line { line, reason };
    let word = word.ok_or_else(|| bad("a list is shorter than it says".into()))?;
    word.parse()
        .map_err(|_| bad(format!("\"{}\" is no whole number", shortened(word))))
}

struct Binary<'a> {
    bytes: &'a [u8],
    at: usize,
    order: Order,
}

impl Binary<'_> {
    fn number(&mut self, kind: Kind) -> Option<f64> {
        let size = kind.bytes();
        let bytes = self.bytes.get(self.at..self.at + size)?;
        self.at += size;
        let mut b = [0; 8];
        b[..size].copy_from_slice(bytes);
        if matches!(self.order, Order::Big) {
            b[..size].reverse();
        }
        let four = [b[0], b[1], b[2], b[3]];
        Some(match kind {
            Kind::I8 => i8::from_le_bytes([b[0]]).into(),
            Kind::U8 => b[0].into(),
            Kind::I16 => i16::from_le_bytes([b[0], b[1]]).into(),
            Kind::U16 => u16::from_le_bytes([b[0], b[1]]).into(),
            Kind::I32 => i32::from_le_bytes(four).into(),
            Kind::U32 => u32::from_le_bytes(four).into(),
            Kind::F32 => f32::from_le_bytes(four).into(),
            Kind::F64 => f64::from_le_bytes(b),
        })
    }
}

fn binary_body(header: &Header, from: &mut Binary<'_>, soup: &mut Soup) -> Result<(), MeshError> {
    for element in &header.elements {
        let mut sink = Sink::new(element);
        if element.properties.is_empty() {
            continue;
        }
        for done in 0..element.count {
            for (i, property) in element.properties.iter().enumerate() {
                let Some(kind) = property.list else {
                    let x = from
                        .number(property.kind)
                        .ok_or_else(|| cut(element, done))?;
                    sink.value(i, x);
                    continue;
                };
                let count = from.number(kind).ok_or_else(|| cut(element, done))?;
                let bytes = (count as u64).saturating_mul(property.kind.bytes() as u64);
                let left = (from.bytes.len() - from.at) as u64;
                if count < 0.0 || bytes > left {
                    return Err(MeshError::Byte {
                        at: from.at,
                        reason: format!("a list of {count} numbers where {left} bytes are left"),
                    });
                }
                if sink.corners == Some(i) {
                    for _ in 0..count as u64 {
                        let x = from
                            .number(property.kind)
                            .ok_or_else(|| cut(element, done))?;
                        sink.list.push(x as i64);
                    }
                } else {
                    from.at += bytes as usize;
                }
            }
            sink.done(element, soup)?;
        }
    }
    Ok(())
}
