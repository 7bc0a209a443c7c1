//! The arena's layout, and what its check refuses.

use zrak_core::accel::{MAX_DEPTH, Node};
use zrak_core::camera::Camera;
use zrak_core::materials::{Dielectric, DiffuseLight, Isotropic, Lambertian, Metal, Mix, Surface};
use zrak_core::math::{Affine, Color, Vec3};
use zrak_core::media::ConstantMedium;
use zrak_core::scene::{
    Background, Globals, MaterialKind, MaterialRef, PrimKind, PrimRef, TextureKind, TextureRef,
};
use zrak_core::shapes::{
    Box3, CURVE_RIBBON, Curve, Cylinder, Disk, Instance, MESH_COLORS, MESH_NORMALS, MESH_TANGENTS,
    MESH_UVS, Mesh, MeshPatch, MeshTriangle, Motion, MovingSphere, PartialSphere, Placement, Quad,
    Sphere, Triangle,
};
use zrak_core::textures::{
    Checker, ColorInput, ImageMap, ImageTexture, N_OPS, Noise, OP_FRACTAL, OP_IMAGE, OP_NOISE,
    PATTERN_NOISE, Program, ScalarInput, TEXELS_LINEAR, TEXELS_SRGB8, TEXELS_UNORM16, TextureOp,
};

use super::{ARENA_ALIGNMENT, SceneArena, SceneArrays};

fn globals() -> Globals {
    let camera: Camera = bytemuck::Zeroable::zeroed();
    let background = Background { bottom: Color::WHITE, top: Color::BLACK };
    Globals {
        camera,
        background,
        max_depth: 7,
        seed_lo: 1,
        seed_hi: 2,
        camera_medium: 0,
        rr_depth: 2,
        _pad: 0,
    }
}

fn input(kind: TextureKind, index: u32) -> ColorInput {
    ColorInput { solid: Color::grey(0.5), texture: TextureRef::new(kind, index) }
}

fn material(kind: MaterialKind) -> MaterialRef {
    MaterialRef::new(kind, 0)
}

fn prim(kind: PrimKind) -> PrimRef {
    PrimRef::new(kind, 0)
}

/// A root whose children are these.
fn root<const N: usize>(children: &[PrimRef]) -> Node<N> {
    let mut node = Node::EMPTY;
    node.children[..children.len()].copy_from_slice(children);
    node
}

