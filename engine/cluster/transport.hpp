// The interface for messages between the processes of a cluster. Its only implementation, through MPI, is
// in a module, boltwright_mpi.so. A program loads the module only if mpirun started it, so a program
// that runs alone needs no MPI library.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "engine/base/result.hpp"
#include "engine/cluster/message.hpp"

namespace bolt::cluster {

inline constexpr std::size_t max_message = 64U << 20;  // bytes; receiving a longer one fails

class Transport {
  public:
    Transport() = default;
    Transport(const Transport&) = delete;
    Transport& operator=(const Transport&) = delete;
    virtual ~Transport() = default;

    // Like the functions of Cluster with the same names.
    [[nodiscard]] virtual int process() const = 0;
    [[nodiscard]] virtual int size() const = 0;
    [[nodiscard]] virtual const std::string& host(int process) const = 0;
    // Starts to send the message; does not wait for its arrival.
    virtual Status send(int to, std::span<const std::byte> message) = 0;
    // The next message from a process, if it has arrived.
    virtual Result<std::optional<Message>> try_receive(int from) = 0;
    // Waits until all messages are sent and all processes have left.
    virtual void leave() = 0;
};

// The function that the module exports. Sets either the transport or the error.
using JoinFunction = void (*)(std::unique_ptr<Transport>& transport, Error& error);
inline constexpr const char* join_function_name = "boltwright_join_cluster";

}  // namespace bolt::cluster
