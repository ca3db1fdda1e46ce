#include "commands.h"

#include "inputs.h"
#include "prt/error.h"
#include "prt/file.h"

#include <fmt/core.h>

namespace prt::cli {

void run(const ShaderArguments& a, Interrupt&) {
    const Model model = load_model(a.model);
    if (!model.compressed)
        throw Error(a.model.string() + ": holds no compressed transfer; run prt compress first");
    const ClusteredTransfer& transfer = model.compressed->transfer;
    const std::string source = a.compute ? constants_shader(transfer, a.language)
                                         : relight_shader(transfer, a.constants, a.language);
    OutputFile output(a.output);
    output.write(source);
    output.commit();
    fmt::print("{}: {} clusters, {} rows of constants, attributes from prt_exit_radiance.glsl\n",
               a.output.string(), transfer.bases.clusters(), constant_rows(transfer.bases));
}

} // namespace prt::cli
