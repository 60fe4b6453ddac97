//! Hands on the compiler's version for the report's machine facts, and, for the cache of long
//! cases, the hashes of the sources and the facts of the build.

use std::path::Path;
use std::process::Command;
use std::{env, fs};

#[path = "src/sources.rs"]
mod sources;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let rustc = env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let ask = |question: &str| {
        Command::new(&rustc)
            .arg(question)
            .output()
            .ok()
            .and_then(|output| String::from_utf8(output.stdout).ok())
            .unwrap_or_else(|| "unknown".into())
    };
    println!("cargo:rustc-env=VERIFICATION_RUSTC={}", ask("--version").trim());

    let root = Path::new("..");
    let cases = sources::case_folders(root).expect("the folders of the cases");
    let places = sources::SHARED.map(Into::into).into_iter().chain(cases);
    for path in places.map(|place| root.join(place)).filter(|path| path.exists()) {
        println!("cargo:rerun-if-changed={}", path.display());
    }
    let hashes = sources::read(root).expect("readable sources");
    let list: String = hashes.iter().map(|(path, hash)| format!("{hash} {path}\n")).collect();
    let out = env::var("OUT_DIR").expect("set by cargo");
    fs::write(Path::new(&out).join("sources.txt"), list).expect("a writable build folder");
    let facts = build_facts() + &ask("-vV");
    fs::write(Path::new(&out).join("build.txt"), facts).expect("a writable build folder");
}

/// What else decides the machine code: target, its features, flags and optimisation.
fn build_facts() -> String {
    let names = [
        "TARGET",
        "CARGO_CFG_TARGET_FEATURE",
        "CARGO_ENCODED_RUSTFLAGS",
        "PROFILE",
        "OPT_LEVEL",
        "DEBUG",
    ];
    let fact = |name: &str| format!("{name}={}\n", env::var(name).unwrap_or_default());
    names.map(fact).concat()
}
