// Bakes, compresses, measures and draws models.

#include "python/src/work.h"

#include "cli/pipeline/bake_model.h"
#include "cli/pipeline/compress_model.h"
#include "cli/pipeline/evaluate_model.h"
#include "cli/pipeline/no_shadow.h"
#include "cli/pipeline/relit_vertices.h"
#include "cli/pipeline/render_model.h"
#include "cli/pipeline/solid_materials.h"
#include "compress/metric/jumps.h"
#include "prt/bake/ambient_occlusion.h"
#include "python/src/arrays.h"
#include "python/src/call.h"
#include "python/src/model.h"
#include "python/src/options.h"

#include <cmath>
#include <utility>

namespace prt::python {
namespace {

using pipeline::Path;
using ModelPointer = std::shared_ptr<Model>;

void take_tracer(py::dict& options, TracerChoice& tracer) {
    std::string device = "auto";
    take(options, "device", device);
    if (device == "auto")
        tracer.backend = Backend::automatic;
    else if (device == "cpu")
        tracer.backend = Backend::cpu;
    else {
        tracer.backend = Backend::gpu;
        tracer.gpu = device == "gpu" ? "" : device;
    }
    choose(options, "method", tracer.method, {{"trace", BakeMethod::trace}, {"raster", BakeMethod::raster}});
    take(options, "raster_resolution", tracer.raster_resolution);
}

void take_fit(py::dict& options, FitMode& fit) {
    choose(options, "fit", fit,
           {{"auto", FitMode::automatic}, {"vertex", FitMode::vertex}, {"surface", FitMode::surface}});
}

void take_repairs(py::dict& options, Repairs& repairs) {
    choose(options, "enclosed", repairs.inside, {{"refill", Inside::refill}, {"keep", Inside::keep}});
    take(options, "denoise", repairs.denoise);
}

void take_lamps(py::dict& options, LampOptions& lamps) {
    choose(options, "lamps", lamps.mode,
           {{"all", LampMode::all}, {"indirect", LampMode::indirect}, {"none", LampMode::none}});
    take(options, "lamp_radius", lamps.radius);
    take(options, "lamp_rays", lamps.rays);
    std::vector<std::pair<std::string, std::string>> groups;
    take(options, "lamp_groups", groups);
    for (auto& [name, pattern] : groups)
        lamps.groups.push_back({std::move(name), std::move(pattern)});
}

/// Media by material ("": all materials): a name, or six coefficients in 1/mm.
void take_media(py::dict& options, SubsurfaceOptions& subsurface) {
    take(options, "metres_per_unit", subsurface.metres_per_unit);
    py::dict media;
    take(options, "subsurface", media);
    for (const auto& [material, value] : media) {
        MediumChoice choice{material.cast<std::string>(), {}};
        if (py::isinstance<py::str>(value)) {
            const auto name = value.cast<std::string>();
            const auto all = measured_media();
            const auto found = std::ranges::find(all, name, &NamedMedium::name);
            if (found == all.end())
                throw Error("subsurface: '" + name + "' is not a measured medium");
            choice.medium = found->medium;
        } else {
            const auto c = value.cast<std::array<double, 6>>();
            choice.medium.scattering = glm::dvec3(c[0], c[1], c[2]) * 1000.0;
            choice.medium.absorption = glm::dvec3(c[3], c[4], c[5]) * 1000.0;
        }
        subsurface.media.push_back(std::move(choice));
    }
}

void take_bake_options(py::dict& options, BakeOptions& bake) {
    take(options, "order", bake.order);
    take(options, "rays", bake.rays);
    take(options, "target_error", bake.target_error);
    take(options, "seed", bake.seed);
    take(options, "threads", bake.threads);
    double bounces = 0;
    take(options, "bounces", bounces);
    if (std::isinf(bounces) && bounces > 0)
        bake.bounces = kEndlessBounces;
    else if (bounces != std::floor(bounces) || !(bounces >= 0 && bounces <= kMaxBounces))
        throw Error("bounces must be a whole number in 0..10000 or math.inf");
    else
        bake.bounces = static_cast<int>(bounces);
    take_fit(options, bake.fit);
    take_tracer(options, bake.tracer);
    take_lamps(options, bake.lamps);
    take_repairs(options, bake.repairs);
    take_media(options, bake.subsurface);
    take(options, "bake_memory_limit", bake.memory.limit);
    std::optional<std::string> storage;
    take(options, "storage", storage);
    if (storage && *storage != "auto") {
        if (*storage != "float16" && *storage != "float32")
            throw Error("storage: '" + *storage + "' is not one of auto, float16, float32");
        bake.memory.storage = *storage == "float16" ? TransferStorage::float16 : TransferStorage::float32;
    }
}

void take_texels(py::dict& options, pipeline::TexelRequest& request) {
    py::dict texels;
    take(options, "lightmap", texels);
    const bool asked = !texels.empty();
    take(texels, "size", request.texels.size);
    take(texels, "per_metre", request.texels.per_metre);
    take(texels, "uv", request.texels.uv_set);
    take(texels, "unwrap", request.unwrap);
    choose(texels, "atlas", request.texels.atlases,
           {{"auto", AtlasMode::automatic}, {"one", AtlasMode::one}, {"each", AtlasMode::each}});
    check_empty(texels);
    if (asked && (!request.given() || request.texels.size < 0))
        throw Error("lightmap needs a size or per_metre above 0");
    take(options, "high_poly", request.high_poly.file);
    take(options, "high_poly_distance", request.high_poly.distance);
}

void take_volume(py::dict& options, pipeline::VolumeRequest& request) {
    py::dict volume;
    take(options, "volume", volume);
    const bool asked = !volume.empty();
    take(volume, "spacing", request.volume.spacing);
    take(volume, "probes", request.volume.probes);
    take(volume, "error", request.volume.error);
    take(volume, "order", request.volume.order);
    take(volume, "rays", request.volume.rays);
    take(volume, "fit", request.volume.fit_points);
    std::optional<std::array<std::array<double, 3>, 2>> bounds;
    take(volume, "bounds", bounds);
    if (bounds)
        request.bounds = {{(*bounds)[0][0], (*bounds)[0][1], (*bounds)[0][2]},
                          {(*bounds)[1][0], (*bounds)[1][1], (*bounds)[1][2]}};
    check_empty(volume);
    if (asked && !request.given())
        throw Error("volume needs a spacing or a number of probes above 0");
}

void take_instances(py::dict& options, pipeline::InstanceArguments& instances) {
    choose(options, "instances", instances.mode,
           {{"own", pipeline::InstanceMode::own},
            {"shared", pipeline::InstanceMode::shared},
            {"auto", pipeline::InstanceMode::automatic}});
    take(options, "instance_error", instances.error);
    take(options, "instance_lights", instances.lights);
}

/// Returns the model that a step wrote.
ModelPointer result(Call& call, const Path& output, const pipeline::Report& report) {
    std::vector<std::byte> bytes = call.take(output);
    ModelPointer model;
    {
        const py::gil_scoped_release release;
        model = read_model(output, std::move(bytes), {});
    }
    model->figures = pipeline::report_json(report);
    model->notices = call.notices();
    return model;
}

/// Returns the name of a result that was made from `model`.
Path named(const Model& model, const char* suffix) {
    return model.name.stem().string() + suffix;
}

ModelPointer bake(const Model& model, py::dict options, const py::object& progress) {
    pipeline::BakeRequest request;
    request.scene = model.name;
    request.output = named(model, "_baked.glb");
    take_bake_options(options, request.options);
    take_texels(options, request.texels);
    take_volume(options, request.volume);
    take_instances(options, request.instances);
    take(options, "no_shadow", request.no_shadow);
    take(options, "refine", request.finer.refine);
    take(options, "max_vertices", request.finer.max_vertices);
    choose(options, "back_sides", request.back_sides,
           {{"auto", pipeline::BackSides::automatic}, {"shared", pipeline::BackSides::shared}});
    choose(options, "levels", request.kept.levels,
           {{"carry", LevelMode::carry}, {"own", LevelMode::own}, {"ignore", LevelMode::ignore}});
    choose(options, "stored_lobes", request.kept.lobes,
           {{"keep", pipeline::LobesOfFile::keep}, {"remove", pipeline::LobesOfFile::remove}});
    check_empty(options);
    request.reading = model.reading;
    Call call(progress);
    const Path output = request.output;
    const pipeline::Report report = call.run(
        [&] { return bake_model(std::move(request), model.source().read(model.reading), call.host()); });
    return result(call, output, report);
}

/// Options of sizes, goals and predictors.
void take_coding(py::dict& options, pipeline::CompressRequest& request) {
    SearchOptions& search = request.options;
    WeightCoding& coding = search.compress.coding;
    std::optional<std::string> preset;
    std::optional<int> clusters, components, bits;
    bool floats = false;
    take(options, "preset", preset);
    take(options, "clusters", clusters);
    take(options, "components", components);
    take(options, "bits", bits);
    take(options, "float_weights", floats);
    Budget& budget = search.budget;
    take(options, "max_error", budget.max_error);
    take(options, "bytes_per_vertex", budget.bytes_per_vertex);
    take(options, "shader_operations", budget.operations);
    const bool jump_is_default = !options.contains("max_jump") || options["max_jump"].is_none();
    take(options, "max_jump", budget.max_jump);
    const bool sizes = clusters || components || bits || floats;
    if (preset && (sizes || budget.any()))
        throw Error("preset cannot be combined with other sizes or goals");
    if (budget.any() && bits)
        throw Error("bits cannot be combined with a goal, which chooses the bits");
    if (jump_is_default && budget.max_error && !budget.bytes_per_vertex && !budget.operations)
        budget.max_jump = kUnseenJump;
    std::string predictors = "auto";
    take(options, "predictors", predictors);
    request.predictors_given = predictors != "auto";
    if (request.predictors_given) {
        py::dict one;
        one["predictors"] = predictors;
        choose(one, "predictors", search.compress.predictors,
               {{"none", PredictorChoice::none},
                {"normal", PredictorChoice::normal},
                {"position", PredictorChoice::normal_and_position}});
    }
    search.choose_predictors = !request.predictors_given;
    search.choose_clusters = !clusters;
    search.choose_components = !components;
    request.components_given = components.has_value();
    request.preset = !budget.any() && !sizes;
    if (request.preset) {
        const std::pair<const char*, WeightCoding> presets[] = {{"u32", preset_u32()},
                                                                {"u64", preset_u64()},
                                                                {"u32x4", preset_u32x4()},
                                                                {"u64x9", preset_u64x9()}};
        const std::string name = preset.value_or("u32");
        const auto found =
            std::ranges::find_if(presets, [&](const auto& entry) { return entry.first == name; });
        if (found == std::end(presets))
            throw Error("preset: '" + name + "' is not one of u32, u64, u32x4, u64x9");
        coding = found->second;
        return;
    }
    if (floats) {
        coding.format = WeightFormat::float32;
        coding.components = 8;
        request.preset = !clusters && !budget.any();
    }
    search.compress.clusters = clusters.value_or(search.compress.clusters);
    coding.components = components.value_or(coding.components);
    coding.bits = bits.value_or(coding.bits);
}

ModelPointer compress(const ModelPointer& model, py::dict options, const py::object& progress) {
    pipeline::CompressRequest request;
    request.baked = model->source();
    request.output = named(*model, "_compressed.glb");
    take_coding(options, request);
    take(options, "seam_weight", request.options.compress.seam_weight);
    take(options, "lights", request.metric.lights);
    choose(options, "light_family", request.metric.metric,
           {{"outdoor", pipeline::MetricChoice::outdoor},
            {"indoor", pipeline::MetricChoice::indoor},
            {"day", pipeline::MetricChoice::day},
            {"natural", pipeline::MetricChoice::natural},
            {"plain", pipeline::MetricChoice::plain}});
    take(options, "best_effort", request.best_effort);
    take(options, "meshopt", request.writing.meshopt);
    take(options, "reorder", request.writing.reorder);
    take(options, "combine_direct", request.writing.whole);
    take(options, "volume_bytes", request.volume_bytes);
    take(options, "seed", request.options.compress.seed);
    take(options, "threads", request.options.compress.threads);
    check_empty(options);
    request.reading = model->reading;
    Call call(progress);
    const Path output = request.output;
    const pipeline::Report report = call.run([&] { return compress_model(std::move(request), call.host()); });
    return result(call, output, report);
}

/// Returns the report as JSON.
std::string evaluate(const ModelPointer& baked, const ModelPointer& shipped, py::dict options,
                     const py::object& progress) {
    pipeline::EvaluateRequest request;
    request.baked = baked->source();
    if (shipped)
        request.shipped = shipped->source();
    take(options, "lights", request.lights);
    take(options, "suns", request.suns.count);
    take(options, "rotations", request.rotations);
    take(options, "no_shadow", request.no_shadow);
    take(options, "threads", request.threads);
    std::vector<std::string> measures;
    take(options, "measures", measures);
    for (const std::string& measure : measures)
        request.measures.insert(measure == "sweep"    ? pipeline::Measure::sweep
                                : measure == "volume" ? pipeline::Measure::volume
                                                      : pipeline::Measure::budget);
    check_empty(options);
    request.reading = baked->reading;
    Call call(progress);
    return call.run([&] { return pipeline::report_json(evaluate_model(std::move(request), call.host())); })
        .dump();
}

/// Returns exit radiance for albedo 1, [vertices][3] or [texels][3]. `lamps`: strengths as a JSON object.
py::array_t<float>
relight(const Model& model, const Floats& sky,
        const std::vector<std::tuple<std::array<float, 3>, std::array<float, 3>, double>>& suns,
        const std::string& lamps, int rays, int threads, const py::object& progress) {
    model.transfer(); // throws without transfer
    pipeline::LoadedLight light;
    light.sky = light_of(sky);
    const int order = model.file.order();
    if (light.sky.order < order)
        throw Error("the light has order " + std::to_string(light.sky.order) + ", but the transfer of " +
                    model.name.string() + " has order " + std::to_string(order));
    light.sky = truncated(light.sky, order);
    for (const auto& [towards, irradiance, half_angle] : suns)
        light.split.suns.push_back({{towards[0], towards[1], towards[2]},
                                    {irradiance[0], irradiance[1], irradiance[2]},
                                    half_angle});
    const bool together = model.file.lightmap.has_value() || suns_stay_in_sky(model.file);
    if (together && !light.split.suns.empty()) {
        light.sky = sum(light.sky, as_light(light.split.suns, order));
        light.split.suns.clear();
    }
    Lighting lighting = lighting_of(light);
    lighting.lamps = pipeline::about(model.name, [&] {
        return pipeline::lamp_strengths_of(nlohmann::ordered_json::parse(lamps),
                                           pipeline::layout_of(model.file));
    });
    Call call(progress);
    const std::vector<glm::vec3> radiance = call.run([&] {
        if (model.file.lightmap)
            return model.file.compressed ? exit_radiance(model.file.compressed->transfer, lighting, threads)
                                         : exit_radiance(model.file.baked->transfer, lighting, threads);
        std::vector<glm::vec3> lit = lit_vertices(model.file, lighting, threads);
        if (light.split.suns.empty())
            return lit;
        const TraceScene scene(
            model.file.scene,
            load_textures(model.file.scene, model.reading.bad_textures, TextureNeeds::shadows),
            {.solid = pipeline::solid_materials(model.file.scene), .threads = threads});
        pipeline::add_direct_suns(scene, light.split.suns, {.rays = rays, .threads = threads},
                                  call.progress("suns"), lit);
        return lit;
    });
    return copied(radiance);
}

/// Returns display values [height][width][3] of bytes, or linear radiance [height][width][3] of floats.
py::tuple render(const ModelPointer& model, const ModelPointer& baked, py::dict options,
                 const py::object& progress) {
    bool linear = false;
    take(options, "linear", linear);
    pipeline::RenderRequest request;
    request.model = model->source();
    request.output = linear ? "picture.exr" : "picture.png";
    if (baked)
        request.baked = baked->source();
    take(options, "light", request.environment);
    take(options, "suns", request.lights.suns.count);
    take(options, "lamps", request.lights.lamps.file);
    take(options, "lamp_scale", request.lights.lamp_scale);
    std::array<int, 2> size = {request.view.width, request.view.height};
    take(options, "size", size);
    request.view.width = size[0];
    request.view.height = size[1];
    if (std::min(size[0], size[1]) < 1 || std::max(size[0], size[1]) > 16384)
        throw Error("size must be two numbers in 1..16384");
    take(options, "samples", request.view.samples);
    take(options, "fov", request.view.field_of_view_degrees);
    for (const auto& [name, target] :
         {std::pair("camera", &request.view.camera), std::pair("look_at", &request.view.look_at)}) {
        std::optional<std::array<double, 3>> point;
        take(options, name, point);
        if (point)
            *target = glm::dvec3((*point)[0], (*point)[1], (*point)[2]);
    }
    std::optional<double> stops;
    take(options, "exposure", stops);
    if (stops)
        request.look.exposure = {false, *stops};
    choose(options, "tone_map", request.look.tone_map,
           {{"filmic", ToneMap::filmic}, {"srgb", ToneMap::srgb}});
    choose(options, "show", request.look.show,
           {{"lit", pipeline::Show::lit},
            {"clusters", pipeline::Show::clusters},
            {"error", pipeline::Show::error},
            {"ao", pipeline::Show::ao}});
    take(options, "background", request.look.background);
    take(options, "path_trace", request.look.paths);
    choose(options, "device", request.backend,
           {{"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"gpu", Backend::gpu}});
    take(options, "threads", request.threads);
    check_empty(options);
    if (request.look.show == pipeline::Show::error && !baked && request.look.paths == 0)
        throw Error("show='error' needs a bake or path_trace");
    request.reading = model->reading;
    Call call(progress);
    const pipeline::Host host = call.host();
    request.reading.notify = host.notify;
    const pipeline::RenderedPicture picture = call.run([&] { return render_model(request, host); });
    const std::string report = pipeline::report_json(picture.report).dump();
    const std::vector<py::ssize_t> shape = {size[1], size[0], 3};
    if (!linear) {
        py::array_t<std::uint8_t> array(shape);
        std::memcpy(array.mutable_data(), picture.display.data(), 3 * picture.display.size());
        return py::make_tuple(array, report, call.notices());
    }
    py::array_t<float> array(shape);
    std::memcpy(array.mutable_data(), picture.linear.pixels.data(),
                picture.linear.pixels.size() * sizeof(glm::vec3));
    return py::make_tuple(array, report, call.notices());
}

/// Returns the ambient visibility [vertices], bent normals [vertices][3], and the device.
py::tuple occlusion(const Model& model, py::dict options, const py::object& progress) {
    OcclusionOptions how;
    take(options, "rays", how.rays);
    take(options, "target_error", how.target_error);
    take_fit(options, how.fit);
    take_tracer(options, how.tracer);
    take_repairs(options, how.repairs);
    std::vector<std::pair<double, double>> falloff;
    take(options, "falloff", falloff);
    for (const auto& [distance, share] : falloff)
        how.tracer.falloff.terms.push_back({distance, share});
    take(options, "max_distance", how.tracer.falloff.farthest);
    take(options, "threads", how.threads);
    take(options, "seed", how.seed);
    std::vector<std::string> no_shadow;
    take(options, "no_shadow", no_shadow);
    check_empty(options);
    how.repairs.bad_textures = model.reading.bad_textures;
    Call call(progress);
    const OcclusionResult result = call.run([&] {
        return pipeline::about(model.name, [&] {
            Scene scene = model.file.scene;
            pipeline::leave_out_shadows(scene, no_shadow);
            return ambient_occlusion(scene, how, call.progress("occlusion"));
        });
    });
    const AmbientVisibility& visibility = result.ambient_visibility;
    return py::make_tuple(copied(visibility.ambient, visibility.ambient.size(), 0),
                          copied(visibility.bent_normals), result.statistics.device);
}

} // namespace

void add_work(py::module_& module) {
    module.def("bake", bake);
    module.def("compress", compress);
    module.def("evaluate", evaluate);
    module.def("relight", relight);
    module.def("render", render);
    module.def("occlusion", occlusion);
}

} // namespace prt::python
