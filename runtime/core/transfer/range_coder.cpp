// Carry propagation and final bytes of the range coder.
#include "runtime/core/transfer/range_coder.h"

namespace prt {

void RangeEncoder::shift_out() {
    if (low_ >> 32)
        for (std::size_t i = bytes_.size(); i-- > 0;) {
            const auto carried = static_cast<std::uint8_t>(std::to_integer<std::uint8_t>(bytes_[i]) + 1);
            bytes_[i] = std::byte{carried};
            if (carried != 0)
                break;
        }
    bytes_.push_back(static_cast<std::byte>(low_ >> 24 & 0xff));
    low_ = (low_ & 0xffffff) << 8;
}

std::vector<std::byte> RangeEncoder::finish() {
    for (int i = 0; i < 4; ++i)
        shift_out();
    return std::move(bytes_);
}

} // namespace prt
