// Gathers subsurface light with a tree of the triangles of a body (Jensen and Buhler 2002).

#include "bake/transport/diffusion.h"

#include "bake/trace/sparse_rows.h"
#include "prt/core/sh_basis.h"
#include "runtime/core/support/parallel.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>

namespace prt {
namespace {

/// Share of the light on a plane from beyond the reach, which is ignored.
constexpr double kNegligible = 1e-4;

/// Maximum number of parts of triangles in the sum for a receiver: four times the number for media with a
/// mean free path of 0.5 mm on triangles of 0.1 m. If colors have both a long reach and a steep fall-off more
/// parts would be needed; parts then stay larger than the tolerance requires.
constexpr int kMaxParts = 1 << 22;

double reach_of(const Dipole& dipole) {
    double low = 0, high = dipole.depth();
    while (dipole.inside(high) < (1 - kNegligible) * dipole.total())
        high *= 2;
    for (int i = 0; i < 40; ++i) {
        const double middle = (low + high) / 2;
        (dipole.inside(middle) < (1 - kNegligible) * dipole.total() ? low : high) = middle;
    }
    return high;
}

Dipole dipole_of(const Medium& medium, int c) {
    return Dipole(medium.scattering[c], medium.absorption[c], medium.ior);
}

double doubled_area(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::length(glm::cross(b - a, c - a));
}

} // namespace

DiffusionOperator::DiffusionOperator(const Receivers& receivers, std::vector<glm::uvec3> triangles,
                                     const Medium& medium, double tolerance)
    : receivers_(receivers),
      triangles_(std::move(triangles)), dipoles_{dipole_of(medium, 0), dipole_of(medium, 1),
                                                 dipole_of(medium, 2)},
      tolerance_(tolerance),
      scale_(std::min({dipoles_[0].depth(), dipoles_[1].depth(), dipoles_[2].depth()})),
      reach_(std::max({reach_of(dipoles_[0]), reach_of(dipoles_[1]), reach_of(dipoles_[2])})) {
    std::erase_if(triangles_, [&](const glm::uvec3& t) {
        return !(doubled_area(position(t.x), position(t.y), position(t.z)) > 0);
    });
    const double falloff = std::max({dipoles_[0].falloff(), dipoles_[1].falloff(), dipoles_[2].falloff()});
    max_extent_ = 10 * tolerance_ / (falloff * falloff);
    tabulate_kernel();
    for (const glm::uvec3& t : triangles_)
        for (int corner = 0; corner < 3; ++corner)
            members_.push_back(t[corner]);
    std::sort(members_.begin(), members_.end());
    members_.erase(std::unique(members_.begin(), members_.end()), members_.end());
    if (!triangles_.empty())
        build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void DiffusionOperator::tabulate_kernel() {
    constexpr int kSteps = 4096; // linear interpolation between the steps: error below 1e-5 of K
    const double last = std::log1p(reach_ * reach_ * 4 / (scale_ * scale_));
    kernel_steps_ = kSteps / last;
    for (int i = 0; i <= kSteps + 1; ++i) {
        const double r = scale_ * std::sqrt(std::expm1(i / kernel_steps_));
        glm::vec3 k;
        for (std::size_t c = 0; c < 3; ++c)
            k[static_cast<int>(c)] = static_cast<float>(dipoles_[c].reflectance(r) / dipoles_[c].total());
        kernel_.push_back(k);
    }
}

glm::vec3 DiffusionOperator::kernel(double squared_distance) const {
    const double at = std::log1p(squared_distance / (scale_ * scale_)) * kernel_steps_;
    const auto i = static_cast<std::size_t>(at);
    if (i + 1 >= kernel_.size())
        return glm::vec3(0); // beyond twice the reach
    return glm::mix(kernel_[i], kernel_[i + 1], static_cast<float>(at - static_cast<double>(i)));
}

std::uint32_t DiffusionOperator::build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    constexpr double kFar = std::numeric_limits<double>::infinity();
    Node node{glm::dvec3(kFar), glm::dvec3(-kFar), glm::dvec3(0), 0, begin, end, 0};
    for (std::uint32_t i = begin; i < end; ++i) {
        const glm::uvec3& t = triangles_[i];
        const glm::dvec3 a = position(t.x), b = position(t.y), c = position(t.z);
        const double area = doubled_area(a, b, c) / 2;
        node.low = glm::min(node.low, glm::min(a, glm::min(b, c)));
        node.high = glm::max(node.high, glm::max(a, glm::max(b, c)));
        node.center += area * (a + b + c) / 3.0;
        node.area += area;
    }
    node.center /= node.area;
    nodes_.push_back(node);
    if (end - begin == 1)
        return index;
    const glm::dvec3 size = node.high - node.low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const std::uint32_t middle = begin + (end - begin) / 2;
    const auto key = [&](const glm::uvec3& t) {
        return receivers_.positions[t.x][axis] + receivers_.positions[t.y][axis] +
               receivers_.positions[t.z][axis];
    };
    std::nth_element(triangles_.begin() + begin, triangles_.begin() + middle, triangles_.begin() + end,
                     [&](const glm::uvec3& a, const glm::uvec3& b) { return key(a) < key(b); });
    build(begin, middle);
    nodes_[index].right = build(middle, end);
    return index;
}

/// Builds the row of one receiver: sources are receivers, then the means of the nodes.
class DiffusionOperator::Gatherer {
public:
    Gatherer(const DiffusionOperator& diffusion, int channels) : diffusion_(diffusion), channels_(channels) {}