/// One record of each array, all good.
fn good() -> SceneArrays {
    let mut a = SceneArrays::default();
    let lambertian = material(MaterialKind::Lambertian);
    a.lambertians.push(Lambertian { albedo: input(TextureKind::Checker, 1) });
    a.metals.push(Metal { reflectance: input(TextureKind::Noise, 0), fuzz: 0.1, _pad: [0; 3] });
    a.dielectrics.push(Dielectric { ior: 1.5, fresnel: 0, _pad: [0; 2] });
    a.isotropics.push(Isotropic { albedo: input(TextureKind::Solid, 0) });
    let radiance = input(TextureKind::Image, 0);
    a.diffuse_lights.push(DiffuseLight { radiance, sides: 0, _pad: [0; 3] });
    let checker =
        |even| Checker { even, odd: input(TextureKind::Solid, 0), inv_scale: 1.0, _pad: [0; 3] };
    a.checkers.push(checker(input(TextureKind::Image, 0)));
    a.checkers.push(checker(input(TextureKind::Checker, 0)));
    a.noises.push(Noise {
        low: Color::BLACK,
        scale: 1.0,
        high: Color::WHITE,
        pattern: PATTERN_NOISE,
        octaves: 1,
        seed: 0,
        _pad: [0; 2],
    });
    a.images.push(ImageTexture {
        first_word: 1,
        width: 3,
        height: 2,
        format: TEXELS_SRGB8,
        bilinear: 1,
        _pad: [0; 3],
    });
    // 3x2 texels, 1x1, from the first word on.
    let raster = ImageTexture { first_word: 0, ..a.images[0] };
    a.image_maps.push(ImageMap { raster, n_levels: 2, mapping: 0, ..bytemuck::Zeroable::zeroed() });
    a.mappings.push(bytemuck::Zeroable::zeroed());
    a.fractals.push(bytemuck::Zeroable::zeroed());
    a.programs.push(Program { first_op: 0, n_ops: 3 });
    let op = |op| TextureOp { op, ..bytemuck::Zeroable::zeroed() };
    a.texture_ops.extend([op(OP_NOISE), op(OP_FRACTAL), op(OP_IMAGE)]);
    a.environments.push(bytemuck::Zeroable::zeroed());
    a.texels = (0..7).collect();
    a.srgb_table = (0..256).map(|i| i as f32).collect();
    let center = Vec3::splat(1.0);
    a.spheres.push(Sphere { center, radius: 2.0, material: lambertian, flags: 0, _pad: [0; 2] });
    a.moving_spheres.push(MovingSphere {
        center,
        radius: 1.0,
        displacement: center,
        material: material(MaterialKind::Metal),
        flags: 0,
        _pad: [0; 3],
    });
    a.quads.push(Quad { material: lambertian, ..bytemuck::Zeroable::zeroed() });
    a.boxes.push(Box3 { lo: Vec3::ZERO, material: lambertian, hi: center, _pad: 0 });
    a.triangles.push(Triangle {
        vertices: [center; 3],
        uv: [[0.0; 2]; 3],
        material: material(MaterialKind::Dielectric),
    });
    a.positions = vec![center; 4];
    a.normals = vec![center; 3];
    a.uvs = vec![[0.5; 2]; 3];
    a.tangents = vec![[1.0; 4]; 3];
    a.colors = vec![[1.0; 4]; 3];
    // The mesh's vertices are 1 to 3, their attributes 0 to 2.
    a.meshes.push(Mesh {
        material: material(MaterialKind::Surface),
        flags: MESH_NORMALS | MESH_UVS | MESH_TANGENTS | MESH_COLORS,
        normal_offset: u32::MAX,
        uv_offset: u32::MAX,
        tangent_offset: u32::MAX,
        color_offset: u32::MAX,
        _pad: [0; 2],
    });
    a.mesh_triangles.push(MeshTriangle { vertices: [1, 2, 3], mesh: 0 });
    a.disks.push(Disk { material: lambertian, ..bytemuck::Zeroable::zeroed() });
    a.cylinders.push(Cylinder {
        material: material(MaterialKind::Interface),
        ..bytemuck::Zeroable::zeroed()
    });
    a.partial_spheres.push(PartialSphere {
        material: material(MaterialKind::Interface),
        ..bytemuck::Zeroable::zeroed()
    });
    a.mesh_patches.push(MeshPatch { vertices: [1, 2, 3, 1], mesh: 0, flip: 0, _pad: [0; 2] });
    a.curves.push(Curve {
        material: lambertian,
        form: CURVE_RIBBON,
        ..bytemuck::Zeroable::zeroed()
    });
    a.ribbons.push(bytemuck::Zeroable::zeroed());
    let placement =
        Placement { world_from_object: Affine::IDENTITY, object_from_world: Affine::IDENTITY };
    a.placements.push(placement);
    a.motions.push(Motion { start: Affine::IDENTITY, end: Affine::IDENTITY });
    a.instances.push(Instance { placement, root2: 2, root8: 1, motion: 0, _pad: 0 });
    a.media.push(ConstantMedium {
        boundary: prim(PrimKind::Sphere),
        material: material(MaterialKind::Isotropic),
        neg_mean_free_path: -1.0,
        placement: 0,
    });
    let amount = ScalarInput { value: 0.5, texture: input(TextureKind::Noise, 0).texture };
    let two = [lambertian, material(MaterialKind::Metal)];
    a.mixes.push(Mix { amount, materials: two });
    a.mixes.push(Mix { amount, materials: [material(MaterialKind::Mix), lambertian] });
    a.surfaces.push(Surface {
        base: MaterialRef::new(MaterialKind::Mix, 1),
        emission: radiance,
        inside: 0,
        ..Surface::default()
    });
    a.conductors.push(bytemuck::Zeroable::zeroed());
    a.rough_dielectrics.push(bytemuck::Zeroable::zeroed());
    a.thin_dielectrics.push(bytemuck::Zeroable::zeroed());
    a.diffuse_transmissions.push(bytemuck::Zeroable::zeroed());
    a.layereds.push(bytemuck::Zeroable::zeroed());
    a.principleds.push(bytemuck::Zeroable::zeroed());
    a.interfaces.push(0);
    a.homogeneous_media.push(bytemuck::Zeroable::zeroed());
    a.lights.push(bytemuck::Zeroable::zeroed());
    let kinds = [PrimKind::Sphere, PrimKind::Quad, PrimKind::Medium, PrimKind::Triangle];
    a.nodes8.push(root(&kinds.map(prim)));
    a.nodes2.push(root(&[PrimRef::new(PrimKind::Node, 1), prim(PrimKind::Box)]));
    a.nodes2.push(root(&[prim(PrimKind::MovingSphere), prim(PrimKind::Instance)]));
    // The tree of the instance.
    a.nodes2.push(root(&[prim(PrimKind::MeshTriangle)]));
    let round = [PrimKind::Disk, PrimKind::Cylinder, PrimKind::PartialSphere];
    let bent = [PrimKind::MeshPatch, PrimKind::Curve];
    a.nodes8.push(root(&[&round[..], &bent].concat().into_iter().map(prim).collect::<Vec<_>>()));
    a
}

