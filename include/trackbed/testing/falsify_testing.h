#pragma once

#include <gmock/gmock.h>

#include <filesystem>
#include <iosfwd>
#include <vector>

#include "trackbed/falsify/falsify.h"

/// Searches for failing runs in GoogleTest:
///
///     EXPECT_THAT(trackbed::FalsifyStudy("studies/lane_change.yaml"), trackbed::IsNotFalsified());
///
/// If the matcher fails, the test prints the shrunk counterexample and the failed check.
namespace trackbed {

/// Searches a study for a failing run on all threads of the machine, and keeps the records in
/// memory. The `overrides` have the form key=value, as on the command line. Throws InputError,
/// which lists every problem of the study's file.
FalsifyResult FalsifyStudy(const std::filesystem::path& file,
                           const std::vector<Override>& overrides = {});

/// Prints the result of a search in GoogleTest, such as "broken in 12 runs at mission.speed = 17.2,
/// …" or "not falsified in 61 runs".
void PrintTo(const FalsifyResult& result, std::ostream* out);

/// Matches if no run of the search failed, and no run revealed a bug in the program. A match does
/// not prove that no failing run exists.
testing::Matcher<const FalsifyResult&> IsNotFalsified();

}  // namespace trackbed
