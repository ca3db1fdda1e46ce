// Gives voxels what surfaces in them stop: the shape over directions by areas and normals of the surfaces,
// the amount by rays, since surfaces that stand behind one another stop less than they would side by side.

#include "far/blocker_volume.h"
#include "prt/support/parallel.h"
#include "prt/support/tangent_frame.h"
#include "trace/sample_sequence.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>

namespace prt {
namespace {

constexpr std::size_t kNodeLines = 16384; ///< through whole nodes
constexpr int kLines = 64;                ///< through a voxel
constexpr float kPieces = 4;              ///< of an edge as long as a voxel's side
constexpr float kMostPieces = 64;         ///< of an edge
constexpr int kMostSurfaces = 256;        ///< that let a line through

/// A line's way through a voxel.
struct Line {
    glm::vec3 origin, direction;
    float length;
};

/// The way of a ray through the cube [corner, corner + size]; nothing where it misses.
std::optional<Line> cut_to_cube(const glm::vec3& origin, const glm::vec3& direction, const glm::vec3& corner,
                                float size) {
    const glm::vec3 a = (corner - origin) / direction, b = (corner + size - origin) / direction;
    const glm::vec3 first = glm::min(a, b), last = glm::max(a, b);
    const float from = glm::max(first.x, glm::max(first.y, first.z)),
                to = glm::min(last.x, glm::min(last.y, last.z));
    if (!(from < to))
        return std::nullopt;
    return Line{origin + from * direction, direction, to - from};
}

/// Lines that are uniform over all that meet a cube, by an additive sequence in four dimensions (Roberts
/// 2018) from a start of its own.
class Lines {
public:
    Lines(std::uint32_t seed, const glm::vec3& corner, float size) : corner_(corner), size_(size) {
        for (std::size_t i = 0; i < place_.size(); ++i)
            place_[i] = pcg_hash(seed * 4 + static_cast<std::uint32_t>(i));
    }
    Line next() {
        for (;;) {
            if (const auto line = candidate())
                return *line;
        }
    }

private:
    std::optional<Line> candidate() {
        // 2^32 over powers of the root of x^5 = x + 1.
        constexpr std::array<std::uint32_t, 4> kSteps = {3679390609u, 3152041523u, 2700274806u, 2313257605u};
        std::array<float, 4> u;
        for (std::size_t i = 0; i < u.size(); ++i) {
            place_[i] += kSteps[i];
            u[i] = static_cast<float>(place_[i] >> 8) * 0x1p-24f;
        }
        constexpr float kTurn = 2 * std::numbers::pi_v<float>;
        const float z = 1 - 2 * u[0], ring = std::sqrt(std::max(0.0f, 1 - z * z));
        const glm::vec3 direction(ring * std::cos(kTurn * u[1]), ring * std::sin(kTurn * u[1]), z);
        const float radius = 0.5f * std::numbers::sqrt3_v<float> * size_ * std::sqrt(u[2]);
        const TangentFrame frame = tangent_frame(direction);
        const glm::vec3 aside =
            radius * (std::cos(kTurn * u[3]) * frame.tangent + std::sin(kTurn * u[3]) * frame.bitangent);
        return cut_to_cube(corner_ + 0.5f * size_ + aside - 2 * size_ * direction, direction, corner_, size_);
    }

    glm::vec3 corner_;
    float size_;
    std::array<std::uint32_t, 4> place_{};
};

/// The factor `a` with sum over `depths` of exp(-a depth) = `passed`; of what stops all, as much as leaves
/// half a line.
float amount(std::span<const float> depths, double passed) {
    const double wanted = std::max(passed, 0.5);
    double a = 0; // from below, where the sum is convex: Newton's steps never go too far
    for (int i = 0; i < 32; ++i) {
        double sum = 0, slope = 0;
        for (const float depth : depths) {
            const double left = std::exp(-a * static_cast<double>(depth));
            sum += left;
            slope += static_cast<double>(depth) * left;
        }
        if (!(slope > 1e-12) || sum - wanted < 1e-4)
            break;
        a += (sum - wanted) / slope;
    }
    return static_cast<float>(a);
}

/// Traces lines through the triangles of dense meshes alone.
class LineTracer {
public:
    LineTracer(const TraceScene& scene, const DenseParts& dense, std::uint32_t seed)
        : scene_(scene), dense_(dense), random_(pcg_hash(~seed)) {}

    /// What stops the line first.
    std::optional<VoxelHit> first(const Line& line) {
        const Surfaces& surfaces = scene_.surfaces();
        Ray ray{line.origin, line.direction, 0, line.length};
        for (int surface = 0; surface < kMostSurfaces; ++surface) {
            const std::optional<RayHit> met = scene_.rays().nearest(ray);
            if (!met)
                break;
            ray.from = std::nextafter(met->distance, std::numeric_limits<float>::infinity());
            if (dense_.primitives[surfaces.primitive(met->triangle)] && stops({met->triangle, met->uv, 0}))
                return VoxelHit{met->triangle, met->uv,
                                glm::dot(scene_.rays().normal(met->triangle), line.direction) > 0,
                                line.direction};
        }
        return std::nullopt;
    }

