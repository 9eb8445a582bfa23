#include "trackbed/vehicle/tyre_file.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/core/file.h"
#include "trackbed/core/table.h"

/// Reads the tyre property files of tests/data/tyres, whose forces tests/data/tyres/evaluate.py has
/// computed from the published equations.
namespace trackbed {
namespace tyre_file_test {

using ::testing::Contains;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

std::filesystem::path DataFile(const std::string& name) {
  return std::filesystem::path(TRACKBED_SOURCE_DIR) / "tests/data/tyres" / name;
}

/// The text of mf52.tir or mf61.tir with `from` replaced by `to`.
std::string TextWith(const std::string& name, const std::string& from, const std::string& to) {
  std::string text = ReadFile(DataFile(name));
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

TyreFile ParseWith(const std::string& name, const std::string& from, const std::string& to) {
  return ParseTyreFile(TextWith(name, from, to), "x.tir");
}

/// The message of the error that ParseTyreFile throws for a text; empty if it throws no error.
std::string ErrorOf(const std::string& text) {
  try {
    static_cast<void>(ParseTyreFile(text, "x.tir"));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

std::string ErrorWith(const std::string& from, const std::string& to) {
  return ErrorOf(TextWith("mf52.tir", from, to));
}

TEST(TyreFile, HasTheForcesOfThePublishedEquations) {
  for (const std::string name : {"mf52", "mf61"}) {
    const MagicFormula tyre = ReadTyreFile(DataFile(name + ".tir")).tyre;
    const Table expected = ReadCsv(DataFile(name + ".csv"));
    const auto load = expected.Column("load_N");
    const auto ratio = expected.Column("slip_ratio");
    const auto angle = expected.Column("slip_angle_rad");
    const auto camber = expected.Column("camber_iso_rad");
    const auto along = expected.Column("longitudinal_force_N");
    const auto across = expected.Column("lateral_force_N");
    ASSERT_GT(expected.rows(), 500U);
    for (std::size_t i = 0; i < expected.rows(); ++i) {
      // The camber of ISO 8855 is positive to the right, that of TyreSlip to the left.
      const TyreForce force = EvaluateTyreForce(
          tyre, load[i], 1.0, {.ratio = ratio[i], .angle = angle[i], .camber = -camber[i]});
      // Rounding of some thousand newtons, after some ten operations.
      EXPECT_NEAR(force.longitudinal, along[i], Tolerance(1e-9)) << name << ", row " << i;
      EXPECT_NEAR(force.lateral, across[i], Tolerance(1e-9)) << name << ", row " << i;
    }
  }
}

// The equations hold the curvature factor at 1 at most, at each load and slip.
TEST(TyreFile, HoldsTheCurvatureFactor) {
  const auto with = [](const char* curvature, const char* change) {
    std::string text = TextWith("mf52.tir", "PEY1 = -0.8", fmt::format("PEY1 = {}", curvature));
    text.replace(text.find("PEY2 = -0.5"), 11, fmt::format("PEY2 = {}", change));
    for (const char* key : {"PEY3 = 0.12", "PEY4 = -5.1", "LEY = 1.05"}) {
      text.erase(text.find(key), std::string_view(key).size());
    }
    return ParseTyreFile(text, "x.tir");
  };
  const TyreFile above = with("1.4", "0");
  const TyreFile at = with("1", "0");
  // At half of the nominal load, 1.4 - 0.8/2 = 1 as well.
  const TyreFile falling = with("1.4", "0.8");
  EXPECT_THAT(above.notes, Contains(HasSubstr("PEY1 is 1.4 with its scale factor")));
  EXPECT_THAT(at.notes, Not(Contains(HasSubstr("PEY1"))));
  const auto force = [](const TyreFile& file, double load, double angle) {
    return EvaluateTyreForce(file.tyre, load, 1.0, {.angle = angle}).lateral;
  };
  for (const double angle : {-0.3, -0.1, -0.02, 0.01, 0.05, 0.2}) {
    EXPECT_EQ(force(above, 3000.0, angle), force(at, 3000.0, angle));
    EXPECT_NEAR(force(falling, 0.5 * at.tyre.f_z0, angle), force(at, 0.5 * at.tyre.f_z0, angle),
                Tolerance(1e-9));
    EXPECT_NE(force(with("0.9", "0"), 3000.0, angle), force(at, 3000.0, angle));
  }
}

TEST(TyreFile, HasTheOtherNumbersInSiUnits) {
  const TyreFile newton = ReadTyreFile(DataFile("mf52.tir"));
  EXPECT_NEAR(newton.tyre.f_z0, 0.95 * 4100.0, Tolerance(1e-9));
  EXPECT_NEAR(*newton.vertical_stiffness, 2.1e5, Tolerance(1e-6));
  EXPECT_NEAR(*newton.vertical_damping, 60.0, Tolerance(1e-9));
  EXPECT_EQ(newton.tyre.rolling_resistance, 0.011);
  EXPECT_EQ(newton.tyre.camber_max, 0.15);
  // The file's parameters give sigma_kappa = p_tx1 R lambda_Fz0 lambda_sigma at the nominal load,
  // and sigma_alpha = p_ty1 sin(2 atan(1/p_ty2)) R lambda_Fz0 lambda_sigma, with sin(2 atan(1/2)) =
  // 4/5.
  EXPECT_NEAR(newton.tyre.relaxation_length_x, 2.1 * 0.31 * 0.95 * 1.1, Tolerance(1e-12));
  EXPECT_NEAR(newton.tyre.relaxation_length, 2.2 * 0.8 * 0.31 * 0.95 * 0.9, Tolerance(1e-12));
  // Forces in kilonewtons.
  const TyreFile kilonewton = ReadTyreFile(DataFile("mf61.tir"));
  EXPECT_NEAR(kilonewton.tyre.f_z0, 0.95 * 4100.0, Tolerance(1e-9));
  EXPECT_NEAR(*kilonewton.vertical_stiffness, 2.1e5, Tolerance(1e-6));
  EXPECT_NEAR(*kilonewton.vertical_damping, 60.0, Tolerance(1e-9));
  // In MF6.1, sigma is the stiffness of the tread over that of the carcass.
  const MagicFormula& tyre = kilonewton.tyre;
  EXPECT_NEAR(tyre.relaxation_length, CorneringStiffness(tyre, tyre.f_z0) / 1.2e5,
              Tolerance(1e-12));
  EXPECT_NEAR(tyre.relaxation_length_x, SlipStiffness(tyre, tyre.f_z0) / 3.6e5, Tolerance(1e-12));
}

TEST(TyreFile, ConvertsUnits) {
  const double feet =
      ParseWith("mf52.tir", "LENGTH\t= 'meter'", "length = \"Foot\"").tyre.relaxation_length;
  const double meters = ReadTyreFile(DataFile("mf52.tir")).tyre.relaxation_length;
  EXPECT_NEAR(feet / meters, 0.3048, Tolerance(1e-12));
  const double degrees =
      ParseWith("mf52.tir", "ANGLE\t= 'radians'", "ANGLE = degree").tyre.camber_max;
  EXPECT_NEAR(degrees, 0.15 * std::acos(-1.0) / 180.0, Tolerance(1e-15));
  EXPECT_THAT(ErrorWith("FORCE\t= 'newton'", "FORCE = 'stone'"),
              HasSubstr("x.tir:9: FORCE: unknown unit 'stone'; allowed: NEWTON"));
}

TEST(TyreFile, OfTheRightSideIsTheMirrorImage) {
  const MagicFormula left = ReadTyreFile(DataFile("mf52.tir")).tyre;
  const MagicFormula right = ParseWith("mf52.tir", "'LEFT'", "'RIGHT'").tyre;
  const MagicFormula symmetric = ParseWith("mf52.tir", "'LEFT'", "'SYMMETRIC'").tyre;
  for (const double kappa : {-0.3, 0.0, 0.05}) {
    for (const double alpha : {-0.2, 0.0, 0.03}) {
      for (const double camber : {-0.05, 0.04}) {
        const TyreSlip slip{.ratio = kappa, .angle = alpha, .camber = camber};
        const TyreSlip mirrored{.ratio = kappa, .angle = -alpha, .camber = -camber};
        const TyreForce a = EvaluateTyreForce(left, 3000.0, 0.7, slip);
        const TyreForce b = EvaluateTyreForce(right, 3000.0, 0.7, mirrored);
        EXPECT_NEAR(a.longitudinal, b.longitudinal, Tolerance(1e-9));
        EXPECT_NEAR(a.lateral, -b.lateral, Tolerance(1e-9));
        const TyreForce c = EvaluateTyreForce(symmetric, 3000.0, 0.7, slip);
        const TyreForce d = EvaluateTyreForce(symmetric, 3000.0, 0.7, mirrored);
        EXPECT_NEAR(c.longitudinal, d.longitudinal, Tolerance(1e-9));
        EXPECT_NEAR(c.lateral, -d.lateral, Tolerance(1e-9));
      }
    }
  }
}

TEST(TyreFile, ReadsWhatOtherProgramsWrite) {
  const MagicFormula plain = ReadTyreFile(DataFile("mf52.tir")).tyre;
  std::string text = ReadFile(DataFile("mf52.tir"));
  std::string returns;
  for (const char c : text) {
    returns += c == '\n' ? "\r\n" : std::string(1, c);
  }
  EXPECT_EQ(ParseTyreFile("\xEF\xBB\xBF" + returns, "x.tir").tyre.p_ky1, plain.p_ky1);
  // Files may contain a comment without a $, an empty value, or a table whose header is a comment.
  EXPECT_EQ(ParseWith("mf52.tir", "PCY1 = 1.31", "pcy1 =+1.31 shape factor").tyre.p_cy1,
            plain.p_cy1);
  EXPECT_EQ(ParseWith("mf52.tir", "PHX1 = -0.0009", "PHX1 =   $ none").tyre.p_hx1, 0.0);
  EXPECT_EQ(ParseWith("mf52.tir", "{radial width}", "! radial width").tyre.p_cy1, plain.p_cy1);
  // Some fits reverse the signs of both parameters.
  std::string reversed = TextWith("mf52.tir", "PKY1 = -19.2", "PKY1 = 19.2");
  reversed.replace(reversed.find("PKY2 = 1.75"), 11, "PKY2 = -1.75");
  EXPECT_EQ(ParseTyreFile(reversed, "x.tir").tyre.p_ky1, plain.p_ky1);
}

TEST(TyreFile, ListsWhatIsIgnored) {
  const std::vector<std::string> notes = ReadTyreFile(DataFile("mf52.tir")).notes;
  EXPECT_THAT(notes, Contains(HasSubstr("read as PAC2002 or MF5.2")));
  EXPECT_THAT(notes, Contains(HasSubstr("[ALIGNING_COEFFICIENTS];")));  // a whole section
  EXPECT_THAT(notes, Contains(HasSubstr("[ROLLING_COEFFICIENTS] QSY2")));
  EXPECT_THAT(notes, Contains(HasSubstr("[LONGITUDINAL_COEFFICIENTS] PTX2, PTX3")));
  EXPECT_THAT(notes, Not(Contains(HasSubstr("PCX1"))));
  EXPECT_THAT(ErrorWith("RBX1 = 12.1", "RBX1 = 0\nRBX1 = 12.1"),
              HasSubstr("RBX1: is 12.1 here and 0 on line"));
}

TEST(TyreFile, FindsTheVersion) {
  const auto version = [](const std::string& model) {
    return ParseWith("mf52.tir", "PROPERTY_FILE_FORMAT\t= 'PAC2002'", model).tyre.version;
  };
  EXPECT_EQ(version("FITTYP = 6"), 5.2);
  EXPECT_EQ(version("FITTYP = 62"), 6.1);
  EXPECT_EQ(version("PROPERTY_FILE_FORMAT = 'MF_05'"), 5.2);
  EXPECT_EQ(version("PROPERTY_FILE_FORMAT = 'USER'\nFITTYP = 61"), 6.1);
  EXPECT_EQ(version("$ nothing"), 5.2);
  EXPECT_THAT(ErrorWith("'PAC2002'", "'PAC89'"),
              HasSubstr("x.tir:14: PROPERTY_FILE_FORMAT: 'PAC89' has other equations"));
  EXPECT_THAT(ErrorWith("'PAC2002'", "'PAC2002'\nFITTYP = 21"),
              HasSubstr("x.tir:15: FITTYP: 21 has other equations"));
  EXPECT_THAT(ErrorWith("'PAC2002'", "'PAC2002'\nFITTYP = 61"),
              HasSubstr("FITTYP: 61 contradicts PROPERTY_FILE_FORMAT 'PAC2002' on line 14"));
  EXPECT_THAT(ErrorWith("PCY1 = 1.31", "PCY1 = 1.31\nPCY2 = 0.9"), HasSubstr("motorcycle"));
}

TEST(TyreFile, IsRefusedWithLineAndKey) {
  EXPECT_THAT(ErrorWith("'tir'", "'rdf'"), HasSubstr("x.tir:3: FILE_TYPE: 'rdf'"));
  EXPECT_THAT(ErrorWith("PKY1 = -19.2", "PKY1 = 19.2"),
              HasSubstr("PKY1: 19.2 must be below 0 in the axes of ISO 8855"));
  EXPECT_THAT(ErrorWith("PKX1 = 22.5\n", ""), HasSubstr("PKX1: missing; a tyre needs"));
  EXPECT_THAT(ErrorWith("PDX1 = 1.12D+00", "PDX1 = much"), HasSubstr("'much' is not a finite"));
  EXPECT_THAT(ErrorWith("PDX1 = 1.12D+00", "PDX1 = 1e999"), HasSubstr("'1e999' is not a finite"));
  EXPECT_THAT(ErrorWith("PDX1 = 1.12D+00", "PDX1 = 1.1 1.2"), HasSubstr("has two numbers"));
  EXPECT_THAT(ErrorWith("PKY1 = -19.2", "PKY1 = -1e-320"),
              HasSubstr("the cornering stiffness at the nominal load is"));
  EXPECT_THAT(ErrorWith("LMUX = 0.9", "LMUX = -0.9"), HasSubstr("-0.9 must be at least 0"));
  EXPECT_THAT(ErrorWith("LMUX = 0.9", "LMUX = 0"), HasSubstr("LMUX: 0 must be above 0"));
  EXPECT_THAT(ErrorWith("FNOMIN\t= 4100", "FNOMIN = -4100"), HasSubstr("must be above 0"));
  EXPECT_THAT(ErrorWith("'LEFT'", "'UP'"), HasSubstr("TYRESIDE: 'UP' must be 'LEFT'"));
  EXPECT_THAT(ErrorWith("'LEFT'", "'LEFT"), HasSubstr("has no closing quote"));
  EXPECT_THAT(ErrorWith("[VERTICAL]", "[VERTICAL"), HasSubstr("has no closing bracket"));
  EXPECT_THAT(ErrorWith("[VERTICAL]", "VERTICAL"), HasSubstr("is neither [SECTION] nor KEY"));
  EXPECT_THAT(ErrorWith("PCX1 = 1.61", "PC X1 = 1.61"), HasSubstr("'PC X1' is no key"));
  EXPECT_THAT(ErrorOf(std::string("PCX1 = 1\0", 9)), HasSubstr("binary data, not text"));
  EXPECT_THAT(ErrorOf(""), HasSubstr("has no entries"));
  EXPECT_THAT(ErrorOf("[MODEL]\n"), HasSubstr("has no entries"));
}

TEST(TyreFile, IsRefusedWithLineAndKeyForNumbersThatNoCarMayHave) {
  // The bounds are those of a car's file, which would otherwise be named instead of the tyre's. The
  // file has the scale factors LHY 0.6 and LFZO 0.95.
  EXPECT_EQ(ErrorWith("\nPHY1 =", "\nPHY1 = 2e3 $"),
            "x.tir:90: PHY1: is 1200 in SI units with its scale factors and pressure; must be "
            "within 1000 of 0");
  EXPECT_THAT(
      ErrorWith("\nVERTICAL_STIFFNESS", "\nVERTICAL_STIFFNESS = 1e9 $"),
      ContainsRegex("x\\.tir:26: VERTICAL_STIFFNESS: is 1e\\+09 in SI units.*1e\\+08 of 0"));
  EXPECT_THAT(ErrorWith("\nPTY1 =", "\nPTY1 = 300 $"),
              ContainsRegex("x\\.tir:111: PTY1: is .* must be within 10 of 0"));
  EXPECT_THAT(ErrorWith("\nFNOMIN", "\nFNOMIN = 2e6 $"),
              HasSubstr("x.tir:25: FNOMIN: is 1.9e+06 in SI units"));
}

TEST(TyreFile, IsBounded) {
  std::string many;
  for (std::size_t i = 0; i <= kMaxTyreFileEntries; ++i) {
    many += "K" + std::to_string(i) + " = 1\n";
  }
  EXPECT_THAT(ErrorOf(many), HasSubstr("has more than 10000 entries"));
}

TEST(TyreNumbers, HaveTheNamesOfACarsFile) {
  const TyreFile front = ReadTyreFile(DataFile("mf52.tir"));
  TyreFile rear = front;
  rear.tyre.p_ky1 = -25.0;
  rear.vertical_stiffness = 2.3e5;
  std::map<std::string, double> numbers;
  for (const auto& [name, value] : TyreNumbers(front, rear)) {
    EXPECT_TRUE(numbers.emplace(name, value).second) << name;
  }
  EXPECT_EQ(numbers.at("p_cx1"), front.tyre.p_cx1);
  EXPECT_EQ(numbers.at("p_ky1_front"), front.tyre.p_ky1);
  EXPECT_EQ(numbers.at("p_ky1_rear"), -25.0);
  EXPECT_EQ(numbers.count("p_ky1"), 0U);
  EXPECT_EQ(numbers.at("magic_formula_version"), 5.2);
  EXPECT_NEAR(numbers.at("tyre_vertical_stiffness"), 2.2e5, Tolerance(1e-6));
}

}  // namespace tyre_file_test
}  // namespace trackbed
