// Runs work that may crash or never end in a child process with limits on processor time and memory, and
// keeps its files in a temporary folder until it has succeeded. OpenCASCADE dereferences null pointers in
// some damaged STEP files and never finishes others.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace bolt::step_import {

struct GuardLimits {
    unsigned processor_s = 120;    // processor time of the child process, s
    std::uint64_t memory_mib = 0;  // address space of the child process, MiB; 0: no limit
};

// Returns limits that the import of an undamaged file of this size never reaches: 120 s plus 1 s per 16 KiB,
// and three quarters of the machine's memory.
GuardLimits default_limits(const std::filesystem::path& step);

enum class GuardOutcome : std::uint8_t {
    exited,         // the work returned
    crashed,        // a signal ended the child process
    out_of_time,    // it reached the limit on processor time
    out_of_memory,  // it reached the limit on memory
    killed,         // another process stopped it, for example the kernel when memory runs out
    interrupted,    // a stop signal arrived (Ctrl-C, SIGTERM); the child process has been killed
    not_started,    // no process could be created
};

// Passes the phase and the result of the work to the parent process. Both survive a crash of the work.
class GuardChannel {
  public:
    GuardChannel();
    GuardChannel(const GuardChannel&) = delete;
    GuardChannel& operator=(const GuardChannel&) = delete;
    ~GuardChannel();

    // Records what the work is doing, for messages about a crash. Cuts the text to 200 bytes.
    void set_phase(std::string_view phase);
    [[nodiscard]] std::string phase() const;

    // Appends to the result, which the parent reads when the work has ended. Returns false if it cannot be
    // stored.
    bool append_result(std::string_view text);
    [[nodiscard]] std::string result() const;

  private:
    struct SharedPage;
    SharedPage* page_ = nullptr;
    int result_file_ = -1;
};

struct GuardedRun {
    GuardOutcome outcome = GuardOutcome::not_started;
    int code = 0;        // the exit code of the work, the number of the signal, or errno if not started
    std::string phase;   // the last phase that the work recorded
    std::string result;  // what the work appended
};

// Runs `work` in a child process and waits for it. The child process never outlives this one.
GuardedRun run_guarded(const GuardLimits& limits, const std::function<int(GuardChannel&)>& work);

// A temporary folder for the files of an import, so that the output folder never holds half of them. It is
// named .NAME.import-N and lies beside the output folder NAME, or inside it where a folder beside it cannot
// be created or is on another file system. Its creator holds a lock on it until it is removed; a folder
// without a lock was left by a program that was killed, and the next import to the same output folder removes
// it.
class StagingFolder {
  public:
    // Removes the folders that killed imports to `output` left behind, and creates a new one. Fails if that
    // cannot be created.
    static Result<StagingFolder> create(const std::filesystem::path& output);
    StagingFolder(StagingFolder&& other) noexcept;
    StagingFolder& operator=(StagingFolder&&) = delete;
    ~StagingFolder();  // removes the folder and what is left in it

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

    // Renames the folder to the output folder, or, if that exists, moves every file into it. Fails if a file
    // cannot be moved.
    Status publish();

  private:
    StagingFolder(std::filesystem::path path, std::filesystem::path output, int lock)
        : path_(std::move(path)), output_(std::move(output)), lock_(lock) {}
    std::filesystem::path path_, output_;
    int lock_ = -1;
};

}  // namespace bolt::step_import
