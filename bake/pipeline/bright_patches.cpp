// Builds a tree of patches that lamps light, and descends it by an upper bound of the light from each child.

#include "bake/pipeline/bright_patches.h"

#include "bake/surface_fit/surface_samples.h"
#include "prt/core/light.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

using std::numbers::pi;

/// Maximum number of triangles of a leaf, which are picked by their power only: 4 are not better, and slower.
constexpr std::uint32_t kLeafTriangles = 32;
constexpr int kBins = 12;
constexpr double kInPlane = 1e-6; ///< height over distance
constexpr double kMaxChoice = 1 - 0x1p-53;

/// Cosine and sine of an angle in [0, π].
struct Angle {
    double cosine, sine;

    static Angle of_cosine(double cosine) { return {cosine, std::sqrt(std::max(0.0, 1 - cosine * cosine))}; }
    /// The angle minus another angle, at least 0.
    Angle less(const Angle& other) const {
        if (cosine >= other.cosine)
            return {1, 0};
        return {cosine * other.cosine + sine * other.sine, sine * other.cosine - cosine * other.sine};
    }
};

/// Sum over lamps of the luminance that a side reflects, each lamp multiplied by its factor in `scale`
/// [lamps].
double radiosity(const Transfer& light, std::uint32_t receiver, const glm::vec3& reflectance,
                 std::span<const double> scale) {
    if (receiver == kNoReceiver)
        return 0;
    const auto channels = static_cast<std::size_t>(light.layout.channels());
    const std::size_t stride = light.dimension() / channels;
    double sum = 0;
    for (std::size_t k = 0; k < scale.size(); ++k) {
        glm::dvec3 color(0);
        for (int c = 0; c < 3; ++c)
            color[c] = static_cast<double>(
                light.vector(receiver)[std::min(static_cast<std::size_t>(c), channels - 1) * stride + k] *
                reflectance[c]);
        sum += scale[k] * luminance(color);
    }
    return sum;
}

/// Reciprocals of the light of each lamp, integrated over all receivers by area; 0 for a lamp that lights no
/// receiver.
std::vector<double> scales_of_lamps(const BakePlan& plan, const Transfer& light) {
    std::vector<double> scales;
    for (std::size_t k = 0; k < plan.lamps.size(); ++k) {
        std::vector<double> one(k + 1, 0.0);
        one[k] = 1;
        double sum = 0;
        for (std::uint32_t p = 0; p < light.receivers(); ++p)
            sum += static_cast<double>(plan.receivers().areas[p]) * radiosity(light, p, glm::vec3(1), one);
        scales.push_back(sum > 0 && std::isfinite(sum) ? 1 / sum : 0);
    }
    return scales;
}

} // namespace

std::array<glm::dvec3, 3> BrightPatches::corners(std::uint32_t triangle) const {
    const glm::uvec3& c = plan_.scene.surfaces().corners(triangle);
    const std::vector<glm::vec3>& positions = plan_.receivers().positions;
    return {glm::dvec3(positions[c.x]), glm::dvec3(positions[c.y]), glm::dvec3(positions[c.z])};
}

BrightPatches::BrightPatches(const BakePlan& plan, const Transfer& light) : plan_(plan) {
    add_patches(light);
    patch_of_.assign(2 * plan.scene.surfaces().triangles(), kNoReceiver);
    if (patches_.empty())
        return;
    build(0, static_cast<std::uint32_t>(patches_.size()), 0);
    for (std::uint32_t i = 0; i < patches_.size(); ++i)
        patch_of_[2 * patches_[i].triangle + (patches_[i].back ? 1 : 0)] = i;
}

void BrightPatches::add_patches(const Transfer& light) {
    const Surfaces& surfaces = plan_.scene.surfaces();
    const std::vector<double> scales = scales_of_lamps(plan_, light);
    for (const TriangleSide& side : triangle_sides(surfaces, *plan_.transport, true)) {
        const Scattering s =
            surfaces.scattering({side.triangle, glm::vec2(1.0f / 3), static_cast<float>(side.area)});
        const glm::uvec3 here = corner_receivers(surfaces, *plan_.transport, side.triangle, side.back),
                         there = corner_receivers(surfaces, *plan_.transport, side.triangle, !side.back);
        double mean = 0;
        for (int i = 0; i < 3; ++i)
            mean += (radiosity(light, here[i], s.reflected, scales) +
                     radiosity(light, there[i], s.transmitted, scales)) /
                    3;
        if (mean > 0 && side.area > 0 && surfaces.material(side.triangle).casts_shadow)
            patches_.push_back({side.triangle, side.back, mean * side.area, side.area});
    }
}

