#include "game/record/seal.hpp"

#include <bit>
#include <cmath>
#include <limits>

namespace bolt::record {

namespace {

// FNV-1a, 64 bits (Fowler, Noll, Vo). Each step can be undone, so one changed byte always changes the sum.
class Hash {
  public:
    explicit Hash(std::string_view table) { add(table); }

    Hash& add(std::uint64_t value) {
        for (unsigned i = 0; i < 8; ++i) step(static_cast<std::uint8_t>(value >> (8 * i)));
        return *this;
    }
    Hash& add(int value) { return add(static_cast<std::uint64_t>(value)); }
    Hash& add(double value) {
        if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
        return add(std::bit_cast<std::uint64_t>(value + 0.0));
    }
    Hash& add(std::string_view text) {
        add(std::uint64_t{text.size()});
        for (const char c : text) step(static_cast<std::uint8_t>(c));
        return *this;
    }

    [[nodiscard]] std::uint64_t value() const { return value_; }

  private:
    void step(std::uint8_t byte) { value_ = (value_ ^ byte) * 0x100000001B3ULL; }

    std::uint64_t value_ = 0xCBF29CE484222325ULL;
};

}  // namespace

std::uint64_t sum_of_meta(std::string_view key, std::string_view value) {
    return Hash("meta").add(key).add(value).value();
}

std::uint64_t sum_of_chunk(std::uint64_t first_tick, std::uint64_t count) {
    return Hash("tick_chunk").add(first_tick).add(count).value();
}

std::uint64_t sum_of(const ObstacleName& obstacle) {
    return Hash("obstacle").add(obstacle.id).add(std::string_view(obstacle.name)).value();
}

std::uint64_t sum_of(const TimingRow& row) {
    const std::string_view bins(reinterpret_cast<const char*>(row.bins.data()), row.bins.size());
    Hash hash("servo_time");
    hash.add(std::string_view(row.name)).add(row.count).add(row.least).add(row.greatest).add(row.sum);
    return hash.add(bins).value();
}

std::uint64_t sum_of(std::uint64_t ordinal, const lesson::Event& event) {
    Hash hash("event");
    hash.add(ordinal).add(event.tick).add(std::string_view(event.kind)).add(event.joint);
    return hash.add(event.value).add(std::string_view(event.text)).value();
}

std::uint64_t sum_of(std::uint64_t ordinal, const lesson::JointResult& result) {
    Hash hash("joint_result");
    hash.add(ordinal).add(std::string_view(result.id));
    hash.add(result.torque).add(result.angle).add(result.clamp).add(result.clamp_at_release);
    hash.add(static_cast<int>(result.torque_verdict)).add(static_cast<int>(result.angle_verdict));
    hash.add(static_cast<int>(result.overall)).add(static_cast<int>(result.condition));
    return hash.add(result.strokes).add(result.rehits).add(result.order_errors).value();
}

std::uint64_t sum_of(std::uint64_t ordinal, const lesson::ScoreReason& reason) {
    return Hash("score_reason").add(ordinal).add(reason.points).add(std::string_view(reason.text)).value();
}

}  // namespace bolt::record
