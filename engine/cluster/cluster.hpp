// The processes of one program on several computers, which `mpirun` starts together: messages between them
// through MPI. A build without MPI has no clusters (available() is false). Call all functions from the thread
// that joined.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/function_ref.hpp"
#include "engine/base/result.hpp"
#include "engine/cluster/message.hpp"

namespace bolt::cluster {

// Returns whether this build can form a cluster.
bool available();

inline constexpr std::size_t max_message = 64U << 20;  // bytes

class Cluster {
  public:
    // Null: the program was not started by mpirun, or it is the only process. Fails in a build without MPI
    // that mpirun started. At most one Cluster may exist in the life of a process.
    static Result<std::unique_ptr<Cluster>> join();

    Cluster(const Cluster&) = delete;
    Cluster& operator=(const Cluster&) = delete;
    // Waits until all processes have left, unless lost() was called.
    ~Cluster();

    [[nodiscard]] int rank() const;  // 0 … size() − 1
    [[nodiscard]] int size() const;
    [[nodiscard]] const std::string& host(int rank) const;  // name of the computer that the process runs on
    // "process 2 on wall-pc-2", for messages.
    [[nodiscard]] std::string describe(int rank) const;

    // Sends without waiting; messages from one process to another arrive in order.
    Status send(int to, std::span<const std::byte> message);
    // The next message from a process; none after `seconds`, or when `stop` returns true. `stop` is called at
    // least 1000 times a second.
    Result<std::optional<Message>> receive(int from, double seconds, FunctionRef<bool()> stop);

    // Another process does not answer: the destructor does not wait for it. mpirun then ends all others.
    void lost();

  private:
    struct State;
    explicit Cluster(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace bolt::cluster
