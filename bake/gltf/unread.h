#pragma once

// Contents of a file that are left out when it is read, without a notice. Experimental.

#include "prt/gltf/gltf.h"

#include <string>
#include <vector>

namespace prt {

/// Returns the names of the extensions that `extensionsUsed` of the file lists and prtkit does not support,
/// in the order of the list. Some extensions that prtkit ignores count as supported, for example those of
/// specular reflection.
std::vector<std::string> unread_extensions(const GltfDocument& document);

/// Returns descriptions of the lights of KHR_lights_punctual that no node of the file refers to, in the order
/// of the file: "light 2 'Lamp'", or "light 2" if the light has no name.
std::vector<std::string> unused_lights(const GltfDocument& document);

} // namespace prt
