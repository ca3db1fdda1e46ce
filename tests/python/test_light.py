"""Conventions, rotation and projection against closed forms."""

import math

import numpy as np
import prtkit
import pytest

SKIES = sorted(prtkit.CONVENTIONS)


def sphere_grid(rows=200):
    """Return directions and solid angles of a lat-long grid."""
    theta = (np.arange(rows) + 0.5) / rows * math.pi
    phi = (np.arange(2 * rows) + 0.5) / rows * math.pi
    t, p = np.meshgrid(theta, phi, indexing="ij")
    d = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1).reshape(-1, 3)
    return d, (np.sin(t) * (math.pi / rows) ** 2).ravel()


def test_basis_is_orthonormal():
    d, w = sphere_grid()
    for convention in ("prtkit", "threejs"):
        basis = prtkit.evaluate_basis(d, 4, convention=convention)
        np.testing.assert_allclose(basis.T @ (basis * w[:, None]), np.eye(16), atol=1e-3)
    first = prtkit.evaluate_basis([[1, 0, 0]], 2)[0]
    np.testing.assert_allclose(first, [0.282095, 0, 0, -0.488603], atol=1e-6)


@pytest.mark.parametrize("convention", SKIES)
def test_conversion_round_trips(convention, random):
    light = random.normal(size=(9, 3))
    back = prtkit.convert(prtkit.convert(light, "prtkit", convention), convention, "prtkit")
    np.testing.assert_allclose(back, light, atol=1e-12)


@pytest.mark.parametrize("convention", SKIES)
def test_what_a_convention_stores(convention, random):
    """Radiance, or irradiance by quadrature, is the product of basis and coefficients."""
    light = random.normal(size=9)
    normals = random.normal(size=(5, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    stored = prtkit.evaluate_basis(normals, 3, convention=convention) @ prtkit.convert(
        light, "prtkit", convention
    )
    d, w = sphere_grid(100)
    radiance = prtkit.evaluate_basis(d, 3) @ light
    irradiance = np.maximum(normals @ d.T, 0) @ (radiance * w)
    expected = {"unity": irradiance / math.pi, "gltf": irradiance}.get(
        convention, prtkit.evaluate_basis(normals, 3) @ light
    )
    np.testing.assert_allclose(stored, expected, atol=2e-3)


def test_unity_stores_the_ambient_color():
    white = np.zeros(9)
    white[0] = math.sqrt(4 * math.pi)  # radiance 1 from every direction
    np.testing.assert_allclose(prtkit.convert(white, "prtkit", "unity"), np.eye(9)[0], atol=1e-12)


def test_irradiance_cannot_give_odd_bands():
    with pytest.raises(ValueError, match="odd bands"):
        prtkit.convert(np.ones(16), "gltf", "prtkit")
    with pytest.raises(ValueError, match="at most order 3"):
        prtkit.convert(np.ones(16), "prtkit", "unity")
    with pytest.raises(ValueError, match="is not one of"):
        prtkit.convert(np.ones(9), "prtkit", "godot")
    with pytest.raises(ValueError, match="order²"):
        prtkit.convert(np.ones(7), "prtkit", "pifu")


@pytest.mark.parametrize("convention", ["prtkit", "pifu", "3dgs"])
def test_rotation_moves_the_function(convention, random):
    light = random.normal(size=(16, 3))
    before = light.copy()
    q, _ = np.linalg.qr(random.normal(size=(3, 3)))
    rotation = q * np.sign(np.linalg.det(q))
    rotated = prtkit.rotate(light, rotation, convention=convention)
    np.testing.assert_array_equal(light, before)
    d, _ = sphere_grid(10)
    basis = prtkit.evaluate_basis(d, 4, convention=convention)
    there = prtkit.evaluate_basis(d @ rotation, 4, convention=convention)  # R^-1 d
    np.testing.assert_allclose(basis @ rotated, there @ light, atol=1e-5)
    with pytest.raises(prtkit.Error):
        prtkit.rotate(light, 2 * np.eye(3))


def test_uniform_environments_are_constant():
    image = np.ones((8, 16, 3)) * [1, 2, 3]
    light = prtkit.project(image, order=3)
    expected = np.zeros((9, 3))
    expected[0] = math.sqrt(4 * math.pi) * np.array([1, 2, 3])
    np.testing.assert_allclose(light, expected, atol=1e-5)
    assert light.dtype == np.float32


def test_directions_of_environments():
    """The center column looks at +Z, the top is +Y; with lat-long-x the center is +X."""
    image = np.zeros((32, 64, 3), np.float32)
    image[15:17, 31:33] = 1
    for layout, direction in (("lat-long", [0, 0, 1]), ("lat-long-x", [1, 0, 0])):
        light = prtkit.project(image, order=4, layout=layout)[:, 0]
        d, _ = sphere_grid(20)
        brightest = d[np.argmax(prtkit.evaluate_basis(d, 4) @ light)]
        assert brightest @ np.array(direction) > 0.98
    turned = prtkit.project(image, order=4, rotate=90)[:, 0]
    np.testing.assert_allclose(turned, prtkit.project(image, order=4, layout="lat-long-x")[:, 0], atol=1e-6)


def test_suns_are_found():
    image = np.full((64, 128, 3), 0.5, np.float32)
    image[20, 40] = 4000
    light = prtkit.separate_suns(image, order=4)
    assert len(light.suns) == 1
    sun = light.suns[0]
    theta, phi = (20.5 / 64) * math.pi, (40.5 / 128 - 0.5) * 2 * math.pi
    expected = [-math.sin(theta) * math.sin(phi), math.cos(theta), math.sin(theta) * math.cos(phi)]
    assert np.dot(sun.towards, expected) > 0.999
    area = 2 * math.pi / 128 * (math.cos(20 / 64 * math.pi) - math.cos(21 / 64 * math.pi))
    np.testing.assert_allclose(sun.irradiance, 3999.5 * area, rtol=0.02)
    whole = prtkit.project(image, order=4)
    np.testing.assert_allclose(light.combined()[0], whole[0], rtol=1e-3)


def test_bad_environments():
    with pytest.raises(prtkit.Error, match="shape"):
        prtkit.project(np.ones((8, 16)))
    with pytest.raises(prtkit.Error):
        prtkit.project(np.full((8, 16, 3), np.nan))
    with pytest.raises(prtkit.Error, match="not one of"):
        prtkit.project(np.ones((8, 16, 3)), layout="round")
    with pytest.raises(prtkit.Error, match="missing.hdr"):
        prtkit.project("missing.hdr")
