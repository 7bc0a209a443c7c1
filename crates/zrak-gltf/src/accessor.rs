//! Accessors: numbers in views of buffers.
//!
//! Everything is checked when an accessor is opened, so that its elements can be read without doubt.

use std::fmt::Display;

use crate::buffers::{Buffers, element, range};
use crate::error::{Error, Warnings};
use crate::json;

/// The type of one number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of_code(code: u32) -> Option<Self> {
        Some(match code {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// Whether it can count.
    fn is_unsigned(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    fn float(self, b: &[u8], normalized: bool) -> f32 {
        let scale = |x: f32, one: f32| if normalized { (x / one).max(-1.0) } else { x };
        match self {
            Self::I8 => scale(f32::from(b[0] as i8), 127.0),
            Self::U8 => scale(f32::from(b[0]), 255.0),
            Self::I16 => scale(f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Self::U16 => scale(f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            Self::U32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32,
            Self::F32 => f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }

    fn unsigned(self, b: &[u8]) -> u32 {
        match self {
            Self::U8 | Self::I8 => u32::from(b[0]),
            Self::U16 | Self::I16 => u32::from(u16::from_le_bytes([b[0], b[1]])),
            Self::U32 | Self::F32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }
}

/// The type of one element.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Scalar,
    Vec2,
    Vec3,
    Vec4,
    Mat4,
}

impl Kind {
    fn of_name(name: &str) -> Option<Self> {
        Some(match name {
            "SCALAR" => Self::Scalar,
            "VEC2" => Self::Vec2,
            "VEC3" => Self::Vec3,
            "VEC4" => Self::Vec4,
            "MAT4" => Self::Mat4,
            _ => return None,
        })
    }

    fn n_components(self) -> usize {
        match self {
            Self::Scalar => 1,
            Self::Vec2 => 2,
            Self::Vec3 => 3,
            Self::Vec4 => 4,
            Self::Mat4 => 16,
        }
    }
}

/// An accessor whose elements are there and have the right type.
pub(crate) struct Accessor<'a> {
    pub(crate) count: usize,
    pub(crate) kind: Kind,
    component: Component,
    normalized: bool,
    stride: usize,
    /// From the first element on; without it all are zero.
    bytes: Option<&'a [u8]>,
    sparse: Option<SparseView<'a>>,
}

/// Elements that stand elsewhere, by their strictly growing indices.
struct SparseView<'a> {
    count: usize,
    component: Component,
    indices: &'a [u8],
    values: &'a [u8],
}

impl SparseView<'_> {
    fn index(&self, i: usize) -> usize {
        let size = self.component.size();
        self.component.unsigned(&self.indices[i * size..(i + 1) * size]) as usize
    }

    /// Where among the values element `wanted` is.
    fn find(&self, wanted: usize) -> Option<usize> {
        let (mut lo, mut hi) = (0, self.count);
        while lo < hi {
            let middle = lo + (hi - lo) / 2;
            if self.index(middle) < wanted { lo = middle + 1 } else { hi = middle }
        }
        (lo < self.count && self.index(lo) == wanted).then_some(lo)
    }
}

/// Opens the accessor that `location` refers to, of one of the `kinds`.
pub(crate) fn open<'a>(
    root: &'a json::Root,
    buffers: &'a Buffers<'_>,
    index: usize,
    kinds: &[Kind],
    location: impl Display,
    warnings: &mut Warnings,
) -> Result<Accessor<'a>, Error> {
    let desc = element(&root.accessors, "accessors", index, &location)?;
    let at = |key: &str| format!("accessors[{index}]{key}");
    let kind = Kind::of_name(&desc.kind).filter(|kind| kinds.contains(kind)).ok_or_else(|| {
        let message = format!("accessors[{index}] is {:?}, which cannot be used here", desc.kind);
        Error::invalid(&location, message)
    })?;
    let unknown = |key: &str, code: u32| {
        Error::invalid(at(key), format!("{code} is no type of numbers that can be used here"))
    };
    let component = Component::of_code(desc.component_type)
        .ok_or_else(|| unknown(".componentType", desc.component_type))?;
    let size = component.size() * kind.n_components();
    let count = usize::try_from(desc.count)
        .ok()
        .filter(|&n| n <= u32::MAX as usize)
        .ok_or_else(|| Error::invalid(at(".count"), "there are more than 2^32 elements"))?;
    let mut stride = size;
    let mut bytes = None;
    if let Some(view_index) = desc.buffer_view {
        let view = buffers.view(view_index, at(".bufferView"))?;
        if let Some(wide) = view.stride {
            if !(size as u64..=1 << 16).contains(&wide) {
                let message = format!(
                    "byteStride is {wide}, but an element of accessors[{index}] has {size} bytes"
                );
                return Err(Error::invalid(format_args!("bufferViews[{view_index}]"), message));
            }
            stride = wide as usize;
        }
        let base = root.buffer_views[view_index].byte_offset;
        let align = component.size() as u64;
        if !desc.byte_offset.wrapping_add(base).is_multiple_of(align)
            || !stride.is_multiple_of(component.size())
        {
            let message = format!("its numbers are not aligned to their {align} bytes");
            warnings.note(at(""), message);
        }
        let length = match count {
            0 => 0,
            _ => (count as u64 - 1) * stride as u64 + size as u64,
        };
        let part = range(view.bytes, desc.byte_offset, length).ok_or_else(|| {
            let message = format!(
                "{count} elements from byte {} on, {stride} bytes apart, reach beyond the {} bytes \
                 of bufferViews[{view_index}]",
                desc.byte_offset,
                view.bytes.len()
            );
            Error::invalid(at(""), message)
        })?;
        bytes = Some(part);
    }
    let sparse = match &desc.sparse {
        None => None,
        Some(sparse) => {
            let code = sparse.indices.component_type;
            let index_component = Component::of_code(code)
                .filter(|c| c.is_unsigned())
                .ok_or_else(|| unknown(".sparse.indices.componentType", code))?;
            let n =
                usize::try_from(sparse.count).ok().filter(|&n| n <= count).ok_or_else(|| {
                    let message = format!("{} of {count} elements cannot differ", sparse.count);
                    Error::invalid(at(".sparse.count"), message)
                })?;
            let part = |key: &str, view_index: usize, offset: u64, size: usize| {
                let view = buffers.view(view_index, at(&format!(".sparse.{key}.bufferView")))?;
                let length = n as u64 * size as u64;
                range(view.bytes, offset, length).ok_or_else(|| {
                    let message =
                        format!("{n} entries reach beyond the end of bufferViews[{view_index}]");
                    Error::invalid(at(&format!(".sparse.{key}")), message)
                })
            };
            let (indices, values) = (&sparse.indices, &sparse.values);
            let view = SparseView {
                count: n,
                component: index_component,
                indices: part(
                    "indices",
                    indices.buffer_view,
                    indices.byte_offset,
                    index_component.size(),
                )?,
                values: part("values", values.buffer_view, values.byte_offset, size)?,
            };
            let grows = (1..n).all(|i| view.index(i - 1) < view.index(i));
            if !grows || (n > 0 && view.index(n - 1) >= count) {
                let message = format!("they must grow, and stay below {count}");
                return Err(Error::invalid(at(".sparse.indices"), message));
            }
            Some(view)
        }
    };
    let normalized = desc.normalized;
    Ok(Accessor { count, kind, component, normalized, stride, bytes, sparse })
}

