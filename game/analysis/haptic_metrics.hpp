// Metrics of the rendered force in a session, except the nuts' torque: collisions with obstacles, changes of
// the force, times to reach the nuts, and times in which the output stage released the force.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "game/lesson/result.hpp"
#include "game/session/session_file.hpp"

namespace bolt::analysis {

// A contact of the wrench while it holds no nut. Contacts with the due nut or the nut held last belong to the
// work and do not count, nor does a contact that began with a nut in the jaw.
struct ObstacleContact {
    double begin = 0.0, length = 0.0;  // s
    collision::ObstacleId obstacle;    // the first one of the contact
    double peak_force = 0.0;           // N
};

// A tick with a large change of the force, and its circumstances.
struct ForceJump {
    double time = 0.0;    // s
    double change = 0.0;  // N in a millisecond
    session::TickRecord tick;
    // s since the last time that the tool engaged or released a nut, and since a contact began or ended; NaN:
    // never
    double since_engaged = nan, since_released = nan, since_contact_begin = nan, since_contact_end = nan;
    std::int16_t last_joint = -1;  // engaged joint, or the one engaged last
    collision::ObstacleId last_touched;
};

struct ChangeStatistics {
    double greatest = 0.0, p99 = 0.0;  // change in a millisecond
    std::uint64_t ticks = 0;           // ticks with output; p99, above and at_limit count only these
    std::uint64_t above = 0;           // changes above a tenth of the device's maximum; 0 if that is unknown
    std::uint64_t at_limit = 0;        // changes at the rate limit of the output stage
};

// The activity of the tool in a tick. activity_of() returns the first that applies.
enum class ToolActivity : std::uint8_t {
    output_off,  // a fault released the force
    releasing,   // released a nut within the last 10 ms
    engaging,    // engaged a nut within the last 10 ms
    on_nut,
    touching,  // a contact without a nut, or one that ended within the last 10 ms
    free
};
inline constexpr std::size_t activity_count = 6;

// Visible fraction from which a nut counts as visible.
inline constexpr double visible_fraction = 0.6;

// The time from a step's beginning until the tool engages its nut.
struct Arrival {
    int joint = 0;
    bool wrench = false;       // engaged with the wrench, otherwise with the fingers
    double duration = 0.0;     // s
    double near_nut = 0.0;     // s within `duration` in which the tool was within 40 mm of the nut's seat
    double nut_visible = 0.0;  // s within `near_nut` with a visible nut (visible_fraction); NaN: not recorded
};

struct HapticMetrics {
    bool has_contacts_and_faults = false;  // false: a session of format 1
    bool has_contact_models = false;
    bool guided = false;  // the guiding force was on
    std::optional<force::OutputLimits> device_limits;
    std::vector<ObstacleContact> obstacle_contacts;  // in order of time
    ChangeStatistics force, torque;                  // N, N·m
    // Ticks with a change of the force at the rate limit of the output stage, by activity.
    std::array<std::uint64_t, activity_count> at_limit{};
    std::vector<ForceJump> force_jumps;  // the largest ones, largest first
    std::vector<Arrival> arrivals;
    std::array<double, force::fault_kinds> faults{};  // s for which each fault released the output
    std::string servo_text;  // "1000 Hz" or "virtual time"; empty if `has_contacts_and_faults` is false
    std::optional<servo::Timing> timing;
};

// Computes the metrics from the ticks in order, in pieces of any size.
class HapticMetricsBuilder {
  public:
    // `seats`: position of each nut's seat, m.
    HapticMetricsBuilder(const session::Header& header, std::span<const lesson::LessonEvent> events,
                         std::vector<Vec3> seats);

    void add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks);
    HapticMetrics finish();

  private:
    struct StepBegin {
        std::uint64_t tick = 0;
        int joint = -1;
    };
    void add_tick(std::uint64_t number, const session::TickRecord& tick);
    struct VisibilitySample {
        std::uint64_t tick = 0;
        int joint = -1;
        double share = 0.0;
    };
    void update_grip(double time, const session::TickRecord& tick);
    void update_touch(double time, const session::TickRecord& tick);
    void update_change(double time, const session::TickRecord& tick);
    void keep_force_jump(const ForceJump& jump);
    [[nodiscard]] bool own_nut(collision::ObstacleId obstacle) const;

    HapticMetrics metrics_;
    double dt_;
    std::vector<Vec3> seats_;
    std::vector<StepBegin> steps_;
    std::size_t next_step_ = 0;
    std::vector<VisibilitySample> visibilities_;
    std::size_t next_visibility_ = 0;
    VisibilitySample visibility_;
    int due_ = -1;
    bool arrived_ = true;
    double step_begun_ = 0.0, near_nut_ = 0.0, nut_visible_ = 0.0;
    double visibility_unknown_ = 0.0;  // s near the nut without a value for it
    std::optional<session::TickRecord> previous_;
    ForceJump latest_;  // last joint and last obstacle so far
    // s, session time of the last events
    double engaged_at_ = nan, released_at_ = nan;
    double contact_begin_ = nan, contact_end_ = nan;
    bool touched_with_nut_ = false;  // the contact began with a nut in the jaw
    bool in_obstacle_contact_ = false;
    std::vector<float> force_changes_, torque_changes_;
};

ToolActivity activity_of(const ForceJump& jump);

// English description of the circumstances: "wrench engages B3", "led to B3, against casing_upper".
std::string describe(const ForceJump& jump, const std::vector<lesson::JointResult>& joints,
                     const std::vector<session::ObstacleName>& obstacles);
std::string obstacle_text(collision::ObstacleId id, const std::vector<session::ObstacleName>& obstacles);

}  // namespace bolt::analysis
