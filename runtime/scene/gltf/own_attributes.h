#pragma once

#include <string_view>

namespace prt {

/// Whether an attribute of a primitive is one of ours (docs/format.md): it comes and goes with transfer.
inline bool is_own_attribute(std::string_view name) {
    return name.starts_with("_PRT_");
}

} // namespace prt
