// The C interface: analytic lights, environment images, rotation and deringing.

#include "prt/core/environment.h"
#include "prt/core/light.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "prt/image/image_file.h"
#include "prt/load/light_file.h"
#include "runtime/c/boundary.h"
#include "runtime/core/support/counted.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace {

using namespace prt::c;
using prt::Error;
using prt::Light;

/// Returns the number of pixels. Throws `Error` if an array cannot hold the image.
std::size_t pixel_count(int width, int height) {
    constexpr std::size_t kMax = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(glm::vec3);
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    if (rows > kMax / columns)
        throw Error("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels does not fit into memory");
    return columns * rows;
}

glm::vec3 vec3(const float* v) {
    return glm::make_vec3(v);
}

void check_colors(const float* light, std::size_t count) {
    if (!finite(light, 3 * count))
        throw Error("the coefficients of a light must be finite");
}

glm::vec3 color(const float* rgb) {
    if (!finite(rgb, 3))
        throw Error("the color of a light must be finite");
    return vec3(rgb);
}

void put(const Light& light, float* to) {
    std::copy(light.coefficients.begin(), light.coefficients.end(), colors(to));
}

Light light_from(int order, const float* from) {
    const std::size_t count = count_of(order);
    check_colors(from, count);
    const auto* first = reinterpret_cast<const glm::vec3*>(from);
    return {order, {first, first + count}};
}

prt::LatLongCenter center_of(int center) {
    if (center != PRT_CENTER_Z && center != PRT_CENTER_X)
        throw Error("the center of a lat-long image must be +Z or +X");
    return center == PRT_CENTER_X ? prt::LatLongCenter::x : prt::LatLongCenter::z;
}

} // namespace

extern "C" {

prt_status prt_light_constant(int order, const float radiance[3], float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(radiance, light);
        put(prt::constant_light(order, color(radiance)), light);
    });
}

prt_status prt_light_directional(int order, const float towards[3], const float irradiance[3], float* light,
                                 prt_message* message) {
    return guarded(message, [&] {
        check_pointers(towards, irradiance, light);
        put(prt::directional_light(order, vec3(towards), color(irradiance)), light);
    });
}

prt_status prt_light_cone(int order, const float axis[3], float half_angle, const float radiance[3],
                          float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(axis, radiance, light);
        put(prt::cone_light(order, vec3(axis), static_cast<double>(half_angle), color(radiance)), light);
    });
}

prt_status prt_light_sphere(int order, const float center[3], float radius, const float radiance[3],
                            float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(center, radiance, light);
        put(prt::sphere_light(order, vec3(center), static_cast<double>(radius), color(radiance)), light);
    });
}

prt_status prt_light_disc(int order, const float center[3], const float normal[3], float radius,
                          const float radiance[3], float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(center, normal, radiance, light);
        put(prt::disc_light(order, vec3(center), vec3(normal), static_cast<double>(radius), color(radiance)),
            light);
    });
}

prt_status prt_light_hemisphere(int order, const float up[3], const float top[3], const float bottom[3],
                                float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(up, top, bottom, light);
        put(prt::hemisphere_light(order, vec3(up), color(top), color(bottom)), light);
    });
}

prt_status prt_light_from_lat_long(int order, const prt_image* image, int center, int threads, float* light,
                                   prt_message* message) {
    return guarded(message, [&] {
        check_pointers(image, light);
        const auto [width, height, pixels] = *image;
        check_pointers(pixels);
        if (width < 1 || height < 1)
            throw Error("the environment has no pixels");
        const auto* first = reinterpret_cast<const glm::vec3*>(pixels);
        prt::Environment environment;
        environment.center = center_of(center);
        environment.image = {width, height, {first, first + pixel_count(width, height)}};
        prt::repair_pixels(environment.image, prt::BadPixels::error);
        put(prt::project(environment, order, threads), light);
    });
}

prt_status prt_light_from_file(int order, const char* path, int center, float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(path, light);
        prt::check_order(order);
        prt::EnvironmentOptions options;
        options.center = center_of(center);
        as_file([&] { put(prt::project(prt::load_environment(path, options).environment, order), light); });
    });
}

prt_status prt_light_from_light_file(int order, const char* path, float* sky, prt_sun* suns, size_t* count,
                                     prt_message* message) {
    return guarded(message, [&] {
        check_pointers(path, sky, count);
        prt::check_order(order);
        const std::size_t room = suns ? *count : 0;
        prt::LightFile file;
        as_file([&] { file = prt::read_light_file(path, order); });
        *count = file.suns.size();
        if (room < file.suns.size())
            throw TooSmall("there is not enough room for " + prt::counted(file.suns.size(), "sun") +
                           " of the light file");
        put(file.sky, sky);
        for (std::size_t i = 0; i < file.suns.size(); ++i) {
            const prt::Sun& sun = file.suns[i];
            std::copy_n(glm::value_ptr(sun.towards), 3, suns[i].towards);
            std::copy_n(glm::value_ptr(sun.irradiance), 3, suns[i].irradiance);
            suns[i].half_angle = static_cast<float>(sun.half_angle);
        }
    });
}

prt_status prt_light_suns(int order, const prt_sun* suns, size_t count, float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(light);
        Light all = prt::constant_light(order, glm::vec3(0));
        for (std::size_t i = 0; i < count; ++i) {
            check_pointers(suns);
            const glm::dvec3 towards(vec3(suns[i].towards));
            const double length = glm::length(towards);
            if (!(length > 0 && std::isfinite(length)))
                throw Error("the direction of a sun must be finite and not 0");
            all = prt::sum(all, prt::as_light({.towards = glm::vec3(towards / length),
                                               .irradiance = color(suns[i].irradiance),
                                               .half_angle = static_cast<double>(suns[i].half_angle)},
                                              order));
        }
        put(all, light);
    });
}

prt_status prt_light_rotate(int order, const float rotation[9], float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(rotation, light);
        Light rotated = light_from(order, light);
        prt::ShRotation(order, glm::dmat3(glm::make_mat3(rotation))).apply(rotated.coefficients);
        check_colors(&rotated.coefficients[0].x, rotated.coefficients.size());
        put(rotated, light);
    });
}

prt_status prt_light_dering(int order, float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(light);
        put(prt::windowed(light_from(order, light), prt::Window::automatic), light);
    });
}

} // extern "C"
