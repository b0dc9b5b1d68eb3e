//! What Blosc 1 packed with LZ4 or not at all, as OpenVDB uses it: blocks of shuffled bytes (Alted 2010; the LZ4 block format of Collet).

/// The bytes that a Blosc buffer stands for, `length` of them. `None` where it is damaged or packed in another way.
pub(super) fn unpack(packed: &[u8], length: usize) -> Option<Vec<u8>> {
    let word = |at: usize| -> Option<usize> {
        let bytes = packed.get(at..at + 4)?.try_into().ok()?;
        Some(u32::from_le_bytes(bytes) as usize)
    };
    let (flags, size) = (*packed.get(2)?, usize::from(*packed.get(3)?));
    let (bytes, block) = (word(4)?, word(8)?);
    if bytes != length || size == 0 {
        return None;
    }
    if flags & 2 != 0 {
        return Some(packed.get(16..16 + length)?.to_vec());
    }
    // LZ4 is method 1; bits and not bytes may be shuffled
    if block == 0 || flags >> 5 != 1 || flags & 4 != 0 {
        return None;
    }
    let mut out = Vec::with_capacity(length);
    for (i, start) in (0..length).step_by(block).enumerate() {
        let whole = block.min(length - start);
        let mut at = word(16 + 4 * i)?;
        // a block that is short, and every block with this flag, is one stream, else there is one for each byte of a number
        let streams = if flags & 0x10 != 0 || whole != block || size > 16 || block / size < 128 {
            1
        } else {
            size
        };
        let mut bytes = Vec::with_capacity(whole);
        for _ in 0..streams {
            let part = whole / streams;
            let stored = word(at)?;
            let stream = packed.get(at + 4..(at + 4).checked_add(stored)?)?;
            at += 4 + stored;
            if stored == part {
                bytes.extend_from_slice(stream);
            } else {
                lz4(stream, part, &mut bytes)?;
            }
        }
        if bytes.len() != whole {
            return None;
        }
        if flags & 1 != 0 && size > 1 {
            let numbers = whole / size;
            let from = out.len();
            out.resize(from + whole, 0);
            let to: &mut [u8] = &mut out[from..];
            for n in 0..numbers {
                for b in 0..size {
                    to[n * size + b] = bytes[b * numbers + n];
                }
            }
            let rest = numbers * size;
            to[rest..].copy_from_slice(&bytes[rest..]);
        } else {
            out.extend_from_slice(&bytes);
        }
    }
    Some(out)
}

/// Appends the `length` bytes of an LZ4 block.
fn lz4(packed: &[u8], length: usize, out: &mut Vec<u8>) -> Option<()> {
    let first = out.len();
    let end = first + length;
    let mut at = 0;
    let next = |at: &mut usize| -> Option<u8> {
        let b = *packed.get(*at)?;
        *at += 1;
        Some(b)
    };
    while out.len() < end {
        let token = next(&mut at)?;
        let longer = |short: u8, at: &mut usize| -> Option<usize> {
            let mut n = usize::from(short);
            if short == 15 {
                loop {
                    let more = next(at)?;
                    n += usize::from(more);
                    if more != 255 {
                        break;
                    }
                }
            }
            Some(n)
        };
        let literals = longer(token >> 4, &mut at)?;
        if out.len() + literals > end {
            return None;
        }
        out.extend_from_slice(packed.get(at..at + literals)?);
        at += literals;
        if out.len() == end {
            break;
        }
        let back =
            usize::from(packed.get(at).copied()?) | usize::from(packed.get(at + 1).copied()?) << 8;
        at += 2;
        let copied = longer(token & 15, &mut at)? + 4;
        if back == 0 || back > out.len() - first || out.len() + copied > end {
            return None;
        }
        for _ in 0..copied {
            out.push(out[out.len() - back]);
        }
    }
    Some(())
}
