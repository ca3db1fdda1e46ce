#include "commands/commands.h"

#include "inputs.h"
#include "outputs.h"
#include "prt/support/error.h"
#include "prt/support/file.h"

#include <fmt/core.h>
#include <glm/vec4.hpp>

#include <algorithm>

namespace prt::cli {

namespace {

/// Storage buffers where the language has them; there is always room in a texture.
ConstantSource constants_for(ShaderLanguage language) {
    const bool old = language == ShaderLanguage::glsl330 || language == ShaderLanguage::essl300;
    return old ? ConstantSource::texture : ConstantSource::buffer;
}

/// What every OpenGL, OpenGL ES and Vulkan guarantees, and few of them exceed on phones.
constexpr std::size_t kGuaranteedBlock = 16384;

/// A block larger than guaranteed compiles, and fails where it is linked.
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

} // namespace

void run(const ShaderArguments& a, Interrupt&) {
    check_outputs({{a.output, "--output"}}, {a.model});
    const Model model = load_model(a.model);
    if (!model.compressed)
        throw Error(a.model.string() + ": holds no compressed transfer; run prt compress first");
    const ClusteredTransfer& transfer = model.compressed->transfer;
    const ConstantSource constants = a.constants.value_or(constants_for(a.language));
    const std::string source =
        a.compute ? constants_shader(transfer, a.language) : relight_shader(transfer, constants, a.language);
    if (!a.compute && constants == ConstantSource::block)
        warn_of_large_blocks(a.model, transfer);
    OutputFile output(a.output);
    output.write(source);
    output.commit();
    fmt::print("{}: {} clusters, {} rows of constants, attributes from prt_exit_radiance.glsl\n",
               a.output.string(), transfer.bases.clusters(), constant_rows(transfer.bases));
}

} // namespace prt::cli
