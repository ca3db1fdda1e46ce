"""Arrays of many kinds, and bad input: one clear line each."""

import pathlib

import numpy as np
import prtkit
import pytest

GOOD = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]])
FACE = np.array([[0, 1, 2]])


class Interface:
    """An object with __array_interface__ only."""

    def __init__(self, array):
        self.array = array
        self.__array_interface__ = array.__array_interface__


class DlPack:
    """An object with __dlpack__ only."""

    def __init__(self, array):
        self.array = array

    def __dlpack__(self, **options):
        return self.array.__dlpack__(**options)

    def __dlpack_device__(self):
        return self.array.__dlpack_device__()


def variants(array):
    yield array
    yield array.tolist()
    yield np.asfortranarray(array)
    yield np.repeat(array, 2, axis=0)[::2]
    locked = array.copy()
    locked.setflags(write=False)
    yield locked
    yield array.astype(array.dtype.newbyteorder())
    yield Interface(array)
    yield DlPack(array)


def test_arrays_of_many_kinds():
    expected = prtkit.compute_prt(GOOD, FACE, n=4)
    for vertices in [*variants(GOOD), GOOD.astype(np.float32), GOOD.astype(int)]:
        np.testing.assert_allclose(prtkit.compute_prt(vertices, FACE, n=4), expected, atol=1e-6)
    for faces in [*variants(FACE), FACE.astype(np.uint8), FACE.astype(np.int32)]:
        np.testing.assert_array_equal(prtkit.compute_prt(GOOD, faces, n=4), expected)


def test_tensors_of_torch():
    torch = pytest.importorskip("torch")
    vertices = torch.tensor(GOOD, requires_grad=True)
    np.testing.assert_array_equal(
        prtkit.compute_prt(vertices, torch.tensor(FACE), n=4), prtkit.compute_prt(GOOD, FACE, n=4)
    )


@pytest.mark.parametrize(
    "vertices, faces, message",
    [
        (GOOD[:, :2], FACE, "vertices must have the shape"),
        (GOOD[0], FACE, "vertices must have the shape"),
        (np.zeros((0, 3)), FACE, "faces? 0 refers|no vertices"),
        (GOOD, np.zeros((0, 3), int), "no faces"),
        (GOOD, FACE[:, :2], "faces must have the shape"),
        (GOOD, [[0, 1, 3]], "face 0 refers to vertex 3, but there are only 3"),
        (GOOD, [[0, 1, -1]], "face 0 refers to vertex -1"),
        (GOOD, [[0.0, 1.0, 2.0]], "faces must be integers"),
        (GOOD * np.nan, FACE, "vertex 0 is not finite"),
        (GOOD * 1e12, FACE, "exceeds 1e9"),
    ],
)
def test_bad_meshes(vertices, faces, message):
    with pytest.raises(prtkit.Error, match=message):
        prtkit.compute_prt(vertices, faces, n=4)
    with pytest.raises(prtkit.Error):
        prtkit.from_arrays(vertices, faces)


def test_bad_types():
    with pytest.raises(TypeError, match="iterator"):
        prtkit.compute_prt((row for row in GOOD), FACE, n=4)
    with pytest.raises((TypeError, ValueError)):
        prtkit.compute_prt([[0, 0, 0], [1, 2]], FACE, n=4)
    with pytest.raises(TypeError, match="real numbers"):
        prtkit.compute_prt(GOOD + 1j, FACE, n=4)
    with pytest.raises(TypeError, match="real numbers"):
        prtkit.compute_prt(GOOD.astype(str), FACE, n=4)
    with pytest.raises(TypeError, match="prtkit.Model or a path"):
        prtkit.bake(GOOD)
    with pytest.raises(prtkit.Error, match="normals"):
        prtkit.compute_prt(GOOD, FACE, n=4, normals=GOOD[:2])
    with pytest.raises(prtkit.Error, match="normal 0 is not finite"):
        prtkit.compute_prt(GOOD, FACE, n=4, normals=GOOD * np.nan)
    with pytest.raises(prtkit.Error, match="albedos"):
        prtkit.compute_prt(GOOD, FACE, n=4, bounces=1, albedo=GOOD[:1])
    with pytest.raises(ValueError, match="highest band"):
        prtkit.compute_prt(GOOD, FACE, order=10)
    with pytest.raises(ValueError, match="n must be"):
        prtkit.compute_prt(GOOD, FACE, n=0)
    for bounces in (-1, 0.5):
        with pytest.raises(ValueError, match="bounces"):
            prtkit.compute_prt(GOOD, FACE, bounces=bounces)
    with pytest.raises(prtkit.Error, match="albedo 0"):
        prtkit.compute_prt(GOOD, FACE, n=2, bounces=1, albedo=GOOD * np.nan)
    with pytest.raises(ValueError, match="band 3"):
        prtkit.compute_prt(GOOD, FACE, n=2, order=3, convention="gltf")
    with pytest.raises(prtkit.Error, match="color 1"):
        prtkit.from_arrays(GOOD, FACE, colors=2 * GOOD)
    with pytest.raises(TypeError, match="masked"):
        prtkit.compute_prt(np.ma.masked_equal(GOOD, 1), FACE)
    with pytest.raises(prtkit.Error, match="direction"):
        prtkit.compute_prt(GOOD, FACE, directions=np.zeros((2, 3)))
    with pytest.raises(prtkit.Error, match="not one of"):
        prtkit.compute_prt(GOOD, FACE, n=2, backend="cuda")
    with pytest.raises(ValueError, match="convention"):
        prtkit.compute_prt(GOOD, FACE, convention="godot")


