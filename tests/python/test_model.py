"""Models: loading, baking, compressing, evaluating, relighting, drawing."""

import json
import math
import os
import subprocess

import numpy as np
import prtkit
import pytest

SKY = np.zeros((9, 3), np.float32)
SKY[0] = math.sqrt(4 * math.pi)  # white, radiance 1


def program(*arguments):
    """Run prt, whose path is in the environment variable PRT."""
    environment = {name: value for name, value in os.environ.items() if name != "LD_PRELOAD"}
    command = [os.environ["PRT"], *map(str, arguments)]
    return subprocess.run(command, check=True, capture_output=True, text=True, env=environment)


def test_arrays_stay_in_their_order(table):
    vertices, faces = table
    model = prtkit.from_arrays(vertices + [1e5, 0, 0], faces, name="table")
    np.testing.assert_allclose(model.vertices, vertices + [1e5, 0, 0], atol=1e-6)
    np.testing.assert_array_equal(model.faces, faces)
    np.testing.assert_allclose(model.normals[:4], [[0, 1, 0]] * 4, atol=1e-6)
    assert model.content == "scene" and model.order == 0 and model.transfer is None and model.terms == []
    assert math.isclose(
        model.areas.sum(), 4 + 0.5 * np.linalg.norm(np.cross(*(vertices[5:7] - vertices[4]))), rel_tol=1e-5
    )


def test_transfer_is_viewed_without_a_copy(small_bake):
    transfer = small_bake.transfer
    assert transfer.shape == (84, 9 + 27) and transfer.dtype == np.float32
    assert not transfer.flags.writeable and transfer.base is not None
    assert transfer.__array_interface__["data"][0] == small_bake.transfer.__array_interface__["data"][0]
    assert [t["kind"] for t in small_bake.terms] == ["direct", "indirect"]
    assert small_bake.record["bounces"] == 1 and small_bake.figures["device"]


def test_a_view_keeps_its_model(table):
    transfer = prtkit.bake(prtkit.from_arrays(*table), order=2, rays=16, fit="vertex").transfer
    assert np.isfinite(transfer).all()  # the model has no other reference


def test_light_times_transfer_is_radiance(small_bake, random):
    light = random.normal(size=(9, 3)).astype(np.float32)
    direct, indirect = (small_bake.transfer[:, t["columns"]] for t in small_bake.terms)
    expected = direct @ light + np.einsum("pci,ic->pc", indirect.reshape(-1, 3, 9), light)
    np.testing.assert_allclose(prtkit.relight(small_bake, light), expected, atol=1e-5)


def test_suns_are_separate(small_bake):
    sun = prtkit.Sun((0.0, 1.0, 0.0), (math.pi, 0.0, 0.0))
    lit = prtkit.relight(small_bake, prtkit.Light(np.zeros((9, 3), np.float32), (sun,)))
    below = (np.abs(small_bake.vertices[:, 0]) < 0.2) & (np.abs(small_bake.vertices[:, 2] + 0.5) < 0.2)
    top = small_bake.vertices[:, 1] > 0.75
    assert np.all(lit[below & ~top, 0] < 0.5)  # in the shadow of the roof
    np.testing.assert_allclose(lit[top, 0], small_bake.normals[top, 1], atol=0.05)


def test_the_program_writes_the_same_file(table, tmp_path):
    if "PRT" not in os.environ:
        pytest.skip("PRT is not the path of the program")
    scene = tmp_path / "table.glb"
    prtkit.from_arrays(*table, name="table").save(scene)
    program(
        "bake", scene, "-o", tmp_path / "b.glb", "--order", 3, "--rays", 64, "--bounces", 2, "--device", "cpu"
    )
    baked = prtkit.bake(scene, order=3, rays=64, bounces=2, device="cpu")
    assert baked.to_bytes() == (tmp_path / "b.glb").read_bytes()
    program(
        "compress",
        tmp_path / "b.glb",
        "-o",
        tmp_path / "c.glb",
        "--json",
        tmp_path / "c.json",
        "--max-error",
        0.5,
    )
    small = prtkit.compress(baked, max_error=0.5)
    assert small.to_bytes() == (tmp_path / "c.glb").read_bytes()
    assert small.figures["lit_rms"] == json.loads((tmp_path / "c.json").read_text())["lit_rms"]
    program("evaluate", tmp_path / "b.glb", tmp_path / "c.glb", "--json", tmp_path / "e.json")
    theirs, ours = json.loads((tmp_path / "e.json").read_text()), prtkit.evaluate(baked, small)
    assert ours["lights"] == theirs["lights"] and ours["verdict"] == theirs["verdict"]


