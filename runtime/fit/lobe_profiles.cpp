// Clusters lobe profiles by k-means on normalised shapes: gain-shape vector quantisation (Gersho and Gray,
// "Vector quantization and signal compression", 1992, section 12.10).

#include "runtime/fit/lobe_profiles.h"

#include "prt/core/sh.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace prt {
namespace {

using Shape = std::array<double, kMaxLobeOrder>;

constexpr int kMeansRounds = 12; ///< assignments hardly change after this number

/// A lobe in units in which the squared distance is the cost of an error.
struct Sized {
    Shape shape{}; ///< unit length
    double size = 0, weight = 0;
};

double dot(const Shape& a, const Shape& b) {
    double sum = 0;
    for (std::size_t l = 0; l < a.size(); ++l)
        sum += a[l] * b[l];
    return sum;
}

std::vector<Sized> sized(std::span<const Lobe> lobes, std::span<const float> areas, const Shape& costs) {
    std::vector<Sized> all;
    for (std::size_t i = 0; i < lobes.size(); ++i) {
        Sized one;
        for (std::size_t l = 0; l < one.shape.size(); ++l)
            one.shape[l] = std::sqrt(costs[l]) * static_cast<double>(lobes[i].profile[l]);
        one.size = std::sqrt(dot(one.shape, one.shape));
        if (!(one.size > 1e-6))
            continue;
        for (double& s : one.shape)
            s /= one.size;
        one.weight = static_cast<double>(areas[i]) * one.size * one.size;
        all.push_back(one);
    }
    return all;
}

/// Returns the shape with the smallest angle to `to`; the first if no shape has a positive dot product.
std::size_t nearest(std::span<const Shape> shapes, const Shape& to) {
    std::size_t best = 0;
    double most = 0;
    for (std::size_t p = 0; p < shapes.size(); ++p)
        if (const double d = dot(shapes[p], to); d > most) {
            most = d;
            best = p;
        }
    return best;
}

/// Chooses start shapes by k-means++ (Arthur and Vassilvitskii 2007), in addition to the given first shape.
std::vector<Shape> first_shapes(std::span<const Sized> lobes, const Shape& first, std::size_t most) {
    std::mt19937_64 random(1);
    std::vector<Shape> shapes = {first};
    std::vector<double> losses(lobes.size(), std::numeric_limits<double>::infinity());
    while (shapes.size() < most) {
        double sum = 0;
        for (std::size_t i = 0; i < lobes.size(); ++i) {
            const double cosine = std::max(dot(shapes.back(), lobes[i].shape), 0.0);
            losses[i] = std::min(losses[i], lobes[i].weight * std::max(1 - cosine * cosine, 0.0));
            sum += losses[i];
        }
        if (!(sum > 1e-12))
            break; // all shapes are represented
        // std::uniform_real_distribution is avoided: its results depend on the standard library.
        double drawn = sum * static_cast<double>(random() >> 11) * 0x1p-53;
        std::size_t i = 0;
        while (i + 1 < lobes.size() && (drawn -= losses[i]) > 0)
            ++i;
        shapes.push_back(lobes[i].shape);
    }
    return shapes;
}

/// Moves each shape except the first to the mean of its lobes; shapes without lobes do not move.
void move_shapes(std::span<const Sized> lobes, std::span<Shape> shapes) {
    std::vector<Shape> sums(shapes.size());
    for (const Sized& lobe : lobes) {
        Shape& sum = sums[nearest(shapes, lobe.shape)];
        for (std::size_t l = 0; l < sum.size(); ++l)
            sum[l] += lobe.weight * lobe.shape[l];
    }
    for (std::size_t p = 1; p < shapes.size(); ++p)
        if (const double length = std::sqrt(dot(sums[p], sums[p])); length > 0)
            for (std::size_t l = 0; l < sums[p].size(); ++l)
                shapes[p][l] = sums[p][l] / length;
}

} // namespace

std::array<double, kMaxLobeOrder> profile_costs(int order, const LobeFitOptions& options) {
    std::array<double, kMaxLobeOrder> costs{};
    for (int l = 0; l < order; ++l)
        costs[static_cast<std::size_t>(l)] =
            options.band_costs[static_cast<std::size_t>(l)] * (2 * l + 1) / (4 * std::numbers::pi);
    return costs;
}

LobeProfile cosine_profile(int order) {
    LobeProfile profile{};
    for (int l = 0; l < order; ++l)
        profile[static_cast<std::size_t>(l)] = static_cast<float>(clamped_cosine_factor(l));
    return profile;
}

std::vector<LobeProfile> shared_profiles(int order, std::span<const Lobe> lobes, std::span<const float> areas,
                                         const LobeFitOptions& options) {
    const Shape costs = profile_costs(order, options);
    const std::vector<Sized> all = sized(lobes, areas, costs);
    const Lobe cosine{{0, 0, 1}, cosine_profile(order)};
    const float one = 1;
    std::vector<Shape> shapes =
        first_shapes(all, sized({&cosine, 1}, {&one, 1}, costs).front().shape, options.profiles);
    for (int round = 0; round < kMeansRounds; ++round)
        move_shapes(all, shapes);
    std::vector<double> largest(shapes.size());
    for (const Sized& lobe : all) {
        double& most = largest[nearest(shapes, lobe.shape)];
        most = std::max(most, lobe.size);
    }
    std::vector<LobeProfile> profiles = {cosine.profile};
    for (std::size_t p = 1; p < shapes.size(); ++p) {
        LobeProfile& profile = profiles.emplace_back();
        for (std::size_t l = 0; l < static_cast<std::size_t>(order); ++l)
            if (costs[l] > 0)
                profile[l] = static_cast<float>(largest[p] * shapes[p][l] / std::sqrt(costs[l]));
    }
    return profiles;
}

} // namespace prt
