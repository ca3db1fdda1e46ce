"""Arrays from other packages as NumPy arrays."""

import numpy as np


def as_array(value, what):
    """Return `value` as a NumPy array, without a copy where it is in host memory.

    Accepts arrays, nested lists, and objects with `__array_interface__`, `__array__` or `__dlpack__`
    (torch, jax, cupy on the host). Raises TypeError for iterators and for what has no numbers.
    """
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise TypeError(f"{what} must not have masked values")
    if isinstance(value, np.ndarray):
        return np.asarray(value)
    if hasattr(value, "detach") and hasattr(value, "cpu"):  # torch: no gradient, host memory
        value = value.detach().cpu()
    if hasattr(value, "__dlpack__") and not hasattr(value, "__array_interface__"):
        try:
            return np.from_dlpack(value)
        except (RuntimeError, BufferError, TypeError):
            pass  # a type that NumPy's reader does not know; __array__ may
    if hasattr(value, "__next__"):
        raise TypeError(f"{what} must be an array or a list, not an iterator: pass list(...)")
    array = np.asarray(value)
    if array.dtype == object:
        raise TypeError(f"{what} must be a rectangular array of numbers")
    return array


def real_array(value, what):
    """Return `value` as an array of real numbers. Raises TypeError for other types."""
    array = as_array(value, what)
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{what} must be real numbers, not {array.dtype}")
    return array
