// Traces direct transfer independently of the baker.

#include "reference_tracer.h"

#include <embree3/rtcore.h>
#include <glm/geometric.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

namespace prt::test {
namespace {

/// Bands 0 to 2 as polynomials, with the Condon-Shortley phase (P.-P. Sloan, "Stupid Spherical Harmonics
/// Tricks", appendix A2).
Order3 basis(const glm::dvec3& d) {
    const double s1 = std::sqrt(3 / (4 * std::numbers::pi)), s2 = std::sqrt(15 / (4 * std::numbers::pi));
    return {std::sqrt(1 / (4 * std::numbers::pi)),
            -s1 * d.y,
            s1 * d.z,
            -s1 * d.x,
            s2 * d.x * d.y,
            -s2 * d.y * d.z,
            std::sqrt(5 / (16 * std::numbers::pi)) * (3 * d.z * d.z - 1),
            -s2 * d.x * d.z,
            s2 / 2 * (d.x * d.x - d.y * d.y)};
}

class BruteForce {
public:
    explicit BruteForce(const Scene& scene)
        : device_(rtcNewDevice("threads=1"), rtcReleaseDevice),
          scene_(rtcNewScene(device_.get()), rtcReleaseScene) {
        rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, scene.receivers()));
        auto* indices = static_cast<unsigned*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, scene.triangles()));
        for (const VertexArray& array : scene.vertex_arrays)
            for (const glm::vec3& p : array.positions)
                for (int axis = 0; axis < 3; ++axis)
                    *vertices++ = p[axis];
        for (const Primitive& primitive : scene.primitives)
            for (const glm::uvec3& t : primitive.triangles)
                for (int corner = 0; corner < 3; ++corner)
                    *indices++ = static_cast<unsigned>(
                        scene.vertex_arrays[primitive.vertices].first_receiver + t[corner]);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_.get());
    }

    bool blocked(const glm::dvec3& from, const glm::dvec3& along) const {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRay ray{};
        ray.org_x = static_cast<float>(from.x);
        ray.org_y = static_cast<float>(from.y);
        ray.org_z = static_cast<float>(from.z);
        ray.dir_x = static_cast<float>(along.x);
        ray.dir_y = static_cast<float>(along.y);
        ray.dir_z = static_cast<float>(along.z);
        ray.tfar = std::numeric_limits<float>::infinity();
        ray.mask = ~0u;
        rtcOccluded1(scene_.get(), &context, &ray);
        return ray.tfar < 0;
    }

private:
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device_;
    std::unique_ptr<RTCSceneTy, void (*)(RTCScene)> scene_;
};

/// Sums of the unit normals of the faces at each vertex.
std::vector<glm::dvec3> open_ways(const Scene& scene) {
    std::vector<glm::dvec3> ways(scene.receivers(), glm::dvec3(0));
    for (const Primitive& primitive : scene.primitives) {
        const VertexArray& array = scene.vertex_arrays[primitive.vertices];
        for (const glm::uvec3& t : primitive.triangles) {
            const glm::dvec3 a(array.positions[t.x]), b(array.positions[t.y]), c(array.positions[t.z]);
            const glm::dvec3 normal = glm::cross(b - a, c - a);
            for (int corner = 0; glm::length(normal) > 0 && corner < 3; ++corner)
                ways[array.first_receiver + t[corner]] += glm::normalize(normal);
        }
    }
    return ways;
}

/// (1/pi) ∫ V max(n·w, 0) Y dw by the cosine's own density: polar strata, one jittered ray in each.
Order3 transfer_at(const BruteForce& tracer, const glm::dvec3& start, const glm::dvec3& normal, int rays,
                   std::mt19937_64& random) {
    const glm::dvec3 side = glm::normalize(
        glm::cross(normal, std::abs(normal.x) < 0.5 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
    const glm::dvec3 other = glm::cross(normal, side);
    std::uniform_real_distribution<double> unit(0, 1);
    const int strata = static_cast<int>(std::lround(std::sqrt(rays)));
    Order3 sum{};
    for (int i = 0; i < strata; ++i)
        for (int j = 0; j < strata; ++j) {
            const double u = (i + unit(random)) / strata,
                         phi = 2 * std::numbers::pi * (j + unit(random)) / strata;
            const glm::dvec3 way =
                std::sqrt(u) * (std::cos(phi) * side + std::sin(phi) * other) + std::sqrt(1 - u) * normal;
            if (tracer.blocked(start, way))
                continue;
            const Order3 y = basis(way);
            for (std::size_t k = 0; k < 9; ++k)
                sum[k] += y[k] / (strata * strata);
        }
    return sum;
}

} // namespace

ReferenceTransfer reference_transfer(const Scene& scene, int rays) {
    const BruteForce tracer(scene);
    const std::vector<glm::dvec3> ways = open_ways(scene);
    const Bounds box = bounds(scene);
    const double height = 1e-6 * static_cast<double>(glm::length(box.high - box.low));
    std::mt19937_64 random(7);
    ReferenceTransfer result;
    for (const VertexArray& array : scene.vertex_arrays)
        for (std::size_t v = 0; v < array.size(); ++v) {
            const glm::dvec3 start = glm::dvec3(array.positions[v]) + height * ways[array.first_receiver + v];
            result.vectors.push_back(transfer_at(tracer, start, glm::dvec3(array.normals[v]), rays, random));
        }
    return result;
}

double ReferenceTransfer::relative_l2(const std::vector<float>& other,
                                      const std::vector<float>& areas) const {
    double error = 0, norm = 0;
    for (std::size_t p = 0; p < vectors.size(); ++p)
        for (std::size_t k = 0; k < 9; ++k) {
            const double off = static_cast<double>(other[9 * p + k]) - vectors[p][k];
            error += static_cast<double>(areas[p]) * off * off;
            norm += static_cast<double>(areas[p]) * vectors[p][k] * vectors[p][k];
        }
    return std::sqrt(error / norm);
}

} // namespace prt::test
