//! Checks that no handle of an arena leads astray: the GPU reads without looking. And that nothing in it
//! makes a loop run for ages, for an arena may come from a file that anybody may have written.
//!
//! What is large is checked in pieces, on all threads, in one go with the checksum of a file: nodes and
//! triangles of meshes. Of several faults, the same one is reported whatever the number of threads.

mod meshes;
#[cfg(test)]
mod tests;
mod trees;

use rayon::prelude::*;
use zrak_core::accessor::Array;
use zrak_core::materials::{Conductor, Roughness};
use zrak_core::media::{NO_PLACEMENT, VACUUM};
use zrak_core::scene::{
    MaterialKind, MaterialRef, PrimKind, PrimRef, SceneView, TextureKind, TextureRef,
};
use zrak_core::shapes::{CURVE_RIBBON, MAX_HALVINGS, NO_MOTION};
use zrak_core::textures::{
    ImageTexture, MAX_LEVELS, N_OPS, NO_MAPPING, OP_FRACTAL, OP_IMAGE, OP_NOISE, TEXELS_LINEAR,
    TEXELS_SRGB8, TEXELS_UNORM16, words_per_texel,
};

use super::{ArrayName, Piece};
use meshes::MeshChecker;
use trees::TreeChecker;

/// What is wrong with an arena.
#[derive(Debug, thiserror::Error)]
#[error("damaged scene data: {message}")]
pub struct Corrupt {
    message: String,
}

impl Corrupt {
    pub(super) fn new(message: impl Into<String>) -> Self {
        Self { message: message.into() }
    }
}

type Check = Result<(), Corrupt>;

fn require(condition: bool, message: impl FnOnce() -> String) -> Check {
    if condition { Ok(()) } else { Err(Corrupt::new(message())) }
}

/// Most records that one thread goes through when there are more.
const BATCH: usize = 4096;

/// Most steps from a material or a texture that refers to others to one that does not.
const NESTING_MAX: u8 = 64;
/// Most operations of a texture.
const OPS_MAX: u32 = 1 << 13;
/// Most octaves of noise.
const OCTAVES_MAX: u32 = 64;
/// Most segments of a path in a coat, and most paths.
const COAT_MAX: u32 = 1000;

/// Checks every record of an array.
fn each<T: bytemuck::Pod + Sync>(
    array: &Array<'_, T>,
    check: impl Fn(usize, T) -> Check + Sync,
) -> Check {
    let one = |i: u32| check(i as usize, array.get(i)).err();
    let found = if array.len() as usize <= BATCH {
        (0..array.len()).find_map(one)
    } else {
        (0..array.len()).into_par_iter().with_min_len(BATCH).find_map_first(one)
    };
    found.map_or(Ok(()), Err)
}

fn records<'a, T: bytemuck::Pod>(array: &Array<'a, T>) -> impl Iterator<Item = T> + use<'a, T> {
    let array = *array;
    (0..array.len()).map(move |i| array.get(i))
}

/// Checks every handle, link, image and tree. `at_piece` is called with the number of every piece,
/// from several threads, unless there is an error.
pub(super) fn check(
    scene: &SceneView,
    pieces: &[Piece],
    at_piece: &(dyn Fn(usize) + Sync),
) -> Check {
    let binary = TreeChecker::new("nodes2", scene, scene.nodes2, |instance| instance.root2)?;
    let wide = TreeChecker::new("nodes8", scene, scene.nodes8, |instance| instance.root8)?;
    let meshes = MeshChecker::new(scene);
    let one = |i: usize| {
        let piece = pieces[i];
        at_piece(i);
        match piece.array {
            ArrayName::nodes2 => binary.check_piece(piece.index),
            ArrayName::nodes8 => wide.check_piece(piece.index),
            ArrayName::mesh_triangles => meshes.check_piece(piece.index),
            _ => Ok(()),
        }
    };
    let fault = (0..pieces.len()).into_par_iter().find_map_first(|i| one(i).err());
    fault.map_or(Ok(()), Err)?;
    let (binary, wide) = rayon::join(|| binary.finish(), || wide.finish());
    binary?;
    wide?;
    meshes.check_patches()?;
    check_shapes(scene)?;
    check_simple_materials(scene)?;
    check_surfaces(scene)?;
    check_plain_textures(scene)?;
    check_programs(scene)
}

