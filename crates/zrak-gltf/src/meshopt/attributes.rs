//! Mode 0: attributes, as differences of their bytes.

const HEADER: u8 = 0xa0;
/// Elements of a group.
const GROUP: usize = 16;
/// Elements of a block at most.
const BLOCK_MAX: usize = 256;

/// Decodes `count` elements of `stride` bytes, at most 256.
pub(super) fn decode(data: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, String> {
    let ends = || "the compressed attributes end early".to_owned();
    if data.first() != Some(&HEADER) {
        return Err("the compressed attributes do not start with 0xa0".to_owned());
    }
    // The first element's predecessor is at the end, in at least 32 bytes.
    let tail = stride.max(32);
    let body_end = data.len().checked_sub(tail).filter(|&end| end >= 1).ok_or_else(ends)?;
    let mut body = &data[1..body_end];
    let mut previous = data[data.len() - stride..].to_vec();
    // Every group costs at least the two bits of its header in every byte's stream.
    if count.div_ceil(GROUP).div_ceil(4).saturating_mul(stride) > body.len() {
        return Err(ends());
    }
    let mut bytes = vec![0; count * stride];
    let block_max = ((8192 / stride) & !(GROUP - 1)).min(BLOCK_MAX);
    for block in bytes.chunks_mut(block_max * stride) {
        let n = block.len() / stride;
        let mut deltas = [0; BLOCK_MAX];
        for k in 0..stride {
            let n_groups = n.div_ceil(GROUP);
            let headers = take(&mut body, n_groups.div_ceil(4)).ok_or_else(ends)?;
            for (g, deltas) in deltas.chunks_exact_mut(GROUP).take(n_groups).enumerate() {
                let mode = headers[g / 4] >> (g % 4 * 2) & 3;
                group(&mut body, mode, deltas).ok_or_else(ends)?;
            }
            let mut value = previous[k];
            for (i, delta) in deltas.iter().enumerate().take(n) {
                value = value.wrapping_add(unzigzag(*delta));
                block[i * stride + k] = value;
            }
            previous[k] = value;
        }
    }
    if body.is_empty() { Ok(bytes) } else { Err("compressed attributes are left over".to_owned()) }
}

fn take<'a>(body: &mut &'a [u8], n: usize) -> Option<&'a [u8]> {
    let (taken, rest) = body.split_at_checked(n)?;
    *body = rest;
    Some(taken)
}

fn group(body: &mut &[u8], mode: u8, deltas: &mut [u8]) -> Option<()> {
    let bits = match mode {
        0 => {
            deltas.fill(0);
            return Some(());
        }
        3 => {
            deltas.copy_from_slice(take(body, GROUP)?);
            return Some(());
        }
        mode => 2 * usize::from(mode),
    };
    // A value of all ones stands for a byte of its own, after the packed ones.
    let sentinel = (1 << bits) - 1;
    let packed = take(body, GROUP * bits / 8)?;
    let per_byte = 8 / bits;
    for (i, delta) in deltas.iter_mut().enumerate() {
        let shift = (per_byte - 1 - i % per_byte) * bits;
        *delta = packed[i / per_byte] >> shift & sentinel;
        if *delta == sentinel {
            *delta = take(body, 1)?[0];
        }
    }
    Some(())
}

fn unzigzag(v: u8) -> u8 {
    if v & 1 == 0 { v >> 1 } else { !(v >> 1) }
}
