//! Rays, and where they may start.

use crate::math::{Vec3, dot, next_down, next_up};

/// Half-line from `o` along `d`; parameters along it count in units of `d`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Origin.
    pub o: Vec3,
    /// Direction; of unit length in world space, of any length in a shape's own space.
    pub d: Vec3,
    /// When it travels, in seconds.
    pub time: f32,
}

impl Ray {
    /// Point at parameter `t`.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, t: f32) -> Vec3 {
        self.o + self.d * t
    }
}

/// Moves a surface point `p`, known to within `p_error` in each coordinate, along the normal `n` to
/// the side that `w` points to, far enough that a ray from there along `w` cannot meet the surface
/// again by rounding, and no farther: there is no fixed epsilon.
///
/// Pharr, Jakob, Humphreys, *Physically Based Rendering*, 4th ed., section 6.8.6.
#[inline(always)]
#[must_use]
pub fn offset_ray_origin(p: Vec3, p_error: Vec3, n: Vec3, w: Vec3) -> Vec3 {
    // Distance from the plane through p at which the box of errors is left.
    let d = dot(n.abs(), p_error);
    let offset = if dot(w, n) < 0.0 { n * -d } else { n * d };
    // Round away from p.
    let away = |x: f32, dx: f32| {
        let moved = x + dx;
        if dx > 0.0 {
            next_up(moved)
        } else if dx < 0.0 {
            next_down(moved)
        } else {
            moved
        }
    };
    p.zip(offset, away)
}
