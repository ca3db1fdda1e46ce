#include "diffusion.h"

#include "prt/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace prt {
namespace {

/// Shares of a receiver below this are left out: a body of a million of them loses less than one in a thousand.
constexpr double kNegligible = 1e-9;

Dipole dipole_of(const Medium& medium, int c) {
    return Dipole(medium.scattering[c], medium.absorption[c], medium.ior);
}

} // namespace

DiffusionOperator::DiffusionOperator(const Receivers& receivers, std::vector<std::uint32_t> members,
                                     const Medium& medium, double tolerance)
    : receivers_(receivers), members_(std::move(members)),
      dipoles_{dipole_of(medium, 0), dipole_of(medium, 1), dipole_of(medium, 2)}, tolerance_(tolerance) {
    std::erase_if(members_, [&](std::uint32_t m) { return receivers_.areas[m] <= 0; });
    // A leaf is one receiver, so that the tree alone decides what is seen as one.
    if (!members_.empty())
        build(0, static_cast<std::uint32_t>(members_.size()));
}

std::uint32_t DiffusionOperator::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Node node{glm::dvec3(std::numeric_limits<double>::infinity()),
              glm::dvec3(-std::numeric_limits<double>::infinity()),
              glm::dvec3(0),
              0,
              begin,
              end,
              0};
    for (std::uint32_t i = begin; i < end; ++i) {
        const glm::dvec3 position(receivers_.positions[members_[i]]);
        const auto area = static_cast<double>(receivers_.areas[members_[i]]);
        node.low = glm::min(node.low, position);
        node.high = glm::max(node.high, position);
        node.centre += area * position;
        node.area += area;
    }
    node.centre /= node.area;
    nodes_.push_back(node);
    if (end - begin == 1)
        return index;
    const glm::dvec3 size = node.high - node.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::nth_element(members_.begin() + begin, members_.begin() + middle, members_.begin() + end,
                     [&](std::uint32_t a, std::uint32_t b) {
                         const float xa = receivers_.positions[a][axis], xb = receivers_.positions[b][axis];
                         return xa != xb ? xa < xb : a < b;
                     });
    build(begin, middle);
    nodes_[index].right = build(middle, end);
    return index;
}

void DiffusionOperator::gather(const glm::dvec3& position, int channels, int coefficients,
                               std::span<const float> means, std::span<double> sums) const {
    std::array<std::uint32_t, 64> stack; // the tree is balanced: its depth is at most 32
    std::size_t height = 0;
    stack[height++] = 0;
    while (height > 0) {
        const std::uint32_t index = stack[--height];
        const Node& node = nodes_[index];
        const glm::dvec3 nearest = glm::clamp(position, node.low, node.high);
        const double least = glm::distance(position, nearest);
        const bool leaf = node.right == 0;
        if (least > 0) {
            double most = 0;
            for (const Dipole& dipole : dipoles_)
                most = std::max(most, dipole.reflectance(least) / dipole.total());
            if (most * node.area < kNegligible * (node.end - node.begin))
                continue;
        }
        const double distance = glm::distance(position, node.centre);
        const glm::dvec3 size = node.high - node.low;
        // Area and extent: a body's bend makes the second larger.
        if (!leaf && (least == 0 ||
                      std::max(node.area, glm::dot(size, size)) > tolerance_ * distance * distance)) {
            stack[height++] = node.right;
            stack[height++] = index + 1;
            continue;
        }
        const float* mean = &means[index * static_cast<std::size_t>(channels * coefficients)];
        for (int c = 0; c < channels; ++c) {
            const Dipole& dipole = dipoles_[static_cast<std::size_t>(c)];
            const double patch = node.area / (node.end - node.begin);
            const double weight = node.area * dipole.mean_over_patch(distance, patch) / dipole.total();
            for (int k = 0; k < coefficients; ++k)
                sums[static_cast<std::size_t>(c * coefficients + k)] +=
                    weight * static_cast<double>(mean[c * coefficients + k]);
        }
    }
}

void DiffusionOperator::apply(int channels, int coefficients, std::span<float> values, int threads) const {
    if (nodes_.empty())
        return;
    const auto stride = static_cast<std::size_t>(channels * coefficients);
    // Means of the nodes, children before parents.
    std::vector<float> means(nodes_.size() * stride);
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        const Node& node = nodes_[n];
        float* const mean = &means[n * stride];
        if (node.right == 0) {
            std::copy_n(&values[members_[node.begin] * stride], stride, mean);
            continue;
        }
        const auto share = static_cast<float>(nodes_[n + 1].area / node.area);
        for (std::size_t i = 0; i < stride; ++i)
            mean[i] = share * means[(n + 1) * stride + i] + (1 - share) * means[node.right * stride + i];
    }
    parallel_for(members_.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        std::vector<double> sums(stride);
        for (std::size_t i = begin; i < end; ++i) {
            std::fill(sums.begin(), sums.end(), 0.0);
            gather(glm::dvec3(receivers_.positions[members_[i]]), channels, coefficients, means, sums);
            std::copy(sums.begin(), sums.end(), &values[members_[i] * stride]);
        }
    });
}

bool DiffusionOperator::is_grey() const {
    for (const double r : {0.0, 1.0 / std::max(dipoles_[0].falloff(), 1.0)})
        for (const Dipole& dipole : dipoles_)
            if (dipole.reflectance(r) / dipole.total() != dipoles_[0].reflectance(r) / dipoles_[0].total())
                return false;
    return true;
}

} // namespace prt
