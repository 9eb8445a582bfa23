#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/cli/program.h"
#include "tests/support/folder_content.h"
#include "trackbed/core/file.h"

namespace trackbed {
namespace import_test {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsSupersetOf;

const fs::path kSource = TRACKBED_SOURCE_DIR;

std::string Arguments(const std::string& out) {
  return "import " + (kSource / "tests/data/recordings/autoware.csv").string() + " --map " +
         (kSource / "scenarios/real/maps/autoware.yaml").string() + " --vehicle " +
         (kSource / "tests/data/models/small_car.xml").string() + " -o " + out;
}

TEST(Import, MakesARunFolderThatOtherVerbsTake) {
  const TempFolder folder;
  const Outcome imported = Trackbed(folder, Arguments("in") + " --mcap --report");
  EXPECT_EQ(imported.code, 0) << imported.output;
  EXPECT_THAT(imported.output, HasSubstr("autoware: 20 s, 40.13 m, 100 % valid, in in\n"));
  EXPECT_THAT(imported.output, HasSubstr("601 of 601 rows used"));
  EXPECT_THAT(
      NamesOfEntries(folder.path() / "in"),
      IsSupersetOf({"record.csv", "recorded.csv", "recorded.state.csv", "model.xml", "metrics.json",
                    "scenario.resolved.yaml", "manifest.json", "run.mcap", "report.html"}));
  const Outcome replayed =
      Trackbed(folder, "run in/scenario.resolved.yaml --plant recorded kinematic -o replayed");
  EXPECT_EQ(replayed.code, 0) << replayed.output;
  EXPECT_THAT(replayed.output, HasSubstr("against the record: yaw rate"));
  EXPECT_THAT(replayed.output, HasSubstr("after 2 s, 10 windows: position"));
  const Outcome compared =
      Trackbed(folder, "compare in replayed --plants recorded,recorded --tolerance position=1e-9");
  EXPECT_EQ(compared.code, 0) << compared.output;
}

TEST(Import, RunsAgainToTheSameBytes) {
  const TempFolder folder;
  ASSERT_EQ(Trackbed(folder, Arguments("in") + " -q").code, 0);
  ASSERT_EQ(Trackbed(folder, "run in/scenario.resolved.yaml -q -o again").code, 0);
  for (const char* name :
       {"metrics.json", "record.csv", "recorded.csv", "scenario.resolved.yaml", "manifest.json"}) {
    EXPECT_EQ(ReadFile(folder.path() / "in" / name), ReadFile(folder.path() / "again" / name))
        << name;
  }
}

TEST(Import, RefusesWhatItCannotUse) {
  const TempFolder folder;
  folder.Write("log.csv", "t,x,y,yaw,v,steer\n0,0,0,0,1,0\n1,1,0,zero,1,0\n");
  const std::string map = (kSource / "scenarios/real/maps/autoware.yaml").string();
  const Outcome bad = Trackbed(folder, "import log.csv --map " + map + " -o out");
  EXPECT_EQ(bad.code, 2);
  EXPECT_THAT(bad.output, HasSubstr("log.csv:3: cell 4 (yaw): 'zero' is not a number"));
  EXPECT_FALSE(fs::exists(folder.path() / "out"));
  const Outcome missing = Trackbed(folder, "import none.csv --map " + map);
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.output, HasSubstr("cannot read none.csv: No such file or directory"));
  EXPECT_EQ(Trackbed(folder, "import log.csv").code, 2);
}

TEST(Import, IsNoScenarioToCheckOrTest) {
  const TempFolder folder;
  fs::copy(kSource / "scenarios/real/maps", folder.path() / "maps");
  fs::copy(ScenarioFile("steering_circle"), folder.path() / "maps");
  const Outcome checked = Trackbed(folder, "check maps");
  EXPECT_EQ(checked.code, 0) << checked.output;
}

TEST(Import, ListsABagAndReadsItByTheProposedMap) {
  const TempFolder folder;
  const std::string bag = (kSource / "tests/data/bags/odometry.mcap").string();
  const Outcome listed = Trackbed(folder, "import " + bag + " --list");
  EXPECT_EQ(listed.code, 0) << listed.output;
  EXPECT_THAT(listed.output, HasSubstr("# /odom: nav_msgs/msg/Odometry, 21 rows\n"));
  EXPECT_THAT(listed.output, HasSubstr("#   /drive.drive.steering_angle\n"));
  folder.Write("map.yaml", listed.output);
  const Outcome imported =
      Trackbed(folder, "import " + bag + " --map map.yaml --vehicle " +
                           (kSource / "tests/data/models/small_car.xml").string() + " -o in");
  EXPECT_EQ(imported.code, 0) << imported.output;
  EXPECT_THAT(imported.output, HasSubstr("odometry: 2 s, "));
}

TEST(Import, ReadsAGpsTrackWithoutAMap) {
  const TempFolder folder;
  const Outcome imported =
      Trackbed(folder, "import " + (kSource / "tests/data/paths/track.gpx").string() + " -o in");
  EXPECT_EQ(imported.code, 0) << imported.output;
  EXPECT_THAT(imported.output, HasSubstr("UTM zone 32N"));
  folder.Write("log.csv", "t,lat,lon\n0,48.1,11.5\n1,48.1001,11.5\n");
  const Outcome missing = Trackbed(folder, "import log.csv");
  EXPECT_EQ(missing.code, 2);
  EXPECT_THAT(missing.output, HasSubstr("trackbed import log.csv --list"));
}

}  // namespace import_test
}  // namespace trackbed
