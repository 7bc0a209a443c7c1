//! What is in an arena: counts, bounds, and memory by what it is for.

use std::collections::{BTreeMap, HashMap};

use serde::Serialize;
use zrak_core::accel::Node;
use zrak_core::accessor::Array;
use zrak_core::lights::{LIGHT_POINT, LIGHT_SPOT};
use zrak_core::materials::SURFACE_EMISSION;
use zrak_core::math::Bounds;
use zrak_core::scene::{PrimKind, PrimRef, SceneView};
use zrak_core::shapes::NO_MOTION;
use zrak_core::textures::{
    ImageTexture, TEXELS_LINEAR, TEXELS_SRGB8, TEXELS_UNORM8, words_per_texel,
};

use super::SceneArena;

/// What is in an arena.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ArenaStats {
    /// Smallest and largest coordinates of everything; none if there is nothing.
    pub bounds: Option<[[f32; 3]; 2]>,
    /// Primitives by kind; without media.
    pub primitives: Vec<PrimitiveCount>,
    /// Vertices of meshes.
    pub vertices: u64,
    /// Trees that are placed by instances.
    pub prototypes: u64,
    /// Placements of them.
    pub instances: u64,
    /// Those of them that move.
    pub moving_instances: u64,
    /// Media by kind.
    pub media: Vec<Count>,
    /// Materials by kind.
    pub materials: Vec<Count>,
    /// Lights by kind; of surfaces, the materials that emit are counted.
    pub lights: Vec<Count>,
    /// Textures by kind.
    pub textures: Vec<Count>,
    /// Images, each once.
    pub images: Vec<ImageStats>,
    /// Bytes by what they are for.
    pub memory: Vec<MemoryUse>,
    /// Bytes of the arena.
    pub bytes: u64,
}

/// Number of primitives of a kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct PrimitiveCount {
    /// The kind.
    pub kind: &'static str,
    /// Each counted once.
    pub unique: u64,
    /// Each counted as often as instances place it.
    pub placed: u64,
}

/// Number of things of a kind.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Count {
    /// The kind.
    pub kind: &'static str,
    /// How many.
    pub count: u64,
}

/// An image.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct ImageStats {
    /// Where its texels begin, in words.
    pub first_word: u32,
    /// Texels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// How its texels are stored.
    pub format: &'static str,
    /// Levels of detail, the image itself among them.
    pub levels: u32,
    /// Bytes of all levels.
    pub bytes: u64,
}

/// Memory for one purpose.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct MemoryUse {
    /// What it is for.
    pub kind: &'static str,
    /// How much.
    pub bytes: u64,
}

/// What an array is for: all names of a purpose.
const PURPOSES: [(&str, &[&str]); 6] = [
    (
        "geometry",
        &[
            "spheres",
            "moving_spheres",
            "quads",
            "boxes",
            "triangles",
            "meshes",
            "mesh_triangles",
            "positions",
            "normals",
            "uvs",
            "tangents",
            "colors",
            "disks",
            "cylinders",
            "partial_spheres",
            "mesh_patches",
            "curves",
            "ribbons",
        ],
    ),
    ("trees", &["nodes2", "nodes8"]),
    ("instances", &["instances", "motions", "placements"]),
    (
        "materials",
        &[
            "media",
            "lambertians",
            "metals",
            "dielectrics",
            "isotropics",
            "diffuse_lights",
            "conductors",
            "rough_dielectrics",
            "thin_dielectrics",
            "diffuse_transmissions",
            "layereds",
            "principleds",
            "interfaces",
            "mixes",
            "surfaces",
            "homogeneous_media",
        ],
    ),
    (
        "textures",
        &[
            "checkers",
            "noises",
            "images",
            "image_maps",
            "mappings",
            "fractals",
            "programs",
            "texture_ops",
            "texels",
            "srgb_table",
        ],
    ),
    ("lights", &["lights", "environments"]),
];

