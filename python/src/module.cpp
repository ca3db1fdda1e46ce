// The module prtkit._prtkit: functions that the Python files of the package call.

#include "prt/core/error.h"
#include "prt/core/version.h"
#include "python/src/light.h"
#include "python/src/model.h"
#include "python/src/work.h"

#include <pybind11/pybind11.h>

#include <string>

namespace {

/// Raises an exception with a message that may contain bytes which are not UTF-8.
void raise(PyObject* type, const std::string& message) {
    PyObject* text = PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "replace");
    PyErr_SetObject(type, text);
    Py_XDECREF(text);
}

} // namespace

PYBIND11_MODULE(_prtkit, module) {
    namespace py = pybind11;
    module.doc() = "Functions in C++ of the package prtkit; use the package itself.";
    module.attr("version") = std::to_string(PRTKIT_VERSION_MAJOR) + "." +
                             std::to_string(PRTKIT_VERSION_MINOR) + "." +
                             std::to_string(PRTKIT_VERSION_PATCH);
    static const py::exception<prt::Error> error(module, "Error", PyExc_RuntimeError);
    static const py::exception<prt::Cancelled> cancelled(module, "Cancelled", PyExc_RuntimeError);
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            if (thrown)
                std::rethrow_exception(thrown);
        } catch (const prt::Cancelled& e) {
            raise(cancelled.ptr(), e.what());
        } catch (const prt::Error& e) {
            raise(error.ptr(), e.what());
        }
    });
    prt::python::add_model(module);
    prt::python::add_work(module);
    prt::python::add_mesh(module);
    prt::python::add_light(module);
}
