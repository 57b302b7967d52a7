//! PLY files, text and binary.
//!
//! G. Turk, The PLY polygon file format (1994): a header that names elements and their properties, then the elements.

use std::io::BufRead;

use nalgebra::Vector3;
use polhode::inertia::{Surface, SurfaceBuilder};

use super::MeshFileError;
use super::text::{Lines, beginning};

/// A list has no more numbers than this.
pub(super) const LONGEST_LIST: u64 = 1 << 20;

#[derive(Clone, Copy, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

#[derive(Clone, Copy)]
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
    fn named(name: &str) -> Option<Kind> {
        Some(match name {
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

    /// The number in the first bytes of `b`, the least significant byte first.
    fn value(self, b: [u8; 8]) -> f64 {
        let four = [b[0], b[1], b[2], b[3]];
        match self {
            Kind::I8 => f64::from(b[0] as i8),
            Kind::U8 => f64::from(b[0]),
            Kind::I16 => f64::from(i16::from_le_bytes([b[0], b[1]])),
            Kind::U16 => f64::from(u16::from_le_bytes([b[0], b[1]])),
            Kind::I32 => f64::from(i32::from_le_bytes(four)),
            Kind::U32 => f64::from(u32::from_le_bytes(four)),
            Kind::F32 => f64::from(f32::from_le_bytes(four)),
            Kind::F64 => f64::from_le_bytes(b),
        }
    }
}

struct Property {
    name: String,
    kind: Kind,
    /// Of a list, the kind of its length.
    length: Option<Kind>,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

/// The surface in a file of the kind PLY.
///
/// # Errors
/// A file of another kind, or one that ends too early, by its line or byte.
pub fn read(reader: impl BufRead) -> Result<Surface, MeshFileError> {
    sized(reader, None)
}

/// The same of a file of `size` bytes, in which elements that cannot be there are refused before they are looked for.
pub(super) fn sized(reader: impl BufRead, size: Option<u64>) -> Result<Surface, MeshFileError> {
    let mut lines = Lines::new(reader);
    let (encoding, elements) = header(&mut lines)?;
    let size = size.map(|size| size.saturating_sub(lines.bytes));
    check_counts(encoding, &elements, size)?;
    let mut numbers = Numbers { lines, encoding, words: Vec::new() };
    let mut vertices = Vec::new();
    let mut mesh = SurfaceBuilder::default();
    for element in &elements {
        let place = |names: &[&str]| {
            element.properties.iter().position(|property| names.contains(&property.name.as_str()))
        };
        let axes = [place(&["x"]), place(&["y"]), place(&["z"])];
        let corners = place(&["vertex_indices", "vertex_index"]);
        for number in 1..=element.count {
            let values = numbers.element(element, number)?;
            match (element.name.as_str(), axes, corners) {
                ("vertex", [Some(x), Some(y), Some(z)], _) => {
                    vertices.push([x, y, z].map(|k| values[k].first().copied().unwrap_or(f64::NAN)));
                }
                ("face", _, Some(corners)) => add(&mut mesh, &vertices, &values[corners], number)?,
                _ => {}
            }
        }
    }
    if let (Some(last), true) = (elements.last(), numbers.is_more()?) {
        return Err(MeshFileError::SurplusElements { element: last.name.clone(), announced: last.count });
    }
    Ok(mesh.finish()?)
}

/// Elements take bytes, or a count would be a loop without an end, and all of them as many as are left at most.
fn check_counts(encoding: Encoding, elements: &[Element], left: Option<u64>) -> Result<(), MeshFileError> {
    let mut needed = 0_u64;
    for Element { name, count, properties } in elements {
        if properties.is_empty() && *count > 0 {
            return Err(MeshFileError::NoProperties { element: name.clone(), announced: *count });
        }
        // a list may be empty, but its length is there; a number of a text is a digit and what parts it from the next
        let bytes = properties.iter().map(|property| match encoding {
            Encoding::Text => 2,
            Encoding::Little | Encoding::Big => property.length.unwrap_or(property.kind).bytes() as u64,
        });
        needed = needed.saturating_add(bytes.sum::<u64>().saturating_mul(*count));
        // nothing stands behind the last number of a text
        if let Some(left) = left.filter(|left| needed > left.saturating_add(1)) {
            return Err(MeshFileError::TooManyElements {
                element: name.clone(),
                announced: *count,
                needed,
                left,
            });
        }
    }
    Ok(())
}

/// A polygon, cut into triangles from its first corner.
fn add(
    mesh: &mut SurfaceBuilder,
    vertices: &[[f64; 3]],
    corners: &[f64],
    face: u64,
) -> Result<(), MeshFileError> {
    let at = |index: f64| {
        let place = (index >= 0.0 && index.fract() == 0.0).then_some(index as usize);
        let found = place.and_then(|place| vertices.get(place));
        found.map(|at| Vector3::from(*at)).ok_or(MeshFileError::Corner {
            face,
            index,
            vertices: vertices.len(),
        })
    };
    let [first, rest @ ..] = corners else { return Ok(()) };
    for pair in rest.windows(2) {
        mesh.add([at(*first)?, at(pair[0])?, at(pair[1])?])?;
    }
    Ok(())
}

fn header<R: BufRead>(lines: &mut Lines<R>) -> Result<(Encoding, Vec<Element>), MeshFileError> {
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut first = true;
    while let Some((line, text)) = lines.next()? {
        let syntax = |expected| MeshFileError::Syntax { line, found: beginning(text), expected };
        let words: Vec<&str> = text.split_ascii_whitespace().collect();
        if std::mem::take(&mut first) {
            if words != ["ply"] {
                return Err(syntax("'ply'"));
            }
            continue;
        }
        match words.as_slice() {
            ["format", kind, _version] => {
                encoding = Some(match *kind {
                    "ascii" => Encoding::Text,
                    "binary_little_endian" => Encoding::Little,
                    "binary_big_endian" => Encoding::Big,
                    _ => return Err(syntax("format ascii, binary_little_endian or binary_big_endian")),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| syntax("'element NAME COUNT'"))?;
                elements.push(Element { name: (*name).into(), count, properties: Vec::new() });
            }
            ["property", rest @ .., name] => {
                let (kind, length) = match rest {
                    ["list", length, kind] => (Kind::named(kind), Some(Kind::named(length))),
                    [kind] => (Kind::named(kind), None),
                    _ => (None, None),
                };
                let (Some(kind), Some(element)) = (kind, elements.last_mut()) else {
                    return Err(syntax("'property TYPE NAME' of an element"));
                };
                let length = match length {
                    Some(None) => return Err(syntax("'property list TYPE TYPE NAME' of an element")),
                    Some(length) => length,
                    None => None,
                };
                element.properties.push(Property { name: (*name).into(), kind, length });
            }
            ["end_header"] => {
                return encoding
                    .map(|encoding| (encoding, elements))
                    .ok_or(syntax("a line 'format ...' before"));
            }
            ["comment" | "obj_info", ..] | [] => {}
            _ => return Err(syntax("a line of the header of a PLY")),
        }
    }
    let line = lines.line + 1;
    Err(MeshFileError::Syntax { line, found: String::new(), expected: "'end_header'" })
}

/// The numbers behind the header.
struct Numbers<R> {
    lines: Lines<R>,
    encoding: Encoding,
    /// Of the line that is being read, the last one first.
    words: Vec<String>,
}

impl<R: BufRead> Numbers<R> {
    /// The values of every property; a scalar is a list of one.
    fn element(&mut self, element: &Element, number: u64) -> Result<Vec<Vec<f64>>, MeshFileError> {
        let truncated = || MeshFileError::TruncatedElements {
            element: element.name.clone(),
            number,
            announced: element.count,
        };
        let mut values = Vec::with_capacity(element.properties.len());
        for property in &element.properties {
            let length = match property.length {
                None => 1.0,
                Some(kind) => self.number(kind)?.ok_or_else(truncated)?,
            };
            if length < 0.0 || length.fract() != 0.0 {
                return Err(MeshFileError::ListLength { element: element.name.clone(), number, length });
            }
            let length = length as u64;
            if length > LONGEST_LIST {
                return Err(MeshFileError::LongList { element: element.name.clone(), number, length });
            }
            let mut list = Vec::new();
            for _ in 0..length {
                list.push(self.number(property.kind)?.ok_or_else(truncated)?);
            }
            values.push(list);
        }
        Ok(values)
    }

    /// Whether a text goes on with more than blanks, and a binary file at all.
    fn is_more(&mut self) -> Result<bool, MeshFileError> {
        if self.encoding != Encoding::Text {
            return Ok(self.number(Kind::U8)?.is_some());
        }
        if !self.words.is_empty() {
            return Ok(true);
        }
        while let Some((_, text)) = self.lines.next()? {
            if !text.trim().is_empty() {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The next number; `None` at the end of the file.
    fn number(&mut self, kind: Kind) -> Result<Option<f64>, MeshFileError> {
        if self.encoding == Encoding::Text {
            while self.words.is_empty() {
                let Some((_, text)) = self.lines.next()? else { return Ok(None) };
                self.words = text.split_ascii_whitespace().rev().map(str::to_owned).collect();
            }
            let Some(word) = self.words.pop() else { return Ok(None) };
            let line = self.lines.line;
            let value = word.parse().map_err(|_| MeshFileError::Syntax {
                line,
                found: beginning(&word),
                expected: "a number",
            });
            return value.map(Some);
        }
        let mut bytes = [0; 8];
        let found = &mut bytes[..kind.bytes()];
        match self.lines.reader().read_exact(found) {
            Ok(()) => {}
            Err(error) if error.kind() == std::io::ErrorKind::UnexpectedEof => return Ok(None),
            Err(error) => return Err(error.into()),
        }
        if self.encoding == Encoding::Big {
            found.reverse();
        }
        Ok(Some(kind.value(bytes)))
    }
}
