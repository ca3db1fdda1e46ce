#!/usr/bin/env bash
# Installs what is missing, checks the formatting, builds with warnings as errors, and runs all tests: first under the
# address and undefined-behaviour sanitizers, then optimised.
set -euo pipefail
cd "$(dirname "$0")"
cmake/install_packages.sh
git ls-files '*.cpp' '*.h' | grep -v '^shaders/' | xargs clang-format --dry-run --Werror
npm install --silent --no-audit --no-fund --no-package-lock --prefix build/validator gltf-validator@2.0.0-dev.3.10 >/dev/null
cmake --preset sanitize >/dev/null
cmake --build --preset sanitize
ctest --preset sanitize
cmake --preset dev >/dev/null
cmake --build --preset dev
# The web page: units, types, and its pictures in Chromium against those of prt.
web=(npm --silent --prefix examples/web)
"${web[@]}" install --no-audit --no-fund --no-package-lock
"${web[@]}" test
export PRT=$PWD/build/dev/cli/prt PRT_EXAMPLE_SCENES=$PWD/build/dev/examples/scenes/example_scenes
export PRTKIT_WEB=$PWD/build/web PRT_RAYS=64 PRT_SCENES=knot,tree
rm -rf "$PRTKIT_WEB"
"${web[@]}" run build
node examples/web/test/e2e.mjs
ctest --preset dev