def test_compressed_models_decode(small_bake, tmp_path):
    small = prtkit.compress(small_bake, clusters=4, components=8, bits=100)
    assert small.content == "compressed" and small.transfer is None
    decoded = prtkit.decode(small)
    error = np.sqrt(np.sum((decoded - small_bake.transfer) ** 2) / np.sum(small_bake.transfer**2))
    assert decoded.shape == small_bake.transfer.shape and error < 0.1
    np.testing.assert_array_equal(prtkit.decode(small_bake), small_bake.transfer)
    report = prtkit.evaluate(small_bake, small, lights=[SKY])
    assert math.isclose(report["relative_l2"], error_of(small_bake, decoded), rel_tol=1e-3)
    path = tmp_path / "small.glb"
    small.save(path)
    np.testing.assert_array_equal(prtkit.decode(path), decoded)
    with pytest.raises(prtkit.Error, match="already compressed"):
        prtkit.compress(small)


def error_of(baked, decoded):
    columns = np.where(np.arange(36) < 9, 3, 1)  # the direct term has one channel for three colors
    weights = baked.areas[:, None] * columns
    wanted = baked.transfer
    return np.sqrt(np.sum(weights * (decoded - wanted) ** 2) / np.sum(weights * wanted**2))


def test_goals(small_bake, table):
    tiny = prtkit.bake(prtkit.from_arrays(*table), order=2, rays=16, fit="vertex")
    assert prtkit.compress(tiny, max_error=0.2).figures["lit_rms"] <= 0.2
    with pytest.raises(prtkit.Error, match="no result meets the goal"):
        prtkit.compress(tiny, max_error=1e-9)
    with pytest.raises(prtkit.Error, match="cannot be combined"):
        prtkit.compress(small_bake, preset="u64", clusters=3)
    with pytest.raises(prtkit.Error, match="is not one of"):
        prtkit.compress(small_bake, preset="u96")


def test_evaluation_does_not_change_its_arguments(small_bake):
    before = small_bake.transfer.copy()
    small = prtkit.compress(small_bake, clusters=4, reorder=True)
    prtkit.evaluate(small_bake, small, lights=[SKY])
    np.testing.assert_array_equal(small_bake.transfer, before)


def test_lightmaps_and_volumes(table):
    vertices, faces = table
    model = prtkit.from_arrays(vertices[:4], faces[:2], texcoords=[[0, 0], [0, 1], [1, 1], [1, 0]])
    baked = prtkit.bake(model, order=2, rays=16, lightmap={"size": 8, "uv": 0}, volume={"probes": 125})
    assert baked.receivers == "texels" and baked.transfer.shape[1] == 4
    assert baked.figures["volume"]["probes"] <= 125
    np.testing.assert_allclose(prtkit.relight(baked, SKY[:4]), 1, atol=0.02)  # an open floor
    with pytest.raises(prtkit.Error, match="unknown option"):
        prtkit.bake(model, lightmap={"sice": 8})


