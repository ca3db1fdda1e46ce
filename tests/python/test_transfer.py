"""compute_prt against closed forms, and against PIFu's formula written in NumPy."""

import math

import numpy as np
import prtkit
import pytest
from conftest import open_quad
from prtkit.compat.pifu import computePRT


def pifu_basis(d):
    """Return the nine functions of PIFu's formula at directions [D, 3]."""
    x, y, z = d.T
    return np.stack(
        [
            np.full_like(x, math.sqrt(1 / (4 * math.pi))),
            math.sqrt(3 / (4 * math.pi)) * y,
            math.sqrt(3 / (4 * math.pi)) * z,
            math.sqrt(3 / (4 * math.pi)) * x,
            math.sqrt(15 / (4 * math.pi)) * x * y,
            math.sqrt(15 / (4 * math.pi)) * y * z,
            math.sqrt(5 / (16 * math.pi)) * (3 * z * z - 1),
            math.sqrt(15 / (4 * math.pi)) * x * z,
            math.sqrt(15 / (16 * math.pi)) * (x * x - y * y),
        ],
        -1,
    )


def open_vertex(normal):
    """Return the closed form of an open vertex: the clamped cosine times the basis, integrated."""
    factors = math.pi * np.repeat([1, 2 / 3, 1 / 4], [1, 3, 5])
    return factors * pifu_basis(np.asarray([normal], float))[0]


def blocked(start, direction, vertices, faces):
    """Return whether a ray hits a triangle (Möller and Trumbore 1997)."""
    a = vertices[faces[:, 0]]
    e1, e2 = vertices[faces[:, 1]] - a, vertices[faces[:, 2]] - a
    p = np.cross(direction, e2)
    determinant = np.einsum("ij,ij->i", e1, p)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = start - a
        u = np.einsum("ij,ij->i", s, p) / determinant
        q = np.cross(s, e1)
        v = q @ direction / determinant
        t = np.einsum("ij,ij->i", q, e2) / determinant
        return bool(np.any((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0)))


def by_formula(vertices, faces, normals, directions):
    """Return PIFu's sum over directions, [V, 9]."""
    starts = vertices + 1e-3 * np.ptp(vertices, axis=0).min() * normals
    functions = pifu_basis(directions)
    result = np.zeros((len(vertices), 9))
    for v, (start, normal) in enumerate(zip(starts, normals)):
        for d, direction in enumerate(directions):
            cosine = normal @ direction
            if cosine > 0 and not blocked(start, direction, vertices, faces):
                result[v] += 4 * math.pi / len(directions) * cosine * functions[d]
    return result


def sphere(random, count):
    directions = random.normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


@pytest.mark.parametrize("normal", [(0, 0, 1), (0, 1, 0), (-1, 0, 0), (0.48, -0.6, 0.64)])
def test_open_vertex_has_the_closed_form(normal):
    vertices, faces = open_quad(normal)
    values = prtkit.compute_prt(vertices, faces, n=10)
    assert values.shape == (4, 9) and values.dtype == np.float64
    np.testing.assert_allclose(values, np.tile(open_vertex(normal), (4, 1)), atol=1e-6)


def test_same_directions_give_the_formula(table, random):
    vertices, faces = table
    normals = prtkit.vertex_normals(vertices, faces)
    directions = sphere(random, 500)
    values = prtkit.compute_prt(vertices, faces, directions=directions)
    expected = by_formula(vertices, faces, normals, directions)
    assert np.abs(expected[:4, 0] - open_vertex((0, 1, 0))[0]).max() > 0.05  # some sky is blocked
    np.testing.assert_allclose(values, expected, atol=1e-5)


def test_own_directions_converge_to_the_formula(table, random):
    vertices, faces = table
    normals = prtkit.vertex_normals(vertices, faces)
    count = 20000
    values = prtkit.compute_prt(vertices, faces, n=100)
    expected = prtkit.compute_prt(vertices, faces, directions=sphere(random, count), normals=normals)
    # Standard deviation of the sum: at most 4 pi max(cosine Y) / sqrt(2 count); four of them.
    np.testing.assert_allclose(values, expected, atol=4 * 4 * math.pi * 0.5 / math.sqrt(2 * count))


