// The C interface: statuses and messages for exceptions, arrays of floats for the types of C++.
#include "prt/prt.h"

#include "prt/constant_former.h"
#include "prt/environment.h"
#include "prt/gltf.h"
#include "prt/image_file.h"
#include "prt/light_set.h"
#include "prt/sh.h"
#include "prt/sh_rotation.h"
#include "prt/sh_vector.h"
#include "prt/shader_source.h"
#include "prt/support/error.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <new>
#include <span>
#include <string>

struct prt_model {
    prt::Scene scene;
    prt::ClusteredTransfer transfer;
    prt::ConstantFormer former;
    std::vector<prt::ClusterLayout> layouts;
};

namespace {

using prt::Error;
using prt::Light;

constexpr std::size_t kMostCoefficients = prt::kMaxOrder * prt::kMaxOrder;

/// What a file or a function says no to, told apart by where it was asked.
struct BadFile : Error {
    using Error::Error;
};

struct TooSmall : Error {
    using Error::Error;
};

void say(prt_message* message, const char* text) noexcept {
    if (!message)
        return;
    const std::size_t length = std::min(std::strlen(text), sizeof message->text - 1);
    std::memcpy(message->text, text, length);
    message->text[length] = 0;
}

/// Runs `body` and turns what it throws into a status and a message.
template <class Body>
prt_status guarded(prt_message* message, Body&& body) noexcept {
    try {
        say(message, "");
        body();
        return PRT_OK;
    } catch (const std::bad_alloc&) {
        say(message, "out of memory");
        return PRT_NO_MEMORY;
    } catch (const BadFile& error) {
        say(message, error.what());
        return PRT_BAD_FILE;
    } catch (const TooSmall& error) {
        say(message, error.what());
        return PRT_TOO_SMALL;
    } catch (const Error& error) {
        say(message, error.what());
        return PRT_BAD_ARGUMENT;
    } catch (const std::exception& error) { // of a library, or a mistake in this one
        say(message, error.what());
        return PRT_INTERNAL;
    }
}

template <class... Pointers>
void check_pointers(const Pointers*... pointers) {
    const bool any_null = (... || (pointers == nullptr));
    if (any_null)
        throw Error("a pointer is null");
}

/// Of an image that an array can hold.
std::size_t pixel_count(int width, int height) {
    constexpr std::size_t kMost = std::numeric_limits<std::ptrdiff_t>::max() / sizeof(glm::vec3);
    const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
    if (rows > kMost / columns)
        throw Error("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels is larger than memory can be");
    return columns * rows;
}

std::size_t count_of(int order) {
    prt::check_order(order);
    return static_cast<std::size_t>(prt::coefficient_count(order));
}

glm::vec3 vec3(const float* v) {
    return glm::make_vec3(v);
}

/// Whether all values lie in -most..most. Without a way out of the loop it runs in vectors.
bool within(float most, const float* values, std::size_t count) {
    bool inside = true;
    for (std::size_t i = 0; i < count; ++i)
        inside &= std::abs(values[i]) <= most; // nor is NaN
    return inside;
}

bool finite(const float* values, std::size_t count) {
    return within(std::numeric_limits<float>::max(), values, count);
}

/// The coefficients of a function on the sphere, as it comes in or goes out.
void check_function(const float* function, std::size_t count) {
    if (!finite(function, count))
        throw Error("the coefficients of a function must be finite, and its products no larger than floats");
}

void check_colors(const float* light, std::size_t count) {
    if (!finite(light, 3 * count))
        throw Error("the coefficients of a light must be finite");
}

/// Of light and constants that a model is lit by.
constexpr float kBrightest = 1e20f, kLargestConstant = 1e30f;

glm::vec3 color(const float* rgb) {
    if (!finite(rgb, 3))
        throw Error("a colour of light must be finite");
    return vec3(rgb);
}

glm::vec3 direction_of(const float* xyz) {
    const double length = glm::length(glm::dvec3(vec3(xyz)));
    if (!(length > 0 && std::isfinite(length)))
        throw Error("a direction is wanted, not a vector of length " + std::to_string(length));
    return vec3(xyz);
}

glm::vec3* colors(float* light) {
    return reinterpret_cast<glm::vec3*>(light); // three floats and nothing else
}

void put(const Light& light, float* to) {
    std::copy(light.coefficients.begin(), light.coefficients.end(), colors(to));
}

std::span<const glm::vec3> light_colors(const float* from, std::size_t count) {
    return {reinterpret_cast<const glm::vec3*>(from), count};
}

Light light_from(int order, const float* from) {
    const std::size_t count = count_of(order);
    check_colors(from, count);
    const auto* first = reinterpret_cast<const glm::vec3*>(from);
    return {order, {first, first + count}};
}

/// Those of C are the same numbers.
prt::ShaderLanguage language_of(int language) {
    if (language < PRT_GLSL450 || language > PRT_VULKAN)
        throw Error("there is no such shader language");
    return static_cast<prt::ShaderLanguage>(language);
}

prt::ConstantSource source_of(int constants) {
    if (constants < PRT_CONSTANTS_IN_BUFFER || constants > PRT_CONSTANTS_IN_TEXTURE)
        throw Error("there is no such place for constants");
    return static_cast<prt::ConstantSource>(constants);
}

prt::LatLongCenter center_of(int center) {
    if (center != PRT_CENTER_Z && center != PRT_CENTER_X)
        throw Error("a lat-long image is centerd on +Z or +X");
    return center == PRT_CENTER_X ? prt::LatLongCenter::x : prt::LatLongCenter::z;
}

static_assert(static_cast<int>(prt::ShaderLanguage::vulkan) == PRT_VULKAN &&
              static_cast<int>(prt::ConstantSource::texture) == PRT_CONSTANTS_IN_TEXTURE &&
              static_cast<int>(prt::WeightFormat::packed) == PRT_PACKED &&
              static_cast<int>(prt::WeightFormat::snorm8) == PRT_SNORM8);
static_assert(sizeof(glm::vec3) == 3 * sizeof(float) &&
              sizeof(prt::ClusterLayout) == 4 * sizeof(std::uint32_t) &&
              sizeof(glm::uvec3) == 3 * sizeof(std::uint32_t));

prt_model* make_model(const prt::GltfDocument& document, const std::string& name) {
    prt::Scene scene = prt::extract_scene(document);
    auto compressed = prt::read_clustered(document, scene);
    if (!compressed)
        throw Error(name + ": holds no compressed transfer; run prt compress first");
    prt::ConstantFormer former(compressed->transfer);
    auto layouts = prt::cluster_layouts(compressed->transfer.bases);
    return new prt_model{std::move(scene), std::move(compressed->transfer), std::move(former),
                         std::move(layouts)};
}

template <class Body>
void as_file(Body&& body) {
    try {
        body();
    } catch (const Error& error) {
        throw BadFile(error.what());
    }
}

} // namespace

