// Clamps factors that glTF requires in 0..1.
#include "runtime/load/unit_range.h"

namespace prt {

bool UnitRange::clamp_component(float& value) {
    if (value >= 0 && value <= 1)
        return false;
    value = value > 1 ? 1.0f : 0.0f; // NaN becomes 0
    return true;
}

std::string UnitRange::notice() const {
    std::string text;
    for (const auto& [name, count] : clamped_)
        text +=
            (text.empty() ? "values clamped to 0..1: " : ", ") + name + " (" + std::to_string(count) + ")";
    return text;
}

} // namespace prt
