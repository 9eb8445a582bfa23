#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "tests/cli/program.h"
#include "tests/tolerance.h"
#include "trackbed/core/text_table.h"

namespace trackbed {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(Experiment, OptimalSteeringGivesThePublishedTable) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "experiment optimal_steering --searches isres,direct --out table.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  EXPECT_THAT(outcome.output,
              HasSubstr("matched by arc length, always within 2.3 % of the primary's "
                        "angle: isres, direct\n"));

  // The reference of the first stage is the exact minimum of Skackauskas et al. 2017, eqs. (1)-(2),
  // solved independently of this program for L = 2.7 m, l_g = 1.4 m. The reference of the second
  // stage is the published angle.
  const std::map<std::string, double> by_time{
      {"2.5", 11.969}, {"2", 14.890}, {"1.5", 19.655}, {"1", 27.000}};
  const std::map<std::string, std::string> published{
      {"2.5", "9.77"}, {"2", "9.94"}, {"1.5", "9.97"}, {"1", "10.03"}};
  const TextTable table = ReadTextCsv(folder.path() / "table.csv");
  EXPECT_EQ(table.columns(), (std::vector<std::string>{"speed_mps", "matching", "search",
                                                       "steering_deg", "off_primary_percent",
                                                       "cost", "evaluations", "published_deg"}));
  ASSERT_EQ(table.rows().size(), 4U * 2U * 2U);
  for (const auto& row : table.rows()) {
    SCOPED_TRACE(row[0] + " m/s by " + row[1] + ", " + row[2]);
    const double steering = std::stod(row[3]);
    if (row[1] == "time") {
      // These values are rounded to a thousandth; the searches have a tolerance of 0.02.
      EXPECT_NEAR(steering, by_time.at(row[0]), Tolerance(0.02));
      EXPECT_EQ(row[7], "");
    } else {
      // A converged search is within 0.05 of 10; the published angles scatter around it by 2.3 %.
      EXPECT_NEAR(steering, 10.0, Tolerance(0.05));
      EXPECT_EQ(row[7], published.at(row[0]));
      EXPECT_LE(std::abs(std::stod(row[7]) - 10.0), 0.23 + 1e-9);
    }
    // The tolerance covers rounding, because both cells are read back as the computed doubles.
    EXPECT_NEAR(std::stod(row[4]), 100.0 * (steering / 10.0 - 1.0), Tolerance(1e-9));
    EXPECT_GT(std::stoi(row[6]), 0);
  }
}

TEST(Experiment, OfAnotherMotionHasNoPublishedAngles) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder,
               "experiment optimal_steering --vehicle bmw320i --steering-deg -5 --primary-speed 8 "
               "--speeds 6,2.5 --searches direct --out t.csv");
  EXPECT_EQ(outcome.code, 0) << outcome.output;
  const TextTable table = ReadTextCsv(folder.path() / "t.csv");
  ASSERT_EQ(table.rows().size(), 4U);
  for (const auto& row : table.rows()) {
    EXPECT_EQ(row[7], "");
    if (row[1] == "arc_length") {
      EXPECT_NEAR(std::stod(row[3]), -5.0, Tolerance(0.05));  // the turn is still to the right
    } else {
      EXPECT_LT(std::stod(row[3]), -5.0);
    }
  }
}

TEST(Experiment, ListsSearchesThatMissTheAngle) {
  // A simplex search descends from straight wheels. A simplex search descends from the steering
  // angle 0. At 2.5 m/s, the search ends on the bound of the steering angle.
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "experiment optimal_steering --searches direct,nelder_mead");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_THAT(outcome.output, HasSubstr("    2.5 arc_length      10.000      27.000      9.77\n"));
  EXPECT_THAT(outcome.output, HasSubstr(", always within 2.3 % of the primary's angle: direct\n"));
  EXPECT_THAT(outcome.output,
              HasSubstr(", not always within 2.3 % of the primary's angle: nelder_mead\n"));
}

TEST(Experiment, IsQuietWhenAskedTo) {
  const TempFolder folder;
  const Outcome outcome =
      Trackbed(folder, "experiment optimal_steering --searches direct --speeds 2 -q");
  EXPECT_EQ(outcome.code, 0);
  EXPECT_EQ(outcome.output, "");
}

TEST(Experiment, RefusesWhatItDoesNotKnow) {
  const TempFolder folder;
  const Outcome name = Trackbed(folder, "experiment optimal_stering");
  EXPECT_EQ(name.code, 2);
  EXPECT_EQ(name.output,
            "unknown experiment 'optimal_stering'; did you mean 'optimal_steering'?\n");
  const Outcome search = Trackbed(folder, "experiment optimal_steering --searches isress");
  EXPECT_EQ(search.code, 2);
  EXPECT_EQ(search.output, "--searches: unknown search 'isress'; did you mean 'isres'?\n");
  const Outcome straight = Trackbed(folder, "experiment optimal_steering --steering-deg 0");
  EXPECT_EQ(straight.code, 2);
  EXPECT_EQ(straight.output,
            "--steering-deg: 0 must not be 0, nor beyond the 27 of --max-steering-deg\n");
  for (const char* option : {"--speeds 0", "--speeds -1", "--speeds nan", "--speeds 2,x",
                             "--speeds 1e9", "--steering-deg nan", "--steering-deg 28",
                             "--primary-speed nan", "--max-steering-deg nan"}) {
    const Outcome outcome = Trackbed(folder, std::string("experiment optimal_steering ") + option);
    EXPECT_EQ(outcome.code, 2) << option << ": " << outcome.output;
    EXPECT_THAT(outcome.output, Not(HasSubstr("internal error"))) << option;
  }
}

}  // namespace
}  // namespace trackbed
