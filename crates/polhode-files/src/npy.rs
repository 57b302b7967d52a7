//! Arrays of doubles in NumPy's format, written and read piece by piece.
//!
//! Source: NumPy Enhancement Proposal 1, "A simple file format for NumPy arrays", version 1.0.

use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom, Write};

/// Bytes before the numbers; a multiple of 64, as the format asks.
const HEAD: usize = 128;

/// The head of an array of little-endian doubles in C order.
pub fn head(shape: [u64; 3]) -> Vec<u8> {
    let [a, b, c] = shape;
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({a}, {b}, {c}), }}");
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    head.extend(((HEAD - 10) as u16).to_le_bytes());
    head.extend(text.as_bytes());
    // three numbers of 20 digits leave room
    head.resize(HEAD - 1, b' ');
    head.push(b'\n');
    head
}

/// An array of `times` × `members` × N on its way to or from a file.
#[derive(Debug)]
pub struct Array<const N: usize> {
    file: File,
    times: u64,
    members: u64,
    bytes: Vec<u8>,
}

impl<const N: usize> Array<N> {
    /// A new one in an empty file; what is not written is zero.
    pub fn create(mut file: File, times: u64, members: u64) -> io::Result<Self> {
        file.write_all(&head([times, members, N as u64]))?;
        file.set_len(Self::size(times, members))?;
        Ok(Self { file, times, members, bytes: Vec::new() })
    }

    /// One that was written before.
    ///
    /// # Errors
    /// Head or size of another array.
    pub fn open(mut file: File, times: u64, members: u64) -> io::Result<Self> {
        let mut found = [0; HEAD];
        file.read_exact(&mut found)?;
        let size = file.metadata()?.len();
        if found[..] != head([times, members, N as u64]) || size != Self::size(times, members) {
            let message = format!("it is not a complete array of {times} x {members} x {N} doubles");
            return Err(io::Error::new(io::ErrorKind::InvalidData, message));
        }
        Ok(Self { file, times, members, bytes: Vec::new() })
    }

    /// Bytes of the file.
    pub fn size(times: u64, members: u64) -> u64 {
        let numbers = times.saturating_mul(members).saturating_mul(N as u64);
        numbers.saturating_mul(8).saturating_add(HEAD as u64)
    }

    fn seek(&mut self, time: u64, member: u64) -> io::Result<()> {
        let place = HEAD as u64 + (time * self.members + member) * N as u64 * 8;
        self.file.seek(SeekFrom::Start(place)).map(|_| ())
    }

    /// Writes the entries of the members from `first` on, at time number `time`.
    pub fn write(
        &mut self,
        time: u64,
        first: u64,
        entries: impl Iterator<Item = [f64; N]>,
    ) -> io::Result<()> {
        self.bytes.clear();
        self.bytes.extend(entries.flatten().flat_map(f64::to_le_bytes));
        self.seek(time, first)?;
        self.file.write_all(&self.bytes)
    }

    /// The bytes of all members at time number `time`.
    pub fn read(&mut self, time: u64) -> io::Result<&[u8]> {
        let size = usize::try_from(self.members.saturating_mul(8 * N as u64)).unwrap_or(usize::MAX);
        self.bytes.clear();
        self.bytes.try_reserve_exact(size).map_err(|_| {
            io::Error::new(
                io::ErrorKind::OutOfMemory,
                format!("{size} bytes of one time do not fit into memory"),
            )
        })?;
        self.bytes.resize(size, 0);
        self.seek(time, 0)?;
        self.file.read_exact(&mut self.bytes)?;
        Ok(&self.bytes)
    }

    /// The entries of all members at time number `time`.
    pub fn entries(&mut self, time: u64) -> io::Result<impl Iterator<Item = [f64; N]> + '_> {
        let numbers = self.read(time)?.as_chunks::<8>().0.as_chunks::<N>().0;
        Ok(numbers.iter().map(|entry| entry.map(f64::from_le_bytes)))
    }

    /// Number of times.
    pub fn times(&self) -> u64 {
        self.times
    }

    /// Number of members.
    pub fn members(&self) -> u64 {
        self.members
    }

    /// Puts everything on the disk.
    pub fn sync(&self) -> io::Result<()> {
        self.file.sync_all()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_head_is_that_of_numpy() {
        // numpy.save of zeros((2, 3, 4)) writes these bytes
        let mut expected =
            b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (2, 3, 4), }".to_vec();
        expected.resize(127, b' ');
        expected.push(b'\n');
        assert_eq!(head([2, 3, 4]), expected);
        assert_eq!(head([u64::MAX; 3]).len(), 128);
    }

    #[test]
    fn what_is_written_in_pieces_is_read_whole() {
        let file = || tempfile::tempfile().unwrap();
        let kept = file();
        let mut array = Array::<2>::create(kept.try_clone().unwrap(), 2, 3).unwrap();
        array.write(1, 1, [[5.0, -0.0], [6.5, 1e-300]].into_iter()).unwrap();
        array.write(0, 0, [[1.0, 2.0]].into_iter()).unwrap();
        array.sync().unwrap();
        let rows: Vec<Vec<[f64; 2]>> = (0..2).map(|time| array.entries(time).unwrap().collect()).collect();
        assert_eq!(rows[0], [[1.0, 2.0], [0.0; 2], [0.0; 2]]);
        assert_eq!(rows[1], [[0.0; 2], [5.0, -0.0], [6.5, 1e-300]]);
        let mut again = kept.try_clone().unwrap();
        again.rewind().unwrap();
        assert!(Array::<2>::open(again, 2, 4).unwrap_err().to_string().contains("not a complete array"));
        kept.set_len(130).unwrap();
        let mut short = kept;
        short.rewind().unwrap();
        assert!(Array::<2>::open(short, 2, 3).is_err());
    }
}
