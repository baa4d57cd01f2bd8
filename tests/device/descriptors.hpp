// Report descriptors as devices of a class have them, written item by item.
#pragma once

#include <cstdint>
#include <vector>

namespace bolt::test {

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
    Items& begin(int type) { return item(0xa0, type, 1); }
    Items& end() {
        out.push_back(0xc0);
        return *this;
    }
    std::vector<std::uint8_t> out;
};

// Three reports: pushes, turns, buttons; the older pucks.
inline std::vector<std::uint8_t> puck_in_three() {
    Items d;
    d.page(1).usage(8).begin(1);
    d.begin(0).id(1).range(-350, 350).usage(0x30).usage(0x31).usage(0x32).fields(3, 16).input(6).end();
    d.begin(0).id(2).usage(0x33).usage(0x34).usage(0x35).fields(3, 16).input(6).end();
    d.begin(2).id(3).page(9).usages(1, 2).range(0, 1).fields(2, 1).input(2).fields(14, 1).input(3).end();
    d.begin(2).id(4).page(8).usage(0x4b).range(0, 1).fields(1, 1).output(2).fields(1, 7).output(3).end();
    return d.end().out;
}

// All six axes in one report; the newer ones.
inline std::vector<std::uint8_t> puck_in_one() {
    Items d;
    d.page(1).usage(8).begin(1);
    d.begin(0).id(1).range(-350, 350).usages(0x30, 0x35).fields(6, 16).input(2).end();
    d.begin(0).id(3).page(9).usages(1, 15).range(0, 1).fields(15, 1).input(2).fields(1, 1).input(3).end();
    return d.end().out;
}

// A mouse without report ids.
inline std::vector<std::uint8_t> mouse() {
    Items d;
    d.page(1).usage(2).begin(1).usage(1).begin(0);
    d.page(9).usages(1, 3).range(0, 1).fields(3, 1).input(2).fields(1, 5).input(1);
    d.page(1).usage(0x30).usage(0x31).range(-127, 127).fields(2, 8).input(6);
    return d.end().end().out;
}

}  // namespace bolt::test
