#include "src/fmu/licenses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "src/fmu/carried_libraries.h"
#include "src/fmu/contents.h"
#include "tests/support/temp_folder.h"
#include "trackbed/core/file.h"

namespace trackbed::fmu_licenses_test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

std::map<std::string, std::string> LicensesOf(const fs::path& library,
                                              const std::map<std::string, fs::path>& carried,
                                              const fs::path& root = "/") {
  std::map<std::string, std::string> texts;
  for (const fmu::ZipEntry& entry : fmu::LicenseEntries(library, carried, root)) {
    EXPECT_TRUE(texts.emplace(entry.name, entry.content).second) << entry.name;
  }
  return texts;
}

// Library files in a database of dpkg that has them under their present and their former folder,
// and a library that no package owns.
TEST(FmuLicenses, AreThoseOfThePackagesThatOwnTheLibraries) {
  const TempFolder folder;
  folder.Write("fmu/fmu_licenses/LICENSE", "own");
  folder.Write("fmu/fmu_licenses/mujoco/LICENSE", "physics");
  folder.Write("var/lib/dpkg/info/libone1:amd64.list", "/.\n/usr/lib/x/libone.so.1.2\n");
  folder.Write("var/lib/dpkg/info/libtwo-2.list", "/lib/x/libtwo.so.2\n");
  folder.Write("var/lib/dpkg/info/libtwo-2.md5sums", "/usr/lib/x/libfour.so\n");
  folder.Write("usr/share/doc/libone1/copyright", "one");
  folder.Write("usr/share/doc/libtwo-2/copyright", "two");
  const auto texts = LicensesOf(folder.path() / "fmu/trackbed_fmu.so",
                                {{"libone.so.1", "/usr/lib/x/libone.so.1.2"},
                                 {"libtwo.so.2", "/usr/lib/x/libtwo.so.2"},
                                 {"libmujoco.so.4", "/opt/libmujoco.so.4"},
                                 {"libfour.so", "/usr/lib/x/libfour.so"}},
                                folder.path());
  EXPECT_EQ(texts.at("documentation/licenses/LICENSE"), "own");
  EXPECT_EQ(texts.at("documentation/licenses/libone1.txt"), "one");
  EXPECT_EQ(texts.at("documentation/licenses/libtwo-2.txt"), "two");
  EXPECT_EQ(texts.at("documentation/licenses/mujoco/LICENSE"), "physics");
  EXPECT_EQ(texts.size(), 5U);
  const std::string& index = texts.at("documentation/licenses/license.txt");
  EXPECT_THAT(index, HasSubstr("\nlibone.so.1: libone1.txt\n"));
  EXPECT_THAT(index, HasSubstr("\nlibtwo.so.2: libtwo-2.txt\n"));
  EXPECT_THAT(index, HasSubstr("\nlibmujoco.so.4: mujoco/\n"));
  EXPECT_THAT(index, HasSubstr("\nlibfour.so: no text found; add its license"));
}

// scripts/wheel renames the libraries of Debian, so that no package owns the files.
TEST(FmuLicenses, OfAWheelAreBesideItsLibrary) {
  const TempFolder folder;
  folder.Write("trackbed/library_licenses/libone-1a2b3c4d.so.1.txt", "one");
  folder.Write("trackbed/library_licenses/libtwo-1a2b3c4d.so.2.txt", "two");
  const auto texts =
      LicensesOf(folder.path() / "trackbed/trackbed_fmu.so",
                 {{"libone-1a2b3c4d.so.1", folder.path() / "trackbed.libs/libone-1a2b3c4d.so.1"}},
                 folder.path());
  EXPECT_EQ(texts.at("documentation/licenses/libone-1a2b3c4d.so.1.txt"), "one");
  EXPECT_EQ(texts.size(), 2U);
  EXPECT_THAT(texts.at("documentation/licenses/license.txt"),
              HasSubstr("\nlibone-1a2b3c4d.so.1: libone-1a2b3c4d.so.1.txt\n"));
}

TEST(FmuLicenses, OfThisBuildAreComplete) {
  const fs::path library = fmu::FindLibrary();
  const auto texts = LicensesOf(library, fmu::CarriedLibraries(library));
  EXPECT_EQ(texts.at("documentation/licenses/LICENSE"),
            ReadFile(fs::path(TRACKBED_SOURCE_DIR) / "LICENSE"));
  EXPECT_THAT(texts.at("documentation/licenses/license.txt"),
              testing::Not(HasSubstr("no text found")));
  // Sentences of the licenses of yaml-cpp (MIT), Eigen (MPL) and MuJoCo (Apache).
  EXPECT_THAT(texts, testing::Contains(
                         testing::Pair(HasSubstr("yaml-cpp"), HasSubstr("without restriction"))));
  EXPECT_THAT(texts, testing::Contains(testing::Pair(HasSubstr("eigen"), HasSubstr("MPL"))));
  EXPECT_THAT(texts, testing::Contains(testing::Pair(HasSubstr("mujoco"), HasSubstr("Apache"))));
}

}  // namespace
}  // namespace trackbed::fmu_licenses_test
