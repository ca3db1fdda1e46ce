#pragma once

// Options of C++ from dictionaries of Python.

#include "prt/core/error.h"

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

namespace prt::python {

namespace py = pybind11;

/// Removes `name` from `options` and writes its value to `target`, unless it is missing or None. Throws
/// `Error` if the value has the wrong type.
template <class T>
void take(py::dict& options, const char* name, T& target) {
    if (!options.contains(name))
        return;
    const py::object value = options.attr("pop")(name);
    if (value.is_none())
        return;
    try {
        target = value.cast<T>();
    } catch (const py::cast_error&) {
        throw Error(std::string(name) + ": " + py::repr(value).cast<std::string>() + " has the wrong type");
    }
}
template <class T>
void take(py::dict& options, const char* name, std::optional<T>& target) {
    T value{};
    if (!options.contains(name) || options[name].is_none()) {
        options.attr("pop")(name, py::none());
        return;
    }
    take(options, name, value);
    target = std::move(value);
}

/// Like `take`, for one of several names.
template <class T>
void choose(py::dict& options, const char* name, T& target,
            std::initializer_list<std::pair<const char*, T>> choices) {
    std::optional<std::string> given;
    take(options, name, given);
    if (!given)
        return;
    std::string names;
    for (const auto& [text, value] : choices) {
        if (*given == text) {
            target = value;
            return;
        }
        names += std::string(names.empty() ? "" : ", ") + text;
    }
    throw Error(std::string(name) + ": '" + *given + "' is not one of " + names);
}

/// Throws `Error` if options are left.
inline void check_empty(const py::dict& options) {
    for (const auto& [name, value] : options)
        throw Error("unknown option " + py::str(name).cast<std::string>());
}

} // namespace prt::python
