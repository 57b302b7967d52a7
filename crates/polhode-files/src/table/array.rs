//! Arrays of NumPy (`.npy`) as the lines of text that their numbers print as, so that they are read like any other table.
//!
//! Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays", versions 1.0 to 3.0.

use std::io::{self, BufRead, Read};

/// How an array begins.
pub(crate) const MAGIC: &[u8] = b"\x93NUMPY";

/// The head of an array is no longer than this many bytes.
const LONGEST_HEAD: usize = 1 << 20;

/// The numbers of one kind in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Kind {
    letter: u8,
    bytes: usize,
    is_big: bool,
}

/// A row of an array of records, or of an array of one or two dimensions.
#[derive(Clone, Debug, PartialEq)]
struct Head {
    /// A kind a number of the row.
    kinds: Vec<Kind>,
    /// A name a number, where the array has names.
    names: Vec<String>,
    rows: u64,
}

/// An array read as text: a line of names where it has them, then a line a row.
pub(crate) struct ArrayText<R> {
    inner: R,
    head: Head,
    row: u64,
    bytes: Vec<u8>,
    text: Vec<u8>,
    at: usize,
}

impl<R: BufRead> ArrayText<R> {
    /// Of a reader that stands at the mark of such a file.
    ///
    /// # Errors
    /// What stands there is no array of numbers in rows.
    pub(crate) fn new(mut inner: R) -> io::Result<Self> {
        let mut start = [0; 8];
        inner.read_exact(&mut start)?;
        let mut length = vec![0; if start[6] == 1 { 2 } else { 4 }];
        inner.read_exact(&mut length)?;
        let length = length.iter().rev().fold(0, |sum, byte| 256 * sum + usize::from(*byte));
        if length > LONGEST_HEAD {
            return Err(refused(format!("its head has {length} bytes, and at most {LONGEST_HEAD} are read")));
        }
        let mut text = vec![0; length];
        inner.read_exact(&mut text)?;
        let head = Head::parse(&String::from_utf8_lossy(&text))?;
        let mut names = head.names.join(",").into_bytes();
        if !names.is_empty() {
            names.push(b'\n');
        }
        let bytes = vec![0; head.kinds.iter().map(|kind| kind.bytes).sum()];
        Ok(Self { inner, head, row: 0, bytes, text: names, at: 0 })
    }

    fn print_row(&mut self) -> io::Result<()> {
        self.row += 1;
        self.inner.read_exact(&mut self.bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => {
                refused(format!("the array ends within row {} of {}", self.row, self.head.rows))
            }
            _ => error,
        })?;
        (self.at, self.text) = (0, Vec::with_capacity(24 * self.head.kinds.len()));
        let mut rest = &self.bytes[..];
        for kind in &self.head.kinds {
            let (own, behind) = rest.split_at(kind.bytes);
            rest = behind;
            if !self.text.is_empty() {
                self.text.push(b',');
            }
            self.text.extend(kind.text(own).as_bytes());
        }
        self.text.push(b'\n');
        Ok(())
    }
}

impl<R: BufRead> Read for ArrayText<R> {
    fn read(&mut self, into: &mut [u8]) -> io::Result<usize> {
        let from = self.fill_buf()?;
        let count = from.len().min(into.len());
        into[..count].copy_from_slice(&from[..count]);
        self.consume(count);
        Ok(count)
    }
}

impl<R: BufRead> BufRead for ArrayText<R> {
    fn fill_buf(&mut self) -> io::Result<&[u8]> {
        if self.at == self.text.len() {
            if self.row < self.head.rows {
                self.print_row()?;
            } else if !self.inner.fill_buf()?.is_empty() {
                let rows = self.head.rows;
                return Err(refused(format!(
                    "bytes follow the last of its {rows} rows; save a single array"
                )));
            }
        }
        Ok(&self.text[self.at..])
    }

    fn consume(&mut self, amount: usize) {
        self.at = self.text.len().min(self.at + amount);
    }
}

fn refused(rule: String) -> io::Error {
    io::Error::new(io::ErrorKind::InvalidData, rule)
}

impl Kind {
    /// Of a type as NumPy writes it, such as `<f8`.
    fn parse(text: &str) -> io::Result<Self> {
        let unknown = || refused(format!("numbers of the type '{text}' are not read; save them as float64"));
        let [order, letter, size @ ..] = text.as_bytes() else { return Err(unknown()) };
        let kind = match (letter, size) {
            (b'f', b"4" | b"8") | (b'i' | b'u', b"1" | b"2" | b"4" | b"8") => {
                Self { letter: *letter, bytes: usize::from(size[0] - b'0'), is_big: *order == b'>' }
            }
            _ => return Err(unknown()),
        };
        if matches!(order, b'<' | b'>') || kind.bytes == 1 { Ok(kind) } else { Err(unknown()) }
    }

    /// The number as the shortest text that gives it back.
    fn text(self, bytes: &[u8]) -> String {
        let mut word = [0; 8];
        for (place, byte) in bytes.iter().enumerate() {
            word[if self.is_big { self.bytes - 1 - place } else { place }] = *byte;
        }
        let bits = u64::from_le_bytes(word);
        match (self.letter, self.bytes) {
            (b'f', 8) => format!("{:?}", f64::from_bits(bits)),
            (b'f', _) => format!("{:?}", f32::from_bits(bits as u32)),
            (b'u', _) => bits.to_string(),
            // the sign of the highest bit of the number
            (_, bytes) => ((bits << (64 - 8 * bytes)) as i64 >> (64 - 8 * bytes)).to_string(),
        }
    }
}

