// Computes constants of instances: constants of each mode in each rotation, times the factors of the
// instances with that rotation.

#include "prt/core/instances.h"

#include "prt/core/error.h"
#include "runtime/support/counted.h"
#include "runtime/support/parallel.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace prt {
namespace {

std::vector<glm::dmat3> rotations_of(std::span<const RelitInstance> instances) {
    std::vector<glm::dmat3> rotations;
    for (const RelitInstance& instance : instances)
        rotations.push_back(instance.placed.rotation);
    return rotations;
}

/// Returns the offset that a shader adds to three times a row to find the red, green and blue vectors of an
/// instance.
std::uint32_t offset_of(std::size_t begin, const ConstantRows& rows) {
    return static_cast<std::uint32_t>(begin / 3) - rows.first; // may wrap around, as the shader's sum does
}

/// Constants of each mode of lighting, [modes][rows].
using ModeConstants = std::array<std::vector<glm::vec4>, kInstanceModes>;

/// Writes one row of an instance: red, green and blue as linear functions of (u, 1), u the position in the
/// box.
void write_row(const InstanceFactors& factors, const ModeConstants& modes, std::size_t row,
               std::span<glm::vec4, 3> colors) {
    glm::vec3 added(0);
    for (std::size_t k = 0; k < kAddedModes; ++k)
        added += factors.added[k] * glm::vec3(modes[kPassingModes + k][row]);
    for (int c = 0; c < 3; ++c) {
        glm::vec4 color(0, 0, 0, added[c]);
        for (std::size_t m = 0; m < kPassingModes; ++m)
            color += factors.passing[m] * modes[m][row][c];
        colors[static_cast<std::size_t>(c)] = color;
    }
}

} // namespace

ConstantRows rows_of(const ClusteredTransfer& transfer, std::size_t first, std::size_t count) {
    if (count == 0)
        return {};
    const std::vector<ClusterLayout> layouts = cluster_layouts(transfer.bases);
    std::size_t low = layouts.size(), high = 0;
    for (std::size_t p = first; p < first + count; ++p) {
        const std::size_t cluster = transfer.receivers.cluster(p);
        low = std::min(low, cluster);
        high = std::max(high, cluster);
    }
    const auto end = high + 1 < layouts.size() ? layouts[high + 1].first_row
                                               : static_cast<std::uint32_t>(constant_rows(transfer.bases));
    return {layouts[low].first_row, end - layouts[low].first_row};
}

ConstantRows joined(const ConstantRows& a, const ConstantRows& b) {
    if (a.count == 0 || b.count == 0)
        return a.count == 0 ? b : a;
    const std::uint32_t first = std::min(a.first, b.first);
    return {first, std::max(a.first + a.count, b.first + b.count) - first};
}

InstanceRelighter::InstanceRelighter(const ClusteredTransfer& transfer,
                                     std::span<const RelitInstance> instances, int yaws)
    : relighter_(transfer), modes_(transfer.bases.layout.order),
      rotations_(instance_rotations(rotations_of(instances), yaws)),
      instances_(instances.begin(), instances.end()), of_(rotations_.rotations.size()) {
    if (transfer.bases.layout.outputs != 1 || transfer.bases.layout.lamps() > 0)
        throw Error("instances with shared transfer do not support lamps");
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        of_[rotations_.of[i]].push_back(static_cast<std::uint32_t>(i));
        begins_.push_back(size_);
        size_ += 3 * std::size_t{instances_[i].rows.count};
    }
    if (size_ * sizeof(glm::vec4) > std::numeric_limits<std::uint32_t>::max())
        throw Error("the constants of " + counted(instances_.size(), "instance") + " need " +
                    std::to_string(size_ * sizeof(glm::vec4) >> 20) + " MB, but a buffer is limited to 4 GB");
}

std::vector<glm::vec4> InstanceRelighter::table() const {
    std::vector<glm::vec4> rows;
    rows.reserve(2 * instances_.size());
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        const InstanceBox& box = instances_[i].placed.box;
        const std::uint32_t offset = offset_of(begins_[i], instances_[i].rows);
        rows.emplace_back(box.middle, static_cast<float>(offset & 0xffffu));
        rows.emplace_back(1.0f / box.half, static_cast<float>(offset >> 16));
    }
    return rows;
}

void InstanceRelighter::update(const Lighting& lighting, std::span<glm::vec4> constants, int threads) const {
    assert(constants.size() >= size_);
    const std::array<Lighting, kInstanceModes> lightings = modes_.lightings(lighting);
    parallel_for(of_.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        ModeConstants modes;
        modes.fill(std::vector<glm::vec4>(relighter_.rows()));
        for (std::size_t rotation = begin; rotation < end; ++rotation) {
            const auto rotated = rotated_into(rotations_.rotations[rotation], lightings);
            ConstantRows all;
            for (const std::uint32_t i : of_[rotation])
                all = joined(all, instances_[i].rows);
            for (std::size_t m = 0; m < kInstanceModes; ++m)
                relighter_.update(rotated[m], modes[m], all.first, all.first + all.count);
            for (const std::uint32_t i : of_[rotation])
                for (std::size_t row = 0; row < instances_[i].rows.count; ++row)
                    write_row(instances_[i].placed.factors, modes, instances_[i].rows.first + row,
                              constants.subspan(begins_[i] + 3 * row).first<3>());
        }
    });
}

} // namespace prt
