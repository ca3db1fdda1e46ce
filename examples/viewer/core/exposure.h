#pragma once

// Automatic exposure from the visible part of the model.

#include "core/document.h"
#include "pictures/lamps.h"

#include "bake/reference/light_meter.h"

#include <cmath>
#include <functional>
#include <optional>

namespace viewer {

class ExposureMeter {
public:
    /// The visible part of the model.
    struct View {
        const Model* model;
        prt::Camera camera;
        int width, height;
        bool textured;

        friend bool operator==(const View&, const View&) = default;
    };
    /// The light on the model. The exposure uses the compressed transfer if there is one, then the raw
    /// transfer; without transfer the light is unshadowed.
    struct Lit {
        const LoadedModel& loaded;
        const LampSettings& lamps;
        float darkness;          ///< fraction of night, 0..1
        RadianceVersion version; ///< identifies the state of light and transfer
    };
    /// Returns the factor on radiance that maps the mean luminance of the visible surfaces to 0.22, lower at
    /// night. Calls `light` only if the view or the light changed. Measures the light itself if no lit
    /// surface is visible.
    float exposure(const View& view, const Lit& lit, const std::function<prt::Light()>& light);
    /// Returns the last exposure in stops.
    float stops() const { return std::log2(exposure_); }

private:
    std::optional<View> view_;                       ///< view of `meter_`
    const prt::LightmapLayout* lightmaps_ = nullptr; ///< lightmap of `meter_`
    std::optional<prt::LightMeter> meter_;
    RadianceVersion version_;
    float exposure_ = 1;
};

} // namespace viewer
