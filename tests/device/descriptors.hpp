// Typical report descriptors of each device class, built item by item.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/emulate/hid_device.hpp"

namespace bolt::test {

using emulate::DescriptorBuilder;

// Older pucks: separate reports for translation, rotation and buttons.
inline std::vector<std::uint8_t> puck_in_three() {
    DescriptorBuilder d;
    d.page(1).usage(8).begin(1);
    d.begin(0).id(1).range(-350, 350).usage(0x30).usage(0x31).usage(0x32).fields(3, 16).input(6).end();
    d.begin(0).id(2).usage(0x33).usage(0x34).usage(0x35).fields(3, 16).input(6).end();
    d.begin(2).id(3).page(9).usages(1, 2).range(0, 1).fields(2, 1).input(2).fields(14, 1).input(3).end();
    d.begin(2).id(4).page(8).usage(0x4b).range(0, 1).fields(1, 1).output(2).fields(1, 7).output(3).end();
    return d.end().out;
}

// Newer pucks: all six axes in one report.
inline std::vector<std::uint8_t> puck_in_one() {
    DescriptorBuilder d;
    d.page(1).usage(8).begin(1);
    d.begin(0).id(1).range(-350, 350).usages(0x30, 0x35).fields(6, 16).input(2).end();
    d.begin(0).id(3).page(9).usages(1, 15).range(0, 1).fields(15, 1).input(2).fields(1, 1).input(3).end();
    return d.end().out;
}

// A mouse without report ids.
inline std::vector<std::uint8_t> mouse() {
    DescriptorBuilder d;
    d.page(1).usage(2).begin(1).usage(1).begin(0);
    d.page(9).usages(1, 3).range(0, 1).fields(3, 1).input(2).fields(1, 5).input(1);
    d.page(1).usage(0x30).usage(0x31).range(-127, 127).fields(2, 8).input(6);
    return d.end().end().out;
}

}  // namespace bolt::test
