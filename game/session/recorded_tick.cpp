#include "game/session/recorded_tick.hpp"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>

namespace bolt::session {

namespace {

// The first number of a nut, and the number of fixed obstacles numbered below it. It is part of the file
// format and must not change.
constexpr std::int32_t first_nut = 1000;

}  // namespace

std::optional<std::int16_t> file_number(collision::ObstacleId obstacle) {
    const auto index = static_cast<std::int32_t>(obstacle.index());
    if (obstacle.is_none()) return std::int16_t{-1};
    if (obstacle.index() >= (obstacle.is_nut() ? max_nuts : max_fixed)) return std::nullopt;
    if (obstacle.is_nut()) return static_cast<std::int16_t>(first_nut + index);
    return static_cast<std::int16_t>(index < first_nut ? index : first_nut - 2 - index);
}

collision::ObstacleId obstacle_of_number(std::int16_t number) {
    if (number == -1) return {};
    if (number >= first_nut) return collision::ObstacleId::nut(static_cast<std::size_t>(number - first_nut));
    return collision::ObstacleId::fixed(
        static_cast<std::size_t>(number >= 0 ? number : first_nut - 2 - number));
}

TickRecord make_record(const servo::TickInput& input, const servo::Output& output) {
    TickRecord record;
    record.commanded_tool = input.commanded_tool;
    record.grip = static_cast<std::uint8_t>(input.grip);
    record.flags = static_cast<std::uint8_t>(
        (input.dead_man ? flag_dead_man : 0) | (input.fresh ? 0 : flag_no_sample) |
        (input.stop ? flag_stop : 0) | (input.reset ? flag_reset : 0) | std::min<int>(input.missed, 15) << 4);
    record.guided_joint = input.guided_joint;
    for (int i = 0; i < 3; ++i) {
        record.force[i] = static_cast<float>(output.force[i]);
        record.torque[i] = static_cast<float>(output.torque[i]);
    }
    record.joint = output.joint;
    record.stage = static_cast<std::uint8_t>(output.stage);
    record.wrench_torque = static_cast<float>(output.wrench_torque);
    record.nut_angle = static_cast<float>(output.nut_angle);
    record.clamp = static_cast<float>(output.clamp);
    record.contacts = output.contacts;
    record.touched = output.touched;
    record.fault = static_cast<std::uint8_t>(output.fault);
    record.checkpoint_action = input.checkpoint_action;
    record.set_torque = input.set_torque;
    record.tool = input.tool;
    record.second_wrench = input.second_wrench;
    return record;
}

servo::TickInput input_of(const TickRecord& record) {
    servo::TickInput input;
    input.commanded_tool = record.commanded_tool;
    input.grip = static_cast<servo::Grip>(record.grip);
    input.dead_man = (record.flags & flag_dead_man) != 0;
    input.fresh = (record.flags & flag_no_sample) == 0;
    input.stop = (record.flags & flag_stop) != 0;
    input.reset = (record.flags & flag_reset) != 0;
    input.missed = static_cast<std::uint8_t>(record.flags >> 4);
    input.guided_joint = record.guided_joint;
    input.checkpoint_action = record.checkpoint_action;
    input.set_torque = record.set_torque;
    input.tool = record.tool;
    input.second_wrench = record.second_wrench;
    return input;
}

bool same_output(const TickRecord& a, const TickRecord& b) {
    const auto equal = [](const auto& x, const auto& y) { return std::memcmp(&x, &y, sizeof x) == 0; };
    return equal(a.force, b.force) && equal(a.torque, b.torque) && a.joint == b.joint && a.stage == b.stage &&
           equal(a.wrench_torque, b.wrench_torque) && equal(a.nut_angle, b.nut_angle) &&
           equal(a.clamp, b.clamp) && a.contacts == b.contacts && a.touched == b.touched &&
           a.fault == b.fault;
}

bool is_valid(const TickRecord& record) {
    constexpr auto last_grip = static_cast<std::uint8_t>(servo::Grip::wrench);
    return record.grip <= last_grip && record.stage < joint::stage_count && record.guided_joint >= -1 &&
           record.joint >= -1 && record.second_wrench >= -1 && file_number(record.touched) &&
           record.fault < force::fault_kinds &&
           (record.checkpoint_action <= servo::max_checkpoints ||
            record.checkpoint_action == servo::save_checkpoint);
}

namespace {

constexpr std::byte newest_chunk_version{6};
constexpr std::size_t header_bytes = 1 + 4 + 8;
constexpr int compression_level = 1;  // level 3 takes a tenth longer and saves nothing on these columns

// The value of a field in its column.
template <class T>
T stored(const T& field) {
    return field;
}
std::int16_t stored(collision::ObstacleId obstacle) { return file_number(obstacle).value_or(INT16_MIN); }

template <class T>
void restore(T& field, T value) {
    field = value;
}
void restore(collision::ObstacleId& obstacle, std::int16_t number) { obstacle = obstacle_of_number(number); }

template <class T>
using Bits = std::conditional_t<sizeof(T) == 4, std::uint32_t,
                                std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>;

// Visits the columns in their stored order; used for encoding and decoding.
template <class Visit>
void for_each_column(std::byte chunk_version, Visit visit) {
    for (int i = 0; i < 3; ++i) visit([i](auto& tick) -> auto& { return tick.commanded_tool.position[i]; });
    for (int i = 0; i < 4; ++i)
        visit([i](auto& tick) -> auto& { return tick.commanded_tool.orientation[i]; });
    visit([](auto& tick) -> auto& { return tick.grip; });
    visit([](auto& tick) -> auto& { return tick.flags; });
    visit([](auto& tick) -> auto& { return tick.guided_joint; });
    for (int i = 0; i < 3; ++i) visit([i](auto& tick) -> auto& { return tick.force[i]; });
    for (int i = 0; i < 3; ++i) visit([i](auto& tick) -> auto& { return tick.torque[i]; });
    visit([](auto& tick) -> auto& { return tick.joint; });
    visit([](auto& tick) -> auto& { return tick.stage; });
    visit([](auto& tick) -> auto& { return tick.wrench_torque; });
    visit([](auto& tick) -> auto& { return tick.nut_angle; });
    visit([](auto& tick) -> auto& { return tick.clamp; });
    if (chunk_version < std::byte{2}) return;
    visit([](auto& tick) -> auto& { return tick.contacts; });
    visit([](auto& tick) -> auto& { return tick.touched; });
    visit([](auto& tick) -> auto& { return tick.fault; });
    if (chunk_version < std::byte{3}) return;
    visit([](auto& tick) -> auto& { return tick.checkpoint_action; });
    if (chunk_version < std::byte{4}) return;
    visit([](auto& tick) -> auto& { return tick.set_torque; });
    if (chunk_version < std::byte{5}) return;
    visit([](auto& tick) -> auto& { return tick.tool; });
    if (chunk_version < std::byte{6}) return;
    visit([](auto& tick) -> auto& { return tick.second_wrench; });
}

std::size_t tick_bytes(std::byte chunk_version) {
    std::size_t bytes = 0;
    for_each_column(chunk_version, [&](auto field) {
        const TickRecord tick;
        bytes += sizeof(stored(field(tick)));
    });
    return bytes;
}

template <class T>
void put(std::byte*& out, T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) *out++ = static_cast<std::byte>(value >> (8U * i));
}

template <class T>
T get(const std::byte*& in) {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
        value = static_cast<T>(value | (static_cast<T>(*in++) << (8U * i)));
    return value;
}

// Zigzag code, with the sign in the lowest bit: …, −2, −1, 0, 1 become …, 3, 1, 0, 2.
template <class Word>
Word zigzag(Word difference) {
    constexpr unsigned top = 8 * sizeof(Word) - 1;
    const auto sign = static_cast<Word>(Word{0} - static_cast<Word>(difference >> top));
    return static_cast<Word>(static_cast<Word>(difference << 1U) ^ sign);
}

template <class Word>
Word unzigzag(Word code) {
    const auto sign = static_cast<Word>(Word{0} - static_cast<Word>(code & 1U));
    return static_cast<Word>(static_cast<Word>(code >> 1U) ^ sign);
}

// Shifts bytes instead of copying memory, so the stored byte order does not depend on the machine.
void to_columns(std::span<const TickRecord> ticks, std::byte* out) {
    const std::size_t count = ticks.size();
    for_each_column(newest_chunk_version, [&](auto field) {
        using Value = decltype(stored(field(ticks[0])));
        using Word = Bits<Value>;
        Word before = 0;
        for (std::size_t i = 0; i < count; ++i) {
            const Word word = std::bit_cast<Word>(stored(field(ticks[i])));
            const Word code = zigzag(static_cast<Word>(word - before));
            before = word;
            for (std::size_t plane = 0; plane < sizeof(Word); ++plane)
                out[plane * count + i] = static_cast<std::byte>(code >> (8U * plane));
        }
        out += sizeof(Word) * count;
    });
}

void from_columns(std::byte chunk_version, const std::byte* in, std::span<TickRecord> ticks) {
    const std::size_t count = ticks.size();
    for_each_column(chunk_version, [&](auto field) {
        using Value = decltype(stored(field(ticks[0])));
        using Word = Bits<Value>;
        Word word = 0;
        for (std::size_t i = 0; i < count; ++i) {
            Word code = 0;
            for (std::size_t plane = 0; plane < sizeof(Word); ++plane)
                code = static_cast<Word>(code | (static_cast<Word>(in[plane * count + i]) << (8U * plane)));
            word = static_cast<Word>(word + unzigzag(code));
            restore(field(ticks[i]), std::bit_cast<Value>(word));
        }
        in += sizeof(Word) * count;
    });
}

tl::unexpected<Error> damaged(std::uint64_t first_tick, const std::string& why) {
    return fail(ErrorCode::failed, fmt::format("the ticks from {} on are damaged: {}", first_tick, why),
                "an unmodified session file");
}

struct FreeCompressor {
    void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
};
struct FreeDecompressor {
    void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

}  // namespace

struct ChunkEncoder::State {
    std::unique_ptr<ZSTD_CCtx, FreeCompressor> zstd{ZSTD_createCCtx()};
    std::vector<std::byte> columns;
    std::vector<std::byte> packed;
};

ChunkEncoder::ChunkEncoder() : state_(std::make_unique<State>()) {}
ChunkEncoder::ChunkEncoder(ChunkEncoder&& other) noexcept = default;
ChunkEncoder& ChunkEncoder::operator=(ChunkEncoder&& other) noexcept = default;
ChunkEncoder::~ChunkEncoder() = default;

Result<std::span<const std::byte>> ChunkEncoder::encode(std::uint64_t first_tick,
                                                        std::span<const TickRecord> ticks) {
    State& state = *state_;
    const std::size_t raw = ticks.size() * tick_bytes(newest_chunk_version);
    state.columns.resize(std::max(state.columns.size(), raw));
    state.packed.resize(std::max(state.packed.size(), header_bytes + ZSTD_compressBound(raw)));
    to_columns(ticks, state.columns.data());

    std::byte* out = state.packed.data();
    *out++ = newest_chunk_version;
    put(out, static_cast<std::uint32_t>(ticks.size()));
    put(out, first_tick);
    ZSTD_CCtx_setParameter(state.zstd.get(), ZSTD_c_compressionLevel, compression_level);
    ZSTD_CCtx_setParameter(state.zstd.get(), ZSTD_c_checksumFlag, 1);
    const std::size_t size =
        ZSTD_compress2(state.zstd.get(), out, state.packed.size() - header_bytes, state.columns.data(), raw);
    if (ZSTD_isError(size) != 0)
        return fail(ErrorCode::failed, std::string("ticks cannot be compressed: ") + ZSTD_getErrorName(size),
                    "free memory");
    return std::span<const std::byte>(state.packed).first(header_bytes + size);
}

struct ChunkDecoder::State {
    std::unique_ptr<ZSTD_DCtx, FreeDecompressor> zstd{ZSTD_createDCtx()};
    std::vector<std::byte> columns;
    std::vector<TickRecord> ticks;
};

ChunkDecoder::ChunkDecoder() : state_(std::make_unique<State>()) {}
ChunkDecoder::ChunkDecoder(ChunkDecoder&& other) noexcept = default;
ChunkDecoder& ChunkDecoder::operator=(ChunkDecoder&& other) noexcept = default;
ChunkDecoder::~ChunkDecoder() = default;

Result<std::span<const TickRecord>> ChunkDecoder::decode(std::uint64_t first_tick, std::size_t count,
                                                         std::span<const std::byte> bytes) {
    State& state = *state_;
    if (bytes.size() < header_bytes) return damaged(first_tick, "they are cut short");
    if (bytes[0] < std::byte{1} || bytes[0] > newest_chunk_version)
        return damaged(first_tick,
                       fmt::format("version {} is unknown; expected 1 to {}", static_cast<int>(bytes[0]),
                                   static_cast<int>(newest_chunk_version)));
    const std::byte* in = bytes.data() + 1;
    if (get<std::uint32_t>(in) != count) return damaged(first_tick, "the count is wrong");
    if (get<std::uint64_t>(in) != first_tick) return damaged(first_tick, "the first tick is wrong");
    if (count > max_chunk_ticks) return damaged(first_tick, "there are too many");

    // The count determines the allocation, never a size in the frame.
    const std::size_t raw = count * tick_bytes(bytes[0]);
    state.columns.resize(raw);
    const std::size_t size =
        ZSTD_decompressDCtx(state.zstd.get(), state.columns.data(), raw, in, bytes.size() - header_bytes);
    if (ZSTD_isError(size) != 0) return damaged(first_tick, ZSTD_getErrorName(size));
    if (size != raw) return damaged(first_tick, "values are missing");
    state.ticks.assign(count, {});
    from_columns(bytes[0], state.columns.data(), state.ticks);
    for (const TickRecord& tick : state.ticks)
        if (!is_valid(tick)) return damaged(first_tick, "a value is out of range");
    return std::span<const TickRecord>(state.ticks);
}

}  // namespace bolt::session
