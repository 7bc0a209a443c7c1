//! Fractal value noise in space: evaluated on the sphere, it has no seam and no pole.

/// Noise of mean 0 within about [-1, 1], from `n_octaves` octaves of lattice noise.
pub(crate) fn fbm(mut p: [f64; 3], n_octaves: u32) -> f64 {
    let (mut sum, mut amplitude) = (0.0, 0.5);
    for octave in 0..n_octaves {
        sum += amplitude * value_noise(p, octave);
        p = p.map(|v| 2.03 * v + 17.1);
        amplitude *= 0.5;
    }
    sum
}

/// Trilinear interpolation, with smoothed weights, of random values in [-1, 1] at integers.
fn value_noise(p: [f64; 3], seed: u32) -> f64 {
    let cell = p.map(f64::floor);
    let weight: [f64; 3] = std::array::from_fn(|axis| {
        let t = p[axis] - cell[axis];
        t * t * (3.0 - 2.0 * t)
    });
    (0..8)
        .map(|corner| {
            let mut w = 1.0;
            let at: [i32; 3] = std::array::from_fn(|axis| {
                let bit = corner >> axis & 1;
                w *= if bit == 1 { weight[axis] } else { 1.0 - weight[axis] };
                cell[axis] as i32 + bit
            });
            w * lattice(at, seed)
        })
        .sum()
}

fn lattice(at: [i32; 3], seed: u32) -> f64 {
    let mut h = seed.wrapping_mul(0x9e37_79b9);
    for v in at {
        h = (h ^ v as u32).wrapping_mul(0x85eb_ca6b);
        h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
        h ^= h >> 16;
    }
    f64::from(h) / f64::from(u32::MAX) * 2.0 - 1.0
}
