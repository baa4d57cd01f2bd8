#include "game/session/header.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>
#include <cstddef>

#include "game/session/tables.hpp"

namespace bolt::session {

namespace {

// Visits each limit with its name, in the order of the text.
template <class Limits, class Visit>
void for_each_limit(Limits& l, Visit visit) {
    visit("force_N", l.force), visit("torque_Nm", l.torque);
    visit("force_rate_N_s", l.force_slew_rate), visit("torque_rate_Nm_s", l.torque_slew_rate);
    visit("ramp_up_s", l.ramp_up), visit("release_s", l.release);
    visit("stiffness_N_m", l.stiffness), visit("torsion_Nm_rad", l.torsion);
    visit("damping_Ns_m", l.damping), visit("angular_damping_Nms_rad", l.angular_damping);
    visit("delay_ticks", l.delay);
    visit("speed_m_s", l.speed), visit("angular_speed_rad_s", l.angular_speed);
    visit("jump_m", l.jump), visit("angular_jump_rad", l.angular_jump);
    visit("silence_s", l.max_silence), visit("recovery_s", l.recovery_time);
}

// The list above names every member; a new member must be added to it.
static_assert(sizeof(force::OutputLimits) == 17 * sizeof(double));

}  // namespace

std::string limits_text(const force::OutputLimits& limits) {
    std::string text;
    for_each_limit(limits, [&](const char* name, auto value) {
        text += fmt::format("{}{}={}", text.empty() ? "" : " ", name, value);
    });
    return text;
}

std::optional<force::OutputLimits> parse_limits(std::string_view text) {
    force::OutputLimits limits;
    bool valid = true;
    for_each_limit(limits, [&](std::string_view name, auto& value) {
        if (!text.starts_with(name) || text.size() <= name.size() || text[name.size()] != '=') {
            valid = false;
            return;
        }
        text.remove_prefix(name.size() + 1);
        const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
        valid = valid && problem == std::errc{};
        text.remove_prefix(static_cast<std::size_t>(end - text.data()));
        if (text.starts_with(' ')) text.remove_prefix(1);
    });
    return valid && text.empty() ? std::optional(limits) : std::nullopt;
}

std::string servo_text(double rate) { return rate > 0.0 ? fmt::format("{:.0f} Hz", rate) : "virtual time"; }

namespace {

constexpr std::string_view person = "person";

std::optional<bool> parse_switch(std::string_view text) {
    if (text == "on") return true;
    return text == "off" ? std::optional(false) : std::nullopt;
}

std::optional<double> parse_servo(std::string_view text) {
    if (text == servo_text(0.0)) return 0.0;
    constexpr std::string_view unit = " Hz";
    if (!text.ends_with(unit)) return std::nullopt;
    const auto rate = number<double>(text.substr(0, text.size() - unit.size()));
    return rate && *rate > 0.0 ? rate : std::nullopt;
}

std::optional<hand::Side> parse_side(std::string_view text) {
    if (text == "left") return hand::Side::left;
    return text == "right" ? std::optional(hand::Side::right) : std::nullopt;
}

// "12000 45000"; none unless the numbers ascend.
std::optional<std::vector<std::uint64_t>> parse_ticks(std::string_view text) {
    std::vector<std::uint64_t> ticks;
    while (!text.empty()) {
        const std::string_view word = text.substr(0, text.find(' '));
        const auto tick = number<std::uint64_t>(word);
        if (!tick || (!ticks.empty() && *tick < ticks.back())) return std::nullopt;
        ticks.push_back(*tick);
        text.remove_prefix(std::min(word.size() + 1, text.size()));
    }
    return ticks;
}

const char* switch_text(bool on) { return on ? "on" : "off"; }

// Reads the texts of a header. The first one that is missing or wrong is kept as the error.
class HeaderParser {
  public:
    HeaderParser(const HeaderTexts& texts, const std::string& file) : texts_(texts), file_(file) {}

    void required(const char* key, std::string& value) {
        if (const std::string* text = find(key))
            value = *text;
        else
            report(fmt::format("is damaged: its {} is missing", key), "the texts of a recorded lesson");
    }
    void optional(const char* key, std::string& value) const {
        if (const std::string* text = find(key)) value = *text;
    }
    // `parse` returns none for a wrong text; `expected` describes the right ones.
    template <class Value, class Parse>
    void required(const char* key, Value& value, const char* expected, Parse parse) {
        std::string text;
        required(key, text);
        if (error_) return;
        if (const auto parsed = parse(text))
            value = *parsed;
        else
            report(fmt::format("is damaged: its {} is \"{}\"", key, text), expected);
    }
    // An empty text has no value.
    template <class Value, class Parse>
    void optional(const char* key, std::optional<Value>& value, const char* expected, Parse parse) {
        const std::string* text = find(key);
        if (text == nullptr || text->empty()) return;
        value = parse(*text);
        if (!value) report(fmt::format("is damaged: its {} is \"{}\"", key, *text), expected);
    }
    [[nodiscard]] Status status() const { return error_ ? Status(fail(*error_)) : Status(); }