def test_bad_options():
    model = prtkit.from_arrays(GOOD, FACE)
    for options, message in [
        ({"order": 11}, "order"),
        ({"order": "six"}, "wrong type"),
        ({"rays": 0}, "rays"),
        ({"bounces": 1.5}, "bounces"),
        ({"fit": "best"}, "not one of"),
        ({"subsurface": {"": "cheese"}}, "cheese"),
        ({"no_shadow": ["glass"]}, "glass"),
    ]:
        with pytest.raises(prtkit.Error, match=message):
            prtkit.bake(model, **options)
    with pytest.raises(prtkit.Error, match="contains no transfer"):
        prtkit.compress(model)
    with pytest.raises(prtkit.Error, match="transfer"):
        prtkit.relight(model, np.zeros((9, 3)))
    baked = prtkit.bake(model, order=3, rays=4)
    for light in (np.full((9, 3), np.nan), np.zeros(9), np.zeros((5, 3))):
        for use in (prtkit.relight, prtkit.render):
            with pytest.raises(ValueError, match="not finite|shape|order²"):
                use(baked, light)
    for options, message in [
        ({"samples": 0}, "samples"),
        ({"fov": np.nan}, "field of view"),
        ({"exposure": np.nan}, "exposure"),
        ({"path_trace": 1}, "paths"),
        ({"size": (0, 8)}, "size"),
        ({"lamp_scale": -1.0}, "factor"),
    ]:
        with pytest.raises(prtkit.Error, match=message):
            prtkit.render(baked, **options)
    with pytest.raises(ValueError, match="rays"):
        prtkit.relight(baked, rays=0)
    with pytest.raises(ValueError, match="strength of a"):
        prtkit.relight(baked, lamps={"a": np.nan})
    with pytest.raises(prtkit.Error, match="rotations"):
        prtkit.evaluate(baked, baked, rotations=1000)
    for options in ({"lightmap": {"size": 0}}, {"lightmap": {"unwrap": True}}, {"volume": {"error": 0.1}}):
        with pytest.raises(prtkit.Error, match="needs"):
            prtkit.bake(model, **options)


def test_files(tmp_path):
    with pytest.raises(prtkit.Error, match="missing.glb"):
        prtkit.load(tmp_path / "missing.glb")
    bad = tmp_path / "bad.glb"
    bad.write_bytes(b"glTF\2\0\0\0")
    with pytest.raises(prtkit.Error, match="bad.glb"):
        prtkit.load(str(bad))
    for name, text in [("bad.ply", "ply\nformat ascii 1.0\nelement vertex 9\n"), ("bad.obj", "f 1 2 3\n")]:
        (tmp_path / name).write_text(text)
        with pytest.raises(prtkit.Error, match=name):
            prtkit.load(tmp_path / name)
        with pytest.raises(prtkit.Error, match=name):
            prtkit.load_mesh(tmp_path / name)
    model = prtkit.from_arrays(GOOD, FACE)
    path = pathlib.Path(tmp_path) / "good.glb"
    model.save(path)
    assert prtkit.load(path).vertices.shape == (3, 3)
    with pytest.raises(prtkit.Error, match="nowhere"):
        model.save(tmp_path / "nowhere" / "good.glb")
    assert path.read_bytes() == model.to_bytes()
