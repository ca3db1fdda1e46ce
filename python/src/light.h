#pragma once

#include <pybind11/pybind11.h>

namespace prt::python {

/// Adds functions of light to the module.
void add_light(pybind11::module_& module);

} // namespace prt::python
