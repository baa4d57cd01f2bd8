#include "tests/session/support.hpp"

#include <stdlib.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <fstream>
#include <iterator>

#include "game/session/session_file.hpp"

namespace bolt::session::test {

TickRecord random_tick(Random& random) {
    const auto any = [&] { return std::bit_cast<float>(random.bits()); };
    TickRecord tick;
    for (float& value : tick.commanded_tool.position) value = any();
    for (float& value : tick.commanded_tool.orientation) value = any();
    for (float& value : tick.force) value = any();
    for (float& value : tick.torque) value = any();
    tick.grip = static_cast<std::uint8_t>(random.bits() % 3);
    tick.flags = static_cast<std::uint8_t>(random.bits() % 256);
    tick.guided_joint = static_cast<std::int16_t>(static_cast<int>(random.bits() % 32769) - 1);
    tick.joint = static_cast<std::int16_t>(static_cast<int>(random.bits() % 32769) - 1);
    tick.stage = static_cast<std::uint8_t>(random.bits() % joint::stage_count);
    tick.wrench_torque = any();
    tick.nut_angle = any();
    tick.clamp = any();
    tick.contacts = static_cast<std::uint16_t>(random.bits() % 65536);
    tick.touched =
        obstacle_of_number(static_cast<std::int16_t>(static_cast<int>(random.bits() % 65535) - 32767));
    tick.fault = static_cast<std::uint8_t>(random.bits() % force::fault_kinds);
    tick.checkpoint_action = static_cast<std::uint8_t>(random.bits() % (servo::max_checkpoints + 2U));
    if (tick.checkpoint_action > servo::max_checkpoints) tick.checkpoint_action = servo::save_checkpoint;
    tick.set_torque = any();
    tick.tool = static_cast<std::uint8_t>(random.bits());
    return tick;
}

std::vector<TickRecord> random_ticks(std::size_t count, std::uint64_t seed) {
    Random random(seed);
    std::vector<TickRecord> ticks(count);
    for (TickRecord& tick : ticks) tick = random_tick(random);
    return ticks;
}

bool same(const TickRecord& a, const TickRecord& b) {
    const auto equal = [](float x, float y) {
        return std::bit_cast<std::uint32_t>(x) == std::bit_cast<std::uint32_t>(y);
    };
    bool all =
        equal(a.wrench_torque, b.wrench_torque) && equal(a.nut_angle, b.nut_angle) && equal(a.clamp, b.clamp);
    for (int i = 0; i < 3; ++i)
        all = all && equal(a.commanded_tool.position[i], b.commanded_tool.position[i]) &&
              equal(a.force[i], b.force[i]) && equal(a.torque[i], b.torque[i]);
    for (int i = 0; i < 4; ++i)
        all = all && equal(a.commanded_tool.orientation[i], b.commanded_tool.orientation[i]);
    return all && a.grip == b.grip && a.flags == b.flags && a.guided_joint == b.guided_joint &&
           a.joint == b.joint && a.stage == b.stage && a.contacts == b.contacts && a.touched == b.touched &&
           a.fault == b.fault && a.checkpoint_action == b.checkpoint_action &&
           equal(a.set_torque, b.set_torque) && a.tool == b.tool;
}

bool same(std::span<const TickRecord> a, std::span<const TickRecord> b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (!same(a[i], b[i])) return false;
    return true;
}

bool same(const Header& a, const Header& b) {
    return a.assembly == b.assembly && a.assembly_file == b.assembly_file &&
           a.assembly_text == b.assembly_text && a.variant == b.variant && a.law == b.law &&
           a.mode == b.mode && a.task == b.task && a.trainee_profile == b.trainee_profile &&
           a.seed == b.seed && std::bit_cast<std::uint64_t>(a.dt) == std::bit_cast<std::uint64_t>(b.dt) &&
           a.program == b.program && a.guiding_force == b.guiding_force &&
           a.contact_models == b.contact_models &&
           a.device_limits.has_value() == b.device_limits.has_value() &&
           (!a.device_limits || limits_text(*a.device_limits) == limits_text(*b.device_limits)) &&
           a.servo_rate == b.servo_rate && a.tool == b.tool && a.view_help == b.view_help &&
           a.hand == b.hand && a.trainee == b.trainee &&
           std::ranges::equal(a.obstacle_names, b.obstacle_names,
                              [](const auto& x, const auto& y) { return x.id == y.id && x.name == y.name; });
}

namespace {

// Equal in all bits, except the sign of zero and the bits of a NaN, as the file format guarantees.
bool equal(double x, double y) { return !(x < y) && !(x > y) && (x != x) == (y != y); }

bool same(const lesson::JointResult& a, const lesson::JointResult& b) {
    return a.id == b.id && equal(a.torque, b.torque) && equal(a.angle, b.angle) && equal(a.clamp, b.clamp) &&
           equal(a.clamp_at_release, b.clamp_at_release) && a.torque_verdict == b.torque_verdict &&
           a.angle_verdict == b.angle_verdict && a.overall == b.overall && a.condition == b.condition &&
           a.strokes == b.strokes && a.done_already == b.done_already && a.out_of_turn == b.out_of_turn;
}

}  // namespace

bool same(const lesson::LessonEvent& a, const lesson::LessonEvent& b) {
    return a.tick == b.tick && a.kind == b.kind && a.joint == b.joint && equal(a.value, b.value) &&
           a.text == b.text;
}

bool same(const lesson::LessonResult& a, const lesson::LessonResult& b) {
    if (!equal(a.duration, b.duration) || !equal(a.score, b.score) || a.finished != b.finished) return false;
    if (a.joints.size() != b.joints.size() || a.reasons.size() != b.reasons.size()) return false;
    for (std::size_t i = 0; i < a.joints.size(); ++i)
        if (!same(a.joints[i], b.joints[i])) return false;
    for (std::size_t i = 0; i < a.reasons.size(); ++i)
        if (!equal(a.reasons[i].points, b.reasons[i].points) || a.reasons[i].text != b.reasons[i].text)
            return false;
    return true;
}

Header sample_header(double dt) {
    Header header;
    header.assembly = "ZQ350";
    header.assembly_file = "content/assemblies/zq350/assembly.json";
    header.assembly_text =
        std::string("{\n  \"name\": \"Getriebe, 减速器\"\n}\n") + std::string(1, '\0') + "end";
    header.variant = "";
    header.law = joint::Law::published;
    header.mode = lesson::Mode::assessment;
    header.task = lesson::Task::loosen;
    header.trainee_profile = "novice";
    header.seed = 0xFFFF'FFFF'FFFF'FFFEULL;
    header.dt = dt;
    header.program = "boltwright 0.1.0";
    header.guiding_force = true;
    header.contact_models = "cover.contact.glb 12 bytes, fnv1a 00000000075bcd15";
    header.device_limits = force::OutputLimits{};
    header.servo_rate = 4000.0;
    header.tool = "torque_wrench";
    header.view_help = true;
    header.hand = hand::Side::left;
    header.trainee = "Ada";

    header.obstacle_names = {{collision::ObstacleId::fixed(0), "housing"},
                             {collision::ObstacleId::fixed(1), "a \"lid\", 盖"},
                             {collision::ObstacleId::nut(3), "B4_nut"}};
    return header;
}

lesson::LessonResult sample_result() {
    lesson::LessonResult result;
    result.duration = 0.1 + 0.2;
    result.score = 87.25;
    result.finished = true;
    for (int i = 0; i < 12; ++i) {
        lesson::JointResult joint;
        joint.id = "J" + std::to_string(12 - i);  // not in alphabetical order
        joint.torque = 48.7 / (i + 1);
        joint.angle = 0.1 * i;
        joint.clamp = 1.0e4 / 3.0 * i;
        joint.clamp_at_release = i == 3 ? 0.0 / 1.0 : 12345.678;
        joint.torque_verdict = static_cast<lesson::Verdict>(i % 4);
        joint.angle_verdict = static_cast<lesson::Verdict>((i + 1) % 4);
        joint.overall = static_cast<lesson::Verdict>((i + 2) % 4);
        joint.condition = static_cast<joint::JointCondition>(i % 3);
        joint.strokes = i;
        joint.done_already = i % 2;
        joint.out_of_turn = 2147483647 - i;
        result.joints.push_back(joint);
    }
    result.reasons = {{-12.5, "visited \"J3\" out of turn"}, {0.0, ""}, {5.0, "naïve but quick"}};
    return result;
}

std::vector<TickRecord> all_ticks(const SessionReader& reader) {
    std::vector<TickRecord> ticks;
    const Status read = reader.for_each_chunk([&](std::uint64_t first, std::span<const TickRecord> chunk) {
        if (first != ticks.size()) std::abort();
        ticks.insert(ticks.end(), chunk.begin(), chunk.end());
    });
    if (!read) ticks.clear();
    return ticks;
}

std::string bytes_of(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

void put_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

namespace {

TickRecord script_tick(std::size_t number) {
    Random random(number);
    return random_tick(random);
}

lesson::LessonEvent script_event(std::size_t tick) {
    return {tick, lesson::EventKind::note, static_cast<int>(tick % 3), static_cast<double>(tick) / 3.0,
            "at " + std::to_string(tick)};
}
bool has_event(std::size_t tick) { return tick % 7 == 3; }

lesson::JointResult script_joint(std::size_t tick) {
    lesson::JointResult joint;
    joint.id = tick % 2 == 0 ? "even" : "odd";
    joint.strokes = static_cast<int>(tick);
    joint.torque = static_cast<double>(tick) * 0.1;
    return joint;
}

}  // namespace

Result<SessionWriter> create_script(const std::filesystem::path& path) {
    return SessionWriter::create(path, sample_header(1.0 / static_cast<double>(script_second)));
}

Status play_script(SessionWriter& writer, std::size_t ticks, const std::function<void(std::size_t)>& after) {
    for (std::size_t i = 0; i < ticks; ++i) {
        if (has_event(i))
            if (auto done = writer.add(script_event(i)); !done) return done;
        if (auto done = writer.update(script_joint(i)); !done) return done;
        if (auto done = writer.append(script_tick(i)); !done) return done;
        if (after) after(i + 1);
    }
    return {};
}

std::filesystem::path script_session(const std::filesystem::path& path, std::size_t ticks) {
    auto writer = create_script(path);
    if (!writer || !play_script(*writer, ticks)) std::abort();
    lesson::LessonResult result;
    result.score = 42.0;
    if (!writer->finish(result)) std::abort();
    return path;
}

void leave_cut_short(const std::filesystem::path& path, bool with_index) {
    const std::filesystem::path live = path.string() + ".live";
    auto writer = create_script(live);
    if (!writer || !play_script(*writer, 25)) std::abort();
    for (const char* suffix : {"", "-wal", "-shm"})
        if (with_index || std::string(suffix) != "-shm")
            put_bytes(path.string() + suffix, bytes_of(live.string() + suffix));
    if (!writer->finish({})) std::abort();
    std::filesystem::remove(live);
}

std::string script_mismatch(const SessionReader& reader) {
    const std::vector<TickRecord> ticks = all_ticks(reader);
    if (ticks.size() != reader.tick_count()) return "the ticks cannot be read";
    for (std::size_t i = 0; i < ticks.size(); ++i)
        if (!same(ticks[i], script_tick(i))) return "tick " + std::to_string(i);

    const auto events = reader.events();
    if (!events) return events.error().message();
    std::vector<lesson::LessonEvent> expected;
    for (std::size_t i = 0; i < ticks.size(); ++i)
        if (has_event(i)) expected.push_back(script_event(i));
    if (events->size() != expected.size()) return std::to_string(events->size()) + " events";
    for (std::size_t i = 0; i < expected.size(); ++i)
        if (!same((*events)[i], expected[i])) return "event " + std::to_string(i);

    const auto result = reader.result();
    if (!result) return result.error().message();
    const std::size_t joints = std::min<std::size_t>(ticks.size(), 2);
    if (result->joints.size() != joints) return std::to_string(result->joints.size()) + " joints";
    for (std::size_t i = 0; i < joints; ++i) {
        const std::size_t last = ticks.size() - 1;
        const std::size_t tick = last % 2 == i ? last : last - 1;
        if (!same(result->joints[i], script_joint(tick))) return "joint " + std::to_string(i);
    }
    return {};
}

}  // namespace bolt::session::test
