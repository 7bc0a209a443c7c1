//! The scene as the renderer sees it: typed arrays in one arena, and handles into them.
//!
//! To add an array (for a new shape, material or texture): write its record in its own file, add
//! one line to [`for_each_scene_array!`](crate::for_each_scene_array), a kind to the handle that refers
//! to it, and a check of that handle to `zrak-scene`, `arena/check.rs`. The host's builder, the
//! arena's layout and [`SceneView`] all come from that one line.

use bytemuck::{Pod, Zeroable};

use crate::accessor::Array;
use crate::camera::Camera;
use crate::math::{Color, Vec3, lerp};
use crate::textures::TextureArrays;

/// Calls the macro with the name and the record type of every array of the arena. This is the only list.
#[macro_export]
macro_rules! for_each_scene_array {
    ($callback:ident) => {
        $callback! {
            /// Binary tree, for the GPU.
            nodes2: $crate::accel::Node<2>,
            /// Eight-wide tree, for the processor.
            nodes8: $crate::accel::Node<8>,
            /// Spheres that stand still.
            spheres: $crate::shapes::Sphere,
            /// Spheres that move on a line.
            moving_spheres: $crate::shapes::MovingSphere,
            /// Parallelograms.
            quads: $crate::shapes::Quad,
            /// Boxes along the axes.
            boxes: $crate::shapes::Box3,
            /// Triangles.
            triangles: $crate::shapes::Triangle,
            /// Meshes.
            meshes: $crate::shapes::Mesh,
            /// Triangles of meshes.
            mesh_triangles: $crate::shapes::MeshTriangle,
            /// Positions of the vertices of meshes.
            positions: $crate::math::Vec3,
            /// Normals of the vertices of meshes.
            normals: $crate::math::Vec3,
            /// Texture coordinates of the vertices of meshes.
            uvs: [f32; 2],
            /// Tangents of the vertices of meshes, and their handedness.
            tangents: [f32; 4],
            /// Linear colours of the vertices of meshes, and alpha.
            colors: [f32; 4],
            /// Disks.
            disks: $crate::shapes::Disk,
            /// Cylinders.
            cylinders: $crate::shapes::Cylinder,
            /// Parts of spheres.
            partial_spheres: $crate::shapes::PartialSphere,
            /// Bilinear patches of meshes.
            mesh_patches: $crate::shapes::MeshPatch,
            /// Parts of curves.
            curves: $crate::shapes::Curve,
            /// Normals of curves that are ribbons.
            ribbons: $crate::shapes::Ribbon,
            /// Trees under affine maps.
            instances: $crate::shapes::Instance,
            /// How instances move.
            motions: $crate::shapes::Motion,
            /// Maps of the boundaries of media.
            placements: $crate::shapes::Placement,
            /// Media of constant density.
            media: $crate::media::ConstantMedium,
            /// Diffuse reflectors.
            lambertians: $crate::materials::Lambertian,
            /// Fuzzy mirrors.
            metals: $crate::materials::Metal,
            /// Clear dielectrics.
            dielectrics: $crate::materials::Dielectric,
            /// Isotropic phase functions.
            isotropics: $crate::materials::Isotropic,
            /// Emitters.
            diffuse_lights: $crate::materials::DiffuseLight,
            /// Metals by Fresnel's equations.
            conductors: $crate::materials::Conductor,
            /// Rough clear dielectrics.
            rough_dielectrics: $crate::materials::RoughDielectric,
            /// Thin panes.
            thin_dielectrics: $crate::materials::ThinDielectric,
            /// Diffuse reflectors that light goes through.
            diffuse_transmissions: $crate::materials::DiffuseTransmission,
            /// Coated bases.
            layereds: $crate::materials::Layered,
            /// OpenPBR surfaces.
            principleds: $crate::materials::Principled,
            /// Materials that are not there; the records say nothing.
            interfaces: u32,
            /// Mixed materials.
            mixes: $crate::materials::Mix,
            /// Materials with more about their surface.
            surfaces: $crate::materials::Surface,
            /// Media that surfaces bound.
            homogeneous_media: $crate::media::HomogeneousMedium,
            /// Lights without a surface.
            lights: $crate::lights::Light,
            /// Checker patterns.
            checkers: $crate::textures::Checker,
            /// Noise patterns.
            noises: $crate::textures::Noise,
            /// Images.
            images: $crate::textures::ImageTexture,
            /// Images with all that can be said about them.
            image_maps: $crate::textures::ImageMap,
            /// Mappings of surfaces to (u, v), and maps of space.
            mappings: $crate::textures::TextureMapping,
            /// Fractal patterns.
            fractals: $crate::textures::Fractal,
            /// Textures made of textures.
            programs: $crate::textures::Program,
            /// What they are made of.
            texture_ops: $crate::textures::TextureOp,
            /// Pictures of the whole sphere of directions; the background is the first.
            environments: $crate::lights::Environment,
            /// Texels of the images.
            texels: u32,
            /// Linear value of each 8-bit sRGB code.
            srgb_table: f32,
        }
    };
}

