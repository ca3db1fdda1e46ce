"""Precomputed radiance transfer: bake, compress, evaluate and relight.

    import prtkit
    model = prtkit.bake(prtkit.load("scene.glb"), bounces=3)
    small = prtkit.compress(model, max_error=0.03)
    print(prtkit.evaluate(model, small)["verdict"])
    small.save("shipped.glb")

Light is radiance, linear Rec. 709, as SH coefficients [order², 3] in the convention "prtkit" unless a function
has a parameter `convention`. Lengths are metres, angles degrees. Order N means bands 0..N-1: order 3 has 9
coefficients. Functions raise `prtkit.Error` with one line for bad input, release the GIL, and stop at Ctrl-C.
Functions that take `threads` use all hardware threads for 0. `progress` is a function of the title of a stage
and of its finished fraction, 0 to 1.
"""

from . import _prtkit
from ._light import Light, Sun, project, separate_suns
from ._model import Model, from_arrays, load
from ._prtkit import Cancelled, Error
from ._sh import CONVENTIONS, convert, evaluate_basis, rotate
from ._transfer import Transfer, compute_prt, load_mesh, transfer_of_mesh, vertex_normals
from ._work import (
    ambient_occlusion,
    bake,
    bent_normals,
    budget,
    compress,
    decode,
    evaluate,
    relight,
    render,
    sweep,
)

__version__ = _prtkit.version

__all__ = [
    "CONVENTIONS",
    "Cancelled",
    "Error",
    "Light",
    "Model",
    "Sun",
    "Transfer",
    "ambient_occlusion",
    "bake",
    "bent_normals",
    "budget",
    "compress",
    "compute_prt",
    "convert",
    "decode",
    "evaluate",
    "evaluate_basis",
    "from_arrays",
    "load",
    "load_mesh",
    "project",
    "relight",
    "render",
    "rotate",
    "separate_suns",
    "sweep",
    "transfer_of_mesh",
    "vertex_normals",
]
