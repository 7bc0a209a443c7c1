//! Materials.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{ColorDesc, ScalarDesc, Triple, one};

/// How a surface or a medium scatters or emits light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum MaterialDesc {
    /// Ideal diffuse reflection, on both sides.
    Lambertian {
        /// Albedo.
        color: ColorDesc,
    },
    /// Mirror reflection, perturbed: reflect + fuzz * (uniform point on the unit sphere).
    Metal {
        /// Reflectance.
        color: ColorDesc,
        /// Radius of the perturbation, 0 (mirror) to 1.
        #[serde(default)]
        fuzz: f64,
    },
    /// Smooth clear dielectric.
    Dielectric {
        /// Index of refraction inside relative to outside; below 1 for a bubble.
        ior: f64,
        /// How the reflected share is computed.
        #[serde(default)]
        fresnel: FresnelDesc,
    },
    /// Isotropic phase function, for media.
    Isotropic {
        /// Single-scattering albedo.
        color: ColorDesc,
    },
    /// Emits and does not scatter.
    DiffuseLight {
        /// Emitted radiance.
        color: ColorDesc,
        /// Which sides of the surface emit.
        #[serde(default)]
        sides: LightSides,
    },
    /// Metal by Fresnel's equations.
    Conductor {
        /// What it is made of.
        metal: ConductorDesc,
        /// How rough the surface is.
        #[serde(default, skip_serializing_if = "RoughnessDesc::is_smooth")]
        roughness: RoughnessDesc,
    },
    /// Clear dielectric with a rough surface, by Fresnel's equations.
    RoughDielectric {
        /// Index of refraction inside relative to outside; below 1 for a bubble.
        ior: f64,
        /// How rough the surface is.
        roughness: RoughnessDesc,
    },
    /// Thin pane of a clear dielectric, whose two sides are close together.
    ThinDielectric {
        /// Index of refraction inside relative to outside.
        ior: f64,
    },
    /// Diffuse reflection and diffuse transmission.
    DiffuseTransmission {
        /// Share of light that is reflected.
        reflectance: ColorDesc,
        /// Share of light that goes through.
        transmittance: ColorDesc,
    },
    /// Diffuse base under a dielectric coat: pbrt's layered model.
    CoatedDiffuse {
        /// Albedo of the base.
        color: ColorDesc,
        /// The coat.
        #[serde(default)]
        coat: CoatDesc,
    },
    /// Metal under a dielectric coat: pbrt's layered model.
    CoatedConductor {
        /// What the base is made of.
        metal: ConductorDesc,
        /// How rough the base is.
        #[serde(default, skip_serializing_if = "RoughnessDesc::is_smooth")]
        metal_roughness: RoughnessDesc,
        /// The coat.
        #[serde(default)]
        coat: CoatDesc,
    },
    /// One of two materials at random.
    Mix {
        /// Names of the two.
        materials: [String; 2],
        /// Share of the second.
        amount: ScalarDesc,
    },
    /// Not there: light goes straight through; for surfaces that only bound a medium.
    Interface,
    /// The OpenPBR surface.
    Principled {
        /// Its parameters.
        #[serde(default)]
        surface: Box<PrincipledDesc>,
    },
    /// Another material with more about the surface: light of its own, holes, bumps, media.
    Surface {
        /// Name of the material that scatters; not a `surface` itself.
        base: String,
        /// Emitted radiance.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        emission: Option<ColorDesc>,
        /// Factor of the emitted radiance.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        emission_strength: f64,
        /// Which sides of the surface emit.
        #[serde(default, skip_serializing_if = "LightSides::is_both")]
        emission_sides: LightSides,
        /// How much of the surface is there: 0 is a hole.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        alpha: Option<ScalarDesc>,
        /// Below this `alpha` is a hole and above it is none; without it, `alpha` is a chance.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        alpha_cutoff: Option<f64>,
        /// Name of a texture with normals in tangent space, as (n + 1) / 2.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        normal_map: Option<String>,
        /// Factor of the normals' x and y.
        #[serde(default = "one", skip_serializing_if = "is_one")]
        normal_scale: f64,
        /// Height in world units, as a texture.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        bump: Option<ScalarDesc>,
        /// The media on the two sides, if the surface bounds any.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        medium: Option<MediumInterfaceDesc>,
        /// Whether the back of the surface is a hole.
        #[serde(default, skip_serializing_if = "super::is_false")]
        one_sided: bool,
    },
}

fn is_one(x: &f64) -> bool {
    *x == 1.0
}

/// The media on the two sides of a surface; nothing is a vacuum.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MediumInterfaceDesc {
    /// Name of the medium behind the surface, where its normal does not point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside: Option<String>,
    /// Name of the medium before the surface.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
}

/// What a metal is made of: its complex index of refraction, or its colour.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum ConductorDesc {
    /// Complex index of refraction eta + i k, for red, green and blue.
    Index {
        /// Real part.
        eta: Triple,
        /// Imaginary part.
        k: Triple,
    },
    /// Reflectance when looked at straight on; eta = 1, k = 2 sqrt(r / (1 - r)) as in pbrt.
    Reflectance {
        /// The reflectance.
        reflectance: ColorDesc,
    },
}

/// How rough a surface is: the alpha of the Trowbridge-Reitz (GGX) distribution, or what it is made of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RoughnessDesc {
    /// Along u, or in all directions.
    #[serde(default = "zero")]
    pub u: ScalarDesc,
    /// Along v, if it differs.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub v: Option<ScalarDesc>,
    /// How alpha is made of the numbers.
    #[serde(default)]
    pub map: RoughnessMap,
}

fn zero() -> ScalarDesc {
    ScalarDesc::Value(0.0)
}

