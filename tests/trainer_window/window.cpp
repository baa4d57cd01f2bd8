// The trainer in a real window, with somebody at its keys and mouse.
#include "game/trainer/window.hpp"

#include <doctest/doctest.h>

#include <filesystem>
#include <mutex>
#include <thread>

#include "game/record/session.hpp"
#include "tests/platform/hand.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/screen_picture.hpp"

using namespace bolt;

namespace {

template <class T>
T need(Result<T> result) {
    if (!result) FAIL(result.error().message());
    return std::move(*result);
}

// What the program says, for another thread to wait for.
class Log {
  public:
    void add(const std::string& line) {
        const std::lock_guard lock(mutex_);
        lines_.push_back(line);
    }
    bool has(const std::string& part) {
        const std::lock_guard lock(mutex_);
        for (const std::string& line : lines_)
            if (line.find(part) != std::string::npos) return true;
        return false;
    }

  private:
    std::mutex mutex_;
    std::vector<std::string> lines_;
};

constexpr int width = 320, height = 200;

struct Program {
    std::filesystem::path out = std::filesystem::path(BOLT_TRAINER_OUT) / "window";
    Log log;
    platform::Desktop desktop = need(platform::Desktop::open());
    platform::Window window = need(platform::Window::open(desktop, {"boltwright", width, height}));
    std::optional<gpu::Instance> instance;
    std::optional<trainer::App> app;

    Program() {
        gpu::InstanceOptions validated;
        validated.validation = true;
        const std::vector<const char*> extensions = need(desktop.vulkan_extensions());
        validated.extensions = extensions;
        instance.emplace(need(gpu::Instance::create(validated)));
        std::filesystem::create_directories(out);
        trainer::AppOptions options;
        options.choice.assembly = "cover-m8";
        options.out = out;
        options.tell = [this](const std::string& line) { log.add(line); };
        app.emplace(std::move(options));
    }
    ~Program() {
        app->drop();
        for (const std::string& message : instance->log().messages) FAIL_CHECK(message);
    }
};

}  // namespace

TEST_CASE(
    "somebody who has read nothing: Enter begins, a press on the wrench takes it, closing keeps the "
    "session") {
    Program program;
    bool begun = false, taken = false, large = false;
    std::thread somebody([&] {
        test::Hand hand("boltwright");
        begun = test::eventually([&] {
            hand.key("Return");
            return program.log.has("lesson begun");
        });
        // The key that is named in the help; pressed again if a slow frame has swallowed it.
        taken = test::eventually([&] {
            if (!program.log.has("in the hand")) hand.key("t");
            std::this_thread::sleep_for(std::chrono::seconds(4));
            return program.log.has("in the hand");
        });
        hand.key("F11");
        large = test::eventually([&] { return test::Hand("boltwright").place().width > width; });
        hand.close();
    });
    const Status run = trainer::run_in_window(*program.app, program.window, *program.instance);
    somebody.join();
    CHECK(begun);
    CHECK(taken);
    CHECK(large);
    CHECK_MESSAGE(run.has_value(), (run ? "" : run.error().message()));
    const auto reader = record::Reader::open(program.out / "session.boltwright");
    REQUIRE(reader);
    CHECK(reader->complete());
    CHECK(reader->tick_count() > 500);
    const auto result = reader->result();
    REQUIRE(result);
    CHECK_FALSE(result->finished);
}
