//! Arrays of the file: every range is checked before a byte is read.

use gltf::json::accessor::{ComponentType, Type, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, buffer};

use super::source::Source;
use crate::Error;

/// Most values of an array for which the file holds no bytes (zeros that sparse entries replace).
const ABSENT_LIMIT: u64 = 1 << 24;

/// Shape of an array.
#[derive(Clone, Copy, Debug)]
struct Layout {
    format: ComponentType,
    shape: Type,
    normalized: bool,
    count: usize,
}

/// Elements in a buffer, all of them within it.
struct Strided<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl Layout {
    fn element_size(self) -> usize {
        self.format.size() * self.shape.multiplicity()
    }
}

impl Source<'_> {
    /// Vectors of `N` floats (1: scalars, 16: 4×4 matrices, column-major); integers are converted, normalized ones
    /// to `0..=1` or `-1..=1`.
    pub(super) fn floats<const N: usize>(
        &self,
        accessor: Index<Accessor>,
        place: &str,
    ) -> Result<Vec<[f32; N]>, Error> {
        let (layout, values) = self.decode(accessor, place, to_f32)?;
        self.require_shape::<N>(layout, place)?;
        Ok(values.as_chunks().0.to_vec())
    }

    /// The first component of every element, as [`Self::floats`].
    pub(super) fn first_floats(&self, accessor: Index<Accessor>, place: &str) -> Result<Vec<f32>, Error> {
        let (layout, values) = self.decode(accessor, place, to_f32)?;
        Ok(values.into_iter().step_by(layout.shape.multiplicity()).collect())
    }

    /// Vectors of `N` unsigned integers.
    pub(super) fn integers<const N: usize>(
        &self,
        accessor: Index<Accessor>,
        place: &str,
    ) -> Result<Vec<[u32; N]>, Error> {
        let (layout, values) = self.decode(accessor, place, to_u32)?;
        self.require_shape::<N>(layout, place)?;
        if !matches!(layout.format, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Err(self.damaged(place, format!("{:?} where unsigned integers belong", layout.format)));
        }
        Ok(values.as_chunks().0.to_vec())
    }

    fn require_shape<const N: usize>(&self, layout: Layout, place: &str) -> Result<(), Error> {
        let wanted = match N {
            1 => Type::Scalar,
            2 => Type::Vec2,
            3 => Type::Vec3,
            4 => Type::Vec4,
            _ => Type::Mat4,
        };
        if layout.shape == wanted {
            return Ok(());
        }
        Err(self.damaged(place, format!("its type is {:?}, not {wanted:?}", layout.shape)))
    }

    /// All components of an array, sparse entries in place.
    fn decode<T: Copy + Default>(
        &self,
        index: Index<Accessor>,
        place: &str,
        component: fn(&[u8], Layout) -> T,
    ) -> Result<(Layout, Vec<T>), Error> {
        let place = &format!("{place} (accessor {index})");
        let accessor = self.get(&self.root.accessors, index, "accessor", place)?;
        let layout = self.layout(accessor, place)?;
        let width = layout.shape.multiplicity();
        let values = layout.count as u64 * width as u64;
        self.charge(values, place)?;
        let mut out = Vec::new();
        if let Some(view) = accessor.buffer_view {
            let offset = accessor.byte_offset.map_or(0, |o| o.0);
            let elements = self.strided(view, offset, layout, place)?;
            out.reserve_exact(layout.count * width);
            for element in (0..layout.count).map(|i| elements.get(i, layout)) {
                out.extend(element.chunks_exact(layout.format.size()).map(|c| component(c, layout)));
            }
        } else if values <= ABSENT_LIMIT {
            out.resize(layout.count * width, T::default());
        } else {
            return Err(self.damaged(place, format!("{} elements without any bytes", layout.count)));
        }
        if let Some(sparse) = &accessor.sparse {
            self.replace_sparse(sparse, layout, place, component, &mut out)?;
        }
        Ok((layout, out))
    }

    fn layout(&self, accessor: &Accessor, place: &str) -> Result<Layout, Error> {
        let (Checked::Valid(format), Checked::Valid(shape)) = (&accessor.component_type, &accessor.type_)
        else {
            return Err(self.damaged(place, "its type or component type is unknown"));
        };
        if matches!(shape, Type::Mat2 | Type::Mat3) {
            return Err(self.damaged(place, format!("its type {shape:?} belongs to no attribute")));
        }
        // Where the file holds the bytes, their number bounds the count; `u32` is what indices can reach.
        let count = u32::try_from(accessor.count.0)
            .map_err(|_| self.damaged(place, format!("{} elements are too many", accessor.count.0)))?;
        Ok(Layout { format: format.0, shape: *shape, normalized: accessor.normalized, count: count as usize })
    }

    /// `layout.count` elements from `offset` bytes into a buffer view on.
    fn strided(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        layout: Layout,
        place: &str,
    ) -> Result<Strided<'_>, Error> {
        let bytes = self.view(view, place)?;
        let size = layout.element_size();
        let view = self.get(&self.root.buffer_views, view, "buffer view", place)?;
        let stride = view.byte_stride.as_ref().map_or(size, |s| s.0);
        let begin = view.byte_offset.map_or(0, |o| o.0).wrapping_add(offset);
        let alignment = layout.format.size();
        if !begin.is_multiple_of(alignment as u64) || !stride.is_multiple_of(alignment) {
            return Err(self.damaged(place, format!("not aligned to its {alignment}-byte components")));
        }
        if stride < size {
            return Err(self.damaged(place, format!("elements of {size} bytes every {stride} bytes overlap")));
        }
        let end = (layout.count as u64)
            .checked_sub(1)
            .map_or(Some(0), |last| last.checked_mul(stride as u64)?.checked_add(size as u64))
            .and_then(|length| length.checked_add(offset))
            .filter(|end| *end <= bytes.len() as u64);
        let first =
            usize::try_from(offset).ok().filter(|_| end.is_some()).and_then(|first| bytes.get(first..));
        let Some(bytes) = first else {
            let problem =
                format!("{} elements of {size} bytes reach past the end of its buffer view", layout.count);
            return Err(self.damaged(place, problem));
        };
        Ok(Strided { bytes, stride })
    }

    /// Bytes of a buffer view.
    pub(super) fn view(&self, index: Index<buffer::View>, place: &str) -> Result<&[u8], Error> {
        let view = self.get(&self.root.buffer_views, index, "buffer view", place)?;
        let bytes = self.buffers.get(view.buffer.value()).and_then(Option::as_deref).ok_or_else(|| {
            self.damaged(place, format!("buffer {}, which it refers to, has no data", view.buffer))
        })?;
        let begin = view.byte_offset.map_or(0, |o| o.0);
        let range = begin
            .checked_add(view.byte_length.0)
            .and_then(|end| Some(usize::try_from(begin).ok()?..usize::try_from(end).ok()?));
        range.and_then(|range| bytes.get(range)).ok_or_else(|| {
            self.damaged(place, format!("buffer view {index} reaches past the end of buffer {}", view.buffer))
        })
    }

    fn replace_sparse<T>(
        &self,
        sparse: &Sparse,
        layout: Layout,
        place: &str,
        component: fn(&[u8], Layout) -> T,
        out: &mut [T],
    ) -> Result<(), Error> {
        let count = usize::try_from(sparse.count.0).ok().filter(|c| *c <= layout.count);
        let (Some(count), Checked::Valid(format)) = (count, &sparse.indices.component_type) else {
            return Err(self.damaged(place, "more sparse entries than elements, or of an unknown type"));
        };
        let scalar = Layout { format: format.0, shape: Type::Scalar, normalized: false, count };
        let rows = self.strided(sparse.indices.buffer_view, sparse.indices.byte_offset.0, scalar, place)?;
        let layout = Layout { count, ..layout };
        let entries = self.strided(sparse.values.buffer_view, sparse.values.byte_offset.0, layout, place)?;
        let width = layout.shape.multiplicity();
        for entry in 0..count {
            let row = to_u32(rows.get(entry, scalar), scalar) as usize;
            let target = row.checked_mul(width).and_then(|first| out.get_mut(first..)?.get_mut(..width));
            let Some(target) = target else {
                return Err(self.damaged(
                    place,
                    format!("sparse entry {entry} replaces element {row}, which is not there"),
                ));
            };
            let components = entries.get(entry, layout).chunks_exact(layout.format.size());
            for (old, new) in target.iter_mut().zip(components) {
                *old = component(new, layout);
            }
        }
        Ok(())
    }
}

