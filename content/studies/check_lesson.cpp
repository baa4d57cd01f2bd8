#include <fmt/format.h>

#include <algorithm>

#include "content/studies/study_reader.hpp"

namespace bolt::content {

namespace {

// A member of the lesson itself, otherwise of the study's "lesson"; none: neither has it.
JsonNode member_of(JsonReader& json, const JsonNode& own, const char* key) {
    if (const JsonNode node = json.member(own, key)) return node;
    return json.member(json.member(json.root(), "lesson"), key);
}

// The ids of --device that stand for the mouse.
bool is_mouse(const std::string& device) { return device == "mouse" || device == "simulated-arm"; }

void check_headset(JsonReader& json, const JsonNode& own, const StudyLesson& lesson) {
    constexpr const char* usable = "an arm or a SpaceMouse in \"devices\", or \"hand\": \"tracked\"";
    const JsonNode hand = member_of(json, own, "hand"), devices = member_of(json, own, "devices");
    if (hand && lesson.hand != "tracked" && lesson.devices.empty())
        json.report(hand.pointer, "the mouse that moves this hand cannot be used in a headset", usable);
    if (devices && std::any_of(lesson.devices.begin(), lesson.devices.end(), is_mouse))
        json.report(devices.pointer, "the mouse cannot be used in a headset", usable);
}

}  // namespace

void check_lesson(JsonReader& json, const JsonNode& own, const StudyLesson& lesson) {
    const JsonNode display = member_of(json, own, "display"), file = member_of(json, own, "displays"),
                   hand = member_of(json, own, "hand");
    if (lesson.display == "walls" && lesson.displays.empty() && display)
        json.report(display.pointer, "the walls are not described",
                    "\"displays\", their display file, with it");
    // The study's "lesson" may name the file for those lessons that are on walls.
    const JsonNode own_file = json.member(own, "displays");
    if (own_file && lesson.display != "walls")
        json.report(file.pointer, "only a lesson on walls has a display file",
                    "\"display\": \"walls\" with it", JsonPart::key);
    if (lesson.display == "headset") return check_headset(json, own, lesson);
    if (hand && lesson.hand == "tracked")
        json.report(hand.pointer, "only a headset tracks the hand", "\"display\": \"headset\" with it");
}

bool names_displays(const Study& study) {
    const auto names = [](const StudyLesson& lesson) { return !lesson.display.empty(); };
    return (study.training && names(study.training->lesson)) ||
           (study.retention && names(study.retention->lesson)) ||
           std::any_of(study.conditions.begin(), study.conditions.end(),
                       [&](const StudyCondition& condition) { return names(condition.lesson); });
}

}  // namespace bolt::content
