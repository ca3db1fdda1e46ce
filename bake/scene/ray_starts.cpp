// Finds ray origins in front of all faces of a vertex, from the nearest point of the convex hull of their
// normals (B. F. Mitchell, V. F. Dem'yanov and V. N. Malozemov, SIAM J. Control 12, 1974).

#include "bake/scene/ray_starts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

namespace prt {
namespace {

/// Minimum height of an origin above a face, and its distance along the surface, in surface offsets. A
/// distance of four reaches into a wedge of 20 degrees between a face and one that meets it at the vertex,
/// also at its corners.
constexpr double kMinHeight = 0.5, kAlong = 4;
/// Maximum distance from the position: a spike whose faces are 3 degrees off its axis needs it.
constexpr double kLongest = 16;

/// A triangle at one of its vertices.
struct Face {
    glm::dvec3 normal;    ///< unit, towards the side that the receiver faces
    double area;          ///< twice the area
    glm::dvec3 to_middle; ///< unit, from the vertex to the centroid of the triangle
};

/// Whether the triangle is so thin that its normal is dominated by rounding.
bool is_flat(double doubled_area, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double longest = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
    const glm::dvec3 extent = glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)));
    const double rounding = std::numeric_limits<float>::epsilon() * std::max({extent.x, extent.y, extent.z});
    return !(doubled_area > longest * rounding);
}

