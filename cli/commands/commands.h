#pragma once

#include "arguments.h"
#include "session.h"

namespace prt::cli {

// Each does what its subcommand says and throws `Error` when it cannot.
void run(const BakeArguments& arguments, Interrupt& interrupt);
void run(const CompressArguments& arguments, Interrupt& interrupt);
void run(const EvaluateArguments& arguments, Interrupt& interrupt);
void run(const ProjectArguments& arguments, Interrupt& interrupt);
void run(const RenderArguments& arguments, Interrupt& interrupt);
void run(const BenchArguments& arguments, Interrupt& interrupt);
void run(const ShaderArguments& arguments, Interrupt& interrupt);
void run(const InfoArguments& arguments, Interrupt& interrupt);

} // namespace prt::cli
