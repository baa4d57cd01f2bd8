#include "game/analysis/session_data.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "content/format/assembly.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/lesson.hpp"
#include "haptics/joint/design.hpp"

namespace bolt::analysis {

namespace {

CurveRequest request_for(const SessionData& data, const std::vector<lesson::LessonEvent>& events) {
    CurveRequest request;
    request.dt = data.header.dt;
    request.direction = data.direction();
    for (const content::AssemblyJoint& joint : data.assembly.joints)
        request.snug_torque.push_back(joint.spec.snug_torque);
    for (const lesson::LessonEvent& event : events)
        if (event.kind == lesson::EventKind::pass_begin) request.pass_begins.push_back(event.tick);
    std::sort(request.pass_begins.begin(), request.pass_begins.end());
    if (data.direction() == joint::Direction::tighten && lesson::turns_by_angle(data.assembly))
        for (const content::Pass& pass : data.assembly.passes)
            request.turns_by_angle.push_back(pass.kind == content::PassKind::turn);
    return request;
}

}  // namespace

Result<content::Assembly> stored_assembly(const session::SessionReader& session) {
    const session::Header& header = session.header();
    const std::string name = header.assembly_file.empty() ? header.assembly : header.assembly_file;
    content::LoadedAssembly loaded = content::parse_assembly(header.assembly_text, name, header.variant);
    if (!loaded.ok()) {
        Error error;
        error.code = ErrorCode::failed;
        error.file = session.file();
        error.what = "the assembly stored in this session cannot be read: " + loaded.errors.front().message();
        error.expected = "a session of this program or an older one";
        return fail(std::move(error));
    }
    BOLT_TRY(content::choose_tool(loaded.assembly, header.tool));
    return lesson::apply_law(std::move(loaded.assembly), header.law, header.rules.law_adaptation);
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

Result<SessionData> read_session(const session::SessionReader& session) {
    Result<content::Assembly> assembly = stored_assembly(session);
    if (!assembly) return fail(assembly.error());
    const Result<lesson::LessonResult> result = session.result();
    if (!result) return fail(result.error());
    const Result<std::vector<lesson::LessonEvent>> events = session.events();
    if (!events) return fail(events.error());

    SessionData data;
    data.file = session.file();
    data.header = session.header();
    data.complete = session.complete();
    data.recorded_duration = static_cast<double>(session.tick_count()) * data.header.dt;
    data.assembly = std::move(*assembly);
    data.joints = results_by_joint(data.assembly, result->joints);
    data.duration = result->duration > 0.0 ? result->duration : data.recorded_duration;
    data.score = result->score;
    data.finished = result->finished;
    data.reasons = result->reasons;
    for (const lesson::LessonEvent& event : *events)
        if (event.kind == lesson::EventKind::pass_begin) data.pass_texts.push_back(event.text);

    CurveBuilder builder(request_for(data, *events));
    std::vector<Vec3> seats;
    for (const content::AssemblyJoint& joint : data.assembly.joints) seats.push_back(joint.design.seat);
    HapticMetricsBuilder metrics(data.header, *events, std::move(seats));
    const Status read =
        session.for_each_chunk([&](std::uint64_t first, std::span<const session::TickRecord> ticks) {
            builder.add(first, ticks);
            metrics.add(first, ticks);
        });
    if (!read) return fail(read.error());
    data.curves = builder.finish();
    data.metrics = metrics.finish();
    Result<std::optional<servo::Timing>> timing = session.timing();
    if (!timing) return fail(timing.error());
    data.metrics.timing = std::move(*timing);
    return data;
}

double target_clamp(const content::Assembly& assembly, std::size_t joint) {
    const content::AssemblyJoint& j = assembly.joints[joint];
    if (j.spec.target_clamp > 0.0) return j.spec.target_clamp;
    if (assembly.law == joint::Law::published)
        return j.spec.torque.target / joint::published_lever(j.published.law, joint::Direction::tighten);
    const joint::FastenerSize& size = j.design.thread.size;
    const double hole = j.design.washer_under_turned() > 0.0 ? size.washer_inner : size.hole;
    const joint::TorqueLevers levers =
        joint::torque_levers(j.design.thread.thread, j.design.friction.thread, j.design.friction.bearing,
                             joint::bearing_mean_diameter(joint::turned_part_size(j.design).bearing, hole));
    const double torque = std::max(0.0, j.spec.torque.target - j.design.prevailing_torque);
    return levers.tightening_lever() > 0.0 ? torque / levers.tightening_lever() : nan;
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
        // Welford's algorithm, for the deviation of forces that differ little.
        const double delta = r.clamp - s.clamp_mean;
        s.clamp_mean += delta / static_cast<double>(s.judged);
        squares += delta * (r.clamp - s.clamp_mean);
    }
    const auto n = static_cast<double>(s.judged);
    // A loosening torque has no target.
    const bool has_target = session.direction() == joint::Direction::tighten;
    if (s.judged == 0) s.clamp_mean = s.clamp_low = s.clamp_high = nan;
    s.mean_torque_error = s.judged > 0 && has_target ? errors / n : nan;
    s.clamp_deviation = s.judged > 1 ? std::sqrt(squares / (n - 1.0)) : nan;
    return s;
}

std::string title_of(const content::Assembly& assembly) {
    const auto english = assembly.title.find("en");
    if (english != assembly.title.end()) return english->second;
    return assembly.title.empty() ? assembly.name : assembly.title.begin()->second;
}

namespace {

struct VisitStart {
    double begin = 0.0;
    int pass = 0;
    std::size_t joint = 0;
};

std::vector<VisitStart> visits_in_time(const SessionData& session) {
    std::vector<VisitStart> visits;
    for (std::size_t j = 0; j < session.curves.size(); ++j)
        for (const Visit& visit : session.curves[j].visits)
            if (visit.worked) visits.push_back({visit.begin, visit.pass, j});
    std::stable_sort(visits.begin(), visits.end(),
                     [](const VisitStart& a, const VisitStart& b) { return a.begin < b.begin; });
    return visits;
}

// Marks the smallest set of joints that would have to move for the planned order: those outside the longest
// ascending subsequence of planned positions. A swap marks up to two joints, a late joint one.
void mark_out_of_turn(PassOrder& order) {
    if (order.planned.empty()) return;
    std::vector<std::size_t> turns;  // first visits of planned joints
    for (std::size_t i = 0; i < order.actual.size(); ++i) {
        const OrderEntry& turn = order.actual[i];
        if (turn.repeated) continue;
        order.actual[i].out_of_turn = true;
        if (order.planned_position(turn.joint) > 0) turns.push_back(i);
    }
    std::vector<std::size_t> length(turns.size(), 1), before(turns.size());
    std::size_t end = 0;
    for (std::size_t i = 0; i < turns.size(); ++i) {
        before[i] = i;
        for (std::size_t k = 0; k < i; ++k) {
            const bool rises = order.planned_position(order.actual[turns[k]].joint) <
                               order.planned_position(order.actual[turns[i]].joint);
            if (!rises || length[k] + 1 <= length[i]) continue;
            length[i] = length[k] + 1;
            before[i] = k;
        }
        if (length[i] > length[end]) end = i;
    }
    for (std::size_t left = turns.empty() ? 0 : length[end]; left > 0; --left) {
        order.actual[turns[end]].out_of_turn = false;
        end = before[end];
    }
}

}  // namespace

bool PassOrder::in_turn() const {
    return std::none_of(actual.begin(), actual.end(),
                        [](const OrderEntry& t) { return t.out_of_turn || t.repeated; });
}

bool PassOrder::as_planned() const { return !planned.empty() && in_turn() && skipped_joints() == 0; }

std::size_t PassOrder::skipped_joints() const {
    return static_cast<std::size_t>(std::count_if(planned.begin(), planned.end(),
                                                  [&](std::size_t j) { return actual_position(j) == 0; }));
}

std::size_t PassOrder::planned_position(std::size_t joint) const {
    const auto found = std::find(planned.begin(), planned.end(), joint);
    return found == planned.end() ? 0 : static_cast<std::size_t>(found - planned.begin()) + 1;
}

std::size_t PassOrder::actual_position(std::size_t joint) const {
    std::size_t position = 0;
    for (const OrderEntry& turn : actual) {
        if (!turn.repeated) ++position;
        if (turn.joint == joint) return position;
    }
    return 0;
}

std::size_t PassOrder::visits(std::size_t joint) const {
    return static_cast<std::size_t>(
        std::count_if(actual.begin(), actual.end(), [&](const OrderEntry& t) { return t.joint == joint; }));
}

std::vector<OrderDrawing> order_drawings(const std::vector<PassOrder>& orders) {
    std::vector<OrderDrawing> drawings;
    for (const PassOrder& order : orders) {
        if (order.actual.empty()) continue;
        const auto same = std::find_if(drawings.begin(), drawings.end(), [&](const OrderDrawing& d) {
            return d.order.as_planned() && order.as_planned() && d.order.planned == order.planned;
        });
        if (same == drawings.end()) {
            drawings.push_back({order, 1});
            continue;
        }
        same->order.label += ", " + order.label;
        ++same->passes;
    }
    return drawings;
}

std::string pass_label(const content::Pass& pass) {
    switch (pass.kind) {
        case content::PassKind::run_down:
            return "run-down";
        case content::PassKind::turn:
            return fmt::format("angle {:.0f} %", 100.0 * pass.fraction);
        case content::PassKind::recheck:
            return "re-check";
        case content::PassKind::loosen:
            return pass.turn_back > 0.0 ? fmt::format("back {:.0f}°", to_degrees(pass.turn_back))
                                        : "loosening";
        case content::PassKind::tighten:
            break;
    }
    return fmt::format("{:.0f} %", 100.0 * pass.fraction);
}

std::vector<PassOrder> pass_orders(const SessionData& session) {
    const bool loosening = session.direction() == joint::Direction::loosen;
    const std::vector<content::Pass> passes =
        loosening ? lesson::loosening_passes(session.assembly) : session.assembly.passes;
    // Very old sessions have no pass_begin events.
    const bool has_passes = !session.pass_texts.empty() && (!loosening || passes.size() > 1);
    std::vector<PassOrder> orders;
    if (!has_passes && !loosening && passes.size() != 1) {
        orders.push_back({"whole session", {}, {}});
    } else {
        for (const content::Pass& pass : passes) orders.push_back({pass_label(pass), pass.order, {}});
    }
    for (PassOrder& order : orders)
        std::erase_if(order.planned, [&](std::size_t j) { return j >= session.joints.size(); });
    for (const VisitStart& visit : visits_in_time(session)) {
        const std::size_t at = has_passes ? static_cast<std::size_t>(visit.pass) : 0;
        while (orders.size() <= at) orders.push_back({fmt::format("pass {}", orders.size() + 1), {}, {}});
        PassOrder& order = orders[at];
        order.actual.push_back({visit.joint, false, order.actual_position(visit.joint) > 0});
    }
    for (PassOrder& order : orders) mark_out_of_turn(order);
    return orders;
}

}  // namespace bolt::analysis
