//! Memory on multiples of 16 bytes, which assets and lanes like best.

use crate::error::Thrown;

/// Zeroed bytes that start on a multiple of 16.
#[derive(Debug, Default)]
pub(crate) struct Aligned {
    blocks: Vec<u128>,
    len: usize,
}

impl Aligned {
    /// `len` zero bytes.
    ///
    /// # Errors
    ///
    /// Where the memory cannot grow that far.
    pub(crate) fn zeroed(len: usize) -> Result<Self, Thrown> {
        let count = len.div_ceil(size_of::<u128>());
        let mut blocks = Vec::new();
        let full = |_| Thrown::out_of_memory(&format!("{len} bytes"));
        blocks.try_reserve_exact(count).map_err(full)?;
        blocks.resize(count, 0);
        Ok(Self { blocks, len })
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &bytemuck::cast_slice(&self.blocks)[..self.len]
    }

    pub(crate) fn bytes_mut(&mut self) -> &mut [u8] {
        &mut bytemuck::cast_slice_mut(&mut self.blocks)[..self.len]
    }

    /// As floats; up to three bytes at the end are left out.
    pub(crate) fn floats_mut(&mut self) -> &mut [f32] {
        let whole = self.len / size_of::<f32>();
        &mut bytemuck::cast_slice_mut(&mut self.blocks)[..whole]
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }
}

/// Address of a slice in the module's memory.
pub(crate) fn address<T>(slice: &[T]) -> usize {
    slice.as_ptr().addr()
}
