//! Secondary motion for skinned characters: to be written.
#![no_std]
