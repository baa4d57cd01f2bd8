#include "game/trainer/lesson_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace bolt::trainer {

Result<std::string> tool_of_station(const content::StationFile& station,
                                    std::span<const content::Tool> tools) {
    if (!station.arm || station.arm->tool.empty()) return std::string();
    const std::string& name = station.arm->tool;
    std::vector<std::string> names;
    for (const content::Tool& tool : tools) {
        if (tool.name == name) return names.empty() ? std::string() : name;
        names.push_back(tool.name);
    }
    return fail(ErrorCode::bad_content,
                fmt::format("the assembly does not have the tool of the station's arm, \"{}\"", name),
                fmt::format("one of its tools: {}", fmt::join(names, ", ")));
}

joint::Law effective_law(const LessonChoice& choice, const content::TraineeSettings& settings,
                         joint::Law assembly_law) {
    if (choice.law) return *choice.law;
    return joint::law_named(settings.law).value_or(assembly_law);
}

}  // namespace bolt::trainer
