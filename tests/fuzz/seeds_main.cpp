// fuzz_seeds FOLDER: writes the seed corpora of all targets, one folder per target, and next to it
// CORPUS.list with the names of its files, separated by commas. libFuzzer reads this list without writing its
// findings to the corpus.
#include "seeds.h"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

namespace {

constexpr const char* kCorpora[] = {"models",  "exr",   "hdr",        "pictures", "mesh",
                                    "meshopt", "light", "round_trip", "words"};

void write_list(const prt::fuzz::Path& corpus) {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator(corpus))
        files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    std::ofstream list(corpus.string() + ".list");
    for (std::size_t i = 0; i < files.size(); ++i)
        list << (i > 0 ? "," : "") << files[i];
}

} // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fprintf(stderr, "fuzz_seeds FOLDER\n");
        return 2;
    }
    const prt::fuzz::Path folder = arguments[1];
    for (const char* corpus : kCorpora)
        std::filesystem::create_directories(folder / corpus);
    prt::fuzz::write_model_seeds(folder);
    prt::fuzz::write_environment_seeds(folder);
    prt::fuzz::write_other_seeds(folder);
    for (const char* corpus : kCorpora)
        write_list(folder / corpus);
}
