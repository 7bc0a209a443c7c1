//! Objects under transforms: the same hits, however they are lowered.

use zrak_core::accel::{Accel, Bvh8};
use zrak_core::interaction::SurfaceInteraction;
use zrak_core::math::{Vec3, vec3};
use zrak_core::ray::Ray;
use zrak_core::sampler::Sampler;
use zrak_core::shapes::surface_interaction;

use super::super::Transform;
use super::{Rng, arena, scene};
use crate::arena::SceneArena;
use crate::desc::{
    BoundaryDesc, ColorDesc, CurveForm, ImageFilter, LightSides, MaterialDesc, MeshDesc,
    ObjectDesc, ScaleDesc, TextureDesc, TransformStep, Triple,
};

fn sphere(center: Triple, radius: f64, transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Sphere {
        center,
        center_end: None,
        radius,
        z_min: None,
        z_max: None,
        phi_max_deg: None,
        material: "m".to_owned(),
        transform,
    }
}

fn cuboid(min: Triple, max: Triple, transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Box { min, max, material: "m".to_owned(), transform }
}

fn quad(corner: Triple, u: Triple, v: Triple, transform: Vec<TransformStep>) -> ObjectDesc {
    ObjectDesc::Quad { corner, u, v, material: "m".to_owned(), transform }
}

fn triangle(vertices: [Triple; 3], transform: Vec<TransformStep>) -> ObjectDesc {
    let uv = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
    ObjectDesc::Triangle { vertices, uv, material: "m".to_owned(), transform }
}

fn curve(form: CurveForm, transform: Vec<TransformStep>) -> ObjectDesc {
    let points = vec![[-0.9, -0.3, 0.0], [-0.3, 0.9, 0.2], [0.3, -0.5, -0.4], [0.9, 0.4, 0.1]];
    let normals = vec![[0.3, 0.2, 1.0], [0.0, -0.4, 1.0]];
    let normals = if form == CurveForm::Ribbon { normals } else { Vec::new() };
    let (widths, material) = ([0.4, 0.3], "m".to_owned());
    ObjectDesc::Curve { points, widths, form, normals, material, transform }
}

/// One that is bent, and a parallelogram.
fn patches() -> MeshDesc {
    MeshDesc::Patches {
        positions: vec![
            [-0.9, -0.8, 0.0],
            [0.9, -0.9, 0.5],
            [-0.8, 0.9, 0.6],
            [0.7, 0.8, -0.2],
            [0.9, 0.1, -1.1],
            [0.7, 1.8, -1.8],
        ],
        patches: vec![[0, 1, 2, 3], [1, 4, 3, 5]],
        normals: Vec::new(),
        uvs: Vec::new(),
    }
}

fn hit(arena: &SceneArena, ray: &Ray) -> Option<SurfaceInteraction> {
    let view = arena.view();
    let sampler = Sampler::new(0, 0, 0, 0);
    let hit = Bvh8 { nodes: view.nodes8 }.closest_hit(&view, ray, &sampler, f32::INFINITY)?;
    Some(surface_interaction(&view, &hit, ray))
}

fn single(v: Triple) -> Vec3 {
    Vec3::from_array(v.map(|x| x as f32))
}

fn distance(a: Vec3, b: Vec3) -> f32 {
    (a - b).length()
}

fn ray_to(o: Triple, p: Triple) -> Ray {
    Ray { o: single(o), d: (single(p) - single(o)).normalized(), time: 0.0 }
}

/// Number of instances that objects become.
fn n_instances(objects: Vec<ObjectDesc>) -> u32 {
    arena(&scene(objects)).view().instances.len()
}

#[test]
fn only_what_must_be_is_an_instance() {
    let turn = vec![TransformStep::RotateYDeg(30.0)];
    let stretch = vec![TransformStep::Scale(ScaleDesc::PerAxis([1.0, 2.0, 1.0]))];
    let shift = vec![TransformStep::Translate([1.0, 2.0, 3.0])];
    assert_eq!(n_instances(vec![sphere([0.0; 3], 1.0, turn.clone())]), 0);
    assert_eq!(n_instances(vec![sphere([0.0; 3], 1.0, stretch.clone())]), 1);
    assert_eq!(n_instances(vec![cuboid([0.0; 3], [1.0; 3], stretch.clone())]), 0);
    assert_eq!(n_instances(vec![cuboid([0.0; 3], [1.0; 3], shift)]), 0);
    assert_eq!(n_instances(vec![cuboid([0.0; 3], [1.0; 3], turn.clone())]), 1);
    let [x, y] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    assert_eq!(n_instances(vec![quad([0.0; 3], x, y, stretch.clone())]), 0);
    assert_eq!(n_instances(vec![triangle([[0.0; 3], x, y], turn)]), 0);
}

