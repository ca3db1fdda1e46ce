#!/usr/bin/env bash
# fetch_drivers.sh FOLDER: unpacks newer graphics drivers than those of the system for tests, without installing
# them. Takes them from Debian's backports, with the machine's Debian sources. FOLDER then contains
#   lavapipe.json   a software device for Vulkan with ray queries
#   radeon.json     AMD's driver, which also compiles for absent chips (RADV_FORCE_FAMILY)
#   lib             their libraries, for LD_LIBRARY_PATH
set -euo pipefail
mkdir -p "${1:?folder}"
folder=$(cd "$1" && pwd)
if [ -f "$folder/lavapipe.json" ]; then exit; fi
address=$(cat /etc/apt/sources.list /etc/apt/sources.list.d/*.sources 2>/dev/null |
    awk '!found && /^URIs:|^deb / { print $2; found = 1 }' || true)
# shellcheck source=/dev/null
suite=$(. /etc/os-release && echo "${VERSION_CODENAME:-}")
if [ -z "$address" ] || [ -z "$suite" ]; then
    echo "fetch_drivers.sh: this machine has no Debian sources" >&2
    exit 1
fi
printf 'deb %s %s main\ndeb %s %s-backports main\n' "$address" "$suite" "$address" "$suite" >"$folder/sources.list"
mkdir -p "$folder/lists/partial" "$folder/packages" "$folder/root"
apt=(apt-get -qq -o "Dir::Etc::sourcelist=$folder/sources.list" -o Dir::Etc::sourceparts=/dev/null
    -o "Dir::State::lists=$folder/lists")
"${apt[@]}" update
(
    cd "$folder/packages"
    "${apt[@]}" -o APT::Sandbox::User=root download {mesa-vulkan-drivers,mesa-libgallium,libdrm2,libdrm-amdgpu1}/"$suite"-backports
)
for package in "$folder"/packages/*.deb; do dpkg -x "$package" "$folder/root"; done
library=$folder/root/usr/lib/$(gcc -print-multiarch)
ln -sfn "$library" "$folder/lib"
for driver in lvp:lavapipe radeon:radeon; do
    sed "s#\"library_path\": *\"[^\"]*\"#\"library_path\": \"$library/libvulkan_${driver%%:*}.so\"#" \
        "$folder"/root/usr/share/vulkan/icd.d/"${driver%%:*}"_icd*.json >"$folder/${driver##*:}.json"
done
rm -rf "$folder/packages" "$folder/lists"
