#include "tools/emulate/hid.hpp"

namespace bolt::emulate {

std::vector<Bytes> with_faults(std::vector<Bytes> reports, const HidFaults& faults, Random& random) {
    for (Bytes& report : reports) {
        if (report.size() > 1 && random.chance(faults.cut))
            report.resize(1 + random.bits() % (report.size() - 1));
        if (random.chance(faults.strange)) report[0] = 0x77;
        if (report.size() > 1 && random.chance(faults.changed))
            report[1 + random.bits() % (report.size() - 1)] = static_cast<std::uint8_t>(random.bits());
    }
    return reports;
}

}  // namespace bolt::emulate
