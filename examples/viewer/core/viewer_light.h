#pragma once

// The light of the viewer: the rig, the environments that it can take, and what is formed of them.

#include "core/exposure.h"
#include "core/light_rig.h"

namespace viewer {

class ViewerLight {
public:
    LightRig rig;
    std::vector<std::shared_ptr<const LoadedEnvironment>> environments; ///< in the order that they came
    ExposureMeter meter;

    /// The rig's light, formed once for all that want it.
    const prt::Light& light(int order);

private:
    prt::Light light_;
    std::uint64_t version_ = 0; ///< of the rig
};

inline const prt::Light& ViewerLight::light(int order) {
    if (version_ != rig.version() || light_.order != order)
        light_ = rig.light(order);
    version_ = rig.version();
    return light_;
}

} // namespace viewer
