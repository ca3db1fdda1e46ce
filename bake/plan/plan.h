#pragma once

// Properties of a bake that are known before the first ray.

#include "bake/scene/trace_scene.h"
#include "bake/scene/transport_receivers.h"
#include "bake/trace/choose_lamps.h"
#include "bake/trace/gather.h"
#include "bake/transport/diffusion.h"
#include "prt/bake/bake_options.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// Medium inside each material, in the scene's unit: [materials].
using Media = std::vector<std::optional<Medium>>;

/// Returns the media of the scene's materials; `options` may replace them. `other`: a model that may contain
/// materials of `options` that the scene does not contain; may be null.
Media choose_media(const Scene& scene, const BakeOptions& options, const Scene* other = nullptr);

/// Returns the names of the materials with a medium in `media` that the file does not describe, for
/// BakeRecord::media.
std::vector<std::string> added_media(const Scene& scene, const Media& media);

/// Loads the textures that a bake of `scene` needs. `same_images`: a scene with the same images, whose
/// textures are shared; null: none.
TraceScene trace_scene(const Scene& scene, const Media& media, const BakeOptions& options,
                       const TraceScene* same_images = nullptr);

/// Returns the index in BakePlan::diffusion of the body that each primitive is part of, without a value for
/// primitives without a medium: [primitives].
std::vector<std::optional<std::size_t>> bodies_of(const Scene& scene, const Media& media);

struct DetailedPlan;

/// Plan of a bake: bounces, back sides and color only as far as the scene needs them.
struct BakePlan {
    const TraceScene& scene;
    const BakeOptions& options;
    bool measures_errors = false;                        ///< measure the errors of this bake, and estimate
                                                         ///< its sampling error from the same points
    int bounces = 0;                                     ///< number of bounces, or kEndlessBounces
    int channels = 1;                                    ///< channels of all light together
    std::unique_ptr<const TransportReceivers> transport; ///< must not move, because operators keep references
    std::vector<DiffusionOperator> diffusion;            ///< one for each medium of each node
    std::vector<Lamp> lamps;
    std::vector<std::string> notices;
    const BakePlan* detail = nullptr; ///< plan of the model that rays hit instead of `scene`; null: none

    /// Plan of the surfaces that rays hit. Triangles of `lamps` are theirs.
    const BakePlan& traced() const { return detail ? *detail : *this; }
    /// Creates rows that gather light from the surfaces that rays hit.
    GatherOperator gather_rows(std::size_t rows) const;
    /// Receivers of the scene, then back sides.
    const Receivers& receivers() const { return transport->receivers; }
    /// Channels of direct light, which is colored only by thin sheets that it passes.
    int direct_channels() const;
    /// Channels of the light of lamps.
    int lamp_channels() const;
    /// Maximum length of a transfer vector.
    std::size_t numbers() const;
    /// Areas of the scene's receivers.
    std::span<const float> areas() const { return std::span(receivers().areas).first(transport->fronts); }
};

/// Returns properties of materials that a bake ignores, one line each.
std::vector<std::string> scene_notices(const TraceScene& scene, const BakeOptions& options);

/// Plans a bake. Keeps references to `scene`, `options` and `detail`, whose number of channels becomes that
/// of the result. `detail`: model that rays hit instead of `scene`; may be null.
BakePlan plan_bake(const TraceScene& scene, const Media& media, const BakeOptions& options,
                   DetailedPlan* detail = nullptr);

/// A detailed model that rays hit, on which the receivers of a scene are measured. It cannot be moved,
/// because its members keep references to each other.
struct DetailedPlan {
    /// Keeps references to the model and to `options`. FinerModel::reach 0: receivers keep their position.
    DetailedPlan(const Scene& scene, const FinerModel& finer, const BakeOptions& options);
    DetailedPlan(const DetailedPlan&) = delete;

    Media media;
    TraceScene traced;
    BakePlan plan;                          ///< bounces between the vertices of the model
    std::optional<DetailedSurface> surface; ///< no value: receivers keep their position
};

} // namespace prt
