#include "content/trainee/glove_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "content/format/json_document.hpp"
#include "content/format/json_members.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {
namespace {

using nlohmann::json;

constexpr const char* calibration_format = "boltwright glove calibration 1";
constexpr double max_gain = 0.2;  // rad per count; 255 counts would be eight turns

// The name of a sensor in the file: "thumb_roll".
std::string key_of(hand::Sensor sensor) {
    std::string key = hand::name_of(sensor);
    for (char& c : key) c = c == ' ' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return key;
}

std::vector<std::string> sensor_keys(std::size_t sensors) {
    std::vector<std::string> keys;
    for (const hand::Sensor sensor : hand::sensors_of(sensors)) keys.push_back(key_of(sensor));
    return keys;
}

bool is_date(const std::string& text) {
    if (text.size() != 10) return false;
    for (std::size_t i = 0; i < text.size(); ++i)
        if (i == 4 || i == 7 ? text[i] != '-' : text[i] < '0' || text[i] > '9') return false;
    const int month = std::stoi(text.substr(5, 2)), day = std::stoi(text.substr(8, 2));
    return month >= 1 && month <= 12 && day >= 1 && day <= 31;
}

void read_fits(MemberReader& members, const json& root, GloveCalibration& to) {
    const json* fits = members.find(root, "", "lines");
    if (fits == nullptr) return;
    if (!fits->is_object() || fits->empty())
        return members.report("/lines", JsonPart::value, "no sensor is calibrated",
                              "an object with a line per sensor, as {\"thumb_mpj\": {\"offset\": 41.5, "
                              "\"gain\": 0.013}}");
    members.check_known(*fits, "/lines", sensor_keys(to.sensors));
    for (const hand::Sensor sensor : hand::sensors_of(to.sensors)) {
        const std::string key = key_of(sensor), at = "/lines/" + key;
        const auto fit = fits->find(key);
        if (fit == fits->end()) continue;
        if (!fit->is_object())
            return members.report(at, JsonPart::value, fmt::format("\"{}\" is not an object", key),
                                  "an object with \"offset\" and \"gain\"");
        members.check_known(*fit, at, {"offset", "gain"});
        to.calibration.fits[hand::index(sensor)] =
            hand::LinearFit{members.number(*fit, at, "gain", -max_gain, max_gain),
                            members.number(*fit, at, "offset", -1e4, 1e4)};
    }
}

}  // namespace

Result<GloveCalibration> parse_glove_calibration(std::string_view text, const std::string& file) {
    const FileHead head{
        "glove calibration",
        calibration_format,
        {"trainee", "glove", "hand", "sensors", "date", "quality", "hand_length_mm", "lines"}};
    return parse_small_file(text, file, head, [](MemberReader& members, const json& root) {
        GloveCalibration read;
        read.trainee = members.text(root, "", "trainee", max_trainee_name_size);
        read.glove = members.text(root, "", "glove");
        const std::string hand = members.text(root, "", "hand");
        if (hand != "left" && hand != "right")
            members.report("/hand", JsonPart::value, fmt::format("a hand cannot be {}", in_quotes(hand)),
                           "\"left\" or \"right\"");
        read.hand = hand == "left" ? hand::Side::left : hand::Side::right;
        const double sensors = members.number(root, "", "sensors", 18, 22);
        if (sensors != 18.0 && sensors != 22.0)
            members.report("/sensors", JsonPart::value, "a glove cannot have this number of sensors",
                           "18 or 22");
        read.sensors = static_cast<std::size_t>(sensors);
        read.date = members.text(root, "", "date");
        if (!is_date(read.date))
            members.report("/date", JsonPart::value, fmt::format("{} is not a date", in_quotes(read.date)),
                           "a date as \"2026-11-22\"");
        read.quality = members.number(root, "", "quality", 0.0, 1.0);
        read.hand_length = 1e-3 * members.number(root, "", "hand_length_mm", 100.0, 300.0);
        read_fits(members, root, read);
        return read;
    });
}

std::string glove_calibration_text(const GloveCalibration& calibration) {
    nlohmann::ordered_json fits = nlohmann::ordered_json::object();
    for (const hand::Sensor sensor : hand::sensors_of(calibration.sensors))
        if (const auto& fit = calibration.calibration.fits[hand::index(sensor)])
            fits[key_of(sensor)] = {{"offset", fit->offset}, {"gain", fit->gain}};
    nlohmann::ordered_json root;
    root["format"] = calibration_format;
    root["trainee"] = calibration.trainee;
    root["glove"] = calibration.glove;
    root["hand"] = calibration.hand == hand::Side::left ? "left" : "right";
    root["sensors"] = calibration.sensors;
    root["date"] = calibration.date;
    root["quality"] = calibration.quality;
    root["hand_length_mm"] = std::round(1e6 * calibration.hand_length) / 1e3;  // to a micrometre
    root["lines"] = std::move(fits);
    // Names are user input: bytes that are not UTF-8 are replaced, because they would make the file
    // unreadable.
    return root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<GloveCalibration> load_glove_calibration(const std::filesystem::path& path) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_trainee_file_size, ErrorCode::bad_content));
    return parse_glove_calibration(text, path.string());
}

Status save_glove_calibration(const std::filesystem::path& path, const GloveCalibration& calibration) {
    const std::string text = glove_calibration_text(calibration);
    // A text that cannot be read back must not replace a valid file.
    BOLT_TRY(parse_glove_calibration(text, path.string()));
    return write_file(path, text);
}

std::filesystem::path glove_calibration_path(const std::filesystem::path& folder, std::string_view trainee,
                                             hand::Side hand) {
    return folder / fmt::format("{}.{}.glove.json", file_name_of(trainee),
                                hand == hand::Side::left ? "left" : "right");
}

}  // namespace bolt::content
