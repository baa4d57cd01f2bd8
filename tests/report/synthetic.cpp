#include "tests/report/synthetic.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/random.hpp"

namespace bolt::report {

using namespace analysis;

namespace {

constexpr double lever = 2.55e-3;   // m, torque per clamp force
constexpr double target = 206.0;    // N·m
constexpr double yields_at = 80e3;  // N

// Records the ticks of a wrench or of fingers on the nuts.
struct TickScript {
    SyntheticSession& session;
    double dt;
    std::vector<double> angle;  // degrees from the hand-started nut
    double seat;                // degrees

    void tick(int joint, double torque, servo::Grip grip) {
        session::TickRecord t;
        t.joint = static_cast<std::int16_t>(joint);
        t.grip = static_cast<std::uint8_t>(grip);
        if (joint >= 0) {
            const double at = angle[static_cast<std::size_t>(joint)];
            t.nut_angle = static_cast<float>(to_radians(at));
            t.wrench_torque = static_cast<float>(torque);
            t.clamp = static_cast<float>(synthetic_clamp(at - seat));
            t.stage = static_cast<std::uint8_t>(synthetic_stage(at - seat));
        }
        session.ticks.push_back(t);
    }

    void pause(double seconds) {
        for (double t = 0.0; t < seconds; t += dt) tick(-1, 0.0, servo::Grip::none);
    }

    void run_down(int joint, Random& random) {
        double& at = angle[static_cast<std::size_t>(joint)];
        while (at < seat - 8.0) {
            at += 540.0 * dt;
            tick(joint, 0.02 + 0.004 * random.normal(), servo::Grip::fingers);
        }
        pause(0.8);
    }

