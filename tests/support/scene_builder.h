#pragma once

#include "prt/load/scene.h"

#include <functional>

namespace prt::test {

/// Builds scenes of one vertex array and one primitive without a file.
class SceneBuilder {
public:
    SceneBuilder& triangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);
    /// Two triangles; the front is where (b - a) x (d - a) points.
    SceneBuilder& quad(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, const glm::vec3& d);
    /// A disc of `segments` triangles, front along unit `axis`.
    SceneBuilder& disc(const glm::vec3& centre, const glm::vec3& axis, float radius, int segments);
    /// A sphere of rows x 2 rows quads, front outside.
    SceneBuilder& sphere(const glm::vec3& centre, float radius, int rows);
    /// The inside of a sphere, open about +Y over the first `open_rows` of its rows x 2 rows quads.
    SceneBuilder& bowl(const glm::vec3& centre, float radius, int rows, int open_rows);
    /// A horizontal square about `centre`, facing up.
    SceneBuilder& floor(const glm::vec3& centre, float half_size, int cells = 1);
    /// Applies `change` to all positions so far.
    SceneBuilder& transform(const std::function<glm::vec3(const glm::vec3&)>& change);

    Scene build() const;

private:
    std::uint32_t vertex(const glm::vec3& position, const glm::vec3& normal);
    VertexArray vertices_;
    std::vector<glm::uvec3> triangles_;
};

/// One scene with the parts side by side, each with its own materials.
Scene join(const std::vector<Scene>& parts);

/// `scene` with this base colour on both sides or one.
Scene painted(Scene scene, const glm::vec3& color, bool double_sided = false);

/// `scene` with single-sided materials, and separate vertices and triangles for the backs.
Scene with_opposites(Scene scene);

/// A point lamp named "lamp" of intensity 1.
PunctualLight lamp_at(const glm::vec3& position);

} // namespace prt::test
