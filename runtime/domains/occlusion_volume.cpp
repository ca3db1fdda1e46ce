// Occlusion by moving objects from two moments of the blocked directions. The cosine-weighted size of a cap
// is the form factor of a sphere cut by the horizon (Snyder, Area light sources for real-time graphics,
// 1996).

#include "prt/core/occlusion_volume.h"

#include "prt/core/error.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prt {
namespace {

/// Returns the fraction of the cosine-weighted hemisphere that a cap covers. The cap is at most half of the
/// sphere; `cosine` is that of the angle between its center and the normal.
float cap_cosine(float share, float cosine) {
    const float squared = 4 * share * (1 - share); // squared sine of the cap's radius
    if (cosine * cosine >= squared)                // the cap is entirely above or below the horizon
        return std::max(cosine, 0.0f) * squared;
    const float cotangent = (1 - 2 * share) / std::sqrt(squared), sine = std::sqrt(1 - cosine * cosine);
    const float cut = std::sqrt(squared - cosine * cosine);
    const float y = std::clamp(-cosine / sine * cotangent, -1.0f, 1.0f);
    const float sum =
        squared * cosine * std::acos(y) - cut * (1 - 2 * share) + std::atan2(cut, 1 - 2 * share);
    return std::clamp(sum * std::numbers::inv_pi_v<float>, 0.0f, 1.0f);
}

glm::vec4 decoded(const OccluderTexel& texel) {
    const glm::vec4 n(texel[0], texel[1], texel[2], texel[3]);
    return glm::max(n / 127.0f, glm::vec4(-1));
}

/// Returns the trilinear sample at a position of -1..1 along each side of the box.
glm::vec4 filtered(const OcclusionVolume& volume, const glm::vec3& at) {
    const glm::vec3 along = (0.5f * at + 0.5f) * static_cast<float>(kOccluderSide - 1);
    const glm::ivec3 low = glm::clamp(glm::ivec3(along), glm::ivec3(0), glm::ivec3(kOccluderSide - 2));
    const glm::vec3 over = along - glm::vec3(low), under = 1.0f - over;
    glm::vec4 sum(0);
    for (int i = 0; i < 8; ++i) {
        const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
        const glm::ivec3 at_corner = low + corner;
        const glm::vec3 weight = glm::mix(under, over, glm::vec3(corner));
        const int texel = (at_corner.z * kOccluderSide + at_corner.y) * kOccluderSide + at_corner.x;
        sum += weight.x * weight.y * weight.z * decoded(volume.texels[static_cast<std::size_t>(texel)]);
    }
    return sum;
}

} // namespace

BlockedCap cap_of(float blocked, const glm::vec3& blocked_direction) {
    const float length = glm::length(blocked_direction);
    if (!(blocked > 0))
        return {};
    const float share = std::max(1 - (1 - blocked) * std::min(length, 1.0f), blocked);
    return {length > 0 ? blocked_direction / length : glm::vec3(0, 1, 0), share, blocked / share};
}

float blocked_cosine(const BlockedCap& cap, const glm::vec3& normal) {
    const float cosine = std::clamp(glm::dot(cap.towards, normal), -1.0f, 1.0f);
    return cap.density *
           (cap.share > 0.5f ? 1 - cap_cosine(1 - cap.share, -cosine) : cap_cosine(cap.share, cosine));
}

float blocked_sun(const BlockedCap& cap, const glm::vec3& towards_sun, float half_angle) {
    const float from_middle = std::acos(std::clamp(glm::dot(cap.towards, towards_sun), -1.0f, 1.0f));
    const float radius = std::acos(std::clamp(1 - 2 * cap.share, -1.0f, 1.0f));
    const float border = kOccluderBorder * radius + half_angle;
    const float inside =
        std::clamp((radius + border - from_middle) / std::max(2 * border, 1e-6f), 0.0f, 1.0f);
    return cap.density * inside * inside * (3 - 2 * inside);
}

OccluderTexel occluder_texel(float blocked, const glm::vec3& blocked_direction) {
    const auto stored = [](float value) {
        return static_cast<std::int8_t>(std::lround(std::clamp(127 * value, -127.0f, 127.0f)));
    };
    const float root = std::sqrt(std::clamp(blocked, 0.0f, 1.0f));
    return {stored(blocked_direction.x), stored(blocked_direction.y), stored(blocked_direction.z),
            stored(2 * root - 1)};
}

