"""Light: environment maps, suns and SH coefficients."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import logging
import os
import tempfile
from typing import Optional, Union

import numpy as np
from numpy.typing import NDArray

from . import _prtkit
from ._arrays import real_array
from ._sh import MAX_ORDER, convert, order_of
from ._types import ArrayLike, PathLike

_log = logging.getLogger("prtkit")


@dataclasses.dataclass(frozen=True)
class Sun:
    """A distant disc of uniform radiance.

    towards: unit direction from the receiver to its center, [3]. irradiance: on a receiver that faces it, linear
    Rec. 709, [3]. half_angle: from the center to the rim, radians; 0: a directional light.
    """

    towards: tuple
    irradiance: tuple
    half_angle: float = 0.0

    def coefficients(self, order):
        """Return the sun as SH radiance, [order², 3], float32."""
        return _prtkit.sun_light(self.towards, self.irradiance, self.half_angle, order)


@dataclasses.dataclass(frozen=True, eq=False)
class Light:
    """Distant light: SH coefficients of a sky, and suns that are separate from it.

    sky: [order², 3] in the convention of prtkit. suns: a sequence of `Sun`.
    """

    sky: np.ndarray
    suns: tuple = ()

    @property
    def order(self):
        return order_of(len(self.sky))

    def combined(self):
        """Return the coefficients of sky and suns, [order², 3]."""
        total = np.array(self.sky, dtype=np.float32)
        for sun in self.suns:
            total += sun.coefficients(self.order)
        return total


def _options(layout, window, rotate, layer, bad_pixels):
    return {"layout": layout, "window": window, "rotate": rotate, "layer": layer, "bad_pixels": bad_pixels}


def _loaded(environment, order, suns, options, threads):
    if isinstance(environment, (str, os.PathLike)):
        sky, combined, found, notices = _prtkit.load_light(
            os.fspath(environment), order, suns, options, threads
        )
    else:
        image = real_array(environment, "environment")
        sky, combined, found, notices = _prtkit.light_of_image(image, order, suns, options, threads)
    for notice in notices:
        _log.info("%s", notice)
    return sky, combined, tuple(Sun(tuple(t), tuple(i), a) for t, i, a in found)


def project(
    environment: Union[PathLike, ArrayLike],
    *,
    order: int = 6,
    convention: str = "prtkit",
    layout: str = "auto",
    window: str = "none",
    rotate: float = 0.0,
    layer: str = "",
    bad_pixels: str = "error",
    threads: int = 0,
) -> NDArray[np.float32]:
    """Return the SH coefficients of an environment map, [order², 3], float32.

    environment: path of an image (.exr, .hdr, .png, .jpg) or light file (.json), or an array [height, width, 3]
    of linear radiance. layout: auto, lat-long, lat-long-x, cube, cube-faces or angular (docs/conventions.md).
    window: none, hann, lanczos or auto, a filter against ringing. rotate: degrees about +Y. layer: layer of an
    EXR file. bad_pixels: error, zero or clamp. The radiance of each texel is integrated over its solid angle.
    """
    options = _options(layout, window, rotate, layer, bad_pixels)
    _, combined, _ = _loaded(environment, order, 0, options, threads)
    return combined if convention == "prtkit" else convert(combined, "prtkit", convention).astype(np.float32)


def separate_suns(
    environment: Union[PathLike, ArrayLike],
    *,
    order: int = 6,
    count: Optional[int] = None,
    layout: str = "auto",
    window: str = "none",
    rotate: float = 0.0,
    layer: str = "",
    bad_pixels: str = "error",
    threads: int = 0,
) -> Light:
    """Return the `Light` of an environment map: a sky, and the suns that are separate from it.

    count: maximum number of suns; None: those that are worth a shadow map, at most 4. Other parameters: as of
    `project`.
    """
    options = _options(layout, window, rotate, layer, bad_pixels)
    sky, _, suns = _loaded(environment, order, count, options, threads)
    return Light(sky, suns)


def as_light(light, order, threads=0):
    """Return a path, coefficients or Light as a checked `Light`; an image gets `order` bands."""
    if isinstance(light, Light):
        return _checked(light)
    if isinstance(light, (str, os.PathLike)):
        return separate_suns(light, order=order, threads=threads)
    return _checked(Light(np.asarray(real_array(light, "light"), dtype=np.float32)))


def _checked(light):
    """Return a light with valid coefficients. Raises ValueError."""
    sky = np.asarray(light.sky)
    if sky.ndim != 2 or sky.shape[1] != 3:
        raise ValueError(f"the coefficients of a light must have the shape (order², 3), not {sky.shape}")
    order_of(len(sky))
    if not np.isfinite(sky).all():
        raise ValueError("a coefficient of the light is not finite")
    for sun in light.suns:
        numbers = [*sun.towards, *sun.irradiance, sun.half_angle]
        if len(numbers) != 7 or not np.isfinite(numbers).all() or min(sun.irradiance) < 0:
            raise ValueError("a sun must have a finite direction, irradiance of 0 or more, and a half angle")
    return light


def _text(light):
    """Return a light file. Bands above those of the light are 0, so that it has enough of them."""
    sky = np.zeros((MAX_ORDER**2, 3))
    sky[: len(light.sky)] = light.sky
    channels = {name: [float(v) for v in sky[:, c]] for c, name in enumerate(("red", "green", "blue"))}
    file = {"prtkit_light": 1, "order": MAX_ORDER, "coefficients": channels}
    if light.suns:
        file["suns"] = [
            {
                "towards": [float(v) for v in sun.towards],
                "irradiance": [float(v) for v in sun.irradiance],
                "half_angle_radians": float(sun.half_angle),
            }
            for sun in light.suns
        ]
    return json.dumps(file)


@contextlib.contextmanager
def light_files(lights):
    """Give the paths of lights: light in memory is written to temporary light files."""
    if isinstance(lights, (str, os.PathLike)):
        lights = [lights]
    with tempfile.TemporaryDirectory(prefix="prtkit") as folder:
        paths = []
        for number, light in enumerate(lights):
            if isinstance(light, (str, os.PathLike)):
                paths.append(os.fspath(light))
                continue
            path = os.path.join(folder, f"light{number}.json")
            with open(path, "w", encoding="utf-8") as file:
                file.write(_text(as_light(light, 1)))
            paths.append(path)
        yield paths
