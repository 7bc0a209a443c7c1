//! Reading images: each file once for each meaning of its numbers, in parallel, with levels of detail
//! where a texture asks for them.

use std::collections::{HashMap, HashSet};

use rayon::prelude::*;
use zrak_core::textures::{
    ImageTexture, MAX_LEVELS, TEXELS_LINEAR, TEXELS_SRGB8, TEXELS_UNORM8, TEXELS_UNORM16,
};
use zrak_image::{
    Texels, TextureImage, decode_texture, linear_to_srgb8, srgb8_to_linear_table, srgb16_to_linear,
};

use super::Role;
use crate::arena::SceneArrays;
use crate::desc::{ImageEncoding, ImageFilter, SceneDesc, TextureDesc};
use crate::lower::assets::{self, MissingTextures};
use crate::lower::budget::{self, Budget};
use crate::lower::{LoadedImage, LowerOptions};
use crate::progress::LoadStage;
use crate::validate::{KeyPath, Problem};

/// An image that is asked for.
struct Request<'a> {
    path: &'a str,
    is_srgb: bool,
    has_levels: bool,
    /// Where it is named.
    key: KeyPath,
}

/// The images of a scene.
pub(super) struct Rasters<'a> {
    requests: Vec<Request<'a>>,
    ids: HashMap<(&'a str, bool), usize>,
    /// Files of which a texture wants levels of detail.
    with_levels: HashSet<&'a str>,
    /// Requests of the image textures.
    pub(super) images: Vec<(usize, usize)>,
    /// Requests of the image maps.
    pub(super) maps: Vec<(usize, usize)>,
}

/// An image as the arena holds it.
struct Raster {
    width: u32,
    height: u32,
    format: u32,
    n_levels: u32,
    words: Vec<u32>,
}

impl<'a> Rasters<'a> {
    pub(super) fn new(desc: &'a SceneDesc) -> Self {
        let with_levels = desc
            .textures
            .values()
            .filter_map(|texture| match texture {
                TextureDesc::Image { path, filter: ImageFilter::Trilinear, .. } => {
                    Some(path.as_str())
                }
                _ => None,
            })
            .collect();
        Self {
            requests: Vec::new(),
            ids: HashMap::new(),
            with_levels,
            images: Vec::new(),
            maps: Vec::new(),
        }
    }

    /// Asks for a file; gives the number of the request.
    pub(super) fn ask(
        &mut self,
        path: &'a str,
        role: Role,
        encoding: ImageEncoding,
        key: KeyPath,
    ) -> usize {
        let is_srgb = match encoding {
            ImageEncoding::Auto => role == Role::Color,
            ImageEncoding::Srgb => true,
            ImageEncoding::Linear => false,
        };
        let next = self.requests.len();
        let id = *self.ids.entry((path, is_srgb)).or_insert(next);
        if id == next {
            let has_levels = self.with_levels.contains(path);
            self.requests.push(Request { path, is_srgb, has_levels, key });
        }
        id
    }

    /// Reads everything, and completes the records.
    pub(super) fn read(
        self,
        options: &LowerOptions,
        budget: &Budget,
        arrays: &mut SceneArrays,
        problems: &mut Vec<Problem>,
        warnings: &mut Vec<Problem>,
    ) -> Vec<LoadedImage> {
        let mut images = Vec::new();
        if self.requests.is_empty() {
            return images;
        }
        options.progress.begin(LoadStage::Images, self.requests.len() as u64);
        let read = |request: &Request| {
            let raster = Raster::read(request, options, budget);
            options.progress.add(1);
            raster
        };
        let read: Vec<Result<Raster, Unread>> = self.requests.par_iter().map(read).collect();
        arrays.srgb_table = srgb8_to_linear_table().to_vec();
        let mut n_words = arrays.texels.len() as u64;
        let mut placed = Vec::new();
        for (raster, request) in read.into_iter().zip(self.requests) {
            let problem = |message, help| Problem { path: request.key.clone(), message, help };
            let raster = raster.unwrap_or_else(|unread| {
                match (unread, options.missing_textures) {
                    (Unread::NoRoom(message), _) => {
                        problems.push(problem(message, Some(budget::HELP.to_owned())));
                    }
                    (Unread::Image(error), MissingTextures::Error) => {
                        problems.push(problem(error.to_string(), None));
                    }
                    (Unread::Image(error), MissingTextures::Warn) => {
                        warnings.push(problem(format!("{error}; mid grey stands for it"), None));
                    }
                }
                Raster::mid_grey()
            });
            n_words += raster.words.len() as u64;
            if n_words > u64::from(u32::MAX) {
                let message = "the scene's images have more than 16 GiB of texels".to_owned();
                problems.push(problem(message, Some("make some of them smaller".to_owned())));
                return images;
            }
            let first_word = arrays.texels.len() as u32;
            images.push(LoadedImage { path: request.path.to_owned(), first_word });
            arrays.texels.extend_from_slice(&raster.words);
            let Raster { width, height, format, n_levels, .. } = raster;
            placed.push((first_word, width, height, format, n_levels));
        }
        let complete = |record: &mut ImageTexture, id: usize| -> u32 {
            let (first_word, width, height, format, n_levels) = placed[id];
            *record = ImageTexture { first_word, width, height, format, ..*record };
            n_levels
        };
        for (id, index) in self.images {
            complete(&mut arrays.images[index], id);
        }
        for (id, index) in self.maps {
            let map = &mut arrays.image_maps[index];
            map.n_levels = complete(&mut map.raster, id);
        }
        images
    }
}

