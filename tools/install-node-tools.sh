#!/usr/bin/env bash
# Installs the Khronos glTF validator that `bolt-author validate` runs, in the version of tools/gltf-validator/package-lock.json.
# Needs the npm registry on the first run only.
set -euo pipefail
cd "$(dirname "$0")/gltf-validator"
required=$(sed -n 's/.*"gltf-validator": "\(.*\)".*/\1/p' package.json)
installed=$(sed -n 's/^ *"version": "\(.*\)".*/\1/p' node_modules/gltf-validator/package.json 2>/dev/null || true)
[[ $installed != "$required" ]] || exit 0
if ! command -v npm >/dev/null; then
    echo "npm: not found (Debian package npm); the Khronos glTF validator is not installed" >&2
    exit 1
fi
echo "Installing: gltf-validator $required"
npm ci --no-audit --no-fund --loglevel=error
