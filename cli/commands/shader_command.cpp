// prt shader: writes shaders for a compressed file.

#include "cli/commands/commands.h"

#include "cli/arguments/options.h"
#include "cli/program/outputs.h"
#include "cli/program/session.h"
#include "cli/program/terminal.h"
#include "prt/core/error.h"
#include "prt/core/occlusion_volume.h"
#include "prt/shader/shader_source.h"
#include "runtime/core/support/printable.h"

#include <fmt/core.h>
#include <glm/vec4.hpp>

#include <algorithm>

namespace prt::cli {
namespace {

enum class Stage { vertex, compute, fragment, instances, volume, volume_compute, occluders, lobes };

struct ShaderArguments {
    Path model, output;
    ShaderLanguage language = ShaderLanguage::glsl450;
    std::optional<ConstantSource> constants; ///< unset: the best option of the language
    Stage stage = Stage::vertex;
    ReadingOptions reading;

    bool computes() const { return stage == Stage::compute || stage == Stage::volume_compute; }
};

constexpr Choice<ShaderLanguage> kLanguages[] = {
    {"glsl450", ShaderLanguage::glsl450, "OpenGL 4.5"},
    {"glsl330", ShaderLanguage::glsl330, "OpenGL 3.3"},
    {"essl300", ShaderLanguage::essl300, "OpenGL ES 3.0, WebGL 2"},
    {"vulkan", ShaderLanguage::vulkan, "GLSL for Vulkan, to convert to SPIR-V and then to HLSL"}};
constexpr Choice<ConstantSource> kConstants[] = {
    {"buffer", ConstantSource::buffer, "storage buffer; only for glsl450 and vulkan"},
    {"block", ConstantSource::block,
     "uniform block; every driver allows 16 KB, which are 1024 constants; not for instances"},
    {"texture", ConstantSource::texture, "float texture"}};
constexpr Choice<Stage> kStages[] = {
    {"vertex", Stage::vertex,
     "vertex shader that relights vertices\n"
     "  for a lightmap: compute shader (glsl450, vulkan) or fragment shader that relights texels"},
    {"compute", Stage::compute,
     "compute shader that computes the constants of a lighting; only glsl450 and vulkan"},
    {"fragment", Stage::fragment, "fragment shader that relights the texels of a lightmap; needs a lightmap"},
    {"instances", Stage::instances, "vertex shader for instances of prt bake --instances shared"},
    {"volume", Stage::volume, "functions that read the light of the probe volume, for all languages"},
    {"volume-compute", Stage::volume_compute,
     "compute shader that writes the texture which the functions of volume read\n"
     "  only glsl450 and vulkan"},
    {"occluders", Stage::occluders, "functions for contact shadows of moving objects, for all languages"},
    {"lobes", Stage::lobes, "functions that relight figures of prt lobes, for all languages"}};

/// Returns storage buffers if the language has them, otherwise a texture, which always has space.
ConstantSource constants_for(ShaderLanguage language) {
    const bool old = language == ShaderLanguage::glsl330 || language == ShaderLanguage::essl300;
    return old ? ConstantSource::texture : ConstantSource::buffer;
}

/// Minimum that every OpenGL, OpenGL ES and Vulkan guarantees; few phones exceed it.
constexpr std::size_t kGuaranteedBlock = 16384;

/// Warns of a block larger than guaranteed: it compiles, but linking fails.
void warn_of_large_blocks(const Path& model, const ClusteredTransfer& transfer) {
    const std::size_t rows = constant_rows(transfer.bases), clusters = transfer.bases.clusters();
    const std::size_t bytes = sizeof(glm::vec4) * std::max(rows, clusters);
    if (bytes > kGuaranteedBlock)
        print_notices(model.string(),
                      {fmt::format("has {} rows of constants, a uniform block of {} bytes; {} are guaranteed "
                                   "(GL_MAX_UNIFORM_BLOCK_SIZE): --constants texture has room everywhere, or "
                                   "compress with at most {} rows",
                                   rows, bytes, kGuaranteedBlock, kGuaranteedBlock / sizeof(glm::vec4))});
}

/// Writes a compute shader if the language has them.
void write_lightmap_shader(const ShaderArguments& a, const ClusteredTransfer& transfer,
                           ConstantSource constants, Session& session) {
    const bool old = constants_for(a.language) == ConstantSource::texture;
    const bool draws = a.stage == Stage::fragment || old;
    if (constants == ConstantSource::block)
        warn_of_large_blocks(a.model, transfer);
    session.write(a.output, draws ? lightmap_shader(transfer, constants, a.language)
                                  : texel_shader(transfer, a.language, TexelFormat::rgba16, constants));
    print(fmt::format("{}: {} clusters, {} rows of constants; a {} shader over the texels of a map\n",
                      printable(a.output.string()), transfer.bases.clusters(), constant_rows(transfer.bases),
                      draws ? "fragment" : "compute"));
}

/// Writes the lookup, which has the same text in all languages, or the pass before it.
void write_volume_shader(const ShaderArguments& a, const SceneFile& model, Session& session) {
    if (!model.compressed_volume)
        throw Error(a.model.string() +
                    ": contains no compressed volume; run prt bake --volume and prt compress first");
    const CompressedVolume& volume = *model.compressed_volume;
    session.write(a.output, a.computes() ? texel_shader(volume.compressed.transfer, a.language)
                                         : volume_functions(volume, TexelFormat::rgba16, model.scene.origin));
    const VolumeAtlas atlas = atlas_of(volume.grid, volume.order);
    const glm::ivec3 texels = atlas.light_texels();
    print(fmt::format("{}: {}; light in a texture of {} x {} x {} texels RGBA16F\n",
                      printable(a.output.string()),
                      a.computes() ? fmt::format("a compute shader, {} x {} x {} groups", atlas.bricks.x,
                                                 atlas.bricks.y, atlas.bricks.z)
                                   : "functions, to be inserted after the version line of a shader",
                      texels.x, texels.y, texels.z));
}

/// Writes occlusion by moving objects, after the lookup of the volume that provides light.
void write_occluder_shader(const ShaderArguments& a, const SceneFile& model, Session& session) {
    const std::string lookup =
        model.compressed_volume
            ? volume_functions(*model.compressed_volume, TexelFormat::rgba16, model.scene.origin)
            : "";
    session.write(a.output, lookup + shader_part("prt_occluders.glsl", ""));
    print(fmt::format(
        "{}: functions, to be inserted after the version line of a shader; {}, lists of up to {} objects\n",
        printable(a.output.string()),
        model.compressed_volume ? "light by the volume of the file"
                                : "no light, as the file has no compressed volume",
        kMaxOccluders));
}

/// Writes lobe transfer that rotates with a skin, after the lookup of the volume that lights it.
void write_lobe_shader(const ShaderArguments& a, const SceneFile& model, Session& session) {
    if (!model.lobes)
        throw Error(a.model.string() + ": contains no lobes; run prt lobes first");
    const LobeModel& lobes = model.lobes->model;
    const std::string lookup =
        model.compressed_volume
            ? volume_functions(*model.compressed_volume, TexelFormat::rgba16, model.scene.origin)
            : "";
    session.write(a.output, lobe_functions(lobes, lookup));
    print(fmt::format(
        "{}: functions, to be inserted after the version line of a shader; {} of _PRT_LOBE_0 on, profiles in "
        "a uniform block of {} bytes{}\n",
        printable(a.output.string()),
        lobes.lobes == 1 ? "one attribute" : fmt::format("{} attributes", lobes.lobes),
        kMaxProfiles * sizeof(glm::vec4),
        model.compressed_volume ? ", light by the volume of the file" : ""));
}

/// Returns the origin of the positions of compressed transfer.
glm::dvec3 origin_of(const SceneFile& model) {
    return model.instanced ? model.instanced->stored.origin : model.scene.origin;
}

void write_instance_shader(const ShaderArguments& a, const SceneFile& model, Session& session) {
    if (!model.instanced)
        throw Error(a.model.string() + ": has no instances that share transfer, which --stage instances "
                                       "needs; bake with --instances shared");
    const ConstantSource constants = a.constants.value_or(constants_for(a.language));
    const ClusteredTransfer& transfer = model.instanced->compressed->transfer;
    session.write(a.output, instance_shader(transfer, constants, a.language, origin_of(model)));
    print(fmt::format("{}: {} instances; attributes from prt_instances.glsl, two of each instance from "
                      "prt::InstanceRelighter\n",
                      printable(a.output.string()), model.instanced->instances.size()));
}

void run(ShaderArguments a, Session& session) {
    a.reading.outputs = check_outputs({{a.output, "--output"}}, {a.model});
    const SceneFile model = load_scene_file(a.model, a.reading);
    if (a.stage == Stage::lobes)
        return write_lobe_shader(a, model, session);
    if (a.stage == Stage::occluders)
        return write_occluder_shader(a, model, session);
    const bool automatic = a.stage != Stage::fragment && a.stage != Stage::instances;
    if (a.stage == Stage::volume || a.stage == Stage::volume_compute ||
        (automatic && model.compressed_volume && !model.compressed))
        return write_volume_shader(a, model, session);
    const std::optional<CompressedTransfer>& compressed =
        model.instanced ? model.instanced->compressed : model.compressed;
    if (!compressed)
        throw Error(a.model.string() + ": contains no compressed transfer; run prt compress first");
    const ClusteredTransfer& transfer = compressed->transfer;
    if (a.stage == Stage::instances)
        return write_instance_shader(a, model, session);
    const ConstantSource constants = a.constants.value_or(constants_for(a.language));
    if (a.stage == Stage::fragment && !model.lightmap)
        throw Error(a.model.string() +
                    ": contains no lightmap, which --stage fragment needs; bake with --texels");
    if (model.lightmap && !a.computes())
        return write_lightmap_shader(a, transfer, constants, session);
    const std::string source = a.computes()
                                   ? constants_shader(transfer, a.language)
                                   : relight_shader(transfer, constants, a.language, origin_of(model));
    if (!a.computes() && constants == ConstantSource::block)
        warn_of_large_blocks(a.model, transfer);
    session.write(a.output, source);
    print(fmt::format("{}: {} clusters, {} rows of constants{}\n", printable(a.output.string()),
                      transfer.bases.clusters(), constant_rows(transfer.bases),
                      clusters_have_equal_layout(transfer.bases) && !a.computes()
                          ? "; all clusters have the same layout: no loop, no table of clusters"
                          : ""));
    if (!a.computes())
        print("to bind (kind, location or binding, name, type, content; - by name):\n" +
              binding_table(relight_bindings(transfer, constants, a.language), "  "));
}

} // namespace

void add_shader(CLI::App& app, Session& session) {
    CLI::App* command = app.add_subcommand("shader", "Write the shaders that relight a compressed model");
    auto& a = arguments_for<ShaderArguments>(
        command, [&session](const ShaderArguments& given) { run(given, session); });
    command
        ->add_option(
            "model", a.model,
            "model to relight: the output of prt compress or prt make, .glb\n"
            "                              --stage lobes: output of prt lobes; occluders: any .gltf or .glb")
        ->required()
        ->check(named);
    add_output(command, a.output,
               "write the GLSL source to this file\n"
               "text, with any suffix, as .vert; suffixes of other formats, as .glb or .json, are an error");
    choice(command, "--language", a.language, kLanguages,
           "shading language of the written source\n"
           "--stage compute and volume-compute: only glsl450 and vulkan\n"
           "--stage volume, occluders and lobes: no effect, the same functions for all languages",
           "glsl450");
    choice(command, "--constants", a.constants, kConstants,
           "GPU storage of the constants\n"
           "constants: 16-byte vectors that your program uploads for each lighting\n"
           "no effect on stages except vertex, fragment, instances, and on files with only a volume\n"
           "default: buffer if the language has it",
           "buffer, else texture");
    choice(command, "--stage", a.stage, kStages,
           "shader to write\n"
           "if the file has only a volume: vertex acts as volume, compute as volume-compute",
           "vertex")
        ->type_name("STAGE");
    add_reading(command, a.reading);
}

} // namespace prt::cli
