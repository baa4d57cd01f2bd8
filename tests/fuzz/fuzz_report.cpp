// Report descriptors: any bytes give fields or an error. The fields then read and write reports of any length
// within bounds.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "haptics/device/space_mouse.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt::device;
    const auto descriptor = parse_report_descriptor({data, size});
    if (!descriptor) {
        if (descriptor.error().message().empty()) std::abort();
        return 0;
    }
    std::vector<std::uint8_t> report(size % 71);
    for (std::size_t i = 0; i < report.size(); ++i) report[i] = data[i % size];
    for (const ReportField& field : descriptor->fields) {
        if ((field.bit + field.bits + 7) / 8 > report_size(*descriptor, field.kind, field.report))
            std::abort();
        const auto value = value_of(field, report);
        if (value && write_value(field, *value, report) && *value >= field.low && *value <= field.high &&
            value_of(field, report) != value)
            std::abort();
        if (value && !(normalized_value(field, *value) >= -1.0 && normalized_value(field, *value) <= 1.0))
            std::abort();
    }
    if (const auto layout = six_axis_layout(*descriptor)) {
        SixAxisState state;
        decode_report(*layout, report, state);
    }
    return 0;
}
