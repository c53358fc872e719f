#!/bin/sh
# Measures time and error of all settings on three scenes, draws docs/fig/accuracy-*.svg, and puts the tables into
# docs/accuracy.md between their marks. Two scenes are sample files: SPECULA_SAMPLES names their folder.
# Further arguments go to `specula bench`, such as `--frames 10`.
set -eu
. "$(dirname -- "$0")/environment.sh"
cd "$root"

samples=${SPECULA_SAMPLES:-../shared/samples}
document=docs/accuracy.md
tables=$(mktemp -d)
mkdir -p docs/fig

scripts/setup.sh
# The development profile optimises the dependencies fully and this crate a little: enough, as frames are drawn by the driver.
cargo build --bin specula

# measure NAME MODEL OPTION...
measure() {
    name=$1
    shift
    if [ ! -e "$1" ]; then
        echo "accuracy: $1 is missing; $name keeps its figures" >&2
        return
    fi
    echo "accuracy: $name ..." >&2
    target/debug/specula bench "$@" --quiet --pareto "docs/fig/accuracy-$name.svg" > "$tables/$name"
}

# Puts the table of a scene between its marks.
insert() {
    [ -e "$tables/$1" ] || return 0
    awk -v name="$1" -v table="$tables/$1" '
        $0 == "<!-- end of " name " -->" { inside = 0 }
        !inside { print }
        $0 == "<!-- " name " -->" { inside = 1; while ((getline line < table) > 0) print line }
    ' "$document" > "$tables/document"
    cat "$tables/document" > "$document"
}

measure showcase assets/showcase.glb "$@"
measure helmet "$samples/models/DamagedHelmet.glb" --env "$samples/env/chinese_garden_1k.hdr" "$@"
measure spheres assets/spheres.glb --env "$samples/env/spiaggia_di_mondello_1k.hdr" --size 384x208 "$@"
for name in showcase helmet spheres; do
    insert "$name"
done
rm -rf -- "$tables"