/// Kinds of things that code is needed for. A kernel that sets this to a constant loses the code of
/// all other kinds, and with it registers; a scene may only be given to a kernel that has the code of
/// all its kinds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Kinds {
    /// Bit for each [`PrimKind`].
    pub prims: u32,
    /// Bit for each [`MaterialKind`].
    pub materials: u32,
    /// Bit for each [`TextureKind`].
    pub textures: u32,
    /// Bit for each [`Feature`].
    pub features: u32,
}

/// What a scene may have besides primitives, materials and textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Feature {
    /// Lights without a surface.
    Lights = 0,
    /// Media that surfaces bound.
    Media = 1,
    /// A picture for a background.
    Environment = 2,
    /// Not something that a scene has, but a kernel: so much code that looking up a texture is a call.
    /// A call costs registers; a copy of its code at each of many places costs more.
    TextureCalls = 31,
}

impl Kinds {
    /// Everything.
    pub const ALL: Self =
        Self { prims: u32::MAX, materials: u32::MAX, textures: u32::MAX, features: u32::MAX };

    /// Spheres that stand still, with solid colours, and no light but the background.
    pub const PLAIN_SPHERES: Self = Self {
        prims: 1 << PrimKind::Sphere as u32,
        materials: 1 << MaterialKind::Lambertian as u32
            | 1 << MaterialKind::Metal as u32
            | 1 << MaterialKind::Dielectric as u32,
        textures: 1 << TextureKind::Solid as u32,
        features: 0,
    };

    /// Those of the books' scenes that need no instance: nothing turned or stretched that cannot be
    /// turned or stretched in world space.
    pub const BOOKS_IN_WORLD_SPACE: Self =
        Self { prims: Self::BOOKS.prims & !(1 << PrimKind::Instance as u32), ..Self::BOOKS };

    /// What the scenes of *Ray Tracing in One Weekend* and *The Next Week* are made of.
    pub const BOOKS: Self = Self {
        prims: 1 << PrimKind::Sphere as u32
            | 1 << PrimKind::MovingSphere as u32
            | 1 << PrimKind::Quad as u32
            | 1 << PrimKind::Box as u32
            | 1 << PrimKind::Triangle as u32
            | 1 << PrimKind::Instance as u32
            | 1 << PrimKind::Medium as u32,
        materials: Self::PLAIN_SPHERES.materials
            | 1 << MaterialKind::Isotropic as u32
            | 1 << MaterialKind::DiffuseLight as u32,
        textures: 1 << TextureKind::Solid as u32
            | 1 << TextureKind::Checker as u32
            | 1 << TextureKind::Noise as u32
            | 1 << TextureKind::Image as u32,
        features: 0,
    };

