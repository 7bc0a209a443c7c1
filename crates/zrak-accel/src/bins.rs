//! Splitting a large set between bins of centres.
//!
//! Wald, *On fast Construction of SAH-based Bounding Volume Hierarchies*, 2007.

use rayon::prelude::*;

use crate::record::{Planes, Record};

/// Bins along an axis; a power of two.
const N_BINS: usize = 32;
/// Sets with more than this many primitives are binned and partitioned by several threads.
pub(crate) const PARALLEL_LIMIT: usize = 1 << 16;
/// Primitives that a thread takes at a time.
const CHUNK: usize = 1 << 14;

/// Where the bins lie.
#[derive(Clone, Copy)]
struct Grid {
    lo: [f32; 3],
    scale: [f32; 3],
}

impl Grid {
    fn over(centers: &Planes) -> Self {
        let mut grid = Self { lo: [0.0; 3], scale: [0.0; 3] };
        for axis in 0..3 {
            let [lo, hi] = centers.interval(axis);
            // A little less, so that the largest centre is in the last bin.
            let scale = N_BINS as f32 * (1.0 - 1.0 / 65536.0) / (hi - lo);
            if scale.is_finite() {
                grid.lo[axis] = lo;
                grid.scale[axis] = scale;
            }
        }
        grid
    }

    /// The bin that a record is in: monotone in its centre. All are in the first if centres coincide
    /// or are infinite.
    #[inline(always)]
    fn bin(&self, record: &Record, axis: usize) -> usize {
        // Added to 1.5 * 2^23, a number is rounded to an integer that the low bits then hold; rounding
        // is what IEEE 754 says everywhere.
        let x = (record.center(axis) - self.lo[axis]) * self.scale[axis];
        ((x - 0.5) + 12_582_912.0).to_bits() as usize % N_BINS
    }
}

/// Boxes and numbers of primitives of the bins of all axes.
#[derive(Clone)]
struct Bins {
    planes: [[Planes; N_BINS]; 3],
    n: [[u32; N_BINS]; 3],
}

impl Bins {
    const EMPTY: Self = Self { planes: [[Planes::EMPTY; N_BINS]; 3], n: [[0; N_BINS]; 3] };

    fn of(records: &[Record], grid: &Grid) -> Self {
        let mut bins = Self::EMPTY;
        for record in records {
            let planes = record.planes();
            for axis in 0..3 {
                let bin = grid.bin(record, axis);
                bins.planes[axis][bin].union(&planes);
                bins.n[axis][bin] += 1;
            }
        }
        bins
    }

    fn add(&mut self, other: &Self) {
        for axis in 0..3 {
            for bin in 0..N_BINS {
                self.planes[axis][bin].union(&other.planes[axis][bin]);
                self.n[axis][bin] += other.n[axis][bin];
            }
        }
    }

    /// Number of primitives before a split.
    fn n_before(&self, split: Split) -> usize {
        self.n[split.axis][..split.bin].iter().map(|&n| n as usize).sum()
    }

    /// The split with the smallest sum of area times number; none if all centres share a bin, or the
    /// areas are infinite.
    fn best_split(&self) -> Option<Split> {
        let mut best = None;
        let mut best_cost = f32::INFINITY;
        for axis in 0..3 {
            let (planes, n) = (&self.planes[axis], &self.n[axis]);
            let mut right_cost = [f32::INFINITY; N_BINS];
            let mut all = Planes::EMPTY;
            let mut count = 0;
            for bin in (1..N_BINS).rev() {
                all.union(&planes[bin]);
                count += n[bin];
                if count != 0 {
                    right_cost[bin] = all.half_area() * count as f32;
                }
            }
            let mut all = Planes::EMPTY;
            let mut count = 0;
            for bin in 1..N_BINS {
                all.union(&planes[bin - 1]);
                count += n[bin - 1];
                if count != 0 {
                    let cost = all.half_area() * count as f32 + right_cost[bin];
                    if cost < best_cost {
                        best_cost = cost;
                        best = Some(Split { axis, bin });
                    }
                }
            }
        }
        best
    }
}

/// A plane between bins: what is in a bin before this one is on the left.
#[derive(Clone, Copy)]
struct Split {
    axis: usize,
    bin: usize,
}

/// Smallest box with the centres of some primitives, doubled.
pub(crate) fn center_bounds(records: &[Record]) -> Planes {
    let of = |chunk: &[Record]| {
        chunk.iter().fold(Planes::EMPTY, |mut all, record| {
            all.union(&record.center_planes());
            all
        })
    };
    if records.len() <= PARALLEL_LIMIT {
        return of(records);
    }
    records.par_chunks(CHUNK).map(of).reduce(
        || Planes::EMPTY,
        |mut a, b| {
            a.union(&b);
            a
        },
    )
}

/// Moves the primitives on the left of the best split to the front; gives their number.
pub(crate) fn split(
    records: &mut [Record],
    centers: &Planes,
    is_allowed: impl Fn(usize) -> bool,
) -> Option<usize> {
    let grid = Grid::over(centers);
    let bins = Bins::of(records, &grid);
    let split = bins.best_split()?;
    if !is_allowed(bins.n_before(split)) {
        return None;
    }
    // Every record is swapped, with itself if need be: a branch would be mispredicted half of the time.
    let mut n_left = 0;
    for i in 0..records.len() {
        let is_left = grid.bin(&records[i], split.axis) < split.bin;
        records.swap(i, n_left);
        n_left += usize::from(is_left);
    }
    Some(n_left)
}

/// Like [`split`] with several threads, but the primitives end up in `out`.
pub(crate) fn split_in_parallel(
    records: &[Record],
    out: &mut [Record],
    centers: &Planes,
    is_allowed: impl Fn(usize) -> bool,
) -> Option<usize> {
    let grid = Grid::over(centers);
    let of_chunks: Vec<Bins> =
        records.par_chunks(CHUNK).map(|chunk| Bins::of(chunk, &grid)).collect();
    let mut bins = Bins::EMPTY;
    for chunk in &of_chunks {
        bins.add(chunk);
    }
    let split = bins.best_split()?;
    let n_left = bins.n_before(split);
    if !is_allowed(n_left) {
        return None;
    }
    // Each chunk has its own part of both sides to write to.
    let (mut left, mut right) = out.split_at_mut(n_left);
    let mut parts = Vec::with_capacity(of_chunks.len());
    for (bins, chunk) in of_chunks.iter().zip(records.chunks(CHUNK)) {
        let n = bins.n_before(split);
        let (chunk_left, rest) = left.split_at_mut(n);
        left = rest;
        let (chunk_right, rest) = right.split_at_mut(chunk.len() - n);
        right = rest;
        parts.push((chunk, chunk_left.iter_mut(), chunk_right.iter_mut()));
    }
    parts.into_par_iter().for_each(|(chunk, mut left, mut right)| {
        for record in chunk {
            let is_left = grid.bin(record, split.axis) < split.bin;
            let side = if is_left { &mut left } else { &mut right };
            if let Some(place) = side.next() {
                *place = *record;
            }
        }
    });
    Some(n_left)
}
