#!/usr/bin/env bash
# Tests prtkit. Installs missing packages first.
#   ./test.sh          the gate before every merge: source checks, all unit tests under the address and
#                      undefined-behaviour sanitizers, a short fuzz run, warnings of gcc, clang-tidy over changed files,
#                      unit tests and three pictures of the web page, threads under the thread sanitizer
#   ./test.sh all      everything, before a release and at the end of a feature: also the optimised build with
#                      the long tests, installed packages and fault injection, drivers with ray queries, mutated models,
#                      clang-tidy and the thread sanitizer over everything, all tests of the web page in Chromium
#   ./test.sh STEP...  single steps
set -euo pipefail
cd "$(dirname "$0")"

gate=(look sanitize fuzz warnings tidy web threads)
all=(look sanitize fuzz mutated_models tidy_all threads_all optimised web_all)

look() {
    git ls-files '*.cpp' '*.h' '*.c' '*.comp' '*.frag' '*.glsl' '*.vert' | xargs clang-format --dry-run --Werror
    git ls-files '*.sh' .ci/run | xargs shellcheck
    tests/checks/include_arrows.py .
    tests/checks/sizes.py .
    tests/checks/words.py .
    tests/checks/checks_test.py
}

sanitize() {
    build_and_test sanitize
}

# Uses the build of `sanitize` and the same inputs in every run; docs/fuzzing.md describes longer runs.
fuzz() {
    build_and_test fuzz sanitize
}

# Runs the program on models with one or a few errors, and reads more damaged shipped files than the gate.
mutated_models() {
    build_and_test mutated_models sanitize
    build/sanitize/tests/hostile_tests --gtest_brief=1
}

# gcc checks every source without building it.
warnings() {
    configure warnings
    ninja -C build/warnings -t targets all | sed -n 's/^\(.*\.o\): C\(XX\)\?_COMPILER.*/\1/p' |
        xargs ninja -C build/warnings --quiet
}

# Checks sources that changed since the branch left main; on main itself, sources that changed in the four hours
# before the last commit.
tidy() {
    local base
    base=$(git merge-base HEAD origin/main 2>/dev/null || true)
    if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
        base=$(git rev-list -1 --first-parent --before=$(($(git show -s --format=%ct HEAD) - 14400)) HEAD)
    fi
    run_tidy ${base:+"$base"}
}

tidy_all() {
    run_tidy
}

threads() {
    build_and_test threads
}

threads_all() {
    threads
    cmake --build --preset threads_all
    local program
    for program in runtime_tests c_interface_tests compress_tests; do
        "build/threads/tests/$program" --gtest_filter='*Threads*' | tee build/threads/log
        grep -q '^\[  PASSED  \] [1-9]' build/threads/log
    done
}

optimised() {
    install_page # the loader of the web page reads damaged files
    tests/support/fetch_drivers.sh build/drivers || echo "test.sh: no driver with ray queries was found; their tests are skipped"
    build_and_test check
}

# Needs the build of `sanitize`.
web() {
    PRT_QUALITIES=small,normal check_page sanitize knot 16 '^knot, (small|normal): |^knot: with separate suns|without transfer'
}

# Needs the build of `optimised`.
web_all() {
    check_page check knot,tree 64 ''
    PRT=$PWD/build/check/cli/prt PRTKIT_WEB=$PWD/build/web node runtime/web/test/installed.mjs
}

configure() {
    cmake --preset "$1" >/dev/null
}

# build_and_test PRESET [BUILD]: builds the targets and runs the tests of a preset, in the build of that name or in BUILD.
# Lists skipped tests.
build_and_test() {
    local build=${2-$1}
    configure "$build"
    cmake --build --preset "$1"
    ctest --preset "$1"
    grep -s '^\[  SKIPPED \] .* ms)$' "build/$build/Testing/Temporary/LastTest.log" | sort -u || true
}

run_tidy() {
    configure sanitize
    cmake --build --preset tidy
    tests/checks/tidy_commands.py build/sanitize build/tidy "$@"
    local log=build/tidy/log
    if ! run-clang-tidy -quiet -p build/tidy >"$log" 2>/dev/null; then
        grep -E -A 3 '(warning|error):' "$log" || cat "$log"
        return 1
    fi
}

# check_page BUILD SCENES RAYS CHECKS: runs lint, unit tests and type checks of the web page, and compares its pictures in
# Chromium with those of prt.
check_page() (
    install_page
    npm --silent --prefix runtime/web test
    export PRT=$PWD/build/$1/cli/prt PRT_EXAMPLE_SCENES=$PWD/build/$1/examples/scenes/example_scenes
    export PRTKIT_WEB=$PWD/build/web PRT_SCENES=$2 PRT_RAYS=$3
    rm -rf "$PRTKIT_WEB"
    npm --silent --prefix examples/web run build
    node examples/web/test/e2e.mjs "" "$4"
)

install_page() {
    local folder
    for folder in runtime/web examples/web; do
        npm --silent --prefix $folder install --no-audit --no-fund --no-package-lock
    done
}

# Prints a table of the steps and their times, also after a failure.
times=()
current=
begin=0
line() {
    printf '%-16s %3d:%02d' "$1" $(($2 / 60)) $(($2 % 60))
}
finish_step() {
    [ -z "$current" ] || times+=("$(line "$current" $((SECONDS - begin)))${1-}")
    current=
}
table() {
    finish_step ' failed'
    printf '\n%-16s %6s\n' step min:s
    printf '%s\n' "${times[@]}" "$(line total "$SECONDS")"
}

packages() {
    cmake/install_packages.sh
    npm install --silent --no-audit --no-fund --no-package-lock --prefix build/validator \
        gltf-validator@2.0.0-dev.3.10 ajv@8.17.1 pngjs@7.0.0 >/dev/null
}

known=("${gate[@]}")
for step in "${all[@]}"; do
    [[ " ${known[*]} " == *" $step "* ]] || known+=("$step")
done
case "$*" in
"") steps=("${gate[@]}") ;;
all) steps=("${all[@]}") ;;
*) steps=("$@") ;;
esac
for step in "${steps[@]}"; do
    if [[ ! $step =~ ^[a-z_]+$ || " ${known[*]} " != *" $step "* ]]; then
        echo "test.sh: unknown step '$step'; steps: ${known[*]}" >&2
        exit 2
    fi
done
trap table EXIT
for step in packages "${steps[@]}"; do
    echo "test.sh: $step"
    current=$step
    begin=$SECONDS
    "$step"
    finish_step
done
