//! Triangles of meshes: what is interpolated over them, and that closed meshes have no holes.

use super::super::{MESH_COLORS, MESH_NORMALS, MESH_TANGENTS, MESH_UVS, Mesh, MeshTriangle};
use super::check_interaction;
use crate::math::{Affine, Color};
use crate::ray::Ray;
use crate::scene::PrimKind;
use crate::testing::{
    ANY_MATERIAL, D3, Rng, TestScene, add, cross, dot, double, hit_of, length, prim, ray_to,
    scaled, single, sub, unit,
};

/// A mesh of one triangle with everything, and its attributes; the second is at other offsets.
fn scene(rng: &mut Rng, flags: u32) -> TestScene {
    let mut scene = TestScene::default();
    // Vertices and attributes of something else come first, so that offsets matter.
    scene.positions.extend((0..5).map(|_| rng.in_cube(1.0)));
    scene.normals.extend((0..2).map(|_| rng.direction()));
    scene.uvs.extend([[9.0, 9.0]; 3]);
    scene.tangents.extend([[0.0, 1.0, 0.0, 1.0]; 7]);
    scene.colors.extend([[7.0; 4]; 4]);
    let n = unit([0.1, 0.2, 1.0]);
    let bent = |rng: &mut Rng| single(unit(add(n, scaled(double(rng.direction()), 0.5))));
    for corner in [[0.0, 0.0, 0.0], [2.0, 0.3, 0.1], [-0.2, 1.7, 0.4]] {
        scene.positions.push(single(corner));
        scene.normals.push(bent(rng));
        scene.uvs.push([rng.unit_f32(), rng.unit_f32()]);
        let t = bent(rng).to_array();
        scene.tangents.push([t[1], t[2], t[0], 1.0]);
        scene.colors.push([(); 4].map(|()| rng.unit_f32()));
    }
    scene.meshes.push(Mesh {
        material: ANY_MATERIAL,
        flags,
        normal_offset: 2_u32.wrapping_sub(5),
        uv_offset: 3_u32.wrapping_sub(5),
        tangent_offset: 7 - 5,
        color_offset: 4_u32.wrapping_sub(5),
        _pad: [0; 2],
    });
    scene.mesh_triangles.push(MeshTriangle { vertices: [5, 6, 7], mesh: 0 });
    scene
}

#[test]
fn attributes_are_blended_by_the_place() {
    let mut rng = Rng::new(1);
    for _ in 0..3000 {
        let all = MESH_NORMALS | MESH_UVS | MESH_TANGENTS | MESH_COLORS;
        let flags = rng.below(all + 1);
        let scene = scene(&mut rng, flags);
        let view = scene.view();
        let w1 = rng.range(0.01, 0.98);
        let w2 = rng.range(0.005, 0.99 - w1);
        let w = [1.0 - w1 - w2, w1, w2];
        let blend = |values: [D3; 3]| -> D3 {
            [0, 1, 2].map(|i| (0..3).map(|k| w[k] * values[k][i]).sum())
        };
        let at = |k: usize| double(scene.positions[5 + k]);
        let p = blend([at(0), at(1), at(2)]);
        let o = single(add(p, scaled(double(rng.direction()), 3.0)));
        let ray = ray_to(o, single(p));
        let n = unit(cross(sub(at(1), at(0)), sub(at(2), at(0))));
        if dot(n, double(ray.d)).abs() < 0.1 {
            continue;
        }
        let s = scene.mesh_triangles[0].interaction(&view, &ray);
        check_interaction(&s);
        let near = |a: D3, b: D3, what: &str| {
            assert!(length(sub(a, b)) < 2e-5 * (1.0 + length(b)), "{what}: {a:?} {b:?}");
        };
        near(double(s.p), p, "point");
        let mut ns = n;
        if flags & MESH_NORMALS != 0 {
            let at = |k: usize| double(scene.normals[2 + k]);
            ns = unit(blend([at(0), at(1), at(2)]));
        }
        near(double(s.ns), ns, "shading normal");
        near(double(s.n), scaled(n, dot(n, ns).signum()), "normal");
        let uv = |k: usize| -> [f64; 2] {
            let default = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]][k];
            if flags & MESH_UVS != 0 { scene.uvs[3 + k].map(f64::from) } else { default }
        };
        let flat = |k: usize| [uv(k)[0], uv(k)[1], 0.0];
        let expected = blend([flat(0), flat(1), flat(2)]);
        near([f64::from(s.uv[0]), f64::from(s.uv[1]), 0.0], expected, "uv");
        // A step in u and v along an edge is the step along the edge.
        if flags & MESH_TANGENTS == 0 {
            let area = cross(sub(flat(1), flat(0)), sub(flat(2), flat(0)))[2];
            for k in [1, 2] {
                let [du, dv] = [0, 1].map(|i| uv(k)[i] - uv(0)[i]);
                let step = add(scaled(double(s.dpdu), du), scaled(double(s.dpdv), dv));
                let off = length(sub(step, sub(at(k), at(0))));
                assert!(off * area.abs() < 1e-5, "{off}: {s:?}");
            }
        } else {
            let at = |k: usize| {
                let [x, y, z, _] = scene.tangents[7 + k];
                [x, y, z].map(f64::from)
            };
            near(unit(double(s.dpdu)), unit(blend([at(0), at(1), at(2)])), "tangent");
        }
        if flags & MESH_COLORS != 0 {
            let at = |k: usize| {
                let [r, g, b, _] = scene.colors[4 + k];
                [r, g, b].map(f64::from)
            };
            near(s.color.to_array().map(f64::from), blend([at(0), at(1), at(2)]), "colour");
            let a = |k: usize| [f64::from(scene.colors[4 + k][3]), 0.0, 0.0];
            near([f64::from(s.alpha), 0.0, 0.0], blend([a(0), a(1), a(2)]), "alpha");
        } else {
            assert_eq!((s.color, s.alpha), (Color::WHITE, 1.0));
        }
    }
}

