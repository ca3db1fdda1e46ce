#include "argument_parts.h"
#include "known_names.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <string>

namespace prt::cli {
namespace {

const std::map<std::string, Backend> kBackends = {
    {"auto", Backend::automatic}, {"cpu", Backend::cpu}, {"gpu", Backend::gpu}};
const std::map<std::string, Inside> kInsides = {{"refill", Inside::refill}, {"keep", Inside::keep}};
const std::map<std::string, BakeMethod> kBakeMethods = {{"trace", BakeMethod::trace},
                                                        {"raster", BakeMethod::raster}};
const std::map<std::string, std::optional<TransferStorage>> kStorages = {
    {"auto", std::nullopt}, {"float32", TransferStorage::float32}, {"float16", TransferStorage::float16}};
const std::map<std::string, BadTextures> kBadTextures = {{"error", BadTextures::error},
                                                         {"ignore", BadTextures::ignore}};
const std::map<std::string, ShaderLanguage> kLanguages = {{"glsl450", ShaderLanguage::glsl450},
                                                          {"glsl330", ShaderLanguage::glsl330},
                                                          {"essl300", ShaderLanguage::essl300},
                                                          {"vulkan", ShaderLanguage::vulkan}};
const std::map<std::string, ConstantSource> kConstants = {{"buffer", ConstantSource::buffer},
                                                          {"block", ConstantSource::block},
                                                          {"texture", ConstantSource::texture}};
const std::map<std::string, Show> kShows = {
    {"lit", Show::lit}, {"clusters", Show::clusters}, {"error", Show::error}, {"ao", Show::ao}};
const std::map<std::string, ToneMap> kToneMaps = {{"filmic", ToneMap::filmic}, {"srgb", ToneMap::srgb}};

void parse_vector(const std::string& name, const std::string& text, std::optional<glm::dvec3>& target) {
    glm::dvec3 v(0);
    int used = 0;
    if (std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &v.x, &v.y, &v.z, &used) != 3 ||
        static_cast<std::size_t>(used) != text.size())
        throw CLI::ValidationError(name, "'" + text + "' is not x,y,z");
    target = v;
}

void vector_option(CLI::App* command, const std::string& name, std::optional<glm::dvec3>& target,
                   const std::string& text) {
    command
        ->add_option_function<std::string>(
            name, [name, &target](const std::string& value) { parse_vector(name, value, target); }, text)
        ->type_name("x,y,z");
}

int parse_bounces(const std::string& text) {
    int bounces = 0;
    if (text == "inf")
        return kEndlessBounces;
    if (!CLI::detail::lexical_cast(text, bounces) || bounces < 0)
        throw CLI::ValidationError("--bounces", "'" + text + "' is neither a number of bounces nor inf");
    return bounces;
}

/// [MATERIAL=]MEDIUM, where MEDIUM is a name or six coefficients in 1/mm.
MediumChoice parse_medium(const std::string& text) {
    MediumChoice choice;
    const std::size_t equals = text.rfind('=');
    if (equals != std::string::npos)
        choice.material = text.substr(0, equals);
    const std::string medium = equals == std::string::npos ? text : text.substr(equals + 1);
    std::string names;
    for (const NamedMedium& named : measured_media()) {
        if (named.name == medium) {
            choice.medium = named.medium;
            return choice;
        }
        names += std::string(named.name) + ", ";
    }
    glm::dvec3 &s = choice.medium.scattering, &a = choice.medium.absorption;
    int used = 0;
    if (std::sscanf(medium.c_str(), "%lf,%lf,%lf,%lf,%lf,%lf%n", &s.x, &s.y, &s.z, &a.x, &a.y, &a.z, &used) !=
            6 ||
        static_cast<std::size_t>(used) != medium.size() || !(std::min({s.x, s.y, s.z}) > 0) ||
        !(std::min({a.x, a.y, a.z}) >= 0))
        throw CLI::ValidationError("--subsurface", "'" + medium + "' is neither one of " + names +
                                                       "nor six coefficients sr,sg,sb,ar,ag,ab in 1/mm");
    s *= 1000.0;
    a *= 1000.0;
    return choice;
}

void add_transport(CLI::App* command, BakeOptions& options) {
    command
        ->add_option_function<std::string>(
            "--bounces", [&options](const std::string& text) { options.bounces = parse_bounces(text); },
            "bounces of light between surfaces; inf: all of them")
        ->type_name("N|inf")
        ->default_str("0");
    command
        ->add_option_function<std::vector<std::string>>(
            "--subsurface",
            [&options](const std::vector<std::string>& texts) {
                for (const std::string& text : texts)
                    options.subsurface.media.push_back(parse_medium(text));
            },
            "light spreads under the surface of a material, or of all: marble, skin1, whole-milk and others, "
            "or "
            "reduced scattering and absorption sr,sg,sb,ar,ag,ab in 1/mm")
        ->allow_extra_args(false) // one each time, so that the scene may follow
        ->type_name("[MATERIAL=]MEDIUM");
    command
        ->add_option("--metres-per-unit", options.subsurface.metres_per_unit,
                     "size of the scene's unit, where it is not glTF's metre; only media care")
        ->capture_default_str();
    choice(command, "--bad-textures", options.bad_textures, kBadTextures,
           "textures that are missing, damaged or of a format that is not read: stop where one is needed, or "
           "use the factors of their materials alone",
           "error");
    command
        ->add_option_function<std::uint64_t>(
            "--memory-limit",
            [&options](const std::uint64_t& bytes) { options.memory_limit = static_cast<double>(bytes); },
            "bytes that the bake may take; otherwise what the machine or its container has")
        ->transform(CLI::AsSizeValue(true))
        ->type_name("SIZE, as 8GB");
    choice(command, "--inside", options.inside, kInsides,
           "vertices that lie inside solid geometry, where no light comes: they take the light of their "
           "neighbours, "
           "or stay dark",
           "refill");
}

void add_method(CLI::App* command, BakeOptions& options) {
    choice(command, "--backend", options.tracer.backend, kBackends,
           "gpu: OpenGL 4.5 of any kind; auto: a hardware GPU, else the CPU", "auto");
    choice(command, "--method", options.tracer.method, kBakeMethods,
           "trace: rays; raster: depth maps from many directions, direct light only, on the GPU", "trace");
    command
        ->add_option("--raster-resolution", options.tracer.raster_resolution,
                     "texels along each side of a depth map")
        ->capture_default_str();
}

void add_bake(CLI::App& app, BakeArguments& a) {
    CLI::App* command = app.add_subcommand("bake", "Bake transfer vectors for every vertex of a glTF scene");
    command->add_option("scene", a.scene, "glTF 2.0 scene, .gltf or .glb")->required();
    add_output(command, a.output, "baked .glb to write");
    command->add_option("--order", a.options.order, "SH order N, 1..10: N² coefficients")
        ->capture_default_str();
    CLI::Option* rays =
        command->add_option("--rays", a.options.rays, "rays per receiver; directions where method is raster")
            ->capture_default_str();
    command
        ->add_option(
            "--target-error", a.options.target_error,
            "relative L2 error of the direct light to reach, with as many rays as each receiver needs")
        ->excludes(rays);
    add_transport(command, a.options);
    command
        ->add_option("--no-shadow", a.no_shadow,
                     "a material whose surfaces stop no light, as the sky or the outline that is a shell "
                     "round a scene")
        ->allow_extra_args(false)
        ->type_name("MATERIAL");
    add_method(command, a.options);
    choice(command, "--storage", a.options.storage, kStorages,
           "auto: float16 where its rounding is less than a tenth of the sampling error", "auto");
    command->add_option("--seed", a.options.seed, "seed of the samples")->capture_default_str();
    add_threads(command, a.options.threads);
    add_json(command, a.json);
}

void add_bench(CLI::App& app, BenchArguments& a) {
    CLI::App* command = app.add_subcommand(
        "bench", "Measure speed against error of the bake, on every backend and by every method");
    CLI::Option* scene = command->add_option("scene", a.scene, "glTF 2.0 scene, .gltf or .glb");
    command->add_flag("--classic", a.classic, "generated meshes like those of Hill's table of 2004")
        ->excludes(scene);
    command->add_option("--order", a.options.order, "SH order N")
        ->capture_default_str()
        ->check(CLI::Range(1, kMaxOrder));
    command->add_option("--from", a.options.fewest_rays, "fewest rays per receiver")
        ->capture_default_str()
        ->check(CLI::Range(1, kMostRays));
    command->add_option("--to", a.options.most_rays, "most rays per receiver")
        ->capture_default_str()
        ->check(CLI::Range(1, kMostRays / 64));
    command
        ->add_option("--raster-resolution", a.options.raster_resolution,
                     "texels along each side of a depth map")
        ->capture_default_str()
        ->check(CLI::Range(16, 16384));
    command->add_option("--most-seconds", a.options.most_seconds, "leave runs out that would take longer")
        ->capture_default_str();
    command->add_option("--seed", a.options.seed, "seed of the samples")->capture_default_str();
    add_threads(command, a.options.threads);
    add_reports(command, a.json, a.html, a.csv);
}

void add_evaluate(CLI::App& app, EvaluateArguments& a) {
    CLI::App* command =
        app.add_subcommand("evaluate", "Measure the error of a compressed file against its bake");
    command->add_option("baked", a.baked, "output of prt bake, the reference")->required();
    command->add_option("shipped", a.shipped, "output of prt compress, or another bake of the same scene");
    command
        ->add_option("--lights", a.lights,
                     "environment (.exr, .hdr, .png, .jpg) or light (.json), repeated for each of several; "
                     "otherwise a uniform light, an overcast sky and a sun")
        ->allow_extra_args(false) // one each time, so that the files may follow
        ->type_name("FILE");
    add_light_options(command, a.light_options);
    command->add_option("--rotations", a.rotations, "turn each light about +Y by this many equal angles")
        ->capture_default_str()
        ->check(CLI::Range(1, 64));
    command->add_flag(
        "--sweep", a.sweep,
        "error against size and shader cost of this compressor and of those it came from; minutes");
    add_threads(command, a.threads);
    add_reports(command, a.json, a.html, a.csv);
}

void add_project(CLI::App& app, ProjectArguments& a) {
    CLI::App* command = app.add_subcommand("project", "Project an environment map into SH lighting");
    command
        ->add_option("environment", a.environment,
                     "environment map, .exr, .hdr, .png or .jpg; with {face} in its name six files px, nx, "
                     "py, ny, pz, nz")
        ->required();
    add_output(command, a.output, "light to write, .json");
    command->add_option("--order", a.order, "SH order N, 1..10")->capture_default_str();
    command
        ->add_option("--suns", a.suns,
                     "fit so many lights to it, write them apart, and the rest as coefficients")
        ->check(CLI::Range(0, 16))
        ->capture_default_str();
    add_light_options(command, a.light_options);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

Exposure parse_exposure(const std::string& text) {
    Exposure exposure;
    exposure.automatic = text.starts_with("auto");
    const std::string number = exposure.automatic ? text.substr(4) : text;
    const bool sign_follows = number.empty() || number[0] == '+' || number[0] == '-';
    if ((exposure.automatic && !sign_follows) ||
        (!number.empty() && !CLI::detail::lexical_cast(number, exposure.stops)) || text.empty() ||
        !std::isfinite(exposure.stops))
        throw CLI::ValidationError("--exposure", "'" + text +
                                                     "' is neither a number of stops nor auto, "
                                                     "auto+STOPS or auto-STOPS");
    return exposure;
}

void add_render(CLI::App& app, RenderArguments& a) {
    CLI::App* command = app.add_subcommand("render", "Draw a file under an environment, without a window");
    command
        ->add_option("model", a.model, "any .gltf or .glb: compressed, baked, or neither (then unshadowed)")
        ->required();
    command->add_option("--env", a.environment, "environment (.exr, .hdr, .png, .jpg) or light (.json)")
        ->required()
        ->type_name("FILE");
    add_output(command, a.output, "picture to write, .png or .exr");
    command
        ->add_option_function<std::string>(
            "--size",
            [&a](const std::string& text) {
                int used = 0;
                if (std::sscanf(text.c_str(), "%dx%d%n", &a.width, &a.height, &used) != 2 ||
                    static_cast<std::size_t>(used) != text.size() || a.width < 1 || a.height < 1 ||
                    a.width > 16384 || a.height > 16384)
                    throw CLI::ValidationError("--size", "'" + text + "' is not WIDTHxHEIGHT in 1..16384");
            },
            "size in pixels")
        ->type_name("WxH")
        ->default_str("1280x720");
    vector_option(command, "--camera", a.camera,
                  "position of the camera, metres; otherwise it sees the whole scene");
    vector_option(command, "--look-at", a.look_at,
                  "point the camera looks at; otherwise the middle of the scene");
    command->add_option("--fov", a.field_of_view_degrees, "vertical field of view, degrees")
        ->capture_default_str()
        ->check(CLI::Range(1.0, 170.0));
    choice(command, "--backend", a.backend, kBackends,
           "gpu: OpenGL 4.5 of any kind; cpu: ray casting; auto: a hardware GPU, else the CPU", "auto");
    choice(
        command, "--show", a.show, kShows,
        "lit; the clusters; the error against --baked (white: 10 % of the mean radiance); ambient occlusion",
        "lit");
    command->add_option("--baked", a.baked, "the bake that --show error compares with")->type_name("FILE");
    command
        ->add_option_function<std::string>(
            "--exposure", [&a](const std::string& text) { a.exposure = parse_exposure(text); },
            "stops; or auto: the mean luminance of what shows of the model becomes 0.22; or stops "
            "beside it: auto+1, auto-0.5")
        ->type_name("STOPS")
        ->default_str("auto");
    choice(command, "--tone-map", a.tone_map, kToneMaps, "tone curve of .png", "filmic");
    command->add_option("--samples", a.samples, "samples per pixel along each axis")
        ->capture_default_str()
        ->check(CLI::Range(1, 16));
    command->add_flag("!--no-background", a.background, "do not show the environment behind the scene");
    add_light_options(command, a.light_options);
    add_threads(command, a.threads);
    add_json(command, a.json);
}

void add_shader(CLI::App& app, ShaderArguments& a) {
    CLI::App* command = app.add_subcommand("shader", "Write the shader that relights a compressed model");
    command->add_option("model", a.model, "output of prt compress")->required();
    add_output(command, a.output, "GLSL to write");
    choice(command, "--language", a.language, kLanguages,
           "vulkan is GLSL to compile to SPIR-V, and from there to HLSL", "glsl450");
    choice(command, "--constants", a.constants, kConstants,
           "where the constants are: a storage buffer, a uniform block or a float texture",
           "buffer, texture where the language has no buffers");
    command->add_flag("--compute", a.compute,
                      "the compute shader that forms the constants instead of the vertex shader");
}

void add_info(CLI::App& app, InfoArguments& a) {
    CLI::App* command = app.add_subcommand("info", "Say what a glTF file holds");
    command->add_option("file", a.file, "any .gltf or .glb")->required();
    add_json(command, a.json);
}

/// What CLI11 cannot see: options that need each other.
void check_together(const RenderArguments& a) {
    if ((a.show == Show::error) == a.baked.empty())
        throw CLI::ValidationError("--show error", "and --baked FILE go together");
}

/// As a shell would take it.
std::string command_line(int argc, char** argv) {
    std::string line = "prt";
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const bool plain =
            !word.empty() && word.find_first_of(" \t\n'\"\\$`*?;&|<>(){}#") == std::string::npos;
        line += plain ? " " + word : " '" + word + "'";
    }
    return line;
}

} // namespace

