#pragma once

// Automatic exposure of what the camera sees of the model.

#include "core/document.h"
#include "pictures/lamps.h"

#include "prt/light_meter.h"

#include <cmath>
#include <functional>
#include <optional>

namespace viewer {

class ExposureMeter {
public:
    /// What the camera sees.
    struct View {
        const Model* model;
        prt::Camera camera;
        int width, height;
        bool textured;

        friend bool operator==(const View&, const View&) = default;
    };
    /// What it is lit by. The compressed transfer counts first, and without any the light arrives unshadowed.
    struct Lit {
        const LoadedModel& loaded;
        const LampSettings& lamps;
        float darkness;          ///< of the night, 0..1
        RadianceVersion version; ///< tells lights and transfers apart
    };
    /// Factor on radiance: what is seen of the model comes to a mean luminance of 0.22, at night to less;
    /// `light` is called where something has changed. Where nothing lit is seen of the
    /// model, the light is measured.
    float exposure(const View& view, const Lit& lit, const std::function<prt::Light()>& light);
    /// Of the last exposure.
    float stops() const { return std::log2(exposure_); }

private:
    std::optional<View> view_;                       ///< that `meter_` belongs to
    const prt::LightmapLayout* lightmaps_ = nullptr; ///< the same
    std::optional<prt::LightMeter> meter_;
    RadianceVersion version_;
    float exposure_ = 1;
};

} // namespace viewer
