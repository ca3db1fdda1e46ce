#pragma once

// Attributes of prtkit.

#include <string_view>

namespace prt {

/// Returns whether an attribute of a primitive belongs to prtkit (docs/format.md): it is added and removed
/// with transfer.
inline bool is_own_attribute(std::string_view name) {
    return name.starts_with("_PRT_");
}

/// Returns whether an attribute contains a lobe.
inline bool is_lobe_attribute(std::string_view name) {
    return name.starts_with("_PRT_LOBE_");
}

} // namespace prt
