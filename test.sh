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
ctest --preset dev
