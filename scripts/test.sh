#!/bin/sh
# Everything a change must pass. With CI=true a test that misses its input fails instead of being skipped.
set -eu
. "$(dirname -- "$0")/environment.sh"
cd "$root"

# A browser is half a minute that a person need not wait.
if [ "${CI:-}" = true ]; then
    scripts/setup.sh window browser cluster
else
    scripts/setup.sh window
fi
cargo fmt --check
cargo clippy --workspace --all-targets -- -D warnings
# The library as an engine has it.
cargo clippy --no-default-features --lib -- -D warnings
cargo test --workspace
RUSTDOCFLAGS=-Dwarnings cargo doc --workspace --no-deps
