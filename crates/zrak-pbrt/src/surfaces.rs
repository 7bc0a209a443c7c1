//! What a shape's surface is made of: material, light, media and holes.

use std::sync::Arc;

use zrak_mesh::TriangleMesh;
use zrak_scene::desc::{
    LightSides, MaterialDesc, MediumInterfaceDesc, MeshDesc, ObjectDesc, ScalarDesc, TransformStep,
};
use zrak_scene::lower::Transform;

use crate::error::{Fault, Result, Span};
use crate::maths::{cross, dot, sub};
use crate::params::Params;
use crate::state::Importer;

impl Importer {
    /// Name of the material of a shape, with the light, the media and the holes that it has.
    pub(crate) fn surface(&mut self, params: &Params) -> Result<String> {
        let material = self.state.material.to_string();
        let alpha = self.alpha(params)?;
        let [inside, outside] = self.state.media.clone();
        let mut light = self.state.light.clone();
        if light.is_some() && self.object.is_some() {
            self.warn(&params.span, "shapes of objects do not shine, as in pbrt");
            light = None;
        }
        let has_media = inside != outside;
        if alpha.is_none() && light.is_none() && !has_media {
            return Ok(material);
        }
        // The same again is made once.
        let key = format!("{material}|{alpha:?}|{light:?}|{inside}|{outside}");
        if let Some(name) = self.surfaces.get(&key) {
            return Ok(name.clone());
        }
        let name = self.fresh("surface");
        // If the material is a surface, the two are put together when all materials are known.
        let mut surface = MaterialDesc::surface(material);
        if let MaterialDesc::Surface {
            emission,
            emission_strength,
            emission_sides,
            alpha: a,
            medium,
            ..
        } = &mut surface
        {
            if let Some(light) = light {
                *emission = Some(light.emission.clone());
                *emission_strength = light.strength;
                *emission_sides =
                    if light.two_sided { LightSides::Both } else { LightSides::Front };
                self.references.shining.insert(name.clone(), params.span.clone());
            }
            *a = alpha;
            if has_media {
                let name = |name: &str| Some(name.to_owned()).filter(|name| !name.is_empty());
                *medium =
                    Some(MediumInterfaceDesc { inside: name(&inside), outside: name(&outside) });
            }
        }
        self.desc.materials.insert(name.clone(), surface);
        self.surfaces.insert(key, name.clone());
        Ok(name)
    }

    /// How much of a shape is there, unless all is.
    fn alpha(&mut self, params: &Params) -> Result<Option<ScalarDesc>> {
        let alpha = self.part(params, "alpha")?;
        Ok(alpha.filter(|alpha| *alpha != ScalarDesc::Value(1.0)))
    }

    /// Number of shapes so far, where shapes are added now.
    pub(crate) fn n_objects(&self) -> usize {
        self.object.as_ref().map_or(self.desc.objects.len(), |(_, objects)| objects.len())
    }

    /// Gives the shapes from number `first` on the radiance that makes them emit the power that the
    /// file gives.
    pub(crate) fn apply_power(&mut self, first: usize, at: &Span) -> Result<()> {
        let Some(light) = self.state.light.clone() else { return Ok(()) };
        let Some(power) = light.power else { return Ok(()) };
        if self.object.is_some() {
            return Ok(());
        }
        for i in first..self.desc.objects.len() {
            let Some((area, is_even)) = self.area(&self.desc.objects[i]) else {
                let message = "the power of this light is not known, as its area is not: it is 1 \
                               in luminance";
                self.warn(at, message);
                continue;
            };
            if !is_even {
                let message = "pbrt gives each triangle the whole power; here the mesh has it \
                               times their number, evenly";
                self.warn(at, message);
            }
            let sides = if light.two_sided { 2.0 } else { 1.0 };
            let k = light.mean * sides * area * std::f64::consts::PI;
            if !(k > 0.0) {
                return Err(Fault::new(at, "a light without area or colour can have no power"));
            }
            let strength = light.strength * power / k;
            let name = self.fresh("surface");
            let Some(material) = material_of(&mut self.desc.objects[i]) else { continue };
            let old = std::mem::replace(material, name.clone());
            if let Some(mut surface) = self.desc.materials.get(&old).cloned() {
                if let MaterialDesc::Surface { emission_strength, .. } = &mut surface {
                    *emission_strength = strength;
                }
                self.references.shining.insert(name.clone(), at.clone());
                self.desc.materials.insert(name, surface);
            }
        }
        Ok(())
    }

    /// Area that a light's power is spread over, in the world; and whether pbrt spreads it so. pbrt makes
    /// each triangle of a mesh a light of the whole power.
    fn area(&self, object: &ObjectDesc) -> Option<(f64, bool)> {
        const PI: f64 = std::f64::consts::PI;
        let map = |steps: &[TransformStep]| Transform::of_steps(steps);
        match object {
            ObjectDesc::Sphere { radius, transform, .. } => {
                let scale = map(transform).uniform_scale()?;
                Some((4.0 * PI * radius * radius * scale * scale, true))
            }
            ObjectDesc::Disk { radius, inner_radius, phi_max_deg, transform, .. } => {
                let map = map(transform);
                let n = cross(map.vector([1.0, 0.0, 0.0]), map.vector([0.0, 1.0, 0.0]));
                let own = 0.5 * phi_max_deg.to_radians();
                let own = own * (radius * radius - inner_radius * inner_radius);
                Some((own * dot(n, n).sqrt(), true))
            }
            ObjectDesc::Cylinder { radius, z_min, z_max, phi_max_deg, transform, .. } => {
                let scale = map(transform).uniform_scale()?;
                let own = phi_max_deg.to_radians() * radius * (z_max - z_min);
                Some((own * scale * scale, true))
            }
            ObjectDesc::Mesh { mesh, transform, .. } => {
                let MeshDesc::Loaded(mesh) = self.desc.meshes.get(mesh)? else { return None };
                Some(mean_triangle(mesh, &map(transform)))
            }
            _ => None,
        }
    }
}

fn mean_triangle(mesh: &Arc<TriangleMesh>, map: &Transform) -> (f64, bool) {
    let (mut sum, mut least, mut most) = (0.0, f64::INFINITY, 0.0_f64);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|v| map.point(mesh.positions[v as usize].map(f64::from)));
        let n = cross(sub(b, a), sub(c, a));
        let area = 0.5 * dot(n, n).sqrt();
        (sum, least, most) = (sum + area, least.min(area), most.max(area));
    }
    (sum / mesh.triangles.len() as f64, most - least <= 1e-3 * most)
}

fn material_of(object: &mut ObjectDesc) -> Option<&mut String> {
    match object {
        ObjectDesc::Sphere { material, .. }
        | ObjectDesc::Disk { material, .. }
        | ObjectDesc::Cylinder { material, .. }
        | ObjectDesc::Mesh { material, .. } => Some(material),
        _ => None,
    }
}
