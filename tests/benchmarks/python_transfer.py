#!/usr/bin/env python3
"""Compares prtkit.compute_prt with the formula of PIFu over Open3D's rays: time and error at equal rays.

python_transfer.py [VERTICES [N]]; needs the packages prtkit, numpy and open3d.
"""

import sys
import time

import numpy as np
import open3d
import prtkit


def blob(vertices):
    """Return a closed mesh with folds: a sphere whose radius varies."""
    rows = int(np.sqrt(vertices / 2))
    columns = 2 * rows
    theta = (np.arange(rows) + 0.5) / rows * np.pi
    phi = np.arange(columns) / columns * 2 * np.pi
    t, p = np.meshgrid(theta, phi, indexing="ij")
    radius = 1 + 0.35 * np.sin(5 * t) * np.cos(6 * p) + 0.1 * np.cos(23 * t) * np.cos(17 * p)
    points = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], -1) * radius[..., None]
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns), indexing="ij")
    k = (j + 1) % columns
    a, b, c, d = i * columns + j, (i + 1) * columns + j, (i + 1) * columns + k, i * columns + k
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return points.reshape(-1, 3), faces


def basis(d):
    """Return the nine functions of PIFu's convention at directions [D, 3]."""
    x, y, z = d.T
    return np.stack(
        [
            np.full_like(x, np.sqrt(1 / (4 * np.pi))),
            np.sqrt(3 / (4 * np.pi)) * y,
            np.sqrt(3 / (4 * np.pi)) * z,
            np.sqrt(3 / (4 * np.pi)) * x,
            np.sqrt(15 / (4 * np.pi)) * x * y,
            np.sqrt(15 / (4 * np.pi)) * y * z,
            np.sqrt(5 / (16 * np.pi)) * (3 * z * z - 1),
            np.sqrt(15 / (4 * np.pi)) * x * z,
            np.sqrt(15 / (16 * np.pi)) * (x * x - y * y),
        ],
        -1,
    )


def by_open3d(vertices, faces, normals, directions, per_ray=4_000_000):
    """PIFu's formula: the same directions for all vertices; rays in chunks of `per_ray`."""
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        open3d.core.Tensor(vertices.astype(np.float32)), open3d.core.Tensor(faces.astype(np.uint32))
    )
    starts = vertices + 1e-3 * np.ptp(vertices, 0).min() * normals
    functions = basis(directions) * (4 * np.pi / len(directions))
    result = np.zeros((len(vertices), 9))
    chunk = max(1, per_ray // len(directions))
    for first in range(0, len(vertices), chunk):
        part = slice(first, first + chunk)
        cosine = normals[part] @ directions.T
        v, d = np.nonzero(cosine > 0)
        rays = np.concatenate([starts[part][v], directions[d]], 1).astype(np.float32)
        free = ~scene.test_occlusions(open3d.core.Tensor(rays)).numpy()
        weights = np.zeros_like(cosine)
        weights[v[free], d[free]] = cosine[v[free], d[free]]
        result[part] = weights @ functions
    return result


def sphere(count, seed):
    """Return uniform random unit directions [count, 3]."""
    random = np.random.default_rng(seed)
    z, phi = random.uniform(-1, 1, count), random.uniform(0, 2 * np.pi, count)
    r = np.sqrt(1 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], -1)


def relative(values, reference):
    return np.sqrt(np.sum((values - reference) ** 2) / np.sum(reference**2))


def main():
    count, n = (int(a) for a in (sys.argv[1:] + ["100000", "40"][len(sys.argv) - 1 :])[:2])
    vertices, faces = blob(count)
    normals = prtkit.vertex_normals(vertices, faces)
    some = np.random.default_rng(1).choice(len(vertices), min(2000, len(vertices)), replace=False)

    begin = time.perf_counter()
    ours = prtkit.compute_prt(vertices, faces, n=n, backend="cpu")
    seconds = time.perf_counter() - begin
    begin = time.perf_counter()
    theirs = by_open3d(vertices, faces, normals, sphere(n * n, 2))
    seconds_theirs = time.perf_counter() - begin

    reference = by_open3d_of(vertices, faces, normals, some)
    print(f"{len(vertices)} vertices, {n * n} rays, order 2")
    print(f"prtkit  {seconds:7.2f} s  relative L2 {relative(ours[some], reference):.4%}")
    print(f"Open3D  {seconds_theirs:7.2f} s  relative L2 {relative(theirs[some], reference):.4%}")
    print(f"ratio of times {seconds_theirs / seconds:.2f}")


def by_open3d_of(vertices, faces, normals, some):
    """Return a reference at some vertices: a Fibonacci sphere of 200 000 directions, by Open3D."""
    count = 200_000
    z = 1 - (2 * np.arange(count) + 1) / count
    phi = np.arange(count) * np.pi * (3 - np.sqrt(5))
    r = np.sqrt(1 - z * z)
    directions = np.stack([r * np.cos(phi), r * np.sin(phi), z], -1)
    scene = open3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        open3d.core.Tensor(vertices.astype(np.float32)), open3d.core.Tensor(faces.astype(np.uint32))
    )
    starts = vertices + 1e-3 * np.ptp(vertices, 0).min() * normals
    functions = basis(directions) * (4 * np.pi / count)
    result = np.zeros((len(some), 9))
    for row, v in enumerate(some):
        cosine = directions @ normals[v]
        above = cosine > 0
        rays = np.concatenate([np.broadcast_to(starts[v], (above.sum(), 3)), directions[above]], 1)
        free = ~scene.test_occlusions(open3d.core.Tensor(rays.astype(np.float32))).numpy()
        result[row] = (cosine[above] * free) @ functions[above]
    return result


if __name__ == "__main__":
    main()