BrightPatches::Bounds BrightPatches::bounds_of(const Patch& patch) const {
    const auto [a, b, c] = corners(patch.triangle);
    const glm::dvec3 front = glm::normalize(glm::cross(b - a, c - a));
    return {glm::min(a, glm::min(b, c)),
            glm::max(a, glm::max(b, c)),
            {patch.back ? -front : front, 1},
            patch.power};
}

BrightPatches::Cone BrightPatches::joined(const Cone& a, const Cone& b) {
    if (a.axis == glm::dvec3(0))
        return b;
    if (b.axis == glm::dvec3(0))
        return a;
    const Cone &wide = a.cosine <= b.cosine ? a : b, &narrow = a.cosine <= b.cosine ? b : a;
    const double between = std::acos(std::clamp(glm::dot(wide.axis, narrow.axis), -1.0, 1.0)),
                 of_wide = std::acos(wide.cosine), of_narrow = std::acos(narrow.cosine);
    if (std::min(between + of_narrow, pi) <= of_wide)
        return wide;
    const double half = 0.5 * (of_wide + between + of_narrow);
    const glm::dvec3 across = narrow.axis - glm::dot(wide.axis, narrow.axis) * wide.axis;
    if (half >= pi || !(glm::length(across) > 1e-9))
        return {wide.axis, -1};
    const double rotation = half - of_wide;
    return {std::cos(rotation) * wide.axis + std::sin(rotation) * glm::normalize(across), std::cos(half)};
}

BrightPatches::Bounds BrightPatches::joined(const Bounds& a, const Bounds& b) {
    return {glm::min(a.low, b.low), glm::max(a.high, b.high), joined(a.normals, b.normals),
            a.power + b.power};
}

/// Power times area times the measure of the directions in which light leaves.
double BrightPatches::cost(const Bounds& bounds) {
    const glm::dvec3 d = bounds.high - bounds.low;
    const double area = d.x * d.y + d.y * d.z + d.z * d.x, cosine = bounds.normals.cosine,
                 angle = std::acos(cosine), sine = std::sin(angle), end = std::min(angle + pi / 2, pi);
    const double measure = 2 * pi * (1 - cosine) +
                           pi / 2 * (2 * end * sine - std::cos(angle - 2 * end) - 2 * angle * sine + cosine);
    return bounds.power * area * measure;
}

std::uint32_t BrightPatches::build(std::uint32_t begin, std::uint32_t end, std::uint32_t parent) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    Bounds all = bounds_of(patches_[begin]);
    for (std::uint32_t i = begin + 1; i < end; ++i)
        all = joined(all, bounds_of(patches_[i]));
    nodes_.push_back({.center = 0.5 * (all.low + all.high),
                      .half = 0.5 * (all.high - all.low),
                      .radius = 0.5 * glm::length(all.high - all.low),
                      .normals = all.normals,
                      .power = all.power,
                      .begin = begin,
                      .end = end,
                      .parent = parent});
    if (end - begin <= kLeafTriangles) {
        for (std::uint32_t i = begin; i < end; ++i)
            patches_[i].leaf = index;
        return index;
    }
    const std::uint32_t middle = split(begin, end, all);
    build(begin, middle, index);
    const std::uint32_t right = build(middle, end, index);
    nodes_[index].right = right;
    return index;
}

/// Bins the centroids of patches along each axis, and splits at the minimum total cost of both sides; splits
/// along longer axes of the box cost less.
struct BrightPatches::Split {
    double cost = std::numeric_limits<double>::infinity();
    int axis = 0, bin = 0;
};