fn random_steps(rng: &mut Rng) -> Vec<TransformStep> {
    let mut steps = vec![
        TransformStep::Scale(ScaleDesc::PerAxis([
            rng.range(0.5, 2.0),
            rng.range(0.5, 2.0) * if rng.range(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 },
            rng.range(0.5, 2.0),
        ])),
        TransformStep::Rotate { axis: rng.triple(1.0), angle_deg: rng.range(0.0, 360.0) },
        TransformStep::Translate(rng.triple(3.0)),
    ];
    if rng.range(0.0, 1.0) < 0.3 {
        steps[0] = TransformStep::Scale(ScaleDesc::Uniform(rng.range(0.5, 2.0)));
    }
    steps
}

/// A ray at a transformed object hits where the image of the object's own hit is, with the image of
/// its normal, at the same texture coordinates.
#[test]
fn hits_move_with_their_objects() {
    let mut rng = Rng(1);
    let mut n_hits = 0;
    for _ in 0..400 {
        let steps = random_steps(&mut rng);
        let map = Transform::of_steps(&steps);
        let back = map.inverse().unwrap();
        let objects: [&dyn Fn(Vec<TransformStep>) -> ObjectDesc; 9] = [
            &|steps| sphere([0.1, 0.2, 0.3], 0.9, steps),
            &|steps| cuboid([-0.5, -0.6, -0.7], [0.8, 0.7, 0.6], steps),
            &|steps| quad([-0.8, -0.7, 0.1], [1.5, 0.1, 0.2], [0.2, 1.6, -0.3], steps),
            &|steps| triangle([[-0.9, -0.8, 0.0], [0.9, -0.7, 0.3], [0.0, 0.9, -0.2]], steps),
            &|steps| ObjectDesc::Sphere {
                center: [0.1, 0.2, 0.3],
                center_end: None,
                radius: 0.9,
                z_min: Some(-0.7),
                z_max: Some(0.5),
                phi_max_deg: Some(300.0),
                material: "m".to_owned(),
                transform: steps,
            },
            &|steps| curve(CurveForm::Flat, steps),
            &|steps| curve(CurveForm::Cylinder, steps),
            &|steps| curve(CurveForm::Ribbon, steps),
            &|steps| ObjectDesc::Mesh {
                mesh: "patches".to_owned(),
                material: "m".to_owned(),
                group_materials: Vec::new(),
                flip: false,
                transform: steps,
            },
        ];
        let scene = |objects| {
            let mut desc = scene(objects);
            desc.meshes.insert("patches".to_owned(), patches());
            desc
        };
        for object in objects {
            let plain = arena(&scene(vec![object(Vec::new())]));
            let moved = arena(&scene(vec![object(steps.clone())]));
            // The same steps given to a group around it.
            let inner = steps[..1].to_vec();
            let outer = steps[1..].to_vec();
            let group = ObjectDesc::Group { objects: vec![object(inner)], transform: outer };
            let grouped = arena(&scene(vec![group]));
            for _ in 0..20 {
                let (o, p) = (rng.triple(4.0), rng.triple(0.7));
                let Some(here) = hit(&plain, &ray_to(o, p)) else { continue };
                let ray = ray_to(map.point(o), map.point(p));
                // Grazing hits may be lost to rounding.
                let n = here.n.to_array().map(f64::from);
                let cos = {
                    let d = ray_to(o, p).d.to_array().map(f64::from);
                    (n[0] * d[0] + n[1] * d[1] + n[2] * d[2]).abs()
                };
                if cos < 0.05 {
                    continue;
                }
                let Some(there) = hit(&moved, &ray) else { panic!("lost: {steps:?} {ray:?}") };
                let expected = single(map.point(here.p.to_array().map(f64::from)));
                let near_edge = distance(there.p, expected) > 1e-4;
                assert!(!near_edge, "{:?} {expected:?}", there.p);
                n_hits += 1;
                let same = hit(&grouped, &ray).unwrap();
                assert!(distance(same.p, there.p) < 1e-4 && distance(same.n, there.n) < 1e-3);
                // Normals by the inverse transposed; of flat shapes to the image of their own side.
                let m = back.rows;
                let normal: Triple = std::array::from_fn(|j| (0..3).map(|k| m[k][j] * n[k]).sum());
                let normal = single(normal).normalized();
                assert!(distance(there.n, normal) < 1e-3, "{:?} {normal:?} {steps:?}", there.n);
                if !matches!(object(Vec::new()), ObjectDesc::Sphere { .. }) {
                    let uv = there.uv.iter().zip(here.uv).all(|(a, b)| (a - b).abs() < 1e-3);
                    assert!(uv, "{:?} {:?} {steps:?}", there.uv, here.uv);
                }
            }
        }
    }
    assert!(n_hits > 10_000, "{n_hits}");
}

