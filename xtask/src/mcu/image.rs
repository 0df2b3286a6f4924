//! A firmware's file: what of it lies where, and which parts of the source its code comes from.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::rc::Rc;

use anyhow::{Context, Result, anyhow};
use gimli::{EndianRcSlice, LittleEndian};
use object::{Object, ObjectSection, ObjectSymbol, SymbolKind};

/// What is in no other part.
const REST: &str = "start, print, copy";
/// Parts of the source, by what is in the path of a file; the first that fits.
const PARTS: [(&str, &[&str]); 10] = [
    ("springs", &["core/src/kernel/spring", "core/src/kernel/target", "core/src/stage/dynamics/"]),
    (
        "skinning, normals",
        &["kernel/skin.rs", "kernel/unskin.rs", "kernel/normal.rs", "stage/skin.rs", "stage/embed.rs"],
    ),
    ("network", &["core/src/kernel/mlp/", "core/src/lanes/rows.rs"]),
    (
        "elementary functions",
        &[
            "core/src/math/psi",
            "core/src/math/exp",
            "core/src/math/trig",
            "core/src/math/entire",
            "core/src/math/theta",
            "core/src/math/activation",
            "core/src/math/rounding",
            "core/src/math/hard",
            "core/src/math/wide",
            "core/src/math/twin",
        ],
    ),
    ("clips, pose", &["core/src/kernel/clip", "core/src/stage/pose"]),
    ("asset", &["core/src/asset/"]),
    ("digests", &["core/src/math/digest"]),
    // The compiler's own library: first what copies memory, then what the processor cannot calculate.
    (REST, &["compiler-builtins/src/mem", "compiler-builtins/src/arm.rs"]),
    ("arithmetic in software", &["compiler-builtins/src/", "libm/src/math", "libm-0"]),
    (
        "life of the character",
        &[
            "core/src/character",
            "core/src/life",
            "core/src/tunables",
            "core/src/workspace",
            "math/noise",
            "math/canary",
        ],
    ),
];
/// Small functions that belong to whoever calls them, unless they are on their own.
const SHARED: (&str, &[&str]) =
    ("vectors, shared", &["core/src/lanes/", "core/src/math/", "core/src/kernel/tiny"]);

/// Sections that programs are made of, B.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Sizes {
    /// Code, with the vectors of interrupts.
    pub text: u64,
    /// Constants without the asset.
    pub constants: u64,
    /// The asset.
    pub asset: u64,
    /// Variables with a first value, and without.
    pub variables: u64,
    /// Memory of the character: one of the variables.
    pub memory: u64,
}

/// What a firmware's file says.
#[derive(Debug)]
pub(crate) struct Image {
    pub sizes: Sizes,
    /// Demangled names of all symbols, with address and length.
    pub symbols: Vec<(String, u64, u64)>,
}

impl Image {
    /// Reads the file.
    ///
    /// # Errors
    ///
    /// If it is not the firmware's.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let file =
            object::File::parse(&*bytes).with_context(|| format!("{} is no ELF file", path.display()))?;
        let size = |name: &str| file.section_by_name(name).map_or(0, |s| s.size());
        let named = file
            .symbols()
            .filter(|s| matches!(s.kind(), SymbolKind::Text | SymbolKind::Data | SymbolKind::Unknown));
        let symbols: Vec<_> = named
            .filter_map(|s| {
                Some((format!("{:#}", rustc_demangle::demangle(s.name().ok()?)), s.address(), s.size()))
            })
            .filter(|(name, ..)| !name.is_empty() && !name.starts_with('$'))
            .collect();
        let of =
            |part: &str| symbols.iter().filter(|(name, ..)| name.contains(part)).map(|(.., size)| size).sum();
        let asset = of("sinew_mcu::TUBE");
        let sizes = Sizes {
            text: size(".text") + size(".vector_table"),
            constants: (size(".rodata") + size(".data")).saturating_sub(asset),
            asset,
            variables: size(".data") + size(".bss"),
            memory: of("FLOATS"),
        };
        Ok(Self { sizes, symbols })
    }

    /// Address of a function.
    ///
    /// # Errors
    ///
    /// If there is none of this name.
    pub(crate) fn address(&self, name: &str) -> Result<u64> {
        let found = self.symbols.iter().find(|(n, ..)| n == name);
        // The lowest bit says that it is Thumb code.
        found
            .map(|(_, address, _)| address & !1)
            .with_context(|| format!("the firmware has no function `{name}`"))
    }

    /// Symbols whose names tell of any of `words`.
    pub(crate) fn with_any(&self, words: &[&str]) -> Vec<&str> {
        let mut found: Vec<&str> = self.symbols.iter().map(|(name, ..)| name.as_str()).collect();
        found.retain(|name| words.iter().any(|word| name.contains(word)));
        found.sort_unstable();
        found.dedup();
        found
    }

    /// Bytes of code by part of the source.
    ///
    /// # Errors
    ///
    /// If the file does not tell where its code comes from.
    pub(crate) fn code(&self, lines: &Lines) -> Result<BTreeMap<&'static str, u64>> {
        let mut sum = BTreeMap::new();
        let mut end = 0;
        let mut functions: Vec<_> =
            self.symbols.iter().map(|(_, address, size)| (address & !1, *size)).collect();
        functions.sort_unstable();
        for (start, size) in functions.into_iter().filter(|(start, _)| *start < self.sizes.text) {
            // Several names may stand for one function; an instruction has two bytes or four.
            for address in (start.max(end)..start + size).step_by(2) {
                *sum.entry(lines.part(address)?).or_default() += 2;
            }
            end = end.max(start + size);
        }
        Ok(sum)
    }
}

/// Which part of the source an instruction comes from.
pub(crate) struct Lines(addr2line::Context<EndianRcSlice<LittleEndian>>);

impl Lines {
    /// Of a firmware's file.
    ///
    /// # Errors
    ///
    /// If it cannot be read.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let bytes = fs::read(path).with_context(|| format!("cannot read {}", path.display()))?;
        let file =
            object::File::parse(&*bytes).with_context(|| format!("{} is no ELF file", path.display()))?;
        let section = |id: gimli::SectionId| {
            let data = file.section_by_name(id.name()).map_or(Ok(&[][..]), |s| s.data());
            data.map(|data| EndianRcSlice::new(Rc::from(data), LittleEndian))
        };
        let tables = gimli::Dwarf::load(section).context("sections of the firmware")?;
        addr2line::Context::from_dwarf(tables).map(Self).map_err(damaged)
    }

    /// The part: that of the innermost function which is not shared.
    ///
    /// # Errors
    ///
    /// If the file's own tables are damaged.
    pub(crate) fn part(&self, address: u64) -> Result<&'static str> {
        let mut part = REST;
        let mut frames = self.0.find_frames(address).skip_all_loads().map_err(damaged)?;
        while let Some(frame) = frames.next().map_err(damaged)? {
            let file = frame.location.and_then(|l| l.file).unwrap_or_default();
            let is = |paths: &[&str]| paths.iter().any(|p| file.contains(p));
            if let Some((name, _)) = PARTS.iter().find(|(_, paths)| is(paths)) {
                return Ok(name);
            }
            if is(SHARED.1) {
                part = SHARED.0;
            }
        }
        Ok(part)
    }
}

fn damaged(error: gimli::Error) -> anyhow::Error {
    anyhow!("line tables of the firmware: {error}")
}
