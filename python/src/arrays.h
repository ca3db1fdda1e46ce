#pragma once

// Conversion between NumPy arrays and containers of prtkit.

#include "prt/core/light.h"
#include "prt/core/transfer_layout.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <glm/vec3.hpp>

#include <span>
#include <string>
#include <vector>

namespace prt::python {

namespace py = pybind11;

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

/// Returns the text "(100, 3)".
std::string shape_in_words(const py::array& array);

/// Returns the rows of an array [rows][3]. Throws `Error`, which names `what`, for another shape.
std::vector<glm::dvec3> double_rows(const Doubles& array, const std::string& what);
std::vector<glm::vec3> float_rows(const Floats& array, const std::string& what);
/// Returns triangles from an array [triangles][3] of integers. Throws `Error` for another shape or type, and
/// for indices that are negative or not less than `vertices`.
std::vector<glm::uvec3> triangles_of(const py::array& array, std::size_t vertices);

/// Returns a new array [rows][columns], or [rows] if `columns` is 0, with a copy of `values`.
py::array_t<float> copied(std::span<const float> values, std::size_t rows, std::size_t columns);
/// Returns a new array [rows][3].
py::array_t<float> copied(std::span<const glm::vec3> values);
/// Returns a read-only array [rows][columns] that views `values`, which `owner` keeps.
py::array_t<float> viewed(std::span<const float> values, std::size_t rows, std::size_t columns,
                          const py::object& owner);

/// Returns the order of order² coefficients. Throws `Error` for another number, and above kMaxOrder.
int order_of(std::size_t coefficients);

/// Returns a light from coefficients [order²][3]. Throws `Error` for another shape, an order outside
/// 1..kMaxOrder, and values that are not finite.
Light light_of(const Floats& coefficients);

} // namespace prt::python
