// Reports what a test does not check on this machine or in this build, so that it does not count as passed.
#pragma once

#include <string>

namespace bolt::test {

// Reports that the rest of the running test case, or of its subcase, is not checked; the caller returns right
// after:
//
//     if (test::sanitized) return test::skip_rest("a lesson takes minutes under a sanitizer");
//
// At the end of the test case main.cpp prints one line, and appends it to the file $BOLT_SKIPPED:
// "SKIPPED: <suite>: <test>: <reason>" if the test case has checked nothing, else "SKIPPED IN PART: ...". A
// program all of whose test cases were skipped exits with 77, which ctest reports as Skipped. A test case
// that checks nothing without this call fails.
void skip_rest(const std::string& reason);

// Reports a single check that is left out; the test case continues. The line is the same.
inline void skip_part(const std::string& reason) { skip_rest(reason); }

}  // namespace bolt::test
