"""The example scripts run."""

import os
import pathlib
import subprocess
import sys

import pytest

pytestmark = pytest.mark.skipif("PRTKIT_LONG" not in os.environ, reason="a long test: ./test.sh all")
EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"


def run(script, *arguments):
    command = [sys.executable, str(EXAMPLES / script), *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True, env=os.environ).stdout


def test_error_is_plotted(small_bake, tmp_path):
    pytest.importorskip("matplotlib")
    small_bake.save(tmp_path / "bake.glb")
    output = run("plot_error.py", tmp_path / "bake.glb", "-o", tmp_path / "error.png", "--bytes", 40, 80)
    errors = [float(line.split()[2]) for line in output.splitlines()]
    assert len(errors) == 2 and errors[0] > errors[1] > 0
    assert (tmp_path / "error.png").read_bytes()[:4] == b"\x89PNG"


def test_light_is_found(tmp_path):
    pytest.importorskip("torch")
    lines = ["ply", "format ascii 1.0", "element vertex 8", "property float x", "property float y"]
    lines += ["property float z", "element face 6", "property list uchar int vertex_indices", "end_header"]
    lines += [f"{x} {y} {z}" for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]
    sides = ["0 2 3 1", "4 5 7 6", "0 1 5 4", "2 6 7 3", "0 4 6 2", "1 3 7 5"]
    (tmp_path / "box.ply").write_text("\n".join(lines + ["4 " + side for side in sides]) + "\n")
    output = run("light_scan.py", tmp_path / "box.ply")
    assert float(output.split()[-1]) < 0.05
