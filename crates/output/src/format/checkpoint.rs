//! Checkpoints: pictures that converge, kept so that they go on where they were, to the bit.
//!
//! A file holds a picture's [identity](Identity), as text, and its sums. All numbers are little-endian; each part ends in its check sum
//! (CRC-32 of IEEE 802.3), so that what is damaged is told from what belongs to another picture:
//!
//! | bytes | what |
//! | --- | --- |
//! | 8 | `ZSETCKPT` |
//! | 4 | version of the format, 1 |
//! | 4 | bytes of the identity |
//! | ... | identity: a line `NAME TEXT` for each entry |
//! | 4 | check sum of all so far |
//! | 4, 8 | rounds, rays |
//! | 8 a cell | one over the rays of a pixel, summed over the rounds |
//! | 24 a pixel | moments |
//! | 4 a number | the sums that are kept, one after the other |
//! | 4 | check sum of all since the last one |
//!
//! A reader makes a picture first and fills it: a file says how much there is to read, never how much memory to take.

use crc32fast::Hasher;
use std::fs::{self, File};
use std::io::{self, BufReader, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use zeroset_scene::accumulator::Accumulator;
use zeroset_scene::progressive::{Cell, LEAST, MOST, Moments, Progressive};

const MAGIC: [u8; 8] = *b"ZSETCKPT";
/// The version of the format.
pub const VERSION: u32 = 1;
/// Most bytes of an identity.
const IDENTITY: u32 = 1 << 20;
/// Most rounds that a picture may have: longer than any machine runs.
const ROUNDS: u32 = 1 << 24;
/// Bytes that are turned into numbers at a time.
const CHUNK: usize = 1 << 16;

/// What a picture is of, and how it is made: entries, each with a name of letters and a text of one line. Two pictures with the same
/// identity are the same picture.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Identity {
    entries: Vec<(&'static str, String)>,
}

impl Identity {
    /// With one more entry.
    #[must_use]
    pub fn with(mut self, name: &'static str, text: impl Into<String>) -> Identity {
        let text = text.into().replace(['\n', '\r'], " ");
        self.entries.push((name, text));
        self
    }

    fn written(&self) -> String {
        let line = |(name, text): &(&str, String)| format!("{name} {text}\n");
        self.entries.iter().map(line).collect()
    }

    /// The first entry that another identity, as it is written, has not.
    fn difference(&self, held: &str) -> Option<Difference> {
        let text = |wanted: &str| {
            let texts = held.lines().filter_map(|line| line.split_once(' '));
            texts
                .filter(|(name, _)| *name == wanted)
                .map(|(_, text)| text.to_owned())
                .next()
        };
        self.entries.iter().find_map(|(name, wanted)| {
            let held = text(name);
            (held.as_ref() != Some(wanted)).then(|| Difference {
                what: name,
                held: held.unwrap_or_default(),
                wanted: wanted.clone(),
            })
        })
    }
}

/// What is not the same in two pictures.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Difference {
    /// The name of the entry.
    pub what: &'static str,
    /// What the file has there.
    pub held: String,
    /// What the picture has that would go on.
    pub wanted: String,
}

/// Why a picture cannot go on from a file.
#[derive(Debug, thiserror::Error)]
#[error("cannot go on from {}: {failure}", path.display())]
pub struct CheckpointError {
    /// The file.
    pub path: PathBuf,
    /// What went wrong.
    pub failure: CheckpointFailure,
}

