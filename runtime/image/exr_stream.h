#pragma once

// Input stream for OpenEXR.

#include <OpenEXR/Iex.h>
#include <OpenEXR/ImfIO.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

namespace prt {

/// Provides a file in memory to OpenEXR.
class MemoryStream : public Imf::IStream {
public:
    explicit MemoryStream(std::span<const std::byte> file) : Imf::IStream("EXR"), file_(file) {}

    bool read(char to[], int count) override {
        if (count < 0 || position_ > file_.size() ||
            static_cast<std::size_t>(count) > file_.size() - position_)
            throw Iex::InputExc("the data ends too early");
        std::memcpy(to, file_.data() + position_, static_cast<std::size_t>(count));
        position_ += static_cast<std::size_t>(count);
        return position_ < file_.size();
    }
    std::uint64_t tellg() override { return position_; }
    void seekg(std::uint64_t position) override { position_ = position; }

private:
    std::span<const std::byte> file_;
    std::size_t position_ = 0;
};

} // namespace prt
