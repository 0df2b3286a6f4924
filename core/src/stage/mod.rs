//! One arrow of the data flow a file: `pose ─▶ skin ─▶ dynamics ─▶ embed`.

pub mod dynamics;
pub mod embed;
pub mod pose;
pub mod skin;
