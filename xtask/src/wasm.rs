//! The npm package: modules compiled, glue generated, optimised, laid out in `wasm/pkg/`, weighed.

use core::hash::{Hash, Hasher};
use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use wasm_bindgen_cli_support::Bindgen;

use crate::report::Step;
use crate::toolchain::Toolchain;
use crate::{npm, process, report, sizes, workspace};

/// The target of all modules.
pub(crate) const TARGET: &str = "wasm32-unknown-unknown";
/// Changed when the layout changes, so that packages laid out by an older version are made again.
const LAYOUT: u32 = 2;
/// Leaves no room for `relaxed-simd`, whose results depend on the machine.
const SIMD: &str = "-Ctarget-feature=+simd128";

/// A modest inliner: 3 of 60 kB gzipped, and no slower, since what kernels need says `inline(always)`.
const INLINING: &str = "-Cllvm-args=-inline-threshold=75";

/// Modules that share a folder.
struct Package {
    modules: &'static [Module],
    /// Its folder below `wasm/`.
    folder: &'static str,
}

/// What users get.
const SHIPPED: Package = Package { modules: &MODULES, folder: "pkg" };
/// What `wasm/bench.mjs` needs besides.
const BENCH: Package = Package { modules: &BENCH_MODULES, folder: "pkg-bench" };

/// One module to compile.
struct Module {
    /// Crate, and its name as a file.
    package: &'static str,
    library: &'static str,
    /// Own folder of build products: cargo would else rebuild everything on each change of flags.
    flavor: &'static str,
    flags: &'static [&'static str],
    features: &'static [&'static str],
    /// Name of the glue, and the place of both files inside the package.
    glue: &'static str,
    wasm: &'static str,
}

/// Both builds of the runtime share one glue; the baker is loaded only by those who want it.
const MODULES: [Module; 3] = [
    Module {
        package: "sinew-wasm",
        library: "sinew_wasm",
        flavor: "wasm-scalar",
        flags: &[],
        features: &[],
        glue: "sinew",
        wasm: "sinew_scalar_bg.wasm",
    },
    Module {
        package: "sinew-wasm",
        library: "sinew_wasm",
        flavor: "wasm-simd",
        flags: &[SIMD],
        features: &[],
        glue: "sinew",
        wasm: "sinew_simd_bg.wasm",
    },
    Module {
        package: "sinew-wasm-bake",
        library: "sinew_wasm_bake",
        flavor: "wasm-scalar",
        flags: &[],
        features: &[],
        glue: "bake/bake",
        wasm: "bake/bake_bg.wasm",
    },
];

/// The runtime with a face for single stages.
const BENCH_MODULES: [Module; 2] =
    [Module { features: &["bench"], ..MODULES[0] }, Module { features: &["bench"], ..MODULES[1] }];

/// `cargo xtask wasm`: builds the package and checks its size.
///
/// # Errors
///
/// If a step fails, the two runtimes need different glue, or a size limit is exceeded.
pub(crate) fn run() -> Result<()> {
    build()?;
    sizes::check(&workspace::root().join("wasm"))
}

/// Builds the package unless it is up to date.
///
/// # Errors
///
/// As [`run`], sizes aside.
pub(crate) fn build() -> Result<()> {
    build_package(&SHIPPED)
}

/// Builds the package and what measuring it needs.
///
/// # Errors
///
/// As [`build`].
pub(crate) fn build_bench() -> Result<()> {
    build()?;
    build_package(&BENCH)
}

fn build_package(package: &Package) -> Result<()> {
    let toolchain = Toolchain::for_target(TARGET)?;
    let raw = package.modules.iter().map(|m| compile(m, toolchain)).collect::<Result<Vec<_>>>()?;
    let optimizer = optimizer();
    let place = workspace::root().join("wasm").join(package.folder);
    let stamp = stamp(&raw, optimizer.as_deref())?;
    if fs::read_to_string(place.join(".stamp")).is_ok_and(|old| old == stamp) {
        return Ok(());
    }
    let fresh = workspace::root().join("wasm/pkg.new");
    empty(&fresh)?;
    for (module, raw) in package.modules.iter().zip(&raw) {
        // The runtime is given its module by the caller, who knows whether SIMD is there.
        let by_caller = package.modules.iter().filter(|m| m.glue == module.glue).count() > 1;
        lay_out(module, by_caller, raw, optimizer.as_deref(), &fresh)?;
    }
    fs::write(fresh.join(".stamp"), stamp)?;
    // Whole or not at all: a page being served never sees half a package for long.
    if place.exists() {
        fs::remove_dir_all(&place)?;
    }
    fs::rename(&fresh, &place)
        .with_context(|| format!("cannot move the finished package to wasm/{}", package.folder))
}

/// Compiles one module and returns where it lies.
fn compile(module: &Module, toolchain: Toolchain) -> Result<PathBuf> {
    let target_dir = workspace::target_dir().join(module.flavor);
    let mut flags: Vec<String> = module.flags.iter().map(ToString::to_string).collect();
    flags.extend(remapped_paths());
    flags.push(INLINING.to_owned());
    let mut cargo = toolchain.cargo("build", TARGET);
    cargo
        .args(["--profile", "wasm", "--package", module.package, "--features", &module.features.join(",")])
        .arg("--target-dir")
        .arg(&target_dir)
        .env("CARGO_ENCODED_RUSTFLAGS", flags.join("\x1f"));
    process::run(&format!("compile {} ({})", module.package, module.flavor), &mut cargo)?;
    Ok(target_dir.join(TARGET).join("wasm").join(module.library).with_extension("wasm"))
}

