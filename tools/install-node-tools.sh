#!/usr/bin/env bash
# Installs the Khronos glTF validator that `bolt-author validate` runs, as tools/gltf-validator/package-lock.json has it:
# from the npm registry the first time, without a network ever after.
set -euo pipefail
cd "$(dirname "$0")/gltf-validator"
wanted=$(sed -n 's/.*"gltf-validator": "\(.*\)".*/\1/p' package.json)
there=$(sed -n 's/^ *"version": "\(.*\)".*/\1/p' node_modules/gltf-validator/package.json 2>/dev/null || true)
[[ $there != "$wanted" ]] || exit 0
if ! command -v npm >/dev/null; then
    echo "npm is not there (Debian: npm), so the Khronos glTF validator is left out" >&2
    exit 1
fi
echo "Installing: gltf-validator $wanted"
npm ci --no-audit --no-fund --loglevel=error