impl<'a> Accessor<'a> {
    /// The bytes of element `i`; none if it is zero.
    fn element(&self, i: usize) -> Option<&'a [u8]> {
        let size = self.component.size() * self.kind.n_components();
        if let Some(sparse) = &self.sparse
            && let Some(k) = sparse.find(i)
        {
            return Some(&sparse.values[k * size..(k + 1) * size]);
        }
        self.bytes.map(|bytes| &bytes[i * self.stride..i * self.stride + size])
    }

    /// Element `i`, cut or filled up with zeros to `N` numbers.
    pub(crate) fn floats<const N: usize>(&self, i: usize) -> [f32; N] {
        let mut numbers = [0.0; N];
        if let Some(bytes) = self.element(i) {
            let size = self.component.size();
            for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(size)) {
                *number = self.component.float(bytes, self.normalized);
            }
        }
        numbers
    }

    /// Element `i` as counts, cut or filled up with zeros.
    pub(crate) fn counts<const N: usize>(&self, i: usize) -> [u32; N] {
        let mut numbers = [0; N];
        if let Some(bytes) = self.element(i) {
            let size = self.component.size();
            for (number, bytes) in numbers.iter_mut().zip(bytes.chunks_exact(size)) {
                *number = self.component.unsigned(bytes);
            }
        }
        numbers
    }

    /// Whether its numbers can count.
    pub(crate) fn is_unsigned(&self) -> bool {
        self.component.is_unsigned()
    }
}
