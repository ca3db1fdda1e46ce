// Finds double-sided surfaces whose backs are lit, patch by patch.

#include "bake/plan/plan.h"
#include "bake/reference/back_reach.h"
#include "bake/refine/sides.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace prt {
namespace {

constexpr std::size_t kPatchTriangles = 64;
/// Number of paths of a patch: at first, in total, and if none of them leaves the inside of its piece. If the
/// first paths of all patches of a piece, at least kPiecePaths together, find no light, the piece is dark.
constexpr std::uint32_t kFirstPaths = 8, kMaxPaths = 512, kHomePaths = 64, kPiecePaths = 256;
/// In a piece with at least this many patches, kFewPaths dark paths make a patch dark.
constexpr std::uint32_t kManyPatches = 16, kFewPaths = 128;
/// A patch is lit if this number of paths found light.
constexpr std::uint32_t kCertain = 4;
/// A piece is separated completely if this share of its area is lit.
constexpr double kMajority = 0.5;

bool can_separate(const Surfaces& surfaces, std::uint32_t t) {
    const Material& material = surfaces.material(t);
    return !surfaces.has_lobes(t) && material.double_sided && material.alpha_mode != AlphaMode::blend &&
           !surfaces.solid(t);
}

/// Groups connected receivers: receivers connected by `triangles`, and corners of one vertex array at the
/// same position.
class ConnectedReceivers {
public:
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
        std::ranges::sort(corners, {}, &Corner::position);
        for (std::size_t i = 1; i < corners.size(); ++i)
            if (corners[i].position == corners[i - 1].position)
                join(corners[i].receiver, corners[i - 1].receiver);
    }

    /// Returns the receiver that represents all receivers connected with `p`.
    std::uint32_t piece_of(std::uint32_t p) {
        while (first_[p] != p)
            p = first_[p] = first_[first_[p]];
        return p;
    }

private:
    struct Corner {
        std::tuple<std::size_t, float, float, float> position; ///< vertex array and position
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

/// Some triangles of a piece that are consecutive in the file.
struct Patch {
    std::vector<std::uint32_t> triangles;
    std::vector<double> areas; ///< sums up to and including each triangle

    std::uint32_t dark_paths = kMaxPaths; ///< the patch is dark after this many dark paths
    std::uint32_t paths = 0, found = 0;   ///< number of followed paths, and number of paths that found light
    double reach = 0;                     ///< sum over the paths
    bool at_home = true;                  ///< all paths stayed at home

    bool is_lit() const { return found > 0 && reach > kMinReach * paths; }
    bool is_surely_lit() const { return found >= kCertain && is_lit(); }
    bool is_surely_dark() const { return found == 0 && paths >= (at_home ? kHomePaths : dark_paths); }

    /// Triangle where the next path starts: half of the paths choose by area, the other half by index, so
    /// that a hut connected with a plain counts as much as the plain.
    std::uint32_t next() const {
        const double at = static_cast<double>(reverse_bits(paths / 2)) * 0x1p-32; // van der Corput
        if (paths % 2 == 0)
            return triangles[static_cast<std::size_t>(at * static_cast<double>(triangles.size()))];
        const auto here = std::upper_bound(areas.begin(), areas.end() - 1, at * areas.back());
        return triangles[static_cast<std::size_t>(here - areas.begin())];
    }
    void add(const BackReach::Path& path) {
        ++paths;
        found += path.reach > 0;
        reach += static_cast<double>(path.reach);
        at_home = at_home && path.at_home;
    }
};

class SideFinder {
public:
    SideFinder(const TraceScene& scene, const BakeOptions& options)
        : scene_(scene), surfaces_(scene.surfaces()), pieces_(surfaces_.triangles(), kNone),
          reach_(scene, choose_lamps(surfaces_, options.lamps), options.seed) {
        for (std::uint32_t t = 0; t < surfaces_.triangles(); ++t)
            if (can_separate(surfaces_, t))
                candidates_.push_back(t);
        ConnectedReceivers connected(surfaces_, candidates_);
        for (const std::uint32_t t : candidates_)
            pieces_[t] = connected.piece_of(surfaces_.corners(t).x);
        make_patches();
    }

