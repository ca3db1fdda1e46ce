#!/usr/bin/env bash
# Renders the pictures of README.md, docs/integration.md and docs/viewer.md from the example scenes, with the programs
# of build/release (or of the given folder) and Chromium: docs/images/make.sh [BUILD]
# Bakes remain in build/pictures for the next time: remove them after a change of the baker.
# The pictures of docs/comparison.md come from examples/comparison.
set -euo pipefail
cd "$(dirname "$0")/../.."
images=docs/images build=${1:-build/release}
prt=$build/cli/prt
work=$PWD/build/pictures
mkdir -p "$work"
for folder in runtime/web examples/web; do npm --silent --prefix $folder install --no-audit --no-fund --no-package-lock; done
scenes=$work/scenes
[ -f "$scenes/sky.exr" ] || "$build/examples/scenes/example_scenes" "$scenes" >/dev/null
sky=$scenes/sky.exr

# From a scene of that name: bake with the options that follow, and what is shipped of it.
bake() { [ -f "$work/$2.baked.glb" ] || "$prt" bake "$scenes/$1.glb" -o "$work/$2.baked.glb" "${@:3}" >/dev/null; }
ship() { "$prt" compress "$work/$1.baked.glb" -o "$work/$1.shipped.glb" --preset "$2" >/dev/null; }
render() { "$prt" render "$work/$1.glb" --lights "$sky" -o "$work/$2.png" --size 840x472 --samples 4 "${@:3}"; }
room_view=(--camera "1.2,1.9,4.2" --look-at "0,1.8,-5" --fov 45)
tree_view=(--camera "1.5,1.7,5.5" --look-at "0,1.9,0")

# The courtyard at noon and at night, lanterns and windows lit.
bake courtyard courtyard --bounces 3 --rays 256 --lamps rays=16
ship courtyard u64
echo '{ "*": 0 }' > "$work/off.json"
court() {
    "$prt" render "$work/courtyard.shipped.glb" --lights "$scenes/$1.exr" -o "$work/court.$1.png" --size 1280x720 --samples 3 \
        --camera 3.9,1.75,4.9 --look-at -1.3,2.75,-6 --fov 46 "${@:2}"
}
court noon --lamp-strengths "$work/off.json"
court night --exposure auto-0.7
node $images/sheet.mjs $images/courtyard.jpg 2 700 "$work"/court.{noon,night}.png

bake knot knot --bounces 1
bake room room --bounces 3 --volume 0.5
bake tree tree --bounces 3
bake terrain terrain --bounces 1
ship knot u32
ship room u32
bake night_room night_room --bounces 3 --rays 256
ship night_room u64
ship tree u64
ship terrain u64
render knot.shipped knot
render tree.shipped tree "${tree_view[@]}"
render room.shipped room "${room_view[@]}" --exposure auto+0.5
render terrain.shipped terrain --camera 1,4.5,11 --look-at 0,2.6,0
render knot.shipped clusters --show clusters
render knot.shipped error --show error --baked "$work/knot.baked.glb"
node $images/sheet.mjs $images/demo.png 2 560 "$work"/{knot,tree,room,terrain,clusters,error}.png

# What each part of the transport adds, each pair at one exposure.
bake room dark --bounces 0
bake knot marble --bounces 1 --subsurface marble --metres-per-unit 0.02
node -e '
  const { readFileSync, writeFileSync } = require("fs");
  const file = readFileSync(process.argv[1]);
  const length = file.readUInt32LE(12);
  const json = JSON.parse(file.subarray(20, 20 + length));
  for (const material of json.materials) delete material.extensions; // leaves that let no light through
  delete json.extensionsUsed;
  file.fill(" ", 20, 20 + length);
  file.write(JSON.stringify(json), 20);
  writeFileSync(process.argv[2], file);' "$scenes/tree.glb" "$scenes/opaque.glb"
bake opaque opaque --bounces 3
# Exposure of the second picture for the first, too.
pair() {
    "$prt" render "$work/$2.baked.glb" --lights "$sky" -o "$work/$2.png" --size 840x600 --json "$work/e.json" "${@:3}" >/dev/null
    local stops
    stops=$(node -p 'JSON.parse(require("fs").readFileSync(process.argv[1])).exposure_stops' "$work/e.json")
    "$prt" render "$work/$1.baked.glb" --lights "$sky" -o "$work/$1.png" --size 840x600 "${@:3}" --exposure "$stops" >/dev/null
    mv "$work/$1.png" "$work/$1.first.png"
    mv "$work/$2.png" "$work/$2.second.png"
}
pair dark room "${room_view[@]}"
pair opaque tree "${tree_view[@]}"
pair knot marble
node $images/sheet.mjs $images/transport.jpg 2 426 \
    "$work"/{dark.first,room.second,opaque.first,tree.second,knot.first,marble.second}.png

# A lightmap of the room, for the viewer.
bake room room.lightmap --texels 512 --texels unwrap --bounces 3
ship room.lightmap u64

# The viewer's tour.
cp examples/viewer/tour.json "$work"
"$build/examples/viewer/prt-viewer" "$work/room.baked.glb" "$work/room.shipped.glb" "$sky" --headless "$work/tour.json"
for picture in "$work"/viewer*.png; do
    node $images/sheet.mjs "$images/$(basename "$picture" .png).jpg" 1 0 "$picture"
done

# The page.
export PRT_SCENES=tree PRT=$PWD/$prt PRT_EXAMPLE_SCENES=$PWD/$build/examples/scenes/example_scenes PRTKIT_WEB=$work/web
npm --silent --prefix examples/web run build
node examples/web/tools/screenshot.mjs "$work/web.png" "?model=tree&quality=1&angle=-40"
node $images/sheet.mjs $images/web.jpg 1 0 "$work/web.png"
