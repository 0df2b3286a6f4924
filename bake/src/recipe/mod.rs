//! Placeholder types.
/// Where flesh is.
#[derive(Clone, Debug, Default)]
pub struct Flesh {
    /// Softness of each render vertex.
    pub softness: Vec<f32>,
    /// Region of each render vertex.
    pub region: Vec<u8>,
    /// Regions.
    pub regions: Vec<Region>,
    /// Body size.
    pub body_size: f64,
}
/// A region.
#[derive(Clone, Debug, Default)]
pub struct Region {
    /// Name.
    pub name: String,
    /// Hz.
    pub frequency: f32,
    /// Ratio.
    pub damping: f32,
    /// Factor.
    pub gain: f32,
    /// Body sizes.
    pub max_offset: f32,
}