    std::vector<bool> find(const std::stop_token& stop) {
        std::map<std::uint32_t, std::uint32_t> patches, found; // number of patches and of found paths per
                                                               // piece
        for (const Patch& patch : patches_)
            ++patches[piece_of(patch)];
        trace(
            [&](const Patch& patch) {
                return std::max(kFirstPaths, (kPiecePaths - 1) / patches.at(piece_of(patch)) + 1);
            },
            [](const Patch& patch) { return patch.is_surely_lit(); }, stop);
        for (Patch& patch : patches_) {
            found[piece_of(patch)] += patch.found;
            if (patches[piece_of(patch)] >= kManyPatches)
                patch.dark_paths = kFewPaths;
        }
        trace([&](const Patch& patch) { return found.at(piece_of(patch)) > 0 ? kMaxPaths : 0; },
              [](const Patch& patch) { return patch.is_surely_lit() || patch.is_surely_dark(); }, stop);
        return separated();
    }

private:
    static constexpr std::uint32_t kNone = ~0u;
    struct Areas {
        double lit = 0, all = 0;
    };

    void make_patches() {
        std::map<std::uint32_t, std::size_t> open; // current patch of a piece
        for (const std::uint32_t t : candidates_) {
            const auto [found, is_new] = open.try_emplace(pieces_[t], patches_.size());
            if (!is_new && patches_[found->second].triangles.size() == kPatchTriangles)
                found->second = patches_.size();
            if (found->second == patches_.size())
                patches_.emplace_back();
            Patch& patch = patches_[found->second];
            patch.triangles.push_back(t);
            patch.areas.push_back((patch.areas.empty() ? 0 : patch.areas.back()) +
                                  doubled_area(surfaces_, t));
        }
    }

    std::uint32_t piece_of(const Patch& patch) const { return pieces_[patch.triangles.front()]; }

    /// Traces paths of each patch until `clear(patch)` is true, or until it has `paths(patch)` paths.
    template <class Paths, class Clear>
    void trace(Paths&& paths, Clear&& clear, const std::stop_token& stop) {
        parallel_for(patches_.size(), 1, scene_.threads(), [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                if (stop.stop_requested())
                    throw Cancelled();
                Patch& patch = patches_[i];
                for (const std::uint32_t most = paths(patch); patch.paths < most && !clear(patch);)
                    patch.add(reach_.path(patch.next(), static_cast<std::uint32_t>(i), patch.paths, pieces_));
            }
        });
    }

    std::vector<bool> separated() const {
        std::map<std::uint32_t, Areas> of_pieces;
        for (const Patch& patch : patches_) {
            Areas& areas = of_pieces[piece_of(patch)];
            areas.all += patch.areas.back();
            areas.lit += patch.is_lit() ? patch.areas.back() : 0;
        }
        std::vector<bool> result;
        for (const Patch& patch : patches_) {
            const Areas& areas = of_pieces[piece_of(patch)];
            if (patch.is_lit() || areas.lit > kMajority * areas.all) {
                result.resize(surfaces_.triangles());
                for (const std::uint32_t t : patch.triangles)
                    result[t] = true;
            }
        }
        return result;
    }

    const TraceScene& scene_;
    const Surfaces& surfaces_;
    std::vector<std::uint32_t> candidates_; ///< triangles
    std::vector<std::uint32_t> pieces_;     ///< [triangles]
    std::vector<Patch> patches_;
    BackReach reach_;
};

} // namespace

std::vector<bool> sides_to_separate(const Scene& scene, const BakeOptions& options,
                                    const std::stop_token& stop) {
    if (std::ranges::none_of(scene.materials, &Material::double_sided))
        return {};
    const TraceScene traced = trace_scene(scene, choose_media(scene, options), options);
    return SideFinder(traced, options).find(stop);
}

} // namespace prt
