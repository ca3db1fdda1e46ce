// Embree's hierarchy of the triangles of a scene (Wald et al. 2014), and offsets of rays from its surfaces.

#include "bake/scene/ray_scene.h"

#include "bake/scene/opposite_triangles.h"
#include "prt/core/error.h"
#include "runtime/core/support/parallel.h"
#include "shared_bake.h"

#include <embree3/rtcore.h>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <type_traits>

namespace prt {
namespace {

/// Offset of rays from surfaces, relative to coordinates: 12 roundings of a float; see PRT_LENGTH_OFFSET.
constexpr float kCoordinateOffset = 12 * std::numeric_limits<float>::epsilon() / 2;

float largest_coordinate(const glm::vec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

RTCRay embree_ray(const Ray& ray) {
    const glm::vec3 &o = ray.origin, &d = ray.direction;
    return {o.x, o.y, o.z, ray.from, d.x, d.y, d.z, 0, ray.to, ~0u, 0, 0};
}

struct SidedHit {
    RayHit hit;
    bool back;
};

std::optional<SidedHit> nearest_hit(RTCScene scene, RTCIntersectContext& context, const Ray& ray) {
    RTCRayHit hit{embree_ray(ray), {}};
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, &context, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return std::nullopt;
    const bool back = glm::dot(glm::vec3(hit.hit.Ng_x, hit.hit.Ng_y, hit.hit.Ng_z), ray.direction) > 0;
    return SidedHit{{hit.hit.primID, {hit.hit.u, hit.hit.v}, hit.ray.tfar}, back};
}

/// Context of a query with a filter. Embree returns the address of its first member.
struct FilteringContext {
    RTCIntersectContext context;
    const std::function<bool(unsigned)>& accepts;
};

void filter(const RTCFilterFunctionNArguments* arguments) {
    const auto& filtering = *reinterpret_cast<const FilteringContext*>(arguments->context);
    if (!filtering.accepts(RTCHitN_primID(arguments->hit, arguments->N, 0)))
        arguments->valid[0] = 0;
}

} // namespace

void RayScene::Release::operator()(RTCDeviceTy* device) const {
    rtcReleaseDevice(device);
}

void RayScene::Release::operator()(RTCSceneTy* scene) const {
    rtcReleaseScene(scene);
}

std::optional<RayHit> RayScene::nearest(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::optional<SidedHit> met = nearest_hit(scene_.get(), context, ray);
    if (!met)
        return std::nullopt;
    if (met->back)
        opposites_->move_to_front(met->hit.triangle, met->hit.uv);
    return met->hit;
}

std::optional<RayHit> RayScene::nearest(const Ray& ray, const std::function<bool(unsigned)>& accepts) const {
    FilteringContext filtering{{}, accepts};
    rtcInitIntersectContext(&filtering.context);
    filtering.context.filter = filter;
    const std::optional<SidedHit> met = nearest_hit(scene_.get(), filtering.context, ray);
    return met ? std::optional(met->hit) : std::nullopt;
}

bool RayScene::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay blocked = embree_ray(ray);
    rtcOccluded1(scene_.get(), &context, &blocked);
    return blocked.tfar < 0;
}

RayScene::RayScene(RayScene&&) noexcept = default;
RayScene::~RayScene() = default;

RayScene::RayScene(const Scene& scene, int threads)
    : opposites_(std::make_unique<const OppositeTriangles>(scene)) {
    device_.reset(rtcNewDevice(("threads=" + std::to_string(thread_count(threads))).c_str()));
    if (!device_)
        throw Error("Embree cannot be started");
    scene_.reset(rtcNewScene(device_.get()));
    // Robust: the triangle test does not depend on the hierarchy, so results do not depend on the build.
    // Filters belong to queries; the queries of a bake have none.
    rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION);
    rtcSetSceneBuildQuality(scene_.get(), RTC_BUILD_QUALITY_HIGH);

    RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), scene.receivers()));
    auto* indices = static_cast<glm::uvec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(glm::uvec3), scene.triangles()));
    if ((!vertices || !indices) && scene.triangles() > 0)
        throw Error("there is not enough memory for the triangles");
    positions_ = vertices;
    corners_ = indices;
    for (const VertexArray& array : scene.vertex_arrays)
        vertices = std::copy(array.positions.begin(), array.positions.end(), vertices);
    for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
        const Primitive& primitive = scene.primitives[p];
        const VertexArray& array = scene.vertex_arrays[primitive.vertices];
        for (std::size_t t = 0; t < primitive.triangles.size(); ++t) {
            const glm::uvec3& triangle = primitive.triangles[t];
            const auto id = static_cast<unsigned>(triangles_.size());
            const bool hit = scene.materials[primitive.material].casts_shadow && opposites_->traced(id) == id;
            // Degenerate triangles cannot be hit; the indices of the other triangles do not change.
            *indices++ =
                (hit ? triangle : glm::uvec3(triangle.x)) + static_cast<unsigned>(array.first_receiver);
            triangles_.push_back({static_cast<std::uint32_t>(p), static_cast<std::uint32_t>(t)});
        }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
    if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
        throw Error("there is not enough memory for the bounding volume hierarchy");
}

