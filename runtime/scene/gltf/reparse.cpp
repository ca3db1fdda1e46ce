// Writes and parses a document.
#include "gltf/reparse.h"

#include "gltf/contents.h"
#include "prt/encode_glb.h"

namespace prt {

GltfDocument reparse(const GltfDocument& document, Instancing instancing) {
    // All readable images are embedded at this point.
    GltfDocument again =
        parse_gltf(encode_glb(document), document.contents().path,
                   {.instancing = instancing, .scene_limit = document.contents().scene_limit});
    again.contents().notices = document.contents().notices;
    return again;
}

} // namespace prt
