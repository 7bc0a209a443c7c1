//! Every way to find the closest hit finds the same one: the same bits of t, the same primitive. In
//! random scenes with every kind of primitive, many of them in the same place.

mod common;

use common::scenes;
use zrak_core::accel::{Accel, BruteForce, Bvh2, Bvh8};
use zrak_core::accessor::Array;
use zrak_core::interaction::NO_INSTANCE;
use zrak_core::math::{Vec3, lowbias32, unit_f32, vec3};
use zrak_core::ray::Ray;
use zrak_core::sampler::Sampler;
use zrak_core::scene::{PrimKind, PrimRef, SceneView};
use zrak_core::shapes::surface_interaction;
use zrak_scene::arena::SceneArena;
use zrak_scene::desc::{CurveForm, MeshDesc, ObjectDesc, ScaleDesc, TransformStep, Triple};

/// Random numbers.
struct Rng(u32);

impl Rng {
    fn bits(&mut self) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9);
        lowbias32(self.0)
    }

    fn below(&mut self, n: u32) -> u32 {
        self.bits() % n
    }

    fn range(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * f64::from(unit_f32(self.bits()))
    }

    /// A point in a cube around the origin; half of them on a coarse grid, so that things coincide.
    fn point(&mut self, size: f64) -> Triple {
        let on_grid = self.below(2) == 0;
        [(); 3].map(|()| {
            let x = self.range(-size, size);
            if on_grid { (x * 2.0 / size).round() * size / 2.0 } else { x }
        })
    }

    fn direction(&mut self) -> Vec3 {
        loop {
            let mut v = [(); 3].map(|()| self.range(-1.0, 1.0) as f32);
            match self.below(4) {
                0 => v[self.below(3) as usize] = 0.0,
                1 => {
                    // Along an axis.
                    let axis = self.below(3) as usize;
                    v = [0.0, -0.0, 0.0];
                    v[axis] = if self.below(2) == 0 { 1.0 } else { -1.0 };
                }
                _ => {}
            }
            let v = Vec3::from_array(v);
            if v.length() > 0.1 {
                return v.normalized();
            }
        }
    }
}

fn random_object(rng: &mut Rng, size: f64) -> ObjectDesc {
    let r = size * [0.05, 0.1, 0.25, 0.5][rng.below(4) as usize];
    let c = rng.point(size);
    let corner = |s: f64| c.map(|x| x + s);
    let edge = |rng: &mut Rng| loop {
        let e = rng.point(2.0 * r);
        if e.iter().map(|x| x * x).sum::<f64>() > 0.01 * r * r {
            return e;
        }
    };
    let m = || "m".to_owned();
    let object = match rng.below(14) {
        0 => scenes::sphere(c, r, "m"),
        1 => scenes::moving_sphere(c, rng.point(size), r, "m"),
        2 => {
            // Along the axes, or any.
            let (u, v) = if rng.below(2) == 0 {
                ([r, 0.0, 0.0], [0.0, 0.0, 2.0 * r])
            } else {
                (edge(rng), edge(rng))
            };
            scenes::quad(c, u, v, "m")
        }
        3 => scenes::cuboid(c, corner(r), "m"),
        4 => {
            let (u, v) = (edge(rng), edge(rng));
            let add = |e: Triple| [c[0] + e[0], c[1] + e[1], c[2] + e[2]];
            scenes::triangle([c, add(u), add(v)], "m")
        }
        5 => {
            let (phi_max_deg, inner_radius) =
                if rng.below(2) == 0 { (360.0, 0.0) } else { (200.0, 0.3 * r) };
            let (height, radius, material) = (c[2], r, m());
            let transform = vec![TransformStep::Translate([c[0], c[1], 0.0])];
            ObjectDesc::Disk { height, radius, inner_radius, phi_max_deg, material, transform }
        }
        6 => {
            let phi_max_deg = if rng.below(2) == 0 { 360.0 } else { 100.0 };
            let transform = vec![TransformStep::Translate(c)];
            let (radius, z_min, z_max) = (r, -r, 2.0 * r);
            ObjectDesc::Cylinder { radius, z_min, z_max, phi_max_deg, material: m(), transform }
        }
        7 => {
            let mesh = ["tetrahedron", "grid"][rng.below(2) as usize].to_owned();
            let scale = TransformStep::Scale(ScaleDesc::Uniform(r));
            let transform = vec![scale, TransformStep::Translate(c)];
            let flip = rng.below(2) == 0;
            ObjectDesc::Mesh { mesh, material: m(), group_materials: Vec::new(), flip, transform }
        }
        8 => {
            let scale = TransformStep::Scale(ScaleDesc::Uniform(r));
            let transform = vec![scale, TransformStep::Translate(c)];
            let transform_end = (rng.below(2) == 0).then(|| {
                vec![
                    scale,
                    TransformStep::RotateZDeg(30.0),
                    TransformStep::Translate(rng.point(size)),
                ]
            });
            ObjectDesc::Instance { prototype: "pair".to_owned(), transform, transform_end }
        }
        9 => {
            let mesh = "patches".to_owned();
            let scale = TransformStep::Scale(ScaleDesc::Uniform(r));
            let transform = vec![scale, TransformStep::Translate(c)];
            let flip = rng.below(2) == 0;
            ObjectDesc::Mesh { mesh, material: m(), group_materials: Vec::new(), flip, transform }
        }
        10 => {
            let form =
                [CurveForm::Flat, CurveForm::Cylinder, CurveForm::Ribbon][rng.below(3) as usize];
            let n_segments = 1 + rng.below(2) as usize;
            let points = (0..3 * n_segments + 1)
                .map(|_| {
                    let p = rng.point(3.0 * r);
                    [c[0] + p[0], c[1] + p[1], c[2] + p[2]]
                })
                .collect();
            let n_normals = if form == CurveForm::Ribbon { n_segments + 1 } else { 0 };
            let normals = (0..n_normals).map(|_| edge(rng)).collect();
            let widths = [r, rng.range(0.0, 0.5) * r];
            let (material, transform) = (m(), Vec::new());
            ObjectDesc::Curve { points, widths, form, normals, material, transform }
        }
        11 => ObjectDesc::Sphere {
            center: c,
            center_end: (rng.below(3) == 0).then(|| rng.point(size)),
            radius: r,
            z_min: (rng.below(2) == 0).then_some(-0.3 * r),
            z_max: Some(0.6 * r),
            phi_max_deg: (rng.below(2) == 0).then_some(250.0),
            material: m(),
            transform: Vec::new(),
        },
        12 => scenes::medium(scenes::in_sphere(c, r), 1.0 / r, "mist"),
        _ => scenes::medium(scenes::in_box(c, corner(r)), 3.0 / r, "mist"),
    };
    match rng.below(4) {
        0 => {
            let axis = [0.3, 1.0, -0.5];
            let steps = vec![
                TransformStep::Rotate { axis, angle_deg: rng.range(0.0, 360.0) },
                TransformStep::Scale(ScaleDesc::PerAxis([1.0, 0.5, -0.7])),
            ];
            scenes::group(vec![object], steps)
        }
        _ => object,
    }
}