    SparseRow gather(const glm::dvec3& at) {
        sources_.clear();
        weights_.clear();
        at_ = at;
        parts_ = 0;
        visit(0);
        return {static_cast<std::uint32_t>(sources_.size()), sources_.data(), weights_.data()};
    }

private:
    void visit(std::uint32_t index) {
        const Node& node = diffusion_.nodes_[index];
        const double least = glm::distance(at_, glm::clamp(at_, node.low, node.high));
        if (least > diffusion_.reach_)
            return;
        const glm::dvec3 size = node.high - node.low;
        const double distance = glm::distance(at_, node.center);
        // K varies on the scale of the distance, but at least on that of the depth of the sources below the
        // surface; far away it falls exponentially, by e over 1/sigma_tr.
        if (least > 0 && small(glm::dot(size, size), distance))
            return add(static_cast<std::uint32_t>(diffusion_.receivers_.size()) + index,
                       static_cast<float>(node.area) * diffusion_.kernel(distance * distance));
        if (node.right != 0) {
            visit(index + 1);
            return visit(node.right);
        }
        const glm::uvec3& t = diffusion_.triangles_[node.begin];
        CornerWeights weights{};
        integrate({diffusion_.position(t.x), diffusion_.position(t.y), diffusion_.position(t.z)},
                  {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)}, 0, weights);
        for (int corner = 0; corner < 3; ++corner)
            add(t[corner], glm::vec3(weights[0][corner], weights[1][corner], weights[2][corner]));
    }

    void add(std::uint32_t source, const glm::vec3& weight) {
        sources_.push_back(source);
        for (int c = 0; c < channels_; ++c)
            weights_.push_back(weight[c]);
    }

    bool small(double squared_extent, double distance) const {
        const double scale = distance * distance + diffusion_.scale_ * diffusion_.scale_;
        return squared_extent <= diffusion_.tolerance_ * scale && squared_extent <= diffusion_.max_extent_;
    }