impl Default for RoughnessDesc {
    fn default() -> Self {
        Self { u: zero(), v: None, map: RoughnessMap::default() }
    }
}

impl RoughnessDesc {
    /// Whether it is no roughness at all.
    #[must_use]
    pub fn is_smooth(&self) -> bool {
        self.u == zero() && self.v.as_ref().is_none_or(|v| *v == zero())
    }
}

/// How the alpha of a distribution is made of a roughness.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum RoughnessMap {
    /// alpha = roughness.
    #[default]
    Alpha,
    /// alpha = sqrt(roughness), as in pbrt.
    Sqrt,
    /// alpha = roughness^2, as in glTF and OpenPBR.
    Square,
}

/// A dielectric coat over a base, with a medium in between.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CoatDesc {
    /// How rough the coat's outside is.
    #[serde(default, skip_serializing_if = "RoughnessDesc::is_smooth")]
    pub roughness: RoughnessDesc,
    /// Index of refraction of the coat.
    #[serde(default = "default_ior")]
    pub ior: f64,
    /// Thickness of the medium in the coat, in its mean free paths.
    #[serde(default = "default_thickness")]
    pub thickness: f64,
    /// Single-scattering albedo of the medium in the coat.
    #[serde(default)]
    pub albedo: Triple,
    /// Mean cosine of its phase function.
    #[serde(default)]
    pub g: f64,
    /// Most segments of a path in the coat.
    #[serde(default = "default_max_depth")]
    pub max_depth: u32,
    /// Paths that are averaged where the model is evaluated for a light.
    #[serde(default = "default_n_samples")]
    pub n_samples: u32,
}

impl Default for CoatDesc {
    fn default() -> Self {
        Self {
            roughness: RoughnessDesc::default(),
            ior: default_ior(),
            thickness: default_thickness(),
            albedo: [0.0; 3],
            g: 0.0,
            max_depth: default_max_depth(),
            n_samples: default_n_samples(),
        }
    }
}

fn default_ior() -> f64 {
    1.5
}

fn default_thickness() -> f64 {
    0.01
}

fn default_max_depth() -> u32 {
    10
}

fn default_n_samples() -> u32 {
    1
}

/// The OpenPBR surface, with the names and defaults of its specification 1.1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
#[allow(missing_docs)] // The specification says what each of them is.
pub struct PrincipledDesc {
    pub base_weight: ScalarDesc,
    pub base_color: ColorDesc,
    pub base_metalness: ScalarDesc,
    pub base_diffuse_roughness: ScalarDesc,
    pub specular_weight: ScalarDesc,
    pub specular_color: ColorDesc,
    pub specular_roughness: ScalarDesc,
    pub specular_roughness_anisotropy: ScalarDesc,
    pub specular_ior: f64,
    pub transmission_weight: ScalarDesc,
    pub transmission_color: ColorDesc,
    pub subsurface_weight: ScalarDesc,
    pub subsurface_color: ColorDesc,
    pub coat_weight: ScalarDesc,
    pub coat_color: ColorDesc,
    pub coat_roughness: ScalarDesc,
    pub coat_roughness_anisotropy: ScalarDesc,
    pub coat_ior: f64,
    pub coat_darkening: ScalarDesc,
    pub fuzz_weight: ScalarDesc,
    pub fuzz_color: ColorDesc,
    pub fuzz_roughness: ScalarDesc,
    pub thin_film_weight: ScalarDesc,
    /// In micrometres.
    pub thin_film_thickness: ScalarDesc,
    pub thin_film_ior: f64,
    pub geometry_thin_walled: bool,
}

impl Default for PrincipledDesc {
    fn default() -> Self {
        let white = || ColorDesc::Solid([1.0; 3]);
        let grey = || ColorDesc::Solid([0.8; 3]);
        Self {
            base_weight: 1.0.into(),
            base_color: grey(),
            base_metalness: 0.0.into(),
            base_diffuse_roughness: 0.0.into(),
            specular_weight: 1.0.into(),
            specular_color: white(),
            specular_roughness: 0.3.into(),
            specular_roughness_anisotropy: 0.0.into(),
            specular_ior: 1.5,
            transmission_weight: 0.0.into(),
            transmission_color: white(),
            subsurface_weight: 0.0.into(),
            subsurface_color: grey(),
            coat_weight: 0.0.into(),
            coat_color: white(),
            coat_roughness: 0.0.into(),
            coat_roughness_anisotropy: 0.0.into(),
            coat_ior: 1.6,
            coat_darkening: 1.0.into(),
            fuzz_weight: 0.0.into(),
            fuzz_color: white(),
            fuzz_roughness: 0.5.into(),
            thin_film_weight: 0.0.into(),
            thin_film_thickness: 0.5.into(),
            thin_film_ior: 1.4,
            geometry_thin_walled: false,
        }
    }
}

/// How the share of light that a dielectric reflects is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum FresnelDesc {
    /// Fresnel's equations for unpolarised light.
    #[default]
    Exact,
    /// Schlick's approximation.
    Schlick,
}

/// Which sides of a light emit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LightSides {
    /// Both.
    #[default]
    Both,
    /// Only the side that the surface normal points to; the other is black.
    Front,
}

impl MaterialDesc {
    /// A surface of the material `base` that has nothing else.
    #[must_use]
    pub fn surface(base: impl Into<String>) -> Self {
        Self::Surface {
            base: base.into(),
            emission: None,
            emission_strength: 1.0,
            emission_sides: LightSides::Both,
            alpha: None,
            alpha_cutoff: None,
            normal_map: None,
            normal_scale: 1.0,
            bump: None,
            medium: None,
            one_sided: false,
        }
    }
}

impl LightSides {
    fn is_both(&self) -> bool {
        *self == Self::Both
    }
}