fn random_scene(rng: &mut Rng, n: u32, size: f64) -> Option<std::sync::Arc<SceneArena>> {
    let mut desc = scenes::scene([4, 4], 1.0);
    desc.materials.insert("m".to_owned(), scenes::lambertian(0.5));
    desc.materials.insert("mist".to_owned(), scenes::isotropic(0.5));
    let (tetrahedron, grid) = meshes();
    desc.meshes.insert("patches".to_owned(), patches());
    desc.meshes.insert("tetrahedron".to_owned(), tetrahedron);
    desc.meshes.insert("grid".to_owned(), grid);
    desc.prototypes.insert(
        "pair".to_owned(),
        vec![
            scenes::sphere([0.0; 3], 1.0, "m"),
            ObjectDesc::Mesh {
                mesh: "grid".to_owned(),
                material: "m".to_owned(),
                group_materials: Vec::new(),
                flip: false,
                transform: vec![TransformStep::RotateXDeg(40.0)],
            },
            scenes::cuboid([0.5, -1.0, -1.0], [1.5, 1.0, 1.0], "m"),
        ],
    );
    while (desc.objects.len() as u32) < n {
        let object = random_object(rng, size);
        // Now and then the same once more: ties.
        for _ in 0..1 + u32::from(rng.below(6) == 0) {
            desc.objects.push(object.clone());
        }
    }
    // A scene with a degenerate shape is not one.
    zrak_scene::validate::validate(&desc).is_empty().then(|| common::arena(&desc))
}

