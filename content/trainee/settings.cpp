#include "content/trainee/settings.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <set>

#include "content/format/json_members.hpp"
#include "content/trainee/people.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace fs = std::filesystem;

std::string file_name_of(std::string_view trainee) {
    if (is_person_code(trainee)) return std::string(trainee);  // has capitals, so it is no encoded name
    std::string name;
    for (const char c : trainee) {
        const bool plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '-';
        name += plain ? std::string(1, c) : fmt::format("_{:02x}", static_cast<unsigned char>(c));
    }
    return name;
}

std::string trainee_of_file_name(std::string_view file_name) {
    if (is_person_code(file_name)) return std::string(file_name);
    std::string name;
    for (std::size_t i = 0; i < file_name.size(); ++i) {
        unsigned byte = 0;
        const char* digits = file_name.data() + i + 1;
        if (file_name[i] != '_')
            name += file_name[i];
        else if (i + 2 < file_name.size() && std::from_chars(digits, digits + 2, byte, 16).ptr == digits + 2)
            name += static_cast<char>(byte), i += 2;
        else
            return {};
    }
    return file_name_of(name) == file_name ? name : std::string();
}

namespace {

using nlohmann::json;

constexpr const char* settings_format = "boltwright settings 1";
constexpr const char *usual = "usual", *distinct = "distinct";
constexpr const char *mechanistic = "mechanistic", *published = "published";

bool contains(const std::vector<std::string>& all, const std::string& one) {
    return std::find(all.begin(), all.end(), one) != all.end();
}

void read_language(MemberReader& members, const json& root, TraineeSettings& to,
                   const SettingsVocabulary& known) {
    to.language = members.text(root, "", "language");
    if (to.language.empty() || contains(known.languages, to.language)) return;
    members.report("/language", JsonPart::value,
                   fmt::format("{} is not a supported language", in_quotes(to.language)),
                   suggest(to.language, known.languages));
}

void read_palette(MemberReader& members, const json& root, TraineeSettings& to) {
    const std::string name = members.text(root, "", "palette");
    if (name != usual && name != distinct)
        members.report("/palette", JsonPart::value, fmt::format("{} is not a palette", in_quotes(name)),
                       fmt::format("\"{}\" or \"{}\"", usual, distinct));
    to.palette = name == distinct ? PaletteKind::distinct : PaletteKind::usual;
}

void read_law(MemberReader& members, const json& root, TraineeSettings& to) {
    if (!root.contains("law")) return;
    to.law = members.text(root, "", "law");
    if (to.law != mechanistic && to.law != published)
        members.report("/law", JsonPart::value, fmt::format("{} is not a joint law", in_quotes(to.law)),
                       fmt::format("\"{}\" or \"{}\"", mechanistic, published));
}

void read_seat(MemberReader& members, const json& root, TraineeSettings& to) {
    const json* seat = members.find(root, "", "seated_height_m");
    if (seat == nullptr || seat->is_null()) return;
    to.seated_eye_height =
        members.number(root, "", "seated_height_m", min_seated_eye_height, max_seated_eye_height);
}

void read_key(MemberReader& members, const std::string& action, const json& value,
              std::set<std::string>& taken, const SettingsVocabulary& known) {
    const std::string at = "/keys/" + pointer_token(action);
    if (!value.is_string())
        return members.report(at, JsonPart::value, fmt::format("the key of \"{}\" is not a text", action),
                              "the name of a key, as \"T\"");
    const auto& key = value.get_ref<const std::string&>();
    if (!contains(known.keys, key))
        return members.report(at, JsonPart::value, fmt::format("{} is not a usable key", in_quotes(key)),
                              suggest(key, known.keys));
    if (const auto kept = known.reserved.find(key); kept != known.reserved.end() && kept->second != action)
        return members.report(at, JsonPart::value,
                              fmt::format("{} is always the key of \"{}\"", in_quotes(key), kept->second),
                              "another key");
    if (!taken.insert(key).second)
        members.report(at, JsonPart::value, fmt::format("{} is the key of two actions", in_quotes(key)),
                       "a different key for each action");
}

void read_keys(MemberReader& members, const json& root, TraineeSettings& to,
               const SettingsVocabulary& known) {
    const json* keys = members.find(root, "", "keys");
    if (keys == nullptr) return;
    if (!keys->is_object())
        return members.report("/keys", JsonPart::value, "\"keys\" is not an object",
                              "an object with a key per action, as {\"tool\": \"T\"}");
    members.check_known(*keys, "/keys", known.actions);
    std::set<std::string> taken;
    for (const auto& [action, key] : keys->items()) {
        read_key(members, action, key, taken, known);
        if (members.first_error) return;
        to.keys[action] = key.get<std::string>();
    }
}

}  // namespace

