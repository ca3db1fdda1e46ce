// Reads the memory of the machine and the limits of its control groups.

#include "bake/plan/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <unistd.h>
#endif

namespace prt {
namespace {

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// Returns the number in `file`; no limit if there is no number ("max").
double limit_in(const std::filesystem::path& file) {
    std::ifstream stream(file);
    double bytes = 0;
    return stream >> bytes ? bytes : kNoLimit;
}

/// Returns the smallest limit in files called `name` from `folder` up to `top`. A container sees its own
/// group at the top.
double min_limit(std::filesystem::path folder, const std::filesystem::path& top, const char* name) {
    double least = limit_in(top / name);
    for (; folder != top && folder.has_relative_path(); folder = folder.parent_path())
        least = std::min(least, limit_in(folder / name));
    return least;
}

} // namespace

double control_group_limit(const std::filesystem::path& membership, const std::filesystem::path& mounted) {
    std::ifstream stream(membership);
    double least = kNoLimit;
    for (std::string line; std::getline(stream, line);) { // format: hierarchy:controllers:/path
        const std::size_t first = line.find(':'), second = line.find(':', first + 1);
        if (first == std::string::npos || second == std::string::npos)
            continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        const std::filesystem::path path = std::filesystem::path(line.substr(second + 1)).relative_path();
        if (controllers.empty())
            least =
                std::min(least, min_limit(path.empty() ? mounted : mounted / path, mounted, "memory.max"));
        else if (("," + controllers + ",").find(",memory,") != std::string::npos) {
            const std::filesystem::path top = mounted / "memory";
            least = std::min(least, min_limit(path.empty() ? top : top / path, top, "memory.limit_in_bytes"));
        }
    }
    return least;
}

double available_memory() {
#if defined(_SC_PHYS_PAGES) && defined(_SC_PAGE_SIZE)
    const double physical =
        static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
    return std::min(physical, control_group_limit("/proc/self/cgroup", "/sys/fs/cgroup"));
#else
    return 0;
#endif
}

} // namespace prt
