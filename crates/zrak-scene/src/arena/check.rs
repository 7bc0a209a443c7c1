//! Checks that no handle of an arena leads astray: the GPU reads without looking.

use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::accessor::Array;
use zrak_core::scene::{
    MaterialKind, MaterialRef, PrimKind, PrimRef, SceneView, TextureKind, TextureRef,
};
use zrak_core::textures::{TEXELS_LINEAR, TEXELS_SRGB8};

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

fn records<'a, T: bytemuck::Pod>(array: &Array<'a, T>) -> impl Iterator<Item = T> + use<'a, T> {
    let array = *array;
    (0..array.len()).map(move |i| array.get(i))
}

/// Checks every handle, link, image and tree.
pub(super) fn check(scene: &SceneView) -> Check {
    check_tree("nodes2", scene, &scene.nodes2)?;
    check_tree("nodes8", scene, &scene.nodes8)?;
    for shape in records(&scene.spheres) {
        check_material(scene, shape.material)?;
    }
    for shape in records(&scene.moving_spheres) {
        check_material(scene, shape.material)?;
    }
    for shape in records(&scene.quads) {
        check_material(scene, shape.material)?;
    }
    for shape in records(&scene.boxes) {
        check_material(scene, shape.material)?;
    }
    for shape in records(&scene.triangles) {
        check_material(scene, shape.material)?;
    }
    for instance in records(&scene.instances) {
        check_prim(scene, instance.target)?;
        require(is_plain_convex(instance.target), || {
            format!("an instance of primitive {:#x}", instance.target.0)
        })?;
    }
    for medium in records(&scene.media) {
        check_prim(scene, medium.boundary)?;
        require(
            is_plain_convex(medium.boundary) || medium.boundary.kind() == Some(PrimKind::Instance),
            || format!("a medium in primitive {:#x}", medium.boundary.0),
        )?;
        check_material(scene, medium.material)?;
        require(medium.material.kind() == Some(MaterialKind::Isotropic), || {
            format!("a medium with material {:#x}", medium.material.0)
        })?;
    }
    for input in records(&scene.lambertians)
        .map(|m| m.albedo)
        .chain(records(&scene.metals).map(|m| m.reflectance))
        .chain(records(&scene.isotropics).map(|m| m.albedo))
        .chain(records(&scene.diffuse_lights).map(|m| m.radiance))
    {
        check_texture(scene, input.texture)?;
    }
    for (i, checker) in records(&scene.checkers).enumerate() {
        for texture in [checker.even.texture, checker.odd.texture] {
            check_texture(scene, texture)?;
            // To earlier ones only, so that no chain is a circle.
            let is_later =
                texture.kind() == Some(TextureKind::Checker) && texture.index() as usize >= i;
            require(!is_later, || format!("checker {i} refers to a later one"))?;
        }
    }
    for image in records(&scene.images) {
        let words_per_texel = match image.format {
            TEXELS_SRGB8 => 1,
            TEXELS_LINEAR => 3,
            other => return Err(Corrupt::new(format!("texels of format {other}"))),
        };
        let n_words = u64::from(image.width) * u64::from(image.height) * words_per_texel;
        require(image.width > 0 && image.height > 0, || "an image without texels".into())?;
        require(u64::from(image.first_word) + n_words <= u64::from(scene.texels.len()), || {
            "an image that ends beyond the texels".into()
        })?;
        require(image.format != TEXELS_SRGB8 || scene.srgb_table.len() == 256, || {
            "8-bit texels without the table that decodes them".into()
        })?;
    }
    Ok(())
}

fn is_plain_convex(prim: PrimRef) -> bool {
    matches!(prim.kind(), Some(PrimKind::Sphere | PrimKind::MovingSphere | PrimKind::Box))
}

fn check_prim(scene: &SceneView, prim: PrimRef) -> Check {
    let len = match prim.kind() {
        Some(PrimKind::Sphere) => scene.spheres.len(),
        Some(PrimKind::MovingSphere) => scene.moving_spheres.len(),
        Some(PrimKind::Quad) => scene.quads.len(),
        Some(PrimKind::Box) => scene.boxes.len(),
        Some(PrimKind::Triangle) => scene.triangles.len(),
        Some(PrimKind::Instance) => scene.instances.len(),
        Some(PrimKind::Medium) => scene.media.len(),
        Some(PrimKind::Node) | None => 0,
    };
    require(prim.index() < len, || format!("no primitive {:#x}", prim.0))
}

fn check_material(scene: &SceneView, material: MaterialRef) -> Check {
    let len = match material.kind() {
        Some(MaterialKind::Lambertian) => scene.lambertians.len(),
        Some(MaterialKind::Metal) => scene.metals.len(),
        Some(MaterialKind::Dielectric) => scene.dielectrics.len(),
        Some(MaterialKind::Isotropic) => scene.isotropics.len(),
        Some(MaterialKind::DiffuseLight) => scene.diffuse_lights.len(),
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
        None => 0,
    };
    require(texture.index() < len, || format!("no texture {:#x}", texture.0))
}

/// Checks that a tree is one: each node has one parent, and none is too deep.
fn check_tree<const N: usize>(name: &str, scene: &SceneView, nodes: &Array<Node<N>>) -> Check {
    require(!nodes.is_empty(), || format!("{name} has no root"))?;
    let mut depths = vec![0_u8; nodes.len() as usize];
    depths[0] = 1;
    for i in 0..nodes.len() {
        let depth = depths[i as usize];
        require(depth > 0, || format!("node {i} of {name} has no parent before it"))?;
        for child in nodes.get(i).children {
            if child == PrimRef::NONE {
                continue;
            }
            if !child.is_node() {
                check_prim(scene, child)?;
                continue;
            }
            let c = child.index() as usize;
            require(c < depths.len() && c > i as usize && depths[c] == 0, || {
                format!("node {i} of {name} has node {c} as a child")
            })?;
            require(usize::from(depth) < MAX_DEPTH, || format!("{name} is too deep"))?;
            depths[c] = depth + 1;
        }
    }
    Ok(())
}
