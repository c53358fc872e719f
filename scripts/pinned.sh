#!/bin/sh
# Follows the Dockerfile of docs/ci.md without Docker, in a clean Debian that debootstrap makes; for root, with a network.
#   scripts/pinned.sh PROGRAM FOLDER [ARGUMENT...]
# runs `specula ARGUMENT...` (test suite.toml, unless others are given) on a copy of FOLDER, and ends with its exit code.
set -eu
here=$(cd -- "$(dirname -- "$0")/.." && pwd)
program=$1 folder=$2
shift 2
[ $# -gt 0 ] || set -- test suite.toml
recipe=$(sed -n '/^<!-- pinned -->$/,/^```$/p' "$here/docs/ci.md")
release=$(printf '%s\n' "$recipe" | sed -n 's/^FROM debian:\([a-z]*\)-slim$/\1/p')
root=$(mktemp -d)
chmod 755 "$root"
trap 'rm -rf "$root"' EXIT
debootstrap --variant=minbase "$release" "$root" >"$root.log" || { cat "$root.log" >&2; exit 1; }
rm -f "$root.log"
# As Docker does it.
cp /etc/resolv.conf "$root/etc/resolv.conf"
cp "$program" "$root/usr/local/bin/specula"
cp -rL "$folder" "$root/suite"
printf '%s\n' "$recipe" | sed -n 's/^RUN //p' >"$root/run.sh"
printf '%s\n' "$recipe" | sed -n 's/^ENV //p' | tr ' ' '\n' >"$root/environment"
chroot "$root" sh -eu /run.sh >&2
# shellcheck disable=SC2046
chroot "$root" env -i PATH=/usr/local/bin:/usr/bin:/bin $(cat "$root/environment") sh -c 'cd /suite && specula "$@"' sh "$@"
