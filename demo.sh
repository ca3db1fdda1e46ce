#!/usr/bin/env bash
# Installs missing packages, builds the program, and runs bake, compress, render and evaluate on the example scenes in out/;
# the room is first. Then builds the viewer and runs its tour.
set -euo pipefail
cd "$(dirname "$0")"
cmake/install_packages.sh
cmake --preset release >/dev/null
cmake --build --preset release --target prt example_scenes
prt=build/release/cli/prt
mkdir -p out
build/release/examples/scenes/example_scenes out/scenes
minutes() {
    echo "$((SECONDS / 60)) min $((SECONDS % 60)) s"
}
sky=out/scenes/sky.exr

# Arguments: name, bounces, preset of the compressor, camera options. The variables sky, rays (per vertex) and volume
# (metres between probes) override the defaults.
road() {
    local name=$1 bounces=$2 preset=$3
    echo
    $prt bake "out/scenes/$name.glb" -o "out/$name.baked.glb" --bounces "$bounces" --rays "${rays:-1024}" ${volume:+--volume "$volume"}
    $prt compress "out/$name.baked.glb" -o "out/$name.shipped.glb" --preset "$preset"
    look_at "$name" "${@:4}"
}
# Lets `prt make` choose all settings for an error of 3 % over the surface.
made() {
    local name=$1
    echo
    $prt make "out/scenes/$name.glb" -o "out/$name.shipped.glb" --baked "out/$name.baked.glb" --lights "$sky" --max-error 0.03
    budget=1 look_at "$name" "${@:2}"
}
look_at() {
    local name=$1
    $prt render "out/$name.shipped.glb" --env "$sky" -o "out/$name.png" "${@:2}"
    [ -n "${first-}" ] || first="out/$name.png after $(minutes)"
    $prt render "out/$name.shipped.glb" --env "$sky" --rotate 120 -o "out/$name.rotated.png" "${@:2}"
    $prt evaluate "out/$name.baked.glb" "out/$name.shipped.glb" --lights "$sky" ${budget:+--budget} --html "out/$name.html" --json "out/$name.json"
}
volume=0.5 road room inf u32 --camera 1.2,1.9,4.2 --look-at 0,1.8,-5 --fov 45
made knot
road tree inf u64 --camera 1.5,1.7,5.5 --look-at 0,1.9,0
made terrain --camera 1,4.5,11 --look-at 0,2.6,0
rays=256 sky=out/scenes/night.exr road night_room inf u64 --camera 0.6,1.7,2.6 --look-at 0,1.8,-6 --fov 50
# The courtyard, 139 000 vertices: minutes on a few cores.
rays=128 sky=out/scenes/noon.exr road courtyard inf u64 --camera 3.9,1.75,4.9 --look-at -1.3,2.75,-6 --fov 46
echo
# The room again, with light in a lightmap instead of at vertices.
$prt bake out/scenes/room.glb -o out/room.lightmap.baked.glb --size 256 --unwrap --bounces inf --rays 1024
$prt compress out/room.lightmap.baked.glb -o out/room.lightmap.shipped.glb --preset u64
$prt render out/room.lightmap.shipped.glb --env "$sky" -o out/room.lightmap.png --camera 1.2,1.9,4.2 --look-at 0,1.8,-5 --fov 45
echo
# A forest whose trees share the transfer of three meshes, and a figure that shadows itself.
build/release/examples/scenes/example_scenes out/scenes forest:200
$prt bake out/scenes/forest.glb -o out/forest.baked.glb --instances shared --bounces inf --rays 512
$prt compress out/forest.baked.glb -o out/forest.shipped.glb --clusters 64
$prt render out/forest.shipped.glb --env "$sky" -o out/forest.png --camera 4,3,16 --look-at 0,2,0 --fov 50
$prt lobes out/scenes/figure.glb -o out/figure.lobes.glb
echo
$prt render out/knot.shipped.glb --env "$sky" --show clusters -o out/knot.clusters.png
$prt render out/knot.shipped.glb --env "$sky" --show error --baked out/knot.baked.glb -o out/knot.error.png
echo
cmake --build --preset release
viewer=build/release/examples/viewer/prt-viewer
cp examples/viewer/tour.json out/
$viewer out/room.baked.glb out/room.shipped.glb out/scenes/sky.exr --headless out/tour.json
rm out/tour.json
echo
$prt bench out/scenes/knot.glb --to 256 --most-seconds 2 --html out/bench.html
echo
echo "First picture: $first; total: $(minutes)"
echo "Pictures and reports: out/*.png and out/*.html"
echo "Interactive viewer: $viewer out/room.baked.glb out/room.shipped.glb out/scenes/sky.exr"
