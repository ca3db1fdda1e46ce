#!/usr/bin/env bash
# Writes the reference of all public headers to build/reference/html. Needs Doxygen (apt-get install doxygen).
set -euo pipefail
cd "$(dirname "$0")/.."
mkdir -p build/reference
headers=$(find runtime bake compress -type d -name include | sort | tr '\n' ' ')
doxygen - <<SETTINGS
PROJECT_NAME = prtkit
OUTPUT_DIRECTORY = build/reference
INPUT = README.md CONTRIBUTING.md CHANGELOG.md docs $headers
FILE_PATTERNS = *.h *.md
RECURSIVE = YES
USE_MDFILE_AS_MAINPAGE = README.md
EXTRACT_ALL = YES
HIDE_UNDOC_RELATIONS = YES
QUIET = YES
WARN_IF_UNDOCUMENTED = NO
GENERATE_LATEX = NO
HAVE_DOT = NO
MACRO_EXPANSION = YES
EXPAND_ONLY_PREDEF = YES
PREDEFINED = PRT_API=
SETTINGS
echo "build/reference/html/index.html"