/// A textured sphere turns with its texture; a plain one needs no instance for that.
#[test]
fn textures_turn_with_their_spheres() {
    let textured = |steps: Vec<TransformStep>| {
        let mut desc = scene(vec![sphere([0.0; 3], 1.0, steps)]);
        let path = "builtin:earth.png".to_owned();
        let filter = ImageFilter::Nearest;
        desc.textures.insert("earth".to_owned(), TextureDesc::image(path, filter));
        let color = ColorDesc::Texture("earth".to_owned());
        desc.materials.insert("m".to_owned(), MaterialDesc::Lambertian { color });
        arena(&desc)
    };
    let steps = vec![TransformStep::Rotate { axis: [1.0, 2.0, 3.0], angle_deg: 70.0 }];
    let map = Transform::of_steps(&steps);
    let (plain, turned) = (textured(Vec::new()), textured(steps));
    assert_eq!((plain.view().instances.len(), turned.view().instances.len()), (0, 1));
    let mut rng = Rng(2);
    for _ in 0..500 {
        let o = rng.triple(3.0);
        if o.iter().map(|x| x * x).sum::<f64>() < 1.5 {
            continue;
        }
        let here = hit(&plain, &ray_to(o, [0.0; 3])).unwrap();
        let there = hit(&turned, &ray_to(map.point(o), [0.0; 3])).unwrap();
        let du = (here.uv[0] - there.uv[0]).abs();
        assert!(du.min(1.0 - du) < 1e-3 || here.uv[1] < 0.05 || here.uv[1] > 0.95);
        assert!((here.uv[1] - there.uv[1]).abs() < 1e-4);
    }
    // Moving keeps the axes of the texture: no instance.
    let moved = textured(vec![TransformStep::Translate([1.0, 0.0, 0.0])]);
    assert_eq!(moved.view().instances.len(), 0);
}

/// What shines up still shines up when mirrored left to right, and shines down when mirrored upside down.
#[test]
fn mirrored_lights_shine_from_the_image_of_their_side() {
    let flat: [fn(Vec<TransformStep>) -> ObjectDesc; 2] = [
        |steps| quad([-1.0, 0.0, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0], steps),
        |steps| triangle([[-2.0, 0.0, 2.0], [2.0, 0.0, 2.0], [0.0, 0.0, -3.0]], steps),
    ];
    for object in flat {
        for (factors, up) in [
            ([1.0, 1.0, 1.0], true),
            ([-1.0, 1.0, 1.0], true),
            ([1.0, 1.0, -1.0], true),
            ([-1.0, 1.0, -1.0], true),
            ([1.0, -1.0, 1.0], false),
            ([-1.0, -1.0, -1.0], false),
        ] {
            let steps = vec![TransformStep::Scale(ScaleDesc::PerAxis(factors))];
            let mut desc = scene(vec![object(steps)]);
            let color = ColorDesc::Solid([3.0; 3]);
            let light = MaterialDesc::DiffuseLight { color, sides: LightSides::Front };
            desc.materials.insert("m".to_owned(), light);
            let arena = arena(&desc);
            let view = arena.view();
            for side in [1.0_f32, -1.0] {
                let o = vec3(0.1, side * 2.0, 0.1);
                let ray = Ray { o, d: vec3(0.0, -side, 0.0), time: 0.0 };
                let surface = hit(&arena, &ray).unwrap();
                let sampler = Sampler::new(0, 0, 0, 0);
                let response = zrak_core::materials::respond(&view, &surface, ray.d, &sampler);
                let shines = response.emitted.r == 3.0;
                assert_eq!(shines, (side > 0.0) == up, "{factors:?}");
            }
        }
    }
}

#[test]
fn media_take_transforms_of_boundary_and_object() {
    let boundary = BoundaryDesc::Box {
        min: [-1.0; 3],
        max: [1.0; 3],
        transform: vec![TransformStep::RotateYDeg(45.0)],
    };
    let medium = ObjectDesc::Medium {
        boundary,
        density: 1e6,
        material: "mist".to_owned(),
        transform: vec![TransformStep::Translate([10.0, 0.0, 0.0])],
    };
    let arena = arena(&scene(vec![medium]));
    let view = arena.view();
    assert_eq!((view.media.len(), view.placements.len()), (1, 1));
    assert_eq!(view.media.get(0).neg_mean_free_path, -1e-6);
    // So dense that it is hit at its rim: an edge at 10 - sqrt(2).
    let ray = Ray { o: Vec3::ZERO, d: vec3(1.0, 0.0, 0.0), time: 0.0 };
    let sampler = Sampler::new(0, 0, 0, 3);
    let hit =
        Bvh8 { nodes: view.nodes8 }.closest_hit(&view, &ray, &sampler, f32::INFINITY).unwrap();
    assert!((hit.t - (10.0 - 2.0_f32.sqrt())).abs() < 1e-3, "{hit:?}");
}

