#!/usr/bin/env bash
# Installs what is missing, checks how sources look, builds with warnings as errors by clang and by gcc, and runs all
# tests: under the address and undefined-behaviour sanitizers, there also with inputs that are wrong, what runs in threads
# under the thread sanitizer, and everything optimised, with the web page.
#   ./test.sh [look | sanitize | fuzz | tidy | threads | optimised]...   all, in this order, where none is named
set -euo pipefail
cd "$(dirname "$0")"

look() {
    git ls-files '*.cpp' '*.h' '*.c' '*.comp' '*.frag' '*.glsl' '*.vert' | xargs clang-format --dry-run --Werror
    git ls-files '*.sh' .ci/run | xargs shellcheck
}

sanitize() {
    build_and_test sanitize
}

# A bounded number of fuzzed and mutated inputs, in the build of `sanitize`; docs/fuzzing.md says how to run more.
fuzz() {
    cmake --preset sanitize >/dev/null
    cmake --build --preset fuzz
    ctest --preset fuzz
}

# Over the joined sources of `sanitize`, whose headers are then read once for many sources. Tests are left to two
# compilers' warnings: reading them took as long as all others.
tidy() {
    cmake --preset sanitize >/dev/null
    local log=build/tidy.log
    if ! run-clang-tidy -quiet -p build/sanitize '^(?!.*/tests/)' >"$log" 2>/dev/null; then
        grep -E -A 3 '(warning|error):' "$log"
        return 1
    fi
}

threads() {
    build_and_test tsan
}

optimised() {
    tests/support/fetch_drivers.sh build/drivers || echo "test.sh: no driver with ray queries: tests of them are skipped"
    cmake --preset check >/dev/null
    cmake --build --preset check
    # The web page: lint, units, types, and its pictures in Chromium against those of prt.
    local web=(npm --silent --prefix examples/web)
    "${web[@]}" install --no-audit --no-fund --no-package-lock
    "${web[@]}" test
    (
        export PRT=$PWD/build/check/cli/prt PRT_EXAMPLE_SCENES=$PWD/build/check/examples/scenes/example_scenes
        export PRTKIT_WEB=$PWD/build/web PRT_RAYS=64 PRT_SCENES=knot,tree
        rm -rf "$PRTKIT_WEB"
        "${web[@]}" run build
        node examples/web/test/e2e.mjs
        node examples/web/test/installed.mjs
    )
    ctest --preset check
}

build_and_test() {
    cmake --preset "$1" >/dev/null
    cmake --build --preset "$1"
    ctest --preset "$1"
}

cmake/install_packages.sh
npm install --silent --no-audit --no-fund --no-package-lock --prefix build/validator gltf-validator@2.0.0-dev.3.10 ajv@8.17.1 pngjs@7.0.0 >/dev/null
[ $# -gt 0 ] || set -- look sanitize fuzz tidy threads optimised
for step in "$@"; do
    case "$step" in
        look | sanitize | fuzz | tidy | threads | optimised) ;;
        *) echo "test.sh: there is no step '$step'" >&2; exit 2 ;;
    esac
    echo "test.sh: $step, after $((SECONDS / 60)) min $((SECONDS % 60)) s"
    "$step"
done
