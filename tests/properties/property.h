#pragma once

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <sstream>
#include <string>
#include <utility>

#include "trackbed/core/error.h"

/// Checks of properties that hold for every input of a kind. RapidCheck generates random inputs.
/// The environment variable RC_PARAMS sets the number of test cases and the seed, as described in
/// RapidCheck's guide: RC_PARAMS="max_success=10000 seed=7". Properties with expensive test cases
/// use a fraction of this number. Without the variable, the seed is fixed.
namespace properties {

/// Checks a property. The function `property` draws its input with `*generator` and asserts with
/// RC_ASSERT. The number of test cases is `share` times the configured number. If the property
/// fails, Check prints the smallest failing input and how to repeat the test.
template <typename Property>
void Check(double share, Property&& property) {
  using namespace rc::detail;
  Configuration defaults;
  defaults.testParams.seed = 1;
  defaults.testParams.maxDiscardRatio = 100;
  const char* given = std::getenv("RC_PARAMS");
  TestParams params = configFromString(given == nullptr ? "" : given, defaults).testParams;
  params.maxSuccess =
      std::max(1, static_cast<int>(std::lround(share * static_cast<double>(params.maxSuccess))));
  const testing::TestInfo* info = testing::UnitTest::GetInstance()->current_test_info();
  TestMetadata metadata;
  metadata.id = std::string(info->test_suite_name()) + "." + info->name();
  metadata.description = info->name();
  const TestResult result = checkTestable(std::forward<Property>(property), metadata, params);
  if (result.is<SuccessResult>()) {
    if (!result.get<SuccessResult>().distribution.empty()) {
      printResultMessage(result, std::cout);
      std::cout << std::endl;
    }
  } else {
    std::ostringstream message;
    printResultMessage(result, message);
    ADD_FAILURE() << message.str();
  }
}

/// Generates a real number between `low` and `high`. Shrinks failing inputs toward `low`.
inline rc::Gen<double> Between(double low, double high) {
  constexpr int kSteps = 1 << 20;
  return rc::gen::map(rc::gen::resize(kSteps, rc::gen::inRange(0, kSteps + 1)),
                      [=](int i) { return low + (high - low) * i / kSteps; });
}

/// Generates a real number between -`reach` and `reach`. Shrinks failing inputs toward 0.
inline rc::Gen<double> Within(double reach) {
  constexpr int kSteps = 1 << 20;
  return rc::gen::map(rc::gen::resize(kSteps, rc::gen::inRange(-kSteps, kSteps + 1)),
                      [=](int i) { return reach * i / kSteps; });
}

/// Generates a power of ten with an integer exponent between `low` and `high`. Shrinks failing
/// inputs toward 1.
inline rc::Gen<double> PowerOfTen(int low, int high) {
  return rc::gen::map(rc::gen::resize(1000, rc::gen::inRange(low, high + 1)),
                      [](int power) { return std::pow(10.0, power); });
}

/// Returns a random integer between `low` and `high`. Shrinks failing inputs toward `low`.
inline int Pick(int low, int high) {
  return *rc::gen::resize(1000, rc::gen::inRange(low, high + 1));
}

/// Returns true with a probability of 1/`times`. Shrinks failing inputs toward false.
inline bool OnceIn(int times) {
  return Pick(0, times - 1) == times - 1;
}

/// Returns the name of the error of error.h that the call throws; empty if the call throws nothing.
/// Any other exception propagates and fails the property.
template <typename Call>
std::string Refusal(const Call& call) {
  try {
    call();
    return "";
  } catch (const trackbed::InputError&) {
    return "InputError";
  } catch (const trackbed::PreconditionError&) {
    return "PreconditionError";
  } catch (const trackbed::InternalError& error) {
    return std::string("InternalError: ") + error.what();
  }
}

template <typename Call>
bool Refuses(const Call& call) {
  return !Refusal(call).empty();
}

}  // namespace properties