Result<TraineeSettings> parse_settings(std::string_view text, const std::string& file,
                                       const SettingsVocabulary& known) {
    const FileHead head{
        "settings file",
        settings_format,
        {"trainee", "language", "volume", "vibration", "captions", "palette", "left_handed", "force_scale",
         "force_arrow", "surroundings", "vignette", "seated_height_m", "arm_reach_m", "law", "keys"}};
    return parse_small_file(text, file, head, [&known](MemberReader& members, const json& root) {
        TraineeSettings read;
        read.trainee = members.text(root, "", "trainee", max_trainee_name_size);
        read_language(members, root, read, known);
        read.volume = members.number(root, "", "volume", 0.0, 1.0);
        if (root.contains("vibration")) read.vibration = members.number(root, "", "vibration", 0.0, 1.0);
        read.captions = members.flag(root, "", "captions");
        read_palette(members, root, read);
        read.left_handed = members.flag(root, "", "left_handed");
        read.force_scale = members.number(root, "", "force_scale", min_force_scale, 1.0);
        if (root.contains("force_arrow")) read.force_arrow = members.flag(root, "", "force_arrow");
        if (root.contains("surroundings")) read.passthrough = members.flag(root, "", "surroundings");
        if (root.contains("vignette")) read.vignette = members.flag(root, "", "vignette");
        read_seat(members, root, read);
        if (root.contains("arm_reach_m"))
            read.arm_reach = members.number(root, "", "arm_reach_m", min_arm_reach, max_arm_reach);
        read_law(members, root, read);
        read_keys(members, root, read, known);
        return read;
    });
}

std::string settings_text(const TraineeSettings& settings) {
    nlohmann::ordered_json root;
    root["format"] = settings_format;
    root["trainee"] = settings.trainee;
    root["language"] = settings.language;
    root["volume"] = settings.volume;
    if (settings.vibration != 1.0) root["vibration"] = settings.vibration;
    root["captions"] = settings.captions;
    root["palette"] = settings.palette == PaletteKind::distinct ? distinct : usual;
    root["left_handed"] = settings.left_handed;
    root["force_scale"] = settings.force_scale;
    if (!settings.force_arrow) root["force_arrow"] = false;
    if (settings.passthrough) root["surroundings"] = true;
    if (!settings.vignette) root["vignette"] = false;
    root["seated_height_m"] = settings.seated_eye_height ? nlohmann::ordered_json(*settings.seated_eye_height)
                                                         : nlohmann::ordered_json(nullptr);
    if (settings.arm_reach != usual_arm_reach) root["arm_reach_m"] = settings.arm_reach;
    if (!settings.law.empty()) root["law"] = settings.law;
    root["keys"] = settings.keys;
    // Names are user input: bytes that are not UTF-8 are replaced, because they would make the file
    // unreadable.
    return root.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

Result<TraineeSettings> load_settings(const std::filesystem::path& path, const SettingsVocabulary& known) {
    BOLT_TRY_ASSIGN(const auto text, read_file(path, max_trainee_file_size, ErrorCode::bad_content));
    return parse_settings(text, path.string(), known);
}

Status save_settings(const std::filesystem::path& path, const TraineeSettings& settings,
                     const SettingsVocabulary& known) {
    const std::string text = settings_text(settings);
    // A text that cannot be read back must not replace a valid file.
    BOLT_TRY(parse_settings(text, path.string(), known));
    std::error_code problem;
    if (!path.parent_path().empty()) std::filesystem::create_directories(path.parent_path(), problem);
    if (problem)
        return fail(ErrorCode::failed,
                    fmt::format("{}: this folder cannot be created: {}", path.parent_path().string(),
                                problem.message()),
                    "a folder that this user may write to");
    if (std::filesystem::is_regular_file(path, problem) && !load_settings(path, known)) {
        std::filesystem::path beside = path;
        beside += ".unread";
        std::filesystem::rename(path, beside, problem);
        if (problem)
            return fail(ErrorCode::failed,
                        fmt::format("{}: the unreadable file cannot be renamed: {}", path.string(),
                                    problem.message()),
                        "a folder that this user may write to");
    }
    return write_file(path, text);
}

std::filesystem::path settings_path(const std::filesystem::path& folder, std::string_view trainee) {
    return folder / fmt::format("{}.settings.json", file_name_of(trainee));
}

}  // namespace bolt::content
