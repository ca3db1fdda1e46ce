// Packs rectangles by the skyline of stb_rect_pack.

#include "bake/products/lightmaps/chart_packing.h"

// Its code is compiled here, with names that no other library shares.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#define STBRP_STATIC
#define STB_RECT_PACK_IMPLEMENTATION
#include <stb/stb_rect_pack.h>
#pragma GCC diagnostic pop

namespace prt {

std::optional<std::vector<glm::ivec2>> pack_rectangles(std::span<const glm::ivec2> sizes, int side) {
    std::vector<stbrp_rect> rectangles;
    for (const glm::ivec2& size : sizes) {
        if (size.x > side || size.y > side)
            return std::nullopt;
        stbrp_rect rectangle{};
        rectangle.id = static_cast<int>(rectangles.size());
        rectangle.w = static_cast<stbrp_coord>(size.x);
        rectangle.h = static_cast<stbrp_coord>(size.y);
        rectangles.push_back(rectangle);
    }
    std::vector<stbrp_node> nodes(static_cast<std::size_t>(side));
    stbrp_context context;
    stbrp_init_target(&context, side, side, nodes.data(), side);
    if (!stbrp_pack_rects(&context, rectangles.data(), static_cast<int>(rectangles.size())))
        return std::nullopt;
    std::vector<glm::ivec2> corners(sizes.size());
    for (const stbrp_rect& rectangle : rectangles)
        corners[static_cast<std::size_t>(rectangle.id)] = {rectangle.x, rectangle.y};
    return corners;
}

} // namespace prt
