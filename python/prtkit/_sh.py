"""Conventions of spherical harmonics, and rotation.

prtkit's basis is real and orthonormal, with the Condon-Shortley phase and polar axis z; coefficient (l, m) has
index l(l+1) + m (docs/conventions.md). A convention is a diagonal matrix: coefficient i in the convention is
`factor[i]` times that of prtkit.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from . import _prtkit
from ._arrays import real_array
from ._types import ArrayLike

MAX_ORDER = 10

#: Factors of the polynomials of Unity in the basis without phase, [9].
_POLYNOMIALS = np.sqrt(np.array([1, 3, 3, 3, 15, 15, 5 / 4, 15, 15 / 4]) / (4 * math.pi))

#: Names of conventions, and what they are.
CONVENTIONS = {
    "prtkit": "radiance, with the Condon-Shortley phase",
    "d3dx": "as prtkit: D3DX and DirectXMath",
    "pifu": "radiance, without the phase: PIFu, ICON, PaMIR and their env_sh.npy",
    "threejs": "radiance, without the phase: three.js SphericalHarmonics3",
    "unity": "SphericalHarmonicsL2, at most order 3: irradiance over pi, as factors of the polynomials 1, y, z, x, "
    "xy, yz, 3z² - 1, xz, x² - y², in the axes of the scene",
    "3dgs": "radiance, with the phase: sh of 3D Gaussian splats, without their offset of 0.5",
    "gltf": "irradiance (band l times pi, 2 pi/3, pi/4, ...), without the phase: EXT_lights_image_based",
}


def order_of(count):
    """Return the order N of N² coefficients. Raises ValueError for another number."""
    order = math.isqrt(count)
    if order * order != count or not 1 <= order <= MAX_ORDER:
        raise ValueError(f"the number of coefficients must be 1, 4, 9, ... or 100 (order²), not {count}")
    return order


def _degrees(order):
    return np.concatenate([np.full(2 * l + 1, l) for l in range(order)])


def _phase(order):
    return np.concatenate([(-1.0) ** np.abs(np.arange(-l, l + 1)) for l in range(order)])


def cosine_factors(order):
    """Return the factor of each band of the clamped cosine over pi, [order] (Ramamoorthi and Hanrahan 2001)."""
    factors = np.zeros(order)
    for l in range(order):
        if l == 0:
            factors[l] = 1
        elif l == 1:
            factors[l] = 2 / 3
        elif l % 2 == 0:
            factors[l] = (
                2
                * (-1) ** (l // 2 - 1)
                / ((l + 2) * (l - 1))
                * math.factorial(l)
                / (2**l * math.factorial(l // 2) ** 2)
            )
    return factors


def _factors(convention, order):
    if convention not in CONVENTIONS:
        raise ValueError(f"convention '{convention}' is not one of {', '.join(CONVENTIONS)}")
    if convention == "unity" and order > 3:
        raise ValueError(f"the convention 'unity' has at most order 3, not {order}")
    factors = np.ones(order * order)
    if convention in ("pifu", "threejs", "unity", "gltf"):
        factors = _phase(order)
    if convention in ("unity", "gltf"):
        scale = 1.0 if convention == "unity" else math.pi
        factors = factors * scale * cosine_factors(order)[_degrees(order)]
    if convention == "unity":
        factors = factors * _POLYNOMIALS[: order * order]
    return factors


def convert(sh: ArrayLike, source: str, target: str) -> NDArray[np.float64]:
    """Convert coefficients of light between conventions.

    sh: [order²] or [order², C], C channels. Returns a new array of the same shape, float64. Raises ValueError
    for an unknown convention, and where `source` has no information: bands 3, 5, 7 and 9 of irradiance.
    """
    values = real_array(sh, "sh").astype(np.float64)
    order = order_of(values.shape[0] if values.ndim else 0)
    divisor = _factors(source, order)
    if np.any(divisor == 0):
        raise ValueError(
            f"'{source}' stores irradiance, which has no light of odd bands above 1; use order 3"
        )
    factor = _factors(target, order) / divisor
    return values * factor.reshape((-1,) + (1,) * (values.ndim - 1))


def evaluate_basis(
    directions: ArrayLike,
    order: int,
    *,
    convention: str = "prtkit",
) -> NDArray[np.float64]:
    """Return the basis functions at unit directions [D, 3]: [D, order²], float64.

    Their product with coefficients in the convention is radiance, or what the convention stores.
    """
    _factors(convention, order)  # checks both
    basis = np.asarray(_prtkit.basis(real_array(directions, "directions"), order))
    if convention in ("pifu", "threejs", "unity", "gltf"):
        basis = basis * _phase(order)
    return basis / _POLYNOMIALS[: order * order] if convention == "unity" else basis


def rotate(
    sh: ArrayLike,
    rotation: ArrayLike,
    *,
    convention: str = "prtkit",
) -> NDArray[np.float64]:
    """Rotate coefficients of light: light from direction w then comes from R w.

    sh: [order²] or [order², C]. rotation: [3, 3], multiplies column vectors. Returns a new array, float64;
    `sh` is not changed. Raises Error if the matrix scales, shears or mirrors.
    """
    values = convert(sh, convention, "prtkit")
    flat = values.reshape(values.shape[0], -1)
    rotated = np.asarray(_prtkit.rotate(flat, real_array(rotation, "rotation"))).reshape(values.shape)
    return convert(rotated, "prtkit", convention)
