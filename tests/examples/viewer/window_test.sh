#!/usr/bin/env bash
# Tests the viewer in a window of a virtual display: keys, dragging, sizes, screenshots, exit.
#   window_test.sh VIEWER MODEL SKY
set -euo pipefail
viewer=$1 model=$2 sky=$3
folder=$(mktemp -d)
cd "$folder"
# The server reports the number of its display.
Xvfb -displayfd 3 -screen 0 1024x768x24 -nolisten tcp 3>display 2>server.log &
server=$!
trap 'kill $server 2>/dev/null || true; rm -rf "$folder"' EXIT
for _ in $(seq 100); do [ -s display ] && break; sleep 0.1; done
DISPLAY=:$(cat display)
export DISPLAY

"$viewer" "$model" "$sky" --width 640 --height 360 2>viewer.log &
program=$!
window=$(timeout 60 xdotool search --sync --onlyvisible --name '^prtkit$' | head -1)
xdotool windowfocus --sync "$window"

# Presses a key for a screenshot and waits for file $1.
screenshot() {
    xdotool key p
    for _ in $(seq 200); do [ -s "$1" ] && return; sleep 0.1; done
    echo "no $1"; cat viewer.log; exit 1
}
# Width and height in the header of a PNG.
size() { od -An -tu1 -j16 -N8 "$1" | awk '{ print $3 * 256 + $4 "x" $7 * 256 + $8 }'; }

sleep 1
screenshot prtkit-1.png
xdotool mousemove 500 200 mousedown 1 mousemove 560 240 mousemove 600 260 mouseup 1 # rotate
xdotool mousemove 500 200 click 4                                                   # nearer
xdotool key d key d key w key h key h key Tab key Tab key g
screenshot prtkit-2.png
if cmp -s prtkit-1.png prtkit-2.png; then echo "the picture did not change"; exit 1; fi
[ "$(size prtkit-1.png)" = 640x360 ]
xdotool windowsize --sync "$window" 400 300
sleep 0.5
screenshot prtkit-3.png
[ "$(size prtkit-3.png)" = 400x300 ]
xdotool windowsize --sync "$window" 1 1
sleep 0.3
xdotool windowsize --sync "$window" 640 360
xdotool key q
for _ in $(seq 100); do kill -0 $program 2>/dev/null || break; sleep 0.1; done
wait $program
[ ! -s viewer.log ] || { cat viewer.log; exit 1; }

# Without a display it prints a one-line error.
status=0
env -u DISPLAY -u WAYLAND_DISPLAY "$viewer" 2>message || status=$?
[ $status = 1 ] && [ "$(wc -l <message)" = 1 ] && grep -q -- --headless message
echo "the window works"