/// Records of an array, by its handle-checked accessor.
fn all<T: bytemuck::Pod>(array: zrak_core::accessor::Array<'_, T>) -> Vec<T> {
    (0..array.len()).map(|i| array.get(i)).collect()
}

#[test]
fn what_is_packed_is_what_is_seen() {
    let arrays = good();
    let arena = SceneArena::pack(globals(), arrays.clone()).unwrap();
    assert_eq!(*arena.globals(), globals());
    let view = arena.view();
    macro_rules! compare {
        ($($(#[$doc:meta])* $name:ident: $record:ty,)*) => {
            $({
                let source: &[u8] = bytemuck::cast_slice(&arrays.$name);
                let seen = all(view.$name);
                assert_eq!(bytemuck::cast_slice::<$record, u8>(&seen), source, stringify!($name));
                // In the bytes it lies where the span says, aligned for the GPU's loads.
                let span = arena.spans().$name;
                let start = span.offset as usize * 16;
                assert_eq!(start % ARENA_ALIGNMENT, 0);
                assert_eq!(&arena.bytes()[start..start + source.len()], source);
                assert!(!source.is_empty(), "no record of {}", stringify!($name));
            })*
        };
    }
    zrak_core::for_each_scene_array!(compare);
    assert_eq!(arena.bytes().as_ptr() as usize % ARENA_ALIGNMENT, 0);
    assert_eq!(arena.bytes().len() % ARENA_ALIGNMENT, 0);
    let size: usize = arena.sizes().iter().map(|(_, size)| size).sum();
    assert!(arena.bytes().len() >= size);
    // A copy is aligned as well.
    let copy = arena.clone();
    assert_eq!(copy.bytes().as_ptr() as usize % ARENA_ALIGNMENT, 0);
    assert_eq!(copy.bytes(), arena.bytes());
}

/// Asserts that the arrays are refused once they are damaged, with a message that contains `words`.
#[track_caller]
fn refused(words: &str, damage: impl FnOnce(&mut SceneArrays)) {
    let mut arrays = good();
    damage(&mut arrays);
    let error = match SceneArena::pack(globals(), arrays.clone()) {
        Ok(_) => panic!("damage was not noticed; expected: {words}"),
        Err(error) => error.to_string(),
    };
    assert!(error.contains(words), "{error:?} does not say {words:?}");
}

#[test]
fn materials_out_of_range_are_refused() {
    let beyond = MaterialRef::new(MaterialKind::Metal, 1);
    refused("no material", |a| a.spheres[0].material = beyond);
    refused("no material", |a| a.moving_spheres[0].material = beyond);
    refused("no material", |a| a.quads[0].material = beyond);
    refused("no material", |a| a.boxes[0].material = beyond);
    refused("no material", |a| a.triangles[0].material = beyond);
    refused("no material", |a| a.spheres[0].material = MaterialRef(0));
    refused("no material", |a| a.spheres[0].material = MaterialRef(u32::MAX));
    refused("no material", |a| a.dielectrics.clear());
    refused("no material", |a| a.media[0].material = MaterialRef::new(MaterialKind::Isotropic, 9));
    refused("a medium with material", |a| {
        a.media[0].material = material(MaterialKind::Lambertian);
    });
}

#[test]
fn textures_out_of_range_are_refused() {
    let beyond = input(TextureKind::Noise, 1);
    refused("no texture", |a| a.lambertians[0].albedo = beyond);
    refused("no texture", |a| a.metals[0].reflectance = beyond);
    refused("no texture", |a| a.isotropics[0].albedo = beyond);
    refused("no texture", |a| a.diffuse_lights[0].radiance = beyond);
    refused("no texture", |a| a.checkers[0].odd = beyond);
    refused("no texture", |a| a.lambertians[0].albedo.texture = TextureRef(0xf000_0000));
    refused("no texture", |a| a.images.clear());
}

#[test]
fn programs_that_lead_astray_are_refused() {
    let program = input(TextureKind::Program, 1);
    refused("no texture", |a| a.lambertians[0].albedo = program);
    refused("operations are not there", |a| a.programs[0].n_ops = 4);
    refused("operations are not there", |a| a.programs[0].n_ops = 0);
    refused("operations are not there", |a| a.programs[0].first_op = u32::MAX);
    refused("no texture operation", |a| a.texture_ops[0].op = N_OPS);
    for i in 0..3 {
        refused("with record", |a| a.texture_ops[i].index = 1);
        refused("no mapping", |a| a.texture_ops[i].mapping = 1);
    }
    refused("octaves", |a| a.fractals[0].octaves = u32::MAX);
    refused("octaves", |a| a.noises[0].octaves = u32::MAX);
    refused("an environment with image", |a| a.environments[0].image = 1);
}

#[test]
fn checkers_that_lead_in_circles_are_refused() {
    refused("refers to a later one", |a| a.checkers[0].even = input(TextureKind::Checker, 1));
    refused("refers to a later one", |a| a.checkers[0].odd = input(TextureKind::Checker, 0));
    refused("refers to a later one", |a| a.checkers[1].even = input(TextureKind::Checker, 1));
}

#[test]
fn images_beyond_the_texels_are_refused() {
    refused("beyond the texels", |a| a.images[0].first_word = 2);
    refused("beyond the texels", |a| a.images[0].format = TEXELS_LINEAR);
    refused("beyond the texels", |a| a.images[0].width = u32::MAX);
    refused("beyond the texels", |a| (a.images[0].width, a.images[0].height) = (1 << 16, 1 << 16));
    refused("beyond the texels", |a| a.images[0].first_word = u32::MAX);
    refused("without texels", |a| a.images[0].width = 0);
    refused("without texels", |a| a.images[0].height = 0);
    refused("format", |a| a.images[0].format = 2);
    refused("format", |a| a.image_maps[0].raster.format = 4);
    refused("beyond the texels", |a| a.image_maps[0].raster.first_word = 1);
    refused("beyond the texels", |a| a.image_maps[0].n_levels = 3);
    refused("beyond the texels", |a| a.image_maps[0].raster.format = TEXELS_UNORM16);
    refused("levels", |a| a.image_maps[0].n_levels = 0);
    refused("levels", |a| a.image_maps[0].n_levels = u32::MAX);
    refused("no mapping", |a| a.image_maps[0].mapping = 1);
    refused("without the table", |a| a.srgb_table.truncate(255));
}

#[test]
fn primitives_out_of_range_are_refused() {
    for kind in [
        PrimKind::Sphere,
        PrimKind::MovingSphere,
        PrimKind::Quad,
        PrimKind::Box,
        PrimKind::Triangle,
        PrimKind::MeshTriangle,
        PrimKind::Disk,
        PrimKind::Cylinder,
        PrimKind::PartialSphere,
        PrimKind::MeshPatch,
        PrimKind::Curve,
        PrimKind::Instance,
        PrimKind::Medium,
    ] {
        refused("no primitive", |a| a.nodes2[0].children[1] = PrimRef::new(kind, 1));
        refused("no primitive", |a| a.nodes8[0].children[7] = PrimRef::new(kind, 1));
    }
    refused("no primitive", |a| a.nodes8[0].children[0] = PrimRef(0xf000_0000));
    refused("no primitive", |a| a.media[0].boundary = PrimRef::new(PrimKind::Box, 1));
}

#[test]
fn boundaries_of_the_wrong_kind_are_refused() {
    for kind in [PrimKind::Quad, PrimKind::Triangle, PrimKind::Medium, PrimKind::Instance] {
        refused("a medium in", |a| a.media[0].boundary = prim(kind));
    }
    for kind in [PrimKind::Sphere, PrimKind::MovingSphere, PrimKind::Box] {
        let mut arrays = good();
        arrays.media[0].boundary = prim(kind);
        assert!(SceneArena::pack(globals(), arrays.clone()).is_ok());
    }
    refused("no placement", |a| a.media[0].placement = 1);
}

#[test]
fn instances_that_lead_astray_are_refused() {
    refused("an instance of node", |a| a.instances[0].root2 = 0);
    refused("an instance of node", |a| a.instances[0].root2 = 3);
    refused("an instance of node", |a| a.instances[0].root8 = 2);
    refused("no motion", |a| a.instances[0].motion = 1);
    // A node of the world's tree.
    refused("as a child", |a| a.instances[0].root2 = 1);
    // Nothing may be placed in what is placed, and media are told apart by one index each.
    refused("in a tree", |a| a.nodes2[2].children[1] = prim(PrimKind::Instance));
    refused("in a tree", |a| a.nodes8[1].children[1] = prim(PrimKind::Medium));
}

#[test]
fn meshes_that_lead_astray_are_refused() {
    refused("no mesh", |a| a.mesh_triangles[0].mesh = 1);
    refused("no vertex", |a| a.mesh_triangles[0].vertices[2] = 4);
    refused("lacks an attribute", |a| a.mesh_triangles[0].vertices[0] = 0);
    refused("lacks an attribute", |a| a.meshes[0].normal_offset = 0);
    refused("lacks an attribute", |a| a.meshes[0].uv_offset = 0);
    refused("lacks an attribute", |a| a.meshes[0].tangent_offset = 0);
    refused("lacks an attribute", |a| a.meshes[0].color_offset = 0);
    refused("no material", |a| a.meshes[0].material = MaterialRef(0));
    refused("no material", |a| a.disks[0].material = MaterialRef(0));
    refused("no material", |a| a.cylinders[0].material = MaterialRef(0));
    refused("no material", |a| a.partial_spheres[0].material = MaterialRef(0));
    refused("no mesh", |a| a.mesh_patches[0].mesh = 1);
    refused("no vertex", |a| a.mesh_patches[0].vertices[3] = 4);
    refused("lacks an attribute", |a| a.mesh_patches[0].vertices[3] = 0);
}

#[test]
fn curves_that_lead_astray_are_refused() {
    refused("no material", |a| a.curves[0].material = MaterialRef(0));
    refused("of form", |a| a.curves[0].form = 3);
    refused("no normals", |a| a.curves[0].ribbon = 1);
    refused("halved", |a| a.curves[0].n_halvings = 11);
}

#[test]
fn surfaces_and_mixes_that_lead_astray_are_refused() {
    let surface = material(MaterialKind::Surface);
    refused("leads to a surface", |a| a.surfaces[0].base = surface);
    refused("leads to a later one", |a| a.mixes[0].materials[1] = surface);
    refused("leads to a later one", |a| a.mixes[0].materials[0] = material(MaterialKind::Mix));
    refused("no medium", |a| a.surfaces[0].inside = 1);
    refused("no medium", |a| a.surfaces[0].outside = 7);
    let beyond = input(TextureKind::Noise, 1).texture;
    refused("no texture", |a| a.mixes[1].amount.texture = beyond);
    refused("no texture", |a| a.surfaces[0].emission.texture = beyond);
    refused("no texture", |a| a.surfaces[0].alpha.texture = beyond);
    refused("no texture", |a| a.surfaces[0].bump.texture = beyond);
    refused("no texture", |a| a.surfaces[0].normal_map = beyond);
    refused("no texture", |a| a.conductors[0].reflectance.texture = beyond);
    refused("no texture", |a| a.conductors[0].roughness.v.texture = beyond);
    refused("no texture", |a| a.rough_dielectrics[0].roughness.u.texture = beyond);
    refused("no texture", |a| a.diffuse_transmissions[0].transmittance.texture = beyond);
    refused("no texture", |a| a.layereds[0].color.texture = beyond);
    refused("no texture", |a| a.layereds[0].roughness.u.texture = beyond);
    refused("no texture", |a| a.layereds[0].metal.roughness.u.texture = beyond);
    refused("no texture", |a| a.principleds[0].fuzz_color.texture = beyond);
    refused("no texture", |a| a.principleds[0].thin_film_thickness.texture = beyond);
}

#[test]
fn trees_that_are_none_are_refused() {
    let node = |i| PrimRef::new(PrimKind::Node, i);
    refused("nodes2 has no root", |a| a.nodes2.clear());
    refused("nodes8 has no root", |a| a.nodes8.clear());
    // A circle, a node with two parents, one without, one out of bounds.
    refused("as a child", |a| a.nodes2[1].children[0] = node(0));
    refused("as a child", |a| a.nodes2[1].children[0] = node(1));
    refused("as a child", |a| a.nodes2[0].children[1] = node(1));
    refused("as a child", |a| a.nodes2[0].children[1] = node(2));
    refused("has no parent", |a| a.nodes2[0].children[0] = PrimRef::NONE);
    refused("has no parent", |a| a.nodes8.push(root(&[])));
}

#[test]
fn trees_that_are_too_deep_for_the_stack_are_refused() {
    let chain = |n: usize| {
        let mut arrays = good();
        arrays.nodes2 = (0..n)
            .map(|i| {
                if i + 1 < n {
                    root(&[PrimRef::new(PrimKind::Node, i as u32 + 1), prim(PrimKind::Sphere)])
                } else {
                    root(&[prim(PrimKind::Sphere)])
                }
            })
            .collect();
        // The tree of the instance comes last.
        arrays.instances[0].root2 = n as u32;
        arrays.nodes2.push(root(&[prim(PrimKind::Sphere)]));
        SceneArena::pack(globals(), arrays.clone()).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(chain(MAX_DEPTH), Ok(()));
    assert!(chain(MAX_DEPTH + 1).unwrap_err().contains("too deep"));
    assert!(chain(1000).unwrap_err().contains("too deep"));
}
