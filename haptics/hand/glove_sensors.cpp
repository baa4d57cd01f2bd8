#include "haptics/hand/glove_sensors.hpp"

#include <algorithm>

namespace bolt::hand {

namespace {

constexpr bool is_dij(Sensor s) {
    return s == Sensor::index_dij || s == Sensor::middle_dij || s == Sensor::ring_dij ||
           s == Sensor::little_dij;
}

constexpr std::array<Sensor, 22> all = [] {
    std::array<Sensor, 22> sensors{};
    for (std::size_t i = 0; i < sensors.size(); ++i) sensors[i] = static_cast<Sensor>(i);
    return sensors;
}();

constexpr std::array<Sensor, 18> without_dij = [] {
    std::array<Sensor, 18> sensors{};
    std::size_t n = 0;
    for (const Sensor s : all)
        if (!is_dij(s)) sensors[n++] = s;
    return sensors;
}();

constexpr std::array<const char*, sensor_count> names = {
    "thumb roll",       "thumb MPJ",  "thumb IJ",       "thumb abduction", "index MPJ",        "index PIJ",
    "index DIJ",        "middle MPJ", "middle PIJ",     "middle DIJ",      "middle abduction", "ring MPJ",
    "ring PIJ",         "ring DIJ",   "ring abduction", "little MPJ",      "little PIJ",       "little DIJ",
    "little abduction", "palm arch",  "wrist pitch",    "wrist yaw"};

}  // namespace

std::span<const Sensor> sensors_of(std::size_t count) {
    if (count == all.size()) return all;
    if (count == without_dij.size()) return without_dij;
    return {};
}

const char* name_of(Sensor sensor) { return names[index(sensor)]; }

}  // namespace bolt::hand
