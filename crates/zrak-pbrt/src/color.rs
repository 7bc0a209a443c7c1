//! The colour matching functions, and colour spaces.

/// Linear sRGB.
pub(crate) type Rgb = [f64; 3];

/// Wavelengths that spectra are integrated over, in nanometres: from, to, step.
pub(crate) const LAMBDA: [f64; 3] = [360.0, 830.0, 1.0];

/// CIE 1931 colour matching functions: the multi-lobe fit of Wyman, Sloan, Shirley, *Simple Analytic
/// Approximations to the CIE XYZ Color Matching Functions*, JCGT 2(2), 2013, within 1% of the
/// tabulated ones.
pub(crate) fn xyz(lambda: f64) -> [f64; 3] {
    let lobe = |a: f64, mean: f64, below: f64, above: f64| {
        let t = (lambda - mean) * if lambda < mean { below } else { above };
        a * libm::exp(-0.5 * t * t)
    };
    [
        lobe(0.362, 442.0, 0.0624, 0.0374)
            + lobe(1.056, 599.8, 0.0264, 0.0323)
            + lobe(-0.065, 501.1, 0.0490, 0.0382),
        lobe(0.821, 568.8, 0.0213, 0.0247) + lobe(0.286, 530.9, 0.0613, 0.0322),
        lobe(1.217, 437.0, 0.0845, 0.0278) + lobe(0.681, 459.0, 0.0385, 0.0725),
    ]
}

/// A colour space: chromaticities of red, green, blue and white.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ColorSpace {
    pub(crate) name: &'static str,
    primaries: [[f64; 2]; 3],
    white: [f64; 2],
}

const D65: [f64; 2] = [0.3127, 0.3290];

/// The colour spaces that a file may choose.
pub(crate) const SPACES: [ColorSpace; 4] = [
    ColorSpace { name: "srgb", primaries: [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06]], white: D65 },
    ColorSpace {
        name: "dci-p3",
        primaries: [[0.680, 0.320], [0.265, 0.690], [0.150, 0.060]],
        white: D65,
    },
    ColorSpace {
        name: "rec2020",
        primaries: [[0.708, 0.292], [0.170, 0.797], [0.131, 0.046]],
        white: D65,
    },
    ColorSpace {
        name: "aces2065-1",
        primaries: [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.0770]],
        white: [0.32168, 0.33767],
    },
];

type Matrix = [[f64; 3]; 3];

fn apply(m: &Matrix, v: [f64; 3]) -> [f64; 3] {
    m.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

fn inverse(m: &Matrix) -> Matrix {
    let minor =
        |r0: usize, c0: usize, r1: usize, c1: usize| m[r0][c0] * m[r1][c1] - m[r0][c1] * m[r1][c0];
    let cofactor = |i: usize, j: usize| minor((i + 1) % 3, (j + 1) % 3, (i + 2) % 3, (j + 2) % 3);
    let determinant: f64 = (0..3).map(|j| m[0][j] * cofactor(0, j)).sum();
    std::array::from_fn(|i| std::array::from_fn(|j| cofactor(j, i) / determinant))
}

impl ColorSpace {
    /// Matrix from RGB to XYZ, with white at Y = 1.
    fn to_xyz(self) -> Matrix {
        let of = |[x, y]: [f64; 2]| [x / y, 1.0, (1.0 - x - y) / y];
        let columns = self.primaries.map(of);
        let m: Matrix = std::array::from_fn(|i| std::array::from_fn(|j| columns[j][i]));
        let scale = apply(&inverse(&m), of(self.white));
        m.map(|row| [row[0] * scale[0], row[1] * scale[1], row[2] * scale[2]])
    }

    /// A colour of this space in linear sRGB; white stays white.
    pub(crate) fn to_srgb(self, rgb: Rgb) -> Rgb {
        if self == SPACES[0] {
            return rgb;
        }
        let xyz = apply(&self.to_xyz(), rgb);
        // Between whites, XYZ is scaled as von Kries has it.
        let white = |space: Self| apply(&space.to_xyz(), [1.0; 3]);
        let (from, to) = (white(self), white(SPACES[0]));
        xyz_to_srgb(std::array::from_fn(|i| xyz[i] * to[i] / from[i]))
    }
}

/// Linear sRGB of XYZ with Y = 1 at white.
pub(crate) fn xyz_to_srgb(xyz: [f64; 3]) -> Rgb {
    apply(&inverse(&SPACES[0].to_xyz()), xyz)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn matrices_are_the_known_ones() {
        let m = SPACES[0].to_xyz();
        let known = [[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]];
        for (row, known) in m.iter().zip(known) {
            for (x, k) in row.iter().zip(known) {
                assert!((x - k).abs() < 2e-4, "{m:?}");
            }
        }
        for space in SPACES {
            let white = space.to_srgb([1.0; 3]);
            assert!(white.iter().all(|x| (x - 1.0).abs() < 1e-9), "{} {white:?}", space.name);
        }
        // A rec2020 red is beyond sRGB's.
        let red = SPACES[2].to_srgb([1.0, 0.0, 0.0]);
        assert!((red[0] - 1.6605).abs() < 1e-3 && (red[1] + 0.1246).abs() < 1e-3, "{red:?}");
    }

    #[test]
    fn matching_functions_have_equal_areas() {
        let mut sum = [0.0; 3];
        for i in 0..=470 {
            let f = xyz(360.0 + f64::from(i));
            (0..3).for_each(|k| sum[k] += f[k]);
        }
        assert!((sum[1] - 106.86).abs() < 1.0, "{sum:?}");
        assert!((sum[0] / sum[1] - 1.0).abs() < 0.01 && (sum[2] / sum[1] - 1.0).abs() < 0.01);
    }
}
