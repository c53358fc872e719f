#!/bin/sh
# Everything a change must pass. With CI=true a test that misses its input fails instead of being skipped.
set -eu
. "$(dirname -- "$0")/environment.sh"
cd "$root"

scripts/setup.sh window
cargo fmt --check
cargo clippy --workspace --all-targets -- -D warnings
cargo test --workspace
RUSTDOCFLAGS=-Dwarnings cargo doc --workspace --no-deps