/// Why an image could not be read.
enum Unread {
    /// It is missing, damaged or too large by itself.
    Image(zrak_image::Error),
    /// There is no memory left for it.
    NoRoom(String),
}

impl From<zrak_image::Error> for Unread {
    fn from(error: zrak_image::Error) -> Self {
        Self::Image(error)
    }
}

impl Raster {
    fn read(request: &Request, options: &LowerOptions, budget: &Budget) -> Result<Self, Unread> {
        let limits = &options.image_limits;
        let (bytes, path) = assets::read(request.path, options)?;
        let n_bytes = zrak_image::texel_bytes(&bytes, &path, limits)?;
        // Deep codes of sRGB become floats.
        let n_bytes = if request.is_srgb { n_bytes + n_bytes / 2 } else { n_bytes };
        let n_bytes = if request.has_levels { n_bytes + n_bytes / 3 } else { n_bytes };
        budget.spend(n_bytes).map_err(Unread::NoRoom)?;
        let image = decode_texture(&bytes, &path, limits)?;
        Ok(Self::new(&image, request.is_srgb, request.has_levels))
    }

    fn mid_grey() -> Self {
        let words = vec![u32::from_le_bytes([188, 188, 188, 255])];
        Self { width: 1, height: 1, format: TEXELS_SRGB8, n_levels: 1, words }
    }

    /// `is_srgb` says whether the codes of integer formats are those of sRGB.
    fn new(image: &TextureImage, is_srgb: bool, has_levels: bool) -> Self {
        let (width, height) = (image.width, image.height);
        let format = match (&image.texels, is_srgb) {
            (Texels::Srgb8(_), true) => TEXELS_SRGB8,
            (Texels::Srgb8(_), false) => TEXELS_UNORM8,
            (Texels::Srgb16(_), false) => TEXELS_UNORM16,
            (Texels::Srgb16(_), true) | (Texels::Linear(_), _) => TEXELS_LINEAR,
        };
        let words = match &image.texels {
            Texels::Srgb8(texels) => texels.iter().map(|t| u32::from_le_bytes(*t)).collect(),
            Texels::Srgb16(texels) if is_srgb => texels
                .iter()
                .flat_map(|&[r, g, b, _]| [r, g, b].map(|c| srgb16_to_linear(c).to_bits()))
                .collect(),
            Texels::Srgb16(texels) => {
                let pair = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
                texels.iter().flat_map(|&[r, g, b, a]| [pair(r, g), pair(b, a)]).collect()
            }
            Texels::Linear(texels) => texels.iter().flatten().map(|x| x.to_bits()).collect(),
        };
        let mut raster = Self { width, height, format, n_levels: 1, words };
        if has_levels {
            raster.add_levels();
        }
        raster
    }

    /// Adds levels of detail down to one texel: each the mean by area of the one before, in linear
    /// values. Each is rounded to the image's own format before the next is made of it.
    fn add_levels(&mut self) {
        let table = srgb8_to_linear_table();
        let (mut width, mut height) = (self.width as usize, self.height as usize);
        let mut first = 0;
        while (width > 1 || height > 1) && self.n_levels < MAX_LEVELS {
            let (w, h) = ((width / 2).max(1), (height / 2).max(1));
            let columns: Vec<_> = (0..w).map(|x| shares(x, w, width)).collect();
            let rows: Vec<_> = (0..h).map(|y| shares(y, h, height)).collect();
            let words = &self.words[first..];
            let (format, table) = (self.format, &table);
            let next: Vec<u32> = rows
                .par_iter()
                .flat_map_iter(|row| {
                    columns.iter().flat_map(move |column| {
                        let mut sum = [0.0_f64; 4];
                        for &(y, weight_y) in row {
                            for &(x, weight_x) in column {
                                let texel = decode(words, y * width + x, format, table);
                                for (sum, value) in sum.iter_mut().zip(texel) {
                                    *sum += weight_x * weight_y * value;
                                }
                            }
                        }
                        encode(sum, format)
                    })
                })
                .collect();
            first = self.words.len();
            self.words.extend(next);
            (width, height) = (w, h);
            self.n_levels += 1;
        }
    }
}

