# Sourced by the other scripts: where the project is, and a private place for the driver's sockets.
# shellcheck shell=sh

# Used by the scripts that source this one.
# shellcheck disable=SC2034
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)

# Vulkan drivers complain on every start when this is unset or not a directory that we may write.
if [ ! -d "${XDG_RUNTIME_DIR:-}" ] || [ ! -w "${XDG_RUNTIME_DIR:-}" ]; then
    XDG_RUNTIME_DIR=$(mktemp -d)
    export XDG_RUNTIME_DIR
    trap 'rm -rf -- "$XDG_RUNTIME_DIR"' EXIT
fi
