#pragma once

// The light on the scene: an environment or a day, and movable lights.

#include "bake/reference/distant_light.h"
#include "bake/reference/surface_radiance.h"
#include "prt/core/environment.h"
#include "prt/core/light.h"
#include "prt/core/transfer_layout.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace viewer {

enum class LightKind { sun, cone, sphere, hemisphere };

struct LightName {
    LightKind kind;
    const char* id; ///< name in scripts and in the panel
};
inline constexpr std::array<LightName, 4> kLights = {{{LightKind::sun, "sun"},
                                                      {LightKind::cone, "cone"},
                                                      {LightKind::sphere, "sphere"},
                                                      {LightKind::hemisphere, "hemisphere"}}};

struct WindowName {
    prt::Window window;
    const char *id, *title, *tip; ///< id for scripts; title and tip for the panel
};
inline constexpr std::array<WindowName, 4> kWindows = {
    {{prt::Window::automatic, "auto", "automatic (no negative light)",
      "Weakest filter of the bands that makes no light negative."},
     {prt::Window::none, "none", "none",
      "Unfiltered bands: sharpest, with dark and coloured rings around strong lights."},
     {prt::Window::hann, "hann", "Hann", "Fades the bands with a raised cosine, independent of the light."},
     {prt::Window::lanczos, "lanczos", "Lanczos", "Fades the bands with a sinc, independent of the light."}}};

struct RigLight {
    LightKind kind = LightKind::sun;
    bool on = true;
    glm::vec3 direction{0, 1, 0}; ///< unit, towards the light
    float distance = 2;           ///< sphere: distance to its center, in radii of the scene
    float size = 0.4f;            ///< cone: half angle, radians; sphere: radius, in radii of the scene
    glm::vec3 color{1, 0.9f, 0.75f};
    float strength = 3; ///< relative to the mean of the environment; suns: irradiance over pi; others:
                        ///< radiance

    friend bool operator==(const RigLight&, const RigLight&) = default;
};

/// Returns a light of this kind with its default values.
RigLight make_light(LightKind kind);

/// Time of a clear day on the equinox at 45 degrees north; +Z points south.
struct Day {
    double hour = 10; ///< 0..24
    double turbidity = 3;

    friend bool operator==(const Day&, const Day&) = default;
};

/// User settings of the light; the environment itself is shared.
struct LightSettings {
    bool day = true; ///< use the day, not the environment
    Day time;
    bool environment_on = true;
    float rotation = 0; ///< rotation of the environment or the day about +Y, radians
    /// Filter against ringing of the sum of all lights. The path-traced reference has no bands and needs no
    /// window.
    prt::Window window = prt::Window::automatic;
    std::vector<RigLight> lights;

    friend bool operator==(const LightSettings&, const LightSettings&) = default;
};

/// An environment map prepared as a light.
struct LoadedEnvironment {
    std::string name;
    prt::Image lat_long;
    prt::Light light;        ///< light of the maximum order
    prt::Light sky;          ///< `light` without its suns
    prt::Image sky_lat_long; ///< image without the suns; empty if the environment has none
    std::vector<prt::Sun> suns;
    float mean = 1; ///< mean luminance
};
LoadedEnvironment load_environment(const std::string& path);

/// Light split into the lighting of the transfer and suns that are shadowed per pixel.
struct SeparateLight {
    prt::Lighting lighting;
    std::vector<prt::Sun> suns;
};

class LightRig {
public:
    LightRig();
    const LightSettings& settings() const { return settings_; }
    /// Changes the settings; increases `version` if they differ.
    void set(const LightSettings& settings);
    void set_environment(std::shared_ptr<const LoadedEnvironment> environment);
    bool has_environment() const { return environment_ != nullptr; }
    std::string environment_name() const { return environment_ ? environment_->name : std::string(); }
    std::uint64_t version() const { return version_; }

    /// Returns the windowed sum of all lights.
    prt::Light light(int order) const;
    /// Returns the light with its strongest suns separate: those of the environment, of the day and the added
    /// ones. The window filters the rest only.
    SeparateLight separate_light(int order) const;
    /// Returns the light for path tracing. Suns stay suns; everything else is part of its environment.
    prt::DistantLight distant_light() const;
    /// Returns the light for an error budget, without a window. The suns are part of the sky, or separate as
    /// in `separate_light`.
    prt::ReferenceLight reference_light() const;
    prt::ReferenceLight separate_reference_light() const;

    /// Returns the fraction of night, 0..1; 0 for an environment map.
    float darkness() const;

    /// Returns the unrotated image behind the scene, the environment or the sky of the day; null if neither
    /// is on.
    const prt::Image* background() const;
    std::uint64_t background_version() const { return background_version_; }

private:
    const LoadedEnvironment* base() const;
    std::vector<prt::Sun> own_suns() const;
    std::vector<prt::Sun> rotated_suns() const;
    std::vector<prt::Sun> strongest_first() const;
    prt::DistantLight distant_light(const prt::Image* lat_long, const std::vector<prt::Sun>& suns) const;
    void add_shapes(prt::Light& sum) const;
    float unit() const;

    LightSettings settings_;
    std::shared_ptr<const LoadedEnvironment> environment_;
    LoadedEnvironment day_;
    glm::vec3 day_sun_{0, 1, 0}, day_sun_irradiance_{0};
    std::uint64_t version_ = 1, background_version_ = 1;
};

} // namespace viewer
