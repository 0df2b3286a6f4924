//! The importer on real files, on every form that glTF allows, and on hostile files.

#![expect(clippy::float_cmp, reason = "imported numbers are the file's, bit for bit")]
#![expect(clippy::unwrap_used, clippy::print_stdout, reason = "helpers of tests are tests")]

mod builder;
mod data;
mod features;
mod hostile;
