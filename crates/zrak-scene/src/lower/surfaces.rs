//! Materials.

mod principled;

use std::collections::HashMap;

use zrak_core::materials::{
    BASE_DIFFUSE, BASE_METAL, Conductor, Dielectric, DiffuseLight, DiffuseTransmission,
    FRESNEL_EXACT, FRESNEL_SCHLICK, Isotropic, Lambertian, Layered, METAL_INDEX, METAL_REFLECTANCE,
    Metal, Mix, ROUGHNESS_ALPHA, ROUGHNESS_SQRT, ROUGHNESS_SQUARE, RoughDielectric, Roughness,
    SIDES_BOTH, SIDES_FRONT, SURFACE_ALPHA, SURFACE_BUMP, SURFACE_CUTOFF, SURFACE_EMISSION,
    SURFACE_MEDIUM, SURFACE_NORMAL_MAP, SURFACE_ONE_SIDED, Surface, ThinDielectric,
};
use zrak_core::math::Color;
use zrak_core::scene::{MaterialKind, MaterialRef};
use zrak_core::textures::ScalarInput;

use super::textures::{LoweredInput, Textures};
use crate::arena::SceneArrays;
use crate::desc::{
    CoatDesc, ColorDesc, ConductorDesc, FresnelDesc, LightSides, MaterialDesc, MediumInterfaceDesc,
    RoughnessDesc, RoughnessMap, ScalarDesc, SceneDesc, Triple,
};

/// A material, and what shapes must know of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoweredMaterial {
    pub(super) handle: MaterialRef,
    /// Whether it looks at texture coordinates.
    pub(super) needs_uv: bool,
}

/// Index of the medium of this name; media are in the order of their names.
pub(super) fn medium_index(desc: &SceneDesc, name: Option<&str>) -> u32 {
    name.and_then(|name| desc.media.keys().position(|key| key == name))
        .map_or(zrak_core::media::VACUUM, |i| i as u32)
}

struct Lowering<'a, 'b> {
    desc: &'a SceneDesc,
    arrays: &'b mut SceneArrays,
    textures: &'b mut Textures<'a>,
    materials: HashMap<&'a str, LoweredMaterial>,
}

/// Lowers all materials, and the textures that they look at.
pub(super) fn lower<'a>(
    desc: &'a SceneDesc,
    textures: &mut Textures<'a>,
    arrays: &mut SceneArrays,
) -> HashMap<&'a str, LoweredMaterial> {
    let mut lowering = Lowering { desc, arrays, textures, materials: HashMap::new() };
    for name in desc.materials.keys() {
        lowering.material_of(name);
    }
    lowering.materials
}

fn color(c: Triple) -> Color {
    Color::from_array(c.map(|x| x as f32))
}