def test_given_normals_replace_those_of_the_mesh(table, random):
    vertices, faces = table
    normals = sphere(random, len(vertices))
    directions = sphere(random, 100)
    values = prtkit.compute_prt(vertices, faces, normals=3 * normals, directions=directions)
    np.testing.assert_allclose(values, by_formula(vertices, faces, normals, directions), atol=1e-5)


@pytest.mark.parametrize("convention", sorted(prtkit.CONVENTIONS))
def test_conventions_give_the_same_radiance(convention, table, random):
    vertices, faces = table
    light = random.normal(size=(9, 3))
    ours = prtkit.compute_prt(vertices, faces, n=20, convention="prtkit") @ light
    theirs = prtkit.compute_prt(vertices, faces, n=20, convention=convention) @ prtkit.convert(
        light, "prtkit", convention
    )
    factor = math.pi if convention == "pifu" else 1  # PIFu leaves out 1/pi
    np.testing.assert_allclose(theirs, factor * ours, atol=1e-12)


def test_order_is_the_highest_band(table):
    for order in (0, 1, 4):
        assert prtkit.compute_prt(*table, n=4, order=order).shape == (7, (order + 1) ** 2)


def test_bounces_of_a_furnace_are_a_geometric_series():
    # Inside a closed white box no light arrives; under the sky, light between two facing squares adds.
    near = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1.0]])
    far = near[::-1] + [0, 0.4, 0]
    vertices, faces = np.concatenate([near, far]), np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    first = prtkit.compute_prt(vertices, faces, n=40, convention="prtkit")[:, 0]
    one = prtkit.compute_prt(vertices, faces, n=40, bounces=1, convention="prtkit")[:, 0]
    two = prtkit.compute_prt(vertices, faces, n=40, bounces=2, convention="prtkit")[:, 0]
    assert np.all(one > first) and np.all(two > one)
    sky = math.sqrt(
        4 * math.pi
    )  # a white sky of radiance 1; a closed surface has radiance 1 after all bounces
    assert np.all(
        prtkit.compute_prt(vertices, faces, n=40, bounces=math.inf, convention="prtkit")[:, 0] * sky < 1.01
    )


def test_color_has_three_channels(table):
    vertices, faces = table
    albedo = np.tile([0.9, 0.5, 0.1], (len(vertices), 1))
    values = prtkit.compute_prt(vertices, faces, n=10, bounces=1, albedo=albedo)
    assert values.shape == (7, 3, 9)
    assert np.all(values[:4, 0, 0] >= values[:4, 2, 0])


def test_far_meshes_keep_their_precision(table):
    vertices, faces = table
    near = prtkit.compute_prt(vertices, faces, n=20)
    far = prtkit.compute_prt(vertices + [1e6, -2e6, 3e6], faces, n=20)
    np.testing.assert_allclose(far, near, atol=0.02)


def test_replacement_of_prt_util(tmp_path):
    path = tmp_path / "square.obj"
    path.write_text(
        "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 0\nvt 0 0\nvt 1 1\nvn 0 0 1\n"
        "f 1/1/1 2/2/1 3/1/1 4/2/1\nf 5/2/1 3/1/1 4/1/1\n"
    )
    values, faces = computePRT(str(path), 10, 2)
    assert values.shape == (4, 9) and values.dtype == np.float64
    assert faces.shape == (3, 3) and faces.dtype == np.int64
    np.testing.assert_allclose(values, np.tile(open_vertex((0, 0, 1)), (4, 1)), atol=1e-6)
    scaled, _ = computePRT(path, 100, 10, 2)
    np.testing.assert_allclose(scaled, values, atol=1e-6)
    with pytest.raises(TypeError):
        computePRT(path, 10)
    vertices, _ = prtkit.load_mesh(path)
    np.testing.assert_array_equal(
        vertices, [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    )  # in the order of the file


def test_directions_of_flat_meshes():
    vertices, faces = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0.0]]), np.array([[0, 1, 2]])
    values = prtkit.compute_prt(vertices, faces, directions=[[0, 0, 1.0]])
    np.testing.assert_allclose(values[:, 0], 4 * math.pi * math.sqrt(1 / (4 * math.pi)), rtol=1e-6)


def test_ply_files_are_read(tmp_path):
    path = tmp_path / "square.ply"
    path.write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"
    )
    values, faces = computePRT(path, 10, 2)
    assert faces.shape == (2, 3)
    np.testing.assert_allclose(values, np.tile(open_vertex((0, 0, 1)), (4, 1)), atol=1e-6)
