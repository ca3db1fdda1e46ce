// Computes radiance of texels tile by tile: two rows at a time stay in the cache until they and the row of
// the next level are written.

#include "prt/core/lightmap.h"

#include "runtime/support/parallel.h"
#include "runtime/transfer/evaluate_range.h"
#include "runtime/transfer/texel_formats.h"

#include <algorithm>
#include <cassert>

namespace prt {
namespace {

constexpr int kTile = 4 * kLaneCount; ///< texels along a row

/// Transposes texels to separate color lanes.
[[gnu::always_inline]] inline RadianceLanes lanes_of(const glm::vec3* texels) {
    RadianceLanes lanes;
    for (std::size_t i = 0; i < kLaneCount; ++i)
        for (int c = 0; c < 3; ++c)
            lanes.colors[c][i] = texels[i][c];
    return lanes;
}

PRT_TARGET_CLONES
void write_row(LightmapFormat format, const glm::vec3* texels, int count, std::byte* to) {
    const std::size_t size = bytes_per_texel(format);
    for (int x = 0; x < count; x += kLaneCount)
        write_texels(format, lanes_of(texels + x), static_cast<std::size_t>(std::min(kLaneCount, count - x)),
                     to + static_cast<std::size_t>(x) * size);
}

/// Averages two by two texels. If only one row or column is left, it is used twice.
void halve(const glm::vec3* upper, const glm::vec3* lower, int count, glm::vec3* means) {
    for (int x = 0; x < std::max(1, count / 2); ++x) {
        const int left = 2 * x, right = std::min(2 * x + 1, count - 1);
        means[x] = 0.25f * (upper[left] + upper[right] + lower[left] + lower[right]);
    }
}

std::vector<LightmapLevel> levels_of(const LightmapSize& map, std::size_t texel) {
    std::vector<LightmapLevel> levels = {{map.width, map.height, 0}};
    while (levels.back().width > 1 || levels.back().height > 1) {
        const LightmapLevel& last = levels.back();
        const std::size_t bytes =
            static_cast<std::size_t>(last.width) * static_cast<std::size_t>(last.height) * texel;
        levels.push_back({std::max(1, last.width / 2), std::max(1, last.height / 2), last.first + bytes});
    }
    return levels;
}

} // namespace

std::size_t bytes_per_texel(LightmapFormat format) {
    return format == LightmapFormat::rgba16 ? 8 : 4;
}

LightmapRelighter::LightmapRelighter(const CompressedLightmap& lightmap, LightmapFormat format)
    : lightmap_(lightmap), format_(format), clusters_(cluster_layouts(lightmap.compressed.transfer.bases)),
      first_texels_(lightmap.layout.first_texels()) {
    for (const LightmapSize& map : lightmap.layout.maps)
        levels_.push_back(levels_of(map, bytes_per_texel(format)));
}

std::size_t LightmapRelighter::bytes(std::size_t map) const {
    return levels_[map].back().first + bytes_per_texel(format_);
}

void LightmapRelighter::update_rows(std::size_t map, std::span<const glm::vec4> constants, int first,
                                    int last, std::span<std::byte> texels) const {
    assert(texels.size() >= bytes(map));
    const std::size_t size = bytes_per_texel(format_);
    const LightmapLevel& level = levels_[map][0];
    const LightmapLevel* const half = levels_[map].size() > 1 ? &levels_[map][1] : nullptr;
    const auto position = [&](const LightmapLevel& in, int x, int y) {
        return texels.data() + in.first +
               (static_cast<std::size_t>(y) * static_cast<std::size_t>(in.width) +
                static_cast<std::size_t>(x)) *
                   size;
    };
    glm::vec3 rows[2][kTile] = {}, means[kTile] = {};
    for (int y = first; y < last; y += 2)
        for (int x = 0; x < level.width; x += kTile) {
            const int count = std::min(kTile, level.width - x), height = std::min(2, level.height - y);
            for (int r = 0; r < height; ++r) {
                const std::size_t begin =
                    first_texels_[map] +
                    static_cast<std::size_t>(y + r) * static_cast<std::size_t>(level.width) +
                    static_cast<std::size_t>(x);
                evaluate_range(lightmap_.compressed.transfer.receivers, clusters_.data(), constants.data(),
                               begin, begin + static_cast<std::size_t>(count), rows[r]);
                write_row(format_, rows[r], count, position(level, x, y + r));
            }
            const bool is_there = half && y / 2 < half->height && (x == 0 || x / 2 < half->width);
            if (!is_there)
                continue;
            halve(rows[0], rows[height - 1], count, means);
            write_row(format_, means, std::min(std::max(1, count / 2), half->width - x / 2),
                      position(*half, x / 2, y / 2));
        }
}

void LightmapRelighter::update_smaller_levels(std::size_t map, std::span<std::byte> texels) const {
    const std::size_t size = bytes_per_texel(format_);
    glm::vec3 rows[2][kTile] = {}, means[kTile] = {};
    for (std::size_t l = 2; l < levels_[map].size(); ++l) {
        const LightmapLevel &from = levels_[map][l - 1], &to = levels_[map][l];
        for (int y = 0; y < to.height; ++y)
            for (int x = 0; x < std::max(1, from.width / 2 * 2); x += kTile) {
                const int count = std::min(kTile, from.width - x), height = std::min(2, from.height - 2 * y);
                for (int r = 0; r < height; ++r)
                    for (int i = 0; i < count; ++i)
                        rows[r][i] = read_texel(format_, texels.data() + from.first +
                                                             (static_cast<std::size_t>(2 * y + r) *
                                                                  static_cast<std::size_t>(from.width) +
                                                              static_cast<std::size_t>(x + i)) *
                                                                 size);
                halve(rows[0], rows[height - 1], count, means);
                write_row(format_, means, std::max(1, count / 2),
                          texels.data() + to.first +
                              (static_cast<std::size_t>(y) * static_cast<std::size_t>(to.width) +
                               static_cast<std::size_t>(x / 2)) *
                                  size);
            }
    }
}

void LightmapRelighter::update(std::size_t map, std::span<const glm::vec4> constants,
                               std::span<std::byte> texels, int threads) const {
    const int height = levels_[map][0].height;
    constexpr int kRowsAtOnce = 16;
    if (thread_count(threads) == 1)
        update_rows(map, constants, 0, height, texels);
    else
        parallel_for(static_cast<std::size_t>(height), kRowsAtOnce, threads,
                     [&](std::size_t begin, std::size_t end) {
                         update_rows(map, constants, static_cast<int>(begin), static_cast<int>(end), texels);
                     });
    update_smaller_levels(map, texels);
}

} // namespace prt
