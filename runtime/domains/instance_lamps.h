#pragma once

// Check of the light of lamps at instances.

#include "prt/core/error.h"
#include "prt/core/instances.h"

#include <string>

namespace prt {

inline void check_instance_lamps(const TransferLayout& layout, const PlacedInstance& instance) {
    if (instance.lamps.size() != layout.lamps())
        throw Error("an instance has the light of " + std::to_string(instance.lamps.size()) +
                    " lamps, but the transfer has " + std::to_string(layout.lamps()) +
                    "; run prt bake again");
}

} // namespace prt
