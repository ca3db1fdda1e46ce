#!/usr/bin/env bash
# Builds and runs a C and a C++ program with the flags of pkg-config: CC CXX LIBDIR TESTS MODEL SKY
set -euo pipefail
cc=$1 cxx=$2 libdir=$3 tests=$4 model=$5 sky=$6
export PKG_CONFIG_PATH=$libdir/pkgconfig
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
read -ra c_flags <<<"$(pkg-config --cflags --libs prtkit-c)"
read -ra cxx_flags <<<"$(pkg-config --cflags --libs prtkit)"
$cc -std=c11 -D_POSIX_C_SOURCE=200809L "$tests/runtime/c/c_test.c" -o "$folder/c" "${c_flags[@]}" -lm
LD_LIBRARY_PATH=$libdir "$folder/c" "$model" "$sky"
$cxx -std=c++20 "$tests/package/bare.cpp" -o "$folder/cpp" "${cxx_flags[@]}"
"$folder/cpp"