  private:
    [[nodiscard]] const std::string* find(const char* key) const {
        const auto found = texts_.find(key);
        return found != texts_.end() ? &found->second : nullptr;
    }
    void report(std::string what, const char* expected) {
        if (!error_) error_ = file_error(file_, std::move(what), expected).value();
    }
    const HeaderTexts& texts_;
    const std::string& file_;
    std::optional<Error> error_;
};

}  // namespace

HeaderTexts texts_of(const Header& header) {
    const std::string no_obstacles = "none";
    HeaderTexts texts{
        {key::assembly, header.assembly},
        {key::assembly_file, header.assembly_file},
        {key::assembly_text, header.assembly_text},
        {key::variant, header.variant},
        {key::law, std::string(joint::name(header.law))},
        {key::mode, std::string(lesson::name(header.mode))},
        {key::task, std::string(lesson::name(header.task))},
        {key::trainee_profile, header.trainee_profile},
        {key::seed, fmt::format("{}", header.seed)},
        {key::dt, fmt::format("{}", header.dt)},
        {key::program, header.program},
        {key::tool, header.tool},
    };
    if (header.guiding_force) texts[key::guide] = switch_text(*header.guiding_force);
    if (header.contact_models)
        texts[key::obstacles] = header.contact_models->empty() ? no_obstacles : *header.contact_models;
    if (header.device_limits) texts[key::device] = limits_text(*header.device_limits);
    if (header.servo_rate) texts[key::servo] = servo_text(*header.servo_rate);
    if (header.view_help) texts[key::view_help] = switch_text(*header.view_help);
    if (header.hand) texts[key::hand] = *header.hand == hand::Side::left ? "left" : "right";
    if (header.trainee) texts[key::trainee] = *header.trainee;
    if (!header.continued_after.empty())
        texts[key::continued_after] = fmt::format("{}", fmt::join(header.continued_after, " "));
    return texts;
}

Result<Header> header_of(const HeaderTexts& texts, const std::string& file) {
    Header header;
    HeaderParser parser(texts, file);
    parser.required(key::assembly, header.assembly);
    parser.required(key::assembly_file, header.assembly_file);
    parser.required(key::assembly_text, header.assembly_text);
    parser.required(key::variant, header.variant);
    parser.required(key::law, header.law, "published or mechanistic", joint::law_named);
    parser.required(key::mode, header.mode, "guided, practice or assessment",
                    [](std::string_view text) { return lesson::mode_names.find(text); });
    parser.required(key::task, header.task, "tighten or loosen",
                    [](std::string_view text) { return lesson::task_names.find(text); });
    parser.required(key::trainee_profile, header.trainee_profile);
    parser.required(key::seed, header.seed, "a whole number", number<std::uint64_t>);
    parser.required(key::dt, header.dt, "a tick in s, at least one in a second", [](std::string_view text) {
        const auto dt = number<double>(text);
        return dt && ticks_per_commit(*dt) ? dt : std::nullopt;
    });
    parser.required(key::program, header.program);
    parser.optional(key::guide, header.guiding_force, "on or off", parse_switch);
    parser.optional(
        key::obstacles, header.contact_models, "none, or the contact models",
        [](const std::string& text) { return std::optional(text == "none" ? std::string() : text); });
    parser.optional(key::device, header.device_limits, "the limits of a device", parse_limits);
    parser.optional(key::servo, header.servo_rate, "virtual time, or a rate in Hz", parse_servo);
    parser.optional(key::view_help, header.view_help, "on or off", parse_switch);
    parser.optional(key::tool, header.tool);
    parser.optional(key::hand, header.hand, "left or right", parse_side);
    if (const auto found = texts.find(key::trainee); found != texts.end()) header.trainee = found->second;
    std::optional<std::vector<std::uint64_t>> continued;
    parser.optional(key::continued_after, continued, "ascending numbers of ticks", parse_ticks);
    header.continued_after = continued.value_or(std::vector<std::uint64_t>());
    BOLT_TRY(parser.status());
    return header;
}

TraineeKind trainee_kind(const Header& header) {
    if (header.trainee)
        return header.trainee_profile == person ? TraineeKind::person : TraineeKind::simulated;
    if (header.view_help) return TraineeKind::simulated;
    if (header.trainee_profile == person || !header.tool.empty()) return TraineeKind::person;
    return TraineeKind::unrecorded;
}

std::string trainee_name(const Header& header) {
    if (header.trainee) return *header.trainee;
    if (trainee_kind(header) == TraineeKind::simulated || header.trainee_profile == person) return {};
    return header.trainee_profile;
}

}  // namespace bolt::session
