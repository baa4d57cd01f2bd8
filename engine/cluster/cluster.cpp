#include "engine/cluster/cluster.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <thread>
#include <utility>

#include "engine/base/steady_seconds.hpp"

namespace bolt::cluster {

namespace {

// A wait first spins, because the next frame is usually near, and then sleeps, because the processor may be
// needed for drawing.
constexpr double spin_time = 200e-6;  // s
constexpr std::chrono::microseconds nap{100};

// mpirun of Open MPI and of MPICH sets one of these variables in each process that it starts.
bool started_by_mpirun() {
    for (const char* variable : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_RANK"})
        // NOLINTNEXTLINE(concurrency-mt-unsafe): before any thread
        if (std::getenv(variable) != nullptr) return true;
    return false;
}

// Returns the path of the MPI module, beside the program or where it is installed; empty: there is none.
std::filesystem::path find_module() {
    std::error_code ignored;
    const std::filesystem::path folder =
        std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const auto& place : {folder / "boltwright_mpi.so", folder / "../lib/boltwright/boltwright_mpi.so"})
        if (std::filesystem::exists(place, ignored)) return place;
    return {};
}

Result<std::unique_ptr<Transport>> join_transport() {
    const std::filesystem::path module = find_module();
    if (module.empty())
        return fail(ErrorCode::usage, "mpirun started a program that was built without MPI",
                    "a program built with MPI (libopenmpi-dev)");
    // The module stays loaded until the program ends. RTLD_GLOBAL: Open MPI loads plug-ins that use the
    // symbols of its library.
    void* const loaded = dlopen(module.c_str(), RTLD_NOW | RTLD_GLOBAL);
    void* const symbol = loaded != nullptr ? dlsym(loaded, join_function_name) : nullptr;
    if (symbol == nullptr) {
        const char* const reason = dlerror();  // NOLINT(concurrency-mt-unsafe): before any thread
        return fail(ErrorCode::failed,
                    fmt::format("{}: {}", module.string(), reason != nullptr ? reason : "?"),
                    "the MPI library that the module was built with");
    }
    JoinFunction join = nullptr;
    static_assert(sizeof(join) == sizeof(symbol));
    std::memcpy(&join, &symbol, sizeof join);
    std::unique_ptr<Transport> transport;
    Error error;
    join(transport, error);
    if (!transport) return fail(error);
    return transport;
}

}  // namespace

Result<std::unique_ptr<Cluster>> Cluster::join() {
    if (!started_by_mpirun()) return std::unique_ptr<Cluster>();
    BOLT_TRY_ASSIGN(auto transport, join_transport());
    std::unique_ptr<Cluster> cluster(new Cluster(std::move(transport)));
    if (cluster->size() > 1) return cluster;
    return std::unique_ptr<Cluster>();  // the only process: `cluster` leaves here
}

Cluster::Cluster(std::unique_ptr<Transport> transport) : transport_(std::move(transport)) {}

Cluster::~Cluster() {
    if (!abandoned_) transport_->leave();
}

std::string Cluster::describe(int process) const {
    return fmt::format("process {} on {}", process, host(process));
}

Result<std::optional<Message>> Cluster::receive(int from, double seconds, FunctionRef<bool()> stop) {
    const double begun = steady_seconds();
    for (;;) {
        BOLT_TRY_ASSIGN(auto message, transport_->try_receive(from));
        if (message) return message;
        const double waited = steady_seconds() - begun;
        if (waited > seconds || stop()) return std::optional<Message>();
        if (waited > spin_time) std::this_thread::sleep_for(nap);
    }
}

}  // namespace bolt::cluster
