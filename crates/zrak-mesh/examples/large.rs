//! Writes scenes of any size, for `docs/benchmarks`: a bumpy ball of so many triangles, or so many
//! instances of one, in the chosen folder.
//!
//! ```sh
//! cargo run --release -p zrak-mesh --example large -- mesh 50000000 /tmp/large
//! cargo run --release -p zrak-mesh --example large -- instances 10000 1000000 /tmp/large
//! ```

use std::f64::consts::PI;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

const SCENE: &str = r#"format = 1
name = "large"

[camera]
look_from = [2.2, 1.4, 2.6]
look_at = [0.0, 0.0, 0.0]
vfov_deg = 35.0
width = 640
height = 360

[render]
samples_per_pixel = 4
max_depth = 8

[background]
kind = "gradient"
bottom = [0.3, 0.3, 0.3]
top = [0.9, 0.95, 1.0]

[materials.clay]
kind = "lambertian"
color = [0.6, 0.4, 0.3]

[meshes.ball]
kind = "file"
path = "ball.ply"

[[objects]]
kind = "mesh"
mesh = "ball"
material = "clay"
"#;

fn main() -> io::Result<()> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    let number = |text: &str| text.parse().map_err(io::Error::other);
    match args[..] {
        ["mesh", n, folder] => {
            std::fs::create_dir_all(folder)?;
            ball(number(n)?, &Path::new(folder).join("ball.ply"))?;
            std::fs::write(Path::new(folder).join("large.toml"), SCENE)
        }
        ["instances", n, n_instances, folder] => {
            std::fs::create_dir_all(folder)?;
            ball(number(n)?, &Path::new(folder).join("ball.ply"))?;
            instances(number(n_instances)?, &Path::new(folder).join("large.pbrt"))
        }
        _ => Err(io::Error::other("arguments: mesh N FOLDER, or instances N COUNT FOLDER")),
    }
}

/// Writes a ball of at least `n` triangles.
fn ball(n: u64, path: &Path) -> io::Result<()> {
    let rows = ((n as f64 / 4.0).sqrt().ceil() as u64).max(2);
    let columns = n.div_ceil(2 * rows).max(3);
    let mut out = BufWriter::with_capacity(1 << 20, File::create(path)?);
    writeln!(out, "ply\nformat binary_little_endian 1.0")?;
    writeln!(out, "element vertex {}", (rows + 1) * columns)?;
    writeln!(out, "property float x\nproperty float y\nproperty float z")?;
    writeln!(out, "element face {}", 2 * rows * columns)?;
    writeln!(out, "property list uchar int vertex_indices\nend_header")?;
    for i in 0..=rows {
        // Not quite to the poles, where triangles would have no area.
        let theta = PI * (i as f64 + 0.01) / (rows as f64 + 0.02);
        for j in 0..columns {
            let phi = 2.0 * PI * j as f64 / columns as f64;
            let wave = (9.0 * theta).sin() * (12.0 * phi).cos();
            let fine = (400.0 * theta).sin() * (400.0 * phi).sin();
            let r = 1.0 + 0.05 * wave + 0.002 * fine;
            let p = [theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin()];
            for x in p {
                out.write_all(&((r * x) as f32).to_le_bytes())?;
            }
        }
    }
    for i in 0..rows {
        for j in 0..columns {
            let at = |i: u64, j: u64| (i * columns + j % columns) as u32;
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            for triangle in [[a, b, c], [a, c, d]] {
                out.write_all(&[3])?;
                for v in triangle {
                    out.write_all(&v.to_le_bytes())?;
                }
            }
        }
    }
    out.flush()
}

/// Writes instances of the ball on a square grid, each turned and scaled.
fn instances(n: u64, path: &Path) -> io::Result<()> {
    let mut out = BufWriter::with_capacity(1 << 20, File::create(path)?);
    let side = (n as f64).sqrt().ceil() as u64;
    let far = side as f64;
    writeln!(out, "LookAt {} {} {} 0 0 0 0 1 0", far * 0.3, far * 0.15, far * 0.6)?;
    writeln!(out, "Camera \"perspective\" \"float fov\" 35")?;
    writeln!(out, "Film \"rgb\" \"integer xresolution\" 640 \"integer yresolution\" 360")?;
    writeln!(out, "Sampler \"independent\" \"integer pixelsamples\" 4\nWorldBegin")?;
    writeln!(out, "LightSource \"infinite\" \"rgb L\" [0.8 0.9 1]")?;
    writeln!(out, "Material \"diffuse\" \"rgb reflectance\" [0.6 0.4 0.3]")?;
    writeln!(out, "ObjectBegin \"ball\"\nShape \"plymesh\" \"string filename\" \"ball.ply\"")?;
    writeln!(out, "ObjectEnd")?;
    for i in 0..n {
        let (x, z) = ((i % side) as f64 - far / 2.0, (i / side) as f64 - far / 2.0);
        let s = 0.2 + 0.2 * ((i * 7919) % 101) as f64 / 101.0;
        let (sin, cos) = ((i % 360) as f64).to_radians().sin_cos();
        let (a, b) = (s * cos, s * sin);
        writeln!(
            out,
            "Transform [{a:.6} 0 {b:.6} 0 0 {s:.6} 0 0 {:.6} 0 {a:.6} 0 {x} 0 {z} 1]\nObjectInstance \"ball\"",
            -b
        )?;
    }
    out.flush()
}
