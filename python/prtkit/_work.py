"""Bake, compress, evaluate, relight and render models."""

from __future__ import annotations

import json
import math
import os
import tempfile
from typing import Any, Dict, List, Mapping, Optional, Sequence, Tuple

import numpy as np
from numpy.typing import NDArray

from . import _prtkit
from ._arrays import real_array
from ._light import Light, as_light, light_files
from ._model import Model, as_model, log_notices
from ._types import ArrayLike, LightLike, ModelLike, PathLike, Progress


def _given(options):
    return {name: value for name, value in options.items() if value is not None}


def _strengths(lamps):
    """Return {name: [r, g, b]} of finite numbers of 0 or more. Raises ValueError."""
    strengths = {}
    for name, value in dict(lamps or {}).items():
        color = np.broadcast_to(np.asarray(real_array(value, f"the strength of {name}"), np.float64), 3)
        if not np.isfinite(color).all() or color.min() < 0 or color.max() > 1e9:
            raise ValueError(f"the strength of {name} must be a number, or three, from 0 to 1e9, not {value}")
        strengths[str(name)] = color.tolist()
    return strengths


def _finished(model):
    log_notices(model.notices)
    return model


def bake(
    scene: ModelLike,
    *,
    order: int = 6,
    rays: int = 1024,
    target_error: Optional[float] = None,
    bounces: float = 0,
    fit: str = "auto",
    denoise: bool = True,
    lamps: str = "all",
    lamp_radius: float = 0.0,
    lamp_rays: int = 64,
    lamp_groups: Sequence[Tuple[str, str]] = (),
    subsurface: Optional[Mapping[str, Any]] = None,
    metres_per_unit: float = 1.0,
    lightmap: Optional[Mapping[str, Any]] = None,
    volume: Optional[Mapping[str, Any]] = None,
    instances: str = "own",
    instance_error: float = 0.1,
    instance_lights: Sequence[LightLike] = (),
    levels: str = "carry",
    refine: Optional[float] = None,
    max_vertices: int = 0,
    back_sides: str = "auto",
    high_poly: Optional[PathLike] = None,
    high_poly_distance: Optional[float] = None,
    no_shadow: Sequence[str] = (),
    stored_lobes: str = "keep",
    enclosed: str = "refill",
    device: str = "auto",
    method: str = "trace",
    raster_resolution: int = 1024,
    storage: str = "auto",
    bake_memory_limit: float = 0.0,
    seed: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> Model:
    """Bake the transfer of a scene, as `prt bake`, and return a model that contains it.

    scene: a Model or a path. order: SH order, 1..10. rays: per vertex, texel or probe. target_error: relative L2
    noise of direct light; chooses the number of rays instead. bounces: 0 to 10000, or math.inf. fit: auto, vertex
    or surface. lamps: all, indirect or none. lamp_groups: pairs (name, pattern). subsurface: {material: medium},
    "" for all materials; a medium is a name, such as "marble", or six coefficients in 1/mm, scattering and
    absorption of red, green and blue. lightmap: {"size": 512} or {"per_metre": 64}, also "unwrap", "uv", "atlas";
    texels instead of vertices. volume: {"spacing": 0.5} or {"probes": 4000}, also "error", "order", "rays", "fit",
    "bounds" [[x0, y0, z0], [x1, y1, z1]]. instances: own, shared or auto. levels: carry, own or ignore. refine:
    relative L2 to split triangles for. back_sides: auto or shared. high_poly: path of a detailed model.
    no_shadow: names of materials. enclosed: refill or keep. device: auto, cpu, gpu, or the name of a GPU. method:
    trace or raster. storage: auto, float16 or float32. `prt bake --help-all` explains all of them.

    The device that traced is `figures["device"]` of the result; a GPU that was asked for and is missing is an
    Error.
    """
    options = _given(
        {
            "order": order,
            "rays": None if target_error is not None else rays,
            "target_error": target_error,
            "bounces": float(bounces),
            "fit": None if lightmap else fit,
            "denoise": denoise,
            "lamps": lamps,
            "lamp_radius": lamp_radius,
            "lamp_rays": lamp_rays,
            "lamp_groups": list(lamp_groups),
            "subsurface": subsurface,
            "metres_per_unit": metres_per_unit,
            "lightmap": lightmap,
            "volume": volume,
            "instances": instances,
            "instance_error": instance_error,
            "levels": levels,
            "refine": refine,
            "max_vertices": max_vertices,
            "back_sides": back_sides,
            "high_poly": None if high_poly is None else os.fspath(high_poly),
            "high_poly_distance": high_poly_distance,
            "no_shadow": list(no_shadow),
            "stored_lobes": stored_lobes,
            "enclosed": enclosed,
            "device": device,
            "method": method,
            "raster_resolution": raster_resolution,
            "storage": storage,
            "bake_memory_limit": bake_memory_limit,
            "seed": seed,
            "threads": threads,
        }
    )
    with light_files(instance_lights) as paths:
        options["instance_lights"] = paths
        return _finished(_prtkit.bake(as_model(scene), options, progress))


def compress(
    model: ModelLike,
    *,
    preset: Optional[str] = None,
    max_error: Optional[float] = None,
    bytes_per_vertex: Optional[float] = None,
    shader_operations: Optional[float] = None,
    max_jump: Optional[float] = None,
    clusters: Optional[int] = None,
    components: Optional[int] = None,
    bits: Optional[int] = None,
    float_weights: bool = False,
    predictors: str = "auto",
    lights: Sequence[LightLike] = (),
    light_family: str = "outdoor",
    seam_weight: float = 1.0,
    best_effort: bool = False,
    combine_direct: bool = False,
    reorder: bool = False,
    meshopt: bool = False,
    volume_bytes: Optional[int] = None,
    seed: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> Model:
    """Compress a bake by clustered PCA, as `prt compress`, and return the compressed model.

    preset: u32 (default), u64, u32x4 or u64x9. Instead of a preset a goal, which takes several times as long:
    max_error, limit of "lit_rms" of the figures (0.03: 3 %) and of contrast errors, bytes_per_vertex with bases, shader_operations; or sizes: clusters, components, bits,
    float_weights. max_jump: of the contrast error between clusters. predictors: auto, none, normal or position.
    lights: light that the error is minimised for, paths or lights; without it light_family: outdoor, indoor, day,
    natural or plain. best_effort: return the closest result if no result meets the goal. reorder: sort vertices by
    cluster. `prt compress --help-all` explains all of them. Raises Error if no result meets the goal.
    """
    options = _given(
        {
            "preset": preset,
            "max_error": max_error,
            "bytes_per_vertex": bytes_per_vertex,
            "shader_operations": shader_operations,
            "max_jump": max_jump,
            "clusters": clusters,
            "components": components,
            "bits": bits,
            "float_weights": float_weights,
            "predictors": predictors,
            "light_family": light_family,
            "seam_weight": seam_weight,
            "best_effort": best_effort,
            "combine_direct": combine_direct,
            "reorder": reorder,
            "meshopt": meshopt,
            "volume_bytes": volume_bytes,
            "seed": seed,
            "threads": threads,
        }
    )
    with light_files(lights) as paths:
        options["lights"] = paths
        return _finished(_prtkit.compress(as_model(model), options, progress))


def decode(model: ModelLike, *, threads: int = 0) -> NDArray[np.float32]:
    """Return the transfer vectors of a bake or a compressed model, [receivers, coefficients], float32.

    `model.terms` has the columns of each term; `Model.transfer` is a view of a bake's vectors without a copy.
    """
    return as_model(model).decode(threads)


def _report(baked, shipped, lights, options, progress):
    with light_files(lights) as paths:
        options = {**_given(options), "lights": paths}
        shipped = None if shipped is None else as_model(shipped)
        return json.loads(_prtkit.evaluate(as_model(baked), shipped, options, progress))


def evaluate(
    baked: ModelLike,
    shipped: ModelLike,
    *,
    lights: Sequence[LightLike] = (),
    suns: Optional[int] = None,
    rotations: int = 1,
    threads: int = 0,
    progress: Progress = None,
) -> Dict[str, Any]:
    """Measure the error of a compressed model, or of another bake, against its bake, as `prt evaluate`.

    lights: paths or lights; without it a uniform sky, an overcast sky and a sun. suns: number of suns of each
    light that the renderer shadows; None: all that are worth it. rotations: of each light about +Y. Returns the
    report: "verdict", "relative_l2", "lights" (a list of records, errors as fractions) and others; the keys are
    those of `prt evaluate --json`.
    """
    options = {"suns": suns, "rotations": rotations, "threads": threads}
    return _report(baked, shipped, lights, options, progress)


def budget(
    baked: ModelLike,
    shipped: Optional[ModelLike] = None,
    *,
    lights: Sequence[LightLike] = (),
    suns: Optional[int] = None,
    no_shadow: Sequence[str] = (),
    threads: int = 0,
    progress: Progress = None,
) -> Dict[str, Any]:
    """Measure the parts of the surface error by cause, against path tracing, as `prt evaluate --measure budget`.

    Bakes once more and path traces; takes minutes for large scenes. Returns the report with its tables as lists
    of records.
    """
    options = {"suns": suns, "no_shadow": list(no_shadow), "threads": threads, "measures": ["budget"]}
    return _report(baked, shipped, lights, options, progress)


def sweep(
    baked: ModelLike,
    *,
    lights: Sequence[LightLike] = (),
    threads: int = 0,
    progress: Progress = None,
) -> List[Dict[str, Any]]:
    """Measure error against bytes and shader cost of several compression methods; takes minutes.

    Returns records, one per point: `pandas.DataFrame(prtkit.sweep(model))`. Keys: "table" (equal_bytes or
    equal_shader_operations), "method", "setting", "bytes_per_vertex", "shader_operations", "lit_rms" and "relative_l2"
    (fractions), "seconds" and others.
    """
    report = _report(baked, None, lights, {"threads": threads, "measures": ["sweep"]}, progress)
    tables: Dict[str, Any] = report["sweep"]
    return [{"table": name, **row} for name, rows in tables.items() if isinstance(rows, list) for row in rows]


def relight(
    model: ModelLike,
    light: Optional[LightLike] = None,
    *,
    lamps: Optional[Mapping[str, Any]] = None,
    rays: int = 256,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.float32]:
    """Return the exit radiance of every vertex for albedo 1, [vertices, 3], float32, linear Rec. 709.

    model: a bake or a compressed model, or its path; of a lightmap the result is [texels, 3]. light: path of an
    environment map or light file, coefficients [order², 3], or a `Light`; None: no sky. Suns of the light have
    sharp shadows by `rays` rays each, if the transfer has a separate direct term; otherwise they are part of the
    sky. lamps: {name: strength or (r, g, b)}, "*" for all others; 1: as in the scene.
    """
    lit = as_model(model)
    order = max(lit.order, 1)
    sky = Light(np.zeros((order**2, 3), np.float32)) if light is None else as_light(light, order, threads)
    if not 1 <= rays <= 1 << 24:
        raise ValueError(f"rays must be in 1..2^24, not {rays}")
    coefficients = np.zeros((max(order, sky.order) ** 2, 3), np.float32)  # bands that it lacks are 0
    coefficients[: len(sky.sky)] = sky.sky
    suns = [
        (tuple(map(float, s.towards)), tuple(map(float, s.irradiance)), float(s.half_angle)) for s in sky.suns
    ]
    return _prtkit.relight(lit, coefficients, suns, json.dumps(_strengths(lamps)), rays, threads, progress)


def render(
    model: ModelLike,
    light: Optional[LightLike] = None,
    *,
    baked: Optional[ModelLike] = None,
    suns: Optional[int] = None,
    lamps: Optional[Mapping[str, Any]] = None,
    lamp_scale: float = 1.0,
    size: Tuple[int, int] = (1280, 720),
    samples: int = 2,
    camera: Optional[ArrayLike] = None,
    look_at: Optional[ArrayLike] = None,
    fov: float = 35.0,
    exposure: Optional[float] = None,
    tone_map: str = "filmic",
    show: str = "lit",
    background: bool = True,
    path_trace: int = 0,
    linear: bool = False,
    device: str = "auto",
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[Any]:
    """Draw a picture, as `prt render`. Ctrl-C ends path tracing within a second, other pictures at their end.

    Returns display values [height, width, 3], uint8, sRGB; with linear=True radiance, float32, linear Rec. 709.
    light: path, coefficients or Light. camera, look_at: points in metres; None: the whole scene is visible.
    fov: vertical, degrees. exposure: stops; None: automatic. tone_map: filmic or srgb. show: lit, clusters, ao, or
    error (against `baked` or path_trace). path_trace: paths per pixel of a reference; 0: light by transfer.
    device: auto, cpu or gpu.
    """
    options = _given(
        {
            "suns": suns,
            "lamp_scale": lamp_scale,
            "size": tuple(size),
            "samples": samples,
            "camera": None if camera is None else [float(v) for v in camera],
            "look_at": None if look_at is None else [float(v) for v in look_at],
            "fov": fov,
            "exposure": exposure,
            "tone_map": tone_map,
            "show": show,
            "background": background,
            "path_trace": path_trace,
            "linear": linear,
            "device": device,
            "threads": threads,
        }
    )
    with light_files([] if light is None else [light]) as paths, tempfile.TemporaryDirectory() as folder:
        if paths:
            options["light"] = paths[0]
        if lamps is not None:
            options["lamps"] = os.path.join(folder, "lamps.json")
            with open(options["lamps"], "w", encoding="utf-8") as file:
                json.dump(_strengths(lamps), file)
        reference = None if baked is None else as_model(baked)
        picture, _, notices = _prtkit.render(as_model(model), reference, options, progress)
    log_notices(notices)
    return picture


def _occlusion(scene, options, progress):
    options = {name: value for name, value in options.items() if value is not None}
    return _prtkit.occlusion(as_model(scene), options, progress)


def ambient_occlusion(
    scene: ModelLike,
    *,
    rays: int = 1024,
    target_error: Optional[float] = None,
    falloff: Sequence[Tuple[float, float]] = (),
    max_distance: float = math.inf,
    fit: str = "auto",
    denoise: bool = True,
    enclosed: str = "refill",
    no_shadow: Sequence[str] = (),
    device: str = "auto",
    seed: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.float32]:
    """Return the share of a uniform sky's light that arrives at each vertex, [vertices], float32, 0..1.

    falloff: pairs (distance in metres, weight): surfaces at the distance block half of the light. max_distance:
    farther surfaces do not block. Other parameters: as of `bake`.
    """
    options = dict(
        rays=rays,
        target_error=target_error,
        falloff=list(falloff),
        max_distance=max_distance,
        fit=fit,
        denoise=denoise,
        enclosed=enclosed,
        no_shadow=list(no_shadow),
        device=device,
        seed=seed,
        threads=threads,
    )
    return _occlusion(scene, options, progress)[0]


def bent_normals(
    scene: ModelLike,
    *,
    rays: int = 1024,
    no_shadow: Sequence[str] = (),
    device: str = "auto",
    seed: int = 0,
    threads: int = 0,
    progress: Progress = None,
) -> NDArray[np.float32]:
    """Return the mean unoccluded direction at each vertex, weighted by the cosine, [vertices, 3], float32, unit.

    A vertex that no light reaches has its own normal.
    """
    options = dict(rays=rays, no_shadow=list(no_shadow), device=device, seed=seed, threads=threads)
    return _occlusion(scene, options, progress)[1]
