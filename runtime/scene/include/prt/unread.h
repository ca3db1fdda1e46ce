#pragma once

// Contents of a file that are left out when it is read, without a notice. Experimental.

#include "prt/gltf.h"

#include <string>
#include <vector>

namespace prt {

/// Returns the names of the extensions that the file uses and prtkit does not read.
std::vector<std::string> unread_extensions(const GltfDocument& document);

/// Returns the names of the lights of KHR_lights_punctual that no node uses.
std::vector<std::string> unused_lights(const GltfDocument& document);

} // namespace prt
