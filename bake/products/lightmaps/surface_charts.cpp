// Assigns an axis to every face, smooths borders of charts, and splits charts that overlap themselves.

#include "bake/products/lightmaps/surface_charts.h"

#include "bake/products/lightmaps/texel_samples.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace prt {
namespace {

constexpr int kDirections = 6; ///< +x, -x, +y, -y, +z, -z
constexpr double kSharp = 0.7; ///< cosine between the normals at an edge; below it, charts end at the edge
/// Minimum cosine between the normal of a face and its axis, except for needles.
constexpr double kSteepest = 0.3;
/// Resolution along the longer side of a chart for the search of overlaps.
constexpr int kOverlapTexels = 256;

double along(const glm::dvec3& normal, int direction) {
    return (direction % 2 == 0 ? 1 : -1) * normal[direction / 2];
}

int steepest_direction(const glm::dvec3& normal) {
    int best = 0;
    for (int d = 1; d < kDirections; ++d)
        if (along(normal, d) > along(normal, best))
            best = d;
    return best;
}

using Position = std::array<float, 3>;

/// Returns for each face the faces that share an edge with it which is not sharp: [faces].
std::vector<std::vector<std::uint32_t>> neighbours(const Scene& scene, std::span<const ChartFace> faces) {
    struct EdgeSide {
        std::uint32_t face;
        glm::vec3 first, second; // normals
    };
    std::map<std::pair<std::size_t, std::pair<Position, Position>>, std::vector<EdgeSide>> edges;
    for (std::uint32_t f = 0; f < faces.size(); ++f) {
        const Primitive& primitive = scene.primitives[faces[f].primitive];
        const VertexArray& vertices = scene.vertex_arrays[primitive.vertices];
        const glm::uvec3& t = primitive.triangles[faces[f].triangle];
        for (int i = 0; i < 3; ++i) {
            const auto point = [&](std::uint32_t v) {
                const glm::vec3& p = vertices.positions[v];
                return Position{p.x, p.y, p.z};
            };
            std::uint32_t a = t[i], b = t[(i + 1) % 3];
            if (point(b) < point(a))
                std::swap(a, b);
            edges[{faces[f].primitive, {point(a), point(b)}}].push_back(
                {f, vertices.normals[a], vertices.normals[b]});
        }
    }
    std::vector<std::vector<std::uint32_t>> result(faces.size());
    for (const auto& [edge, sides] : edges)
        for (std::size_t i = 1; i < sides.size(); ++i) {
            const EdgeSide &one = sides[i - 1], &other = sides[i];
            if (static_cast<double>(glm::dot(one.first, other.first)) > kSharp &&
                static_cast<double>(glm::dot(one.second, other.second)) > kSharp) {
                result[one.face].push_back(other.face);
                result[other.face].push_back(one.face);
            }
        }
    return result;
}

/// Returns the direction of each face: the one nearest to its normal, unless most of its neighbours have
/// another direction that is also possible for the face.
std::vector<int> directions(std::span<const ChartFace> faces,
                            const std::vector<std::vector<std::uint32_t>>& optional_work) {
    constexpr int kPasses = 32;
    constexpr double kOfNeighbours = 0.6; // weight of the neighbours relative to the cosine
    std::vector<int> direction;
    for (const ChartFace& face : faces)
        direction.push_back(steepest_direction(face.normal));
    for (int pass = 0, changed = 1; pass < kPasses && changed > 0; ++pass) {
        changed = 0;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            std::array<double, kDirections> score{};
            for (int d = 0; d < kDirections; ++d)
                score[static_cast<std::size_t>(d)] = along(faces[f].normal, d);
            for (const std::uint32_t n : optional_work[f])
                score[static_cast<std::size_t>(direction[n])] +=
                    kOfNeighbours / static_cast<double>(optional_work[f].size());
            int best = direction[f];
            for (int d = 0; d < kDirections; ++d)
                if (score[static_cast<std::size_t>(d)] > score[static_cast<std::size_t>(best)] &&
                    (along(faces[f].normal, d) >= kSteepest || faces[f].normal == glm::dvec3(0)))
                    best = d;
            changed += best != direction[f];
            direction[f] = best;
        }
    }
    return direction;
}

