#include "gltf/reread.h"

#include "gltf/contents.h"
#include "prt/encode_glb.h"

namespace prt {

GltfDocument reread(const GltfDocument& document, Instancing instancing) {
    // What could be read of images is inside by now.
    GltfDocument again = parse_gltf(encode_glb(document), document.contents().path,
                                    {.missing_images = MissingImages::ignore, .instancing = instancing});
    again.contents().notices = document.contents().notices;
    return again;
}

} // namespace prt
