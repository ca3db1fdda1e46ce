// Memory limit for reading a file.
#include "runtime/load/allowance.h"

#include "prt/core/error.h"

namespace prt {

namespace {

std::string megabytes(double bytes) { // whole megabytes: more digits are meaningless
    constexpr double kMegabyte = 1e6;
    return bytes < 1e18 ? std::to_string(static_cast<unsigned long long>(bytes / kMegabyte)) + " MB"
                        : std::string("more than 1e12 MB");
}

double allowed(std::size_t file_bytes) {
    constexpr double kAlways = 256e6, kPerByte = 64;
    return kAlways + kPerByte * static_cast<double>(file_bytes);
}

std::string excess(double bytes, std::size_t file_bytes, const std::string& what) {
    return what + " would need " + megabytes(bytes) + " of memory; the limit for a file of " +
           std::to_string(file_bytes) + " bytes is " + megabytes(allowed(file_bytes));
}

} // namespace

void check_allowed(double bytes, std::size_t file_bytes, const std::string& what) {
    if (!(bytes <= allowed(file_bytes)))
        throw Error(excess(bytes, file_bytes, what));
}

void check_scene_allowed(double bytes, const GltfData& data, const std::string& what) {
    const double limit = data.scene_limit;
    if (bytes <= (limit > 0 ? limit : allowed(data.file_bytes)))
        return;
    if (limit > 0)
        throw Error(what + " would need " + megabytes(bytes) + " of memory; the limit is " +
                    megabytes(limit) + ", raise it with --memory-limit");
    throw Error(excess(bytes, data.file_bytes, what) + data.limit_remedy);
}

} // namespace prt