/// What arrays that are not listed are for.
const OTHER: &str = "other";

fn purpose(array: &str) -> &'static str {
    PURPOSES.iter().find(|(_, names)| names.contains(&array)).map_or(OTHER, |(kind, _)| kind)
}

impl ArenaStats {
    /// Counts what is in an arena. It visits every node of the binary trees.
    #[must_use]
    pub fn of(arena: &SceneArena) -> Self {
        let scene = arena.view();
        let counts = count_primitives(&scene);
        let mut memory: Vec<MemoryUse> = PURPOSES
            .iter()
            .map(|(kind, _)| *kind)
            .chain([OTHER])
            .map(|kind| MemoryUse { kind, bytes: 0 })
            .collect();
        for (name, bytes) in arena.sizes() {
            let kind = purpose(name);
            memory.iter_mut().filter(|m| m.kind == kind).for_each(|m| m.bytes += bytes as u64);
        }
        memory.retain(|m| m.bytes > 0);
        let moving = records(&scene.instances).filter(|i| i.motion != NO_MOTION).count();
        Self {
            bounds: bounds(&scene),
            primitives: counts.primitives,
            vertices: scene.positions.len().into(),
            prototypes: counts.n_prototypes,
            instances: scene.instances.len().into(),
            moving_instances: moving as u64,
            media: present(vec![
                ("constant", scene.media.len()),
                ("homogeneous", scene.homogeneous_media.len()),
            ]),
            materials: materials(&scene),
            lights: lights(&scene),
            textures: present(vec![
                ("checker", scene.checkers.len()),
                ("noise", scene.noises.len()),
                ("fractal", scene.fractals.len()),
                ("image", scene.images.len() + scene.image_maps.len()),
                ("combination", scene.programs.len()),
            ]),
            images: images(&scene),
            memory,
            bytes: arena.bytes().len() as u64,
        }
    }

    /// Primitives of all kinds, each counted once.
    #[must_use]
    pub fn n_unique(&self) -> u64 {
        self.primitives.iter().map(|count| count.unique).sum()
    }

    /// Primitives of all kinds, each counted as often as it is placed.
    #[must_use]
    pub fn n_placed(&self) -> u64 {
        self.primitives.iter().map(|count| count.placed).sum()
    }
}

fn records<'a, T: bytemuck::Pod>(array: &Array<'a, T>) -> impl Iterator<Item = T> + use<'a, T> {
    let array = *array;
    (0..array.len()).map(move |i| array.get(i))
}

