//! Modes 1 and 2: the indices of triangles, and any others.

const TRIANGLES_HEADER: u8 = 0xe1;
const SEQUENCE_HEADER: u8 = 0xd1;

const ENDS: &str = "the compressed indices end early";

/// What follows the codes of triangles.
struct Data<'a> {
    bytes: &'a [u8],
    last: u32,
}

impl Data<'_> {
    fn byte(&mut self) -> Result<u8, String> {
        let (&byte, rest) = self.bytes.split_first().ok_or(ENDS)?;
        self.bytes = rest;
        Ok(byte)
    }

    /// An integer of seven bits a byte.
    fn varint(&mut self) -> Result<u32, String> {
        let mut value = 0;
        let mut shift = 0;
        loop {
            let byte = self.byte()?;
            if shift > 28 {
                return Err("a compressed index has more than 32 bits".to_owned());
            }
            value |= u32::from(byte & 0x7f) << shift;
            shift += 7;
            if byte & 0x80 == 0 {
                return Ok(value);
            }
        }
    }

    fn index(&mut self) -> Result<u32, String> {
        let v = self.varint()?;
        self.last = self.last.wrapping_add(unzigzag(v));
        Ok(self.last)
    }
}

fn unzigzag(v: u32) -> u32 {
    if v & 1 == 0 { v >> 1 } else { !(v >> 1) }
}

/// The latest 16 of what was pushed, the latest first.
struct Fifo<T> {
    entries: [T; 16],
    n_pushed: usize,
}

impl<T: Copy + Default> Fifo<T> {
    fn new() -> Self {
        Self { entries: [T::default(); 16], n_pushed: 0 }
    }

    fn push(&mut self, entry: T) {
        self.entries[self.n_pushed % 16] = entry;
        self.n_pushed = self.n_pushed.wrapping_add(1);
    }

    fn get(&self, age: usize) -> T {
        self.entries[self.n_pushed.wrapping_sub(1 + age) % 16]
    }
}

/// The next new index.
fn step(next: &mut u32) -> u32 {
    let index = *next;
    *next = index.wrapping_add(1);
    index
}

/// Decodes `count` indices, three for each triangle.
pub(super) fn triangles(data: &[u8], count: usize) -> Result<Vec<u32>, String> {
    if !count.is_multiple_of(3) {
        return Err(format!("{count} indices do not make triangles"));
    }
    if data.first() != Some(&TRIANGLES_HEADER) {
        return Err("the compressed triangles do not start with 0xe1".to_owned());
    }
    let tail_start = data.len().checked_sub(16).filter(|&start| start >= 1).ok_or(ENDS)?;
    let (body, table) = data[1..].split_at(tail_start - 1);
    let (codes, rest) = body.split_at_checked(count / 3).ok_or(ENDS)?;
    let mut data = Data { bytes: rest, last: 0 };
    let mut edges = Fifo::<[u32; 2]>::new();
    let mut vertices = Fifo::<u32>::new();
    let mut next = 0_u32;
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        let (x, y) = (usize::from(code >> 4), usize::from(code & 15));
        if x < 15 {
            // A known edge, and a vertex.
            let [a, b] = edges.get(x);
            let c = match y {
                0 => step(&mut next),
                1..=12 => vertices.get(y),
                13 => data.last.wrapping_sub(1),
                14 => data.last.wrapping_add(1),
                _ => data.index()?,
            };
            if matches!(y, 13 | 14) {
                data.last = c;
            }
            if !(1..=12).contains(&y) {
                vertices.push(c);
            }
            edges.push([c, b]);
            edges.push([a, c]);
            indices.extend([a, b, c]);
            continue;
        }
        let (a, z, w) = if y < 14 {
            let aux = table[y];
            // The table cannot ask for indices of their own.
            if aux >> 4 == 15 || aux & 15 == 15 {
                return Err("the table of compressed triangles is damaged".to_owned());
            }
            (step(&mut next), aux >> 4, aux & 15)
        } else {
            let aux = data.byte()?;
            if aux == 0 {
                next = 0;
            }
            let a = if y == 14 { step(&mut next) } else { data.index()? };
            (a, aux >> 4, aux & 15)
        };
        let mut corner = |nibble: u8| match nibble {
            0 => Ok(step(&mut next)),
            15 => data.index(),
            age => Ok(vertices.get(usize::from(age) - 1)),
        };
        let b = corner(z)?;
        let c = corner(w)?;
        vertices.push(a);
        for (nibble, vertex) in [(z, b), (w, c)] {
            if matches!(nibble, 0 | 15) {
                vertices.push(vertex);
            }
        }
        for edge in [[b, a], [c, b], [a, c]] {
            edges.push(edge);
        }
        indices.extend([a, b, c]);
    }
    if data.bytes.is_empty() {
        Ok(indices)
    } else {
        Err("compressed indices are left over".to_owned())
    }
}

/// Decodes `count` indices.
pub(super) fn sequence(data: &[u8], count: usize) -> Result<Vec<u32>, String> {
    if data.first() != Some(&SEQUENCE_HEADER) {
        return Err("the compressed indices do not start with 0xd1".to_owned());
    }
    let end = data.len().checked_sub(4).filter(|&end| end >= 1).ok_or(ENDS)?;
    let mut data = Data { bytes: &data[1..end], last: 0 };
    if count > data.bytes.len() {
        return Err(ENDS.to_owned());
    }
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let v = data.varint()?;
        let baseline = &mut last[(v & 1) as usize];
        *baseline = baseline.wrapping_add(unzigzag(v >> 1));
        indices.push(*baseline);
    }
    if data.bytes.is_empty() {
        Ok(indices)
    } else {
        Err("compressed indices are left over".to_owned())
    }
}