std::variant<Arguments, int> parse_arguments(int argc, char** argv) {
    CLI::App app("prtkit: bakes, compresses and relights precomputed radiance transfer", "prt");
    app.set_version_flag("--version", "prt " PRTKIT_VERSION);
    app.require_subcommand(1);
    BakeArguments bake;
    BenchArguments bench;
    CompressArguments compress;
    EvaluateArguments evaluate;
    ProjectArguments project;
    RenderArguments render;
    ShaderArguments shader;
    InfoArguments info;
    add_bake(app, bake);
    add_bench(app, bench);
    add_compress(app, compress);
    add_evaluate(app, evaluate);
    add_project(app, project);
    add_render(app, render);
    add_shader(app, shader);
    add_info(app, info);
    if (argc < 2) {
        std::fputs(app.help().c_str(), stdout);
        std::fputs("prt: error: which command? They are listed above\n", stderr);
        return 2;
    }
    try {
        check_names(app, {argv + 1, static_cast<std::size_t>(argc - 1)});
        app.parse(argc, argv);
        if (app.got_subcommand("render"))
            check_together(render);
        if (app.got_subcommand("evaluate") && evaluate.shipped.empty() && !evaluate.sweep)
            throw CLI::ValidationError(
                "evaluate", "compares two files: prt evaluate BAKED.glb SHIPPED.glb; or measures what the "
                            "compressor makes of one: prt evaluate BAKED.glb --sweep");
        if (app.got_subcommand("compress"))
            resolve(*app.get_subcommand("compress"), compress);
        if (app.got_subcommand("bench") && bench.scene.empty() && !bench.classic)
            throw CLI::RequiredError("scene, or --classic");
    } catch (const CLI::Success& nothing_to_do) {
        return app.exit(nothing_to_do);
    } catch (const CLI::ParseError& error) {
        std::fprintf(stderr, "prt: error: %s\n", error.what());
        return 2;
    }
    evaluate.command_line = bench.command_line = command_line(argc, argv);
    if (app.got_subcommand("bake"))
        return Arguments(bake);
    if (app.got_subcommand("bench"))
        return Arguments(bench);
    if (app.got_subcommand("compress"))
        return Arguments(compress);
    if (app.got_subcommand("evaluate"))
        return Arguments(evaluate);
    if (app.got_subcommand("project"))
        return Arguments(project);
    if (app.got_subcommand("render"))
        return Arguments(render);
    if (app.got_subcommand("shader"))
        return Arguments(shader);
    return Arguments(info);
}

} // namespace prt::cli