/// Panic messages name source files: without the builder's folders, the bytes are the same everywhere.
fn remapped_paths() -> Vec<String> {
    let home = |variable: &str, folder: &str| {
        let set = std::env::var_os(variable).map(PathBuf::from);
        set.or_else(|| std::env::home_dir().map(|home| home.join(folder)))
    };
    let places = [
        (Some(workspace::root()), "sinew"),
        (home("CARGO_HOME", ".cargo").map(|cargo| cargo.join("registry/src")), "registry"),
    ];
    let known = places.into_iter().filter_map(|(path, name)| Some((path?, name)));
    known.map(|(path, name)| format!("--remap-path-prefix={}={name}", path.display())).collect()
}

/// npm's `wasm-opt`, or `None` with a remark where there is no npm.
fn optimizer() -> Option<PathBuf> {
    match npm::ready("wasm") {
        Ok(()) => Some(workspace::root().join("wasm/node_modules/binaryen/bin/wasm-opt")),
        Err(error) => {
            report::note(format!("   without wasm-opt, modules are about a quarter larger: {error}"));
            None
        }
    }
}

/// A text that changes when the package must be made again.
fn stamp(raw: &[PathBuf], optimizer: Option<&Path>) -> Result<String> {
    let mut hasher = DefaultHasher::new();
    LAYOUT.hash(&mut hasher);
    for path in raw {
        fs::read(path).with_context(|| format!("cannot read {}", path.display()))?.hash(&mut hasher);
    }
    if optimizer.is_some() {
        // Its version stands there.
        fs::read(workspace::root().join("wasm/package-lock.json"))?.hash(&mut hasher);
    }
    Ok(format!("{:016x}", hasher.finish()))
}

/// Generates glue for a module and puts both where the package has them.
fn lay_out(
    module: &Module,
    by_caller: bool,
    raw: &Path,
    optimizer: Option<&Path>,
    package: &Path,
) -> Result<()> {
    let step = Step::start(format!("glue and wasm-opt for {}", module.wasm));
    let scratch = package.join(".scratch");
    empty(&scratch)?;
    let name = module.glue.rsplit('/').next().unwrap_or(module.glue);
    Bindgen::new()
        .input_path(raw)
        .out_name(name)
        .typescript(true)
        .remove_name_section(true)
        .remove_producers_section(true)
        .omit_default_module_path(by_caller)
        .web(true)?
        .generate(&scratch)
        .with_context(|| format!("wasm-bindgen on {}", raw.display()))?;
    for extension in ["js", "d.ts"] {
        let mut generated = fs::read_to_string(scratch.join(format!("{name}.{extension}")))?;
        if extension == "js" {
            generated = without_doc_comments(&generated);
        }
        place_glue(&package.join(format!("{}.{extension}", module.glue)), generated.as_bytes())?;
    }
    let wasm = scratch.join(format!("{name}_bg.wasm"));
    let placed = package.join(module.wasm);
    match optimizer {
        Some(tool) => optimize(&step, tool, &wasm, &placed)?,
        None => fs::rename(&wasm, &placed)?,
    }
    fs::remove_dir_all(&scratch)?;
    step.done();
    Ok(())
}

/// Glue without the comments that its declarations repeat: a third of it, gzipped.
fn without_doc_comments(glue: &str) -> String {
    let code = |line: &&str| !["/**", "* ", "*/"].iter().any(|start| line.trim_start().starts_with(start));
    glue.lines().filter(|line| code(line) && line.trim() != "*").map(|line| format!("{line}\n")).collect()
}

/// Writes the glue, or checks that it is what another build needed too.
fn place_glue(path: &Path, generated: &[u8]) -> Result<()> {
    if let Some(dir) = path.parent() {
        fs::create_dir_all(dir)?;
    }
    match fs::read(path) {
        Ok(shared) if shared == generated => Ok(()),
        Ok(_) => bail!(
            "the scalar and the SIMD build need different {}: what crosses to JavaScript must not depend on \
             cfg(target_feature), nor pass closures (their names carry the flags)",
            path.file_name().unwrap_or_default().display()
        ),
        Err(_) => fs::write(path, generated).with_context(|| format!("cannot write {}", path.display())),
    }
}

/// `wasm-opt -O3`: it reads the permitted features from the module, and never reorders float operations.
fn optimize(step: &Step, tool: &Path, from: &Path, to: &Path) -> Result<()> {
    let mut command = process::command("node", &workspace::root());
    command.arg(tool).arg("-O3").arg(from).arg("-o").arg(to);
    let (status, text) = process::stream(step, &mut command)?;
    if !status.success() {
        bail!("{}: {status}\n{}", process::shown(&command), process::tail(&text));
    }
    Ok(())
}

/// Makes an empty folder.
fn empty(dir: &Path) -> Result<()> {
    if dir.exists() {
        fs::remove_dir_all(dir)?;
    }
    fs::create_dir_all(dir).with_context(|| format!("cannot create {}", dir.display()))
}
