#include "game/session/timing_rows.hpp"

namespace bolt::session {

namespace {

constexpr std::size_t entry_bytes = 4 + 8;

void put(std::vector<std::byte>& out, std::uint64_t value, unsigned bytes) {
    for (unsigned i = 0; i < bytes; ++i) out.push_back(static_cast<std::byte>(value >> (8 * i)));
}

std::uint64_t get(std::span<const std::byte> in) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < in.size(); ++i) value |= static_cast<std::uint64_t>(in[i]) << (8 * i);
    return value;
}

TimingRow row_of(const char* name, const servo::Histogram& h) {
    TimingRow row{name, h.count, h.least, h.greatest, h.sum, {}};
    for (std::size_t i = 0; i < h.bins; ++i) {
        if (h.counts[i] == 0) continue;
        put(row.bins, i, 4);
        put(row.bins, h.counts[i], 8);
    }
    return row;
}

bool read_bins(std::span<const std::byte> in, servo::Histogram& h) {
    if (in.size() % entry_bytes != 0) return false;
    std::uint64_t sum = 0;
    for (; !in.empty(); in = in.subspan(entry_bytes)) {
        const std::uint64_t bin = get(in.first(4)), count = get(in.subspan(4, 8));
        if (bin >= h.bins || count > h.count) return false;
        h.counts[bin] = count;
        sum += count;
    }
    return sum == h.count;
}

}  // namespace

std::array<TimingRow, timing_rows> rows_of(const servo::Timing& timing) {
    return {row_of("wake_up", timing.wake_up), row_of("compute", timing.compute),
            row_of("period", timing.period), TimingRow{"missed", timing.missed, 0, 0, 0.0, {}}};
}

bool take_row(servo::Timing& timing, const TimingRow& row) {
    if (row.name == "missed") {
        timing.missed = row.count;
        return row.bins.empty();
    }
    servo::Histogram* const h = row.name == "wake_up"   ? &timing.wake_up
                                : row.name == "compute" ? &timing.compute
                                : row.name == "period"  ? &timing.period
                                                        : nullptr;
    if (h == nullptr) return false;
    *h = {};
    h->count = row.count;
    h->least = row.least;
    h->greatest = row.greatest;
    h->sum = row.sum;
    if (row.name == "wake_up") timing.ticks = row.count;
    return read_bins(row.bins, *h);
}

}  // namespace bolt::session
