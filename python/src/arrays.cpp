// Converts between NumPy arrays and containers of prtkit.

#include "python/src/arrays.h"

#include "prt/core/error.h"
#include "prt/core/sh_basis.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace prt::python {
namespace {

template <class T, class Array>
std::vector<T> rows_of(const Array& array, const std::string& what) {
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw Error(what + " must have the shape (N, 3), not " + shape_in_words(array));
    std::vector<T> rows(static_cast<std::size_t>(array.shape(0)));
    if (!rows.empty())
        std::memcpy(rows.data(), array.data(), rows.size() * sizeof(T));
    return rows;
}

} // namespace

std::string shape_in_words(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t axis = 0; axis < array.ndim(); ++axis)
        text += (axis > 0 ? ", " : "") + std::to_string(array.shape(axis));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

std::vector<glm::dvec3> double_rows(const Doubles& array, const std::string& what) {
    return rows_of<glm::dvec3>(array, what);
}

std::vector<glm::vec3> float_rows(const Floats& array, const std::string& what) {
    return rows_of<glm::vec3>(array, what);
}

std::vector<glm::uvec3> triangles_of(const py::array& array, std::size_t vertices) {
    if (array.ndim() != 2 || array.shape(1) != 3)
        throw Error("faces must have the shape (F, 3), not " + shape_in_words(array));
    if (array.dtype().kind() != 'i' && array.dtype().kind() != 'u')
        throw Error("faces must be integers, not " + py::str(array.dtype()).cast<std::string>());
    const auto indices = py::array_t<std::int64_t, py::array::c_style | py::array::forcecast>(array);
    const std::span all(indices.data(), static_cast<std::size_t>(indices.size()));
    std::vector<glm::uvec3> triangles(all.size() / 3);
    for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i] < 0 || static_cast<std::size_t>(all[i]) >= vertices)
            throw Error("face " + std::to_string(i / 3) + " refers to vertex " + std::to_string(all[i]) +
                        ", but there are only " + std::to_string(vertices));
        triangles[i / 3][static_cast<int>(i % 3)] = static_cast<unsigned>(all[i]);
    }
    return triangles;
}

py::array_t<float> copied(std::span<const float> values, std::size_t rows, std::size_t columns) {
    std::vector<py::ssize_t> shape = {static_cast<py::ssize_t>(rows)};
    if (columns > 0)
        shape.push_back(static_cast<py::ssize_t>(columns));
    py::array_t<float> array(shape);
    std::ranges::copy(values, array.mutable_data());
    return array;
}

py::array_t<float> copied(std::span<const glm::vec3> values) {
    const std::span flat(values.empty() ? nullptr : &values.front().x, 3 * values.size());
    return copied(flat, values.size(), 3);
}

py::array_t<float> viewed(std::span<const float> values, std::size_t rows, std::size_t columns,
                          const py::object& owner) {
    py::array_t<float> array({static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(columns)},
                             values.data(), owner);
    array.attr("setflags")(py::arg("write") = false);
    return array;
}

int order_of(std::size_t coefficients) {
    for (int order = 1; order <= kMaxOrder; ++order)
        if (static_cast<std::size_t>(coefficient_count(order)) == coefficients)
            return order;
    throw Error("the number of coefficients must be 1, 4, 9, ... or 100 (order²), not " +
                std::to_string(coefficients));
}

Light light_of(const Floats& coefficients) {
    Light light{0, float_rows(coefficients, "the coefficients of a light")};
    light.order = order_of(light.coefficients.size());
    for (const glm::vec3& c : light.coefficients)
        if (!std::isfinite(c.x + c.y + c.z))
            throw Error("a coefficient of the light is not finite");
    return light;
}

} // namespace prt::python