/// What is wrong with a checkpoint.
#[derive(Debug, thiserror::Error)]
pub enum CheckpointFailure {
    /// What the system said.
    #[error("{0}")]
    System(#[source] io::Error),
    /// A folder, a device, a pipe.
    #[error("it is not a regular file")]
    Special,
    /// Some other file.
    #[error("it is not a checkpoint")]
    Format,
    /// The file of another version of the format.
    #[error("its format is version {0}, and {VERSION} is what this program reads")]
    Version(u32),
    /// A file that was cut off or changed.
    #[error("the file is damaged: {0}")]
    Damaged(&'static str),
    /// The file of another picture.
    #[error("it is of another picture: its {} differs", .0.what)]
    Foreign(Difference),
}

/// Writes a picture that converges.
///
/// # Errors
/// What the writer says.
pub fn write(writer: &mut dyn Write, identity: &Identity, picture: &Progressive) -> io::Result<()> {
    let text = identity.written();
    let length = u32::try_from(text.len()).ok().filter(|n| *n <= IDENTITY);
    let length = length.ok_or_else(|| io::Error::other("what the picture is of is too long"))?;
    let mut out = Checked::new(writer);
    out.put(&MAGIC)?;
    out.put(&VERSION.to_le_bytes())?;
    out.put(&length.to_le_bytes())?;
    out.put(text.as_bytes())?;
    out.seal()?;
    let state = picture.state();
    out.put(&state.rounds.to_le_bytes())?;
    out.put(&state.rays.to_le_bytes())?;
    for cell in state.cells {
        out.put(&cell.inverses.to_le_bytes())?;
    }
    for moment in state.moments.as_flattened() {
        out.put(&moment.to_le_bytes())?;
    }
    for sum in state.sums.kept() {
        for x in state.sums.sum(sum) {
            out.put(&x.to_le_bytes())?;
        }
    }
    out.seal()
}

/// Goes on from a file: `picture` is a new one with the same identity.
///
/// # Errors
/// See [`CheckpointFailure`]. The picture has no samples then.
pub fn resume(
    path: &Path,
    identity: &Identity,
    picture: &mut Progressive,
) -> Result<(), CheckpointError> {
    open(path)
        .and_then(|file| read(BufReader::new(file), identity, picture))
        .map_err(|failure| CheckpointError {
            path: path.to_owned(),
            failure,
        })
}

fn open(path: &Path) -> Result<File, CheckpointFailure> {
    // a pipe would be waited for
    let metadata = fs::metadata(path).map_err(CheckpointFailure::System)?;
    if !metadata.is_file() {
        return Err(CheckpointFailure::Special);
    }
    File::open(path).map_err(CheckpointFailure::System)
}

/// As [`resume`], from any reader.
///
/// # Errors
/// See [`CheckpointFailure`]. The picture has no samples then.
pub fn read(
    reader: impl Read,
    identity: &Identity,
    picture: &mut Progressive,
) -> Result<(), CheckpointFailure> {
    let mut from = Checking::new(reader);
    match from.bytes() {
        Ok(MAGIC) => {}
        Err(CheckpointFailure::System(error)) => return Err(CheckpointFailure::System(error)),
        _ => return Err(CheckpointFailure::Format),
    }
    let version = u32::from_le_bytes(from.bytes()?);
    if version != VERSION {
        return Err(CheckpointFailure::Version(version));
    }
    let length = u32::from_le_bytes(from.bytes()?);
    if length > IDENTITY {
        return Err(CheckpointFailure::Damaged("what it is of is too long"));
    }
    let mut text = vec![0; length as usize];
    from.fill(&mut text)?;
    from.check()?;
    let text = String::from_utf8(text);
    let text = text.map_err(|_| CheckpointFailure::Damaged("what it is of is no text"))?;
    if let Some(difference) = identity.difference(&text) {
        return Err(CheckpointFailure::Foreign(difference));
    }
    let rounds = u32::from_le_bytes(from.bytes()?);
    let rays = u64::from_le_bytes(from.bytes()?);
    let [width, height] = picture.size().map(u64::from);
    let most = u128::from(rounds) * u128::from(MOST) * u128::from(width * height);
    if rounds > ROUNDS || u128::from(rays) > most {
        return Err(CheckpointFailure::Damaged("no picture has so many samples"));
    }
    let fill = |cells: &mut [Cell], moments: &mut [Moments], sums: &mut Accumulator| {
        let [few, many] = [MOST, LEAST].map(|n| f64::from(rounds) / f64::from(n));
        for cell in cells {
            cell.inverses = f64::from_le_bytes(from.bytes()?);
            // a rounding more or less
            if !(cell.inverses >= 0.999 * few && cell.inverses <= 1.001 * many) {
                return Err(CheckpointFailure::Damaged(
                    "no cell has such a number of samples",
                ));
            }
        }
        from.numbers(moments.as_flattened_mut(), f64::from_le_bytes)?;
        for (_, numbers) in sums.sums_mut() {
            from.numbers(numbers, f32::from_le_bytes)?;
        }
        from.check()?;
        from.end()
    };
    picture.restore(rounds, rays, fill)
}

/// A writer that keeps a check sum.
struct Checked<'a> {
    writer: &'a mut dyn Write,
    sum: Hasher,
    held: Vec<u8>,
}

impl<'a> Checked<'a> {
    fn new(writer: &'a mut dyn Write) -> Checked<'a> {
        Checked {
            writer,
            sum: Hasher::new(),
            held: Vec::with_capacity(CHUNK + 8),
        }
    }

    fn put(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.held.extend_from_slice(bytes);
        if self.held.len() >= CHUNK {
            self.flush()?;
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.sum.update(&self.held);
        self.writer.write_all(&self.held)?;
        self.held.clear();
        Ok(())
    }

    /// Writes the check sum of what was put since the last one.
    fn seal(&mut self) -> io::Result<()> {
        self.flush()?;
        let sum = std::mem::take(&mut self.sum).finalize();
        self.writer.write_all(&sum.to_le_bytes())
    }
}

/// A reader that keeps a check sum.
struct Checking<R> {
    reader: R,
    sum: Hasher,
}

impl<R: Read> Checking<R> {
    fn new(reader: R) -> Checking<R> {
        Checking {
            reader,
            sum: Hasher::new(),
        }
    }

    fn exact(&mut self, to: &mut [u8]) -> Result<(), CheckpointFailure> {
        self.reader.read_exact(to).map_err(|e| match e.kind() {
            ErrorKind::UnexpectedEof => CheckpointFailure::Damaged("it ends too early"),
            _ => CheckpointFailure::System(e),
        })
    }

    fn fill(&mut self, to: &mut [u8]) -> Result<(), CheckpointFailure> {
        self.exact(to)?;
        self.sum.update(to);
        Ok(())
    }

    fn bytes<const N: usize>(&mut self) -> Result<[u8; N], CheckpointFailure> {
        let mut bytes = [0; N];
        self.fill(&mut bytes)?;
        Ok(bytes)
    }

    fn numbers<T, const N: usize>(
        &mut self,
        to: &mut [T],
        number: impl Fn([u8; N]) -> T,
    ) -> Result<(), CheckpointFailure> {
        let mut bytes = [0; CHUNK];
        for part in to.chunks_mut(CHUNK / N) {
            let bytes = &mut bytes[..part.len() * N];
            self.fill(bytes)?;
            for (x, bytes) in part.iter_mut().zip(bytes.as_chunks::<N>().0) {
                *x = number(*bytes);
            }
        }
        Ok(())
    }

    /// Compares with the check sum that comes next.
    fn check(&mut self) -> Result<(), CheckpointFailure> {
        let wanted = std::mem::take(&mut self.sum).finalize();
        let mut held = [0; 4];
        self.exact(&mut held)?;
        if u32::from_le_bytes(held) != wanted {
            return Err(CheckpointFailure::Damaged("its check sum is another one"));
        }
        Ok(())
    }

    /// That nothing comes any more.
    fn end(&mut self) -> Result<(), CheckpointFailure> {
        match self.exact(&mut [0]) {
            Err(CheckpointFailure::Damaged(_)) => Ok(()),
            Ok(()) => Err(CheckpointFailure::Damaged("it goes on behind its end")),
            Err(error) => Err(error),
        }
    }
}
