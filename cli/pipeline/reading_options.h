#pragma once

// Options for reading models.

#include "pipeline/host.h"
#include "prt/gltf.h"
#include "prt/texture.h"

namespace prt::pipeline {

struct ReadingOptions : GltfOptions {
    BadTextures bad_textures = BadTextures::error;
    Notify notify = {}; ///< receives notices about the model
};

} // namespace prt::pipeline
