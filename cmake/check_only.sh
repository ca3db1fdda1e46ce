#!/bin/sh
# Compiler launcher of the preset `warnings`: runs the compiler's checks on a source and writes an empty object, so that
# the build system knows what is checked. Precompiled headers are compiled.
set -eu
output=
previous=
for argument; do
    if [ "$previous" = -o ]; then output=$argument; fi
    previous=$argument
done
case $output in
*.o)
    "$@" -fsyntax-only
    : >"$output"
    ;;
*) exec "$@" ;;
esac
