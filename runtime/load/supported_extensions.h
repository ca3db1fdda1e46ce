#pragma once

// Extensions of glTF that prtkit supports.

#include "runtime/load/json.h"

#include <string_view>

namespace prt {

inline constexpr const char* kCesiumExtension = "CESIUM_RTC";

/// Returns whether a file may list `name` in extensionsRequired.
bool is_supported_extension(std::string_view name);
/// Throws `Error` if the file requires an extension that is not supported.
void check_required_extensions(const Json& json);

} // namespace prt