/// The surface of a lumpy ball: rings of vertices between two poles.
fn ball(rng: &mut Rng, rings: u32, sectors: u32) -> TestScene {
    let mut scene = TestScene::default();
    scene.positions.push(single([0.0, 0.0, 1.0]));
    for ring in 1..rings {
        let theta = std::f64::consts::PI * f64::from(ring) / f64::from(rings);
        for sector in 0..sectors {
            let phi = std::f64::consts::TAU * f64::from(sector) / f64::from(sectors);
            let r = rng.range(0.8, 1.2);
            let (s, c) = theta.sin_cos();
            scene.positions.push(single([r * s * phi.cos(), r * s * phi.sin(), r * c]));
        }
    }
    scene.positions.push(single([0.0, 0.0, -1.0]));
    let last = scene.positions.len() as u32 - 1;
    let at = |ring: u32, sector: u32| match ring {
        0 => 0,
        ring if ring == rings => last,
        ring => 1 + (ring - 1) * sectors + sector % sectors,
    };
    for ring in 0..rings {
        for sector in 0..sectors {
            let (a, b) = (at(ring, sector), at(ring, sector + 1));
            let (c, d) = (at(ring + 1, sector), at(ring + 1, sector + 1));
            for vertices in [[a, c, d], [a, d, b]] {
                if vertices[0] != vertices[1]
                    && vertices[1] != vertices[2]
                    && vertices[0] != vertices[2]
                {
                    scene.mesh_triangles.push(MeshTriangle { vertices, mesh: 0 });
                }
            }
        }
    }
    scene.meshes.push(Mesh {
        material: ANY_MATERIAL,
        flags: 0,
        normal_offset: 0,
        uv_offset: 0,
        tangent_offset: 0,
        color_offset: 0,
        _pad: [0; 2],
    });
    scene
}

/// Rays from inside at vertices, edges and anywhere, of the mesh as it is and as an instance that is
/// stretched, sheared or mirrored.
#[test]
fn meshes_and_instances_of_them_have_no_holes() {
    let mut rng = Rng::new(2);
    let mut n_rays = 0;
    for case in 0..24 {
        let mut scene = ball(&mut rng, 8, 12);
        let n = scene.mesh_triangles.len();
        // Under any map, with the origin at any distance.
        let far = [0.0, 1.0, 300.0][case % 3];
        let rows: [D3; 3] = [0, 1, 2].map(|i| {
            let mut row = scaled(double(rng.direction()), 0.3);
            row[i] += rng.range(0.5, 2.0) * if rng.chance(0.2) { -1.0 } else { 1.0 };
            row
        });
        let shift = double(rng.in_cube(far));
        let map = |p: D3| -> D3 { [0, 1, 2].map(|i| dot(rows[i], p) + shift[i]) };
        let across = [cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1])];
        let det = dot(rows[0], across[0]);
        let back = |p: D3| -> D3 {
            let p = sub(p, shift);
            [0, 1, 2].map(|i| (0..3).map(|k| across[k][i] * p[k]).sum::<f64>() / det)
        };
        let affine = |f: &dyn Fn(D3) -> D3| {
            let zero = f([0.0; 3]);
            let column = |k: usize| {
                let mut e = [0.0; 3];
                e[k] = 1.0;
                sub(f(e), zero)
            };
            let (x, y, z) = (column(0), column(1), column(2));
            let rows = [0, 1, 2].map(|i| [x[i], y[i], z[i], zero[i]].map(|x| x as f32));
            Affine { rows }
        };
        let triangles: Vec<_> = (0..n).map(|i| prim(PrimKind::MeshTriangle, i)).collect();
        let is_placed = case % 2 == 1;
        let prims: Vec<_> = if is_placed {
            let (there, home) = (affine(&map), affine(&back));
            triangles.iter().map(|&t| scene.place(t, there, home)).collect()
        } else {
            triangles
        };
        let view = scene.view();
        for _ in 0..1500 {
            let triangle = scene.mesh_triangles[rng.below(n as u32) as usize];
            let [a, b, c] = triangle.vertices.map(|v| double(scene.positions[v as usize]));
            let aim = match rng.below(3) {
                0 => a,
                1 => add(a, scaled(sub(b, a), rng.unit())),
                _ => scaled(add(add(a, b), c), 1.0 / 3.0),
            };
            let o = double(rng.in_cube(0.25));
            let (o, aim) = if is_placed { (map(o), map(aim)) } else { (o, aim) };
            let ray: Ray = ray_to(single(o), single(aim));
            n_rays += 1;
            assert!(
                prims.iter().any(|&p| hit_of(&view, p, &ray).is_some()),
                "a hole: far {far}, placed {is_placed}, {ray:?}"
            );
        }
    }
    assert_eq!(n_rays, 24 * 1500);
}
