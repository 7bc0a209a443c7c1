//! Instances: trees that are stored once and placed any number of times.
//!
//! A ray that enters an instance's box goes on in the space of the objects. Its direction is not
//! normalised there, so parameters along it mean the same and hits inside compare with those outside.

use bytemuck::{Pod, Zeroable};

use crate::accel::Node;
use crate::interaction::SurfaceInteraction;
use crate::math::{Affine, Bounds, Vec3, cross, dot, lerp, vec3};
use crate::ray::Ray;
use crate::scene::{PrimRef, SceneView};

/// Index that stands for no motion.
pub const NO_MOTION: u32 = u32::MAX;

/// An affine map and the map back.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Placement {
    /// From the space of the objects to the world.
    pub world_from_object: Affine,
    /// From the world to the space of the objects.
    pub object_from_world: Affine,
}

const _: () = assert!(size_of::<Placement>() == 96);

/// Objects under an affine map.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Instance {
    /// Where it is, if it stands still.
    pub placement: Placement,
    /// Root of the tree of its objects, among the binary nodes.
    pub root2: u32,
    /// The same among the eight-wide nodes.
    pub root8: u32,
    /// Index of its motion, or [`NO_MOTION`].
    pub motion: u32,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Instance>() == 112);

/// Where an instance is at two times; between them the matrices are blended linearly.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Motion {
    /// From the space of the objects to the world, at time 0.
    pub start: Affine,
    /// The same at time 1.
    pub end: Affine,
}

const _: () = assert!(size_of::<Motion>() == 96);

impl Motion {
    #[inline(always)]
    fn at(&self, time: f32) -> Affine {
        let row = |i: usize| {
            let (a, b) = (self.start.rows[i], self.end.rows[i]);
            [
                lerp(time, a[0], b[0]),
                lerp(time, a[1], b[1]),
                lerp(time, a[2], b[2]),
                lerp(time, a[3], b[3]),
            ]
        };
        Affine { rows: [row(0), row(1), row(2)] }
    }
}

impl Placement {
    /// The ray in the space of the objects; parameters along it mean the same.
    #[inline(always)]
    #[must_use]
    pub fn object_ray(&self, ray: &Ray) -> Ray {
        Ray {
            o: self.object_from_world.point(ray.o),
            d: self.object_from_world.vector(ray.d),
            time: ray.time,
        }
    }

    /// World bounds of what lies within `bounds` in the space of the objects.
    #[must_use]
    pub fn bounds(&self, bounds: Bounds) -> Bounds {
        moved_bounds(&self.world_from_object, bounds)
    }

    /// A point on a surface, brought to the world. `slack` bounds how far the map back is off
    /// besides its rounding.
    #[inline(always)]
    #[must_use]
    pub fn to_world(&self, local: &SurfaceInteraction, slack: Vec3) -> SurfaceInteraction {
        let to_world = &self.world_from_object;
        let p = to_world.point(local.p);
        // The next ray is mapped back: what rounding does to its origin on the way must not carry
        // it through the surface, so that error counts here as well.
        let back = self.object_from_world.point_rounding(p) + slack;
        let p_error = to_world.abs_vector(local.p_error + back) + to_world.point_rounding(local.p);
        let normal = |n: Vec3| self.object_from_world.transposed_vector(n).normalized();
        let n = normal(local.n);
        SurfaceInteraction {
            p,
            p_error: widen(p_error),
            n,
            ns: if local.ns == local.n { n } else { normal(local.ns) },
            dpdu: to_world.vector(local.dpdu),
            dpdv: to_world.vector(local.dpdv),
            ..*local
        }
    }
}

impl Instance {
    /// Where it is at a time, and how far the map back may be off besides its rounding.
    #[inline(always)]
    #[must_use]
    pub fn placement_at(&self, scene: &SceneView, time: f32) -> Placement {
        if self.motion == NO_MOTION {
            return self.placement;
        }
        let world_from_object = scene.motions.get(self.motion).at(time);
        Placement { world_from_object, object_from_world: inverse(&world_from_object) }
    }

    /// World bounds over the shutter interval.
    #[must_use]
    pub fn bounds(&self, scene: &SceneView, shutter: [f32; 2]) -> Bounds {
        let objects = node_bounds(&scene.nodes2.get(self.root2));
        if self.motion == NO_MOTION {
            return self.placement.bounds(objects);
        }
        // Blending is linear in time for each point, so the ends hold what is between them, up to the
        // rounding of the blend.
        let motion = scene.motions.get(self.motion);
        let [start, end] = shutter.map(|t| moved_bounds(&motion.at(t), objects));
        let both = start.union(end);
        both.padded((both.hi - both.lo).max_component() * 4e-6)
    }

    /// A point on one of its surfaces, found along `ray` in the space of the objects, in the world.
    #[inline(always)]
    #[must_use]
    pub fn to_world(
        &self,
        placement: &Placement,
        local: &SurfaceInteraction,
    ) -> SurfaceInteraction {
        let slack = if self.motion == NO_MOTION {
            Vec3::ZERO
        } else {
            // The inverse was computed in single precision: look how far it is off here.
            let p = placement.world_from_object.point(local.p);
            (placement.object_from_world.point(p) - local.p).abs() * 2.0
        };
        placement.to_world(local, slack)
    }
}

/// The map back, computed in single precision; of a map without one, zero.
#[inline(always)]
fn inverse(map: &Affine) -> Affine {
    let [a, b, c] = map.rows.map(|r| vec3(r[0], r[1], r[2]));
    let (bc, ca, ab) = (cross(b, c), cross(c, a), cross(a, b));
    let determinant = dot(a, bc);
    let scale = if determinant == 0.0 { 0.0 } else { 1.0 / determinant };
    let t = vec3(map.rows[0][3], map.rows[1][3], map.rows[2][3]);
    let row = |x: f32, y: f32, z: f32| {
        let l = vec3(x, y, z) * scale;
        [l.x, l.y, l.z, -dot(l, t)]
    };
    Affine { rows: [row(bc.x, ca.x, ab.x), row(bc.y, ca.y, ab.y), row(bc.z, ca.z, ab.z)] }
}

/// Bounds of all that is in a node.
fn node_bounds(node: &Node<2>) -> Bounds {
    let mut all = Bounds::EMPTY;
    for i in 0..2 {
        if node.children[i] != PrimRef::NONE {
            let corner = |c: &[[f32; 2]; 3]| vec3(c[0][i], c[1][i], c[2][i]);
            all = all.union(Bounds { lo: corner(&node.lo), hi: corner(&node.hi) });
        }
    }
    all
}

/// Bounds of the image of a box, with a margin for the rounding of rays that are mapped back.
fn moved_bounds(map: &Affine, bounds: Bounds) -> Bounds {
    if bounds.lo.x > bounds.hi.x {
        return bounds;
    }
    let mut moved = Bounds::EMPTY;
    for corner in 0..8 {
        let pick = |bit: u32, lo: f32, hi: f32| if corner >> bit & 1 == 0 { lo } else { hi };
        let p = map.point(vec3(
            pick(0, bounds.lo.x, bounds.hi.x),
            pick(1, bounds.lo.y, bounds.hi.y),
            pick(2, bounds.lo.z, bounds.hi.z),
        ));
        let error = map.point_rounding(p).abs();
        moved = moved.union(Bounds { lo: p - error, hi: p + error });
    }
    let size = (moved.hi - moved.lo).max_component();
    moved.padded(size * 4e-6)
}

/// Makes up for the rounding of the error bound itself.
#[inline(always)]
fn widen(error: Vec3) -> Vec3 {
    error * 1.01
}