template <class Visit>
void RayScene::visit_near(const glm::vec3& position, float distance, Visit&& visit) const {
    RTCPointQuery query{position.x, position.y, position.z, 0, distance};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(
        scene_.get(), &query, &context,
        [](RTCPointQueryFunctionArguments* arguments) {
            (*static_cast<std::remove_reference_t<Visit>*>(arguments->userPtr))(arguments->primID);
            return false; // the radius does not change
        },
        &visit);
}

bool RayScene::triangle_reaches(unsigned id, const glm::vec3& position, float distance) const {
    const glm::uvec3& t = corners_[id];
    const glm::vec3 &a = positions_[t.x], &b = positions_[t.y], &c = positions_[t.z];
    return glm::all(glm::lessThanEqual(glm::min(a, glm::min(b, c)) - distance, position)) &&
           glm::all(glm::greaterThanEqual(glm::max(a, glm::max(b, c)) + distance, position));
}

float RayScene::surface_offset(const glm::vec3& position) const {
    const float coordinate = largest_coordinate(position);
    const float near = std::max(coordinate * 1e-6f, std::numeric_limits<float>::min());
    float length = 0;
    visit_near(position, near, [&](unsigned id) {
        if (!triangle_reaches(id, position, near))
            return; // only another triangle in its leaf is near
        for (int corner = 0; corner < 3; ++corner)
            length = std::max(length, largest_coordinate(positions_[corners_[id][corner]] - position));
    });
    return coordinate_offset(position) + PRT_LENGTH_OFFSET * length;
}

float RayScene::coordinate_offset(const glm::vec3& position) {
    return kCoordinateOffset * largest_coordinate(position);
}

void RayScene::triangles_near(const glm::vec3& position, float distance, std::vector<unsigned>& ids) const {
    ids.clear();
    visit_near(position, distance, [&](unsigned id) { ids.push_back(id); });
}

float RayScene::triangle_offset(unsigned id, float distance) const {
    const glm::uvec3& t = corners_[opposites_->traced(id)];
    const glm::vec3 &a = positions_[t.x], &b = positions_[t.y], &c = positions_[t.z];
    const float length =
        std::max({largest_coordinate(b - a), largest_coordinate(c - b), largest_coordinate(a - c)});
    return coordinate_offset(glm::max(glm::abs(a), glm::max(glm::abs(b), glm::abs(c)))) +
           PRT_LENGTH_OFFSET * (length + distance);
}

glm::vec3 RayScene::ray_origin(const Receivers& receivers, std::uint32_t index) const {
    const glm::vec3& position = receivers.positions[index];
    const auto& starts = receivers.starts.empty() ? receivers.normals : receivers.starts;
    const float unit = surface_offset(position);
    return position + (starts[index] + way_off_surfaces(position, starts[index], unit)) * unit;
}

glm::vec3 RayScene::way_off_surfaces(const glm::vec3& position, const glm::vec3& start, float unit) const {
    constexpr double kOnIt = 0.25, kAway = 0.5; // units
    const glm::dvec3 point = glm::dvec3(position) + static_cast<double>(unit) * glm::dvec3(start);
    glm::dvec3 way(0), largest(-2);
    visit_near(position, 2 * unit, [&](unsigned id) {
        const glm::uvec3& t = corners_[id];
        if (!triangle_reaches(id, position, 2 * unit))
            return; // only another triangle in its leaf is near
        const glm::dvec3 a(positions_[t.x]), b(positions_[t.y]), c(positions_[t.z]);
        const glm::dvec3 area = glm::cross(b - a, c - a);
        const double squared = glm::dot(area, area),
                     along = glm::dot(area, point - a) / static_cast<double>(unit);
        if (!(along * along < kOnIt * kOnIt * squared))
            return;
        const bool above_it = glm::dot(glm::cross(b - a, point - a), area) >= 0 &&
                              glm::dot(glm::cross(c - b, point - b), area) >= 0 &&
                              glm::dot(glm::cross(a - c, point - c), area) >= 0;
        if (!above_it)
            return;
        const double doubled = std::sqrt(squared);
        const glm::dvec3 normal = area / doubled;
        way += normal * (kAway - along / doubled);
        if (std::tie(largest.x, largest.y, largest.z) < std::tie(normal.x, normal.y, normal.z))
            largest = normal;
    });
    if (largest.x < -1)
        return glm::vec3(0);
    // The sides of a closed sheet cancel each other: then use one of them, independent of the order of the
    // visit.
    return glm::vec3(glm::length(way) < kOnIt ? kAway * largest : way);
}

} // namespace prt