extern "C" {

prt_status prt_sh_evaluate(int order, const float direction[3], float* basis, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(direction, basis);
        const std::size_t count = count_of(order);
        std::array<float, kMostCoefficients> values;
        prt::evaluate_sh(order, direction_of(direction), std::span(values).first(count));
        check_function(values.data(), count);
        std::copy_n(values.begin(), count, basis);
    });
}

prt_status prt_sh_multiply(int order, const float* a, const float* b, float* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(a, b, out);
        const std::size_t count = count_of(order);
        check_function(a, count);
        check_function(b, count);
        std::array<float, kMostCoefficients> product;
        prt::sh_product(order, std::span(a, count), std::span(b, count), std::span(product).first(count));
        check_function(product.data(), count);
        std::copy_n(product.begin(), count, out);
    });
}

prt_status prt_sh_rotate(int order, const float rotation[9], const float* in, float* out,
                         prt_message* message) {
    return guarded(message, [&] {
        check_pointers(rotation, in, out);
        const std::size_t count = count_of(order);
        check_function(in, count);
        std::array<float, kMostCoefficients> turned;
        prt::ShRotation(order, glm::dmat3(glm::make_mat3(rotation)))
            .apply(std::span(in, count), std::span(turned).first(count));
        check_function(turned.data(), count);
        std::copy_n(turned.begin(), count, out);
    });
}

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

prt_status prt_light_rotate(int order, const float rotation[9], float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(rotation, light);
        Light turned = light_from(order, light);
        prt::ShRotation(order, glm::dmat3(glm::make_mat3(rotation))).apply(turned.coefficients);
        check_colors(&turned.coefficients[0].x, turned.coefficients.size());
        put(turned, light);
    });
}

prt_status prt_light_dering(int order, float* light, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(light);
        put(prt::windowed(light_from(order, light), prt::Window::automatic), light);
    });
}

prt_status prt_model_load(const char* path, prt_model** model, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(path, model);
        *model = nullptr;
        as_file([&] {
            *model = make_model(prt::load_gltf(path, {.missing_images = prt::MissingImages::ignore}), path);
        });
    });
}

prt_status prt_model_load_memory(const void* bytes, size_t size, prt_model** model, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(bytes, model);
        *model = nullptr;
        const std::span file(static_cast<const std::byte*>(bytes), size);
        as_file([&] {
            *model = make_model(
                prt::parse_gltf(file, "memory", {.missing_images = prt::MissingImages::ignore}), "memory");
        });
    });
}

void prt_model_destroy(prt_model* model) {
    delete model;
}

prt_status prt_model_get_info(const prt_model* model, prt_model_info* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        const prt::ClusteredReceivers& receivers = model->transfer.receivers;
        *out = {};
        out->order = model->former.order();
        out->channels = model->former.layout().channels();
        out->direct_apart = model->former.layout().has(prt::PartKind::direct);
        out->receivers = receivers.size();
        out->clusters = model->layouts.size();
        out->rows = model->former.rows();
        out->format = static_cast<prt_weight_format>(receivers.format);
        out->stride = receivers.stride();
        out->weights = receivers.weights.data();
        out->cluster_of = receivers.clusters.data();
        out->cluster_table = reinterpret_cast<const std::uint32_t*>(model->layouts.data());
        out->meshes = model->scene.primitives.size();
    });
}

