#include "game/analysis/torque_envelope.hpp"

#include <algorithm>
#include <cmath>

#include "engine/base/math.hpp"

namespace bolt::analysis {

namespace {
constexpr std::size_t most_samples = std::size_t{1} << 18U;
constexpr double least_step = 1e-6;  // rad
constexpr double least_turn = to_radians(1.0);
}  // namespace

AdvanceBuilder::AdvanceBuilder(joint::Direction direction)
    : sign_(direction == joint::Direction::tighten ? 1.0 : -1.0), step_(least_step) {
    curve_.direction = direction;
}

void AdvanceBuilder::restart(double nut_angle, double torque, joint::Stage stage) {
    curve_.angle.assign(1, 0.0);
    curve_.torque.assign(1, torque);
    curve_.stage.assign(1, stage);
    curve_.passed_over = 0;
    origin_ = nut_angle;
    anchor_ = 0.0;
}

// Of each pair of samples the one with more torque is kept, so that peaks stay.
void AdvanceBuilder::thin() {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < curve_.size(); i += 2, ++kept) {
        const bool second =
            i + 1 < curve_.size() && std::abs(curve_.torque[i + 1]) > std::abs(curve_.torque[i]);
        const std::size_t from = second ? i + 1 : i;
        curve_.angle[kept] = curve_.angle[from];
        curve_.torque[kept] = curve_.torque[from];
        curve_.stage[kept] = curve_.stage[from];
    }
    curve_.angle.resize(kept);
    curve_.torque.resize(kept);
    curve_.stage.resize(kept);
    step_ = std::max(2.0 * step_, curve_.angle.back() / static_cast<double>(most_samples));
}

void AdvanceBuilder::add(double nut_angle, double torque, joint::Stage stage) {
    if (!std::isfinite(nut_angle) || !std::isfinite(torque)) return;
    const bool loosening = curve_.direction == joint::Direction::loosen;
    if (curve_.empty() || (loosening && nut_angle > origin_ + step_)) {
        restart(nut_angle, torque, stage);
        return;
    }
    const double turned = sign_ * (nut_angle - origin_);
    if (curve_.size() == 1 && turned <= step_) {
        if (sign_ * torque > sign_ * curve_.torque[0]) curve_.torque[0] = torque;
        ++curve_.passed_over;
        return;
    }
    if (turned <= anchor_ + step_) {
        // Within a step that has grown, the sample with more torque stands for it: peaks stay.
        const bool further = turned > curve_.angle.back() + least_step;
        if (further && std::abs(torque) > std::abs(curve_.torque.back())) {
            curve_.angle.back() = turned;
            curve_.torque.back() = torque;
            curve_.stage.back() = stage;
        }
        if (!further) ++curve_.passed_over;
        return;
    }
    if (curve_.size() == most_samples) thin();
    anchor_ = turned;
    curve_.angle.push_back(turned);
    curve_.torque.push_back(torque);
    curve_.stage.push_back(stage);
}

Curve AdvanceBuilder::take() { return std::move(curve_); }

Curve advance_curve(std::span<const double> angle, std::span<const double> torque,
                    joint::Direction direction) {
    // A rig counts its angle upwards whichever way it turns, or as we do: what it ran through says which.
    const std::size_t count = std::min(angle.size(), torque.size());
    if (count == 0) return {};
    const double counts_up = angle[count - 1] >= angle[0] ? 1.0 : -1.0;
    const double sign = direction == joint::Direction::tighten ? 1.0 : -1.0;
    AdvanceBuilder builder(direction);
    for (std::size_t i = 0; i < count; ++i)
        builder.add(sign * counts_up * (angle[i] - angle[0]), torque[i], joint::Stage::navigation);
    Curve curve = builder.take();
    curve.stage.clear();
    return curve;
}

Result<std::vector<std::optional<Curve>>> advance_curves(const session::Reader& session, std::size_t joints,
                                                         joint::Direction direction) {
    std::vector<AdvanceBuilder> builders(joints, AdvanceBuilder(direction));
    BOLT_TRY(session.for_each_chunk([&](std::uint64_t, std::span<const session::TickRecord> ticks) {
        for (const session::TickRecord& tick : ticks) {
            if (tick.joint < 0 || static_cast<std::size_t>(tick.joint) >= joints) continue;
            const auto stage = static_cast<joint::Stage>(std::min<int>(tick.stage, joint::stage_count - 1));
            builders[static_cast<std::size_t>(tick.joint)].add(
                static_cast<double>(tick.nut_angle), static_cast<double>(tick.wrench_torque), stage);
        }
    }));
    std::vector<std::optional<Curve>> curves;
    for (AdvanceBuilder& builder : builders) {
        Curve curve = builder.take();
        const double sign = direction == joint::Direction::tighten ? 1.0 : -1.0;
        const bool loaded =
            std::any_of(curve.torque.begin(), curve.torque.end(), [&](double t) { return sign * t > 0.0; });
        const bool turned = !curve.empty() && curve.angle.back() >= least_turn;
        curves.push_back(loaded && turned ? std::optional<Curve>(std::move(curve)) : std::nullopt);
    }
    return curves;
}

}  // namespace bolt::analysis
