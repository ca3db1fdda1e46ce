// Computes textures. Maps tile by tile: two rows at a time stay in the cache until they and the row of the
// next level are written. Probes one at a time: coefficients are summed in registers, rounded once, and
// written to every brick that contains the probe.

#include "prt/core/texture_relighter.h"

#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "runtime/core/support/parallel.h"
#include "runtime/core/transfer/evaluate_range.h"
#include "runtime/domains/texel_formats.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

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
void write_row(TexelFormat format, const glm::vec3* texels, int count, std::byte* to) {
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

/// Gets rows [first, last) of levels[0], tile by tile, by fetch(x, y, count, colors), and writes their means
/// to levels[1], if there is one.
template <class Fetch>
void write_means(TexelFormat format, std::span<const TextureLevel> levels, int first, int last,
                 std::byte* texels, Fetch&& fetch) {
    const glm::ivec3 from = levels[0].size, to = levels.size() > 1 ? levels[1].size : glm::ivec3(0);
    glm::vec3 rows[2][kTile] = {}, means[kTile] = {};
    for (int y = first; y < last; y += 2)
        for (int x = 0; x < from.x; x += kTile) {
            const int count = std::min(kTile, from.x - x), height = std::min(2, from.y - y);
            for (int r = 0; r < height; ++r)
                fetch(x, y + r, count, rows[r]);
            if (x / 2 >= to.x || y / 2 >= to.y)
                continue;
            halve(rows[0], rows[height - 1], count, means);
            write_row(format, means, std::min(std::max(1, count / 2), to.x - x / 2),
                      texels + levels[1].first + levels[1].texel(x / 2, y / 2) * bytes_per_texel(format));
        }
}

std::vector<TextureLevel> levels_of(const LightmapSize& map, std::size_t texel) {
    std::vector<TextureLevel> levels = {{{map.width, map.height, 1}, 0}};
    while (levels.back().size != glm::ivec3(1)) {
        const TextureLevel& last = levels.back();
        levels.push_back({glm::max(last.size / 2, 1), last.first + last.texel(0, last.size.y) * texel});
    }
    return levels;
}

using HalfLanes [[gnu::vector_size(2 * kLaneCount)]] = std::int16_t;

/// Maximum number of values of a probe in all planes, rounded up to whole lanes.
constexpr std::size_t kMaxNumbers = 64;
static_assert(kMaxNumbers >= 3 * kMaxIncidentOrder * kMaxIncidentOrder + 4 && kMaxNumbers % kLaneCount == 0);

/// Probes, and the positions of their texels in a light texture.
struct Probes {
    const ClusteredReceivers& receivers;
    const ClusterLayout* clusters;
    const std::uint32_t *first_texels, *texels;
    std::byte* light;
    std::size_t plane; ///< bytes
};

/// Computes the coefficients of a probe, color by color, followed by the visibility of the sun.
template <std::size_t Outputs>
[[gnu::always_inline]] inline void light_probe(const Probes& probes, const glm::vec4* constants,
                                               std::size_t p, float* numbers) {
    Color sums[Outputs];
    sum_outputs(probes.receivers, probes.clusters, constants, p, sums);
    const float sun = sums[0][3];
#pragma GCC unroll 16
    for (std::size_t o = 0; o < Outputs; ++o) // the next color overwrites the fourth number
        *reinterpret_cast<ColorInMemory*>(numbers + 3 * o) = sums[o];
    numbers[3 * Outputs] = sun > 0 ? std::min(sun, 1.0f) : 0.0f;
}

/// Rounds `count` floats to half floats.
[[gnu::always_inline]] inline void round_to_halves(const float* numbers, std::size_t count,
                                                   std::int16_t* halves) {
    for (std::size_t i = 0; i < count; i += kLaneCount) {
        const Lanes values = lanes_at(numbers + i);
        const HalfLanes lanes = __builtin_convertvector(texel_formats::signed_half(values), HalfLanes);
        std::memcpy(halves + i, &lanes, sizeof lanes);
    }
}

/// Writes the numbers of a probe, `Texel` bytes to each of `planes` planes.
template <std::size_t Texel>
[[gnu::always_inline]] inline void write_probe(const Probes& probes, std::size_t p, const void* numbers,
                                               std::size_t planes) {
    for (std::uint32_t t = probes.first_texels[p]; t < probes.first_texels[p + 1]; ++t)
        for (std::size_t k = 0; k < planes; ++k)
            std::memcpy(probes.light + k * probes.plane + probes.texels[t] * Texel,
                        static_cast<const std::byte*>(numbers) + k * Texel, Texel);
}

template <std::size_t Outputs>
[[gnu::always_inline]] inline void light_probes(const Probes& probes, const glm::vec4* constants,
                                                TexelFormat format, std::size_t first, std::size_t last) {
    constexpr std::size_t kNumbers = 3 * Outputs + 1, kPlanes = (kNumbers + 3) / 4;
    alignas(64) float numbers[kMaxNumbers] = {};
    alignas(64) std::int16_t halves[kMaxNumbers];
    for (std::size_t p = first; p < last; ++p) {
        light_probe<Outputs>(probes, constants, p, numbers);
        if (format == TexelFormat::rgba32) {
            write_probe<4 * sizeof(float)>(probes, p, numbers, kPlanes);
            continue;
        }
        round_to_halves(numbers, kNumbers, halves);
        write_probe<4 * sizeof(std::int16_t)>(probes, p, halves, kPlanes);
    }
}

PRT_TARGET_CLONES
void light_in_lanes(const Probes& probes, const glm::vec4* constants, std::size_t outputs, TexelFormat format,
                    std::size_t first, std::size_t last) {
    switch (outputs) {
    case 4:
        return light_probes<4>(probes, constants, format, first, last);
    case 9:
        return light_probes<9>(probes, constants, format, first, last);
    default:
        return light_probes<16>(probes, constants, format, first, last);
    }
}

/// Returns for every row of the first output the response of `direct` transfer to grey radiance coefficients,
/// averaged over the channels; empty without a `direct` term.
std::vector<float> direct_rows(const ClusterLighting& lighting, std::size_t outputs) {
    const TransferLayout& layout = lighting.layout();
    if (!layout.has(TermKind::direct))
        return {};
    const TransferTerm& term = layout.terms.front();
    const std::size_t columns = layout.columns_of(term), dimension = layout.dimension();
    const auto channels = static_cast<std::size_t>(term.channels);
    std::vector<float> rows;
    for (std::size_t row = 0; row < lighting.rows(); row += outputs)
        for (std::size_t i = 0; i < columns; ++i) {
            float sum = 0;
            for (std::size_t c = 0; c < channels; ++c)
                sum += lighting.matrix()[(row / kLaneCount * dimension + c * columns + i) * kLaneCount +
                                         row % kLaneCount];
            rows.push_back(sum / static_cast<float>(channels));
        }
    return rows;
}

} // namespace

