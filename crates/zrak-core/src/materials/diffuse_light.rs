//! Emitter that scatters nothing.

use bytemuck::{Pod, Zeroable};

use super::Response;
use crate::interaction::SurfaceInteraction;
use crate::math::{Color, Vec3};
use crate::scene::SceneView;
use crate::textures::ColorInput;

/// Both sides emit.
pub const SIDES_BOTH: u32 = 0;
/// Only the side that the normal points to emits.
pub const SIDES_FRONT: u32 = 1;

/// Emits the same radiance in every direction.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct DiffuseLight {
    /// Radiance.
    pub radiance: ColorInput,
    /// [`SIDES_BOTH`] or [`SIDES_FRONT`].
    pub sides: u32,
    /// Nothing.
    pub _pad: [u32; 3],
}

const _: () = assert!(size_of::<DiffuseLight>() == 32);

impl DiffuseLight {
    #[inline(always)]
    pub(super) fn respond(
        &self,
        scene: &SceneView,
        surface: &SurfaceInteraction,
        d: Vec3,
    ) -> Response {
        let emitted = if self.sides == SIDES_BOTH || surface.is_front(d) {
            self.radiance.evaluate(scene, &surface.texture_context())
        } else {
            Color::BLACK
        };
        Response { emitted, scatter: None }
    }
}