    /// Whether primitives of this kind may occur.
    #[inline(always)]
    #[must_use]
    pub const fn has_prim(&self, kind: PrimKind) -> bool {
        self.prims >> kind as u32 & 1 != 0
    }

    /// Whether materials of this kind may occur.
    #[inline(always)]
    #[must_use]
    pub const fn has_material(&self, kind: MaterialKind) -> bool {
        self.materials >> kind as u32 & 1 != 0
    }

    /// Whether textures of this kind may occur.
    #[inline(always)]
    #[must_use]
    pub const fn has_texture(&self, kind: TextureKind) -> bool {
        self.textures >> kind as u32 & 1 != 0
    }

    /// Whether scenes may have this.
    #[inline(always)]
    #[must_use]
    pub const fn has_feature(&self, feature: Feature) -> bool {
        self.features >> feature as u32 & 1 != 0
    }

    /// Whether all of `other` are among these.
    #[must_use]
    pub const fn include(&self, other: &Self) -> bool {
        other.prims & !self.prims == 0
            && other.materials & !self.materials == 0
            && other.textures & !self.textures == 0
            && other.features & !self.features == 0
    }
}

impl SceneView<'_> {
    /// The kinds that occur in the scene's arrays.
    #[must_use]
    pub fn kinds_in_use(&self) -> Kinds {
        let bit = |is_empty: bool, kind: u32| if is_empty { 0 } else { 1 << kind };
        let prims = [
            (self.spheres.is_empty(), PrimKind::Sphere),
            (self.moving_spheres.is_empty(), PrimKind::MovingSphere),
            (self.quads.is_empty(), PrimKind::Quad),
            (self.boxes.is_empty(), PrimKind::Box),
            (self.triangles.is_empty(), PrimKind::Triangle),
            (self.mesh_triangles.is_empty(), PrimKind::MeshTriangle),
            (self.disks.is_empty(), PrimKind::Disk),
            (self.cylinders.is_empty(), PrimKind::Cylinder),
            (self.partial_spheres.is_empty(), PrimKind::PartialSphere),
            (self.mesh_patches.is_empty(), PrimKind::MeshPatch),
            (self.curves.is_empty(), PrimKind::Curve),
            (self.instances.is_empty(), PrimKind::Instance),
            (self.media.is_empty(), PrimKind::Medium),
        ];
        let materials = [
            (self.lambertians.is_empty(), MaterialKind::Lambertian),
            (self.metals.is_empty(), MaterialKind::Metal),
            (self.dielectrics.is_empty(), MaterialKind::Dielectric),
            (self.isotropics.is_empty(), MaterialKind::Isotropic),
            (self.diffuse_lights.is_empty(), MaterialKind::DiffuseLight),
            (self.conductors.is_empty(), MaterialKind::Conductor),
            (self.rough_dielectrics.is_empty(), MaterialKind::RoughDielectric),
            (self.thin_dielectrics.is_empty(), MaterialKind::ThinDielectric),
            (self.diffuse_transmissions.is_empty(), MaterialKind::DiffuseTransmission),
            (self.layereds.is_empty(), MaterialKind::Layered),
            (self.principleds.is_empty(), MaterialKind::Principled),
            (self.mixes.is_empty(), MaterialKind::Mix),
            (self.surfaces.is_empty(), MaterialKind::Surface),
            (self.interfaces.is_empty(), MaterialKind::Interface),
        ];
        let textures = [
            (false, TextureKind::Solid),
            (self.checkers.is_empty(), TextureKind::Checker),
            (self.noises.is_empty(), TextureKind::Noise),
            (self.images.is_empty(), TextureKind::Image),
            (self.programs.is_empty(), TextureKind::Program),
        ];
        let features = [
            (self.lights.is_empty(), Feature::Lights),
            (self.homogeneous_media.is_empty(), Feature::Media),
            (self.environments.is_empty(), Feature::Environment),
        ];
        Kinds {
            features: features.iter().map(|k| bit(k.0, k.1 as u32)).sum(),
            prims: prims.iter().map(|k| bit(k.0, k.1 as u32)).sum(),
            materials: materials.iter().map(|k| bit(k.0, k.1 as u32)).sum(),
            textures: textures.iter().map(|k| bit(k.0, k.1 as u32)).sum(),
        }
    }
}

