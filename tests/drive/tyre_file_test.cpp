#include "trackbed/vehicle/tyre_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "trackbed/core/error.h"
#include "trackbed/drive/car_cache.h"
#include "trackbed/drive/drive.h"
#include "trackbed/scenario/input_files.h"
#include "trackbed/scenario/scenario.h"

/// Tests the keys vehicle.tyre_file and vehicle.tyre_file_rear.
namespace trackbed {
namespace car_tyre_file_test {

using ::testing::Contains;
using ::testing::HasSubstr;

const std::filesystem::path kTyres =
    std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tyres";

/// A scenario in the folder of the tyre files, with this section `vehicle`.
Scenario With(const std::string& vehicle) {
  return ParseScenario("schema: 1\nname: x\nvehicle: {" + vehicle +
                           "}\nmission: {speed: 3, waypoints: [[0, 0], [40, 0]]}\n"
                           "plan: {method: fillet}\n",
                       "x.yaml", kTyres);
}

std::string ErrorOf(const std::string& vehicle) {
  try {
    static_cast<void>(LoadCar(With(vehicle)));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void ExpectEqual(const MagicFormula& tyre, const MagicFormula& expected) {
  for (const MagicFormulaField& field : MagicFormulaFields()) {
    EXPECT_EQ(tyre.*field.value, expected.*field.value) << field.name;
  }
}

TEST(CarTyreFile, ReplacesAllTyreCoefficientsOfTheModel) {
  const TyreFile front = ReadTyreFile(kTyres / "mf52.tir");
  const TyreFile rear = ReadTyreFile(kTyres / "mf61.tir");
  // The Prius has one p_ky1 per axle, and the coefficient r_hy1, which a tyre file may lack.
  const CarTyres prius = *LoadCar(With("model: prius")).parts().tyres;
  const CarTyres same = *LoadCar(With("model: prius, tyre_file: mf52.tir")).parts().tyres;
  ExpectEqual(same.axle[0], front.tyre);
  ExpectEqual(same.axle[1], front.tyre);
  EXPECT_EQ(same.vertical_stiffness, *front.vertical_stiffness);
  EXPECT_EQ(same.vertical_damping, *front.vertical_damping);
  EXPECT_EQ(same.camber_gain, prius.camber_gain);
  const CarTyres both =
      *LoadCar(With("tyre_file: mf52.tir, tyre_file_rear: mf61.tir")).parts().tyres;
  ExpectEqual(both.axle[0], front.tyre);
  ExpectEqual(both.axle[1], rear.tyre);
}

TEST(CarTyreFile, IsPartOfTheKeyOfTheCache) {
  CarCache cars;
  const auto bare = cars.Load(With("model: prius"));
  const auto on_file = cars.Load(With("model: prius, tyre_file: mf52.tir"));
  EXPECT_EQ(cars.compiled(), 2U);
  EXPECT_NE(bare->parts().tyres->axle[0].p_ky1, on_file->parts().tyres->axle[0].p_ky1);
  EXPECT_EQ(cars.Load(With("model: prius, tyre_file: mf52.tir")), on_file);
}

TEST(CarTyreFile, NotesWhatWasIgnored) {
  EXPECT_THAT(TyreFileNotes(With("tyre_file: mf52.tir")),
              Contains(HasSubstr("vehicle.tyre_file: ignored: ")));
  EXPECT_TRUE(TyreFileNotes(With("model: prius")).empty());
  EXPECT_THAT(TyreFileNotes(With("tyre_file: mf52.tir, tyre_file_rear: mf61.tir")),
              Contains(HasSubstr("vehicle.tyre_file_rear: read as MF6.1")));
}

TEST(CarTyreFile, ErrorsNameTheKeyAndTheRemedy) {
  EXPECT_THAT(ErrorOf("tyre_file: none.tir"), HasSubstr("vehicle.tyre_file: "));
  EXPECT_THAT(ErrorOf("tyre_file: evaluate.py"), HasSubstr("evaluate.py:"));
  EXPECT_THAT(ErrorOf("tyre_file: mf52.tir, tyre: contact"),
              HasSubstr("has no effect on MuJoCo's contacts; remove it, or vehicle.tyre: contact"));
  EXPECT_THAT(ErrorOf("tyre_file_rear: mf52.tir"), HasSubstr("needs vehicle.tyre_file"));
  EXPECT_THAT(ErrorOf("model: diff_drive, tyre_file: mf52.tir"),
              HasSubstr("has no steered front wheels, and so no tyre law"));
}

}  // namespace car_tyre_file_test
}  // namespace trackbed
