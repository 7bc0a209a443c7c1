//! The scenes that come with zrak: those of *Ray Tracing in One Weekend* and *Ray Tracing: The Next
//! Week* (Shirley, Black and Hollasch, version 4), as the books build them, one with everything, a workshop of
//! what real scenes have besides, and one of bent shapes.
//!
//! Where a book draws random numbers, the scene draws them in the same order from its own seeded
//! generator, so a built-in scene is the same on every machine but not sphere for sphere the book's.
//!
//! To add a scene: 1. write a file with a function that returns its [`SceneDesc`]; 2. name it in
//! the table below.

mod checkered_spheres;
mod cornell;
mod cover;
mod earth;
mod everything;
mod final_scene;
mod parts;
mod perlin_spheres;
mod quads;
mod rng;
mod shapes;
mod simple_light;
mod workshop;

#[cfg(test)]
mod tests;

use crate::desc::SceneDesc;

/// A scene that comes with zrak.
#[derive(Clone, Copy, Debug)]
pub struct Builtin {
    /// What it is called on the command line.
    pub name: &'static str,
    /// One line about it.
    pub summary: &'static str,
    /// Makes its description.
    pub build: fn() -> SceneDesc,
}

/// Every built-in scene, in the order of the books.
pub fn all() -> &'static [Builtin] {
    &[
        Builtin {
            name: "cover",
            summary: "One Weekend's cover: a field of small spheres around three big ones",
            build: cover::cover,
        },
        Builtin {
            name: "bouncing-spheres",
            summary: "The cover with motion blur, on a checkered ground",
            build: cover::bouncing_spheres,
        },
        Builtin {
            name: "checkered-spheres",
            summary: "Two spheres with a solid checker texture",
            build: checkered_spheres::checkered_spheres,
        },
        Builtin { name: "earth", summary: "A globe with an image texture", build: earth::earth },
        Builtin {
            name: "perlin-spheres",
            summary: "Marble made of Perlin's noise",
            build: perlin_spheres::perlin_spheres,
        },
        Builtin { name: "quads", summary: "Five coloured parallelograms", build: quads::quads },
        Builtin {
            name: "simple-light",
            summary: "Marble in the dark, lit by a sphere and a quad",
            build: simple_light::simple_light,
        },
        Builtin {
            name: "cornell-box",
            summary: "The Cornell box with two boxes",
            build: cornell::cornell_box,
        },
        Builtin {
            name: "cornell-smoke",
            summary: "The Cornell box with two boxes of smoke",
            build: cornell::cornell_smoke,
        },
        Builtin {
            name: "final",
            summary: "The Next Week's last: everything at once, in a mist",
            build: final_scene::final_scene,
        },
        Builtin {
            name: "everything",
            summary: "One of each shape, material, texture and option, from a scene file",
            build: everything::everything,
        },
        Builtin {
            name: "workshop",
            summary: "Meshes, instances, lights and media: what real scenes are made of, in small",
            build: workshop::workshop,
        },
        Builtin {
            name: "shapes",
            summary: "Bent shapes: parts of spheres, bilinear patches, hair, grass and thread",
            build: shapes::shapes,
        },
    ]
}

/// The built-in scene of this name.
pub fn find(name: &str) -> Option<&'static Builtin> {
    all().iter().find(|builtin| builtin.name == name)
}

/// The name of the built-in scene that someone who wrote `name` may have meant.
pub fn suggest(name: &str) -> Option<&'static str> {
    crate::suggest::closest(name, all().iter().map(|builtin| builtin.name))
}
