// Light: projection, suns, rotation, basis.

#include "python/src/light.h"

#include "cli/pipeline/loaded_light.h"
#include "prt/core/error.h"
#include "prt/core/sh.h"
#include "prt/core/sh_rotation.h"
#include "prt/fit/suns.h"
#include "python/src/arrays.h"
#include "python/src/options.h"

#include <utility>

namespace prt::python {
namespace {

pipeline::LightOptions light_options_of(py::dict& options) {
    pipeline::LightOptions light;
    std::string layout = "auto";
    take(options, "layout", layout);
    if (layout == "lat-long-x") {
        light.environment.layout = EnvironmentLayout::lat_long;
        light.environment.center = LatLongCenter::x;
    } else if (layout != "auto") {
        py::dict of_layout;
        of_layout["layout"] = layout;
        EnvironmentLayout chosen{};
        choose(of_layout, "layout", chosen,
               {{"lat-long", EnvironmentLayout::lat_long},
                {"cube", EnvironmentLayout::cube},
                {"cube-faces", EnvironmentLayout::cube_faces},
                {"angular", EnvironmentLayout::angular}});
        light.environment.layout = chosen;
    }
    choose(options, "bad_pixels", light.environment.bad_pixels,
           {{"error", BadPixels::error}, {"zero", BadPixels::zero}, {"clamp", BadPixels::clamp}});
    take(options, "layer", light.environment.layer);
    choose(options, "window", light.window,
           {{"none", Window::none},
            {"hann", Window::hann},
            {"lanczos", Window::lanczos},
            {"auto", Window::automatic}});
    take(options, "rotate", light.rotation_degrees);
    return light;
}

py::list suns_of(const std::vector<Sun>& suns) {
    py::list list;
    for (const Sun& sun : suns)
        list.append(py::make_tuple(std::array{sun.towards.x, sun.towards.y, sun.towards.z},
                                   std::array{sun.irradiance.r, sun.irradiance.g, sun.irradiance.b},
                                   sun.half_angle));
    return list;
}

/// Returns the coefficients of the sky, those of sky and suns, the suns, and notices.
py::tuple parts_of(const pipeline::LoadedLight& light, const std::vector<std::string>& notices) {
    return py::make_tuple(copied(light.sky.coefficients), copied(light.combined.coefficients),
                          suns_of(light.split.suns), notices);
}

/// Returns the `parts_of` the light of a file.
py::tuple load_light(const pipeline::Path& path, int order, std::optional<int> suns, py::dict options,
                     int threads) {
    pipeline::LightOptions how = light_options_of(options);
    check_empty(options);
    std::vector<std::string> notices;
    how.notify = [&](const std::string& file, const std::vector<std::string>& list) {
        for (const std::string& notice : list)
            notices.push_back(file + ": " + notice);
    };
    pipeline::LoadedLight light;
    {
        const py::gil_scoped_release release;
        light = pipeline::load_light(path, order, {suns}, how, threads);
    }
    return parts_of(light, notices);
}

/// Returns the environment of an image [height][width][3].
Environment environment_of(const Floats& image, py::dict options, pipeline::LightOptions& how) {
    if (image.ndim() != 3 || image.shape(2) != 3)
        throw Error("an environment must have the shape (height, width, 3), not " + shape_in_words(image));
    how = light_options_of(options);
    check_empty(options);
    Environment environment;
    environment.image.width = static_cast<int>(image.shape(1));
    environment.image.height = static_cast<int>(image.shape(0));
    const auto* pixels = reinterpret_cast<const glm::vec3*>(image.data());
    environment.image.pixels.assign(pixels, pixels + image.size() / 3);
    environment.layout = how.environment.layout.value_or(
        environment.image.height == 6 * environment.image.width ? EnvironmentLayout::cube
                                                                : EnvironmentLayout::lat_long);
    environment.center = how.environment.center;
    return environment;
}

/// Like `load_light`, for an image in memory.
py::tuple light_of_image(const Floats& image, int order, std::optional<int> suns, const py::dict& options,
                         int threads) {
    pipeline::LightOptions how;
    Environment environment = environment_of(image, options, how);
    pipeline::LoadedLight light;
    {
        const py::gil_scoped_release release;
        check_environment(environment);
        repair_pixels(environment.image, how.environment.bad_pixels);
        light = light_of_environment(std::move(environment), order, {suns}, how, threads);
    }
    return parts_of(light, {});
}

/// Returns the coefficients [order²][C], rotated by a matrix [3][3].
py::array_t<double> rotate(const Doubles& coefficients, const Doubles& rotation) {
    if (rotation.ndim() != 2 || rotation.shape(0) != 3 || rotation.shape(1) != 3)
        throw Error("a rotation must have the shape (3, 3), not " + shape_in_words(rotation));
    if (coefficients.ndim() != 2)
        throw Error("coefficients must have the shape (order², C), not " + shape_in_words(coefficients));
    const int order = order_of(static_cast<std::size_t>(coefficients.shape(0)));
    glm::dmat3 matrix;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            matrix[column][row] = rotation.at(row, column);
    const ShRotation rotated(order, matrix);
    const auto count = static_cast<std::size_t>(coefficients.shape(0));
    py::array_t<double> result({coefficients.shape(0), coefficients.shape(1)});
    std::vector<double> in(count), out(count);
    for (py::ssize_t c = 0; c < coefficients.shape(1); ++c) {
        for (std::size_t i = 0; i < count; ++i)
            in[i] = coefficients.at(static_cast<py::ssize_t>(i), c);
        rotated.apply(std::span<const double>(in), std::span(out));
        for (std::size_t i = 0; i < count; ++i)
            result.mutable_at(static_cast<py::ssize_t>(i), c) = out[i];
    }
    return result;
}

/// Returns the basis functions at directions [D][3], [D][order²].
py::array_t<double> basis(const Doubles& directions, int order) {
    if (order < 1 || order > kMaxOrder)
        throw Error("order must be in 1.." + std::to_string(kMaxOrder) + ", not " + std::to_string(order));
    const std::vector<glm::dvec3> all = double_rows(directions, "directions");
    const auto count = static_cast<std::size_t>(coefficient_count(order));
    py::array_t<double> result({static_cast<py::ssize_t>(all.size()), static_cast<py::ssize_t>(count)});
    const std::span values(result.mutable_data(), all.size() * count);
    for (std::size_t d = 0; d < all.size(); ++d)
        evaluate_sh(order, all[d], values.subspan(d * count, count));
    return result;
}

py::array_t<float> sun_light(const std::array<float, 3>& towards, const std::array<float, 3>& irradiance,
                             double half_angle, int order) {
    return copied(as_light(Sun{{towards[0], towards[1], towards[2]},
                               {irradiance[0], irradiance[1], irradiance[2]},
                               half_angle},
                           order)
                      .coefficients);
}

} // namespace

void add_light(py::module_& module) {
    module.def("load_light", load_light);
    module.def("light_of_image", light_of_image);
    module.def("rotate", rotate);
    module.def("basis", basis);
    module.def("sun_light", sun_light);
}

} // namespace prt::python
