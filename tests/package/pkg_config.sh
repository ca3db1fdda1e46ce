#!/usr/bin/env bash
# Builds and runs programs in C and C++ with the flags of pkg-config, and links every module:
# CC CXX LIBDIR TESTS MODEL SKY
set -euo pipefail
cc=$1 cxx=$2 libdir=$3 tests=$4 model=$5 sky=$6
export PKG_CONFIG_PATH=$libdir/pkgconfig
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# build OUTPUT SOURCE MODULE...
build() {
    local flags
    read -ra flags <<<"$(pkg-config --cflags --libs "${@:3}")"
    $cxx -std=c++20 "$2" -o "$folder/$1" "${flags[@]}"
}
read -ra flags <<<"$(pkg-config --cflags --libs prtkit-c)"
$cc -std=c11 -D_POSIX_C_SOURCE=200809L "$tests/runtime/c/c_test.c" -o "$folder/c" "${flags[@]}" -lm
LD_LIBRARY_PATH=$libdir "$folder/c" "$model" "$sky"
build bare "$tests/package/bare.cpp" prtkit
"$folder/bare"
build loader "$tests/package/loader/main.cpp" prtkit-load prtkit-shader
"$folder/loader" "$model"
build user "$tests/package/main.cpp" prtkit-compress prtkit-bake prtkit-gl
"$folder/user"
for module in "$libdir"/pkgconfig/prtkit*.pc; do # checks that all other libraries exist
    build module "$tests/package/bare.cpp" "$(basename "$module" .pc)" prtkit
done