impl Head {
    /// Of a dictionary as Python writes it.
    fn parse(text: &str) -> io::Result<Self> {
        let value = |key: &str| {
            let after = text.split_once(&format!("'{key}':")).map(|(_, after)| after.trim_start());
            after.ok_or_else(|| refused(format!("its head names no {key}")))
        };
        if !value("fortran_order")?.starts_with("False") {
            return Err(refused(
                "it is stored by columns; save it by rows, with numpy.ascontiguousarray".into(),
            ));
        }
        let shape = tuple(value("shape")?)?;
        let (rows, width) = match shape[..] {
            [rows] => (rows, 1),
            [rows, width] => (rows, width),
            _ => return Err(refused(format!("it has {} dimensions; save rows of numbers", shape.len()))),
        };
        let (mut kinds, mut names) = (Vec::new(), Vec::new());
        let described = value("descr")?;
        if let Some(list) = described.strip_prefix('[') {
            for entry in list.split(']').next().unwrap_or_default().split("('").skip(1) {
                let part = |n: usize| entry.split('\'').nth(n).unwrap_or_default();
                let kind = Kind::parse(part(2))?;
                let inner =
                    entry.split_once("', (").map(|(_, inner)| tuple(&format!("({inner}"))).transpose()?;
                let name = part(0).replace(',', "_");
                for suffix in suffixes(&inner.unwrap_or_default())? {
                    kinds.push(kind);
                    names.push(format!("{name}{suffix}"));
                }
            }
            if width != 1 {
                return Err(refused("records stand in several columns; save one column of records".into()));
            }
        } else {
            let kind = Kind::parse(described.split('\'').nth(1).unwrap_or_default())?;
            if width > MOST_COLUMNS {
                return Err(refused(format!("its rows have {width} numbers; save a row a time")));
            }
            kinds = vec![kind; usize::try_from(width).unwrap_or_default()];
        }
        Ok(Self { kinds, names, rows })
    }
}

/// More numbers than these are no row of a record.
const MOST_COLUMNS: u64 = 10_000;

/// The numbers in brackets that a text begins with.
fn tuple(text: &str) -> io::Result<Vec<u64>> {
    let inside = text.strip_prefix('(').and_then(|text| text.split(')').next());
    let numbers = inside.unwrap_or("?").split(',').map(str::trim).filter(|number| !number.is_empty());
    let numbers: Result<Vec<u64>, _> = numbers.map(str::parse).collect();
    numbers.map_err(|_| refused("its head has no shape of whole numbers".into()))
}

/// What tells the numbers of an inner array apart.
fn suffixes(shape: &[u64]) -> io::Result<Vec<String>> {
    match *shape {
        [] => Ok(vec![String::new()]),
        [n] if n <= 9 => Ok((0..n).map(|k| format!("_{k}")).collect()),
        [n, m] if n <= 9 && m <= 9 && n * m <= 9 => {
            Ok((0..n * m).map(|k| format!("_{}{}", k / m, k % m)).collect())
        }
        _ => Err(refused("its records hold arrays of more than 9 numbers".into())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(head: &str, bytes: &[u8]) -> Vec<u8> {
        let length = (head.len() as u16).to_le_bytes();
        [MAGIC, &[1, 0], &length, head.as_bytes(), bytes].concat()
    }

    fn read(file: &[u8]) -> io::Result<String> {
        let mut text = String::new();
        ArrayText::new(file)?.read_to_string(&mut text)?;
        Ok(text)
    }

    #[test]
    fn arrays_print_their_shortest_digits() {
        let head = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 2), }";
        let numbers = [0.1, -2.0, 1e-300, 3.0_f64].map(f64::to_le_bytes).concat();
        assert_eq!(read(&file(head, &numbers)).unwrap(), "0.1,-2.0\n1e-300,3.0\n");
        let head = "{'descr': [('t', '>i4'), ('q', '<f4', (2,))], 'fortran_order': False, 'shape': (1,), }";
        let row = [(-7_i32).to_be_bytes(), 0.1_f32.to_le_bytes(), 1_f32.to_le_bytes()].concat();
        assert_eq!(read(&file(head, &row)).unwrap(), "t,q_0,q_1\n-7,0.1,1.0\n");
    }

    #[test]
    fn what_is_behind_an_array_is_refused() {
        let one = file("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }", &[0; 16]);
        assert_eq!(read(&one).unwrap(), "0.0\n0.0\n");
        for more in [&one[..], b"\n"] {
            let message = read(&[&one[..], more].concat()).unwrap_err().to_string();
            assert!(message.contains("follow the last of its 2 rows"), "{message}");
        }
    }

    #[test]
    fn what_is_no_array_of_rows_is_refused() {
        let message = |head: &str| read(&file(head, &[0; 12])).unwrap_err().to_string();
        let of = |descr: &str, order: &str, shape: &str| {
            message(&format!("{{'descr': {descr}, 'fortran_order': {order}, 'shape': {shape}, }}"))
        };
        assert!(of("'<f8'", "False", "(2, 1)").contains("ends within row 2 of 2"));
        assert!(of("'<f8'", "True", "(1, 1)").contains("ascontiguousarray"));
        assert!(of("'<c16'", "False", "(1, 1)").contains("'<c16' are not read"));
        assert!(of("'<f8'", "False", "(1, 1, 1)").contains("3 dimensions"));
        assert!(of("'<f8'", "False", "(1, 99999999999)").contains("99999999999 numbers"));
        assert!(of("'<f8'", "False", "(1, x)").contains("no shape"));
        assert!(of("[('a', '<f8', (99,))]", "False", "(1,)").contains("more than 9"));
        assert!(message("{}").contains("fortran_order"));
        assert!(read(MAGIC).is_err());
    }
}