/// Checks primitives, and what all of them have in common, except for the triangles of meshes.
fn check_shapes(scene: &SceneView) -> Check {
    each(&scene.spheres, |_, shape| check_material(scene, shape.material))?;
    each(&scene.moving_spheres, |_, shape| check_material(scene, shape.material))?;
    each(&scene.quads, |_, shape| check_material(scene, shape.material))?;
    each(&scene.boxes, |_, shape| check_material(scene, shape.material))?;
    each(&scene.triangles, |_, shape| check_material(scene, shape.material))?;
    each(&scene.disks, |_, shape| check_material(scene, shape.material))?;
    each(&scene.cylinders, |_, shape| check_material(scene, shape.material))?;
    each(&scene.partial_spheres, |_, shape| check_material(scene, shape.material))?;
    each(&scene.curves, |_, curve| {
        check_material(scene, curve.material)?;
        require(curve.form <= CURVE_RIBBON, || format!("a curve of form {}", curve.form))?;
        require(curve.form != CURVE_RIBBON || curve.ribbon < scene.ribbons.len(), || {
            format!("no normals {} of a ribbon", curve.ribbon)
        })?;
        // A ray walks over all pieces.
        require(curve.n_halvings <= MAX_HALVINGS, || {
            format!("a curve that is halved {} times", curve.n_halvings)
        })
    })?;
    each(&scene.meshes, |_, mesh| check_material(scene, mesh.material))?;
    each(&scene.instances, |_, instance| {
        require(instance.motion == NO_MOTION || instance.motion < scene.motions.len(), || {
            format!("no motion {}", instance.motion)
        })
    })?;
    each(&scene.media, |_, medium| {
        check_prim(scene, medium.boundary)?;
        require(is_plain_convex(medium.boundary), || {
            format!("a medium in primitive {:#x}", medium.boundary.0)
        })?;
        require(
            medium.placement == NO_PLACEMENT || medium.placement < scene.placements.len(),
            || format!("no placement {}", medium.placement),
        )?;
        check_material(scene, medium.material)?;
        require(medium.material.kind() == Some(MaterialKind::Isotropic), || {
            format!("a medium with material {:#x}", medium.material.0)
        })
    })
}

/// Checks materials that lead to one texture each.
fn check_simple_materials(scene: &SceneView) -> Check {
    each(&scene.lambertians, |_, m| check_texture(scene, m.albedo.texture))?;
    each(&scene.metals, |_, m| check_texture(scene, m.reflectance.texture))?;
    each(&scene.isotropics, |_, m| check_texture(scene, m.albedo.texture))?;
    each(&scene.diffuse_lights, |_, m| check_texture(scene, m.radiance.texture))
}

/// Checks checkers and plain images.
fn check_plain_textures(scene: &SceneView) -> Check {
    let mut levels = Nesting::with_capacity(scene.checkers.len());
    for (i, checker) in records(&scene.checkers).enumerate() {
        let inner = |texture: TextureRef| {
            let is_checker = texture.kind() == Some(TextureKind::Checker);
            is_checker.then_some(texture.index() as usize)
        };
        let textures = [checker.even.texture, checker.odd.texture];
        for texture in textures {
            check_texture(scene, texture)?;
        }
        // To earlier ones only, so that no chain is a circle.
        levels.push(textures.map(inner), || format!("checker {i} refers to a later one"))?;
    }
    for image in records(&scene.images) {
        require(matches!(image.format, TEXELS_SRGB8 | TEXELS_LINEAR), || {
            format!("texels of format {} in a plain image", image.format)
        })?;
        check_raster(scene, &image, 1)?;
    }
    Ok(())
}

/// How deep records are nested that may refer to earlier ones of their kind.
struct Nesting(Vec<u8>);

impl Nesting {
    fn with_capacity(n: u32) -> Self {
        Self(Vec::with_capacity(n as usize))
    }

    /// Adds the next record, which refers to these.
    fn push(&mut self, inner: [Option<usize>; 2], message: impl Fn() -> String) -> Check {
        let mut level = 0;
        for i in inner.into_iter().flatten() {
            let Some(&below) = self.0.get(i) else { return Err(Corrupt::new(message())) };
            level = level.max(below + 1);
        }
        require(level <= NESTING_MAX, || format!("more than {NESTING_MAX} in one another"))?;
        self.0.push(level);
        Ok(())
    }
}

