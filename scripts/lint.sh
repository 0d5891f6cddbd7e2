#!/usr/bin/env bash
# Checks the format of the C++ sources, clang-tidy's findings and the shell scripts.
# Usage: scripts/lint.sh           check; needs build/compile_commands.json (make lint sees to it)
#        scripts/lint.sh --fix     only format the C++ sources
set -euo pipefail
cd "$(dirname "$0")/.."

# New files count before they are added to git; deleted ones do not.
sources() {
    git ls-files --cached --others --exclude-standard -- "$@" | sort -u |
        while IFS= read -r file; do if [ -f "$file" ]; then echo "$file"; fi; done
}
mapfile -t formatted < <(sources '*.cpp' '*.hpp')
mapfile -t scripts < <(sources '*.sh' .ci/run)

if [ "${1:-}" = --fix ]; then
    clang-format-14 -i "${formatted[@]}"
    exit
fi

echo "Format of ${#formatted[@]} files"
clang-format-14 --dry-run --Werror "${formatted[@]}"

echo "Shell scripts"
shellcheck "${scripts[@]}"

# Tests are left out: the macros of GoogleTest set off most of the checks.
mapfile -t checked < <(sources 'src/*.cpp' 'app/*.cpp' 'bench/*.cpp' 'examples/*.cpp')
echo "clang-tidy on ${#checked[@]} files"
findings=$(mktemp)
trap 'rm -f "$findings"' EXIT
# What it counts in system headers is left out, and what it finds comes last, where one sees it.
if ! printf '%s\0' "${checked[@]}" |
    xargs -0 -n 1 -P "$(nproc)" clang-tidy-14 -p build --quiet --extra-arg=-Wno-unknown-warning-option \
        >"$findings" 2>/dev/null; then
    cat "$findings"
    grep -E ' (error|warning): ' "$findings" | sort -u
    echo "clang-tidy: findings above" >&2
    exit 1
fi
