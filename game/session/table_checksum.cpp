#include "game/session/table_checksum.hpp"

#include <bit>
#include <cmath>
#include <limits>

#include "engine/base/hash.hpp"

namespace bolt::session {

namespace {

// The hash of one table row: typed values in a fixed byte order.
class Hash {
  public:
    explicit Hash(std::string_view table) { add(table); }

    Hash& add(std::uint64_t value) {
        for (unsigned i = 0; i < 8; ++i) hash_.add(static_cast<std::uint8_t>(value >> (8 * i)));
        return *this;
    }
    Hash& add(int value) { return add(static_cast<std::uint64_t>(value)); }
    Hash& add(double value) {
        if (std::isnan(value)) value = std::numeric_limits<double>::quiet_NaN();
        return add(std::bit_cast<std::uint64_t>(value + 0.0));
    }
    Hash& add(std::string_view text) {
        add(std::uint64_t{text.size()});
        hash_.add(text);
        return *this;
    }

    [[nodiscard]] std::uint64_t value() const { return hash_.value(); }

  private:
    Fnv1a hash_;
};

}  // namespace

std::uint64_t sum_of_meta(std::string_view key, std::string_view value) {
    return Hash("meta").add(key).add(value).value();
}

std::uint64_t sum_of_chunk(std::uint64_t first_tick, std::uint64_t count) {
    return Hash("tick_chunk").add(first_tick).add(count).value();
}

std::uint64_t sum_of(const ObstacleName& obstacle) {
    return Hash("obstacle")
        .add(std::int32_t{file_number(obstacle.id).value_or(-1)})
        .add(std::string_view(obstacle.name))
        .value();
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

}  // namespace bolt::session
