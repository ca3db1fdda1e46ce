#pragma once

// Options for reading models.

#include "cli/pipeline/host.h"
#include "prt/gltf/gltf.h"
#include "prt/render/texture.h"

namespace prt::pipeline {

/// Transfer that instances share: `Model::baked` contains it for all vertices, or only `instanced` has it.
enum class SharedTransfer { expand, keep };

struct ReadingOptions : GltfOptions {
    SharedTransfer shared = SharedTransfer::expand;
    BadTextures bad_textures = BadTextures::error;
    Notify notify = {}; ///< receives notices about the model
};

} // namespace prt::pipeline
