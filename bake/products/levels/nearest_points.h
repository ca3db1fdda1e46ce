#pragma once

// Finds the nearest point of a surface with a similar normal.

#include "bake/scene/receivers.h"
#include "bake/scene/trace_scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace prt {

/// A point of a triangle.
struct NearestPoint {
    std::uint32_t triangle = 0;        ///< index in the order of the scene's primitives; kNoTriangle: there
                                       ///< is no point
    std::array<double, 3> shares = {}; ///< barycentric coordinates
    double distance = 0;               ///< metres
};
inline constexpr std::uint32_t kNoTriangle = ~0u;

/// Returns the barycentric coordinates of the point of triangle `corners` that is nearest to `position` (C.
/// Ericson, Real-Time Collision Detection, section 5.1.5).
std::array<double, 3> nearest_on_triangle(const std::array<glm::dvec3, 3>& corners,
                                          const glm::dvec3& position);

/// Selects the nearest point. Points whose interpolated normal deviates at most 60 degrees from the requested
/// normal have priority if they are at most a twentieth of the diagonal farther than the nearest point of
/// all. Among points with equal distances the one with the best normal is selected, and then the first
/// triangle (docs/math.md, section 23).
class NearestRule {
public:
    /// `diagonal`: diagonal of the bounding box of the surface's largest node, metres.
    explicit NearestRule(double diagonal) : reach_(kReach * diagonal), tie_(kTie * diagonal) {}

    void begin(const glm::vec3& position, const glm::vec3& normal);
    void add(std::uint32_t triangle, const std::array<glm::dvec3, 3>& corners,
             const std::array<glm::dvec3, 3>& normals);
    /// Maximum distance of points that can still be selected.
    double radius() const;
    NearestPoint result() const;

private:
    static constexpr double kReach = 0.05, kTie = 1e-3;
    static constexpr double kMinCosine = 0.5;

    struct Candidate {
        double score; ///< squared distance, plus a term for the normal
        NearestPoint position;

        bool worse_than(double other_score, std::uint32_t triangle) const {
            return other_score < score || (other_score == score && triangle < position.triangle);
        }
    };
    double reach_, tie_;
    glm::dvec3 position_{0}, normal_{0};
    Candidate any_{}, agreeing_{};
};

/// Finds nearest points on the surfaces of a scene. Thread-safe.
class NearestPoints {
public:
    /// Keeps references. All materials of the scene must cast shadows. Triangles are ignored if a corner has
    /// no normal or no area, and therefore no light.
    NearestPoints(const TraceScene& scene, const Receivers& receivers);

    NearestPoint find(const glm::vec3& position, const glm::vec3& normal) const;
    double diagonal() const { return diagonal_; }

private:
    std::array<glm::dvec3, 3> at_corners(const std::vector<glm::vec3>& values, std::uint32_t triangle) const;

    const TraceScene& scene_;
    const Receivers& receivers_;
    double diagonal_;
    std::vector<bool> lit_; ///< [triangles]
};

} // namespace prt
