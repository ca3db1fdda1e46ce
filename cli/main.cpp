#include "commands/commands.h"
#include "prt/support/error.h"

#include <fmt/core.h>

#include <new>

int main(int argc, char** argv) {
    using namespace prt::cli;
    Interrupt interrupt;
    const auto parsed = parse_arguments(argc, argv);
    if (const int* status = std::get_if<int>(&parsed))
        return *status;
    try {
        std::visit([&](const auto& arguments) { run(arguments, interrupt); }, std::get<Arguments>(parsed));
        if (std::fflush(stdout) != 0)
            throw prt::Error("standard output cannot be written");
        return 0;
    } catch (const std::bad_alloc&) {
        fmt::print(stderr, "prt: error: there is not enough memory\n");
    } catch (const std::exception& error) {
        fmt::print(stderr, "prt: error: {}\n", error.what());
    }
    return 1;
}
