//! Trees of textures as lists of operations over a few slots.

use zrak_core::math::{Affine, Color};
use zrak_core::scene::TextureKind;
use zrak_core::textures::{
    FRACTAL_FBM, FRACTAL_WINDY, FRACTAL_WRINKLED, Fractal, MAPPING_CYLINDRICAL, MAPPING_PLANAR,
    MAPPING_SPHERICAL, MAPPING_UV, N_SLOTS, NO_MAPPING, OP_CHECKER, OP_DOTS, OP_FRACTAL, OP_IMAGE,
    OP_LERP_U, OP_LERP_V, OP_MIX, OP_MULTIPLY, OP_NOISE, OP_SOLID, OP_UV_CHECKER, OP_VERTEX_COLOR,
    Program, TextureMapping, TextureOp,
};

use super::{LoweredInput, Role, Textures, color, noise, textured};
use crate::arena::SceneArrays;
use crate::desc::{
    ColorDesc, FractalPattern, ImageChannel, MappingDesc, ScalarDesc, TextureDesc, Triple,
};
use crate::lower::Transform;
use crate::validate::{KeyPath, Problem};

/// Most operations of a program: textures that share their parts may grow without bound.
const OPS_MAX: usize = 4096;

/// A texture whose parts are textures.
struct Expr {
    op: TextureOp,
    parts: Vec<Expr>,
    /// Slots that it takes to evaluate it.
    n_slots: usize,
}

/// What is known on the way down a tree.
#[derive(Clone, Copy)]
struct Place<'a> {
    /// Name of the texture, for what is said about it.
    name: &'a str,
    role: Role,
    /// From the world to where the texture is.
    space: Transform,
}

impl<'a> Textures<'a> {
    /// Makes a program of the texture of this name.
    pub(super) fn program(
        &mut self,
        arrays: &mut SceneArrays,
        name: &'a str,
        role: Role,
    ) -> LoweredInput {
        let mut builder = Builder { textures: self, arrays, needs_uv: false, n_ops: 0 };
        let place = Place { name, role, space: Transform::IDENTITY };
        let expr = builder.texture(place);
        let Builder { needs_uv, n_ops, .. } = builder;
        if n_ops > OPS_MAX || expr.n_slots > N_SLOTS {
            let message = format!("texture `{name}` is made of too many textures");
            let help = format!(
                "at most {OPS_MAX}, and such that no more than {N_SLOTS} have to be kept at a time"
            );
            let path = KeyPath::default().join("textures").join(name);
            self.problems.push(Problem { path, message, help: Some(help) });
            return super::solid([0.0; 3]);
        }
        let first_op = arrays.texture_ops.len() as u32;
        emit(&expr, 0, &mut arrays.texture_ops);
        arrays
            .programs
            .push(Program { first_op, n_ops: arrays.texture_ops.len() as u32 - first_op });
        textured(TextureKind::Program, arrays.programs.len() - 1, needs_uv)
    }
}

struct Builder<'a, 'b> {
    textures: &'b mut Textures<'a>,
    arrays: &'b mut SceneArrays,
    needs_uv: bool,
    n_ops: usize,
}