impl SceneView<'_> {
    /// Radiance that comes from beyond the scene along the unit direction `d`.
    #[inline(always)]
    #[must_use]
    pub fn radiance_from_beyond(&self, d: Vec3) -> Color {
        if self.kinds.has_feature(Feature::Environment) && !self.environments.is_empty() {
            self.environments.get(0).radiance(&TextureArrays::of(self), d)
        } else {
            self.globals.background.radiance(d)
        }
    }
}

/// Where an array lies in the arena.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Span {
    /// Distance from the start of the arena, in units of 16 bytes.
    pub offset: u32,
    /// Number of records.
    pub len: u32,
}

macro_rules! define_views {
    ($($(#[$doc:meta])* $name:ident: $record:ty,)*) => {
        /// Where each array lies in the arena.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
        #[repr(C)]
        pub struct Spans {
            $($(#[$doc])* pub $name: Span,)*
        }

        /// A scene, borrowed: the same type on the processor and on the GPU.
        #[derive(Clone, Copy)]
        pub struct SceneView<'a> {
            /// Camera, background and limits.
            pub globals: Globals,
            /// What code is needed for.
            pub kinds: Kinds,
            $($(#[$doc])* pub $name: Array<'a, $record>,)*
        }
    };
}

crate::for_each_scene_array!(define_views);

/// What there is one of in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Globals {
    /// How the picture is taken.
    pub camera: Camera,
    /// Radiance of rays that leave the scene.
    pub background: Background,
    /// Greatest number of ray segments of a path.
    pub max_depth: u32,
    /// Lower half of the seed.
    pub seed_lo: u32,
    /// Upper half of the seed.
    pub seed_hi: u32,
    /// Index of the medium that the camera is in, or [`crate::media::VACUUM`].
    pub camera_medium: u32,
    /// Number of ray segments after which a path that carries little may be ended by chance.
    pub rr_depth: u32,
    /// Nothing.
    pub _pad: u32,
}

const _: () = assert!(size_of::<Globals>().is_multiple_of(16));

impl Globals {
    /// The seed of all random numbers.
    #[inline(always)]
    #[must_use]
    pub const fn seed(&self) -> u64 {
        self.seed_lo as u64 | (self.seed_hi as u64) << 32
    }
}

/// Radiance by direction: a linear blend in y, constant if both ends are the same.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Background {
    /// Radiance straight down.
    pub bottom: Color,
    /// Radiance straight up.
    pub top: Color,
}

impl Background {
    /// Radiance that comes from the unit direction `d`.
    #[inline(always)]
    #[must_use]
    pub fn radiance(&self, d: Vec3) -> Color {
        let t = 0.5 * (d.y + 1.0);
        // A blend of equal ends may be off by rounding, and a constant must be exact.
        let blend = |a: f32, b: f32| if a == b { a } else { lerp(t, a, b) };
        Color::new(
            blend(self.bottom.r, self.top.r),
            blend(self.bottom.g, self.top.g),
            blend(self.bottom.b, self.top.b),
        )
    }
}

/// Defines a handle: a kind in the upper four bits and an index in the lower 28.
macro_rules! tagged_handle {
    ($(#[$doc:meta])* $name:ident, $kind:ident { $($(#[$kdoc:meta])* $variant:ident = $value:literal,)* }) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Pod, Zeroable)]
        #[repr(transparent)]
        pub struct $name(pub u32);

        #[doc = concat!("What a [`", stringify!($name), "`] refers to.")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[repr(u32)]
        pub enum $kind {
            $($(#[$kdoc])* $variant = $value,)*
        }

        impl $name {
            /// Handle of record `index` of its kind.
            ///
            /// # Panics
            /// If `index` does not fit 28 bits.
            #[must_use]
            pub const fn new(kind: $kind, index: u32) -> Self {
                assert!(index < 1 << 28, "more than 2^28 records of one kind");
                Self((kind as u32) << 28 | index)
            }

            /// Index into the array of its kind.
            #[inline(always)]
            #[must_use]
            pub const fn index(self) -> u32 {
                self.0 & 0x0fff_ffff
            }

            /// Kind, if it is one.
            #[inline(always)]
            #[must_use]
            pub const fn kind(self) -> Option<$kind> {
                match self.0 >> 28 {
                    $($value => Some($kind::$variant),)*
                    _ => None,
                }
            }
        }
    };
}

tagged_handle! {
    /// Child of a tree: a node, or a primitive.
    PrimRef, PrimKind {
        /// Inner node of the tree.
        Node = 0,
        /// [`crate::shapes::Sphere`].
        Sphere = 1,
        /// [`crate::shapes::MovingSphere`].
        MovingSphere = 2,
        /// [`crate::shapes::Quad`].
        Quad = 3,
        /// [`crate::shapes::Box3`].
        Box = 4,
        /// [`crate::shapes::Triangle`].
        Triangle = 5,
        /// [`crate::shapes::Instance`].
        Instance = 6,
        /// [`crate::media::ConstantMedium`].
        Medium = 7,
        /// [`crate::shapes::MeshTriangle`].
        MeshTriangle = 8,
        /// [`crate::shapes::Disk`].
        Disk = 9,
        /// [`crate::shapes::Cylinder`].
        Cylinder = 10,
        /// [`crate::shapes::PartialSphere`].
        PartialSphere = 11,
        /// [`crate::shapes::MeshPatch`].
        MeshPatch = 12,
        /// [`crate::shapes::Curve`].
        Curve = 13,
    }
}

impl PrimRef {
    /// Refers to nothing: the slot of a node that has fewer children than slots, and "no hit".
    pub const NONE: Self = Self(u32::MAX);

    /// Whether this is an inner node.
    #[inline(always)]
    #[must_use]
    pub const fn is_node(self) -> bool {
        self.0 < 1 << 28
    }
}

tagged_handle! {
    /// Material of a surface or phase function of a medium.
    MaterialRef, MaterialKind {
        /// [`crate::materials::Lambertian`].
        Lambertian = 1,
        /// [`crate::materials::Metal`].
        Metal = 2,
        /// [`crate::materials::Dielectric`].
        Dielectric = 3,
        /// [`crate::materials::Isotropic`].
        Isotropic = 4,
        /// [`crate::materials::DiffuseLight`].
        DiffuseLight = 5,
        /// [`crate::materials::Conductor`].
        Conductor = 6,
        /// [`crate::materials::RoughDielectric`].
        RoughDielectric = 7,
        /// [`crate::materials::ThinDielectric`].
        ThinDielectric = 8,
        /// [`crate::materials::DiffuseTransmission`].
        DiffuseTransmission = 9,
        /// [`crate::materials::Layered`].
        Layered = 10,
        /// [`crate::materials::Principled`].
        Principled = 11,
        /// [`crate::materials::Mix`].
        Mix = 12,
        /// Not there: light goes straight through.
        Interface = 13,
        /// [`crate::materials::Surface`].
        Surface = 14,
    }
}

tagged_handle! {
    /// Texture; the solid colour beside it counts if it is `Solid`.
    TextureRef, TextureKind {
        /// A colour that does not vary.
        Solid = 0,
        /// [`crate::textures::Checker`].
        Checker = 1,
        /// [`crate::textures::Noise`].
        Noise = 2,
        /// [`crate::textures::ImageTexture`].
        Image = 3,
        /// [`crate::textures::Program`].
        Program = 4,
    }
}
