// Removes suns from an image one by one, strongest first, and after each refits the previous ones without it
// (Hogbom 1974, "CLEAN"; docs/math.md, "Suns in an image").
#include "prt/fit/suns.h"

#include "prt/core/error.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "runtime/fit/disc_fit.h"
#include "runtime/fit/shadowed_light.h"
#include "runtime/fit/spot.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>

namespace prt {
namespace {

/// Minimum error reduction by another sun, as a fraction of the light, that justifies its shadow map.
constexpr double kWorthwhile = 0.01;

/// A sun and the light that was removed from the image for it.
struct TakenSun {
    Spot spot; ///< initial state
    Disc disc;
    double reach = 0;   ///< radians about the center within which light was removed
    glm::dvec3 flux{0}; ///< radiance times solid angle
    struct Part {
        std::size_t texel;
        glm::vec3 color;
    };
    std::vector<Part> parts;
};

/// Lowers the texels about `spot` to the surrounding sky.
TakenSun take(SkyMap& map, const Spot& spot, double widest) {
    TakenSun sun{spot, fitted_disc(map, spot), 0, glm::dvec3(0), {}};
    Spot whole = spot;
    whole.towards = sun.disc.towards;
    whole.radius = sun.disc.half_angle;
    const Aperture aperture = aperture_of(map, whole, widest);
    sun.reach = aperture.radius;
    for (const NearTexel& near : map.near(whole.towards, aperture.radius)) {
        glm::vec3& pixel = map.pixel(near.texel);
        const glm::vec3 rest = glm::min(pixel, glm::vec3(aperture.sky)), own = pixel - rest;
        if (own == glm::vec3(0))
            continue;
        sun.flux += near.solid_angle * glm::dvec3(own);
        sun.parts.push_back({near.texel, own});
        pixel = rest;
    }
    return sun;
}

void put_back(SkyMap& map, const TakenSun& sun) {
    for (const TakenSun::Part& part : sun.parts)
        map.pixel(part.texel) += part.color;
}

Sun as_disc(const TakenSun& sun) {
    // Irradiance of a cone of uniform radiance whose integral is the flux.
    const glm::dvec3 irradiance = 0.5 * (1 + std::cos(sun.disc.half_angle)) * sun.flux;
    return {glm::vec3(sun.disc.towards), glm::vec3(irradiance), sun.disc.half_angle};
}

/// Incremental search for suns.
class Search {
public:
    Search(const Environment& environment, const SunOptions& options)
        : options_(options), widest_(widest_sun(options.order)), map_(environment, options.threads),
          shadowed_(map_, options.order) {
        for (const SkyCell& cell : map_.cells())
            all_ += cell.flux;
        without_ = error();
    }

    /// Finds one more sun. Returns whether there was one.
    bool add() {
        std::vector<Taken> taken; // light that remains within these is a halo
        for (const TakenSun& sun : suns_)
            taken.push_back({sun.disc.towards, sun.reach});
        const std::optional<Spot> spot = strongest_spot(map_, widest_, taken);
        if (!spot)
            return false;
        suns_.push_back(take(map_, *spot, widest_));
        for (TakenSun& sun : suns_) {
            put_back(map_, sun);
            sun = take(map_, sun.spot, widest_);
        }
        return true;
    }

    /// Finds the number of suns with the minimum sum of error and cost.
    void add_paying() {
        double least = without_;
        std::vector<TakenSun> best;
        for (int count = 1; count <= kMaxAutoSuns && add(); ++count)
            if (const double cost = error() + kWorthwhile * count; cost < least) {
                least = cost;
                best = suns_;
            }
        for (const TakenSun& sun : suns_)
            put_back(map_, sun);
        suns_ = std::move(best);
        for (const TakenSun& sun : suns_)
            for (const TakenSun::Part& part : sun.parts)
                map_.pixel(part.texel) -= part.color;
    }

    SunSplit split() const {
        std::vector<std::pair<double, Sun>> found;
        for (const TakenSun& sun : suns_)
            found.emplace_back(luminance(all_) > 0 ? luminance(sun.flux) / luminance(all_) : 0, as_disc(sun));
        std::ranges::stable_sort(found, std::greater(), &std::pair<double, Sun>::first);
        SunSplit result;
        for (const auto& [share, sun] : found) {
            result.suns.push_back(sun);
            result.energy_shares.push_back(share);
            result.remainder_share -= share;
        }
        result.remainder = map_.environment();
        result.error_without = without_;
        result.error_with = suns_.empty() ? without_ : error();
        return result;
    }

private:
    std::vector<Sun> discs() const {
        std::vector<Sun> list;
        for (const TakenSun& sun : suns_)
            list.push_back(as_disc(sun));
        return list;
    }

    double error() const {
        return shadowed_.error(project(map_.environment(), options_.order, options_.threads), discs());
    }

    const SunOptions& options_;
    double widest_;
    SkyMap map_;
    ShadowedLight shadowed_;
    glm::dvec3 all_{0};
    double without_ = 0;
    std::vector<TakenSun> suns_;
};

} // namespace

double widest_sun(int order) {
    check_order(order);
    return std::min(0.26, 0.25 * std::numbers::pi / order);
}

SunSplit find_suns(const Environment& environment, const SunOptions& options) {
    check_order(options.order);
    check_environment(environment);
    if (options.count && *options.count < 0)
        throw Error("the number of suns must not be negative, but is " + std::to_string(*options.count));
    Search search(environment, options);
    if (options.count)
        for (int k = 0; k < *options.count && search.add(); ++k) {
        }
    else
        search.add_paying();
    return search.split();
}

} // namespace prt