impl Strided<'_> {
    /// Bytes of element `index`, which must be less than the checked count.
    fn get(&self, index: usize, layout: Layout) -> &[u8] {
        &self.bytes[index * self.stride..][..layout.element_size()]
    }
}

/// The first `N` bytes; callers hand in whole components.
fn head<const N: usize>(bytes: &[u8]) -> [u8; N] {
    bytes.first_chunk().copied().unwrap_or([0; N])
}

/// A component as a float; normalized integers by the equations of glTF 2.0, section 3.6.2.2.
fn to_f32(bytes: &[u8], layout: Layout) -> f32 {
    let (value, scale) = match layout.format {
        ComponentType::F32 => return f32::from_le_bytes(head(bytes)),
        ComponentType::I8 => (f64::from(i8::from_le_bytes(head(bytes))), 127.0),
        ComponentType::U8 => (f64::from(u8::from_le_bytes(head(bytes))), 255.0),
        ComponentType::I16 => (f64::from(i16::from_le_bytes(head(bytes))), 32_767.0),
        ComponentType::U16 => (f64::from(u16::from_le_bytes(head(bytes))), 65_535.0),
        ComponentType::U32 => (f64::from(u32::from_le_bytes(head(bytes))), 4_294_967_295.0),
    };
    let value = if layout.normalized { (value / scale).max(-1.0) } else { value };
    #[expect(clippy::cast_possible_truncation, reason = "rounding to f32 is meant")]
    let rounded = value as f32;
    rounded
}

/// A component as an unsigned integer; 0 for other formats, which callers refuse.
fn to_u32(bytes: &[u8], layout: Layout) -> u32 {
    match layout.format {
        ComponentType::U8 => u32::from(u8::from_le_bytes(head(bytes))),
        ComponentType::U16 => u32::from(u16::from_le_bytes(head(bytes))),
        ComponentType::U32 => u32::from_le_bytes(head(bytes)),
        ComponentType::I8 | ComponentType::I16 | ComponentType::F32 => 0,
    }
}
