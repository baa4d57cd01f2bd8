#include "game/analysis/joint_curve.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "engine/base/math.hpp"

namespace bolt::analysis {

namespace {

// True if the samples differ at most in their time.
bool same_reading(const CurvePoint& a, const CurvePoint& b) {
    return a.angle == b.angle && a.torque == b.torque && a.clamp == b.clamp && a.stage == b.stage &&
           a.hold == b.hold;
}

}  // namespace

CurveDecimator::CurveDecimator(std::size_t max_buckets)
    : max_buckets_(std::max<std::size_t>(2, max_buckets)) {}

void CurveDecimator::merge(Bucket& into, const Bucket& next) {
    if (next.low.torque < into.low.torque) into.low = next.low;
    if (next.high.torque > into.high.torque) into.high = next.high;
    into.last = next.last;
    into.count += next.count;
}

void CurveDecimator::halve() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < buckets_.size(); i += 2, ++kept) {
        Bucket merged = buckets_[i];
        if (i + 1 < buckets_.size()) merge(merged, buckets_[i + 1]);
        buckets_[kept] = merged;
    }
    buckets_.resize(kept);
    bucket_samples_ *= 2;
}

void CurveDecimator::add(const CurvePoint& point) {
    if (!buckets_.empty() && same_reading(buckets_.back().last, point)) {
        buckets_.back().last.time = point.time;
        return;
    }
    const Bucket one{point, point, point, point, 1};
    if (!buckets_.empty() && buckets_.back().count < bucket_samples_) {
        merge(buckets_.back(), one);
        return;
    }
    if (buckets_.size() == max_buckets_) halve();
    buckets_.push_back(one);
}

std::vector<CurvePoint> CurveDecimator::points() const {
    std::vector<CurvePoint> out;
    for (const Bucket& bucket : buckets_) {
        CurvePoint four[] = {bucket.first, bucket.low, bucket.high, bucket.last};
        std::stable_sort(std::begin(four), std::end(four),
                         [](const CurvePoint& a, const CurvePoint& b) { return a.time < b.time; });
        for (const CurvePoint& p : four)
            if (out.empty() || !same_reading(out.back(), p)) out.push_back(p);
    }
    return out;
}

namespace {

constexpr std::size_t max_visits = 64;  // of one joint; further visits are added to the last one
constexpr std::size_t max_spans = 64;
constexpr double min_work_angle = to_radians(0.5);
constexpr double unmarked = std::numeric_limits<double>::quiet_NaN();
constexpr double min_work_torque = 0.01;  // N·m, least torque that counts as work

bool usable(const session::TickRecord& tick, std::size_t joints) {
    return tick.joint >= 0 && static_cast<std::size_t>(tick.joint) < joints &&
           tick.stage < joint::stage_count && std::isfinite(tick.nut_angle) &&
           std::isfinite(tick.wrench_torque) && std::isfinite(tick.clamp);
}

void extend(std::vector<StageSpan>& spans, joint::Stage stage, double from, double to) {
    if (!spans.empty() && (spans.back().stage == stage || spans.size() == max_spans))
        spans.back().to = to;
    else
        spans.push_back({stage, from, to});
}

}  // namespace

CurveBuilder::CurveBuilder(CurveRequest request)
    : request_(std::move(request)),
      sign_(request_.direction == joint::Direction::tighten ? 1.0 : -1.0),
      joints_(request_.snug_torque.size()) {}

void CurveBuilder::begin_visit(JointBuilder& joint, const CurvePoint& point, int pass) {
    std::vector<Visit>& visits = joint.curve.visits;
    const bool seated = point.stage != joint::Stage::navigation;
    if (turns_by_angle(pass) && seated && std::isnan(joint.curve.mark)) joint.curve.mark = point.angle;
    if (visits.size() == max_visits) {
        // Continue the last visit: feed its points to the decimator again.
        for (const CurvePoint& kept : visits.back().points) joint.points.add(kept);
        return;
    }
    Visit visit;
    visit.pass = pass;
    visit.begin = visit.end = point.time;
    visit.begin_angle = point.angle;
    visit.peak = point;
    visits.push_back(std::move(visit));
}

void CurveBuilder::end_visit(JointBuilder& joint) {
    if (joint.curve.visits.empty()) return;
    joint.curve.visits.back().points = joint.points.points();
    joint.points = CurveDecimator();
    joint.held = false;
}

