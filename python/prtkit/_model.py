"""Models: glTF files in memory."""

from __future__ import annotations

import logging
import os
from typing import Optional

from . import _prtkit
from ._arrays import as_array, real_array
from ._prtkit import Model
from ._types import ArrayLike, PathLike

_log = logging.getLogger("prtkit")


def log_notices(notices):
    for notice in notices:
        _log.info("%s", notice)


def load(
    path: PathLike,
    *,
    lamp_scale: float = 1.0,
    smooth_normals: Optional[float] = None,
    bad_textures: str = "error",
    allow_outside: bool = False,
    memory_limit: float = 0.0,
) -> Model:
    """Read a scene, a bake or a compressed model: .glb, .gltf, .obj or .ply.

    lamp_scale: factor on all lights; 1/683 for files in candela and lux. smooth_normals: angle in degrees up to
    which edges of primitives without normals are smooth; None: flat. bad_textures: error or ignore.
    allow_outside: read files outside the folder of the scene. memory_limit: bytes of the extracted scene; 0:
    256 MB plus 64 times the size of the file. Notices about the file go to the logger "prtkit".
    """
    options = {
        "lamp_scale": lamp_scale,
        "smooth_normals": smooth_normals,
        "bad_textures": bad_textures,
        "allow_outside": allow_outside,
        "memory_limit": memory_limit,
    }
    model = Model._load(os.fspath(path), options)
    log_notices(model.notices)
    return model


def from_arrays(
    vertices: ArrayLike,
    faces: ArrayLike,
    *,
    normals: Optional[ArrayLike] = None,
    colors: Optional[ArrayLike] = None,
    texcoords: Optional[ArrayLike] = None,
    double_sided: bool = False,
    name: str = "mesh",
) -> Model:
    """Make a scene of a triangle mesh.

    vertices: [V, 3], metres. faces: [F, 3], integers, counter-clockwise seen from the front. normals: [V, 3];
    None: weighted by the angles of the faces, so that vertices are not split. colors: [V, 3], base colors, linear
    Rec. 709, 0..1; None: white. texcoords: [V, 2], v = 0 at the top of an image. double_sided: both sides reflect
    light; a bake then adds vertices for back sides that light reaches, unless it has back_sides="shared".
    """
    vertices, faces = real_array(vertices, "vertices"), as_array(faces, "faces")
    if normals is None:
        normals = _prtkit.vertex_normals(vertices, faces)
    return Model._from_arrays(
        vertices,
        faces,
        real_array(normals, "normals"),
        None if colors is None else real_array(colors, "colors"),
        None if texcoords is None else real_array(texcoords, "texcoords"),
        double_sided,
        name,
    )


def as_model(scene):
    """Return a model, or the model of a path."""
    if isinstance(scene, Model):
        return scene
    if isinstance(scene, (str, os.PathLike)):
        return load(scene)
    raise TypeError(f"expected a prtkit.Model or a path, not {type(scene).__name__}")
