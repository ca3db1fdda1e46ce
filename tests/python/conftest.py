"""Meshes and lights that the tests share."""

import numpy as np
import pytest


@pytest.fixture
def random():
    return np.random.default_rng(7)


def open_quad(normal):
    """Return vertices and faces of a square with this unit normal."""
    normal = np.asarray(normal, float)
    a = np.cross(normal, [0.3, 0.5, -0.7])
    a /= np.linalg.norm(a)
    b = np.cross(normal, a)
    return np.array([-a - b, a - b, a + b, -a + b]), np.array([[0, 1, 2], [0, 2, 3]])


def table_scene():
    """Return a floor of 2 m below a tilted triangle that blocks part of its sky."""
    floor = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1.0]])
    roof = np.array([[-0.8, 0.5, -0.6], [0.7, 0.6, -0.5], [0.1, 0.9, 0.8]])
    return np.concatenate([floor, roof]), np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]])


@pytest.fixture
def table():
    return table_scene()


@pytest.fixture(scope="session")
def small_bake():
    """A bake of a bumpy plane with an overhang, order 3, one bounce."""
    import prtkit

    x, z = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-1, 1, 9), indexing="ij")
    y = 0.2 * np.sin(4 * x) * np.cos(3 * z)
    vertices = np.stack([x, y, z], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(8), np.arange(8), indexing="ij")
    a, b, c, d = i * 9 + j, i * 9 + j + 1, (i + 1) * 9 + j + 1, (i + 1) * 9 + j
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    roof = np.array([[-0.9, 0.8, -0.9], [0.9, 0.8, -0.9], [0, 0.9, 0.4]])
    vertices, faces = np.concatenate([vertices, roof]), np.concatenate([faces, [[81, 83, 82]]])
    colors = np.where(vertices[:, :1] > 0, [[0.8, 0.3, 0.2]], [[0.4, 0.6, 0.9]])
    scene = prtkit.from_arrays(vertices, faces, colors=colors)
    return prtkit.bake(scene, order=3, rays=64, bounces=1, fit="vertex", device="cpu")
