"""Transfer of the vertices of a mesh in memory."""

from __future__ import annotations

import dataclasses
import logging
import math
import os
from typing import Optional, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _prtkit
from ._arrays import as_array, real_array
from ._sh import _factors
from ._types import ArrayLike, PathLike, Progress


_log = logging.getLogger("prtkit")


@dataclasses.dataclass(frozen=True, eq=False)
class Transfer:
    """Transfer of the vertices of a mesh, with the device that computed it.

    vectors: [V, C] or, if light bounces between colored surfaces, [V, 3, C]; float64. device: its name.
    """

    vectors: np.ndarray
    device: str


def vertex_normals(vertices: ArrayLike, faces: ArrayLike) -> NDArray[np.float64]:
    """Return unit normals [V, 3], float64, weighted by the angles of the faces at each vertex.

    0 for a vertex that no face with an area uses.
    """
    return _prtkit.vertex_normals(real_array(vertices, "vertices"), as_array(faces, "faces"))


def load_mesh(path: PathLike, *, join: bool = True) -> Tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Read an OBJ or PLY file: vertices [V, 3], float64, and faces [F, 3], int64, in the order of the file.

    Polygons are triangulated. join: vertices at the same position are one, also where texture coordinates or
    normals differ.
    """
    vertices, faces = _prtkit.load_mesh(os.fspath(path))
    if join:
        rows = np.ascontiguousarray(vertices + 0.0).view(np.dtype((np.void, 24))).ravel()  # -0 becomes 0
        _, first, index = np.unique(rows, return_index=True, return_inverse=True)
        order = np.argsort(first)  # vertices stay in the order of the file
        vertices = vertices[first[order]]
        faces = np.argsort(order).astype(np.int64)[index][faces]
    return vertices, faces


def _scale(convention, order):
    """Return factors [order²] from prtkit's transfer to that of a convention.

    Light in the convention times this transfer is the radiance of a white surface; PIFu leaves out 1/pi.
    """
    if convention == "pifu":
        return math.pi * _factors("pifu", order)
    factors = _factors(convention, order)
    if np.any(factors == 0):
        raise ValueError(
            f"'{convention}' stores irradiance, which has no light of band 3; use order=2 or less"
        )
    return 1 / factors


def transfer_of_mesh(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    n: int = 40,
    order: int = 2,
    normals: Optional[ArrayLike] = None,
    convention: str = "pifu",
    directions: Optional[ArrayLike] = None,
    bounces: float = 0,
    albedo: Optional[ArrayLike] = None,
    backend: str = "auto",
    seed: int = 0,
    denoise: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> Transfer:
    """Like `compute_prt`, with the name of the device that traced."""
    vertices, faces = real_array(vertices, "vertices"), as_array(faces, "faces")
    normals = None if normals is None else real_array(normals, "normals")
    if not isinstance(order, (int, np.integer)) or isinstance(order, bool) or not 0 <= order <= 9:
        raise ValueError(f"order is the highest band, 0 to 9, not {order}")
    if int(n) != n or n < 1 or n > 4096:
        raise ValueError(f"n must be a whole number in 1..4096, not {n}")
    if bounces != math.inf and (bounces != int(bounces) or not 0 <= bounces <= 10000):
        raise ValueError(f"bounces must be a whole number in 0..10000 or math.inf, not {bounces}")
    bands = order + 1
    if directions is not None:
        if bounces or denoise or backend not in ("auto", "cpu"):
            raise ValueError("directions cannot be combined with bounces, denoise and backend='gpu'")
        values = _by_directions(vertices, faces, normals, directions, bands, threads, progress)
        return Transfer(values / math.pi * _scale(convention, bands), "CPU")
    options = {
        "order": bands,
        "rays": (int(n) * int(n) + 1) // 2,  # PIFu's rays below the surface need not be traced
        "bounces": -1 if bounces == math.inf else int(bounces),
        "seed": seed,
        "threads": threads,
        "denoise": denoise,
        "backend": backend,
    }
    albedo = None if albedo is None else real_array(albedo, "albedo")
    values, channels, device = _prtkit.bake_mesh(vertices, faces, normals, albedo, options, progress)
    values = np.asarray(values, np.float64)
    if channels == 3:
        values = values.reshape(len(values), 3, -1)
    return Transfer(values * _scale(convention, bands), device)


def compute_prt(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    n: int = 40,
    order: int = 2,
    normals: Optional[ArrayLike] = None,
    convention: str = "pifu",
    directions: Optional[ArrayLike] = None,
    bounces: float = 0,
    albedo: Optional[ArrayLike] = None,
    backend: str = "auto",
    seed: int = 0,
    denoise: bool = False,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.float64]:
    """Return the transfer of the vertices of a mesh, [V, (order + 1)²], float64.

    vertices: [V, 3]; stay unsplit and in their order. faces: [F, 3], integers. n: n² directions over the
    sphere, of which the half above the surface is traced. **order: the highest band**, as in PIFu's computePRT:
    2 for 9 coefficients. normals: [V, 3]; None: weighted by the angles of the faces. convention: a name in CONVENTIONS; "pifu" is the integral of visibility times the clamped cosine
    times the basis without phase, without 1/pi. directions: [D, 3], the same for all vertices, with equal weights,
    as PIFu traces them; None: stratified directions that differ between vertices, which have less noise. bounces:
    0 or more, math.inf for all; then albedo [V, 3], 0..1, is that of the surfaces (None: white), and the result is
    [V, 3, (order + 1)²] if it has color. backend: auto, cpu or gpu; raises Error if it
    is missing; its name is logged, and in the result of `transfer_of_mesh`.
    """
    result = transfer_of_mesh(
        vertices,
        faces,
        n=n,
        order=order,
        normals=normals,
        convention=convention,
        directions=directions,
        bounces=bounces,
        albedo=albedo,
        backend=backend,
        seed=seed,
        denoise=denoise,
        threads=threads,
        progress=progress,
    )
    _log.info("transfer of %d vertices, traced by %s", len(result.vectors), result.device)
    return result.vectors


def _by_directions(vertices, faces, normals, directions, bands, threads, progress):
    extent = np.ptp(vertices.reshape(-1, 3), axis=0) if vertices.ndim == 2 and len(vertices) else np.ones(3)
    # PIFu's start of rays; not 0 for a flat mesh
    offset = float(max(1e-3 * np.min(extent), 1e-6 * np.max(extent)))
    return _prtkit.transfer_by_directions(
        vertices, faces, normals, real_array(directions, "directions"), bands, offset, threads, progress
    )
