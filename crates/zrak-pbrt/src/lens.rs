//! The lenses of realistic cameras, as one thin lens: from the file of their surfaces.

use crate::error::{Fault, Result, Span};
use crate::state::Importer;

/// A surface: its radius of curvature (0 for the stop), the distance to the next and the index of
/// refraction on the way there, and the diameter of its opening. Lengths in millimetres.
type Surface = [f64; 4];

/// A camera with a thin lens: distances in metres.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ThinLens {
    pub(crate) radius: f64,
    pub(crate) focus: f64,
    /// Field of view over the film's shorter side, in degrees.
    pub(crate) fov_deg: f64,
}

/// Focal length by a paraxial ray that comes in parallel to the axis at height 1.
fn focal_length_mm(surfaces: &[Surface]) -> Option<f64> {
    let (mut height, mut slope, mut index) = (1.0, 0.0, 1.0);
    for [radius, thickness, eta, _] in surfaces {
        let next = if *eta == 0.0 { 1.0 } else { *eta };
        if *radius != 0.0 {
            slope = (index * slope - height * (next - index) / radius) / next;
            index = next;
        }
        height += thickness * slope;
    }
    // At last there is air before the film.
    let slope = slope * index;
    (slope < -1e-9).then(|| -1.0 / slope)
}

impl Importer {
    /// Reads the file of a lens. `short_mm` is the film's shorter side.
    pub(crate) fn lens(
        &mut self,
        name: &str,
        span: &Span,
        short_mm: f64,
        diameter_mm: f64,
        focus: f64,
    ) -> Result<ThinLens> {
        let path = self.sources.resolve(name, span)?;
        let text = self.sources.read(&path, span)?;
        let mut numbers = Vec::new();
        for (i, line) in text.lines().enumerate() {
            for word in line.split('#').next().unwrap_or("").split_ascii_whitespace() {
                match word.parse::<f64>() {
                    Ok(x) if x.is_finite() => numbers.push(x),
                    _ => {
                        let message =
                            format!("{} line {}: `{word}` is no number", path.display(), i + 1);
                        return Err(Fault::new(span, message));
                    }
                }
            }
        }
        let surfaces: Vec<Surface> =
            numbers.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        let bad = |what: &str| Fault::new(span, format!("{} {what}", path.display()));
        if !numbers.len().is_multiple_of(4) || surfaces.is_empty() {
            return Err(bad("must have four numbers for each surface of the lens"));
        }
        let focal =
            focal_length_mm(&surfaces).ok_or_else(|| bad("is no lens that collects light"))?;
        // With the film where that distance is in focus.
        let focus_mm = focus * 1000.0;
        let image = if focus_mm > focal { focal * focus_mm / (focus_mm - focal) } else { focal };
        Ok(ThinLens {
            radius: 0.5 * diameter_mm / 1000.0,
            focus,
            fov_deg: 2.0 * libm::atan(0.5 * short_mm / image).to_degrees(),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::focal_length_mm;

    #[test]
    fn lens_makers_equation_holds_for_a_thin_lens() {
        let thin = [[100.0, 0.0, 1.5, 20.0], [-100.0, 50.0, 1.0, 20.0]];
        let focal = focal_length_mm(&thin).unwrap();
        assert!((focal - 100.0).abs() < 1e-9, "{focal}");
        // A thick one: 1/f = (n - 1) (1/R1 - 1/R2 + (n - 1) d / (n R1 R2)).
        let thick = [[100.0, 10.0, 1.5, 20.0], [-100.0, 50.0, 0.0, 20.0]];
        let expected = 1.0 / (0.5 * (0.01 + 0.01 - 0.5 * 10.0 / (1.5 * 1e4)));
        let focal = focal_length_mm(&thick).unwrap();
        assert!((focal - expected).abs() < 1e-9, "{focal} {expected}");
        assert_eq!(focal_length_mm(&[[-100.0, 5.0, 1.5, 20.0]]), None);
    }
}
