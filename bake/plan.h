#pragma once

// What a bake will do, known before the first ray.

#include "lamps/choose_lamps.h"
#include "prt/bake.h"
#include "prt/trace_scene.h"
#include "transport/diffusion.h"
#include "transport/transport_receivers.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace prt {

/// What is inside of each material, in the scene's unit: [materials].
using Media = std::vector<std::optional<Medium>>;

/// The media of the scene's materials, and those that `options` choose instead.
Media choose_media(const Scene& scene, const BakeOptions& options);

/// `scene` with the textures that a bake needs.
TraceScene trace_scene(const Scene& scene, const Media& media, const BakeOptions& options);

/// Only what the scene needs: bounces, back sides and color.
struct BakePlan {
    const TraceScene& scene;
    const BakeOptions& options;
    bool measures_errors = false;                        ///< of this bake, and so that of sampling
    int bounces = 0;                                     ///< or kEndlessBounces
    int channels = 1;                                    ///< of all light together
    std::unique_ptr<const TransportReceivers> transport; ///< stays where it is: operators keep references
    std::vector<DiffusionOperator> diffusion;            ///< one for each medium of each node
    std::vector<Lamp> lamps;
    std::vector<std::string> notices;

    /// Those of the scene, then back sides.
    const Receivers& receivers() const { return transport->receivers; }
    /// Direct light is colored by sheets alone that it comes through.
    int direct_channels() const;
    /// Of the light of lamps.
    int lamp_channels() const;
    /// Of a transfer vector, at most.
    std::size_t numbers() const;
    /// Of the scene's receivers.
    std::span<const float> areas() const { return std::span(receivers().areas).first(transport->fronts); }
};

/// What materials have that a bake leaves out, a line each.
std::vector<std::string> scene_notices(const TraceScene& scene, const BakeOptions& options);

/// Keeps references to `scene` and `options`.
BakePlan plan_bake(const TraceScene& scene, const Media& media, const BakeOptions& options);

} // namespace prt