// Updates the run-down, the stages and the mark. Only angles beyond all previous ones extend a stage.
void CurveBuilder::advance(JointBuilder& joint, const CurvePoint& point, double snug_torque) {
    JointCurve& curve = joint.curve;
    if (!joint.started) {
        joint.started = true;
        curve.start_angle = curve.end_angle = point.angle;
        curve.run_down.torque_low = curve.run_down.torque_high = point.torque;
    }
    joint.contact = joint.contact || point.stage != joint::Stage::navigation;
    if (!joint.contact) {
        RunDown& run = curve.run_down;
        run.time += request_.dt;
        run.angle = std::max(run.angle, sign_ * (point.angle - curve.start_angle));
        run.torque_low = std::min(run.torque_low, point.torque);
        run.torque_high = std::max(run.torque_high, point.torque);
    }
    if (sign_ * (point.angle - curve.end_angle) > 0.0) {
        extend(curve.stages, point.stage, curve.end_angle, point.angle);
        curve.end_angle = point.angle;
    }
    // As in the lesson (update_turned_torque()): a nut off its seat has no mark.
    if (sign_ > 0.0 && point.stage == joint::Stage::navigation) curve.mark = unmarked;
    const bool marks = request_.turns_by_angle.empty() || turns_by_angle(open_pass_);
    if (marks && std::isnan(curve.mark) && snug_torque > 0.0 && sign_ * point.torque >= snug_torque)
        curve.mark = point.angle;
}

bool CurveBuilder::turns_by_angle(int pass) const {
    const auto i = static_cast<std::size_t>(pass);
    return i < request_.turns_by_angle.size() && request_.turns_by_angle[i];
}

void CurveBuilder::add_sample(JointBuilder& joint, CurvePoint point, double snug_torque) {
    Visit& visit = joint.curve.visits.back();
    if (!joint.held) ++visit.holds;
    joint.held = true;
    point.hold = static_cast<std::uint16_t>(std::min(visit.holds, 65535));
    advance(joint, point, snug_torque);
    visit.end = point.time;
    if (sign_ * point.torque > sign_ * visit.peak.torque) visit.peak = point;
    visit.release = point;
    const bool turned = std::abs(point.angle - visit.begin_angle) >= min_work_angle;
    const bool loaded = sign_ * point.torque >= std::max(0.5 * snug_torque, min_work_torque);
    visit.worked = visit.worked || turned || loaded;
    joint.points.add(point);
}

void CurveBuilder::add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks) {
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const session::TickRecord& tick = ticks[i];
        if (!usable(tick, joints_.size())) {
            if (open_joint_ >= 0) joints_[static_cast<std::size_t>(open_joint_)].held = false;
            continue;
        }
        const std::uint64_t at = first_tick + i;
        const std::vector<std::uint64_t>& begins = request_.pass_begins;
        const auto begun = std::upper_bound(begins.begin(), begins.end(), at) - begins.begin();
        const int pass = std::max(0, static_cast<int>(begun) - 1);
        const CurvePoint point{static_cast<double>(at) * request_.dt,   static_cast<double>(tick.nut_angle),
                               static_cast<double>(tick.wrench_torque), static_cast<double>(tick.clamp),
                               static_cast<joint::Stage>(tick.stage),   0};
        if (tick.joint != open_joint_ || pass != open_pass_) {
            if (open_joint_ >= 0) end_visit(joints_[static_cast<std::size_t>(open_joint_)]);
            open_joint_ = tick.joint;
            open_pass_ = pass;
            begin_visit(joints_[static_cast<std::size_t>(tick.joint)], point, pass);
        }
        const auto index = static_cast<std::size_t>(tick.joint);
        // As in the lesson, fingers do not make a nut snug.
        const bool fingers = static_cast<servo::Grip>(tick.grip) == servo::Grip::fingers;
        add_sample(joints_[index], point, fingers ? 0.0 : request_.snug_torque[index]);
    }
}

std::vector<JointCurve> CurveBuilder::finish() {
    if (open_joint_ >= 0) end_visit(joints_[static_cast<std::size_t>(open_joint_)]);
    std::vector<JointCurve> curves;
    for (JointBuilder& joint : joints_) curves.push_back(std::move(joint.curve));
    joints_.clear();
    open_joint_ = -1;
    return curves;
}

}  // namespace bolt::analysis