void check_occlusion_volume(const OcclusionVolume& volume) {
    for (int a = 0; a < 3; ++a)
        if (!(volume.high[a] > volume.low[a]) || !std::isfinite(volume.high[a] - volume.low[a]))
            throw Error("the box of an occlusion volume is empty or not finite");
    if (!(volume.reach > 0) || !std::isfinite(volume.reach))
        throw Error("the reach of an occlusion volume must be finite and greater than 0");
}

glm::vec3 PlacedOccluder::center() const {
    const glm::mat3 columns{glm::vec3(to_box[0]), glm::vec3(to_box[1]), glm::vec3(to_box[2])};
    const glm::vec3 moved(to_box[0].w, to_box[1].w, to_box[2].w);
    return glm::determinant(columns) == 0 ? glm::vec3(0) : -(glm::inverse(glm::transpose(columns)) * moved);
}

PlacedOccluder placed(const OcclusionVolume& volume, const glm::mat4& to_world, std::size_t slot) {
    const glm::vec3 middle = 0.5f * (volume.low + volume.high);
    const glm::mat3 linear(to_world);
    const float scale = std::cbrt(std::abs(glm::determinant(linear)));
    PlacedOccluder where{};
    where.half = glm::vec4(0.5f * scale * (volume.high - volume.low), scale * volume.reach);
    where.slot = glm::vec4(static_cast<float>(slot), 0, 0, 0);
    // An object without volume blocks nothing: the rows and the reach stay 0.
    if (scale > 0) {
        const glm::mat3 inverse = scale * glm::inverse(linear);
        const glm::vec3 center(to_world * glm::vec4(middle, 1));
        for (int a = 0; a < 3; ++a) {
            const glm::vec3 row(inverse[0][a], inverse[1][a], inverse[2][a]);
            where.to_box[static_cast<std::size_t>(a)] = glm::vec4(row, -glm::dot(row, center));
        }
    }
    return where;
}

BlockedCap blocked_at(const OcclusionVolume& volume, const PlacedOccluder& where, const glm::vec3& position) {
    const glm::vec4 point(position, 1);
    const glm::vec3 q(glm::dot(where.to_box[0], point), glm::dot(where.to_box[1], point),
                      glm::dot(where.to_box[2], point));
    const float distance = glm::length(q);
    if (!(distance < where.half.w))
        return {};
    // Outside the box, use the projection onto its faces towards the center; from there on the solid angle
    // decreases with the square of the distance.
    const glm::vec3 sides = q / glm::vec3(where.half);
    const float outside = std::max({std::abs(sides.x), std::abs(sides.y), std::abs(sides.z), 1.0f});
    const glm::vec4 texel = filtered(volume, sides / outside);
    const float root = (0.5f * texel.w + 0.5f) / outside;
    const glm::vec3 blocked_direction(texel);
    const float fade = glm::smoothstep(1.0f, kOccluderFade, distance / where.half.w);
    const glm::vec3 rotated = blocked_direction.x * glm::vec3(where.to_box[0]) +
                              blocked_direction.y * glm::vec3(where.to_box[1]) +
                              blocked_direction.z * glm::vec3(where.to_box[2]);
    return cap_of(fade * root * root, rotated);
}

std::vector<std::uint32_t> occluders_near(std::span<const PlacedOccluder> placed, const glm::vec3& low,
                                          const glm::vec3& high, std::size_t most) {
    std::vector<std::uint32_t> near;
    std::vector<float> nearness(placed.size());
    for (std::size_t i = 0; i < placed.size(); ++i) {
        const glm::vec3 center = placed[i].center();
        const float distance = glm::distance(center, glm::clamp(center, low, high));
        nearness[i] = distance - placed[i].reach();
        if (nearness[i] < 0)
            near.push_back(static_cast<std::uint32_t>(i));
    }
    std::ranges::stable_sort(near, {}, [&](std::uint32_t i) { return nearness[i]; });
    near.resize(std::min(near.size(), most));
    return near;
}

std::vector<OccluderTexel> occluder_texture(std::span<const OcclusionVolume> volumes) {
    std::vector<OccluderTexel> texels;
    texels.reserve(volumes.size() * kOccluderTexels);
    for (const OcclusionVolume& volume : volumes)
        texels.insert(texels.end(), volume.texels.begin(), volume.texels.end());
    return texels;
}

} // namespace prt
