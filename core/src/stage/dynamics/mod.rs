//! Targets in, offsets out: how flesh moves about where skinning puts it.

pub mod springs;
