#include "game/session/summary.hpp"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/base/math.hpp"

namespace bolt::session {

namespace {

double rounded(double value, double digits) { return std::round(value * digits) / digits; }

}  // namespace

std::string summary_json(const content::Assembly& assembly, const CourseOptions& options,
                         const Played& played) {
    const lesson::LessonResult& result = played.result;
    nlohmann::ordered_json json;
    json["assembly"] = assembly.name;
    json["variant"] = assembly.variant;
    json["tool"] = assembly.tool;
    json["law"] = joint::name(options.law);
    json["mode"] = lesson::name(options.mode);
    json["task"] = lesson::name(options.task);
    json["guide"] = options.guide && options.mode == lesson::Mode::guided;
    json["obstacles"] = played.obstacles;
    json["operator"] = options.operator_name;
    json["trainee"] = options.trainee;
    json["seed"] = options.seed;
    json["duration_s"] = rounded(result.duration, 1e3);
    json["score"] = rounded(result.score, 1e2);
    json["finished"] = result.finished;
    json["joints"] = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < result.joints.size(); ++i) {
        const lesson::JointResult& joint = result.joints[i];
        json["joints"].push_back({{"id", joint.id},
                                  {"torque_Nm", rounded(joint.torque, 1e3)},
                                  {"target_torque_Nm", rounded(assembly.joints[i].spec.torque.target, 1e3)},
                                  {"angle_deg", rounded(to_degrees(joint.angle), 1e2)},
                                  {"clamp_N", rounded(joint.clamp, 1.0)},
                                  {"verdict", lesson::name(joint.overall)}});
    }
    return json.dump(2) + "\n";
}

std::string summary_table(const content::Assembly& assembly, const lesson::LessonResult& result) {
    std::string table = fmt::format("{:<8} {:<8} {:>9} {:>9} {:>8} {:>8}  {}\n", "joint", "size", "torque",
                                    "clamp", "target", "angle", "verdict");
    table += fmt::format("{:<8} {:<8} {:>9} {:>9} {:>8} {:>8}\n", "", "", "N·m", "kN", "N·m", "deg");
    for (std::size_t i = 0; i < result.joints.size(); ++i) {
        const lesson::JointResult& joint = result.joints[i];
        const content::AssemblyJoint& given = assembly.joints[i];
        std::string verdict(lesson::name(joint.overall));
        if (joint.condition != joint::Condition::sound)
            verdict += fmt::format(" ({})", joint::name(joint.condition));
        if (joint.order_errors > 0) verdict += fmt::format(", {}× out of turn", joint.order_errors);
        if (joint.rehits > 0) verdict += fmt::format(", {}× again", joint.rehits);
        table += fmt::format("{:<8} {:<8} {:>8.1f} {:>9.2f} {:>8.1f} {:>8.1f}  {}\n", joint.id,
                             given.design.thread.size.name, joint.torque, joint.clamp / 1e3,
                             given.spec.torque.target, to_degrees(joint.angle), verdict);
    }
    table += fmt::format("{:.1f} s, score {:.1f} of 100\n", result.duration, result.score);
    for (const lesson::ScoreReason& reason : result.reasons)
        table += reason.points == 0.0 ? fmt::format("  {:>6}  {}\n", "", reason.text)
                                      : fmt::format("  {:>+6.1f}  {}\n", reason.points, reason.text);
    return table;
}

}  // namespace bolt::session
