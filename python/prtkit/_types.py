"""Types of parameters."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Callable, Optional, Union

PathLike = Union[str, "os.PathLike[str]"]
#: A NumPy array, nested lists, or an object with `__array_interface__`, `__array__` or `__dlpack__`.
ArrayLike = Any
#: Receives the title of a stage and its finished fraction, 0..1.
Progress = Optional[Callable[[str, float], None]]

if TYPE_CHECKING:
    from ._light import Light
    from ._prtkit import Model

    LightLike = Union[PathLike, ArrayLike, Light]
    ModelLike = Union[PathLike, Model]
else:
    LightLike = ModelLike = Any