/// Checks that the levels of an image lie within the texels.
fn check_raster(scene: &SceneView, image: &ImageTexture, n_levels: u32) -> Check {
    require(image.format <= TEXELS_UNORM16, || format!("texels of format {}", image.format))?;
    require(image.width > 0 && image.height > 0, || "an image without texels".into())?;
    require((1..=MAX_LEVELS).contains(&n_levels), || format!("an image of {n_levels} levels"))?;
    let words_per_texel = u64::from(words_per_texel(image.format));
    let (mut width, mut height) = (u64::from(image.width), u64::from(image.height));
    let mut end = u64::from(image.first_word);
    for _ in 0..n_levels {
        end = end.saturating_add((width * height).saturating_mul(words_per_texel));
        (width, height) = ((width / 2).max(1), (height / 2).max(1));
    }
    require(end <= u64::from(scene.texels.len()), || {
        "an image that ends beyond the texels".into()
    })?;
    // Texels are counted in 32-bit signed numbers.
    require(image.width < 1 << 24 && image.height < 1 << 24, || "an image with long sides".into())?;
    require(image.format != TEXELS_SRGB8 || scene.srgb_table.len() == 256, || {
        "8-bit texels without the table that decodes them".into()
    })
}

/// Checks the textures made of textures, and what they are made of.
fn check_programs(scene: &SceneView) -> Check {
    let mapped = |mapping: u32| {
        require(mapping == NO_MAPPING || mapping < scene.mappings.len(), || {
            format!("no mapping {mapping}")
        })
    };
    for map in records(&scene.image_maps) {
        check_raster(scene, &map.raster, map.n_levels)?;
        mapped(map.mapping)?;
    }
    for environment in records(&scene.environments) {
        require(environment.image < scene.image_maps.len(), || {
            format!("an environment with image {}", environment.image)
        })?;
    }
    for program in records(&scene.programs) {
        let end = u64::from(program.first_op) + u64::from(program.n_ops);
        require(program.n_ops <= OPS_MAX, || format!("a texture of {} steps", program.n_ops))?;
        require(program.n_ops > 0 && end <= u64::from(scene.texture_ops.len()), || {
            "a texture whose operations are not there".into()
        })?;
    }
    for op in records(&scene.texture_ops) {
        require(op.op < N_OPS, || format!("no texture operation {}", op.op))?;
        mapped(op.mapping)?;
        let len = match op.op {
            OP_NOISE => scene.noises.len(),
            OP_FRACTAL => scene.fractals.len(),
            OP_IMAGE => scene.image_maps.len(),
            _ => continue,
        };
        require(op.index < len, || format!("a texture operation with record {}", op.index))?;
    }
    // Octaves are loops.
    for octaves in records(&scene.noises)
        .map(|noise| noise.octaves)
        .chain(records(&scene.fractals).map(|fractal| fractal.octaves))
    {
        require(octaves <= OCTAVES_MAX, || format!("noise of {octaves} octaves"))?;
    }
    Ok(())
}

fn is_plain_convex(prim: PrimRef) -> bool {
    matches!(prim.kind(), Some(PrimKind::Sphere | PrimKind::MovingSphere | PrimKind::Box))
}

fn check_prim(scene: &SceneView, prim: PrimRef) -> Check {
    let is_there = !prim.is_node() && prim.index() < n_prims(scene, prim.0 >> 28);
    require(is_there, || format!("no primitive {:#x}", prim.0))
}

/// Number of primitives of a kind.
fn n_prims(scene: &SceneView, kind: u32) -> u32 {
    // A handle with this kind, which is not a node's.
    match PrimRef(kind << 28).kind() {
        Some(PrimKind::Sphere) => scene.spheres.len(),
        Some(PrimKind::MovingSphere) => scene.moving_spheres.len(),
        Some(PrimKind::Quad) => scene.quads.len(),
        Some(PrimKind::Box) => scene.boxes.len(),
        Some(PrimKind::Triangle) => scene.triangles.len(),
        Some(PrimKind::MeshTriangle) => scene.mesh_triangles.len(),
        Some(PrimKind::Disk) => scene.disks.len(),
        Some(PrimKind::Cylinder) => scene.cylinders.len(),
        Some(PrimKind::PartialSphere) => scene.partial_spheres.len(),
        Some(PrimKind::MeshPatch) => scene.mesh_patches.len(),
        Some(PrimKind::Curve) => scene.curves.len(),
        Some(PrimKind::Instance) => scene.instances.len(),
        Some(PrimKind::Medium) => scene.media.len(),
        Some(PrimKind::Node) | None => 0,
    }
}

