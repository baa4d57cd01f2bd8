#include "engine/cluster/cluster.hpp"

#include <fmt/format.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <thread>
#include <utility>

#include "engine/base/steady_seconds.hpp"

#ifdef BOLT_MPI
// The deprecated C++ bindings would only take time to compile.
#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#endif

namespace bolt::cluster {

namespace {

// mpirun of Open MPI and of MPICH tell a process with these variables that it belongs to a cluster.
bool started_by_mpirun() {
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
        // NOLINTNEXTLINE(concurrency-mt-unsafe): before any thread
        if (std::getenv(variable) != nullptr) return true;
    return false;
}

}  // namespace

#ifdef BOLT_MPI

namespace {

constexpr int message_tag = 1;
// A wait first spins, because the next frame is usually near, and then sleeps, because the processor may be
// needed for drawing.
constexpr double spin_time = 200e-6;  // s
constexpr std::chrono::microseconds nap{100};

Status check_mpi(int code, const char* doing) {
    if (code == MPI_SUCCESS) return {};
    std::array<char, MPI_MAX_ERROR_STRING> text{};
    int length = 0;
    (void)MPI_Error_string(code, text.data(), &length);
    return fail(ErrorCode::failed, fmt::format("{}: {}", doing, text.data()),
                "all processes that mpirun started");
}

}  // namespace

struct Cluster::State {
    struct Sent {
        Message message;
        MPI_Request request = MPI_REQUEST_NULL;
    };
    int rank = 0, size = 1;
    std::vector<std::string> hosts;
    std::deque<Sent> sent;  // not yet on their way; a deque, because MPI holds their addresses
    bool lost = false;

    // Removes messages that are on their way.
    Status tidy() {
        while (!sent.empty()) {
            int done = 0;
            BOLT_TRY(check_mpi(MPI_Test(&sent.front().request, &done, MPI_STATUS_IGNORE),
                               "sending to another process"));
            if (done == 0) break;
            sent.pop_front();
        }
        return {};
    }
};

bool available() { return true; }

Result<std::unique_ptr<Cluster>> Cluster::join() {
    if (!started_by_mpirun()) return std::unique_ptr<Cluster>();
    int provided = 0;
    BOLT_TRY(check_mpi(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "joining"));
    (void)MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    auto state = std::make_unique<State>();
    BOLT_TRY(check_mpi(MPI_Comm_rank(MPI_COMM_WORLD, &state->rank), "joining"));
    BOLT_TRY(check_mpi(MPI_Comm_size(MPI_COMM_WORLD, &state->size), "joining"));
    std::array<char, MPI_MAX_PROCESSOR_NAME> name{};
    int length = 0;
    BOLT_TRY(check_mpi(MPI_Get_processor_name(name.data(), &length), "joining"));
    std::vector<char> names(name.size() * static_cast<std::size_t>(state->size));
    BOLT_TRY(check_mpi(MPI_Allgather(name.data(), static_cast<int>(name.size()), MPI_CHAR, names.data(),
                                     static_cast<int>(name.size()), MPI_CHAR, MPI_COMM_WORLD),
                       "joining"));
    for (int i = 0; i < state->size; ++i)
        state->hosts.emplace_back(names.data() + static_cast<std::size_t>(i) * name.size());
    std::unique_ptr<Cluster> cluster(new Cluster(std::move(state)));
    if (cluster->size() > 1) return cluster;
    return std::unique_ptr<Cluster>();  // leaves at once
}

Cluster::Cluster(std::unique_ptr<State> state) : state_(std::move(state)) {}

Cluster::~Cluster() {
    if (state_->lost) return;
    for (State::Sent& sent : state_->sent) (void)MPI_Wait(&sent.request, MPI_STATUS_IGNORE);
    (void)MPI_Finalize();
}

int Cluster::rank() const { return state_->rank; }
int Cluster::size() const { return state_->size; }
const std::string& Cluster::host(int rank) const { return state_->hosts[static_cast<std::size_t>(rank)]; }

Status Cluster::send(int to, std::span<const std::byte> message) {
    BOLT_TRY(state_->tidy());
    State::Sent& sent = state_->sent.emplace_back(Message(message.begin(), message.end()));
    return check_mpi(MPI_Isend(sent.message.data(), static_cast<int>(sent.message.size()), MPI_BYTE, to,
                               message_tag, MPI_COMM_WORLD, &sent.request),
                     "sending to another process");
}

Result<std::optional<Message>> Cluster::receive(int from, double seconds, FunctionRef<bool()> stop) {
    const double begun = steady_seconds();
    for (;;) {
        BOLT_TRY(state_->tidy());
        int found = 0;
        MPI_Message handle = MPI_MESSAGE_NULL;
        MPI_Status status{};
        BOLT_TRY(check_mpi(MPI_Improbe(from, message_tag, MPI_COMM_WORLD, &found, &handle, &status),
                           "receiving from another process"));
        if (found != 0) {
            int size = 0;
            (void)MPI_Get_count(&status, MPI_BYTE, &size);
            if (size < 0 || static_cast<std::size_t>(size) > max_message)
                return fail(ErrorCode::failed, fmt::format("{} sent {} bytes", describe(from), size),
                            fmt::format("at most {}", max_message));
            Message message(static_cast<std::size_t>(size));
            BOLT_TRY(check_mpi(MPI_Mrecv(message.data(), size, MPI_BYTE, &handle, MPI_STATUS_IGNORE),
                               "receiving from another process"));
            return std::optional(std::move(message));
        }
        const double waited = steady_seconds() - begun;
        if (waited > seconds || stop()) return std::optional<Message>();
        if (waited > spin_time) std::this_thread::sleep_for(nap);
    }
}

void Cluster::lost() { state_->lost = true; }

#else

struct Cluster::State {
    std::string host;
};

bool available() { return false; }

Result<std::unique_ptr<Cluster>> Cluster::join() {
    if (!started_by_mpirun()) return std::unique_ptr<Cluster>();
    return fail(ErrorCode::usage, "mpirun started a program that was built without MPI",
                "one that was built where an MPI library is installed (libopenmpi-dev)");
}

Cluster::Cluster(std::unique_ptr<State> state) : state_(std::move(state)) {}
Cluster::~Cluster() = default;
int Cluster::rank() const { return 0; }
int Cluster::size() const { return 1; }
const std::string& Cluster::host(int) const { return state_->host; }
Status Cluster::send(int, std::span<const std::byte>) { return {}; }
Result<std::optional<Message>> Cluster::receive(int, double, FunctionRef<bool()>) {
    return std::optional<Message>();
}
void Cluster::lost() {}

#endif

std::string Cluster::describe(int rank) const { return fmt::format("process {} on {}", rank, host(rank)); }

}  // namespace bolt::cluster