#[test]
fn moving_spheres_move_under_transforms() {
    let moving = |transform: Vec<TransformStep>| ObjectDesc::Sphere {
        center: [0.0; 3],
        center_end: Some([1.0, 0.0, 0.0]),
        radius: 0.5,
        z_min: None,
        z_max: None,
        phi_max_deg: None,
        material: "m".to_owned(),
        transform,
    };
    let steps =
        vec![TransformStep::Scale(ScaleDesc::Uniform(2.0)), TransformStep::RotateZDeg(90.0)];
    let arena = arena(&scene(vec![moving(steps)]));
    let sphere = arena.view().moving_spheres.get(0);
    assert_eq!(sphere.radius, 1.0);
    assert!(distance(sphere.displacement, vec3(0.0, 2.0, 0.0)) < 1e-6);
    let ray = Ray { o: vec3(-5.0, 2.0, 0.0), d: vec3(1.0, 0.0, 0.0), time: 1.0 };
    assert!((hit(&arena, &ray).unwrap().p.x + 1.0).abs() < 1e-5);
    assert!(hit(&arena, &Ray { time: 0.0, ..ray }).is_none());
}

#[test]
fn flat_patches_are_quads_and_others_are_not() {
    let corners = |last: [f32; 3]| vec![[0.0; 3], [1.0, 0.0, 0.5], [0.0, 2.0, 0.0], last];
    let flat = [1.0, 2.0, 0.5];
    let normals = vec![[0.0, 0.0, 1.0]; 4];
    let default_uvs = vec![[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    // Corners, normals, texture coordinates, and the numbers of quads and patches.
    let cases = [
        (corners(flat), Vec::new(), Vec::new(), [1, 0]),
        (corners(flat), Vec::new(), default_uvs, [1, 0]),
        (corners([1.0, 2.0, 0.501]), Vec::new(), Vec::new(), [0, 1]),
        (corners(flat), normals, Vec::new(), [0, 1]),
        (corners(flat), Vec::new(), vec![[0.5; 2]; 4], [0, 1]),
        // On a line: nothing.
        (vec![[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]], Vec::new(), Vec::new(), [0, 0]),
    ];
    for (positions, normals, uvs, expected) in cases {
        let mut desc = scene(vec![ObjectDesc::Mesh {
            mesh: "patches".to_owned(),
            material: "m".to_owned(),
            group_materials: Vec::new(),
            flip: false,
            transform: Vec::new(),
        }]);
        let mesh = MeshDesc::Patches { positions, patches: vec![[0, 1, 2, 3]], normals, uvs };
        desc.meshes.insert("patches".to_owned(), mesh);
        let arena = arena(&desc);
        let view = arena.view();
        assert_eq!([view.quads.len(), view.mesh_patches.len()], expected, "{desc:?}");
    }
}

/// Hairs under one map that the renderer cannot apply to them share an instance, and their parts join.
#[test]
fn curves_are_cut_where_it_pays() {
    let squash = vec![TransformStep::Scale(ScaleDesc::PerAxis([1.0, 2.0, 1.0]))];
    let turn = vec![TransformStep::RotateXDeg(30.0), TransformStep::Scale(ScaleDesc::Uniform(2.0))];
    let hairs = |steps: &Vec<TransformStep>| {
        (0..10).map(|_| curve(CurveForm::Ribbon, steps.clone())).collect::<Vec<_>>()
    };
    assert_eq!(n_instances(hairs(&squash)), 1);
    assert_eq!(n_instances(hairs(&turn)), 0);
    let arena = arena(&scene(hairs(&turn)));
    let view = arena.view();
    let n = view.curves.len() / 10;
    assert!((2..=8).contains(&n) && view.ribbons.len() == 1, "{n} {}", view.ribbons.len());
    for i in 1..n {
        let (a, b) = (view.curves.get(i - 1), view.curves.get(i));
        assert_eq!((a.points[3], a.widths[1], a.u[1]), (b.points[0], b.widths[0], b.u[0]));
    }
    let (first, last) = (view.curves.get(0), view.curves.get(n - 1));
    assert_eq!((first.u[0], last.u[1]), (0.0, 1.0));
    assert_eq!((first.widths[0], last.widths[1]), (0.8, 0.6));
    // Along an axis there is nothing to gain.
    let points = [0.0, 1.0, 2.0, 3.0].map(|x| [x, 0.0, 0.0]).to_vec();
    let straight = ObjectDesc::Curve {
        points,
        widths: [0.1; 2],
        form: CurveForm::Flat,
        normals: Vec::new(),
        material: "m".to_owned(),
        transform: Vec::new(),
    };
    let arena = self::arena(&scene(vec![straight]));
    assert_eq!((arena.view().curves.len(), arena.view().curves.get(0).n_halvings), (1, 0));
}