/// The texels that texel `x` of `n` covers, of `n_fine` texels along the same side, and the share of it that
/// each of them takes.
fn shares(x: usize, n: usize, n_fine: usize) -> Vec<(usize, f64)> {
    // In units of one over n of a fine texel, everything is a whole number.
    let (start, end) = (x * n_fine, (x + 1) * n_fine);
    (start / n..end.div_ceil(n))
        .map(|i| {
            let overlap = ((i + 1) * n).min(end) - (i * n).max(start);
            (i, overlap as f64 / n_fine as f64)
        })
        .collect()
}

/// Linear red, green, blue and alpha of a texel.
fn decode(words: &[u32], i: usize, format: u32, table: &[f32; 256]) -> [f64; 4] {
    match format {
        TEXELS_SRGB8 | TEXELS_UNORM8 => {
            let codes = words[i].to_le_bytes();
            let share = |code: u8| f64::from(code) / 255.0;
            let color = |code: u8| match format {
                TEXELS_SRGB8 => f64::from(table[usize::from(code)]),
                _ => share(code),
            };
            [color(codes[0]), color(codes[1]), color(codes[2]), share(codes[3])]
        }
        TEXELS_UNORM16 => {
            let share = |bits: u32| f64::from(bits & 0xffff) / 65535.0;
            let (rg, ba) = (words[2 * i], words[2 * i + 1]);
            [share(rg), share(rg >> 16), share(ba), share(ba >> 16)]
        }
        _ => {
            let value = |channel: usize| f64::from(f32::from_bits(words[3 * i + channel]));
            [value(0), value(1), value(2), 1.0]
        }
    }
}

/// The words of a texel.
fn encode([r, g, b, a]: [f64; 4], format: u32) -> impl Iterator<Item = u32> {
    let share = |x: f64, most: f64| (x * most + 0.5) as u32;
    let words = match format {
        TEXELS_SRGB8 => {
            let code = |x: f64| u32::from(linear_to_srgb8(x as f32));
            [code(r) | code(g) << 8 | code(b) << 16 | share(a, 255.0) << 24, 0, 0]
        }
        TEXELS_UNORM8 => {
            let code = |x: f64| share(x, 255.0);
            [code(r) | code(g) << 8 | code(b) << 16 | code(a) << 24, 0, 0]
        }
        TEXELS_UNORM16 => {
            let code = |x: f64| share(x, 65535.0);
            [code(r) | code(g) << 16, code(b) | code(a) << 16, 0]
        }
        _ => [r, g, b].map(|x| (x as f32).to_bits()),
    };
    words.into_iter().take(zrak_core::textures::words_per_texel(format) as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_cover_every_texel_once() {
        for n_fine in 1..40 {
            for n in 1..=n_fine {
                let mut covered = vec![0.0; n_fine];
                for x in 0..n {
                    let shares = shares(x, n, n_fine);
                    let sum: f64 = shares.iter().map(|s| s.1).sum();
                    assert!((sum - 1.0).abs() < 1e-12);
                    for (i, share) in shares {
                        covered[i] += share;
                    }
                }
                let each = n as f64 / n_fine as f64;
                assert!(covered.iter().all(|c| (c - each).abs() < 1e-12), "{n} of {n_fine}");
            }
        }
    }

    #[test]
    fn levels_keep_the_mean_in_every_format() {
        let (width, height) = (13, 6);
        let code = |i: u32| (i * 37 % 256) as u8;
        let srgb8: Vec<[u8; 4]> =
            (0..width * height).map(|i| [code(i), code(i + 5), code(3 * i), code(7 * i)]).collect();
        let srgb16: Vec<[u16; 4]> = srgb8.iter().map(|t| t.map(|c| u16::from(c) * 257)).collect();
        let linear: Vec<[f32; 3]> =
            srgb8.iter().map(|t| [t[0], t[1], t[2]].map(|c| f32::from(c) / 64.0)).collect();
        let table = srgb8_to_linear_table();
        for (texels, is_srgb, tolerance) in [
            (Texels::Srgb8(srgb8.clone()), true, 0.01),
            (Texels::Srgb8(srgb8), false, 0.005),
            (Texels::Srgb16(srgb16.clone()), false, 1e-4),
            (Texels::Srgb16(srgb16), true, 1e-6),
            (Texels::Linear(linear), false, 1e-6),
        ] {
            let image = TextureImage { width, height, texels };
            let raster = Raster::new(&image, is_srgb, true);
            // 13x6, 6x3, 3x1, 1x1.
            assert_eq!(raster.n_levels, 4);
            let n_texels = 13 * 6 + 6 * 3 + 3 + 1;
            let per_texel = zrak_core::textures::words_per_texel(raster.format) as usize;
            assert_eq!(raster.words.len(), n_texels * per_texel);
            let fine: Vec<_> =
                (0..78).map(|i| decode(&raster.words, i, raster.format, &table)).collect();
            let last = decode(&raster.words, n_texels - 1, raster.format, &table);
            for channel in 0..4 {
                let mean = fine.iter().map(|t| t[channel]).sum::<f64>() / 78.0;
                let off = (mean - last[channel]).abs();
                assert!(off < tolerance, "format {} channel {channel}: {off}", raster.format);
            }
        }
    }
}
