//! The classes, by number.

use crate::offer::{HARMLESS, Seen};
use crate::{container as a, content as c, numbers as e, replays as r, running as h};

/// How a class is tested.
pub(crate) enum Case {
    /// What all offers of the class came to, and what that must be.
    Offers(fn() -> Vec<Seen>, &'static [Seen]),
    /// In another file, beside this mark.
    Elsewhere(&'static str, &'static str),
    /// The kernel that would read it is not written.
    NotYet(&'static str),
}

/// A class of bad input.
pub(crate) struct Class {
    pub(crate) number: u8,
    pub(crate) name: &'static str,
    pub(crate) case: Case,
}

const fn offers(number: u8, name: &'static str, run: fn() -> Vec<Seen>, codes: &'static [Seen]) -> Class {
    Class { number, name, case: Case::Offers(run, codes) }
}

const fn not_yet(number: u8, name: &'static str, awaits: &'static str) -> Class {
    Class { number, name, case: Case::NotYet(awaits) }
}

const fn elsewhere(number: u8, name: &'static str, file: &'static str, mark: &'static str) -> Class {
    Class { number, name, case: Case::Elsewhere(file, mark) }
}

const SHORT: Seen = "ASSET_TOO_SHORT";
const MAGIC: Seen = "ASSET_BAD_MAGIC";
const VERSION: Seen = "ASSET_UNSUPPORTED_VERSION";
const LENGTH: Seen = "ASSET_WRONG_LENGTH";
const HASH: Seen = "ASSET_WRONG_HASH";
const ALIGN: Seen = "ASSET_MISALIGNED";
const SECTION: Seen = "ASSET_WRONG_SECTION";
const EXTENT: Seen = "ASSET_WRONG_EXTENT";
const ZERO: Seen = "ASSET_NOT_ZERO";
const ENTRY: Seen = "ASSET_INVALID_ENTRY";
const ROOT: Seen = "STEP_BAD_ROOT";
const JOINT: Seen = "STEP_BAD_JOINT";
const TIME: Seen = "STEP_TIME_NOT_FINITE";
const TUNABLE: Seen = "TUNABLE_OUT_OF_RANGE";
const NETWORKS: &str = "networks";
const POISSON: &str = "Poisson solver";
const WASM: &str = "wasm/test/special.test.mjs";

/// All of them.
pub(crate) const CLASSES: [Class; 80] = [
    offers(1, "empty file", a::empty, &[SHORT, "REPLAY_NO_HEADER", "STATE_WRONG_LENGTH"]),
    offers(
        2,
        "every truncation",
        a::truncated,
        &[SHORT, LENGTH, EXTENT, "REPLAY_NO_HEADER", "REPLAY_TRUNCATED"],
    ),
    offers(3, "every flipped bit", r::flipped, r::FLIPPED),
    offers(4, "wrong magic", a::magic, &[MAGIC, "REPLAY_BAD_MAGIC", "STATE_BAD_HEADER"]),
    offers(
        5,
        "version too old, too new",
        a::version,
        &[VERSION, "REPLAY_UNSUPPORTED_VERSION", "STATE_BAD_HEADER"],
    ),
    offers(6, "trailing bytes", a::trailing, &[LENGTH, "REPLAY_DAMAGED", "STATE_WRONG_LENGTH"]),
    offers(7, "big-endian magic", a::swapped, &[MAGIC, "REPLAY_BAD_MAGIC"]),
    offers(8, "buffer off by 1, 2, 3", a::misaligned, &[ALIGN]),
    offers(9, "shorter than the header", a::headless, &[SHORT, "REPLAY_NO_HEADER"]),
    offers(10, "checksum wrong", a::checksum, &[HASH, "REPLAY_DAMAGED_HEADER", "STATE_DAMAGED"]),
    offers(
        11,
        "checksum right, content hostile",
        a::resealed,
        &[LENGTH, MAGIC, VERSION, SECTION, EXTENT, ZERO, ENTRY, HARMLESS],
    ),
    offers(12, "offset past the end", a::offset_past_the_end, &[EXTENT]),
    offers(13, "offset + length overflows", a::overflowing_extent, &[EXTENT]),
    offers(14, "overlapping sections", a::overlap, &[EXTENT]),
    offers(15, "hole", a::hole, &[EXTENT]),
    offers(16, "duplicate section", a::duplicate, &[SECTION]),
    offers(17, "unknown section", a::unknown, &[SECTION]),
    offers(18, "order reversed", a::reversed, &[SECTION]),
    offers(19, "section on the header", a::on_the_header, &[EXTENT]),
    offers(20, "zero length", a::zero_length, &[EXTENT]),
    offers(21, "section on its own entry", a::on_itself, &[EXTENT]),
    offers(22, "misaligned offset", a::misaligned_offset, &[EXTENT]),
    offers(23, "padding that is not zero", a::padding, &[ZERO, SECTION, ENTRY]),
    offers(24, "count 0 everywhere", c::counts_zero, &[ENTRY]),
    offers(25, "count 1", c::counts_one, &[HARMLESS]),
    offers(26, "largest counts", c::counts_largest, &[EXTENT]),
    offers(27, "count times size overflows", c::counts_overflow, &[EXTENT]),
    offers(28, "count against section length", c::count_against_length, &[EXTENT]),
    offers(29, "counts against each other", c::counts_against_each_other, &[ENTRY]),
    offers(
        30,
        "memory too small",
        c::memory,
        &["BUFFER_WRONG_LENGTH", "STATE_WRONG_LENGTH", "RECORD_SINK_FULL"],
    ),
    not_yet(31, "product of layer widths", NETWORKS),
    offers(32, "cycle of parents", c::cycle, &[ENTRY]),
    offers(33, "its own parent", c::own_parent, &[ENTRY]),
    offers(34, "parent after child", c::late_parent, &[ENTRY]),
    offers(35, "two roots, no root", c::roots, &[HARMLESS, ENTRY]),
    offers(36, "as deep as it has nodes", c::deep, &[HARMLESS]),
    offers(37, "index out of range", c::indices, &[ENTRY]),
    offers(38, "joint in two chains", c::shared_node, &[HARMLESS]),
    offers(39, "bone without length", c::no_length, &[HARMLESS]),
    offers(40, "names twice, not text", c::names, &[HARMLESS, ENTRY]),
    offers(41, "NaN", e::nan, &[ENTRY, ROOT, JOINT, TIME, TUNABLE, "STATE_DAMAGED"]),
    offers(42, "infinity", e::infinite, &[ENTRY, ROOT, JOINT, TIME, TUNABLE, "STATE_DAMAGED"]),
    offers(43, "subnormal", e::subnormal, &[HARMLESS, ENTRY, ROOT, TUNABLE]),
    offers(44, "-0", e::negative_zero, &[HARMLESS, ENTRY, ROOT, TUNABLE]),
    offers(45, "largest numbers", e::largest, &[HARMLESS, ENTRY, ROOT, JOINT, TUNABLE]),
    offers(46, "negative frequency, damping, gain", e::negative, &[ENTRY, TUNABLE]),
    // Springs are per unit mass: the frequency takes the place of the mass.
    offers(47, "mass 0, tiny, huge", e::frequencies, &[HARMLESS, ENTRY, TUNABLE]),
    offers(48, "dt 0, negative, NaN, huge", h::times, &["held", HARMLESS, TIME]),
    offers(49, "quaternion 0, not unit, huge", e::quaternions, &[HARMLESS, ENTRY, ROOT]),
    offers(50, "matrix singular, mirrored, sheared", h::matrices, &[HARMLESS]),
    offers(51, "scale 0, negative", e::scales, &[HARMLESS, ENTRY]),
    offers(52, "step beyond the springs' domain", h::beyond_the_domain, &[HARMLESS]),
    offers(53, "critical damping and beside it", h::critical, &[HARMLESS]),
    offers(54, "limits the wrong way round", e::limits, &[ENTRY, TUNABLE]),
    not_yet(55, "scale 0, inf, NaN, subnormal", NETWORKS),
    not_yet(56, "zero point out of range", NETWORKS),
    not_yet(57, "int4 tail", NETWORKS),
    not_yet(58, "reserved nibble", NETWORKS),
    not_yet(59, "activation unknown", NETWORKS),
    not_yet(60, "width 0", NETWORKS),
    not_yet(61, "LayerNorm without variance", NETWORKS),
    not_yet(62, "table not monotone", NETWORKS),
    not_yet(63, "weights all -128", NETWORKS),
    not_yet(64, "matrix not symmetric", POISSON),
    not_yet(65, "matrix not positive definite", POISSON),
    not_yet(66, "singular system", POISSON),
    not_yet(67, "disconnected", POISSON),
    not_yet(68, "condition 2^24", POISSON),
    not_yet(69, "right side 0, inf", POISSON),
    not_yet(70, "rows not monotone, columns out of range", POISSON),
    not_yet(71, "no iterations, breakdown", POISSON),
    offers(72, "pose NaN in mid-run", h::pose_nan, &[JOINT]),
    offers(73, "1e30 in a frame", h::teleports, &[HARMLESS, JOINT, ROOT]),
    offers(74, "frame time jumps", h::time_jumps, &["held", HARMLESS]),
    offers(
        75,
        "buffer of another asset",
        h::another_asset,
        &["STATE_OTHER_ASSET", "REPLAY_OTHER_ASSET", "STEP_JOINT_COUNT", "STEP_NO_SUCH_CLIP"],
    ),
    // Safe Rust cannot write the next three: they are JavaScript's.
    elsewhere(76, "call before init", WASM, "class 76"),
    elsewhere(77, "aliased buffers", WASM, "class 77"),
    elsewhere(78, "null and length 0", WASM, "class 78"),
    elsewhere(79, "FTZ, rounding mode", "tests/tests/float_environment.rs", "Class 79"),
    elsewhere(80, "re-entrant call", WASM, "class 80"),
];
