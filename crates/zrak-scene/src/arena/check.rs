//! Checks that no handle of an arena leads astray: the GPU reads without looking.

use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::accessor::Array;
use zrak_core::materials::{Conductor, Roughness};
use zrak_core::media::{NO_PLACEMENT, VACUUM};
use zrak_core::scene::{
    MaterialKind, MaterialRef, PrimKind, PrimRef, SceneView, TextureKind, TextureRef,
};
use zrak_core::shapes::{
    CURVE_RIBBON, Instance, MAX_HALVINGS, MESH_COLORS, MESH_NORMALS, MESH_TANGENTS, MESH_UVS,
    NO_MOTION,
};
use zrak_core::textures::{
    ImageTexture, MAX_LEVELS, N_OPS, NO_MAPPING, OP_FRACTAL, OP_IMAGE, OP_NOISE, TEXELS_LINEAR,
    TEXELS_SRGB8, TEXELS_UNORM16, words_per_texel,
};

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
    check_trees("nodes2", scene, &scene.nodes2, |instance| instance.root2)?;
    check_trees("nodes8", scene, &scene.nodes8, |instance| instance.root8)?;
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
    for disk in records(&scene.disks) {
        check_material(scene, disk.material)?;
    }
    for cylinder in records(&scene.cylinders) {
        check_material(scene, cylinder.material)?;
    }
    for sphere in records(&scene.partial_spheres) {
        check_material(scene, sphere.material)?;
    }
    for curve in records(&scene.curves) {
        check_material(scene, curve.material)?;
        require(curve.form <= CURVE_RIBBON, || format!("a curve of form {}", curve.form))?;
        require(curve.form != CURVE_RIBBON || curve.ribbon < scene.ribbons.len(), || {
            format!("no normals {} of a ribbon", curve.ribbon)
        })?;
        // A ray walks over all pieces.
        require(curve.n_halvings <= MAX_HALVINGS, || {
            format!("a curve that is halved {} times", curve.n_halvings)
        })?;
    }
    for mesh in records(&scene.meshes) {
        check_material(scene, mesh.material)?;
    }
    check_meshes(scene)?;
    check_surfaces(scene)?;
    for instance in records(&scene.instances) {
        require(instance.motion == NO_MOTION || instance.motion < scene.motions.len(), || {
            format!("no motion {}", instance.motion)
        })?;
    }
    for medium in records(&scene.media) {
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
        require(matches!(image.format, TEXELS_SRGB8 | TEXELS_LINEAR), || {
            format!("texels of format {} in a plain image", image.format)
        })?;
        check_raster(scene, &image, 1)?;
    }
    check_programs(scene)
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
        require(octaves <= 64, || format!("noise of {octaves} octaves"))?;
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
        Some(PrimKind::MeshTriangle) => scene.mesh_triangles.len(),
        Some(PrimKind::Disk) => scene.disks.len(),
        Some(PrimKind::Cylinder) => scene.cylinders.len(),
        Some(PrimKind::PartialSphere) => scene.partial_spheres.len(),
        Some(PrimKind::MeshPatch) => scene.mesh_patches.len(),
        Some(PrimKind::Curve) => scene.curves.len(),
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

/// Checks that the trees are some: each node but a root has one parent, and none is too deep. The
/// world's root is the first; the others are those of instances, in whose trees no instance and no
/// medium is.
fn check_trees<const N: usize>(
    name: &str,
    scene: &SceneView,
    nodes: &Array<Node<N>>,
    root: impl Fn(&Instance) -> u32,
) -> Check {
    require(!nodes.is_empty(), || format!("{name} has no root"))?;
    // Depth of each node, with the top bit set in the trees of instances; 0 for one without a parent.
    const PLACED: u8 = 0x80;
    let mut depths = vec![0_u8; nodes.len() as usize];
    depths[0] = 1;
    for instance in records(&scene.instances) {
        let root = root(&instance);
        require(root > 0 && root < nodes.len(), || {
            format!("an instance of node {root} of {name}")
        })?;
        depths[root as usize] = 1 | PLACED;
    }
    for i in 0..nodes.len() {
        let depth = depths[i as usize];
        require(depth > 0, || format!("node {i} of {name} has no parent before it"))?;
        for child in nodes.get(i).children {
            if child == PrimRef::NONE {
                continue;
            }
            if !child.is_node() {
                check_prim(scene, child)?;
                let only_in_world =
                    matches!(child.kind(), Some(PrimKind::Instance | PrimKind::Medium));
                require(depth & PLACED == 0 || !only_in_world, || {
                    format!("an instance or a medium in a tree of {name} that instances place")
                })?;
                continue;
            }
            let c = child.index() as usize;
            require(c < depths.len() && c > i as usize && depths[c] == 0, || {
                format!("node {i} of {name} has node {c} as a child")
            })?;
            let too_deep = usize::from(depth & !PLACED) >= MAX_DEPTH;
            require(!too_deep, || format!("{name} is too deep"))?;
            depths[c] = depth + 1;
        }
    }
    Ok(())
}

/// Checks that triangles and patches lead to vertices, and vertices to all that their meshes say they
/// have.
fn check_meshes(scene: &SceneView) -> Check {
    for triangle in records(&scene.mesh_triangles) {
        check_face(scene, triangle.mesh, triangle.vertices)?;
    }
    for patch in records(&scene.mesh_patches) {
        check_face(scene, patch.mesh, patch.vertices)?;
    }
    Ok(())
}

fn check_face<const N: usize>(scene: &SceneView, mesh: u32, vertices: [u32; N]) -> Check {
    require(mesh < scene.meshes.len(), || format!("no mesh {mesh}"))?;
    let mesh = scene.meshes.get(mesh);
    for v in vertices {
        require(v < scene.positions.len(), || format!("no vertex {v}"))?;
        for (flag, offset, len) in [
            (MESH_NORMALS, mesh.normal_offset, scene.normals.len()),
            (MESH_UVS, mesh.uv_offset, scene.uvs.len()),
            (MESH_TANGENTS, mesh.tangent_offset, scene.tangents.len()),
            (MESH_COLORS, mesh.color_offset, scene.colors.len()),
        ] {
            require(mesh.flags & flag == 0 || v.wrapping_add(offset) < len, || {
                format!("vertex {v} lacks an attribute of its mesh")
            })?;
        }
    }
    Ok(())
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
    for (i, mix) in records(&scene.mixes).enumerate() {
        check_texture(scene, mix.amount.texture)?;
        for material in mix.materials {
            check_material(scene, material)?;
            let leads_on = match material.kind() {
                Some(MaterialKind::Mix) => material.index() as usize >= i,
                Some(MaterialKind::Surface) => true,
                _ => false,
            };
            require(!leads_on, || format!("mix {i} leads to a later one or to a surface"))?;
        }
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