/// Returns the connected parts of a chart.
template <class SameChart>
std::vector<std::vector<std::uint32_t>>
connected(std::span<const std::uint32_t> faces, const std::vector<std::vector<std::uint32_t>>& optional_work,
          std::vector<int>& part, const SameChart& same) {
    std::vector<std::vector<std::uint32_t>> parts;
    for (const std::uint32_t f : faces)
        part[f] = -1;
    for (const std::uint32_t seed : faces) {
        if (part[seed] >= 0)
            continue;
        const auto number = static_cast<int>(parts.size());
        std::vector<std::uint32_t>& members = parts.emplace_back(1, seed);
        part[seed] = number;
        for (std::size_t i = 0; i < members.size(); ++i)
            for (const std::uint32_t n : optional_work[members[i]])
                if (part[n] == -1 && same(seed, n)) {
                    part[n] = number;
                    members.push_back(n);
                }
    }
    for (const std::uint32_t f : faces)
        part[f] = -2; // in no chart that is being split
    return parts;
}

bool overlaps(std::span<const ChartFace> faces, const SurfaceChart& chart) {
    glm::dvec2 low(projected(faces[chart.faces.front()].corners[0], chart.axis)), high = low;
    for (const std::uint32_t f : chart.faces)
        for (const glm::dvec3& corner : faces[f].corners) {
            low = glm::min(low, projected(corner, chart.axis));
            high = glm::max(high, projected(corner, chart.axis));
        }
    const double longer = std::max(high.x - low.x, high.y - low.y);
    if (!(longer > 0))
        return false;
    const double scale = kOverlapTexels / longer;
    Atlas atlas;
    atlas.width = std::max(1, static_cast<int>(std::ceil((high.x - low.x) * scale)));
    atlas.height = std::max(1, static_cast<int>(std::ceil((high.y - low.y) * scale)));
    std::vector<ChartTriangle> flat;
    for (const std::uint32_t f : chart.faces) {
        ChartTriangle& t = flat.emplace_back(ChartTriangle{f, {}});
        for (std::size_t i = 0; i < 3; ++i)
            t.corners[i] = (projected(faces[f].corners[i], chart.axis) - low) * scale;
    }
    return sample_texels(flat, atlas).overlapping > 0;
}

/// Returns the two halves of a chart that overlaps itself: nearer and farther along its axis.
std::array<std::vector<std::uint32_t>, 2> halves(std::span<const ChartFace> faces,
                                                 const SurfaceChart& chart) {
    const auto depth = [&](std::uint32_t f) {
        return faces[f].corners[0][chart.axis] + faces[f].corners[1][chart.axis] +
               faces[f].corners[2][chart.axis];
    };
    std::vector<std::uint32_t> sorted = chart.faces;
    std::stable_sort(sorted.begin(), sorted.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return depth(a) < depth(b); });
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    return {{{sorted.begin(), middle}, {middle, sorted.end()}}};
}

/// Appends faces without area to charts: to one that has one of their corners, else to the first.
void join_flat(std::span<const ChartFace> faces, std::span<const std::uint32_t> flat,
               std::vector<SurfaceChart>& charts) {
    if (charts.empty() || flat.empty()) {
        if (!flat.empty())
            charts.push_back({0, {flat.begin(), flat.end()}});
        return;
    }
    const auto point = [](const glm::dvec3& corner) { return std::array{corner.x, corner.y, corner.z}; };
    std::map<std::array<double, 3>, std::size_t> chart_at;
    for (std::size_t c = 0; c < charts.size(); ++c)
        for (const std::uint32_t f : charts[c].faces)
            for (const glm::dvec3& corner : faces[f].corners)
                chart_at.try_emplace(point(corner), c);
    for (const std::uint32_t f : flat) {
        std::size_t to = 0;
        for (const glm::dvec3& corner : faces[f].corners)
            if (const auto found = chart_at.find(point(corner)); found != chart_at.end())
                to = found->second;
        charts[to].faces.push_back(f);
    }
}

