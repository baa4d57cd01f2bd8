#include "game/analysis/session_data.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "content/format/assembly.hpp"
#include "game/lesson/plan.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::analysis {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

CurveRequest request_for(const SessionData& data, const std::vector<lesson::Event>& events) {
    CurveRequest request;
    request.dt = data.header.dt;
    request.direction = data.direction();
    for (const content::AssemblyJoint& joint : data.assembly.joints)
        request.snug_torque.push_back(joint.spec.snug_torque);
    for (const lesson::Event& event : events)
        if (event.kind == "pass_begin") request.pass_begins.push_back(event.tick);
    std::sort(request.pass_begins.begin(), request.pass_begins.end());
    return request;
}

}  // namespace

Result<content::Assembly> stored_assembly(const session::Reader& session) {
    const session::Header& header = session.header();
    const std::string name = header.assembly_file.empty() ? header.assembly : header.assembly_file;
    content::Loaded loaded = content::parse_assembly(header.assembly_text, name, header.variant);
    if (!loaded.ok()) {
        Error error;
        error.code = ErrorCode::failed;
        error.file = session.file();
        error.what = "the assembly stored in this session cannot be read: " + loaded.errors.front().message();
        return fail(std::move(error));
    }
    for (const joint::Law law : {joint::Law::published, joint::Law::mechanistic})
        if (header.law == joint::name(law)) loaded.assembly.law = law;
    const joint::Law law = loaded.assembly.law;
    return lesson::under_law(std::move(loaded.assembly), law);
}

std::vector<lesson::JointResult> results_by_joint(const content::Assembly& assembly,
                                                  const std::vector<lesson::JointResult>& given) {
    std::vector<lesson::JointResult> results;
    for (const content::AssemblyJoint& joint : assembly.joints) {
        const auto named = [&](const lesson::JointResult& r) { return r.id == joint.design.id; };
        const auto found = std::find_if(given.begin(), given.end(), named);
        results.push_back(found != given.end() ? *found : lesson::JointResult{});
        results.back().id = joint.design.id;
    }
    return results;
}

Result<SessionData> read_session(const session::Reader& session) {
    Result<content::Assembly> assembly = stored_assembly(session);
    if (!assembly) return fail(assembly.error());
    const Result<lesson::LessonResult> result = session.result();
    if (!result) return fail(result.error());
    const Result<std::vector<lesson::Event>> events = session.events();
    if (!events) return fail(events.error());

    SessionData data;
    data.file = session.file();
    data.header = session.header();
    data.complete = session.complete();
    data.recorded = static_cast<double>(session.tick_count()) * data.header.dt;
    data.assembly = std::move(*assembly);
    data.joints = results_by_joint(data.assembly, result->joints);
    data.duration = result->duration > 0.0 ? result->duration : data.recorded;
    data.score = result->score;
    data.finished = result->finished;
    data.reasons = result->reasons;
    for (const lesson::Event& event : *events)
        if (event.kind == "pass_begin") data.pass_texts.push_back(event.text);

    CurveBuilder builder(request_for(data, *events));
    std::vector<Vec3> seats;
    for (const content::AssemblyJoint& joint : data.assembly.joints) seats.push_back(joint.design.seat);
    FeelBuilder feel(data.header, *events, std::move(seats));
    const Status read =
        session.for_each_chunk([&](std::uint64_t first, std::span<const session::TickRecord> ticks) {
            builder.add(first, ticks);
            feel.add(first, ticks);
        });
    if (!read) return fail(read.error());
    data.curves = builder.finish();
    data.feel = feel.finish();
    Result<std::optional<servo::Timing>> timing = session.timing();
    if (!timing) return fail(timing.error());
    data.feel.timing = std::move(*timing);
    return data;
}

double target_clamp(const content::Assembly& assembly, std::size_t joint) {
    const content::AssemblyJoint& j = assembly.joints[joint];
    if (j.spec.target_clamp > 0.0) return j.spec.target_clamp;
    if (assembly.law == joint::Law::published)
        return j.spec.torque.target / joint::published_lever(assembly.published, joint::Direction::tighten);
    const joint::FastenerSize& size = j.design.thread.size;
    const double hole = j.design.washer_under_nut ? size.washer_inner : size.hole;
    const joint::TorqueLevers levers =
        joint::torque_levers(j.design.thread.thread, j.design.friction.thread, j.design.friction.bearing,
                             joint::bearing_mean_diameter(size.nut_bearing, hole));
    return levers.tighten() > 0.0 ? j.spec.torque.target / levers.tighten() : nan;
}

Summary summarise(const SessionData& session) {
    Summary s;
    s.joints = session.joints.size();
    s.clamp_low = std::numeric_limits<double>::infinity();
    s.clamp_high = -s.clamp_low;
    double squares = 0.0, errors = 0.0;
    for (std::size_t i = 0; i < session.joints.size(); ++i) {
        const lesson::JointResult& r = session.joints[i];
        if (r.overall == lesson::Verdict::none) continue;
        ++s.judged;
        if (r.overall == lesson::Verdict::ok) ++s.ok;
        const double target = session.assembly.joints[i].spec.torque.target;
        errors += target > 0.0 ? std::abs(r.torque - target) / target : 0.0;
        if (r.clamp < s.clamp_low) s.lowest = i;
        if (r.clamp > s.clamp_high) s.highest = i;
        s.clamp_low = std::min(s.clamp_low, r.clamp);
        s.clamp_high = std::max(s.clamp_high, r.clamp);
        // Welford: the spread of forces that differ little.
        const double delta = r.clamp - s.clamp_mean;
        s.clamp_mean += delta / static_cast<double>(s.judged);
        squares += delta * (r.clamp - s.clamp_mean);
    }
    const auto n = static_cast<double>(s.judged);
    const bool asked = session.direction() == joint::Direction::tighten;  // a loosening torque has no target
    if (s.judged == 0) s.clamp_mean = s.clamp_low = s.clamp_high = nan;
    s.mean_torque_error = s.judged > 0 && asked ? errors / n : nan;
    s.clamp_deviation = s.judged > 1 ? std::sqrt(squares / (n - 1.0)) : nan;
    return s;
}

std::string title_of(const content::Assembly& assembly) {
    const auto english = assembly.title.find("en");
    if (english != assembly.title.end()) return english->second;
    return assembly.title.empty() ? assembly.name : assembly.title.begin()->second;
}

}  // namespace bolt::analysis