    /// Adds the integrals over a part of a triangle whose corners have these barycentric coordinates; parts
    /// that are large relative to the variation of K are split into four.
    void integrate(const std::array<glm::dvec3, 3>& p, const std::array<glm::dvec3, 3>& barycentrics,
                   int depth, CornerWeights& weights) {
        constexpr int kMaxDepth = 16;
        const double extent =
            std::max({glm::dot(p[1] - p[0], p[1] - p[0]), glm::dot(p[2] - p[1], p[2] - p[1]),
                      glm::dot(p[0] - p[2], p[0] - p[2])});
        const glm::dvec3 center = (p[0] + p[1] + p[2]) / 3.0;
        const double distance = glm::distance(at_, center), area = doubled_area(p[0], p[1], p[2]) / 2;
        if (distance - std::sqrt(extent) > diffusion_.reach_)
            return;
        if (depth == kMaxDepth || parts_ >= kMaxParts || small(extent, distance)) {
            ++parts_;
            const glm::dvec3 middle = (barycentrics[0] + barycentrics[1] + barycentrics[2]) / 3.0;
            const glm::vec3 k = diffusion_.kernel(distance * distance);
            for (std::size_t c = 0; c < 3; ++c)
                weights[c] += area * static_cast<double>(k[static_cast<int>(c)]) * middle;
            return;
        }
        std::array<glm::dvec3, 3> q, b; // midpoints of the edges opposite to each corner
        for (std::size_t i = 0; i < 3; ++i) {
            q[i] = (p[(i + 1) % 3] + p[(i + 2) % 3]) / 2.0;
            b[i] = (barycentrics[(i + 1) % 3] + barycentrics[(i + 2) % 3]) / 2.0;
        }
        integrate(q, b, depth + 1, weights);
        integrate({p[0], q[2], q[1]}, {barycentrics[0], b[2], b[1]}, depth + 1, weights);
        integrate({q[2], p[1], q[0]}, {b[2], barycentrics[1], b[0]}, depth + 1, weights);
        integrate({q[1], q[0], p[2]}, {b[1], b[0], barycentrics[2]}, depth + 1, weights);
    }

    const DiffusionOperator& diffusion_;
    int channels_;
    std::vector<std::uint32_t> sources_;
    std::vector<float> weights_;
    glm::dvec3 at_{0};
    int parts_ = 0;
};

void DiffusionOperator::apply(int channels, int order, std::span<float> values, int threads) const {
    std::vector<glm::dvec3> positions;
    for (const std::uint32_t member : members_)
        positions.push_back(position(member));
    const std::vector<float> exit = at(positions, channels, order, values, threads);
    const auto stride = static_cast<std::size_t>(channels * coefficient_count(order));
    for (std::size_t i = 0; i < members_.size(); ++i)
        std::copy_n(&exit[i * stride], stride, &values[members_[i] * stride]);
}

std::vector<float> DiffusionOperator::at(std::span<const glm::dvec3> positions, int channels, int order,
                                         std::span<const float> values, int threads) const {
    const auto stride = static_cast<std::size_t>(channels * coefficient_count(order));
    std::vector<float> exit(positions.size() * stride);
    if (nodes_.empty())
        return exit;
    // The values, then the means of the nodes, children before parents.
    std::vector<float> from((receivers_.size() + nodes_.size()) * stride);
    std::copy_n(values.begin(), receivers_.size() * stride, from.begin());
    float* const means = &from[receivers_.size() * stride];
    for (std::size_t n = nodes_.size(); n-- > 0;) {
        const Node& node = nodes_[n];
        float* const mean = means + n * stride;
        if (node.right == 0) {
            const glm::uvec3& t = triangles_[node.begin];
            for (std::size_t i = 0; i < stride; ++i)
                mean[i] =
                    (values[t.x * stride + i] + values[t.y * stride + i] + values[t.z * stride + i]) / 3;
            continue;
        }
        const auto share = static_cast<float>(nodes_[n + 1].area / node.area);
        for (std::size_t i = 0; i < stride; ++i)
            mean[i] = share * means[(n + 1) * stride + i] + (1 - share) * means[node.right * stride + i];
    }
    parallel_for(positions.size(), 64, threads, [&](std::size_t begin, std::size_t end) {
        Gatherer gatherer(*this, channels);
        for (std::size_t i = begin; i < end; ++i) {
            const SparseRow row = gatherer.gather(positions[i]);
            apply_rows(order, channels, channels == 1, std::span(&row, 1), from.data(), &exit[i * stride]);
        }
    });
    return exit;
}

bool DiffusionOperator::is_grey() const {
    for (const double r : {0.0, scale_, 3 * scale_})
        for (const Dipole& dipole : dipoles_)
            if (dipole.reflectance(r) / dipole.total() != dipoles_[0].reflectance(r) / dipoles_[0].total())
                return false;
    return true;
}

} // namespace prt