prt_status prt_model_get_vertex_inputs(const prt_model* model, prt_vertex_inputs* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        *out = {};
        for (const prt::Guide& guide : model->transfer.bases.guides) {
            if (guide.kind == prt::GuideKind::normal) {
                out->normals = 1;
                continue;
            }
            out->positions = 1;
            std::copy_n(glm::value_ptr(guide.origin), 3, out->guide_origin);
        }
        std::copy_n(glm::value_ptr(model->scene.origin), 3, out->origin);
    });
}

prt_status prt_model_count_lamps(const prt_model* model, size_t* lamps, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, lamps);
        *lamps = model->former.layout().lamps();
    });
}

prt_status prt_model_lamp_name(const prt_model* model, size_t lamp, const char** name, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, name);
        const std::span<const prt::TransferPart> lamps = model->former.layout().lamp_parts();
        if (lamp >= lamps.size())
            throw Error("the model has " + std::to_string(lamps.size()) + " lamps");
        *name = lamps[lamp].name.c_str();
    });
}

prt_status prt_model_add_sun(const prt_model* model, const float towards[3], const float irradiance[3],
                             float* lamps, double* away, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, towards, irradiance, lamps);
        const prt::TransferLayout& layout = model->former.layout();
        const glm::dvec3 direction(towards[0], towards[1], towards[2]);
        const double length = glm::length(direction);
        if (!(length > 0 && std::isfinite(length)) || !within(kBrightest, irradiance, 3))
            throw Error("a sun needs a direction, and irradiance of at most 1e20");
        const prt::SunDisc sun{glm::vec3(direction / length), glm::make_vec3(irradiance)};
        const double angle = prt::add_sun(layout, sun, {reinterpret_cast<glm::vec3*>(lamps), layout.lamps()});
        if (away)
            *away = angle;
    });
}

prt_status prt_model_get_mesh(const prt_model* model, size_t mesh, prt_mesh* out, prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, out);
        if (mesh >= model->scene.primitives.size())
            throw Error("the model has " + std::to_string(model->scene.primitives.size()) + " meshes");
        const prt::Primitive& primitive = model->scene.primitives[mesh];
        const prt::VertexArray& vertices = model->scene.vertex_arrays[primitive.vertices];
        *out = {};
        out->vertices = vertices.size();
        out->first_receiver = vertices.first_receiver;
        out->positions = reinterpret_cast<const float*>(vertices.positions.data());
        out->normals = reinterpret_cast<const float*>(vertices.normals.data());
        if (!vertices.texcoords.empty() && !vertices.texcoords[0].empty())
            out->texcoords = reinterpret_cast<const float*>(vertices.texcoords[0].data());
        out->indices = 3 * primitive.triangles.size();
        out->index = reinterpret_cast<const std::uint32_t*>(primitive.triangles.data());
        const glm::vec4 color = model->scene.materials[primitive.material].base_color;
        std::copy_n(glm::value_ptr(color), 4, out->base_color);
    });
}

prt_status prt_model_form_constants(const prt_model* model, int order, const float* light, float* constants,
                                    prt_message* message) {
    return prt_model_form_constants_apart(model, order, light, nullptr, nullptr, constants, message);
}

prt_status prt_model_form_constants_apart(const prt_model* model, int order, const float* sky,
                                          const float* suns, const float* lamps, float* constants,
                                          prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, sky, constants);
        const std::size_t count = count_of(order), rows = model->former.rows(),
                          strengths = lamps ? model->former.layout().lamps() : 0;
        if (!within(kBrightest, sky, 3 * count) || (suns && !within(kBrightest, suns, 3 * count)) ||
            (lamps && !within(kBrightest, lamps, 3 * strengths)))
            throw Error("the coefficients of a light must be finite and at most 1e20");
        model->former.form(
            {light_colors(sky, count), light_colors(suns, suns ? count : 0), light_colors(lamps, strengths)},
            {reinterpret_cast<glm::vec4*>(constants), rows});
        if (!within(kLargestConstant, constants, 4 * rows))
            throw Error("the light is too bright for the model: constants pass 1e30");
    });
}

prt_status prt_model_evaluate(const prt_model* model, const float* constants, float* radiance,
                              prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, constants, radiance);
        if (!within(kLargestConstant, constants, 4 * model->former.rows()))
            throw Error("constants must be finite and at most 1e30");
        prt::evaluate(model->transfer, {reinterpret_cast<const glm::vec4*>(constants), model->former.rows()},
                      {colors(radiance), model->transfer.receivers.size()});
    });
}

prt_status prt_model_shader(const prt_model* model, int language, int constants, char* source, size_t* size,
                            prt_message* message) {
    return guarded(message, [&] {
        check_pointers(model, size);
        const std::string text =
            prt::relight_shader(model->transfer, source_of(constants), language_of(language));
        const std::size_t room = source ? *size : 0;
        *size = text.size() + 1;
        if (room < *size)
            throw TooSmall("the shader takes " + std::to_string(*size) + " bytes");
        std::memcpy(source, text.c_str(), *size);
    });
}

} // extern "C"
