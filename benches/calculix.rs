//! Seconds per element and explicit step, here and in CalculiX, on the same linear mesh in one run.
//!
//! Needs `ccx` on the path (Debian: calculix-ccx); says so and ends where there is none. CalculiX
//! chooses its own step, so the first run prints every increment to learn it; then the time of 80
//! increments is the difference of the least times of two runs that print nothing in between, one thread each.

mod common;
#[path = "common/steel.rs"]
mod steel;

use bearing_dynamics::mesh::write::write_abaqus;
use common::{cube, least};
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::Instant;
use steel::solid;

/// Wanted; a busy machine must not fail it, a regression must.
const WANTED: f64 = 80.0;
const LEAST: f64 = 60.0;

/// Increments that are timed, and of the shorter run.
const TIMED: f64 = 80.0;
const BEFORE: f64 = 5.5;
const ROUNDS: usize = 4;

/// Pulls one node for `period` seconds; whole seconds of the program, and its `.dat`.
fn calculix(folder: &Path, nonlinear: bool, period: f64, print_every: usize) -> (f64, String) {
    let kind = if nonlinear { ", NLGEOM" } else { "" };
    // First increment, period, least increment (mass is scaled below it), largest increment.
    let deck = format!(
        "*INCLUDE, INPUT=mesh.inp\n*NSET, NSET=one\n1\n*MATERIAL, NAME=steel\n*ELASTIC\n2.1e11, 0.3\n\
         *DENSITY\n7800.\n*SOLID SECTION, ELSET=all_elements, MATERIAL=steel\n*STEP{kind}, INC=1000000\n\
         *DYNAMIC, EXPLICIT\n1e-8, {period:e}, 1e-12, 1e-4\n*CLOAD\none, 1, 1000.\n\
         *NODE PRINT, NSET=one, FREQUENCY={print_every}\nU\n*END STEP\n"
    );
    fs::write(folder.join("run.inp"), deck).expect("a deck");
    let start = Instant::now();
    let output = Command::new("ccx")
        .args(["-i", "run"])
        .current_dir(folder)
        .env("OMP_NUM_THREADS", "1")
        .output()
        .expect("ccx starts");
    let seconds = start.elapsed().as_secs_f64();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("Job finished"), "{said}");
    (seconds, fs::read_to_string(folder.join("run.dat")).expect("its output"))
}

/// Times printed in a `.dat`, s.
fn times(dat: &str) -> Vec<f64> {
    let after = |line: &str| line.rsplit_once("time")?.1.trim().parse().ok();
    dat.lines().filter_map(after).collect()
}

fn main() {
    let version = match Command::new("ccx").arg("-v").output() {
        Ok(output) => String::from_utf8_lossy(&output.stdout).trim().to_string(),
        Err(error) => {
            println!("no ccx to compare with: {error}");
            return;
        }
    };
    let mesh = cube(15);
    let count = mesh.elements.len() as f64;
    let folder = std::env::temp_dir().join(format!("calculix-bench-{}", std::process::id()));
    fs::create_dir(&folder).expect("a temporary folder");
    fs::write(folder.join("mesh.inp"), write_abaqus(&mesh).expect("plain names")).expect("a mesh");

    let mut solid = solid(&mesh);
    let mut ours = f64::INFINITY;
    let mut measure_ours = || {
        ours = ours.min(least(6, 300, |n| {
            (0..n).for_each(|_| solid.step(|_, _, _| {}).expect("stable"));
        }));
        ours
    };
    println!("CalculiX: \"{version}\"; {count} linear tetrahedra, {} nodes", mesh.nodes.len());
    let step = {
        let printed = times(&calculix(&folder, true, 1e-6, 1).1);
        let step = printed[0];
        let alike = |pair: &[f64]| (pair[1] - pair[0] - step).abs() < 1e-4 * step;
        let constant = printed.windows(2).rev().skip(1).all(alike);
        assert!(printed.len() > 3 && constant, "increments are not all alike: {printed:?}");
        step
    };
    // Short and long runs, with large displacements and without; in turn, so that all see the same
    // machine.
    let mut least = [[f64::INFINITY; 2]; 2];
    for _ in 0..ROUNDS {
        for (nonlinear, least) in [true, false].into_iter().zip(&mut least) {
            measure_ours();
            for (increments, least) in [BEFORE, BEFORE + TIMED].into_iter().zip(least) {
                *least = least.min(calculix(&folder, nonlinear, increments * step, 1_000_000).0);
            }
        }
    }
    let ours = measure_ours();
    println!("here: {:.3e} s per element and step ({:.1} M/s)", ours / count, count / ours * 1e-6);
    let names = ["large displacements (NLGEOM)", "small displacements"];
    let ratios = least.map(|[short, long]| (long - short) / TIMED / ours);
    for (name, ratio) in names.into_iter().zip(ratios) {
        println!(
            "CalculiX, {name}: {:.3e} s per element and step ({:.2} M/s), {ratio:.0} times ours",
            ratio * ours / count,
            count / (ratio * ours) * 1e-6,
        );
    }
    fs::remove_dir_all(&folder).expect("the temporary folder goes");
    let held = ratios[0] >= LEAST;
    if !held {
        eprintln!("wanted {WANTED} times CalculiX with large displacements, at least {LEAST}");
        std::process::exit(1);
    }
}
