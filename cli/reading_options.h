#pragma once

// How commands read models, of the options that `add_reading` declares.

#include "prt/gltf.h"
#include "prt/texture.h"

namespace prt::cli {

struct ReadingOptions : GltfOptions {
    BadTextures bad_textures = BadTextures::error;
};

} // namespace prt::cli