fn check_material(scene: &SceneView, material: MaterialRef) -> Check {
    let len = match material.kind() {
        Some(MaterialKind::Lambertian) => scene.lambertians.len(),
        Some(MaterialKind::Metal) => scene.metals.len(),
        Some(MaterialKind::Dielectric) => scene.dielectrics.len(),
        Some(MaterialKind::Isotropic) => scene.isotropics.len(),
        Some(MaterialKind::DiffuseLight) => scene.diffuse_lights.len(),
        Some(MaterialKind::Conductor) => scene.conductors.len(),
        Some(MaterialKind::RoughDielectric) => scene.rough_dielectrics.len(),
        Some(MaterialKind::ThinDielectric) => scene.thin_dielectrics.len(),
        Some(MaterialKind::DiffuseTransmission) => scene.diffuse_transmissions.len(),
        Some(MaterialKind::Layered) => scene.layereds.len(),
        Some(MaterialKind::Principled) => scene.principleds.len(),
        Some(MaterialKind::Mix) => scene.mixes.len(),
        Some(MaterialKind::Interface) => scene.interfaces.len(),
        Some(MaterialKind::Surface) => scene.surfaces.len(),
        None => 0,
    };
    require(material.index() < len, || format!("no material {:#x}", material.0))
}

fn check_texture(scene: &SceneView, texture: TextureRef) -> Check {
    let len = match texture.kind() {
        Some(TextureKind::Solid) => return Ok(()),
        Some(TextureKind::Checker) => scene.checkers.len(),
        Some(TextureKind::Noise) => scene.noises.len(),
        Some(TextureKind::Image) => scene.images.len(),
        Some(TextureKind::Program) => scene.programs.len(),
        None => 0,
    };
    require(texture.index() < len, || format!("no texture {:#x}", texture.0))
}

/// Checks materials that lead to other materials, to textures and to media.
fn check_surfaces(scene: &SceneView) -> Check {
    let roughness = |r: Roughness| [r.u.texture, r.v.texture];
    let metal = |m: Conductor| {
        let [u, v] = roughness(m.roughness);
        [m.reflectance.texture, u, v]
    };
    for texture in records(&scene.conductors)
        .flat_map(metal)
        .chain(records(&scene.rough_dielectrics).flat_map(|m| roughness(m.roughness)))
        .chain(
            records(&scene.diffuse_transmissions)
                .flat_map(|m| [m.reflectance.texture, m.transmittance.texture]),
        )
        .chain(records(&scene.layereds).flat_map(|m| metal(m.metal)))
        .chain(records(&scene.layereds).flat_map(|m| roughness(m.roughness)))
        .chain(records(&scene.layereds).map(|m| m.color.texture))
        .chain(records(&scene.principleds).flat_map(|m| m.textures()))
    {
        check_texture(scene, texture)?;
    }
    for coat in records(&scene.layereds) {
        require(coat.max_depth <= COAT_MAX && coat.n_samples <= COAT_MAX, || {
            format!("a coat with {} paths of {} segments", coat.n_samples, coat.max_depth)
        })?;
    }
    let mut levels = Nesting::with_capacity(scene.mixes.len());
    for (i, mix) in records(&scene.mixes).enumerate() {
        check_texture(scene, mix.amount.texture)?;
        let message = || format!("mix {i} leads to a later one or to a surface");
        let inner = |material: MaterialRef| {
            let is_mix = material.kind() == Some(MaterialKind::Mix);
            is_mix.then_some(material.index() as usize)
        };
        for material in mix.materials {
            check_material(scene, material)?;
            require(material.kind() != Some(MaterialKind::Surface), message)?;
        }
        levels.push(mix.materials.map(inner), message)?;
    }
    for (i, surface) in records(&scene.surfaces).enumerate() {
        check_material(scene, surface.base)?;
        require(surface.base.kind() != Some(MaterialKind::Surface), || {
            format!("surface {i} leads to a surface")
        })?;
        let textures = [
            surface.emission.texture,
            surface.alpha.texture,
            surface.bump.texture,
            surface.normal_map,
        ];
        for texture in textures {
            check_texture(scene, texture)?;
        }
        for medium in [surface.inside, surface.outside] {
            check_medium(scene, medium)?;
        }
    }
    check_medium(scene, scene.globals.camera_medium)
}

fn check_medium(scene: &SceneView, medium: u32) -> Check {
    require(medium == VACUUM || medium < scene.homogeneous_media.len(), || {
        format!("no medium {medium}")
    })
}
