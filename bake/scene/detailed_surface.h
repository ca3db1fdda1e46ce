#pragma once

// Surface of a detailed model, on which receivers of a simpler scene are measured.

#include "bake/scene/receivers.h"
#include "bake/scene/trace_scene.h"

#include <atomic>
#include <cstddef>
#include <optional>
#include <string>

namespace prt {

/// Finds the points of a detailed model at which receivers of a scene are measured. Thread-safe.
class DetailedSurface {
public:
    /// Keeps a reference to `model`. `reach`: maximum distance in metres at which the surface is searched, on
    /// both sides of a receiver. `origin`: Scene::origin of the receivers.
    DetailedSurface(const TraceScene& model, double reach, const glm::dvec3& origin);

    /// Moves the receivers from index `first` on to the outermost surface within reach along their normals
    /// that faces the same way, and replaces their normals and `starts`. Thin sheets that transmit light face
    /// both ways, as do double-sided surfaces where no front is in reach. Other receivers keep their
    /// position. All positions become relative to the origin of the model. `starts` must be filled.
    void move(Receivers& receivers, std::size_t first = 0) const;
    /// Returns a notice if many of the receivers so far found no surface, otherwise no value. Throws `Error`
    /// if no receiver found one, because the model then has other surfaces.
    std::optional<std::string> check() const;

private:
    const TraceScene& model_;
    Receivers vertices_;
    double reach_;
    glm::vec3 from_scene_;                                        ///< to the origin of the model
    mutable std::atomic<std::size_t> searched_ = 0, missing_ = 0; ///< receivers
};

} // namespace prt