/// A closed mesh, and one of enough triangles to be shared.
fn meshes() -> (MeshDesc, MeshDesc) {
    let mesh = |positions, triangles| MeshDesc::Inline {
        positions,
        triangles,
        normals: Vec::new(),
        uvs: Vec::new(),
        colors: Vec::new(),
    };
    let corners = vec![[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    let tetrahedron = mesh(corners, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
    let n = 8_u32;
    let point = |i: u32| {
        let (x, y) = (i % (n + 1), i / (n + 1));
        [x as f32 / 4.0 - 1.0, y as f32 / 4.0 - 1.0, ((x * y) % 3) as f32 * 0.1]
    };
    let cell = |i: u32| {
        let a = i % n + i / n * (n + 1);
        [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]
    };
    let positions = (0..(n + 1) * (n + 1)).map(point).collect();
    (tetrahedron, mesh(positions, (0..n * n).flat_map(cell).collect()))
}

/// Patches that share edges; one is flat and becomes a quad, one has two corners in one place.
fn patches() -> MeshDesc {
    MeshDesc::Patches {
        positions: vec![
            [0.0, 1.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.5, -0.5, 1.0],
            [-1.0, 0.0, 0.5],
            [-1.0, -1.0, 1.5],
        ],
        patches: vec![[0, 1, 2, 3], [0, 2, 4, 5], [4, 0, 5, 2], [0, 1, 4, 4]],
        normals: Vec::new(),
        uvs: Vec::new(),
    }
}

fn leaves(view: &SceneView) -> Vec<PrimRef> {
    let mut leaves = Vec::new();
    let mut links = vec![PrimRef::new(PrimKind::Node, 0)];
    while let Some(link) = links.pop() {
        if link.is_node() {
            let children = view.nodes2.get(link.index()).children;
            links.extend(children.into_iter().filter(|child| *child != PrimRef::NONE));
        } else {
            leaves.push(link);
        }
    }
    leaves
}

#[test]
fn all_ways_find_the_same_hit() {
    let mut rng = Rng(1);
    let (mut n_hits, mut n_rays, mut n_scenes) = (0, 0, 0);
    let mut kinds = [0; 14];
    let mut n_in_instances = 0;
    while n_scenes < 300 {
        let n = [1, 2, 3, 8, 30, 150][rng.below(6) as usize];
        let size = [1e-3, 1.0, 1e4][rng.below(3) as usize];
        let Some(arena) = random_scene(&mut rng, n, size) else { continue };
        n_scenes += 1;
        let view = arena.view();
        let mut prims = leaves(&view);
        let brute = |prims: &[PrimRef], ray: &Ray, sampler: &Sampler| {
            BruteForce { prims: Array::new(prims) }.closest_hit(&view, ray, sampler, f32::INFINITY)
        };
        let (bvh2, bvh8) = (Bvh2 { nodes: view.nodes2 }, Bvh8 { nodes: view.nodes8 });
        let mut origin = Vec3::ZERO;
        for i in 0..1500_u32 {
            // From anywhere, from far away, or from where the ray before hit.
            if i % 3 != 0 {
                let far = if i % 3 == 1 { 1.5 } else { 50.0 };
                let [x, y, z] = rng.point(far * size).map(|x| x as f32);
                origin = vec3(x, y, z);
            }
            let d = if i % 4 == 0 {
                let [x, y, z] = rng.point(size).map(|x| x as f32);
                let to = vec3(x, y, z) - origin;
                if to.length() > 1e-6 * size as f32 { to.normalized() } else { rng.direction() }
            } else {
                rng.direction()
            };
            let ray = Ray { o: origin, d, time: unit_f32(rng.bits()) };
            let mut sampler = Sampler::new(9, i, n_scenes, 0);
            (0..i % 5).for_each(|_| sampler.next_bounce());
            let expected = brute(&prims, &ray, &sampler);
            // In any order.
            prims.reverse();
            assert_eq!(brute(&prims, &ray, &sampler), expected, "{ray:?}");
            for hit in [
                bvh2.closest_hit(&view, &ray, &sampler, f32::INFINITY),
                bvh8.closest_hit(&view, &ray, &sampler, f32::INFINITY),
            ] {
                let bits = |hit: Option<zrak_core::interaction::Hit>| {
                    hit.map(|hit| (hit.t.to_bits(), hit.prim, hit.instance))
                };
                assert_eq!(bits(hit), bits(expected), "{ray:?}");
            }
            n_rays += 1;
            if let Some(hit) = expected {
                n_hits += 1;
                kinds[hit.prim.kind().unwrap() as usize] += 1;
                n_in_instances += u32::from(hit.instance != NO_INSTANCE);
                origin = if hit.prim.kind() == Some(PrimKind::Medium) {
                    ray.at(hit.t)
                } else {
                    let s = surface_interaction(&view, &hit, &ray);
                    s.spawn(rng.direction(), 0.0).o
                };
            }
        }
    }
    assert!(n_hits * 12 > n_rays, "{n_hits} hits of {n_rays} rays");
    // Every kind of primitive was hit.
    let hittable = |kind: usize| kind != PrimKind::Instance as usize;
    assert!((1..14).filter(|&k| hittable(k)).all(|k| kinds[k] > 400), "{kinds:?}");
    assert!(n_in_instances > 10_000, "{n_in_instances}");
}