/// Returns twice the area of the face if its height were the rounding error of its corners as floats. A
/// smaller face has corners on a line, up to rounding.
double rounding_of(const ChartFace& face) {
    constexpr double kRounding = 4 * 0x1p-24; // rounding of two corners and of the line between them
    double largest = 0, longest = 0;
    for (int i = 0; i < 3; ++i) {
        largest = std::max(largest, glm::length(face.corners[i]));
        longest = std::max(longest, glm::distance(face.corners[i], face.corners[(i + 1) % 3]));
    }
    return kRounding * largest * longest;
}

} // namespace

glm::dvec2 projected(const glm::dvec3& position, int axis) {
    return {position[(axis + 1) % 3], position[(axis + 2) % 3]};
}

std::vector<ChartFace> chart_faces(const Scene& scene, std::span<const std::size_t> primitives) {
    std::vector<ChartFace> faces;
    for (const std::size_t p : primitives) {
        const Primitive& primitive = scene.primitives[p];
        const auto& positions = scene.vertex_arrays[primitive.vertices].positions;
        for (std::size_t t = 0; t < primitive.triangles.size(); ++t) {
            ChartFace face{p, t, {}};
            for (int i = 0; i < 3; ++i)
                face.corners[i] = glm::dvec3(positions[primitive.triangles[t][i]]);
            const glm::dvec3 normal =
                glm::cross(face.corners[1] - face.corners[0], face.corners[2] - face.corners[0]);
            const double length = glm::length(normal);
            face.normal = length > rounding_of(face) ? normal / length : glm::dvec3(0);
            faces.push_back(face);
        }
    }
    return faces;
}

std::vector<SurfaceChart> cut_into_charts(const Scene& scene, std::span<const ChartFace> faces,
                                          std::size_t max_charts) {
    const std::vector<std::vector<std::uint32_t>> optional_work = neighbours(scene, faces);
    const std::vector<int> direction = directions(faces, optional_work);
    std::vector<int> part(faces.size(), -2);
    std::vector<std::uint32_t> all(faces.size());
    for (std::uint32_t f = 0; f < faces.size(); ++f)
        all[f] = f;
    std::vector<SurfaceChart> waiting, done;
    std::vector<std::uint32_t> flat;
    const auto has_area = [&](std::uint32_t f) { return faces[f].normal != glm::dvec3(0); };
    const auto wait = [&](std::span<const std::uint32_t> some) {
        const auto same = [&](std::uint32_t a, std::uint32_t b) { return direction[a] == direction[b]; };
        for (std::vector<std::uint32_t>& members : connected(some, optional_work, part, same))
            if (std::any_of(members.begin(), members.end(), has_area))
                waiting.push_back({direction[members.front()] / 2, std::move(members)});
            else
                flat.insert(flat.end(), members.begin(), members.end());
    };
    wait(all);
    while (!waiting.empty() && waiting.size() + done.size() <= max_charts) {
        SurfaceChart chart = std::move(waiting.back());
        waiting.pop_back();
        // Two triangles that face the same side do not overlap: they are on both sides of their edge.
        if (chart.faces.size() <= 2 || !overlaps(faces, chart))
            done.push_back(std::move(chart));
        else
            for (const std::vector<std::uint32_t>& half : halves(faces, chart))
                wait(half);
    }
    std::move(waiting.begin(), waiting.end(), std::back_inserter(done));
    join_flat(faces, flat, done);
    return done;
}

} // namespace prt
