#include "content/station/registration.hpp"

#include <array>
#include <chrono>

#include "content/format/json_members.hpp"

namespace bolt::content {
namespace {

using nlohmann::json;
using nlohmann::ordered_json;

constexpr std::size_t max_registrations = 64;

// The number that `count` digits at this position make; −1 if a character is no digit.
int digits_at(std::string_view text, std::size_t at, std::size_t count) {
    int value = 0;
    for (const char c : text.substr(at, count)) {
        if (c < '0' || c > '9') return -1;
        value = 10 * value + (c - '0');
    }
    return value;
}

// Reads an array of numbers from `low` to `high`.
template <std::size_t N>
std::array<double, N> read_numbers(MemberReader& members, const json& object, const std::string& at,
                                   const char* key, double low, double high) {
    std::array<double, N> numbers{};
    const json* list = members.find(object, at, key);
    if (list == nullptr) return numbers;
    const std::string pointer = at + "/" + key;
    if (!list->is_array() || list->size() != N) {
        members.report(pointer, JsonPart::value, fmt::format("\"{}\" is not a list of {} numbers", key, N),
                       fmt::format("{} numbers in [ ]", N));
        return numbers;
    }
    for (std::size_t i = 0; i < N; ++i) {
        const json& value = (*list)[i];
        numbers[i] = value.is_number() ? value.get<double>() : bolt::nan;
        if (numbers[i] >= low && numbers[i] <= high) continue;
        members.report(fmt::format("{}/{}", pointer, i), JsonPart::value,
                       fmt::format("\"{}\" cannot have {}", key, in_quotes(value.dump())),
                       fmt::format("a number from {} to {}", low, high));
        numbers[i] = low;
    }
    return numbers;
}

Vec3 read_point(MemberReader& members, const json& object, const std::string& at, const char* key) {
    const auto [x, y, z] =
        read_numbers<3>(members, object, at, key, -max_registered_distance, max_registered_distance);
    return {x, y, z};
}

CoordinateFrame read_frame(MemberReader& members, const json& object, const std::string& at,
                           const char* key) {
    const std::string text = members.text(object, at, key);
    const Result<CoordinateFrame> frame = parse_coordinate_frame(text);
    if (!frame) members.report(at + "/" + key, JsonPart::value, frame.error().what, frame.error().expected);
    return frame.value_or(CoordinateFrame::arm);
}

Quat read_orientation(MemberReader& members, const json& object, const std::string& at) {
    constexpr const char* key = "orientation_wxyz";
    const auto [w, x, y, z] =
        read_numbers<4>(members, object, at, key, -1.0 - unit_tolerance, 1.0 + unit_tolerance);
    const Quat orientation(w, x, y, z);
    const double length = glm::length(orientation);
    if (!(std::abs(length - 1.0) <= unit_tolerance))
        members.report(at + "/" + key, JsonPart::value,
                       fmt::format("the quaternion has the length {:.6g}", length),
                       "a unit quaternion [w, x, y, z]");
    return orientation;
}

std::string read_date(MemberReader& members, const json& object, const std::string& at) {
    std::string date = members.text(object, at, "date");
    if (!is_utc_date(date))
        members.report(at + "/date", JsonPart::value, fmt::format("{} is not a date", in_quotes(date)),
                       "a date and time in UTC, as \"2026-03-02T09:15:00Z\"");
    return date;
}

int read_point_count(MemberReader& members, const json& object, const std::string& at) {
    const double count = members.number(object, at, "points", 3.0, max_registered_points);
    if (count != std::floor(count))
        members.report(at + "/points", JsonPart::value, fmt::format("\"points\" cannot be {}", count),
                       fmt::format("a whole number from 3 to {}", max_registered_points));
    return static_cast<int>(count);
}

// Leaving a point out of the fit cannot reduce its residual, so the largest residual of a left-out point is
// at least the rms.
void check_residuals(MemberReader& members, const std::string& at, const Registration& one) {
    constexpr double rounding = 1e-9;  // m
    if (!one.largest_left_out) return;
    const std::string pointer = at + "/largest_left_out_m";
    if (one.points == 3)  // the two that remain determine no pose
        members.report(pointer, JsonPart::value, "with 3 points none can be left out",
                       "more points, or no \"largest_left_out_m\"");
    else if (*one.largest_left_out < one.rms - rounding)
        members.report(pointer, JsonPart::value,
                       fmt::format("a largest residual of {:g} is impossible with an rms of {:g}",
                                   *one.largest_left_out, one.rms),
                       "a number that is not less than \"rms_m\"");
}

std::optional<PointPair> read_check_point(MemberReader& members, const json& object, const std::string& at) {
    const auto found = object.find("check_point");
    if (found == object.end()) return std::nullopt;
    const std::string pointer = at + "/check_point";
    if (!found->is_object()) {
        members.report(pointer, JsonPart::value, "\"check_point\" is not an object", "an object {...}");
        return std::nullopt;
    }
    members.check_known(*found, pointer, {"from_m", "to_m"});
    return PointPair{read_point(members, *found, pointer, "from_m"),
                     read_point(members, *found, pointer, "to_m")};
}

Registration read_registration(MemberReader& members, const json& object, const std::string& at) {
    members.check_known(object, at,
                        {"from", "to", "date", "position_m", "orientation_wxyz", "points", "rms_m",
                         "largest_left_out_m", "check_point", "tip_m"});
    Registration one;
    one.from = read_frame(members, object, at, "from");
    one.to = read_frame(members, object, at, "to");
    if (one.from == one.to)
        members.report(at + "/to", JsonPart::value, "both frames are the same", "another frame");
    one.date = read_date(members, object, at);
    one.pose = {read_point(members, object, at, "position_m"), read_orientation(members, object, at)};
    one.points = read_point_count(members, object, at);
    one.rms = members.number(object, at, "rms_m", 0.0, max_registered_rms);
    if (object.contains("largest_left_out_m"))
        one.largest_left_out =
            members.number(object, at, "largest_left_out_m", 0.0, 2.0 * max_registered_distance);
    check_residuals(members, at, one);
    one.check_point = read_check_point(members, object, at);
    if (object.contains("tip_m")) one.tip = read_point(members, object, at, "tip_m");
    return one;
}

ordered_json json_of(const Vec3& v) { return {v.x, v.y, v.z}; }

ordered_json json_of(const Registration& one) {
    ordered_json object;
    object["from"] = name(one.from);
    object["to"] = name(one.to);
    object["date"] = one.date;
    object["position_m"] = json_of(one.pose.position);
    const Quat& q = one.pose.orientation;
    object["orientation_wxyz"] = {q.w, q.x, q.y, q.z};
    object["points"] = one.points;
    object["rms_m"] = one.rms;
    if (one.largest_left_out) object["largest_left_out_m"] = *one.largest_left_out;
    if (one.check_point) {
        object["check_point"]["from_m"] = json_of(one.check_point->from);
        object["check_point"]["to_m"] = json_of(one.check_point->to);
    }
    if (one.tip != Vec3(0.0)) object["tip_m"] = json_of(one.tip);
    return object;
}

}  // namespace

const std::vector<std::string>& coordinate_frame_names() {
    static const std::vector<std::string> names{"arm",  "wheel", "tracker",    "wall",         "workpiece",
                                                "room", "hand",  "controller", "wrist_tracker"};
    return names;
}

std::string_view name(CoordinateFrame frame) {
    return coordinate_frame_names()[static_cast<std::size_t>(frame)];
}

Result<CoordinateFrame> parse_coordinate_frame(std::string_view text) {
    const std::vector<std::string>& names = coordinate_frame_names();
    const auto found = std::find(names.begin(), names.end(), text);
    if (found == names.end())
        return fail(ErrorCode::bad_content, fmt::format("{} is not a frame", in_quotes(text)),
                    suggest(text, names));
    return static_cast<CoordinateFrame>(found - names.begin());
}

bool Registration::operator==(const Registration& other) const {
    const auto pair = [](const std::optional<PointPair>& a, const std::optional<PointPair>& b) {
        return a.has_value() == b.has_value() && (!a || (a->from == b->from && a->to == b->to));
    };
    return from == other.from && to == other.to && date == other.date &&
           pose.position == other.pose.position && pose.orientation == other.pose.orientation &&
           points == other.points && rms == other.rms && largest_left_out == other.largest_left_out &&
           pair(check_point, other.check_point) && tip == other.tip;
}

bool is_utc_date(std::string_view text) {
    constexpr std::string_view form = "0000-00-00T00:00:00Z";
    if (text.size() != form.size()) return false;
    for (std::size_t i = 0; i < form.size(); ++i)
        if (form[i] != '0' && text[i] != form[i]) return false;
    const int year = digits_at(text, 0, 4), month = digits_at(text, 5, 2), day = digits_at(text, 8, 2);
    const int hour = digits_at(text, 11, 2), minute = digits_at(text, 14, 2), second = digits_at(text, 17, 2);
    if (std::min({year, month, day, hour, minute, second}) < 0) return false;
    using namespace std::chrono;
    return year_month_day(std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                          std::chrono::day(static_cast<unsigned>(day)))
               .ok() &&
           hour < 24 && minute < 60 && second < 60;
}

std::optional<double> check_error(const Registration& registration) {
    if (!registration.check_point) return std::nullopt;
    return glm::length(registration.pose * registration.check_point->from - registration.check_point->to);
}

const Registration* find_registration(std::span<const Registration> registrations, CoordinateFrame from,
                                      CoordinateFrame to) {
    for (const Registration& one : registrations)
        if ((one.from == from && one.to == to) || (one.from == to && one.to == from)) return &one;
    return nullptr;
}

void set_registration(std::vector<Registration>& registrations, const Registration& registration) {
    const Registration* old = find_registration(registrations, registration.from, registration.to);
    if (old == nullptr)
        registrations.push_back(registration);
    else
        registrations[static_cast<std::size_t>(old - registrations.data())] = registration;
}

std::vector<Registration> read_registrations(MemberReader& members, const json& root) {
    std::vector<Registration> registrations;
    const auto list = root.find("registrations");
    if (list == root.end()) return registrations;
    if (!list->is_array() || list->size() > max_registrations) {
        members.report("/registrations", JsonPart::value,
                       fmt::format("\"registrations\" is not a list of at most {}", max_registrations),
                       "a list [...] of objects");
        return registrations;
    }
    for (std::size_t i = 0; i < list->size(); ++i) {
        const std::string at = fmt::format("/registrations/{}", i);
        if (!(*list)[i].is_object()) {
            members.report(at, JsonPart::value, "the registration is not an object", "an object {...}");
            return registrations;
        }
        const Registration one = read_registration(members, (*list)[i], at);
        if (find_registration(registrations, one.from, one.to) != nullptr)
            members.report(at, JsonPart::value,
                           fmt::format("there are two registrations between \"{}\" and \"{}\"",
                                       name(one.from), name(one.to)),
                           "one for each pair of frames");
        registrations.push_back(one);
    }
    return registrations;
}

void write_registrations(ordered_json& root, std::span<const Registration> registrations) {
    for (const Registration& one : registrations) root["registrations"].push_back(json_of(one));
}

}  // namespace bolt::content
