// hostile_files FOLDER FIRST COUNT: writes damaged shipped files, FOLDER/SEED.glb, for readers in other
// languages.

#include "damage.h"
#include "shipped_files.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <string>

int main(int count, char** arguments) {
    using namespace prt::test;
    if (count != 4)
        return std::fprintf(stderr, "usage: hostile_files FOLDER FIRST COUNT\n"), 2;
    const std::filesystem::path folder = arguments[1];
    std::filesystem::create_directories(folder);
    std::vector<ShippedFile> files = shipped_files();
    std::ranges::move(volume_files(), std::back_inserter(files));
    const auto first = static_cast<std::uint32_t>(std::strtoul(arguments[2], nullptr, 10)),
               cases = static_cast<std::uint32_t>(std::strtoul(arguments[3], nullptr, 10));
    for (const ShippedFile& shipped : files)
        shipped.file.write(folder / ("whole." + shipped.name + ".glb"));
    for (std::uint32_t seed = first; seed < first + cases; ++seed)
        damaged(files[seed % files.size()].file, seed).write(folder / (std::to_string(seed) + ".glb"));
}
