//! What an import may be told.

use zrak_scene::progress::LoadProgress;

/// How a file is read.
#[derive(Clone, Debug)]
pub struct ImportOptions {
    /// How much memory it may ask for.
    pub limits: Limits,
    /// Whether buffers and images may be outside of the file's folder.
    pub allow_external: bool,
    /// Name or index of the scene; without it the file's default scene, or else its first.
    pub scene: Option<String>,
    /// Which of the scene's cameras: the name of its node, or its own, or else its number in the order
    /// of the nodes, from 0; without it the first.
    pub camera: Option<String>,
    /// Height of the picture in pixels; its width follows from the camera.
    pub height: u32,
    /// Luminous efficacy by which the candela and lux of lights become radiometric units. 683 is
    /// what Blender uses both ways; 1 takes the numbers as they are.
    pub lumens_per_watt: f64,
    /// Whether backs of single-sided surfaces are holes, as rasterisers show them.
    pub cull_back_faces: bool,
    /// Whether a scene without lights gets a soft environment.
    pub default_light: bool,
    /// Is told of the bytes that are read.
    pub progress: LoadProgress,
}

impl Default for ImportOptions {
    fn default() -> Self {
        Self {
            limits: Limits::default(),
            allow_external: false,
            scene: None,
            camera: None,
            height: 720,
            lumens_per_watt: 683.0,
            cull_back_faces: false,
            default_light: true,
            progress: LoadProgress::default(),
        }
    }
}

/// How much memory a file may ask for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Bytes of all files, and of all geometry and images made of them.
    pub max_bytes: u64,
    /// JSON objects; each takes some hundred bytes.
    pub max_objects: u64,
}

impl Default for Limits {
    fn default() -> Self {
        Self { max_bytes: 4 << 30, max_objects: 2 << 20 }
    }
}
