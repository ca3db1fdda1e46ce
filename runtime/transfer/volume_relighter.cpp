// Computes incident light of probes, one at a time: coefficients are summed in registers, rounded once, and
// written to every brick that contains the probe.

#include "prt/core/volume_relighter.h"

#include "prt/core/sh.h"
#include "runtime/support/parallel.h"
#include "runtime/transfer/packed_weights.h"
#include "runtime/transfer/texel_formats.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstring>
#include <numeric>

namespace prt {
namespace {

using Color [[gnu::vector_size(16)]] = float;
using ColorInMemory [[gnu::vector_size(16), gnu::aligned(4), gnu::may_alias]] = float;
using HalfLanes [[gnu::vector_size(2 * kLaneCount)]] = std::int16_t;

[[gnu::always_inline]] inline Color color_at(const glm::vec4* row) {
    return *reinterpret_cast<const ColorInMemory*>(row);
}

/// Maximum number of values of a probe in all planes, rounded up to whole lanes.
constexpr std::size_t kMaxNumbers = 64;
static_assert(kMaxNumbers >= 3 * kMaxIncidentOrder * kMaxIncidentOrder + 4 && kMaxNumbers % kLaneCount == 0);

struct Probes {
    const ClusteredReceivers& receivers;
    const ClusterLayout* clusters;
    const std::uint32_t* first_texels;
    const std::uint32_t* texels;
};

struct Planes {
    std::byte* first;
    std::size_t bytes; ///< size of one plane
    std::size_t count;
};

/// Computes the coefficients of a probe, color by color, followed by the visibility of the sun.
template <std::size_t Outputs>
[[gnu::always_inline]] inline void light_probe(const Probes& probes, const glm::vec4* constants,
                                               std::size_t p, float* numbers) {
    const std::byte* const words = probes.receivers.weights.data() + p * probes.receivers.stride();
    const ClusterLayout& layout = probes.clusters[cluster_in(words, probes.receivers.cluster_bits)];
    const glm::vec4* row = constants + layout.first_row * Outputs;
    Color sums[Outputs];
    for (std::size_t o = 0; o < Outputs; ++o)
        sums[o] = color_at(row + o);
    auto position = static_cast<std::size_t>(probes.receivers.cluster_bits);
    for (std::size_t j = 0; j < layout.components; ++j) {
        const int width = width_of(layout, j);
        const auto weight = static_cast<float>(bits_at(words, position, width));
        position += static_cast<std::size_t>(width);
        row += Outputs;
        for (std::size_t o = 0; o < Outputs; ++o)
            sums[o] += weight * color_at(row + o);
    }
    const float sun = sums[0][3];
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

template <std::size_t Texel>
[[gnu::always_inline]] inline void write_probe(const Probes& probes, std::size_t p, const void* numbers,
                                               const Planes& planes) {
    for (std::uint32_t t = probes.first_texels[p]; t < probes.first_texels[p + 1]; ++t)
        for (std::size_t k = 0; k < planes.count; ++k)
            std::memcpy(planes.first + k * planes.bytes + probes.texels[t] * Texel,
                        static_cast<const std::byte*>(numbers) + k * Texel, Texel);
}

template <std::size_t Outputs>
[[gnu::always_inline]] inline void update_range(const Probes& probes, const glm::vec4* constants,
                                                VolumeFormat format, std::size_t first, std::size_t last,
                                                const Planes& planes) {
    alignas(64) float numbers[kMaxNumbers] = {};
    alignas(64) std::int16_t halves[kMaxNumbers];
    for (std::size_t p = first; p < last; ++p) {
        light_probe<Outputs>(probes, constants, p, numbers);
        if (format == VolumeFormat::rgba32) {
            write_probe<4 * sizeof(float)>(probes, p, numbers, planes);
            continue;
        }
        round_to_halves(numbers, 3 * Outputs + 1, halves);
        write_probe<4 * sizeof(std::int16_t)>(probes, p, halves, planes);
    }
}

PRT_TARGET_CLONES
void update_in_lanes(const Probes& probes, const glm::vec4* constants, int order, VolumeFormat format,
                     std::size_t first, std::size_t last, const Planes& planes) {
    switch (order) {
    case 2:
        return update_range<4>(probes, constants, format, first, last, planes);
    case 3:
        return update_range<9>(probes, constants, format, first, last, planes);
    default:
        return update_range<16>(probes, constants, format, first, last, planes);
    }
}

/// Returns for every row of the first output the response of `direct` transfer to grey radiance coefficients,
/// averaged over the channels; empty without a `direct` term.
std::vector<float> direct_rows(const ClusterLighting& relighter, std::size_t outputs) {
    const TransferLayout& layout = relighter.layout();
    if (!layout.has(TermKind::direct))
        return {};
    const TransferTerm& term = layout.terms.front();
    const std::size_t columns = layout.columns_of(term), dimension = layout.dimension();
    const auto channels = static_cast<std::size_t>(term.channels);
    std::vector<float> rows;
    for (std::size_t row = 0; row < relighter.rows(); row += outputs)
        for (std::size_t i = 0; i < columns; ++i) {
            float sum = 0;
            for (std::size_t c = 0; c < channels; ++c)
                sum += relighter.matrix()[(row / kLaneCount * dimension + c * columns + i) * kLaneCount +
                                          row % kLaneCount];
            rows.push_back(sum / static_cast<float>(channels));
        }
    return rows;
}

} // namespace

VolumeRelighter::VolumeRelighter(const CompressedVolume& volume, VolumeFormat format)
    : volume_(volume), format_(format), atlas_(atlas_of(volume.grid, volume.order)),
      constants_(volume.compressed.transfer), clusters_(cluster_layouts(volume.compressed.transfer.bases)),
      direct_(direct_rows(constants_, atlas_.coefficients())) {
    assert(volume.compressed.transfer.receivers.format == WeightFormat::packed);
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

std::size_t VolumeRelighter::bytes() const {
    const std::size_t texel = format_ == VolumeFormat::rgba16 ? 8 : 16;
    return texel * atlas_.texels_of_plane() * static_cast<std::size_t>(atlas_.planes());
}

void VolumeRelighter::update_constants(const LightingView& lighting, const std::optional<glm::vec3>& sun,
                                       std::span<glm::vec4> constants) const {
    constants_.update(lighting, constants);
    if (!sun || direct_.empty())
        return;
    std::array<float, static_cast<std::size_t>(kMaxOrder) * kMaxOrder> values{};
    const auto count = static_cast<std::size_t>(coefficient_count(layout().order));
    const std::span<float> basis = std::span(values).first(count);
    evaluate_sh(layout().order, *sun, basis);
    const std::size_t outputs = atlas_.coefficients();
    for (std::size_t row = 0; row * outputs < rows(); ++row)
        constants[row * outputs].w =
            std::inner_product(basis.begin(), basis.end(),
                               direct_.begin() + static_cast<std::ptrdiff_t>(row * count), 0.0f) /
            basis[0];
}

void VolumeRelighter::update_probes(std::span<const glm::vec4> constants, std::size_t first, std::size_t last,
                                    std::span<std::byte> texels) const {
    assert(constants.size() >= rows() && texels.size() >= bytes() && last <= probes());
    const auto planes = static_cast<std::size_t>(atlas_.planes());
    const Probes probes{volume_.compressed.transfer.receivers, clusters_.data(), first_texels_.data(),
                        texels_.data()};
    update_in_lanes(probes, constants.data(), atlas_.order, format_, first, last,
                    {texels.data(), bytes() / planes, planes});
}

void VolumeRelighter::update(std::span<const glm::vec4> constants, std::span<std::byte> texels,
                             int threads) const {
    constexpr std::size_t kProbesAtOnce = 1024;
    if (thread_count(threads) == 1)
        return update_probes(constants, 0, probes(), texels);
    parallel_for(probes(), kProbesAtOnce, threads,
                 [&](std::size_t first, std::size_t last) { update_probes(constants, first, last, texels); });
}

} // namespace prt
