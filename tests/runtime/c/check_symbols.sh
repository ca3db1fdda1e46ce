#!/bin/bash
# check_symbols.sh NM LIBRARY LIST HEADER: checks that the library exports exactly the symbols and versions of LIST, and
# that the header declares the same functions. A removed name breaks programs: keep it, or change the SOVERSION.
set -euo pipefail
nm=$1 library=$2 list=$3 header=$4
exported=$("$nm" -D --defined-only --with-symbol-versions "$library" | awk '$2 != "A" { print $3 }' | sort)
if ! diff <(sort "$list") <(printf '%s\n' "$exported") >&2; then
    echo "< is missing in the library; > is not in $list: add it there, and to the next version in exported.map" >&2
    exit 1
fi
diff <(sed 's/@.*//' "$list" | sort) <(tr '\n' ' ' <"$header" | grep -o 'PRT_API prt_status [a-z_]*(\|PRT_API void [a-z_]*(' | grep -o 'prt_[a-z_]*(' | tr -d '(' | sort) >&2
