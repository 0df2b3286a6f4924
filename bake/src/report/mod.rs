//! Reports: what the baker made of a character, as a page for people.
//!
//! Pictures are inside the page and plots are drawn as SVG, so that the page can be sent around as one file. It is
//! readable on a phone, in light and dark, printed, and without JavaScript.

#[cfg(feature = "simulate")]
mod cage;
mod character;
mod motion;
mod page;
mod svg;

#[cfg(feature = "simulate")]
pub use cage::cage;
pub use character::character;
pub use page::{Bar, Block, Fact, Image, Picture, Report, Section};
pub use svg::{Histogram, Plot, Series};

/// Colors of lines and regions.
pub const COLORS: usize = 8;
