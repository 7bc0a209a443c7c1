//! Corners of faces as vertices: equal ones are the same.

/// Most vertices, texture coordinates, and normals: the numbers above mean other things.
pub(super) const MAX_INDEX: usize = 1 << 30;
/// Instead of an index: no texture coordinates.
pub(super) const NO_UV: u32 = u32::MAX;
/// Instead of the index of a normal: that of the face.
pub(super) const FLAT: u32 = u32::MAX;
/// The longest search for an equal vertex; where more meet, some are stored more than once.
const SEARCH_MAX: usize = 64;
/// The end of a list.
const END: u32 = u32::MAX;
/// Instead of the index of a normal: this and the number of a smoothing group.
const SMOOTH: u32 = 1 << 31;

/// Instead of the index of a normal: the mean of those of the faces of a smoothing group.
pub(super) fn smooth_normal(group: u32) -> u32 {
    SMOOTH | group.min(MAX_INDEX as u32)
}

/// What a corner of a face is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Corner {
    pub(super) position: u32,
    /// An index or [`NO_UV`].
    pub(super) uv: u32,
    /// An index, [`FLAT`], or a [`smooth_normal`].
    pub(super) normal: u32,
}

impl Corner {
    pub(super) fn is_smooth(&self) -> bool {
        self.normal & SMOOTH != 0 && self.normal != FLAT
    }
}

/// The vertices so far.
#[derive(Debug, Default)]
pub(super) struct Welder {
    vertices: Vec<Vertex>,
    /// The last vertex at each position.
    heads: Vec<u32>,
}

#[derive(Debug)]
struct Vertex {
    corner: Corner,
    /// The one before it at its position.
    next: u32,
}

impl Welder {
    /// Index of the vertex that is this corner.
    #[inline]
    pub(super) fn vertex(&mut self, corner: Corner) -> u32 {
        let place = corner.position as usize;
        if self.heads.len() <= place {
            self.heads.resize(place + 1, END);
        }
        let mut at = self.heads[place];
        for _ in 0..SEARCH_MAX {
            if at == END {
                break;
            }
            let vertex = &self.vertices[at as usize];
            if vertex.corner == corner {
                return at;
            }
            at = vertex.next;
        }
        let index = self.vertices.len() as u32;
        self.vertices.push(Vertex { corner, next: self.heads[place] });
        self.heads[place] = index;
        index
    }

    pub(super) fn len(&self) -> usize {
        self.vertices.len()
    }

    pub(super) fn into_vertices(self) -> Vec<Corner> {
        self.vertices.into_iter().map(|v| v.corner).collect()
    }
}
