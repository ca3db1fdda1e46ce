// Memory limit for reading a file.
#include "gltf/allowance.h"

#include "prt/support/error.h"

namespace prt {

void check_allowed(double bytes, std::size_t file_bytes, const std::string& what) {
    constexpr double kAlways = 256e6, kPerByte = 64, kMegabyte = 1e6;
    const double most = kAlways + kPerByte * static_cast<double>(file_bytes);
    if (bytes <= most)
        return;
    const auto megabytes = [](double value) { // avoids meaningless digits
        return value < 1e18 ? std::to_string(static_cast<unsigned long long>(value / kMegabyte)) + " MB"
                            : std::string("a million million MB");
    };
    throw Error(what + " would take " + megabytes(bytes) + ", more than the " + megabytes(most) +
                " that a file of " + std::to_string(file_bytes) + " bytes may take");
}

} // namespace prt
