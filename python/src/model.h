#pragma once

// The class Model of the Python package: a glTF file in memory, with its transfer.

#include "cli/pipeline/model.h"
#include "prt/core/transfer_view.h"
#include "python/src/call.h"

#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <vector>

namespace prt::python {

/// A file in memory.
struct Model {
    pipeline::Path name;              ///< for messages
    std::vector<std::byte> bytes;     ///< a complete .glb file
    pipeline::ReadingOptions reading; ///< with which `bytes` are read
    pipeline::SceneFile file;         ///< content of `bytes`
    nlohmann::ordered_json figures;   ///< report of the step that made it; null for a loaded file
    std::vector<std::string> notices; ///< about reading and making it

    pipeline::FileSource source() const { return {name, bytes}; }
    /// Returns the raw or compressed transfer of the surfaces. Throws `Error` for a model without
    /// transfer.
    TransferView transfer() const;
};

/// Reads a file. Call it without the GIL.
std::shared_ptr<Model> read_model(pipeline::Path name, std::vector<std::byte> bytes,
                                  pipeline::ReadingOptions reading);

/// Options of reading files, from the keyword arguments of Python. Removes what it reads from `options`.
pipeline::ReadingOptions reading_options(py::dict& options);

void add_model(py::module_& module);

} // namespace prt::python
