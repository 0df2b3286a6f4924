//! Copies between slices that need not be equally long.

/// Copies as many elements as both have. At once: element by element takes several times as long in WebAssembly.
#[inline(always)]
pub(crate) fn copy<T: Copy>(from: &[T], to: &mut [T]) {
    let n = from.len().min(to.len());
    to[..n].copy_from_slice(&from[..n]);
}
