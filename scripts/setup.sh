#!/bin/sh
# Checks that the project can be built and that a Vulkan driver is there; installs Mesa's software driver where neither
# a question nor a password stands in the way. Changes nothing else, and nothing at all when all is there.
# Tests use more where it is there, and go without it otherwise: `window` installs an X server without a screen and input for it,
# for those of the viewer, `browser` installs Chromium and GNU parallel, `cluster` installs Slurm, for those of suites.
set -eu

say() { printf '%s\n' "setup: $*" >&2; }

have_vulkan_loader() {
    for file in /usr/lib/libvulkan.so.1 /usr/lib64/libvulkan.so.1 /usr/lib/*/libvulkan.so.1 /usr/local/lib/libvulkan.so.1; do
        [ -e "$file" ] && return 0
    done
    ldconfig -p 2>/dev/null | grep 'libvulkan\.so\.1' >/dev/null
}

# A driver announces itself to the loader by a JSON file in one of these places.
have_vulkan_driver() {
    [ -n "${VK_DRIVER_FILES:-}${VK_ICD_FILENAMES:-}" ] && return 0
    for folder in "${XDG_CONFIG_HOME:-${HOME:-}/.config}" "${XDG_DATA_HOME:-${HOME:-}/.local/share}" \
        /etc /usr/local/etc /usr/local/share /usr/share /run/opengl-driver/share; do
        for file in "$folder"/vulkan/icd.d/*.json; do
            [ -e "$file" ] && return 0
        done
    done
    return 1
}

# Prints what to put before a command to run it as root without being asked, or fails.
root_prefix() {
    if [ "$(id -u)" -eq 0 ]; then
        echo env
    elif sudo -n true 2>/dev/null; then
        echo 'sudo -n env'
    else
        return 1
    fi
}

# The one command that installs a software driver on this system.
install_command() {
    if command -v apt-get >/dev/null; then
        echo 'sudo apt-get install mesa-vulkan-drivers'
    elif command -v dnf >/dev/null; then
        echo 'sudo dnf install mesa-vulkan-drivers'
    elif command -v pacman >/dev/null; then
        echo 'sudo pacman -S vulkan-swrast'
    elif command -v apk >/dev/null; then
        echo 'sudo apk add mesa-vulkan-swrast vulkan-loader'
    elif command -v zypper >/dev/null; then
        echo 'sudo zypper install libvulkan_lvp'
    else
        echo 'install your GPU driver, or Mesa with lavapipe'
    fi
}

# install_with_apt PACKAGE...
install_with_apt() {
    packages=$*
    prefix=$(root_prefix) || return 1
    say "installing $*"
    # The prefix is one or more words by design, and so are the packages. Without a network it should not take long to fail.
    # shellcheck disable=SC2086
    set -- $prefix DEBIAN_FRONTEND=noninteractive apt-get --quiet --quiet -o Acquire::http::Timeout=20 -o Acquire::Retries=1
    # shellcheck disable=SC2086
    "$@" install --yes --no-install-recommends $packages >&2 && return 0
    say 'refreshing the package lists and trying again'
    # shellcheck disable=SC2086
    "$@" update >&2 && "$@" install --yes --no-install-recommends $packages >&2
}

if ! command -v cargo >/dev/null; then
    say 'cargo is missing; install Rust from https://rustup.rs'
    exit 2
fi

# Elsewhere the system's own Metal or Direct3D is used.
[ "$(uname -s)" = Linux ] || exit 0

# install_for_tests COMMAND COMMAND PACKAGE PACKAGE
install_for_tests() {
    { command -v "$1" && command -v "$2"; } >/dev/null && return
    { command -v apt-get >/dev/null && install_with_apt "$3" "$4"; } || say "tests that need $1 or $2 will be skipped"
}

for wanted in "$@"; do
    case $wanted in
    window) install_for_tests Xvfb xdotool xvfb xdotool ;;
    browser) install_for_tests chromium parallel chromium parallel ;;
    cluster) install_for_tests sbatch slurmd slurm-wlm slurm-client ;;
    esac
done

have_vulkan_loader && have_vulkan_driver && exit 0
say 'no Vulkan driver found; Mesa has one that draws on the CPU where there is no GPU'
if command -v apt-get >/dev/null && install_with_apt mesa-vulkan-drivers; then
    exit 0
fi
say "no Vulkan driver could be installed from here; run: $(install_command)"
exit 1