std::uint32_t BrightPatches::split(std::uint32_t begin, std::uint32_t end, const Bounds& all) {
    const auto middle_of = [&](const Patch& patch) {
        const auto [a, b, c] = corners(patch.triangle);
        return (a + b + c) / 3.0;
    };
    const glm::dvec3 size = all.high - all.low;
    const double longest = std::max({size.x, size.y, size.z});
    const auto bin_of = [&](const Patch& patch, int axis) {
        return std::clamp(static_cast<int>(kBins * (middle_of(patch)[axis] - all.low[axis]) / size[axis]), 0,
                          kBins - 1);
    };
    Split best;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > 0))
            continue;
        std::array<std::optional<Bounds>, kBins> bins;
        for (std::uint32_t i = begin; i < end; ++i) {
            std::optional<Bounds>& bin = bins[static_cast<std::size_t>(bin_of(patches_[i], axis))];
            const Bounds bounds = bounds_of(patches_[i]);
            bin = bin ? joined(*bin, bounds) : bounds;
        }
        std::array<double, kBins> below{};
        std::optional<Bounds> sum;
        for (std::size_t i = 0; i < kBins; ++i) {
            if (bins[i])
                sum = sum ? joined(*sum, *bins[i]) : *bins[i];
            below[i] = sum ? cost(*sum) : std::numeric_limits<double>::infinity();
        }
        sum.reset();
        for (std::size_t i = kBins; i-- > 1;) {
            if (bins[i])
                sum = sum ? joined(*sum, *bins[i]) : *bins[i];
            const double both =
                (below[i - 1] + (sum ? cost(*sum) : std::numeric_limits<double>::infinity())) * longest /
                size[axis];
            if (both < best.cost)
                best = {both, axis, static_cast<int>(i)};
        }
    }
    const auto from = patches_.begin() + begin, to = patches_.begin() + end;
    if (std::isfinite(best.cost)) {
        const auto at = std::stable_partition(
            from, to, [&](const Patch& patch) { return bin_of(patch, best.axis) < best.bin; });
        if (at != from && at != to)
            return static_cast<std::uint32_t>(at - patches_.begin());
    }
    return begin + (end - begin) / 2; // all at one position
}

double BrightPatches::importance(const Node& node, const Receiver& receiver) {
    const glm::dvec3 to = node.center - receiver.position;
    const double squared = glm::dot(to, to), radius = node.radius, distance = std::sqrt(squared);
    // Height of the box above the receiver's plane. Patches in that plane do not light the receiver.
    const double height = glm::dot(receiver.normal, to) + glm::dot(glm::abs(receiver.normal), node.half);
    if (!(height > kInPlane * (radius + distance)))
        return 0;
    if (distance <= radius)
        return node.power / (radius * radius) * std::min(1.0, height / radius);
    const Angle round = Angle::of_cosine(std::sqrt(std::max(0.0, 1 - radius * radius / squared)));
    const double here = Angle::of_cosine(std::clamp(glm::dot(receiver.normal, to) / distance, -1.0, 1.0))
                            .less(round)
                            .cosine,
                 there = Angle::of_cosine(std::clamp(-glm::dot(node.normals.axis, to) / distance, -1.0, 1.0))
                             .less(Angle::of_cosine(node.normals.cosine))
                             .less(round)
                             .cosine;
    const double most = std::min(here, height / std::max(distance - radius, height));
    return most > 0 && there > 0 ? node.power * most * there / squared : 0;
}

double BrightPatches::share_of_left(std::uint32_t node, const Receiver& receiver) const {
    const double left = importance(nodes_[node + 1], receiver),
                 right = importance(nodes_[nodes_[node].right], receiver);
    return left + right > 0 ? left / (left + right) : -1;
}

std::optional<BrightPatches::Point> BrightPatches::pick(const Receiver& receiver, double choice,
                                                        const glm::dvec2& uv) const {
    if (patches_.empty())
        return std::nullopt;
    std::uint32_t node = 0;
    double probability = 1;
    while (nodes_[node].right != 0) {
        const double left = share_of_left(node, receiver);
        if (left < 0)
            return std::nullopt;
        const bool goes_left = choice < left;
        const double share = goes_left ? left : 1 - left;
        choice = std::clamp(goes_left ? choice / left : (choice - left) / share, 0.0, kMaxChoice);
        probability *= share;
        node = goes_left ? node + 1 : nodes_[node].right;
    }
    const Node& leaf = nodes_[node];
    std::uint32_t i = leaf.begin;
    double left = choice * leaf.power;
    while (i + 1 < leaf.end && left >= patches_[i].power)
        left -= patches_[i++].power;
    const Patch& patch = patches_[i];
    const auto [a, b, c] = corners(patch.triangle);
    return Point{patch.triangle, patch.back, a + uv.x * (b - a) + uv.y * (c - a),
                 probability * patch.power / (leaf.power * patch.area)};
}

double BrightPatches::density(const Receiver& receiver, std::uint32_t triangle, bool back) const {
    const std::uint32_t i = patch_of_[2 * triangle + (back ? 1 : 0)];
    if (i == kNoReceiver)
        return 0;
    const Patch& patch = patches_[i];
    double probability = patch.power / (nodes_[patch.leaf].power * patch.area);
    for (std::uint32_t node = patch.leaf; node != 0;) {
        const std::uint32_t parent = nodes_[node].parent;
        const double left = share_of_left(parent, receiver);
        if (left < 0)
            return 0;
        probability *= node == parent + 1 ? left : 1 - left;
        node = parent;
    }
    return probability;
}

} // namespace prt
