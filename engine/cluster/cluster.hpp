// The processes of one program on several computers, which `mpirun` starts together, and the messages between
// them. Call all functions from the thread that joined.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/function_ref.hpp"
#include "engine/base/result.hpp"
#include "engine/cluster/transport.hpp"

namespace bolt::cluster {

class Cluster {
  public:
    // Null: the program was not started by mpirun, or it is the only process. Fails if mpirun started a build
    // without MPI. At most one Cluster may exist in the life of a process.
    static Result<std::unique_ptr<Cluster>> join();

    Cluster(const Cluster&) = delete;
    Cluster& operator=(const Cluster&) = delete;
    // Waits until all processes have left, unless abandon() was called.
    ~Cluster();

    // Number of this process, 0 … size() − 1. MPI calls it the rank.
    [[nodiscard]] int process() const { return transport_->process(); }
    [[nodiscard]] int size() const { return transport_->size(); }
    // Name of the computer that the process runs on.
    [[nodiscard]] const std::string& host(int process) const { return transport_->host(process); }
    // "process 2 on wall-pc-2", for messages.
    [[nodiscard]] std::string describe(int process) const;

    // Sends to process `to` without waiting. Messages from one process to another arrive in order.
    Status send(int to, std::span<const std::byte> message) { return transport_->send(to, message); }
    // The next message from process `from`; none after `seconds`, or when `stop` returns true. `stop` is
    // polled at least 1000 times a second.
    Result<std::optional<Message>> receive(int from, double seconds, FunctionRef<bool()> stop);

    // Call it if another process does not answer: the destructor then does not wait for the others, and
    // mpirun ends them.
    void abandon() { abandoned_ = true; }

  private:
    explicit Cluster(std::unique_ptr<Transport> transport);
    std::unique_ptr<Transport> transport_;
    bool abandoned_ = false;
};

}  // namespace bolt::cluster
