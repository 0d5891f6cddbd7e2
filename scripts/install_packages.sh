#!/usr/bin/env bash
# Installs the Debian packages of the groups named (of scripts/packages.txt) that are missing.
# Usage: scripts/install_packages.sh GROUP...     groups: build test bench docs lint
set -euo pipefail
cd "$(dirname "$0")"

fail() {
    echo "install_packages.sh: $*" >&2
    exit 1
}

wanted=()
for group in "$@"; do
    mapfile -t packages < <(awk -v group="$group" '$1 == group { print $2 }' packages.txt)
    [ ${#packages[@]} -gt 0 ] || fail "there is no group '$group' in scripts/packages.txt."
    wanted+=("${packages[@]}")
done
[ ${#wanted[@]} -gt 0 ] || fail "name at least one group of scripts/packages.txt."

command -v apt-get >/dev/null ||
    fail "this is not Debian. Install what scripts/packages.txt names by other means, then run CMake (see CONTRIBUTING.md)."

# dpkg-query fails where it does not know a package at all; what it prints of the others is right.
# A package may bring another one: nodejs from elsewhere than Debian says that it provides npm.
installed=$(dpkg-query --show --showformat='${db:Status-Status} ${Package}\n' "${wanted[@]}" 2>/dev/null || true)
provided=$(dpkg-query --show --showformat='${Provides}\n' "${wanted[@]}" 2>/dev/null | tr -s ', ' '\n' || true)
missing=()
for package in "${wanted[@]}"; do
    grep -qxF "installed $package" <<<"$installed" || grep -qxF "$package" <<<"$provided" || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
        fail "these packages are missing, and only root can install them: ${missing[*]}"
    as_root=(sudo)
fi
echo "Installing ${missing[*]}"
# Errors and warnings go to standard error; what the tools say besides is hundreds of lines.
"${as_root[@]}" apt-get update --quiet=2 >/dev/null
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install --yes --quiet=2 --no-install-recommends "${missing[@]}" >/dev/null
