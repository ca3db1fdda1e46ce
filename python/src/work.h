#pragma once

#include <pybind11/pybind11.h>

namespace prt::python {

/// Adds functions that bake, compress, measure and draw models.
void add_work(pybind11::module_& module);
/// Adds functions that bake arrays of a mesh.
void add_mesh(pybind11::module_& module);

} // namespace prt::python