/// The kinds that there are some of.
fn present(counts: Vec<(&'static str, u32)>) -> Vec<Count> {
    let counts = counts.into_iter().filter(|(_, n)| *n > 0);
    counts.map(|(kind, n)| Count { kind, count: n.into() }).collect()
}

fn bounds(scene: &SceneView) -> Option<[[f32; 3]; 2]> {
    let root = scene.nodes2.get(0);
    let boxes = (0..2).filter(|&i| root.children[i] != PrimRef::NONE).map(|i| {
        let corner = |planes: &[[f32; 2]; 3]| {
            zrak_core::math::vec3(planes[0][i], planes[1][i], planes[2][i])
        };
        Bounds { lo: corner(&root.lo), hi: corner(&root.hi) }
    });
    let Bounds { lo, hi } = boxes.reduce(|a, b| a.union(b))?;
    Some([[lo.x, lo.y, lo.z], [hi.x, hi.y, hi.z]])
}

struct Primitives {
    primitives: Vec<PrimitiveCount>,
    n_prototypes: u64,
}

/// Numbers of primitives, by the number of their kind.
type ByKind = BTreeMap<u32, u64>;

fn count_primitives(scene: &SceneView) -> Primitives {
    let mut n_placements: BTreeMap<u32, u64> = BTreeMap::new();
    for instance in records(&scene.instances) {
        *n_placements.entry(instance.root2).or_insert(0) += 1;
    }
    let mut unique = tree(&scene.nodes2, 0);
    let mut placed = unique.clone();
    for (&root, &n) in &n_placements {
        for (kind, count) in tree(&scene.nodes2, root) {
            *unique.entry(kind).or_insert(0) += count;
            *placed.entry(kind).or_insert(0) += count.saturating_mul(n);
        }
    }
    let primitives = unique
        .iter()
        .filter_map(|(&kind, &unique)| {
            let kind_of_prim = PrimRef(kind << 28).kind();
            let name = match kind_of_prim? {
                PrimKind::Node | PrimKind::Instance | PrimKind::Medium => return None,
                PrimKind::Sphere => "sphere",
                PrimKind::MovingSphere => "moving sphere",
                PrimKind::Quad => "quad",
                PrimKind::Box => "box",
                PrimKind::Triangle => "triangle",
                PrimKind::MeshTriangle => "mesh triangle",
                PrimKind::Disk => "disk",
                PrimKind::Cylinder => "cylinder",
                PrimKind::PartialSphere => "part of a sphere",
                PrimKind::MeshPatch => "bilinear patch",
                PrimKind::Curve => "curve",
            };
            Some(PrimitiveCount { kind: name, unique, placed: placed[&kind] })
        })
        .collect();
    Primitives { primitives, n_prototypes: n_placements.len() as u64 }
}

/// The primitives of a tree.
fn tree(nodes: &Array<Node<2>>, root: u32) -> ByKind {
    let mut counts = ByKind::new();
    let mut stack = vec![root];
    while let Some(node) = stack.pop() {
        for child in nodes.get(node).children {
            if child == PrimRef::NONE {
                continue;
            }
            if child.is_node() {
                stack.push(child.index());
            } else {
                *counts.entry(child.0 >> 28).or_insert(0) += 1;
            }
        }
    }
    counts
}

fn materials(scene: &SceneView) -> Vec<Count> {
    present(vec![
        ("lambertian", scene.lambertians.len()),
        ("metal", scene.metals.len()),
        ("dielectric", scene.dielectrics.len()),
        ("isotropic", scene.isotropics.len()),
        ("diffuse_light", scene.diffuse_lights.len()),
        ("conductor", scene.conductors.len()),
        ("rough_dielectric", scene.rough_dielectrics.len()),
        ("thin_dielectric", scene.thin_dielectrics.len()),
        ("diffuse_transmission", scene.diffuse_transmissions.len()),
        ("layered", scene.layereds.len()),
        ("principled", scene.principleds.len()),
        ("interface", scene.interfaces.len()),
        ("mix", scene.mixes.len()),
        ("surface", scene.surfaces.len()),
    ])
}

fn lights(scene: &SceneView) -> Vec<Count> {
    let [mut point, mut spot, mut distant] = [0; 3];
    for light in records(&scene.lights) {
        match light.kind {
            LIGHT_POINT => point += 1,
            LIGHT_SPOT => spot += 1,
            _ => distant += 1,
        }
    }
    let emits = records(&scene.surfaces).filter(|s| s.flags & SURFACE_EMISSION != 0).count();
    let background = scene.globals.background;
    let shines = |c: zrak_core::math::Color| c.r.max(c.g).max(c.b) > 0.0;
    let is_lit = shines(background.bottom) || shines(background.top);
    present(vec![
        ("point", point),
        ("spot", spot),
        ("distant", distant),
        ("environment", scene.environments.len()),
        ("background", u32::from(scene.environments.is_empty() && is_lit)),
        ("emitting material", scene.diffuse_lights.len() + emits as u32),
    ])
}

fn images(scene: &SceneView) -> Vec<ImageStats> {
    let maps = records(&scene.image_maps).map(|map| (map.raster, map.n_levels));
    let plain = records(&scene.images).map(|image| (image, 1));
    let mut levels: HashMap<u32, (ImageTexture, u32)> = HashMap::new();
    for (image, n_levels) in plain.chain(maps) {
        let known = levels.entry(image.first_word).or_insert((image, n_levels));
        known.1 = known.1.max(n_levels);
    }
    let mut images: Vec<ImageStats> = levels.into_values().map(image_stats).collect();
    images.sort_by_key(|image| image.first_word);
    images
}

fn image_stats((image, levels): (ImageTexture, u32)) -> ImageStats {
    let ImageTexture { first_word, width, height, format, .. } = image;
    let (mut n_texels, mut size) = (0, [u64::from(width), u64::from(height)]);
    for _ in 0..levels {
        n_texels += size[0] * size[1];
        size = size.map(|n| (n / 2).max(1));
    }
    let name = match format {
        TEXELS_SRGB8 => "sRGB, 8 bits",
        TEXELS_LINEAR => "float",
        TEXELS_UNORM8 => "linear, 8 bits",
        _ => "linear, 16 bits",
    };
    let bytes = n_texels * u64::from(words_per_texel(format)) * 4;
    ImageStats { first_word, width, height, format: name, levels, bytes }
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use zrak_mesh::TriangleMesh;

    use super::*;
    use crate::builtin;
    use crate::desc::{MeshDesc, ObjectDesc, SceneDesc, TransformStep};
    use crate::lower::{LowerOptions, lower};

    #[test]
    fn every_array_has_a_purpose() {
        let arena = lower(&SceneDesc::default(), &LowerOptions::new(".")).unwrap();
        for (name, _) in arena.sizes() {
            assert_ne!(purpose(name), OTHER, "say what the array `{name}` is for");
        }
    }

    #[test]
    fn memory_is_that_of_the_arena() {
        for scene in builtin::all() {
            let arena = lower(&(scene.build)(), &LowerOptions::new(".")).unwrap();
            let stats = ArenaStats::of(&arena);
            let sum: u64 = stats.memory.iter().map(|m| m.bytes).sum();
            // Each array ends with some padding.
            let padding = 256 * arena.sizes().len() as u64;
            assert!(sum <= stats.bytes && stats.bytes - sum < padding, "{}", scene.name);
        }
    }

    #[test]
    fn placed_primitives_are_counted_as_often_as_they_are_placed() {
        let mut desc = (builtin::find("quads").unwrap().build)();
        let material = desc.materials.keys().next().unwrap().clone();
        let n_quads = desc.objects.len() as u64;
        let mesh = TriangleMesh {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 9.0]],
            triangles: vec![[0, 1, 2], [1, 2, 3], [2, 3, 0]],
            ..TriangleMesh::default()
        };
        desc.meshes.insert("fan".into(), MeshDesc::Loaded(Arc::new(mesh)));
        let placed = ObjectDesc::Mesh {
            mesh: "fan".into(),
            material,
            group_materials: Vec::new(),
            flip: false,
            transform: Vec::new(),
        };
        desc.prototypes.insert("fan".into(), vec![placed]);
        for i in 0..7 {
            desc.objects.push(ObjectDesc::Instance {
                prototype: "fan".into(),
                transform: vec![TransformStep::Translate([100.0 * f64::from(i), 0.0, 0.0])],
                transform_end: None,
            });
        }
        let stats = ArenaStats::of(&lower(&desc, &LowerOptions::new(".")).unwrap());
        let count = |kind: &str| {
            let count = stats.primitives.iter().find(|count| count.kind == kind).unwrap();
            (count.unique, count.placed)
        };
        assert_eq!(count("mesh triangle"), (3, 21));
        assert_eq!(count("quad"), (n_quads, n_quads));
        assert_eq!((stats.prototypes, stats.instances, stats.vertices), (1, 7, 4));
        let [_, hi] = stats.bounds.unwrap();
        assert!((600.9..601.1).contains(&hi[0]) && hi[2] >= 9.0, "{hi:?}");
    }
}
