#pragma once

// The light of the viewer: the rig, the available environments, and the SH light computed from them.

#include "core/exposure.h"
#include "core/light_rig.h"
#include "pictures/lamps.h"

namespace viewer {

class ViewerLight {
public:
    LightRig rig;
    std::vector<std::shared_ptr<const LoadedEnvironment>> environments; ///< in the order of loading
    ExposureMeter meter;

    /// Changes the lamps; increases `lamps_version` if they differ.
    void set_lamps(const LampSettings& lamps);
    const LampSettings& lamps() const { return lamps_; }
    std::uint64_t lamps_version() const { return lamps_version_; }

    /// Returns the rig's light; computes it once per version.
    const prt::Light& light(int order);
    /// Returns the rig's light with its suns separate, or with all light in its sky.
    const SeparateLight& light_for_pictures(int order, bool separate_suns);

private:
    LampSettings lamps_;
    std::uint64_t lamps_version_ = 1;
    prt::Light light_;
    std::uint64_t version_ = 0; ///< version of the rig
    SeparateLight separate_;
    struct {
        std::uint64_t rig = 0;
        bool separate_suns = false;
    } separate_version_;
};

inline void ViewerLight::set_lamps(const LampSettings& lamps) {
    if (lamps == lamps_)
        return;
    lamps_ = lamps;
    ++lamps_version_;
}

inline const prt::Light& ViewerLight::light(int order) {
    if (version_ != rig.version() || light_.order != order)
        light_ = rig.light(order);
    version_ = rig.version();
    return light_;
}

inline const SeparateLight& ViewerLight::light_for_pictures(int order, bool separate_suns) {
    if (separate_version_.rig != rig.version() || separate_version_.separate_suns != separate_suns ||
        separate_.lighting.sky.order != order)
        separate_ = separate_suns ? rig.separate_light(order) : SeparateLight{{light(order)}, {}};
    separate_version_ = {rig.version(), separate_suns};
    return separate_;
}

} // namespace viewer
