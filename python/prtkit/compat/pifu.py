"""Replacement for `prt_util.py` of PIFu, PIFuHD, ICON, ECON, PaMIR and their forks.

    from prtkit.compat.pifu import computePRT
    PRT, F = computePRT(mesh_path, 40, 2)         # PIFu, PaMIR
    PRT, F = computePRT(mesh_path, scale, 10, 2)  # ICON, ECON
"""

from __future__ import annotations

from typing import Tuple

import numpy as np
from numpy.typing import NDArray

from .._transfer import compute_prt, load_mesh
from .._types import PathLike


def computePRT(mesh_path: PathLike, *arguments: float) -> Tuple[NDArray[np.float64], NDArray[np.int64]]:
    """Return the transfer [V, (order + 1)²], float64, and the faces [F, 3], int64, of an OBJ or PLY file.

    Called as computePRT(mesh_path, n, order) or computePRT(mesh_path, scale, n, order); n² rays per vertex, order
    is the highest band, and the mesh is scaled by `scale`, which does not change the result. Vertices at the same
    position are one; the faces are in the order of the file and refer to them. Raises TypeError for other calls.
    """
    if len(arguments) not in (2, 3):
        raise TypeError("computePRT(mesh_path, n, order) or computePRT(mesh_path, scale, n, order)")
    n, order = arguments[-2:]
    vertices, faces = load_mesh(mesh_path)
    if len(arguments) == 3:
        vertices = vertices * arguments[0]
    return compute_prt(vertices, faces, n=int(n), order=int(order)), faces