def test_occlusion_of_a_plane_below_a_roof(table):
    model = prtkit.from_arrays(*table)
    open_floor = prtkit.ambient_occlusion(prtkit.from_arrays(table[0][:4], table[1][:2]), rays=64)
    np.testing.assert_allclose(open_floor, 1, atol=1e-5)
    below = prtkit.ambient_occlusion(model, rays=256)
    assert np.all(below[:4] < 0.99) and np.all(below >= 0)
    far = prtkit.ambient_occlusion(model, rays=64, max_distance=0.01)
    np.testing.assert_allclose(far[:4], 1, atol=1e-5)
    bent = prtkit.bent_normals(model, rays=256)
    np.testing.assert_allclose(np.linalg.norm(bent, axis=1), 1, atol=1e-5)
    assert bent[0, 0] < -0.05  # at corner (-1, -1) open sky is outside the roof


def test_pictures(small_bake):
    picture = prtkit.render(small_bake, SKY, size=(64, 36), samples=1, device="cpu")
    assert picture.shape == (36, 64, 3) and picture.dtype == np.uint8 and picture.max() > 60
    linear = prtkit.render(small_bake, SKY, size=(64, 36), linear=True, device="cpu")
    assert linear.dtype == np.float32 and 0.1 < linear.max() <= 1.01  # a white sky gives at most the albedo
    traced = prtkit.render(small_bake, SKY, size=(32, 18), linear=True, path_trace=64)
    ours = prtkit.render(small_bake, SKY, size=(32, 18), linear=True, device="cpu")
    assert abs(traced.mean() - ours.mean()) < 0.05 * ours.mean()


def test_lamps(tmp_path):
    scene = lit_scene()
    baked = prtkit.bake(scene, order=2, rays=16, fit="vertex")
    assert [t["name"] for t in baked.terms if t["kind"] == "lamp"] == ["Bulb"]
    one = prtkit.relight(baked)
    np.testing.assert_allclose(prtkit.relight(baked, lamps={"Bulb": (2, 0, 0)}), one * [2, 0, 0], atol=1e-6)
    np.testing.assert_allclose(prtkit.relight(baked, lamps={"*": 0.5}), 0.5 * one, atol=1e-6)
    # Irradiance of a light of intensity 10 at 2 m above the floor, over pi: at the corners.
    expected = 10 * 2 / (2**2 + 1 + 1) ** 1.5 / math.pi
    np.testing.assert_allclose(one, expected, rtol=1e-3)
    with pytest.raises(prtkit.Error, match="no lamp 'Sun'"):
        prtkit.relight(baked, lamps={"Sun": 1})


def lit_scene():
    """Return a floor of 2 m with a point light of 10 cd at 2 m height, as a model."""
    data = prtkit.from_arrays(
        [[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1.0]], [[0, 1, 2], [0, 2, 3]]
    ).to_bytes()
    length = int.from_bytes(data[12:16], "little")
    gltf = json.loads(data[20 : 20 + length])
    gltf["extensionsUsed"] = ["KHR_lights_punctual"]
    gltf["extensions"] = {
        "KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 10, "name": "Bulb"}]}
    }
    gltf["nodes"].append(
        {"name": "Bulb", "translation": [0, 2, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}
    )
    gltf["scenes"][0]["nodes"].append(1)
    text = json.dumps(gltf).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    total = 12 + 8 + len(text) + len(rest)
    glb = data[:8] + total.to_bytes(4, "little") + len(text).to_bytes(4, "little") + data[16:20] + text + rest
    return prtkit.Model._parse(glb, "lamp.glb", {})


def test_progress_reports_stages(table):
    reports = []
    prtkit.bake(
        prtkit.from_arrays(*table),
        order=2,
        rays=64,
        progress=lambda stage, done: reports.append((stage, done)),
    )
    assert reports[-1][0] == "baking" and reports[-1][1] == 1 and all(0 <= done <= 1 for _, done in reports)
    with pytest.raises(ZeroDivisionError):
        prtkit.bake(prtkit.from_arrays(*table), order=2, rays=64, progress=lambda stage, done: 1 / 0)


def test_missing_gpus_are_errors(table):
    with pytest.raises(prtkit.Error, match="no such GPU|GPU"):
        prtkit.bake(prtkit.from_arrays(*table), order=2, rays=16, device="a GPU that does not exist")
