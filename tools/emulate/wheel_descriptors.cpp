#include "tools/emulate/wheel_descriptors.hpp"

#include "tools/emulate/descriptor_writer.hpp"

namespace bolt::emulate {

namespace {

constexpr int variable = 2, array = 0, padding = 3;
constexpr int desktop = 1, simulation = 2, buttons = 9, pid = 0xf;

Items& value(Items& d, int usage, std::int64_t low, std::int64_t high, int bits) {
    return d.usage(usage).range(low, high).fields(1, bits).output(variable);
}

// Which axes pull, and from where: bits, then a slot of `bits` for two of them.
void directions(Items& d, std::int64_t high, int bits) {
    d.usage(0x55)
        .begin(2)
        .page(desktop)
        .usage(0x30)
        .usage(0x31)
        .range(0, 1)
        .fields(2, 1)
        .output(variable)
        .end();
    d.page(pid).usage(0x56).fields(1, 1).output(variable).fields(5, 1).output(padding);
    d.usage(0x57).begin(2).item(0x08, 0xa0001, 4).item(0x08, 0xa0002, 4);
    d.range(0, high).fields(2, bits).output(variable).end();
}

}  // namespace

Bytes board_descriptor() {
    Items d;
    d.page(desktop).usage(4).begin(1).begin(0).id(1);
    d.page(buttons).usages(1, 64).range(0, 1).fields(64, 1).input(variable).page(desktop);
    for (const int axis : {0x30, 0x31, 0x32, 0x33, 0x34, 0x35, 0x37, 0x36}) d.usage(axis);
    d.range(-32767, 32767).fields(8, 16).input(variable).end();

    for (const bool out : {true, false}) {
        if (out) d.page(0xff00).usage(0).begin(1);
        d.id(0xa1);
        int usage = 0;
        for (const int bits : {8, 16, 8, 32, 64, 64}) {
            d.usage(++usage).range(0, 4).fields(1, bits);
            out ? d.output(variable) : d.input(variable);
        }
        if (!out) d.end();
    }

    d.page(pid).usage(0x92).begin(2).id(2);
    for (const int state : {0x9f, 0xa0, 0xa4, 0xa6, 0x94}) d.usage(state);
    d.range(0, 1).fields(5, 1).input(variable).fields(3, 1).input(padding).end();

    d.usage(0x21).begin(2).id(1);
    value(d, 0x22, 1, 40, 8).usage(0x25).begin(2);
    for (const int type : {0x26, 0x27, 0x30, 0x31, 0x32, 0x33, 0x34, 0x40, 0x41, 0x42, 0x43}) d.usage(type);
    d.range(1, 11).fields(1, 8).output(array).end();
    d.usage(0x50).usage(0x54).usage(0x51).usage(0xa7).range(0, 32767).fields(4, 16).output(variable);
    value(d, 0x52, 0, 255, 8);
    value(d, 0x53, 1, 8, 8);
    directions(d, 35900, 16);
    d.end();

    d.usage(0x73).begin(2).id(5);
    value(d, 0x22, 1, 40, 8);
    value(d, 0x70, -32767, 32767, 16).end();

    d.usage(0x77).begin(2).id(10);
    value(d, 0x22, 1, 40, 8).usage(0x78).begin(2).usage(0x79).usage(0x7a).usage(0x7b);
    d.range(1, 3).fields(1, 8).output(array).end();
    value(d, 0x7c, 0, 255, 8).end();

    d.usage(0x90).begin(2).id(11);
    value(d, 0x22, 1, 40, 8).end();

    d.usage(0x95).begin(2).id(12).usage(0x96).begin(2);
    for (int what = 0x97; what <= 0x9c; ++what) d.usage(what);
    d.range(1, 6).fields(8, 1).output(variable).end().end();

    d.usage(0x7d).begin(2).id(13);
    value(d, 0x7e, 0, 255, 8).end();

    d.usage(0xab).begin(2).id(17).usage(0x25).begin(2);
    for (const int type : {0x26, 0x27, 0x30, 0x31, 0x32, 0x33, 0x34, 0x40, 0x41, 0x42, 0x43}) d.usage(type);
    d.range(1, 11).fields(1, 8).feature(array).end();
    d.page(desktop).usage(0x3b).range(0, 511).fields(1, 10).feature(variable).fields(1, 6).feature(1).end();

    d.page(pid).usage(0x89).begin(2).id(18).usage(0x22).range(1, 40).fields(1, 8).feature(variable);
    d.usage(0x8b).begin(2).usage(0x8c).usage(0x8d).usage(0x8e).range(1, 3).fields(1, 8).feature(array).end();
    d.usage(0xac).range(0, 65535).fields(1, 16).feature(array).end();
    return d.end().out;
}

Bytes other_wheel_descriptor() {
    Items d;
    d.page(desktop).usage(4).begin(1).id(1);
    d.page(simulation).usage(0xc8).range(0, 65535).fields(1, 16).input(variable);
    d.page(buttons).usages(1, 8).range(0, 1).fields(8, 1).input(variable);

    d.page(pid).usage(0x21).begin(2).id(0x11);
    value(d, 0x22, 1, 8, 8)
        .usage(0x25)
        .begin(2)
        .usage(0x40)
        .usage(0x26)
        .range(1, 2)
        .fields(1, 8)
        .output(array)
        .end();
    value(d, 0x50, 0, 65535, 16);
    value(d, 0x52, 0, 100, 8);
    directions(d, 255, 8);
    d.end();

    d.usage(0x73).begin(2).id(0x15);
    value(d, 0x70, -10000, 10000, 16).end();

    d.usage(0x77).begin(2).id(0x1a);
    value(d, 0x22, 1, 8, 8)
        .usage(0x78)
        .begin(2)
        .usage(0x7b)
        .usage(0x79)
        .range(1, 2)
        .fields(1, 8)
        .output(array)
        .end();
    d.end();

    d.usage(0x96).begin(2).id(0x1c).usage(0x9a).usage(0x99).usage(0x97).usage(0x98);
    d.range(1, 4).fields(1, 8).output(array).end();

    d.usage(0x7d).begin(2).id(0x1d);
    value(d, 0x7e, 0, 100, 8).end();
    return d.end().out;
}

}  // namespace bolt::emulate
