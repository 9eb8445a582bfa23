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
/// A failing matcher prints the smallest counterexample and the failed check.
namespace trackbed {

/// Searches a study on all threads of the machine, in memory. `overrides` have the form key=value,
/// as on the command line. InputError lists every problem of the file.
FalsifyResult FalsifyStudy(const std::filesystem::path& file,
                           const std::vector<Override>& overrides = {});

/// Prints a search in GoogleTest: "broken in 12 runs at mission.speed = 17.2, …" or "not falsified
/// in 61 runs".
void PrintTo(const FalsifyResult& result, std::ostream* out);

/// Matches if no run of the search failed or revealed a bug in the program. A match is not a proof.
testing::Matcher<const FalsifyResult&> IsNotFalsified();

}  // namespace trackbed
