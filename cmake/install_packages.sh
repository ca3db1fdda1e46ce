#!/usr/bin/env bash
# Installs what cmake/packages.txt lists, where it is missing. Needs root (or sudo) only then.
set -euo pipefail
list="$(dirname "$0")/packages.txt"
wanted=()
while IFS= read -r line; do
    line="${line%%#*}"
    case "$line" in
        *:*) command -v "${line%%:*}" >/dev/null || wanted+=("$(echo "${line#*:}" | xargs)") ;;
        *) name="$(echo "$line" | xargs)"; [ -z "$name" ] || wanted+=("$name") ;;
    esac
done <"$list"
missing=()
for package in "${wanted[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0
echo "installing: ${missing[*]}"
sudo=""
[ "$(id -u)" = 0 ] || sudo=sudo
$sudo apt-get update -qq
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
