// Finds double-sided surfaces that are lit on both sides, piece by piece.

#include "plan.h"
#include "prt/sides.h"
#include "sides/light_reach.h"
#include "trace/picked.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>
#include <utility>

namespace prt {
namespace {

constexpr std::size_t kMinSamples = 8, kMaxSamples = 1024; ///< of a side of a piece

bool can_separate(const Surfaces& surfaces, std::uint32_t t) {
    const Material& material = surfaces.material(t);
    return material.double_sided && material.casts_shadow && material.alpha_mode != AlphaMode::blend &&
           material.glass.factor <= 0 && !surfaces.transmits(t) && !surfaces.solid(t);
}

/// Receivers that hang together.
class ConnectedReceivers {
public:
    /// Joined by `triangles`, and where corners of one vertex array have the same position.
    ConnectedReceivers(const Surfaces& surfaces, std::span<const std::uint32_t> triangles)
        : first_(surfaces.scene().receivers()) {
        std::iota(first_.begin(), first_.end(), 0u);
        std::vector<Corner> corners;
        for (const std::uint32_t t : triangles) {
            const glm::uvec3& c = surfaces.corners(t);
            const std::size_t array = surfaces.scene().primitives[surfaces.primitive(t)].vertices;
            const VertexArray& vertices = surfaces.scene().vertex_arrays[array];
            for (int corner = 0; corner < 3; ++corner) {
                join(c[corner], c.x);
                const glm::vec3& at = vertices.positions[c[corner] - vertices.first_receiver];
                corners.push_back({{array, at.x, at.y, at.z}, c[corner]});
            }
        }
        std::ranges::sort(corners, {}, &Corner::place);
        for (std::size_t i = 1; i < corners.size(); ++i)
            if (corners[i].place == corners[i - 1].place)
                join(corners[i].receiver, corners[i - 1].receiver);
    }

    /// The receiver that stands for the piece of receiver `p`.
    std::uint32_t piece_of(std::uint32_t p) {
        while (first_[p] != p)
            p = first_[p] = first_[first_[p]];
        return p;
    }

private:
    struct Corner {
        std::tuple<std::size_t, float, float, float> place; ///< vertex array and position
        std::uint32_t receiver;
    };
    void join(std::uint32_t a, std::uint32_t b) { first_[piece_of(a)] = piece_of(b); }

    std::vector<std::uint32_t> first_;
};

double doubled_area(const Surfaces& surfaces, std::uint32_t t) {
    const glm::uvec3& c = surfaces.corners(t);
    const VertexArray& vertices =
        surfaces.scene().vertex_arrays[surfaces.scene().primitives[surfaces.primitive(t)].vertices];
    const auto at = [&](unsigned corner) { return vertices.positions[corner - vertices.first_receiver]; };
    return static_cast<double>(glm::length(glm::cross(at(c.y) - at(c.x), at(c.z) - at(c.x))));
}

struct Piece {
    std::vector<std::uint32_t> triangles;
};

std::vector<Piece> pieces_of(const Surfaces& surfaces, const std::vector<std::uint32_t>& triangles) {
    ConnectedReceivers connected(surfaces, triangles);
    std::map<std::uint32_t, Piece> pieces;
    for (const std::uint32_t t : triangles)
        pieces[connected.piece_of(surfaces.corners(t).x)].triangles.push_back(t);
    std::vector<Piece> result;
    for (auto& [receiver, piece] : pieces)
        result.push_back(std::move(piece));
    return result;
}

/// Triangles that stand for pieces, drawn by area.
struct Samples {
    std::vector<std::uint32_t> triangles;
    std::vector<std::size_t> ends; ///< [pieces]
};

Samples sample(const Surfaces& surfaces, std::span<const Piece> pieces) {
    Samples samples;
    for (const Piece& piece : pieces) {
        const std::size_t all = piece.triangles.size();
        const auto area = [&](std::size_t i) { return doubled_area(surfaces, piece.triangles[i]); };
        for (const Picked& picked : pick(all, std::clamp(all, kMinSamples, kMaxSamples), area))
            samples.triangles.insert(samples.triangles.end(), picked.times, piece.triangles[picked.index]);
        samples.ends.push_back(samples.triangles.size());
    }
    return samples;
}

/// Takes those pieces out that no light reaches on that side.
void keep_reached(const TraceScene& scene, Side side, const ReachOptions& options,
                  const std::stop_token& stop, std::vector<Piece>& pieces) {
    const Samples samples = sample(scene.surfaces(), pieces);
    const std::vector<float> reach = light_reach(scene, samples.triangles, side, options, stop);
    std::size_t begin = 0, piece = 0;
    std::erase_if(pieces, [&](const Piece&) {
        const std::size_t end = samples.ends[piece++];
        double sum = 0;
        for (std::size_t s = begin; s < end; ++s)
            sum += static_cast<double>(reach[s]);
        const double least = kLeastReach * static_cast<double>(end - std::exchange(begin, end));
        return !(sum > least);
    });
}

} // namespace

std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop) {
    if (std::ranges::none_of(scene.materials, &Material::double_sided))
        return {};
    const TraceScene traced = trace_scene(scene, choose_media(scene, options), options);
    const Surfaces& surfaces = traced.surfaces();
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < surfaces.triangles(); ++t)
        if (can_separate(surfaces, t))
            triangles.push_back(t);
    std::vector<Piece> pieces = pieces_of(surfaces, triangles);
    const std::vector<Lamp> lamps = choose_lamps(surfaces, options.lamps);
    const ReachOptions reach{.lamps = lamps, .seed = options.seed};
    for (const Side side : {Side::back, Side::front})
        keep_reached(traced, side, reach, stop, pieces);
    if (pieces.empty())
        return {};
    std::vector<bool> result(surfaces.triangles());
    for (const Piece& piece : pieces)
        for (const std::uint32_t t : piece.triangles)
            result[t] = true;
    return result;
}

} // namespace prt
