#!/usr/bin/env bash
# Makes the pictures of the documentation anew with the program (make pictures).
# Usage: scripts/make_pictures.sh PROGRAM MODULES     MODULES: a folder with node_modules of viewer/
set -euo pipefail
program=$(realpath "$1") modules=$(realpath "$2")
cd "$(dirname "$0")/.."
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

for model in examples/*.step; do
    name=$(basename "$model" .step)
    echo "$name"
    "$program" detect "$model" --quiet --png "docs/images/$name.png" --html "$scratch/$name-page.html"
done
pages=()
for name in flange spiral_stair staggered_connector bracket; do pages+=("$scratch/$name-page.html"); done
node tests/browser/shoot.mjs --only desktop-light "$modules" "$scratch" "${pages[@]}"
for page in "${pages[@]}"; do mv "${page%.html}-desktop-light.png" "docs/images/$(basename "$page" .html).png"; done
