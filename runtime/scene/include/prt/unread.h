#pragma once

// Parts of a file that reading it leaves out without a notice. Experimental.

#include "prt/gltf.h"

#include <string>
#include <vector>

namespace prt {

/// Extensions that the file uses and prtkit does not read.
std::vector<std::string> unread_extensions(const GltfDocument& document);

/// Lights of KHR_lights_punctual that no node has.
std::vector<std::string> unused_lights(const GltfDocument& document);

} // namespace prt
