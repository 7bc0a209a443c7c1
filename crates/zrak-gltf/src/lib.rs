//! glTF 2.0 files, text and binary: scenes in and out.
//!
//! [`import`] maps a file to a [`SceneDesc`](zrak_scene::desc::SceneDesc); what it maps exactly,
//! approximately and not at all is in the guide's page on glTF. The data flow is
//!
//! ```text
//! bytes -> container -> json -> extensions, buffers -> hierarchy -> place (primitive, materials) -> SceneDesc
//! ```
//!
//! All input is hostile: every index, range, size and count is checked before it is used or memory is
//! taken for it, nothing recurses on the depth of the input, and the memory that a file may ask for
//! is bounded by [`Limits`].

mod accessor;
mod budget;
mod buffers;
mod cameras;
mod container;
mod deform;
mod error;
mod export;
mod extensions;
mod hierarchy;
mod import;
mod json;
mod lights;
mod materials;
mod meshopt;
mod names;
mod options;
mod place;
mod primitive;
mod textures;
mod uri;

pub use buffers::Resolver;
pub use error::{Error, ErrorKind, Warning};
pub use export::{Assets, to_glb, write_glb};
pub use import::{Imported, import, parse_gltf};
pub use options::{ImportOptions, Limits};
pub use textures::EMBEDDED;
