// Report descriptors written item by item: HID 1.11, section 6.2.2.
#pragma once

#include <cstdint>
#include <vector>

namespace bolt::emulate {

class Items {
  public:
    // `head` with the size bits left 0; as many bytes as the value needs, or as many as are asked for.
    Items& item(unsigned head, std::int64_t value, int bytes = 0) {
        const bool fits_one = value >= -128 && value <= 127, fits_two = value >= -32768 && value <= 32767;
        const int n = bytes != 0 ? bytes : fits_one ? 1 : fits_two ? 2 : 4;
        out.push_back(static_cast<std::uint8_t>(head | (n == 4 ? 3U : static_cast<unsigned>(n))));
        for (int i = 0; i < n; ++i)
            out.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
        return *this;
    }
    Items& page(int p) { return item(0x04, p, p > 255 ? 2 : 1); }
    Items& usage(int u) { return item(0x08, u, u > 255 ? 2 : 1); }
    Items& usages(int from, int to) { return item(0x18, from, 1).item(0x28, to, 1); }
    Items& range(std::int64_t low, std::int64_t high) { return item(0x14, low).item(0x24, high); }
    Items& fields(int count, int bits) { return item(0x94, count, 1).item(0x74, bits, 1); }
    Items& id(int i) { return item(0x84, i, 1); }
    Items& input(int flags) { return item(0x80, flags, 1); }
    Items& output(int flags) { return item(0x90, flags, 1); }
    Items& feature(int flags) { return item(0xb0, flags, 1); }
    Items& begin(int type) { return item(0xa0, type, 1); }
    Items& end() {
        out.push_back(0xc0);
        return *this;
    }
    std::vector<std::uint8_t> out;
};

}  // namespace bolt::emulate
