// Runs the test cases of a suite and reports those that were skipped (support/skip.hpp).
#define DOCTEST_CONFIG_IMPLEMENT
#include <doctest/doctest.h>
#include <errno.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/skip.hpp"

namespace {

constexpr int all_skipped = 77;  // ctest's SKIP_RETURN_CODE

struct Run {
    std::mutex mutex;                  // test cases have threads
    std::vector<std::string> skipped;  // reasons of the running test case, with its subcases
    std::vector<std::string> subcases;
    int cases = 0;
    int cases_skipped = 0;
    int cases_unchecked = 0;
};
Run& run() {
    static Run the_run;
    return the_run;
}

std::string suite_name() {
    std::string_view name = program_invocation_short_name;
    constexpr std::string_view prefix = "test_";
    if (name.substr(0, prefix.size()) == prefix) name.remove_prefix(prefix.size());
    return std::string(name);
}

void report(const std::string& line) {
    (void)std::printf("%s\n", line.c_str());
    const char* path = std::getenv("BOLT_SKIPPED");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    if (path == nullptr) return;
    if (std::ofstream file(path, std::ios::app); !(file << line << '\n'))
        (void)std::fprintf(stderr, "%s: cannot be written; expected a file for skipped tests\n", path);
}

// Reports skipped and unchecked test cases, which doctest's own reporter counts as passed.
class SkipListener final : public doctest::IReporter {
  public:
    explicit SkipListener(const doctest::ContextOptions& /*options*/) {}

    void test_case_start(const doctest::TestCaseData& data) override {
        name_ = data.m_name;
        run().skipped.clear();
        run().subcases.clear();
    }
    void test_case_reenter(const doctest::TestCaseData& /*data*/) override { run().subcases.clear(); }
    void test_case_end(const doctest::CurrentTestCaseStats& stats) override {
        ++run().cases;
        const bool checked = stats.numAssertsCurrentTest > 0;
        const std::string what = suite_name() + ": " + name_;
        for (const std::string& reason : run().skipped)
            report((checked ? "SKIPPED IN PART: " : "SKIPPED: ") + what + ": " + reason);
        if (checked || stats.failure_flags != 0) return;
        if (!run().skipped.empty()) {
            ++run().cases_skipped;
        } else {
            ++run().cases_unchecked;
            (void)std::fprintf(stderr, "%s: checks nothing; expected a check or test::skip_rest(reason)\n",
                               what.c_str());
        }
    }
    void subcase_start(const doctest::SubcaseSignature& subcase) override {
        run().subcases.emplace_back(subcase.m_name.c_str());
    }
    void subcase_end() override {
        if (!run().subcases.empty()) run().subcases.pop_back();
    }

    void report_query(const doctest::QueryData& /*data*/) override {}
    void test_run_start() override {}
    void test_run_end(const doctest::TestRunStats& /*stats*/) override {}
    void test_case_exception(const doctest::TestCaseException& /*exception*/) override {}
    void log_assert(const doctest::AssertData& /*data*/) override {}
    void log_message(const doctest::MessageData& /*data*/) override {}
    void test_case_skipped(const doctest::TestCaseData& /*data*/) override {}

  private:
    std::string name_;
};

}  // namespace

namespace bolt::test {

void skip_rest(const std::string& reason) {
    const std::lock_guard lock(run().mutex);
    std::string where;
    for (const std::string& subcase : run().subcases) where += subcase + ": ";
    run().skipped.push_back(where + reason);
}

}  // namespace bolt::test

REGISTER_LISTENER("skips", 1, SkipListener);

int main(int argc, char** argv) {
    doctest::Context context(argc, argv);
    const int result = context.run();
    if (context.shouldExit() || result != 0) return result;
    if (run().cases_unchecked > 0) return EXIT_FAILURE;
    if (run().cases == 0) {
        (void)std::fprintf(stderr, "%s: no test case runs; expected at least one\n", suite_name().c_str());
        return EXIT_FAILURE;
    }
    return run().cases_skipped == run().cases ? all_skipped : EXIT_SUCCESS;
}
