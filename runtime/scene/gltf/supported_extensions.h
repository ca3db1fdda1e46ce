#pragma once

#include <string_view>

namespace prt {

inline constexpr const char* kCesiumExtension = "CESIUM_RTC";

/// Returns whether a file may list `name` in extensionsRequired.
bool is_supported_extension(std::string_view name);

} // namespace prt
