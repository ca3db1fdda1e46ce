// Computes constants of instances: constants of each mode in each rotation, times the factors of the
// instances with that rotation.

#include "prt/core/instances.h"

#include "prt/core/error.h"
#include "runtime/core/support/counted.h"
#include "runtime/core/support/parallel.h"
#include "runtime/domains/instance_lamps.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>

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

/// Returns the sum of the lights of all lamps at an instance, times their strengths.
InstanceLampLight lamp_light(const PlacedInstance& instance, std::span<const glm::vec3> strengths) {
    InstanceLampLight sum;
    for (std::size_t l = 0; l < instance.lamps.size(); ++l) {
        const glm::vec3 strength = strengths.empty() ? glm::vec3(1) : strengths[l];
        for (std::size_t i = 0; i < sum.functions.size(); ++i)
            for (int c = 0; c < 3; ++c) {
                const auto color = static_cast<std::size_t>(c);
                sum.functions[i][color] += strength[c] * instance.lamps[l].functions[i][color];
            }
    }
    return sum;
}

/// Adds the light of lamps to one row of an instance. `responses` [kInstanceLampFunctions] are those of the
/// row.
void add_lamps(const InstanceLampLight& light, const glm::vec3* responses, std::span<glm::vec4, 3> colors) {
    for (std::size_t i = 0; i < light.functions.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const auto color = static_cast<std::size_t>(c);
            colors[color] += responses[i][c] * light.functions[i][color];
        }
}

/// Returns the constants of all rows under the radiance √(4π)·Y_i, [rows][kInstanceLampFunctions].
std::vector<glm::vec3> lamp_responses(const ClusterLighting& relighter) {
    const auto count = static_cast<std::size_t>(coefficient_count(relighter.order()));
    std::vector<glm::vec3> responses(relighter.rows() * kInstanceLampFunctions, glm::vec3(0));
    std::vector<glm::vec4> constants(relighter.rows());
    for (std::size_t i = 0; i < std::min(count, kInstanceLampFunctions); ++i) {
        Lighting lighting{{relighter.order(), std::vector<glm::vec3>(count, glm::vec3(0))}};
        lighting.sky.coefficients[i] = glm::vec3(std::sqrt(4 * std::numbers::pi_v<float>));
        lighting.lamps.assign(relighter.layout().lamps(), glm::vec3(0));
        relighter.update(lighting, constants);
        for (std::size_t row = 0; row < constants.size(); ++row)
            responses[row * kInstanceLampFunctions + i] = glm::vec3(constants[row]);
    }
    return responses;
}

/// Returns the constants of all rows under lamps alone, by the lamp terms of the transfer.
std::vector<glm::vec4> lamp_constants(const ClusterLighting& relighter,
                                      std::span<const glm::vec3> strengths) {
    Lighting lighting{{relighter.order(),
                       std::vector<glm::vec3>(static_cast<std::size_t>(coefficient_count(relighter.order())),
                                              glm::vec3(0))}};
    lighting.lamps.assign(strengths.begin(), strengths.end());
    std::vector<glm::vec4> constants(relighter.rows());
    relighter.update(lighting, constants);
    return constants;
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
    if (transfer.bases.layout.outputs != 1)
        throw Error("the transfer of instances must have one output");
    if (transfer.bases.layout.lamps() > 0)
        responses_ = lamp_responses(relighter_);
    for (std::size_t i = 0; i < instances_.size(); ++i) {
        if (!instances_[i].placed.lamps.empty())
            check_instance_lamps(transfer.bases.layout, instances_[i].placed);
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
    const std::size_t lamps = relighter_.layout().lamps();
    if (!lighting.lamps.empty() && lighting.lamps.size() != lamps)
        throw Error("the lighting has " + counted(lighting.lamps.size(), "lamp") + ", but the transfer has " +
                    std::to_string(lamps));
    std::array<Lighting, kInstanceModes> lightings = modes_.lightings(lighting);
    for (Lighting& mode : lightings) // the lamps have their own light at instances
        mode.lamps.assign(lamps, glm::vec3(0));
    const bool drawn_once = std::ranges::any_of(
        instances_, [](const RelitInstance& instance) { return instance.placed.lamps.empty(); });
    const std::vector<glm::vec4> of_lamps =
        lamps > 0 && drawn_once ? lamp_constants(relighter_, lighting.lamps) : std::vector<glm::vec4>();
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
            for (const std::uint32_t i : of_[rotation]) {
                const InstanceLampLight light = lamp_light(instances_[i].placed, lighting.lamps);
                for (std::size_t row = 0; row < instances_[i].rows.count; ++row) {
                    const std::size_t of_model = instances_[i].rows.first + row;
                    const auto colors = constants.subspan(begins_[i] + 3 * row).first<3>();
                    write_row(instances_[i].placed.factors, modes, of_model, colors);
                    if (lamps == 0)
                        continue;
                    if (!instances_[i].placed.lamps.empty())
                        add_lamps(light, &responses_[of_model * kInstanceLampFunctions], colors);
                    else
                        for (int c = 0; c < 3; ++c)
                            colors[static_cast<std::size_t>(c)].w += of_lamps[of_model][c];
                }
            }
        }
    });
}

} // namespace prt
