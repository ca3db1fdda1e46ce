#pragma once

// Where light comes from: an environment or a day, and lights that can be moved.

#include "prt/distant_light.h"
#include "prt/environment.h"
#include "prt/light.h"
#include "prt/sun_disc.h"
#include "prt/surface_radiance.h"
#include "prt/transfer_layout.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace viewer {

enum class LightKind { sun, cone, sphere, hemisphere };

struct LightName {
    LightKind kind;
    const char* id; ///< for scripts and for people
};
inline constexpr std::array<LightName, 4> kLights = {{{LightKind::sun, "sun"},
                                                      {LightKind::cone, "cone"},
                                                      {LightKind::sphere, "sphere"},
                                                      {LightKind::hemisphere, "hemisphere"}}};

struct WindowName {
    prt::Window window;
    const char *id, *title, *tip; ///< for scripts; for people
};
inline constexpr std::array<WindowName, 4> kWindows = {
    {{prt::Window::automatic, "auto", "auto: no negative light",
      "The least filter of the bands under which no light is negative."},
     {prt::Window::none, "none", "none",
      "The bands as they are: sharpest, with dark and coloured rings about strong lights."},
     {prt::Window::hann, "hann", "Hann", "Fades the bands out by a raised cosine, whatever the light."},
     {prt::Window::lanczos, "lanczos", "Lanczos", "Fades the bands out by a sinc, whatever the light."}}};

struct RigLight {
    LightKind kind = LightKind::sun;
    bool on = true;
    glm::vec3 direction{0, 1, 0}; ///< unit, towards the light
    float distance = 2;           ///< sphere: to its center, in radii of the scene
    float size = 0.4f;            ///< cone: half angle, radians; sphere: radius, in radii of the scene
    glm::vec3 color{1, 0.9f, 0.75f};
    float strength = 3; ///< suns: irradiance over pi; others: radiance; over the mean of the environment

    friend bool operator==(const RigLight&, const RigLight&) = default;
};

/// A light of that kind as it comes first.
RigLight make_light(LightKind kind);

/// A clear day on the equinox at 45 degrees north, +Z to the south.
struct Day {
    double hour = 10; ///< 0..24
    double turbidity = 3;

    friend bool operator==(const Day&, const Day&) = default;
};

/// What is set; the environment itself is shared.
struct LightSettings {
    bool day = true; ///< instead of the environment
    Day time;
    bool environment_on = true;
    float rotation = 0; ///< of environment or day about +Y, radians
    /// Against ringing, over all lights together; the path-traced reference has no bands and no window.
    prt::Window window = prt::Window::automatic;
    std::vector<RigLight> lights;

    friend bool operator==(const LightSettings&, const LightSettings&) = default;
};

/// An environment map, ready to light.
struct LoadedEnvironment {
    std::string name;
    prt::Image lat_long;
    prt::Light light;        ///< of the highest order
    prt::Light sky;          ///< the same without its suns
    prt::Image sky_lat_long; ///< and its image; empty where it has none
    std::vector<prt::SunDisc> suns;
    float mean = 1; ///< luminance
};
LoadedEnvironment load_environment(const std::string& path);

/// Light taken apart: what lights transfer, and the suns that are shadowed at each pixel.
struct LightApart {
    prt::Lighting lighting;
    std::vector<prt::SunDisc> suns;
};

class LightRig {
public:
    LightRig();
    const LightSettings& settings() const { return settings_; }
    /// Counts up `version` where something changes.
    void set(const LightSettings& settings);
    void set_environment(std::shared_ptr<const LoadedEnvironment> environment);
    bool has_environment() const { return environment_ != nullptr; }
    std::string environment_name() const { return environment_ ? environment_->name : std::string(); }
    std::uint64_t version() const { return version_; }

    /// All lights together, under the window.
    prt::Light light(int order) const;
    /// The same, its strongest suns apart: the environment's own, the day's and those that were added. The
    /// window is for the rest.
    LightApart light_apart(int order) const;
    /// The same light as rays meet it. Suns are suns; all else is in its environment.
    prt::DistantLight distant_light() const;
    /// As an error budget measures it: under no window, all in the sky or with the suns of `light_apart`
    /// apart.
    prt::MeasuredLight measured_light() const;
    prt::MeasuredLight measured_light_apart() const;

    /// How much it is night, 0..1; an environment map is as it is.
    float darkness() const;

    /// Behind the scene: the environment or the day's sky, not turned; null where neither is on.
    const prt::Image* background() const;
    std::uint64_t background_version() const { return background_version_; }

private:
    const LoadedEnvironment* base() const;
    std::vector<prt::SunDisc> own_suns() const;
    std::vector<prt::SunDisc> turned_suns() const;
    std::vector<prt::SunDisc> strongest_first() const;
    prt::DistantLight distant_light(const prt::Image* lat_long, const std::vector<prt::SunDisc>& suns) const;
    void add_shapes(prt::Light& sum) const;
    float unit() const;

    LightSettings settings_;
    std::shared_ptr<const LoadedEnvironment> environment_;
    LoadedEnvironment day_;
    glm::vec3 day_sun_{0, 1, 0}, day_sun_irradiance_{0};
    std::uint64_t version_ = 1, background_version_ = 1;
};

} // namespace viewer