    /// Whether the line comes from inside of a body, which nothing does that is far away: it meets backs of
    /// one-sided surfaces ahead and behind.
    bool from_inside(const Line& line, const VoxelHit& hit) {
        if (!hit.back || scene_.surfaces().two_sided(hit.triangle))
            return false;
        const std::optional<VoxelHit> behind =
            first({line.origin, -line.direction, std::numeric_limits<float>::infinity()});
        return behind && behind->back && !scene_.surfaces().two_sided(behind->triangle);
    }

private:
    bool stops(const SurfacePoint& point) {
        if (scene_.surfaces().opaque(point.triangle))
            return true;
        random_ = pcg_hash(random_);
        return scene_.surfaces().coverage(point) > static_cast<float>(random_ >> 8) * 0x1p-24f;
    }

    const TraceScene& scene_;
    const DenseParts& dense_;
    std::uint32_t random_;
};

} // namespace

void BlockerVolume::add_pieces(const TraceScene& scene, const DenseParts& dense) {
    const Scene& s = scene.scene();
    for (std::size_t p = 0; p < s.primitives.size(); ++p) {
        if (!dense.primitives[p])
            continue;
        const std::vector<glm::vec3>& positions = s.vertex_arrays[s.primitives[p].vertices].positions;
        for (const glm::uvec3& t : s.primitives[p].triangles) {
            const glm::vec3 &a = positions[t.x], b = positions[t.y] - a, c = positions[t.z] - a;
            const glm::vec3 doubled = glm::cross(b, c);
            const float twice = glm::length(doubled);
            if (!(twice > 0))
                continue;
            const float longest =
                std::sqrt(std::max({glm::dot(b, b), glm::dot(c, c), glm::dot(c - b, c - b)}));
            const auto parts = std::clamp(std::ceil(kPieces * longest / grid_.size()), 2.0f, kMostPieces);
            const float area =
                0.5f * twice / (parts * parts * grid_.size() * grid_.size()); // of a part, in sides
            const auto add = [&](float u, float v) {
                const std::uint32_t cell = grid_.add(a + (u * b + v * c) / parts);
                if (cell >= extinctions_.size())
                    extinctions_.resize(cell + 1);
                extinctions_[cell].add(doubled / twice, area);
            };
            for (float i = 0; i < parts; ++i)
                for (float j = 0; i + j < parts; ++j) {
                    add(i + 1.0f / 3, j + 1.0f / 3);
                    if (i + j + 1 < parts)
                        add(i + 2.0f / 3, j + 2.0f / 3);
                }
        }
    }
}

void BlockerVolume::fit(const TraceScene& scene, const DenseParts& dense, std::uint32_t cell) {
    const float size = grid_.size();
    Lines lines(cell, grid_.corner(cell), size);
    LineTracer tracer(scene, dense, cell);
    std::array<float, kLines> depths;
    std::optional<VoxelHit> from_inside;
    std::uint8_t& kept = kept_[cell];
    int passed = kLines;
    for (float& depth : depths) {
        const Line line = lines.next();
        depth = extinctions_[cell].along(line.direction) * line.length / size;
        const std::optional<VoxelHit> hit = tracer.first(line);
        if (!hit)
            continue;
        --passed;
        if (tracer.from_inside(line, *hit))
            from_inside = hit;
        else if (kept < kHits)
            hits_[std::size_t{cell} * kHits + kept++] = *hit;
    }
    if (kept == 0 && from_inside)
        hits_[std::size_t{cell} * kHits + kept++] = *from_inside;
    extinctions_[cell].scale(amount(depths, passed));
}

float BlockerVolume::fit_nodes(const TraceScene& scene, const DenseParts& dense) const {
    std::vector<Line> lines; // of one sequence, through a cube of side 1 in the place of each node
    for (Lines sequence(0, glm::vec3(0), 1); lines.size() < kNodeLines;)
        lines.push_back(sequence.next());
    std::vector<float> depths(kNodeLines);
    std::vector<std::uint8_t> open(kNodeLines);
    parallel_for(kNodeLines, 64, scene.threads(), [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Bounds& node = dense.nodes[i % dense.nodes.size()];
            const glm::vec3 sides = node.high - node.low;
            const float side = std::max({sides.x, sides.y, sides.z});
            const Line line{0.5f * (node.low + node.high - side) + side * lines[i].origin, lines[i].direction,
                            side * lines[i].length};
            depths[i] =
                depth(line.origin, line.direction, 0, line.length, std::numeric_limits<float>::infinity());
            open[i] = !LineTracer(scene, dense, static_cast<std::uint32_t>(i)).first(line);
        }
    });
    return amount(depths, static_cast<double>(std::ranges::count(open, std::uint8_t{1})));
}

} // namespace prt
