//! Learning the springs of flesh from simulated motion.

pub mod sensitivity;
