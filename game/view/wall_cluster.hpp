// Projection walls on several computers: the processes that mpirun started show one room in step. The first
// process (MPI's rank 0) runs the lesson and sends each frame to the others. When all have drawn it, all
// present it.
//
//   first process:  send the frame, draw it, wait until all have drawn it, permit, present
//   another:        receive the frame, draw it, report that, wait for the permission, present
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/cluster/cluster.hpp"
#include "engine/cluster/message.hpp"
#include "engine/platform/input.hpp"

namespace bolt::view {

// A frame, as the first process sends it.
struct ClusterFrame {
    std::uint64_t number = 0;
    Pose head;                 // of the viewer, in the room
    bool tracked = false;      // false: the pose of the head is an old or an estimated one
    cluster::Message content;  // the state of the frame, from WindowContent::share; below 4 KiB
    cluster::Message bulk;     // what has changed and is larger; a message of its own, before the frame
};

// Polled while a process waits for another one. Returns true once the program was asked to end, which ends
// the wait.
using StopWaiting = std::function<bool()>;

// The part of the first process.
class WallLeader {
  public:
    // Waits until all processes have opened their walls. Fails with the error of a process that could not, or
    // if a process has another `fingerprint`, the hash of the program's version and the display file. `log`
    // receives a line when a process is slow to answer; it may be empty.
    static Result<WallLeader> begin(cluster::Cluster& cluster, std::uint64_t fingerprint, StopWaiting stop,
                                    std::function<void(const std::string&)> log);

    Status send(const ClusterFrame& frame);
    // Waits until the other processes have drawn the frame, and returns the input of their windows: keys,
    // text and requests to close. Fails if a process has ended, or does not answer for a minute.
    Result<std::vector<platform::InputEvent>> wait_until_drawn();
    // Permits all processes to present the frame. Present it, then call presented().
    Status permit();
    void presented();
    // Ends the other processes; a second call does nothing. With an error they fail too, with its exit code.
    void end(const std::optional<Error>& error);
    // As end(), for a start that fails before begin() has succeeded.
    static void end_others(cluster::Cluster& cluster, const std::optional<Error>& error);

    // One line for the log: frames, bytes of a frame, how long a message takes, and how far apart the
    // processes presented.
    [[nodiscard]] std::string summary() const;

  private:
    WallLeader(cluster::Cluster& cluster, StopWaiting stop, std::function<void(const std::string&)> log)
        : cluster_(&cluster), stop_(std::move(stop)), log_(std::move(log)) {}
    Result<std::optional<cluster::Message>> answer_of(int process);
    Status measure_transport();

    cluster::Cluster* cluster_;
    StopWaiting stop_;
    std::function<void(const std::string&)> log_;
    double permitted_ = 0.0;  // s, when the last frame was permitted
    double own_delay_ = 0.0;  // s, from then until this process had presented it
    bool ended_ = false;
    std::vector<float> skews_;          // s, of each frame: from the first process that presented to the last
    std::vector<std::uint32_t> sizes_;  // bytes of each frame, without its bulk
    std::uint32_t largest_bulk_ = 0;    // bytes
    std::vector<float> transports_;     // s, of messages of 4 KiB to the other processes
};

// The part of every other process.
class WallFollower {
  public:
    // Reports to the first process that the walls of this one are open. `fingerprint`: as in
    // WallLeader::begin(), which compares it. Does not wait.
    static Result<WallFollower> begin(cluster::Cluster& cluster, std::uint64_t fingerprint, StopWaiting stop);

    // Waits for the next frame. None: the first process has ended, or the program was asked to end. Fails
    // with the reason that the first process gave for its end.
    Result<std::optional<ClusterFrame>> next_frame();
    // Reports that the frame is drawn, with the input of this process's windows, and waits for the permission
    // to present it. Returns false if the program ends instead. After presenting, call presented().
    Result<bool> wait_for_permission(std::span<const platform::InputEvent> events);
    void presented();

    // Reports the error that ends this process to the first one. May also be called instead of begin().
    static void report(cluster::Cluster& cluster, const Error& error);

  private:
    WallFollower(cluster::Cluster& cluster, StopWaiting stop) : cluster_(&cluster), stop_(std::move(stop)) {}
    Status read_frame(cluster::MessageReader& message, ClusterFrame& frame);

    cluster::Cluster* cluster_;
    StopWaiting stop_;
    double permitted_ = 0.0, delay_ = 0.0;  // s, as in WallLeader
};

}  // namespace bolt::view
