#pragma once

// The nearest place on a surface that looks the same way.

#include "prt/receivers.h"
#include "prt/trace_scene.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>

namespace prt {

/// A point of a triangle.
struct NearestPlace {
    std::uint32_t triangle = 0;        ///< in the order of the scene's primitives; kNoTriangle: there is none
    std::array<double, 3> shares = {}; ///< of its corners
    double distance = 0;               ///< metres
};
inline constexpr std::uint32_t kNoTriangle = ~0u;

/// Point of triangle `corners` that is nearest to `position` (C. Ericson, Real-Time Collision Detection,
/// section 5.1.5): shares of its corners.
std::array<double, 3> nearest_on_triangle(const std::array<glm::dvec3, 3>& corners,
                                          const glm::dvec3& position);

/// What is nearest: places whose normal, interpolated, leans at most 60 degrees from the one that is asked
/// for come first where they are no more than a twentieth of the diagonal behind the nearest of all. Among
/// places as near the one whose normal fits best counts, and then the first triangle (docs/math.md, section
/// 23).
class NearestRule {
public:
    /// `diagonal` of the box of the surface's largest node, metres.
    explicit NearestRule(double diagonal) : reach_(kReach * diagonal), tie_(kTie * diagonal) {}

    void begin(const glm::vec3& position, const glm::vec3& normal);
    void add(std::uint32_t triangle, const std::array<glm::dvec3, 3>& corners,
             const std::array<glm::dvec3, 3>& normals);
    /// How far the places that may still count are.
    double radius() const;
    NearestPlace result() const;

private:
    static constexpr double kReach = 0.05, kTie = 1e-3;
    static constexpr double kLeastCosine = 0.5;

    struct Candidate {
        double score; ///< squared distance, and what the normal adds
        NearestPlace place;

        bool worse_than(double other_score, std::uint32_t triangle) const {
            return other_score < score || (other_score == score && triangle < place.triangle);
        }
    };
    double reach_, tie_;
    glm::dvec3 position_{0}, normal_{0};
    Candidate any_{}, agreeing_{};
};

/// Thread-safe.
class NearestPlaces {
public:
    /// Keeps references. All materials of the scene cast shadows; triangles of corners without a normal or an
    /// area, which have no light, count for nothing.
    NearestPlaces(const TraceScene& scene, const Receivers& receivers);

    NearestPlace find(const glm::vec3& position, const glm::vec3& normal) const;
    double diagonal() const { return diagonal_; }

private:
    std::array<glm::dvec3, 3> at_corners(const std::vector<glm::vec3>& values, std::uint32_t triangle) const;

    const TraceScene& scene_;
    const Receivers& receivers_;
    double diagonal_;
    std::vector<bool> lit_; ///< [triangles]
};

} // namespace prt
