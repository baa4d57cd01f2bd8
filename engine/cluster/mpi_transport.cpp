// The module that joins a cluster through MPI.
// The deprecated C++ bindings would only take time to compile.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <fmt/format.h>
#include <mpi.h>

#include <array>
#include <deque>
#include <utility>

#include "engine/cluster/transport.hpp"

namespace bolt::cluster {

namespace {

constexpr int message_tag = 1;

Status check_mpi(int code, const char* doing) {
    if (code == MPI_SUCCESS) return {};
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    (void)MPI_Error_string(code, text.data(), &length);
    return fail(ErrorCode::failed, fmt::format("{}: {}", doing, text.data()),
                "all processes that mpirun started");
}

class MpiTransport final : public Transport {
  public:
    Status join() {
        int provided = 0;
        BOLT_TRY(check_mpi(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "joining"));
        (void)MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
        // MPI calls the number of a process its rank.
        BOLT_TRY(check_mpi(MPI_Comm_rank(MPI_COMM_WORLD, &process_), "joining"));
        BOLT_TRY(check_mpi(MPI_Comm_size(MPI_COMM_WORLD, &size_), "joining"));
        std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
        int length = 0;
        BOLT_TRY(check_mpi(MPI_Get_processor_name(name.data(), &length), "joining"));
        std::vector<char> names(name.size() * static_cast<std::size_t>(size_));
        BOLT_TRY(check_mpi(MPI_Allgather(name.data(), static_cast<int>(name.size()), MPI_CHAR, names.data(),
                                         static_cast<int>(name.size()), MPI_CHAR, MPI_COMM_WORLD),
                           "joining"));
        for (std::size_t i = 0; i < static_cast<std::size_t>(size_); ++i)
            hosts_.emplace_back(names.data() + i * name.size());
        return {};
    }

    [[nodiscard]] int process() const override { return process_; }
    [[nodiscard]] int size() const override { return size_; }
    [[nodiscard]] const std::string& host(int process) const override {
        return hosts_[static_cast<std::size_t>(process)];
    }

    Status send(int to, std::span<const std::byte> message) override {
        BOLT_TRY(release_sent());
        Sent& sent = sent_.emplace_back(Sent{Message(message.begin(), message.end()), MPI_REQUEST_NULL});
        return check_mpi(MPI_Isend(sent.message.data(), static_cast<int>(sent.message.size()), MPI_BYTE, to,
                                   message_tag, MPI_COMM_WORLD, &sent.request),
                         "sending to another process");
    }

    Result<std::optional<Message>> try_receive(int from) override {
        BOLT_TRY(release_sent());
        int found = 0, size = 0;
        MPI_Message handle = MPI_MESSAGE_NULL;
        MPI_Status status{};
        BOLT_TRY(check_mpi(MPI_Improbe(from, message_tag, MPI_COMM_WORLD, &found, &handle, &status),
                           "receiving from another process"));
        if (found == 0) return std::optional<Message>();
        (void)MPI_Get_count(&status, MPI_BYTE, &size);
        if (size < 0 || static_cast<std::size_t>(size) > max_message)
            return fail(ErrorCode::failed, fmt::format("process {} sent {} bytes", from, size),
                        fmt::format("at most {}", max_message));
        Message message(static_cast<std::size_t>(size));
        BOLT_TRY(check_mpi(MPI_Mrecv(message.data(), size, MPI_BYTE, &handle, MPI_STATUS_IGNORE),
                           "receiving from another process"));
        return std::optional(std::move(message));
    }

    void leave() override {
        for (Sent& sent : sent_) (void)MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
        (void)MPI_Finalize();
    }

  private:
    struct Sent {
        Message message;
        MPI_Request request;
    };
    // Releases the oldest messages that MPI no longer reads.
    Status release_sent() {
        while (!sent_.empty()) {
            int done = 0;
            BOLT_TRY(check_mpi(MPI_Test(&sent_.front().request, &done, MPI_STATUS_IGNORE),
                               "sending to another process"));
            if (done == 0) break;
            sent_.pop_front();
        }
        return {};
    }

    int process_ = 0, size_ = 1;  // number of this process, and how many there are
    std::vector<std::string> hosts_;
    std::deque<Sent> sent_;  // messages that MPI may still read; a deque, because MPI holds their addresses
};

}  // namespace

extern "C" __attribute__((visibility("default"))) void boltwright_join_cluster(
    std::unique_ptr<Transport>& transport, Error& error) {
    auto joined = std::make_unique<MpiTransport>();
    if (Status done = joined->join(); !done)
        error = done.error();
    else
        transport = std::move(joined);
}

}  // namespace bolt::cluster