std::size_t bytes_per_texel(TexelFormat format) {
    return format == TexelFormat::rgba32 ? 16 : format == TexelFormat::rgba16 ? 8 : 4;
}

TextureRelighter::TextureRelighter(const ClusteredTransfer& transfer, TexelFormat format)
    : receivers_(transfer.receivers), format_(format), outputs_(transfer.bases.layout.outputs),
      lighting_(transfer), clusters_(cluster_layouts(transfer.bases)) {
    assert(receivers_.format == WeightFormat::packed);
}

TextureRelighter::TextureRelighter(const CompressedLightmap& lightmap, TexelFormat format)
    : TextureRelighter(lightmap.compressed.transfer, format) {
    std::size_t first = 0;
    for (const LightmapSize& map : lightmap.layout.maps) {
        std::vector<TextureLevel> levels = levels_of(map, bytes_per_texel(format));
        const std::size_t bytes = levels.back().first + bytes_per_texel(format);
        textures_.push_back({first, static_cast<std::size_t>(map.height), bytes, std::move(levels)});
        first += map.texels();
    }
}

TextureRelighter::TextureRelighter(const CompressedVolume& volume, TexelFormat format)
    : TextureRelighter(volume.compressed.transfer, format) {
    if (format != TexelFormat::rgba16 && format != TexelFormat::rgba32)
        throw Error("the light of a volume has signs; use TexelFormat::rgba16 or rgba32");
    atlas_ = atlas_of(volume.grid, volume.order);
    const std::size_t texels = atlas_.texels_of_plane() * static_cast<std::size_t>(atlas_.planes());
    textures_.push_back(
        {0, receivers_.size(), texels * bytes_per_texel(format), {{atlas_.light_texels(), 0}}});
    direct_ = direct_rows(lighting_, outputs_);
    const VolumeProbes probes = probes_of(volume.grid);
    first_texels_.assign(probes.size() + 1, 0);
    for (const auto& of_brick : probes.of_brick)
        for (const std::uint32_t p : of_brick)
            ++first_texels_[p + 1];
    std::partial_sum(first_texels_.begin(), first_texels_.end(), first_texels_.begin());
    texels_.resize(first_texels_.back());
    std::vector<std::uint32_t> next = first_texels_;
    for (std::size_t b = 0; b < probes.of_brick.size(); ++b)
        for (std::size_t i = 0; i < kBrickProbes; ++i)
            texels_[next[probes.of_brick[b][i]]++] = static_cast<std::uint32_t>(atlas_.texel(b, i));
}

