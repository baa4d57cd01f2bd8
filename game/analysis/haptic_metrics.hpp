// What a hand felt in a session beside the torque of its nuts: what it bumped into, how evenly the force
// changed, how long it took to get onto the nuts, and when the output stage let go.
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

// The wrench against something while it was on no nut. What it does to the nut it is going to, or has just
// left, is work and no bump; neither is what began with a nut in its jaw.
struct Bump {
    double begin = 0.0, length = 0.0;  // s
    collision::ObstacleId obstacle;    // the first one of it
    double hardest = 0.0;              // N, of the force put out meanwhile
};

// A tick in which the force changed much, and what was going on.
struct Moment {
    double time = 0.0;    // s
    double change = 0.0;  // N in a millisecond
    session::TickRecord tick;
    // s since each; NaN: never
    double taken = nan, left = nan, touched = nan, lost_touch = nan;
    std::int16_t last_joint = -1;  // engaged, or the last that was
    collision::ObstacleId last_touched;
    static constexpr double nan = std::numeric_limits<double>::quiet_NaN();
};

struct Changes {
    double greatest = 0.0, p99 = 0.0;  // in a millisecond; p99 of the ticks in which anything was put out
    std::uint64_t ticks = 0;           // of those
    std::uint64_t above = 0;           // of those, more than a tenth of the device's greatest; 0: not known
    std::uint64_t at_limit = 0;        // of those, as much as the output stage lets through
};

// What was going on in a tick, most telling first.
enum class Doing : std::uint8_t { held_off, leaving, taking, on_nut, against, free };
inline constexpr std::size_t doings = 6;

// Of a nut, from where on it counts as seen.
inline constexpr double in_sight = 0.6;

// From a step's beginning until its nut was in the wrench or between the fingers.
struct Arrival {
    int joint = 0;
    bool wrench = false;
    double waited = 0.0;   // s
    double placing = 0.0;  // s of them near the nut
    double seen = 0.0;     // s of those with the nut in sight (in_sight); NaN: not known
};

struct Feel {
    bool recorded = false;  // format 2; otherwise contacts and faults are not known
    bool obstacles = false, guided = false;
    std::optional<force::OutputLimits> device;
    std::vector<Bump> bumps;  // in time
    Changes force, torque;    // N, N·m
    // Ticks in which the force changed as fast as the output stage lets it, by what was going on.
    std::array<std::uint64_t, doings> at_limit{};
    std::vector<Moment> moments;  // the largest changes of the force, largest first
    std::vector<Arrival> arrivals;
    std::array<double, force::fault_kinds> faults{};  // s that each held the output off
    std::string servo;                                // how it ran, in words
    std::optional<servo::Timing> timing;
};

// Takes the ticks in order, in pieces of any size.
class FeelBuilder {
  public:
    // `seats`: of the joints' nuts.
    FeelBuilder(const session::Header& header, std::span<const lesson::Event> events,
                std::vector<Vec3> seats);

    void add(std::uint64_t first_tick, std::span<const session::TickRecord> ticks);
    Feel finish();

  private:
    struct StepBegin {
        std::uint64_t tick = 0;
        int joint = -1;
    };
    void take(std::uint64_t number, const session::TickRecord& tick);
    struct Sight {
        std::uint64_t tick = 0;
        int joint = -1;
        double share = 0.0;
    };
    void note_grip(double time, const session::TickRecord& tick);
    void note_touch(double time, const session::TickRecord& tick);
    void note_change(double time, const session::TickRecord& tick);
    void keep_moment(const Moment& moment);
    [[nodiscard]] bool own_nut(collision::ObstacleId obstacle) const;

    Feel feel_;
    double dt_;
    std::vector<Vec3> seats_;
    std::vector<StepBegin> steps_;
    std::size_t next_step_ = 0;
    std::vector<Sight> sights_;
    std::size_t next_sight_ = 0;
    Sight sight_;
    int due_ = -1;
    bool arrived_ = true;
    double step_begun_ = 0.0, placing_ = 0.0, seen_ = 0.0;
    std::optional<session::TickRecord> before_;
    Moment now_;  // what is known of the last times
    double taken_ = Moment::nan, left_ = Moment::nan, touch_ = Moment::nan, lost_ = Moment::nan;  // s
    bool working_touch_ = false;  // began with a nut in the jaw
    bool in_bump_ = false;
    std::vector<float> force_changes_, torque_changes_;
};

Doing doing(const Moment& moment);

// In words: "the wrench slides onto B3", "against casing_upper".
std::string happening(const Moment& moment, const std::vector<lesson::JointResult>& joints,
                      const std::vector<session::ObstacleName>& obstacles);
std::string obstacle_text(collision::ObstacleId id, const std::vector<session::ObstacleName>& obstacles);

}  // namespace bolt::analysis