/// Lists the triangles at each vertex of an array.
class VertexTriangles {
public:
    VertexTriangles(const VertexArray& vertices, std::span<const Primitive* const> primitives)
        : vertices_(vertices), first_(vertices.size() + 1, 0) {
        for (const Primitive* primitive : primitives)
            for (const glm::uvec3& t : primitive->triangles)
                for (int corner = 0; corner < 3; ++corner)
                    ++first_[t[corner] + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        triangles_.resize(first_.back());
        std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
        for (const Primitive* primitive : primitives)
            for (const glm::uvec3& t : primitive->triangles)
                for (int corner = 0; corner < 3; ++corner)
                    triangles_[next[t[corner]]++] = &t;
    }

    /// Replaces `faces` by the faces of `vertex` that are not flat.
    void read(std::size_t vertex, std::vector<Face>& faces) const {
        faces.clear();
        const glm::dvec3 here(vertices_.positions[vertex]);
        for (std::size_t i = first_[vertex]; i < first_[vertex + 1]; ++i) {
            const glm::uvec3& t = *triangles_[i];
            const glm::dvec3 a(vertices_.positions[t.x]), b(vertices_.positions[t.y]),
                c(vertices_.positions[t.z]), normal = glm::cross(b - a, c - a);
            const double area = glm::length(normal);
            if (!is_flat(area, a, b, c))
                faces.push_back({normal / area, area, glm::normalize((a + b + c) / 3.0 - here)});
        }
    }

private:
    const VertexArray& vertices_;
    std::vector<std::size_t> first_;
    std::vector<const glm::uvec3*> triangles_;
};

double min_height(std::span<const Face> faces, const glm::dvec3& way) {
    double least = std::numeric_limits<double>::infinity();
    for (const Face& face : faces)
        least = std::min(least, glm::dot(way, face.normal));
    return least;
}

/// Returns the unit direction that is highest above the lowest of `faces`; zero if no direction is above all
/// of them. It points to the point of the normals' convex hull that is nearest to the origin. Each step moves
/// weight from the highest normal that has weight to the lowest normal (Mitchell, Dem'yanov and Malozemov
/// 1974).
glm::dvec3 most_open_direction(std::span<const Face> faces, std::vector<double>& shares) {
    constexpr int kSteps = 100;
    constexpr double kGap = 1e-3; // relative to the best height
    shares.assign(faces.size(), 1 / static_cast<double>(faces.size()));
    glm::dvec3 nearest(0);
    for (const Face& face : faces)
        nearest += face.normal * shares.front();
    for (int step = 0; step < kSteps; ++step) {
        std::size_t low = 0, high = 0;
        double least = std::numeric_limits<double>::infinity(), most = -least;
        for (std::size_t f = 0; f < faces.size(); ++f) {
            const double height = glm::dot(nearest, faces[f].normal);
            if (height < least) {
                least = height;
                low = f;
            }
            if (height > most && shares[f] > 0) {
                most = height;
                high = f;
            }
        }
        const glm::dvec3 way = faces[low].normal - faces[high].normal;
        const double squared = glm::dot(nearest, nearest), length = glm::dot(way, way);
        if (squared - least <= kGap * squared || !(length > 0))
            break;
        const double moved = std::clamp((most - least) / length, 0.0, shares[high]);
        shares[low] += moved;
        shares[high] = moved < shares[high] ? shares[high] - moved : 0;
        nearest += way * moved;
    }
    const double length = glm::length(nearest);
    if (!(length > 0) || !(min_height(faces, nearest / length) > 0))
        return glm::dvec3(0);
    return nearest / length;
}

/// Direction along the surface towards the centroids of `faces`; zero if they surround the vertex. On a
/// straight edge of a regular mesh the mean has length 0.6 to 0.9, inside it is near zero.
glm::dvec3 inward_direction(std::span<const Face> faces, const glm::dvec3& up) {
    constexpr double kMinMean = 0.25;
    glm::dvec3 sum(0);
    for (const Face& face : faces)
        sum += face.to_middle;
    const glm::dvec3 along = sum - up * glm::dot(up, sum);
    const double length = glm::length(along);
    return length > kMinMean * static_cast<double>(faces.size()) ? along / length : glm::dvec3(0);
}

/// Flips the normals of `faces` to the side of `normal`.
void orient(std::span<Face> faces, const glm::dvec3& normal) {
    glm::dvec3 sum(0);
    for (const Face& face : faces)
        sum += face.area * face.normal;
    if (glm::dot(sum, normal) < 0)
        for (Face& face : faces)
            face.normal = -face.normal;
}

glm::dvec3 ray_start(std::span<Face> all, const glm::dvec3& normal, std::vector<double>& shares) {
    orient(all, normal);
    std::span<Face> faces = all;
    glm::dvec3 up = faces.empty() ? glm::dvec3(0) : most_open_direction(faces, shares);
    if (up == glm::dvec3(0)) {
        // Faces on all sides, for example of two sheets that share a vertex: use the faces on the side of the
        // normal.
        const auto end = std::partition(all.begin(), all.end(),
                                        [&](const Face& face) { return glm::dot(face.normal, normal) > 0; });
        faces = all.first(static_cast<std::size_t>(end - all.begin()));
        up = faces.empty() ? glm::dvec3(0) : most_open_direction(faces, shares);
        if (up == glm::dvec3(0))
            return normal;
    }
    glm::dvec3 start = up * std::min(1 / min_height(faces, up), kLongest);
    const glm::dvec3 inward = inward_direction(faces, up);
    double most = kAlong;
    for (const Face& face : faces) {
        const double falls = -glm::dot(inward, face.normal);
        if (falls > 0)
            most = std::min(most, std::max(0.0, glm::dot(start, face.normal) - kMinHeight) / falls);
    }
    return start + most * inward;
}

} // namespace

std::vector<glm::vec3> ray_starts(const Scene& scene, Side side) {
    std::vector<std::vector<const Primitive*>> users(scene.vertex_arrays.size());
    for (const Primitive& primitive : scene.primitives)
        users[primitive.vertices].push_back(&primitive);
    std::vector<glm::vec3> starts;
    starts.reserve(scene.receivers());
    std::vector<Face> faces;
    std::vector<double> shares;
    for (std::size_t array = 0; array < users.size(); ++array) {
        const VertexArray& vertices = scene.vertex_arrays[array];
        const VertexTriangles triangles(vertices, users[array]);
        for (std::size_t v = 0; v < vertices.size(); ++v) {
            triangles.read(v, faces);
            const glm::dvec3 normal(vertices.normals[v]);
            starts.emplace_back(ray_start(faces, side == Side::back ? -normal : normal, shares));
        }
    }
    return starts;
}

} // namespace prt