impl<'a> Lowering<'a, '_> {
    fn color_input(&mut self, desc: &'a ColorDesc) -> LoweredInput {
        self.textures.color_input(self.arrays, desc)
    }

    fn scalar_input(&mut self, desc: &'a ScalarDesc) -> (ScalarInput, bool) {
        self.textures.scalar_input(self.arrays, desc)
    }

    fn roughness(&mut self, desc: &'a RoughnessDesc) -> (Roughness, bool) {
        let (u, mut needs_uv) = self.scalar_input(&desc.u);
        let mut v = u;
        if let Some(desc) = &desc.v {
            v = self.scalar_input(desc).0;
            // Which direction is which is a matter of the texture's.
            needs_uv = true;
        }
        let map = match desc.map {
            RoughnessMap::Alpha => ROUGHNESS_ALPHA,
            RoughnessMap::Sqrt => ROUGHNESS_SQRT,
            RoughnessMap::Square => ROUGHNESS_SQUARE,
        };
        (Roughness { u, v, map, _pad: 0 }, needs_uv)
    }

    fn conductor(
        &mut self,
        metal: &'a ConductorDesc,
        roughness: &'a RoughnessDesc,
    ) -> (Conductor, bool) {
        let (roughness, mut needs_uv) = self.roughness(roughness);
        let mut conductor = Conductor { roughness, ..bytemuck::Zeroable::zeroed() };
        match metal {
            ConductorDesc::Index { eta, k } => {
                (conductor.kind, conductor.eta, conductor.k) =
                    (METAL_INDEX, color(*eta), color(*k));
            }
            ConductorDesc::Reflectance { reflectance } => {
                let lowered = self.color_input(reflectance);
                needs_uv |= lowered.needs_uv;
                (conductor.kind, conductor.reflectance) = (METAL_REFLECTANCE, lowered.input);
            }
        }
        (conductor, needs_uv)
    }

    /// Adds a coated base; says whether its coat looks at texture coordinates.
    fn coat(&mut self, base: Layered, coat: &'a CoatDesc) -> bool {
        let (roughness, needs_uv) = self.roughness(&coat.roughness);
        self.arrays.layereds.push(Layered {
            roughness,
            ior: coat.ior as f32,
            thickness: coat.thickness as f32,
            albedo: color(coat.albedo),
            g: coat.g as f32,
            max_depth: coat.max_depth,
            n_samples: coat.n_samples,
            ..base
        });
        needs_uv
    }

    /// The material of this name, lowered when it is first asked for: inner ones come first. Validation
    /// has made sure that it exists and does not lead to itself.
    fn material_of(&mut self, name: &'a str) -> LoweredMaterial {
        if let Some(done) = self.materials.get(name) {
            return *done;
        }
        let lowered = self.material(&self.desc.materials[name]);
        self.materials.insert(name, lowered);
        lowered
    }

    fn surface(&mut self, desc: &'a MaterialDesc) -> LoweredMaterial {
        let MaterialDesc::Surface {
            base,
            emission,
            emission_strength,
            emission_sides,
            alpha,
            alpha_cutoff,
            normal_map,
            normal_scale,
            bump,
            medium,
            one_sided,
        } = desc
        else {
            return self.material(desc);
        };
        let base = self.material_of(base);
        let mut needs_uv = base.needs_uv;
        let mut record = Surface { base: base.handle, ..Surface::default() };
        if let Some(emission) = emission {
            let lowered = self.color_input(emission);
            needs_uv |= lowered.needs_uv;
            record.flags |= SURFACE_EMISSION;
            record.emission = lowered.input;
            record.emission_strength = *emission_strength as f32;
            record.emission_sides = match emission_sides {
                LightSides::Both => SIDES_BOTH,
                LightSides::Front => SIDES_FRONT,
            };
        }
        if let Some(alpha) = alpha {
            let (input, uv) = self.scalar_input(alpha);
            needs_uv |= uv;
            record.flags |= SURFACE_ALPHA;
            record.alpha = input;
        }
        if let Some(cutoff) = alpha_cutoff {
            record.flags |= SURFACE_CUTOFF;
            record.alpha_cutoff = *cutoff as f32;
        }
        if let Some(name) = normal_map {
            let lowered = self.textures.normals(self.arrays, name);
            needs_uv = true;
            record.flags |= SURFACE_NORMAL_MAP;
            record.normal_map = lowered.input.texture;
            record.normal_scale = *normal_scale as f32;
        }
        if let Some(bump) = bump {
            let (input, _) = self.scalar_input(bump);
            needs_uv = true;
            record.flags |= SURFACE_BUMP;
            record.bump = input;
        }
        if let Some(MediumInterfaceDesc { inside, outside }) = medium {
            record.flags |= SURFACE_MEDIUM;
            record.inside = medium_index(self.desc, inside.as_deref());
            record.outside = medium_index(self.desc, outside.as_deref());
        }
        if *one_sided {
            record.flags |= SURFACE_ONE_SIDED;
        }
        self.arrays.surfaces.push(record);
        let index = self.arrays.surfaces.len() as u32 - 1;
        LoweredMaterial { handle: MaterialRef::new(MaterialKind::Surface, index), needs_uv }
    }

    fn material(&mut self, desc: &'a MaterialDesc) -> LoweredMaterial {
        let (kind, index, needs_uv) = match desc {
            MaterialDesc::Lambertian { color } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                self.arrays.lambertians.push(Lambertian { albedo: input });
                (MaterialKind::Lambertian, self.arrays.lambertians.len(), needs_uv)
            }
            MaterialDesc::Metal { color, fuzz } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                let metal = Metal { reflectance: input, fuzz: *fuzz as f32, _pad: [0; 3] };
                self.arrays.metals.push(metal);
                (MaterialKind::Metal, self.arrays.metals.len(), needs_uv)
            }
            MaterialDesc::Dielectric { ior, fresnel } => {
                let fresnel = match fresnel {
                    FresnelDesc::Exact => FRESNEL_EXACT,
                    FresnelDesc::Schlick => FRESNEL_SCHLICK,
                };
                let dielectric = Dielectric { ior: *ior as f32, fresnel, _pad: [0; 2] };
                self.arrays.dielectrics.push(dielectric);
                (MaterialKind::Dielectric, self.arrays.dielectrics.len(), false)
            }
            MaterialDesc::Isotropic { color } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                self.arrays.isotropics.push(Isotropic { albedo: input });
                (MaterialKind::Isotropic, self.arrays.isotropics.len(), needs_uv)
            }
            MaterialDesc::DiffuseLight { color, sides } => {
                let LoweredInput { input, needs_uv } = self.color_input(color);
                let sides = match sides {
                    LightSides::Both => SIDES_BOTH,
                    LightSides::Front => SIDES_FRONT,
                };
                let light = DiffuseLight { radiance: input, sides, _pad: [0; 3] };
                self.arrays.diffuse_lights.push(light);
                (MaterialKind::DiffuseLight, self.arrays.diffuse_lights.len(), needs_uv)
            }
            MaterialDesc::Mix { materials, amount } => {
                let parts = [&materials[0], &materials[1]].map(|name| self.material_of(name));
                let (amount, uv) = self.scalar_input(amount);
                let needs_uv = uv || parts.iter().any(|part| part.needs_uv);
                self.arrays.mixes.push(Mix { amount, materials: parts.map(|part| part.handle) });
                (MaterialKind::Mix, self.arrays.mixes.len(), needs_uv)
            }
            MaterialDesc::Interface => {
                self.arrays.interfaces.push(0);
                (MaterialKind::Interface, self.arrays.interfaces.len(), false)
            }
            MaterialDesc::Surface { .. } => return self.surface(desc),
            MaterialDesc::Conductor { metal, roughness } => {
                let (conductor, needs_uv) = self.conductor(metal, roughness);
                self.arrays.conductors.push(conductor);
                (MaterialKind::Conductor, self.arrays.conductors.len(), needs_uv)
            }
            MaterialDesc::RoughDielectric { ior, roughness } => {
                let (roughness, needs_uv) = self.roughness(roughness);
                let dielectric = RoughDielectric { roughness, ior: *ior as f32, _pad: 0 };
                self.arrays.rough_dielectrics.push(dielectric);
                (MaterialKind::RoughDielectric, self.arrays.rough_dielectrics.len(), needs_uv)
            }
            MaterialDesc::ThinDielectric { ior } => {
                self.arrays.thin_dielectrics.push(ThinDielectric { ior: *ior as f32 });
                (MaterialKind::ThinDielectric, self.arrays.thin_dielectrics.len(), false)
            }
            MaterialDesc::DiffuseTransmission { reflectance, transmittance } => {
                let r = self.color_input(reflectance);
                let t = self.color_input(transmittance);
                let both = DiffuseTransmission { reflectance: r.input, transmittance: t.input };
                self.arrays.diffuse_transmissions.push(both);
                let len = self.arrays.diffuse_transmissions.len();
                (MaterialKind::DiffuseTransmission, len, r.needs_uv || t.needs_uv)
            }
            MaterialDesc::CoatedDiffuse { color, coat } => {
                let lowered = self.color_input(color);
                let base = Layered {
                    base: BASE_DIFFUSE,
                    color: lowered.input,
                    ..bytemuck::Zeroable::zeroed()
                };
                let needs_uv = self.coat(base, coat) || lowered.needs_uv;
                (MaterialKind::Layered, self.arrays.layereds.len(), needs_uv)
            }
            MaterialDesc::CoatedConductor { metal, metal_roughness, coat } => {
                let (metal, uv) = self.conductor(metal, metal_roughness);
                let base = Layered { base: BASE_METAL, metal, ..bytemuck::Zeroable::zeroed() };
                let needs_uv = self.coat(base, coat) || uv;
                (MaterialKind::Layered, self.arrays.layereds.len(), needs_uv)
            }
            MaterialDesc::Principled { surface } => {
                let (record, needs_uv) = self.principled(surface);
                self.arrays.principleds.push(record);
                (MaterialKind::Principled, self.arrays.principleds.len(), needs_uv)
            }
        };
        LoweredMaterial { handle: MaterialRef::new(kind, index as u32 - 1), needs_uv }
    }
}