impl<'a> Builder<'a, '_> {
    fn texture(&mut self, place: Place<'a>) -> Expr {
        let desc: &'a TextureDesc = &self.textures.desc.textures[place.name];
        match desc {
            TextureDesc::Solid { color } => self.solid(*color),
            TextureDesc::Noise { .. } => {
                let index = noise(self.arrays, desc);
                let mapping = self.space(&place);
                self.leaf(TextureOp { index, mapping, ..operation(OP_NOISE) })
            }
            TextureDesc::Fractal { scale, pattern, octaves, roughness, seed, low, high } => {
                self.arrays.fractals.push(Fractal {
                    low: color(*low),
                    scale: *scale as f32,
                    high: color(*high),
                    pattern: match pattern {
                        FractalPattern::Fbm => FRACTAL_FBM,
                        FractalPattern::Wrinkled => FRACTAL_WRINKLED,
                        FractalPattern::Windy => FRACTAL_WINDY,
                    },
                    octaves: *octaves,
                    seed: *seed,
                    roughness: *roughness as f32,
                    _pad: 0,
                });
                let index = self.arrays.fractals.len() as u32 - 1;
                let mapping = self.space(&place);
                self.leaf(TextureOp { index, mapping, ..operation(OP_FRACTAL) })
            }
            TextureDesc::VertexColor { channel } => {
                self.needs_uv = true;
                let index = match channel {
                    ImageChannel::Color => 0,
                    ImageChannel::R => 1,
                    ImageChannel::G => 2,
                    ImageChannel::B => 3,
                    ImageChannel::A => 4,
                };
                self.leaf(TextureOp { index, ..operation(OP_VERTEX_COLOR) })
            }
            TextureDesc::Image { mapping, .. } => {
                let mapping = self.mapping(mapping, &place);
                let index =
                    self.textures.image_map(self.arrays, place.name, desc, place.role, mapping);
                self.leaf(TextureOp { index, ..operation(OP_IMAGE) })
            }
            TextureDesc::Checker { scale, even, odd } => {
                let mapping = self.space(&place);
                let value = (1.0 / scale) as f32;
                let op = TextureOp { mapping, value, ..operation(OP_CHECKER) };
                self.pair(op, even, odd, place)
            }
            TextureDesc::UvChecker { even, odd, mapping } => {
                let mapping = self.mapping(mapping, &place);
                self.pair(TextureOp { mapping, ..operation(OP_UV_CHECKER) }, even, odd, place)
            }
            TextureDesc::Dots { inside, outside, mapping } => {
                let mapping = self.mapping(mapping, &place);
                self.pair(TextureOp { mapping, ..operation(OP_DOTS) }, inside, outside, place)
            }
            TextureDesc::Bilerp { corners, mapping } => {
                let mapping = self.mapping(mapping, &place);
                let [low_u, high_u] =
                    [[corners[0], corners[1]], [corners[2], corners[3]]].map(|[low_v, high_v]| {
                        let parts = vec![self.solid(low_v), self.solid(high_v)];
                        self.inner(TextureOp { mapping, ..operation(OP_LERP_V) }, parts)
                    });
                self.inner(TextureOp { mapping, ..operation(OP_LERP_U) }, vec![low_u, high_u])
            }
            TextureDesc::Multiply { a, b } => self.pair(operation(OP_MULTIPLY), a, b, place),
            TextureDesc::Mix { a, b, amount } => {
                let parts = vec![
                    self.part(a, place),
                    self.part(b, place),
                    match amount {
                        ScalarDesc::Value(x) => self.solid([*x; 3]),
                        ScalarDesc::Texture(name) => {
                            self.texture(Place { name, role: Role::Scalar, ..place })
                        }
                    },
                ];
                self.inner(operation(OP_MIX), parts)
            }
            TextureDesc::Placed { texture, transform } => {
                // Validation has made sure that it can be undone.
                let inverse = Transform::of_steps(transform).inverse();
                let space = place.space.then(&inverse.unwrap_or(Transform::IDENTITY));
                self.part(texture, Place { space, ..place })
            }
        }
    }

    fn part(&mut self, desc: &'a ColorDesc, place: Place<'a>) -> Expr {
        match desc {
            ColorDesc::Solid(c) => self.solid(*c),
            // What is too long is not made longer: it is refused in the end.
            ColorDesc::Texture(_) if self.n_ops > OPS_MAX => self.solid([0.0; 3]),
            ColorDesc::Texture(name) => self.texture(Place { name, ..place }),
        }
    }

    fn pair(
        &mut self,
        op: TextureOp,
        a: &'a ColorDesc,
        b: &'a ColorDesc,
        place: Place<'a>,
    ) -> Expr {
        let parts = vec![self.part(a, place), self.part(b, place)];
        self.inner(op, parts)
    }

    fn solid(&mut self, c: Triple) -> Expr {
        self.leaf(TextureOp { color: color(c), ..operation(OP_SOLID) })
    }

    fn leaf(&mut self, op: TextureOp) -> Expr {
        self.inner(op, Vec::new())
    }

    fn inner(&mut self, op: TextureOp, parts: Vec<Expr>) -> Expr {
        self.n_ops += 1;
        let n_slots = order(&parts)
            .iter()
            .enumerate()
            .map(|(held, &i)| held + parts[i].n_slots)
            .fold(1, usize::max);
        Expr { op, parts, n_slots }
    }

    /// The map of a texture of space.
    fn space(&mut self, place: &Place<'a>) -> u32 {
        if place.space == Transform::IDENTITY {
            return NO_MAPPING;
        }
        self.add(MAPPING_PLANAR, place.space.rows)
    }

    fn mapping(&mut self, desc: &MappingDesc, place: &Place<'a>) -> u32 {
        let moved = |steps| place.space.then(&Transform::of_steps(steps)).rows;
        match desc {
            MappingDesc::Uv => {
                self.needs_uv = true;
                NO_MAPPING
            }
            MappingDesc::UvAffine { matrix: [u, v] } => {
                self.needs_uv = true;
                let row = |r: &[f64; 3]| [r[0], r[1], 0.0, r[2]];
                self.add(MAPPING_UV, [row(u), row(v), [0.0; 4]])
            }
            MappingDesc::Planar { matrix: [u, v] } => {
                let planar = Transform { rows: [*u, *v, [0.0; 4]] };
                self.add(MAPPING_PLANAR, place.space.then(&planar).rows)
            }
            MappingDesc::Spherical { transform } => self.add(MAPPING_SPHERICAL, moved(transform)),
            MappingDesc::Cylindrical { transform } => {
                self.add(MAPPING_CYLINDRICAL, moved(transform))
            }
        }
    }

    fn add(&mut self, kind: u32, rows: [[f64; 4]; 3]) -> u32 {
        let map = Affine { rows: rows.map(|row| row.map(|x| x as f32)) };
        self.arrays.mappings.push(TextureMapping { map, kind, _pad: [0; 3] });
        self.arrays.mappings.len() as u32 - 1
    }
}

fn operation(op: u32) -> TextureOp {
    TextureOp { op, slots: 0, index: 0, mapping: NO_MAPPING, color: Color::BLACK, value: 0.0 }
}

/// The order in which parts are evaluated: those that take many slots before those that take few, while
/// little has to be kept (Sethi and Ullman, *The Generation of Optimal Code for Arithmetic
/// Expressions*, 1970).
fn order(parts: &[Expr]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..parts.len()).collect();
    order.sort_by_key(|&i| std::cmp::Reverse(parts[i].n_slots));
    order
}

/// Writes the operations that leave an expression in slot `at` and use none below it.
fn emit(expr: &Expr, at: u32, ops: &mut Vec<TextureOp>) {
    let mut slots = at;
    for (slot, &i) in (at..).zip(&order(&expr.parts)) {
        emit(&expr.parts[i], slot, ops);
        slots |= slot << (4 * (i + 1));
    }
    ops.push(TextureOp { slots, ..expr.op });
}
