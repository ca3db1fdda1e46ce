#pragma once

// Options for reading models.

#include "cli/pipeline/host.h"
#include "prt/gltf/gltf.h"
#include "prt/render/texture.h"

namespace prt::pipeline {

struct ReadingOptions : GltfOptions {
    BadTextures bad_textures = BadTextures::error;
    Notify notify = {}; ///< receives notices about the model
};

} // namespace prt::pipeline