    // Strokes until the torque is reached; the wrench is loaded and unloaded at rest.
    int tighten(int joint, double until) {
        double& at = angle[static_cast<std::size_t>(joint)];
        int strokes = 0;
        while (synthetic_torque(at - seat) < until && strokes < 40) {
            ++strokes;
            const double holds = synthetic_torque(at - seat);
            for (double s = 0.0; s < 1.0; s += dt / 0.2) tick(joint, s * holds, servo::Grip::wrench);
            const double from = at;
            while (at < from + 40.0 && synthetic_torque(at - seat) < until) {
                at += 25.0 * dt;
                tick(joint, synthetic_torque(at - seat), servo::Grip::wrench);
            }
            const double reached = synthetic_torque(at - seat);
            for (double s = 1.0; s > 0.0; s -= dt / 0.1) tick(joint, s * reached, servo::Grip::wrench);
            pause(0.5);
        }
        return strokes;
    }
};

lesson::Verdict verdict_of(double value, const content::ToleranceWindow& window) {
    if (value < window.low) return lesson::Verdict::low;
    return value > window.high ? lesson::Verdict::high : lesson::Verdict::ok;
}

}  // namespace

double synthetic_clamp(double degrees) {
    constexpr double width = 5.0, slope = 2.1e3;
    const double x = degrees / width;
    const double elastic = slope * width * (x > 30.0 ? x : std::log1p(std::exp(x)));
    if (elastic <= yields_at) return elastic;
    constexpr double more = 12e3;
    return yields_at + more * (1.0 - std::exp(-(elastic - yields_at) / more));
}

double synthetic_torque(double degrees) { return 0.02 + lever * synthetic_clamp(degrees); }

joint::Stage synthetic_stage(double degrees) {
    const double clamp = synthetic_clamp(degrees);
    if (clamp < 200.0) return joint::Stage::navigation;
    if (clamp < 9e3) return joint::Stage::transition;
    return clamp < yields_at ? joint::Stage::linearity : joint::Stage::yield;
}

content::Assembly synthetic_assembly() {
    content::Assembly assembly;
    assembly.name = "flange";
    assembly.title["en"] = "Split casing, upper half";
    assembly.variant = "carbon";
    for (int i = 0; i < 12; ++i) {
        content::AssemblyJoint joint;
        joint.design.id = "J" + std::string(i < 9 ? "0" : "") + std::to_string(i + 1);
        joint.design.thread.size.name = "M16";
        joint.design.thread.size.hole = 17.5e-3;
        joint.design.thread.size.nut_bearing = 22.5e-3;
        joint.design.thread.thread = joint::metric_thread(16e-3, 2e-3);
        joint.design.bolt_class.name = "8.8";
        joint.design.bolt_length = i % 6 == 0 || i % 6 == 5 ? 75e-3 : 180e-3;
        joint.design.seat = Vec3{-0.32 + 0.128 * (i % 6), 0.2, i < 6 ? -0.12 : 0.12};
        joint.spec.torque = {target, 0.9 * target, 1.1 * target};
        joint.spec.snug_torque = 20.0;
        joint.spec.target_clamp = 80.9e3;
        assembly.joints.push_back(joint);
    }
    const std::vector<std::size_t> cross = {2, 9, 3, 8, 1, 10, 4, 7, 0, 11, 5, 6};
    std::vector<std::size_t> round = {0, 1, 2, 3, 4, 5, 11, 10, 9, 8, 7, 6};
    assembly.passes = {{content::PassKind::run_down, 1.0, round},
                       {content::PassKind::tighten, 0.3, cross},
                       {content::PassKind::tighten, 0.7, cross},
                       {content::PassKind::tighten, 1.0, cross}};
    return assembly;
}

SyntheticSession synthetic_session(const SyntheticOptions& options) {
    SyntheticSession session;
    SessionData& data = session.data;
    data.assembly = synthetic_assembly();
    data.file = "out/session.bolt";
    session::Header& header = data.header;
    header.assembly = "flange";
    header.assembly_file = "flange/assembly.json";
    header.variant = "carbon";
    header.law = joint::Law::mechanistic;
    header.mode = lesson::Mode::practice;
    header.task = lesson::Task::tighten;
    header.trainee_profile = "expert";
    header.trainee = "";
    header.seed = options.seed;
    header.dt = options.dt;
    header.program = "boltwright 0.1.0";
    Random random(options.seed);
    const std::size_t count = data.assembly.joints.size();
    TickScript hand{session, options.dt, std::vector<double>(count, 0.0), 360.0 * options.run_down_turns};
    data.joints = results_by_joint(data.assembly, {});
    const std::size_t passes = data.assembly.passes.size() - (options.cut_short ? 1 : 0);
    for (std::size_t p = 0; p < passes; ++p) {
        const content::Pass& pass = data.assembly.passes[p];
        session.events.push_back(
            {session.ticks.size(), lesson::EventKind::pass_begin, -1, static_cast<double>(p), ""});
        data.pass_texts.emplace_back();
        std::vector<std::size_t> order = pass.order;
        if (options.slips && p == 2) std::swap(order[3], order[6]);
        if (options.slips && p + 1 == passes) order.pop_back();
        for (const std::size_t j : order) {
            const int joint = static_cast<int>(j);
            if (pass.kind == content::PassKind::run_down) {
                hand.run_down(joint, random);
                continue;
            }
            double until = pass.fraction * target * (1.0 + options.scatter * random.normal());
            if (options.slips && p + 1 == passes && j == 4) until = 1.12 * target;
            if (options.slips && p + 1 == passes && j == 7) until = 0.86 * target;
            data.joints[j].strokes += hand.tighten(joint, until);
        }
    }
    CurveRequest request;
    request.snug_torque.assign(count, data.assembly.joints.front().spec.snug_torque);
    request.dt = options.dt;
    for (const lesson::LessonEvent& event : session.events) request.pass_begins.push_back(event.tick);
    CurveBuilder builder(request);
    builder.add(0, session.ticks);
    data.curves = builder.finish();
    for (std::size_t j = 0; j < count; ++j) {
        lesson::JointResult& r = data.joints[j];
        const JointCurve& curve = data.curves[j];
        if (curve.visits.empty()) continue;
        r.torque = curve.visits.back().peak.torque;
        r.angle = std::isfinite(curve.mark) ? curve.end_angle - curve.mark : 0.0;
        r.clamp_at_release = curve.visits.back().release.clamp;
        r.clamp = r.clamp_at_release * (0.965 + 0.01 * random.normal());
        r.torque_verdict = r.overall = verdict_of(r.torque, data.assembly.joints[j].spec.torque);
    }
    if (options.slips) {
        data.joints[7].done_already = 1;
        data.joints[data.assembly.passes[2].order[6]].out_of_turn = 1;
        data.joints[11].condition = joint::JointCondition::stripped;
        data.joints[11].overall = lesson::Verdict::high;
        data.reasons = {{100.0, "twelve joints to do"},
                        {-8.0, "J05: torque 12 % above the target"},
                        {-4.0, "one joint taken out of turn"},
                        {-1.5, "J08: hit again after it was done"}};
    } else {
        data.reasons = {{100.0, "twelve joints to do"}, {-1.0, "scatter of the clamp force above 3 %"}};
    }
    data.score = 0.0;
    for (const lesson::Deduction& reason : data.reasons) data.score += reason.points;
    data.complete = !options.cut_short;
    data.finished = !options.cut_short;
    data.recorded_duration = data.duration = static_cast<double>(session.ticks.size()) * options.dt;
    return session;
}

}  // namespace bolt::report
