//! Filters of attributes, on little-endian numbers in place.

/// Unit vectors as points of an octahedron, each in three of four numbers.
pub(super) fn octahedral8(bytes: &mut [u8]) {
    for v in bytes.chunks_exact_mut(4) {
        let unit = octahedral([v[0], v[1], v[2]].map(|b| f64::from(b as i8)));
        for (byte, x) in v.iter_mut().zip(unit) {
            *byte = rounded(x * 127.0) as i8 as u8;
        }
    }
}

/// The same in numbers of 16 bits.
pub(super) fn octahedral16(bytes: &mut [u8]) {
    for v in bytes.chunks_exact_mut(8) {
        let number = |i: usize| f64::from(i16::from_le_bytes([v[2 * i], v[2 * i + 1]]));
        let unit = octahedral([number(0), number(1), number(2)]);
        for (bytes, x) in v.chunks_exact_mut(2).zip(unit) {
            bytes.copy_from_slice(&(rounded(x * 32767.0) as i16).to_le_bytes());
        }
    }
}

/// The third number is what 1 is.
fn octahedral([x, y, one]: [f64; 3]) -> [f64; 3] {
    let (mut x, mut y) = if one == 0.0 { (0.0, 0.0) } else { (x / one, y / one) };
    let z = 1.0 - x.abs() - y.abs();
    // The lower half is folded over the upper one.
    let fold = z.min(0.0);
    x += if x >= 0.0 { fold } else { -fold };
    y += if y >= 0.0 { fold } else { -fold };
    let length = (x * x + y * y + z * z).sqrt();
    [x, y, z].map(|x| x / length)
}

/// Unit quaternions without their largest component, which is positive.
pub(super) fn quaternion(bytes: &mut [u8]) {
    for v in bytes.chunks_exact_mut(8) {
        let number = |i: usize| i16::from_le_bytes([v[2 * i], v[2 * i + 1]]);
        let one = f64::from(number(3) | 3);
        let [x, y, z] =
            [0, 1, 2].map(|i| f64::from(number(i)) / one * std::f64::consts::FRAC_1_SQRT_2);
        let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
        let largest = (number(3) & 3) as usize;
        for (i, x) in [w, x, y, z].into_iter().enumerate() {
            let at = (largest + i) % 4 * 2;
            v[at..at + 2].copy_from_slice(&(rounded(x * 32767.0) as i16).to_le_bytes());
        }
    }
}

/// Numbers 2^e m, with e in the upper 8 bits and m in the lower 24.
pub(super) fn exponential(bytes: &mut [u8]) {
    for v in bytes.chunks_exact_mut(4) {
        let word = i32::from_le_bytes([v[0], v[1], v[2], v[3]]);
        let (e, m) = (word >> 24, word << 8 >> 8);
        v.copy_from_slice(&(libm::ldexp(f64::from(m), e) as f32).to_le_bytes());
    }
}

/// To the nearest integer, halves away from zero.
fn rounded(x: f64) -> i32 {
    (if x >= 0.0 { x + 0.5 } else { x - 0.5 }) as i32
}
