//! The configurations: what is built how, and what runs it.

use std::env::consts::ARCH;

/// A way to build the program and to run it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Configuration {
    /// After the name of the processor.
    pub(super) name: &'static str,
    pub(super) machine: Machine,
    /// `RUSTFLAGS`.
    pub(super) flags: &'static str,
    /// Without optimization.
    pub(super) debug: bool,
}

/// What the program runs on.
#[derive(Clone, Copy, Debug)]
pub(super) enum Machine {
    /// This one.
    Here,
    /// Another processor under Linux, emulated.
    Emulated(Processor),
    /// WebAssembly in Node.
    Node,
    /// WebAssembly in Chromium.
    Chromium,
}

/// A processor that QEMU emulates for programs of Linux.
#[derive(Clone, Copy, Debug)]
pub(super) struct Processor {
    /// Of its Rust target.
    pub(super) triple: &'static str,
    /// Of its C compiler, which links, and of its folder under `/usr`.
    pub(super) gnu: &'static str,
    /// QEMU's name of it.
    pub(super) qemu: &'static str,
    /// Debian's packages: linker and C library.
    pub(super) packages: [&'static str; 2],
}

impl Configuration {
    /// Processor and peculiarity.
    pub(super) fn title(&self) -> String {
        match self.machine {
            Machine::Here => format!("{ARCH} {}", self.name),
            Machine::Emulated(processor) => {
                let processor = processor.triple.split('-').next().unwrap_or_default();
                format!("{processor} {}", self.name).trim_end().to_owned()
            }
            Machine::Node | Machine::Chromium => format!("wasm32 {}", self.name),
        }
    }
}

const fn here(name: &'static str, flags: &'static str, debug: bool) -> Configuration {
    Configuration { name, machine: Machine::Here, flags, debug }
}

const fn emulated(name: &'static str, processor: Processor, flags: &'static str) -> Configuration {
    Configuration { name, machine: Machine::Emulated(processor), flags, debug: false }
}

const fn wasm(name: &'static str, machine: Machine, flags: &'static str) -> Configuration {
    Configuration { name, machine, flags, debug: false }
}

/// Flags of the SIMD build of the npm package.
const SIMD128: &str = "-Ctarget-feature=+simd128";

/// All; the first is what the others are compared with.
pub(super) const ALL: [Configuration; 13] = [
    here("release", "", false),
    here("debug", "", true),
    here("native CPU", "-Ctarget-cpu=native", false),
    here("scalar lanes", "--cfg sinew_scalar", false),
    emulated("", I686, ""),
    emulated("", AARCH64, ""),
    emulated("", ARMV7, ""),
    emulated("", RISCV64, ""),
    // AltiVec, which the compiler would use, takes subnormals for zero.
    emulated("big-endian", POWERPC64, "-Ctarget-feature=-altivec"),
    wasm("scalar, Node", Machine::Node, ""),
    wasm("SIMD, Node", Machine::Node, SIMD128),
    wasm("scalar, Chromium", Machine::Chromium, ""),
    wasm("SIMD, Chromium", Machine::Chromium, SIMD128),
];

const I686: Processor = Processor {
    triple: "i686-unknown-linux-gnu",
    gnu: "i686-linux-gnu",
    qemu: "i386",
    packages: ["gcc-i686-linux-gnu", "libc6-dev-i386-cross"],
};
const AARCH64: Processor = Processor {
    triple: "aarch64-unknown-linux-gnu",
    gnu: "aarch64-linux-gnu",
    qemu: "aarch64",
    packages: ["gcc-aarch64-linux-gnu", "libc6-dev-arm64-cross"],
};
const ARMV7: Processor = Processor {
    triple: "armv7-unknown-linux-gnueabihf",
    gnu: "arm-linux-gnueabihf",
    qemu: "arm",
    packages: ["gcc-arm-linux-gnueabihf", "libc6-dev-armhf-cross"],
};
const RISCV64: Processor = Processor {
    triple: "riscv64gc-unknown-linux-gnu",
    gnu: "riscv64-linux-gnu",
    qemu: "riscv64",
    packages: ["gcc-riscv64-linux-gnu", "libc6-dev-riscv64-cross"],
};
const POWERPC64: Processor = Processor {
    triple: "powerpc64-unknown-linux-gnu",
    gnu: "powerpc64-linux-gnu",
    qemu: "ppc64",
    packages: ["gcc-powerpc64-linux-gnu", "libc6-dev-ppc64-cross"],
};
