#pragma once

#include "prt/gltf.h"
#include "prt/light.h"
#include "session.h"

#include <nlohmann/json.hpp>

#include <filesystem>

namespace prt::cli {

using Json = nlohmann::ordered_json;

/// Writes a report, all or nothing. An empty path: nothing is written.
void write_json(const Json& json, const std::filesystem::path& path, Interrupt& interrupt);

/// How a bake was made.
Json bake_record_json(const BakeRecord& record);

/// The light file of docs/format.md.
Json light_json(const Light& light);

/// Reads a light file: its coefficients with its lights added. Throws `Error` that names it.
Light read_light_json(const std::filesystem::path& path);

} // namespace prt::cli
