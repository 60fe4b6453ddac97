#!/bin/sh
# Runs CalculiX on the decks of this folder, keeps what is compared in kept/, and notes all hashes.
# Only after bracket.py or a deck has changed: the kept output is evidence.
set -eu
cd "$(dirname "$0")"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cp ./*.inp "$work"
for kind in c3d4 c3d10; do
    for job in static held free element; do
        (cd "$work" && OMP_NUM_THREADS=1 ccx -i "${kind}_$job" > log)
    done
    cp "$work/${kind}_static.dat" "$work/${kind}_held.dat" "$work/${kind}_free.dat" kept
    cp "$work/${kind}_element.mas" "$work/${kind}_element.sti" "$work/${kind}_element.dof" kept
done
# Its exit code after -v is 201.
ccx -v > kept/version.txt || true
sha256sum bracket.py keep.sh ./*.msh ./*.inp kept/* | sed 's|  \./|  |' > SHA256SUMS