void TextureRelighter::update_constants(const LightingView& lighting, const std::optional<glm::vec3>& sun,
                                        std::span<glm::vec4> constants) const {
    lighting_.update(lighting, constants);
    if (!sun || direct_.empty())
        return;
    std::array<float, static_cast<std::size_t>(kMaxOrder) * kMaxOrder> values{};
    const auto count = static_cast<std::size_t>(coefficient_count(layout().order));
    const std::span<float> basis = std::span(values).first(count);
    evaluate_sh(layout().order, *sun, basis);
    for (std::size_t row = 0; row * outputs_ < rows(); ++row)
        constants[row * outputs_].w =
            std::inner_product(basis.begin(), basis.end(),
                               direct_.begin() + static_cast<std::ptrdiff_t>(row * count), 0.0f) /
            basis[0];
}

void TextureRelighter::update_rows(const Texture& map, const glm::vec4* constants, int first, int last,
                                   std::byte* texels) const {
    const TextureLevel& level = map.levels.front();
    write_means(format_, map.levels, first, last, texels, [&](int x, int y, int count, glm::vec3* colors) {
        const std::size_t begin = level.texel(x, y), receiver = map.first_receiver + begin;
        evaluate_range(receivers_, clusters_.data(), constants, receiver,
                       receiver + static_cast<std::size_t>(count), colors);
        write_row(format_, colors, count, texels + begin * bytes_per_texel(format_));
    });
}

void TextureRelighter::update_range(std::size_t texture, std::span<const glm::vec4> constants,
                                    std::size_t first, std::size_t last, std::span<std::byte> texels) const {
    assert(constants.size() >= rows() && texels.size() >= bytes(texture) && last <= units(texture));
    const Texture& of = textures_[texture];
    if (outputs_ == 1)
        return update_rows(of, constants.data(), static_cast<int>(first), static_cast<int>(last),
                           texels.data());
    light_in_lanes({receivers_, clusters_.data(), first_texels_.data(), texels_.data(), texels.data(),
                    atlas_.texels_of_plane() * bytes_per_texel(format_)},
                   constants.data(), outputs_, format_, first, last);
}

void TextureRelighter::update_smaller_levels(std::size_t texture, std::span<std::byte> texels) const {
    const std::size_t size = bytes_per_texel(format_);
    for (std::size_t l = 1; l < levels(texture).size(); ++l) {
        const TextureLevel& from = levels(texture)[l];
        write_means(format_, levels(texture).subspan(l), 0, from.size.y, texels.data(),
                    [&](int x, int y, int count, glm::vec3* colors) {
                        for (int i = 0; i < count; ++i)
                            colors[i] =
                                read_texel(format_, &texels[from.first + from.texel(x + i, y) * size]);
                    });
    }
}

void TextureRelighter::update(std::size_t texture, std::span<const glm::vec4> constants,
                              std::span<std::byte> texels, int threads) const {
    const std::size_t at_once = outputs_ == 1 ? 16 : 1024;
    if (thread_count(threads) == 1)
        update_range(texture, constants, 0, units(texture), texels);
    else
        parallel_for(units(texture), at_once, threads, [&](std::size_t first, std::size_t last) {
            update_range(texture, constants, first, last, texels);
        });
    update_smaller_levels(texture, texels);
}

} // namespace prt
