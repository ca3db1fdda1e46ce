#pragma once

// Automatic exposure of what the camera sees of the model.

#include "core/model.h"

#include "prt/light_meter.h"

#include <functional>
#include <optional>

namespace viewer {

class ExposureMeter {
public:
    /// What is measured; `radiance_version` tells lights and transfers apart. Either transfer may be null:
    /// the compressed one counts first, and without any the light arrives unshadowed.
    struct Subject {
        const Model* model;
        prt::Camera camera;
        int width, height;
        bool textured;
        const prt::Transfer* raw;
        const prt::ClusteredTransfer* compressed;
        std::uint64_t radiance_version;
    };
    /// Factor on radiance; `light` is called where something has changed. Where nothing lit is seen of the
    /// model, the light is measured.
    float exposure(const Subject& subject, const std::function<prt::Light()>& light);

private:
    std::string seen_key_; ///< model, camera and size that `meter_` belongs to
    std::optional<prt::LightMeter> meter_;
    std::uint64_t radiance_version_ = 0;
    float exposure_ = 1;
};

} // namespace viewer
