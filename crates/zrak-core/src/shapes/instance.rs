//! A sphere or box under an affine map.

use bytemuck::{Pod, Zeroable};

use super::Shape;
use crate::interaction::SurfaceInteraction;
use crate::math::{Affine, Bounds, Vec3, vec3};
use crate::ray::Ray;
use crate::scene::{PrimKind, PrimRef, SceneView};

/// A shape that the host could not express in world space itself.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Instance {
    /// From the shape's space to the world.
    pub world_from_object: Affine,
    /// From the world to the shape's space.
    pub object_from_world: Affine,
    /// A sphere, moving sphere or box.
    pub target: PrimRef,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<Instance>() == 112);

impl Instance {
    /// The ray in the shape's space; parameters along it mean the same.
    #[inline(always)]
    #[must_use]
    pub fn object_ray(&self, ray: &Ray) -> Ray {
        Ray {
            o: self.object_from_world.point(ray.o),
            d: self.object_from_world.vector(ray.d),
            time: ray.time,
        }
    }

    /// World bounds, from those of the target in its own space.
    #[must_use]
    pub fn bounds(&self, target: Bounds) -> Bounds {
        let mut bounds = Bounds::EMPTY;
        for corner in 0..8 {
            let pick = |bit: u32, lo: f32, hi: f32| if corner >> bit & 1 == 0 { lo } else { hi };
            let p = self.world_from_object.point(vec3(
                pick(0, target.lo.x, target.hi.x),
                pick(1, target.lo.y, target.hi.y),
                pick(2, target.lo.z, target.hi.z),
            ));
            let error = self.world_from_object.point_rounding(p).abs();
            bounds = bounds.union(Bounds { lo: p - error, hi: p + error });
        }
        let size = (bounds.hi - bounds.lo).max_component();
        bounds.padded(size * 4e-6)
    }

    /// See [`Shape::intersect`].
    #[inline(always)]
    #[must_use]
    pub fn intersect(&self, scene: &SceneView, ray: &Ray) -> Option<f32> {
        let ray = self.object_ray(ray);
        let i = self.target.index();
        match self.target.kind() {
            Some(PrimKind::Sphere) => scene.spheres.get(i).intersect(&ray),
            Some(PrimKind::MovingSphere) => scene.moving_spheres.get(i).intersect(&ray),
            Some(PrimKind::Box) => scene.boxes.get(i).intersect(&ray),
            _ => None,
        }
    }

    /// See [`Shape::interaction`].
    #[inline(always)]
    #[must_use]
    pub fn interaction(&self, scene: &SceneView, ray: &Ray, t: f32) -> SurfaceInteraction {
        let ray = self.object_ray(ray);
        let i = self.target.index();
        let local = match self.target.kind() {
            Some(PrimKind::Sphere) => scene.spheres.get(i).interaction(&ray, t),
            Some(PrimKind::MovingSphere) => scene.moving_spheres.get(i).interaction(&ray, t),
            _ => scene.boxes.get(i).interaction(&ray, t),
        };
        let to_world = &self.world_from_object;
        let p = to_world.point(local.p);
        // The next ray is mapped back: what rounding does to its origin on the way must not carry
        // it through the surface, so that error counts here as well.
        let back = self.object_from_world.point_rounding(p);
        let p_error = to_world.abs_vector(local.p_error + back) + to_world.point_rounding(local.p);
        let n = self.object_from_world.transposed_vector(local.n).normalized();
        SurfaceInteraction { p, p_error: widen(p_error), n, ..local }
    }
}

/// Makes up for the rounding of the error bound itself.
#[inline(always)]
fn widen(error: Vec3) -> Vec3 {
    error * 1.01
}
