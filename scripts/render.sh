#!/bin/sh
# Renders: `scripts/render.sh` draws the showcase, `scripts/render.sh MODEL -o OUT.png ...` whatever you ask for.
# The arguments are those of `specula render`; see `specula render --help`.
set -eu
. "$(dirname -- "$0")/environment.sh"

status=0
"$root/scripts/setup.sh" || status=$?
case $status in
    0) ;;
    1) echo 'render: going on without a driver; the CPU reference renderer draws, more slowly' >&2 ;;
    *) exit "$status" ;;
esac

picture=
if [ $# -eq 0 ]; then
    picture=$root/out/showcase.png
    mkdir -p "$root/out"
    set -- "$root/assets/showcase.glb" --camera 0 --size 1280x960 -o "$picture"
fi
cargo build --release --manifest-path "$root/Cargo.toml"
"$root/target/release/specula" render "$@"
if [ -n "$picture" ]; then
    echo "The picture is $picture"
fi
