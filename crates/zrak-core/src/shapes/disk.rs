//! Disks and rings, or pieces of them, under any affine map: ellipses.

use core::f32::consts::TAU;

use bytemuck::{Pod, Zeroable};

use super::{Shape, Shutter};
use crate::interaction::SurfaceInteraction;
use crate::math::{Bounds, Vec3, atan2, dot, gamma, max, sqrt};
use crate::ray::Ray;
use crate::scene::MaterialRef;

/// The points `center + x u + y v` with `inner`^2 <= x^2 + y^2 <= 1 and an angle of (x, y) in
/// [0, `phi_max`].
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Disk {
    /// Centre.
    pub center: Vec3,
    /// Material of the surface.
    pub material: MaterialRef,
    /// Unit normal.
    pub normal: Vec3,
    /// Inner radius as a share of the outer one.
    pub inner: f32,
    /// Vector whose product with a point's position relative to the centre is x.
    pub x_axis: Vec3,
    /// Largest angle, in radians; at least a turn for all of it.
    pub phi_max: f32,
    /// Vector whose product with a point's position relative to the centre is y.
    pub y_axis: Vec3,
    /// Nothing.
    pub _pad0: u32,
    /// Radius along x.
    pub u: Vec3,
    /// Nothing.
    pub _pad1: u32,
    /// Radius along y.
    pub v: Vec3,
    /// Nothing.
    pub _pad2: u32,
}

const _: () = assert!(size_of::<Disk>() == 96);

/// Angle of (x, y), from 0 to a turn.
#[inline(always)]
pub(super) fn angle(y: f32, x: f32) -> f32 {
    let phi = atan2(y, x);
    if phi < 0.0 { phi + TAU } else { phi }
}

impl Disk {
    #[inline(always)]
    fn coordinates(&self, p: Vec3) -> (f32, f32) {
        let from_center = p - self.center;
        (dot(self.x_axis, from_center), dot(self.y_axis, from_center))
    }
}

impl Shape for Disk {
    fn bounds(&self, _: Shutter) -> Bounds {
        // Half-width along an axis: the length of the row of (u | v).
        let reach = self.u.zip(self.v, |a, b| sqrt(a * a + b * b));
        let size = reach.max_component();
        Bounds { lo: self.center - reach, hi: self.center + reach }.padded(size * 4e-6)
    }

    #[inline(always)]
    fn intersect(&self, ray: &Ray) -> Option<f32> {
        let t = dot(self.normal, self.center - ray.o) / dot(self.normal, ray.d);
        let (x, y) = self.coordinates(ray.at(t));
        let r2 = x * x + y * y;
        // False for the NaN and the infinities of a parallel ray.
        if t > 0.0
            && t < f32::INFINITY
            && r2 <= 1.0
            && r2 >= self.inner * self.inner
            && (self.phi_max >= TAU || angle(y, x) <= self.phi_max)
        {
            Some(t)
        } else {
            None
        }
    }

    #[inline(always)]
    fn interaction(&self, ray: &Ray, t: f32) -> SurfaceInteraction {
        let (x, y) = self.coordinates(ray.at(t));
        let (ux, vy) = (self.u * x, self.v * y);
        let p = self.center + ux + vy;
        let p_error = (self.center.abs() + ux.abs() + vy.abs()) * gamma(10);
        let r = max(sqrt(x * x + y * y), 1e-12);
        let plain = SurfaceInteraction::plain(p, p_error, self.normal, self.material);
        // u along the angle, v from the rim inwards.
        SurfaceInteraction {
            uv: [angle(y, x) / self.phi_max, (1.0 - r) / (1.0 - self.inner)],
            dpdu: (self.v * x - self.u * y) * self.phi_max,
            dpdv: (self.u * x + self.v * y) * ((self.inner - 1.0) / r),
            ..plain
        }
    }
}
