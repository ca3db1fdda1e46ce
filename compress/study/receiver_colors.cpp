// Visualises clusters, components, errors and seams as colors of receivers.

#include "compress/study/receiver_colors.h"

#include "prt/core/error_measures.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>

namespace prt {
glm::vec3 heat_color(double share) {
    const auto ramp = static_cast<float>(3 * std::min(share, 1.0));
    return glm::clamp(glm::vec3(ramp, ramp - 1, ramp - 2), 0.0f, 1.0f);
}

glm::vec3 label_color(std::size_t label) {
    // Hues in steps of the golden ratio.
    const auto number = static_cast<double>(label);
    const double hue = 6 * std::fmod(0.61803398875 * number, 1.0);
    const double value = 0.45 + 0.5 * std::fmod(0.754877666 * number, 1.0);
    glm::dvec3 color;
    for (int c = 0; c < 3; ++c)
        color[c] = value * std::clamp(std::abs(std::fmod(hue + 2 * c, 6.0) - 3) - 1, 0.08, 1.0);
    return glm::vec3(color);
}

std::vector<glm::vec3> cluster_colors(const ClusteredTransfer& transfer) {
    std::vector<glm::vec3> colors;
    for (const std::uint16_t cluster : transfer.receivers.cluster_indices())
        colors.push_back(label_color(cluster));
    return colors;
}

std::vector<glm::vec3> component_colors(const ClusteredTransfer& transfer) {
    const double most = std::max(1, transfer.bases.max_components());
    std::vector<glm::vec3> colors;
    for (const std::uint16_t cluster : transfer.receivers.cluster_indices())
        colors.push_back(heat_color(transfer.bases.components[cluster] / most));
    return colors;
}

std::vector<glm::vec3> error_colors(std::span<const glm::vec3> reference,
                                    std::span<const glm::vec3> approximation, std::span<const float> areas) {
    std::vector<glm::vec3> colors;
    for (const double error : contrast_errors(reference, approximation, areas).magnitudes)
        colors.push_back(heat_color(error / kWhiteError));
    return colors;
}

std::vector<glm::vec3> seam_colors(std::span<const glm::vec3> reference,
                                   std::span<const glm::vec3> approximation, std::span<const float> areas,
                                   std::span<const Edge> edges, std::span<const std::uint16_t> clusters) {
    const std::vector<double> errors = contrast_errors(reference, approximation, areas).luminances;
    std::vector<double> jumps(reference.size(), -1);
    for (const Edge& edge : edges) {
        if (clusters[edge.first] == clusters[edge.second])
            continue;
        const double jump = std::abs(errors[edge.first] - errors[edge.second]);
        for (const std::uint32_t end : {edge.first, edge.second})
            jumps[end] = std::max(jumps[end], jump);
    }
    std::vector<glm::vec3> colors;
    for (const double jump : jumps)
        colors.push_back(jump < 0 ? glm::vec3(0.01f, 0.02f, 0.08f) : heat_color(jump / kWhiteSeam));
    return colors;
}

} // namespace prt
